/* A bounding volume hierarchy over the terms of the potential [field.h], for ray casting. Call
 * fieldindex_build once. Ray casters then traverse the nodes themselves; fieldindex_potential
 * evaluates the potential at a point.
 *
 * A FieldTube is the term of a segment with precomputed constants. A node of the hierarchy is a box
 * that contains its tubes and the space where their terms are at least RAY_TERM_CUTOFF [field.h].
 * Exported by
 * the public header of the module field. */
#ifndef CORCAST_FIELD_FIELDINDEX_H
#define CORCAST_FIELD_FIELDINDEX_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* A term of the potential: exp(-E^2) (erf(u) + erf(length_k - u)) / 2. u is the position of the
 * point along the axis, from the first end, and below 0 before it; E is the distance from the axis
 * line; both are in units of 1 / k. */
typedef struct FieldTube {
    Vec3 a;          /* first end of the segment, mm */
    Vec3 axis;       /* direction of the segment, unit */
    double length;   /* mm */
    double k;        /* potential_k, 1/mm */
    double length_k; /* k length */
    double peak;     /* maximum of the term */
    double log_peak; /* natural logarithm of `peak` */
    double reach2; /* squared distance from the segment, in units of 1 / k^2, beyond which the term
                    * is below RAY_TERM_CUTOFF. 0 or below: the term is smaller everywhere. */
    uint32_t segment; /* index into geometry->segments */
} FieldTube;

/* Returns the tube of a segment. `index` is its index in geometry->segments. The segment's ends
 * must differ. */
FieldTube fieldtube_of(const FieldSegment *segment, uint32_t index);

/* Maximum number of tubes in a leaf, and size of a stack that suffices to traverse any hierarchy.
 */
enum { FIELD_LEAF_SIZE = 2, FIELD_STACK_SIZE = 64 };

/* A node of the hierarchy. */
typedef struct FieldNode {
    double bounds[2][3]; /* low and high corner of the box, mm */
    uint32_t first;   /* leaf: index of its first tube; inner node: index of its second child. The
                       * first child is the next node. */
    uint32_t n_tubes; /* number of tubes of a leaf; 0 for an inner node */
} FieldNode;

/* The index. Immutable after construction; threads may share it. */
typedef struct FieldIndex {
    const Geometry *geometry; /* borrowed */
    FieldTube *tubes;         /* sorted by leaf; without tubes whose reach2 is 0 or below */
    size_t n_tubes;
    FieldNode *nodes; /* in depth-first order; the depth is at most log2(n_tubes) + 1 */
    size_t n_nodes;
} FieldIndex;

/* Builds the index of the segments of a geometry, which may have none. The geometry must outlive
 * the index. Free *out with fieldindex_free. Errors: STATUS_MEMORY. O(n log^2 n). */
MUST_CHECK Status fieldindex_build(const Geometry *geometry, FieldIndex **out, Err *err);
/* Frees the index; NULL is allowed. */
void fieldindex_free(FieldIndex *index);

/* Returns the sum of all terms at x, even of segments that do not blend with each other. Terms
 * below RAY_TERM_CUTOFF are left out. O(log n) if few segments are near. */
double fieldindex_potential(const FieldIndex *index, Vec3 x);

#endif
