/* Color maps from numbers to colors. */
#ifndef CORCAST_IMAGE_COLORMAP_H
#define CORCAST_IMAGE_COLORMAP_H

#include "base/base.h"

typedef struct Colormap {
    float (*srgb)[3]; /* owned; red green blue in [0, 1], from low to high */
    size_t n;         /* at least 2 */
    bool separate;    /* the colors distinguish groups and are not interpolated */
} Colormap;

/* Reads a file of one color per line, "red green blue" in sRGB from 0 to 1. '#' starts a comment
 * line. A line `separate` before the first color makes the map separate. Release *map with
 * colormap_release. Errors: STATUS_INPUT, naming file and line, for other lines and for fewer than
 * 2 colors; STATUS_MEMORY. */
MUST_CHECK Status colormap_read(Colormap *map, const char *path, Err *err);
void colormap_release(Colormap *map);

/* Stores the linear color at `fraction`, which is clamped to [0, 1]. Interpolates between
 * neighbouring colors in sRGB. NaN gives middle grey. */
void colormap_linear(const Colormap *map, double fraction, float rgb[3]);

/* Stores the linear color with the index `number` modulo the number of colors. */
void colormap_color(const Colormap *map, size_t number, float rgb[3]);

#endif
