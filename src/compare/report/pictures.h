/* Makes pictures that show the difference of two pictures: a heat map, the signed difference, and
 * an animation. */
#ifndef CORCAST_COMPARE_REPORT_PICTURES_H
#define CORCAST_COMPARE_REPORT_PICTURES_H

#include "base/base.h"
#include "image/image.h"

/* The colors of the heat map. Color i is for differences of at least heat_steps[i].from_level and
 * below that of the next step. The steps begin at 0, 1, 2, 4, 8 and 16 levels. They do not depend
 * on the pictures, so two heat maps can be compared. */
enum { HEAT_STEPS = 6 };
typedef struct HeatStep {
    int from_level; /* largest difference over the channels, in 8-bit levels */
    uint8_t red, green, blue;
} HeatStep;
extern const HeatStep heat_steps[HEAT_STEPS];

/* For the three functions: a and b must have equal size, channels and bits (8 or 16). Release a
 * Picture *out with picture_release. Errors: STATUS_MEMORY. */

/* Makes the heat map of the difference, an 8-bit RGB picture. In 16-bit pictures, a difference
 * above 0 and below one level (257 codes) has the color of level 1, so that only equal pixels have
 * the color of level 0. */
MUST_CHECK Status heat_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* Makes the signed difference, an 8-bit picture with the channels of a: 128 + 8 (B - A) in 8-bit
 * levels, clipped. Equal pixels are grey. The factor 8 makes small differences visible. */
MUST_CHECK Status difference_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* Appends an animated PNG [APNG 1.0] to *out that shows A and B in turn, half a second each,
 * without end. Viewers that do not support animations show A. */
MUST_CHECK Status flicker_png(const Picture *a, const Picture *b, Text *out, Err *err);

#endif
