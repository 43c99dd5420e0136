/* The mean of numbers that segments have, at a point of an implicit surface. Exported by the room's
 * door. */
#ifndef CORCAST_FIELD_TERMMEAN_H
#define CORCAST_FIELD_TERMMEAN_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* Constant once made, shared by threads. */
typedef struct TermMean TermMean;

/* Makes it of a potential or a blob, which is borrowed until termmean_free. O(n log n).
 * STATUS_MEMORY. */
MUST_CHECK Status termmean_new(const Geometry *geometry, TermMean **out, Err *err);
void termmean_free(TermMean *mean);

/* The mean of numbers[segment] at x over the segments whose term is felt there, weighted by these:
 * of all, or, where segments blend in groups, of the group whose sum is largest. Segments whose
 * number is NAN do not count; NAN where they have more than half of the weight, or nothing is felt.
 * Terms below RAY_TERM_CUTOFF are left out. O(log n) where few segments are near. */
double termmean_at(const TermMean *mean, const double *numbers, Vec3 x);

#endif
