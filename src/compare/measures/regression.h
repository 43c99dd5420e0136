/* The straight line through the colours of two pictures; private to the room compare. */
#ifndef CORCAST_COMPARE_MEASURES_REGRESSION_H
#define CORCAST_COMPARE_MEASURES_REGRESSION_H

#include "compare/measures/pixel_counts.h"

/* Takes gain and offset of b = gain a + offset, by least squares over the samples that `counting`
 * has counted, and the standard errors of both. A level is 1 / code_levels codes. */
MUST_CHECK Status regression_take(const Counting *counting, double code_levels,
                                  CompareResult *result, Err *err);

#endif
