/* The mean of the values of segments at a point of an implicit surface.
 *
 * Each segment has a value, for example its flow. Where segments blend, a point of the surface gets
 * the mean of their values, weighted by their terms of the potential or of the blob. So colors
 * change smoothly. Exported by the public header of the module field. */
#ifndef CORCAST_FIELD_TERMMEAN_H
#define CORCAST_FIELD_TERMMEAN_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* Immutable after construction; threads may share it. */
typedef struct TermMean TermMean;

/* Prepares the means for the potential or the blob of a geometry, which is borrowed until
 * termmean_free. Free *out with termmean_free. Errors: STATUS_MEMORY. O(n log n). */
MUST_CHECK Status termmean_new(const Geometry *geometry, TermMean **out, Err *err);
/* Frees the means; NULL is allowed. */
void termmean_free(TermMean *mean);

/* Returns the mean of values[segment] at x, weighted by the terms of the segments at x.
 *
 * If segments blend in groups, only the group with the largest sum counts. Segments whose value is
 * NAN do not count. Terms below RAY_TERM_CUTOFF are left out. Returns NAN if segments with the
 * value NAN have more than half of the weight, or if there is no term. O(log n) if few segments are
 * near. */
double termmean_at(const TermMean *mean, const double *values, Vec3 x);

#endif
