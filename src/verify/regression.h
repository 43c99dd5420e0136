/* The straight line through the colours of two pictures; private to the room verify. */
#ifndef CORCAST_VERIFY_REGRESSION_H
#define CORCAST_VERIFY_REGRESSION_H

#include "verify/pixel_counts.h"

/* Takes gain and offset of b = gain a + offset, by least squares over the samples that `counting`
 * has counted, and the standard errors of both. A level is 1 / code_levels codes. */
MUST_CHECK Status regression_take(const Counting *counting, double code_levels,
                                  CompareResult *result, Err *err);

#endif
