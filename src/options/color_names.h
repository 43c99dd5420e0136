/* Finds CSS colors by name: "tomato" is 0xFF6347. */
#ifndef CORCAST_OPTIONS_COLOR_NAMES_H
#define CORCAST_OPTIONS_COLOR_NAMES_H

#include <stdbool.h>
#include <stdint.h>

/* Sets *rgb to the CSS color with this name, as 0xRRGGBB in sRGB. Ignores case. Returns false and
 * leaves *rgb unchanged if CSS has no such color. */
bool color_by_name(const char *name, uint32_t *rgb);

#endif
