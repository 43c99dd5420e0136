/* Names what made one picture of another. */
#ifndef CORCAST_COMPARE_CAUSE_CAUSE_H
#define CORCAST_COMPARE_CAUSE_CAUSE_H

#include "compare/result.h"

/* Sets result->cause to a sentence about what made B of A, if that is certain.
 *
 * Causes are: turned, mirrored or with other channels; moved; blurred; brighter or darker
 * everywhere; one thing missing; other outlines, highlights or shading only. The sentence stays ""
 * if no single cause explains the difference.
 *
 * a, b     the pictures of the result, of one shape, depth and gamma.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status compare_cause(const Picture *a, const Picture *b, CompareResult *result,
                                Err *err);

#endif
