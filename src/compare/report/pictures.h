/* Makes pictures that show the difference of two pictures: a heat map, the signed difference, and
 * an animation. */
#ifndef CORCAST_COMPARE_REPORT_PICTURES_H
#define CORCAST_COMPARE_REPORT_PICTURES_H

#include "base/base.h"
#include "image/image.h"

/* The colors of the heat map. A color is for differences from `from_level` to the next step: 0, 1,
 * 2, 4, 8, 16 and more levels. The steps do not depend on the pictures, so two heat maps can be
 * compared. */
enum { HEAT_STEPS = 6 };
typedef struct HeatStep {
    int from_level; /* largest difference over the channels, in 8-bit levels */
    uint8_t red, green, blue;
} HeatStep;
extern const HeatStep heat_steps[HEAT_STEPS];

/* Both pictures must have equal size, channels and bits. The caller releases *out. Errors:
 * STATUS_MEMORY. */

/* Makes the heat map of the difference, an 8-bit RGB picture. Only equal pixels have the color of
 * level 0. A difference of 16-bit codes below one level has the color of level 1. */
MUST_CHECK Status heat_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* Makes the signed difference, an 8-bit picture: 128 + 8 (B - A) in 8-bit levels, clipped. Equal
 * pixels are grey. */
MUST_CHECK Status difference_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* Appends an animated PNG [APNG 1.0] that shows A and B in turn, half a second each, without end.
 * Viewers that cannot show animations show A. */
MUST_CHECK Status flicker_png(const Picture *a, const Picture *b, Text *out, Err *err);

#endif
