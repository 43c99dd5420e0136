/* Finds a single change that explains all differences of two pictures, such as a rotation or a
 * gain. */
#ifndef CORCAST_COMPARE_CAUSE_CAUSE_H
#define CORCAST_COMPARE_CAUSE_CAUSE_H

#include "compare/result.h"

/* Finds the bounding box of all pixels that differ, and the change that turns A into B. Sets
 * result->box; its width is 0 if no pixel differs. Sets result->cause to a sentence about the
 * change if a single change explains all differences; else result->cause stays "".
 *
 * The changes are: mirrored or channels exchanged; moved, rotated, enlarged or cropped; blurred;
 * brighter or darker everywhere; another hue or saturation; compressed as JPEG; noise; one vessel
 * missing; different outlines, highlights or shading only.
 *
 * a, b    the pictures that were compared, of equal size, channels, bit depth and gamma.
 * result  the comparison of a and b by compare_pictures. After an error result->cause is "".
 * Errors  STATUS_MEMORY.
 * Cost    O(pixels). */
MUST_CHECK Status compare_cause(const Picture *a, const Picture *b, CompareResult *result,
                                Err *err);

#endif
