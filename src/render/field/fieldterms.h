/* The segments of an implicit scene in the camera's frame, and as the terms of a tile: what the
 * kernels of kernel_trace.h are given. */
#ifndef CORCAST_RENDER_FIELDTERMS_H
#define CORCAST_RENDER_FIELDTERMS_H

#include "field/field.h"
#include "render/tile/interval.h"
#include "render/tile/tile.h"

/* A segment in the frame of the camera, mm. */
typedef struct FrameSegment {
    Vec3 a, b, axis; /* the ends, and the unit vector from a to b */
    double length;
    double k; /* potential_k, 1 / mm */
    /* Of the angle between the axis and parallel rays, and 1 / sine; 0 where the axis is parallel
     * to the rays. */
    double sine, per_sine;
    double reach; /* mm from the axis, beyond which the term is below the cut-off */
} FrameSegment;

/* A term of the potential as the tile sees it. `o` is where the middle ray passes at z = z_near:
 * its place less the point of the axis that is nearest to the ray. k = potential_k. */
typedef struct TileTerm {
    double z_near;
    double on, off; /* z between which the term may exceed the cut-off on a ray of the tile */
    float k, per_k2;
    float reach2; /* the term is below the cut-off where (k distance)^2 of the segment exceeds it */
    float u, v;   /* k times the distances of that point from the two ends */
    float o[3];
    float axis[3];                /* unit */
    float cross[3];               /* (middle ray's direction) x axis; orthographic: of length k */
    float sine, per_sine, cosine; /* orthographic: of the angle between axis and ray */
    float per_w, per_u;           /* orthographic: 1 / (k sine) and 1 / (k cosine), finite */
    uint32_t segment;             /* index in the scene */
} TileTerm;

/* A tile of the potential: the terms near it, and where its samples are. */
typedef struct FieldTile {
    const TileTerm *terms; /* by rising `on`, unless in a plane or of any depth */
    size_t n_terms;
    LocalGroups *groups; /* a workspace; NULL where all segments blend */
    bool perspective;
    bool any_depth;     /* samples are places, not rays from the eye: no plane is looked for */
    bool blob;          /* terms are those of a blob: nor is it there */
    bool plane;         /* all blend, and lie in one plane, square to all rays */
    const float *x, *y; /* of the samples, relative to the middle ray */
    double middle_x, middle_y;
    float half_size; /* largest distance of a sample from the middle ray */
    double z_min;    /* nothing is seen before it; of places: they are not before it */
} FieldTile;

/* Sets the terms of a tile, one for each of the n segments listed that is within reach of its rays,
 * and the list of those segments; there is room for n. Sets `plane`; all else of the tile but the
 * terms is set. */
void fieldterms_make(const FrameSegment *segments, const uint32_t *list, size_t n, FieldTile *tile,
                     TileTerm *terms, uint32_t *kept);

/* Has the memory of the segments fetched that fieldterms_make is about to read. */
void fieldterms_fetch(const FrameSegment *segments, const uint32_t *list, size_t n);

enum { TILE_WORK_BYTES = 2176 }; /* of one term in a kernel's workspace */

/* The workspace of a kernel, for up to `capacity` terms. */
typedef struct TileWork {
    void *memory;
    size_t capacity;
} TileWork;

/* Makes room for `n` terms. */
MUST_CHECK Status tilework_reserve(TileWork *work, size_t n, Err *err);
void tilework_release(TileWork *work);

#endif
