/* Color maps: lists of colors that are read from files. A color map assigns a color to each
 * fraction from 0 to 1. A color scale [colorscale.h] maps the values of a quantity to these
 * fractions. Included by the public header image.h. */
#ifndef CORCAST_IMAGE_COLORMAP_H
#define CORCAST_IMAGE_COLORMAP_H

#include "base/base.h"

/* A color map. */
typedef struct Colormap {
    float (*srgb)[3]; /* owned; red green blue in [0, 1], from low to high */
    size_t n;         /* at least 2 */
    bool separate;    /* true: a qualitative map, whose colors distinguish groups and are not
                       * interpolated */
} Colormap;

/* Reads a color map from a file with one color per line: "red green blue" in sRGB, from 0 to 1. A
 * line that starts with '#' is a comment. A line `separate` before the first color sets
 * map->separate. *map is set on success only; release it with colormap_release. Errors:
 * STATUS_INPUT, with file and line, for any other line and for fewer than 2 colors; STATUS_IO if
 * the file cannot be read; STATUS_MEMORY. */
MUST_CHECK Status colormap_read(Colormap *map, const char *path, Err *err);
void colormap_release(Colormap *map);

/* Computes the color, in linear RGB, at a fraction of the map: 0 is the first color, 1 the last.
 * Fractions outside [0, 1] are clamped. Interpolates between neighbouring colors in sRGB, also in a
 * `separate` map, for which callers use colormap_color. NaN gives middle grey. */
void colormap_linear(const Colormap *map, double fraction, float rgb[3]);

/* Computes the color with index `number` modulo the number of colors, in linear RGB. Index 0 is the
 * first color. */
void colormap_color(const Colormap *map, size_t number, float rgb[3]);

#endif
