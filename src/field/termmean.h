/* Computes the mean of the values of segments at a point of a smooth surface [field.h, blob.h].
 * Call termmean_new once for a geometry, and termmean_at for each point.
 *
 * Each segment has a value, for example its flow. Where segments blend, a point gets the mean of
 * their values, weighted by their terms of the potential or of the blob. Colors of values therefore
 * change smoothly. Exported by the public header of the module field. */
#ifndef CORCAST_FIELD_TERMMEAN_H
#define CORCAST_FIELD_TERMMEAN_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* Immutable after construction; threads may share it. */
typedef struct TermMean TermMean;

/* Prepares the means for the potential or the blob of a geometry with at least one segment. The
 * geometry is borrowed until termmean_free. Free *out with termmean_free. Errors: STATUS_MEMORY.
 * Cost: O(n log n). */
MUST_CHECK Status termmean_new(const Geometry *geometry, TermMean **out, Err *err);
/* Frees the means; NULL is allowed. */
void termmean_free(TermMean *mean);

/* Returns the mean of the values at x, mm, weighted by the terms of the segments at x.
 *
 * If segments blend in groups [localgroups.h], only the group with the largest sum of terms counts.
 * The mean is over the segments whose value is not NAN. Terms below RAY_TERM_CUTOFF are left
 * out.
 *
 * values   the value of segment i is values[geometry->segments[i].segment].
 * Returns  NAN if segments with the value NAN have more than half of the weight, or if no term is
 *          left.
 * Cost     O(log n) if few segments are near x. */
double termmean_at(const TermMean *mean, const double *values, Vec3 x);

#endif
