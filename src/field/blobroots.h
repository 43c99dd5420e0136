/* The field of a blob along one ray, asked without cleverness: what the root finders of two
 * renderers are judged by where they disagree. Exported by the room's door. */
#ifndef CORCAST_FIELD_BLOBROOTS_H
#define CORCAST_FIELD_BLOBROOTS_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

enum { BLOB_ROOTS = 16 };

typedef struct BlobRoots {
    int n;
    double t[BLOB_ROOTS]; /* rising; each to 10^-12 of the least radius near the ray, and its own
                             rounding */
    bool sure; /* whether there is no other in the interval asked about, or before the last of
                  BLOB_ROOTS */
} BlobRoots;

/* The first places in (t_min, t_max) where the field of the segments' blob passes 1 along the ray,
 * either way, by halving intervals in long double; it takes time in proportion to n.
 * STATUS_MEMORY. */
MUST_CHECK Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min,
                             double t_max, BlobRoots *roots, Err *err);

#endif
