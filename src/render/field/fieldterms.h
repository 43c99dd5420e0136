/* Prepares the segments of an implicit model for the kernels of kernel_trace.h. A segment is first
 * moved to the frame of the view [FrameSegment]. For each tile that it may touch, fieldterms_make
 * then makes a term [TileTerm]: the segment relative to the middle ray of the tile, in single
 * precision. A FieldTile holds the terms of a tile and its sample positions.
 *
 * The cut-off is the value below which a term counts as 0: TILE_TERM_CUTOFF [field.h]. `per_x`
 * means 1 / x. */
#ifndef CORCAST_RENDER_FIELD_FIELDTERMS_H
#define CORCAST_RENDER_FIELD_FIELDTERMS_H

#include "field/field.h"
#include "render/tile/interval.h"
#include "render/tile/tile.h"

/* A segment in the frame of the camera, mm. */
typedef struct FrameSegment {
    Vec3 a, b, axis; /* the ends, and the unit vector from a to b */
    double length;
    double k; /* 1 / (unit of length of the segment's term), 1 / mm [potential_k] */
    /* Orthographic views: the sine of the angle between the axis and the rays, and 1 / sine. Both
     * are 0 if the axis is parallel to the rays. */
    double sine, per_sine;
    double reach; /* distance from the axis beyond which the term is below the cut-off */
} FrameSegment;

/* A term of the potential, prepared for one tile. P is the point of the segment's axis that is
 * nearest to the tile's middle ray, and Q is the point of the middle ray that is nearest to P.
 * Lengths are in mm unless they are multiplied by k (FrameSegment.k). */
typedef struct TileTerm {
    double z_near;  /* z of Q */
    double on, off; /* range of z where the term may exceed the cut-off on a ray of the tile */
    float k, per_k2;
    float reach2;                 /* (k times FrameSegment.reach)^2 */
    float u, v;                   /* k times the distances from P to the two ends */
    float o[3];                   /* Q - P */
    float axis[3];                /* unit */
    float cross[3];               /* middle ray x axis; orthographic: scaled to length k */
    float sine, per_sine, cosine; /* orthographic: of the angle between axis and ray */
    float per_w, per_u; /* orthographic: 1 / (k sine) and 1 / (k cosine); where a divisor is
                         * below 1e-20, it counts as 1e-20 */
    uint32_t segment;   /* index in the scene */
} TileTerm;

/* A tile of the potential: the terms near it, and the positions of its samples. */
typedef struct FieldTile {
    const TileTerm *terms; /* sorted by ascending `on`, unless `plane` or `any_depth` is true */
    size_t n_terms;
    LocalGroups *groups; /* workspace that finds which segments blend, so that their terms are
                          * added; NULL if all segments blend */
    bool perspective;
    bool any_depth;     /* samples are points with depths of their own, not rays; `plane` is then
                         * false */
    bool blob;          /* the model is a POV-Ray blob, not a potential; `plane` is then false */
    bool plane;         /* orthographic view: all terms blend, and all axes are in one plane
                         * perpendicular to the rays */
    const float *x, *y; /* per sample: position relative to the middle ray; mm, or in perspective
                         * at z = 1 */
    double middle_x, middle_y; /* position of the middle ray, in the same unit */
    float half_size;           /* largest distance of a sample from the middle ray */
    double z_min; /* no hit has a smaller z; with any_depth, no sample has a smaller z */
} FieldTile;

/* Makes one term for each of the n listed segments that is within reach of the tile's rays. Sets
 * `terms`, `n_terms` and `plane` of the tile; the caller has set its other fields. If no segment is
 * within reach, n_terms is 0.
 *
 * terms   has space for n terms; tile->terms becomes this array.
 * kept    has space for n indices; receives the indices of the segments that have terms, in the
 * order of `list`, even if `terms` is sorted. */
void fieldterms_make(const FrameSegment *segments, const uint32_t *list, size_t n, FieldTile *tile,
                     TileTerm *terms, uint32_t *kept);

/* Prefetches the segments that fieldterms_make will read. It has no other effect. */
void fieldterms_fetch(const FrameSegment *segments, const uint32_t *list, size_t n);

/* Upper bound of the bytes that one term takes in a kernel's workspace, for the widest kernel.
 * kernel_packet.h and kernel_trace_flat.h check it at compile time. */
enum { TILE_WORK_BYTES = 2176 };

#endif
