/* The segments of a scene prepared for rays, and a bounding volume hierarchy over them. Exported by
 * the room's door. */
#ifndef CORCAST_FIELD_FIELDINDEX_H
#define CORCAST_FIELD_FIELDINDEX_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* A term of the potential. Lengths of u and of the distance E to the axis are in units of 1 / k,
 * so the term is exp(-E^2) (erf(u) + erf(length_k - u)) / 2. */
typedef struct FieldTube {
    Vec3 a;
    Vec3 axis;       /* unit */
    double length;   /* mm */
    double k;        /* potential_k, 1/mm */
    double length_k; /* k length */
    double peak;     /* largest value of the term */
    double log_peak;
    double reach2;    /* beyond E^2 = reach2 of the segment the term is below RAY_TERM_CUTOFF */
    uint32_t segment; /* index into geometry->segments */
} FieldTube;

FieldTube fieldtube_of(const FieldSegment *segment, uint32_t number);

enum { FIELD_LEAF_SIZE = 2, FIELD_STACK_SIZE = 64 };

/* A box about tubes out to their reach. */
typedef struct FieldNode {
    double bounds[2][3]; /* low, high, mm */
    uint32_t first;      /* leaf: its tubes; inner: the second child, the first being next to it */
    uint32_t n_tubes;    /* 0 for an inner node */
} FieldNode;

/* Constant once built, shared by threads. */
typedef struct FieldIndex {
    const Geometry *geometry;
    FieldTube *tubes; /* without the segments whose term is below the cut-off everywhere */
    size_t n_tubes;
    FieldNode *nodes; /* depth first; at most log2(n_tubes) + 1 deep */
    size_t n_nodes;
} FieldIndex;

/* geometry->segments, of which there may be none, is borrowed and must outlive the index, which the
 * caller frees with fieldindex_free. O(n log^2 n). STATUS_MEMORY. */
MUST_CHECK Status fieldindex_build(const Geometry *geometry, FieldIndex **out, Err *err);
void fieldindex_free(FieldIndex *index);

/* The sum of all terms of the scene at x, whatever blends with what, but for those below
 * RAY_TERM_CUTOFF. O(log n) where few segments are near. */
double fieldindex_potential(const FieldIndex *index, Vec3 x);

#endif
