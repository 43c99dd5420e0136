/* What comparisons of all kinds share; private to the room compare. */
#ifndef CORCAST_COMPARE_MEASURES_RESULT_H
#define CORCAST_COMPARE_MEASURES_RESULT_H

#include "compare/compare.h"

/* Nothing measured yet. `ids` is of one of the images, or NULL. */
CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                           const Tolerance *tolerance);
/* Names the segments at the places found (the id planes are both or neither NULL), and holds the
 * result against its tolerance: fills in rules, agrees and reason. */
void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b);

/* STATUS_INPUT unless both sides are equal. */
MUST_CHECK Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err);

/* What is compared, in words. */
const char *result_title(const CompareResult *result);

PixelPlace place_of(size_t pixel, int width);

/* A sentence about a rule that is broken, or would be. */
void rule_sentence(const CompareResult *result, const Rule *rule, char *out, size_t size);

/* The largest difference over the channels of a pixel, codes. */
int largest_difference(const Picture *a, const Picture *b, size_t pixel);
/* How many codes of such a picture the tolerance lets a pixel be off. */
int allowed_codes(const Tolerance *tolerance, const Picture *picture);
/* Whether depths or normals differ by more than so much at a pixel that both show. */
bool geometry_differs(const Rendering *a, const Rendering *b, size_t pixel, double mm, double deg);

/* The smallest of n >= 1 values, which are reordered, that at least `fraction` of all do not
 * exceed: the percentile by nearest rank. O(n). */
double percentile(double *values, size_t n, double fraction);

/* The angle between two vectors in degrees, exact also where it is small. */
double angle_deg(const float *a, const float *b);

#endif
