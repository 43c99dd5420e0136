/* Colour maps: numbers to colours. */
#ifndef CORCAST_IMAGE_COLORMAP_H
#define CORCAST_IMAGE_COLORMAP_H

#include "base/base.h"

typedef struct Colormap {
    float (*srgb)[3]; /* owned; red green blue in [0, 1], from low to high */
    size_t n;         /* at least 2 */
    bool separate;    /* the colours tell groups apart, and nothing lies between them */
} Colormap;

/* Reads a file of one colour a line, "red green blue" in sRGB from 0 to 1; '#' starts a comment
 * line. A line `separate` before the first colour makes the map separate. STATUS_INPUT naming file
 * and line on anything else, and on fewer than 2 colours. */
MUST_CHECK Status colormap_read(Colormap *map, const char *path, Err *err);
void colormap_release(Colormap *map);

/* The linear colour at `fraction`, clamped to [0, 1], between neighbours interpolated in sRGB;
 * middle grey for NaN. */
void colormap_linear(const Colormap *map, double fraction, float rgb[3]);

/* The linear colour number `number` of a map, which may have fewer: they are counted round. */
void colormap_color(const Colormap *map, size_t number, float rgb[3]);

#endif
