/* What field.c searches: segments prepared for rays, and a bounding volume hierarchy over them. */
#ifndef CORCAST_RENDER_FIELDINDEX_H
#define CORCAST_RENDER_FIELDINDEX_H

#include "render/cast/field.h"

/* A term of the potential. Lengths of u and of the distance E to the axis are in units of 1 / k,
 * so the term is exp(-E^2) (erf(u) + erf(length_k - u)) / 2. */
typedef struct FieldTube {
    Vec3 a;
    Vec3 axis;       /* unit */
    double length;   /* mm */
    double k;        /* sqrt(2) / radius, 1/mm */
    double length_k; /* k length */
    double peak;     /* largest value of the term */
    double log_peak;
    double reach2; /* beyond E^2 = reach2 of the segment the term is below the cut-off */
    uint32_t segment;
} FieldTube;

FieldTube fieldtube_of(const FieldSegment *segment, uint32_t number);

enum { FIELD_LEAF_SIZE = 2, FIELD_STACK_SIZE = 64 };

/* A box about tubes out to their reach. */
typedef struct FieldNode {
    double bounds[2][3]; /* low, high */
    uint32_t first;      /* leaf: its tubes; inner: the second child, the first being next to it */
    uint32_t n_tubes;    /* 0 for an inner node */
} FieldNode;

struct FieldIndex {
    const Scene *scene;
    FieldTube *tubes; /* without the segments whose term is below the cut-off everywhere */
    size_t n_tubes;
    FieldNode *nodes; /* depth first; at most log2(n_tubes) + 1 deep */
    size_t n_nodes;
};

#endif
