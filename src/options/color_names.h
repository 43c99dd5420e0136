/* Colors by name. */
#ifndef CORCAST_OPTIONS_COLOR_NAMES_H
#define CORCAST_OPTIONS_COLOR_NAMES_H

#include <stdbool.h>
#include <stdint.h>

/* The color that CSS calls so, in capitals or not, as 0xRRGGBB; false, and *rgb as it was, when it
 * calls none so. */
bool color_by_name(const char *name, uint32_t *rgb);

#endif
