/* What colours mean: a scale from the values of a quantity to colours. */
#ifndef CORCAST_IMAGE_COLORSCALE_H
#define CORCAST_IMAGE_COLORSCALE_H

#include "base/base.h"
#include "image/colormap.h"

typedef struct ColorScale {
    const char *name; /* of the quantity, borrowed; NULL: there is no scale */
    const char *unit; /* borrowed; "" for pure numbers */
    double range[2];  /* values at the ends of the map, ascending; above 0 with `log` */
    bool log;         /* equal steps of the map are equal ratios of values */
    int classes;      /* N >= 2: the range is N equal steps of one colour each; else continuous */
    Colormap map;     /* owned by who made the scale */
} ColorScale;

/* Sets the range from the least to the greatest of `n` values that the scale can show: finite, and
 * above 0 with `log`. False, and nothing is set, when there is none. */
bool colorscale_fit(ColorScale *scale, const double *values, size_t n);

/* The linear colour of a value, at the ends of the map beyond the range; middle grey for values
 * that the scale cannot show. Colours of classes are spread over the whole map, its ends included;
 * a value on a bound belongs to the class above. A range without width has the middle of the map at
 * its one value. */
void colorscale_linear(const ColorScale *scale, double value, float rgb[3]);

#endif
