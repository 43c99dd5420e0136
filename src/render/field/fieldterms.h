/* Prepares the segments of an implicit surface for the kernels of kernel_trace.h and
 * kernel_shadow.h. A segment is first transformed to the frame of the view [FrameSegment]. For each
 * tile that the segment may affect, fieldterms_make then makes a term [TileTerm]: the segment
 * relative to the middle ray of the tile, in single precision.
 *
 * The cut-off is the value below which a term counts as 0: TILE_TERM_CUTOFF [field.h]. A name per_x
 * stands for 1 / x. A divisor below 1e-20 counts as 1e-20, so that all fields are finite. */
#ifndef CORCAST_RENDER_FIELD_FIELDTERMS_H
#define CORCAST_RENDER_FIELD_FIELDTERMS_H

#include "field/field.h"
#include "render/tile/interval.h"
#include "render/tile/tile.h"

/* A segment in the frame of the view. Lengths are in mm. */
typedef struct FrameSegment {
    Vec3 a, b, axis; /* the ends, and the unit vector from a to b */
    double length;
    double k; /* 1 / mm: a distance times k is the argument of the segment's Gaussian
               * [potential_k] */
    /* Orthographic views: the sine of the angle between the axis and the rays, and 1 / sine. Both
     * are 0 if the axis is parallel to the rays. */
    double sine, per_sine;
    double reach; /* distance from the segment beyond which the term is below the cut-off */
} FrameSegment;

/* A term of the potential, prepared for one tile. P is the point of the segment's axis that is
 * nearest to the tile's middle ray, and Q is the point of the middle ray that is nearest to P.
 * Lengths are in mm unless they are multiplied by k (FrameSegment.k). */
typedef struct TileTerm {
    double z_near;                /* z of Q */
    double z_begin, z_end;        /* interval of z outside which the term is below the cut-off on
                                   * all rays of the tile */
    float k, per_k2;              /* FrameSegment.k; 1 / k^2 */
    float reach2;                 /* (k times FrameSegment.reach)^2 */
    float u, v;                   /* k times the distances from P, which is on the segment, to the
                                   * ends a and b; >= 0 */
    float o[3];                   /* the vector from P to Q */
    float axis[3];                /* unit */
    float cross[3];               /* cross product of the middle ray's direction and the axis;
                                   * orthographic: scaled to length k */
    float sine, per_sine, cosine; /* orthographic: sine, 1 / sine and cosine of the angle between
                                   * axis and ray */
    float per_k_sine;             /* orthographic: 1 / (k sine) */
    float per_k_cosine;           /* orthographic: 1 / (k cosine) */
    uint32_t segment;             /* index of the segment in the geometry */
} TileTerm;

/* A tile: its terms, the workspace for them, and the positions of its samples. */
typedef struct FieldTile {
    const TileTerm *terms; /* sorted by ascending z_begin; in the order of the list if `plane` or
                            * `any_depth` is true */
    size_t n_terms;
    LocalGroups *groups; /* workspace for finding the blend groups of the terms; NULL: all segments
                          * blend, so that all terms are added */
    bool perspective;
    bool any_depth;            /* true: the samples are points with depths of their own, as in
                                * shadow queries; `plane` is then false. false: the samples are
                                * rays */
    bool blob;                 /* true: the model is a blob, not a potential; `plane` is then
                                * false */
    bool plane;                /* true: the view is orthographic, all segments blend, and all axes
                                * are in one plane perpendicular to the rays */
    const float *x, *y;        /* per sample: position relative to the middle ray: mm, or, in
                                * perspective, mm at z = 1 */
    double middle_x, middle_y; /* position of the middle ray, in the same unit */
    float half_size;           /* largest distance of a sample from the middle ray */
    double z_min;              /* lower bound of z of hits; with any_depth, of the samples */
} FieldTile;

/* Makes one term for each of the n listed segments that is within reach of a ray of the tile. Sets
 * `terms`, `n_terms` and `plane` of the tile; the caller has set its other fields. If no segment is
 * within reach, n_terms is 0.
 *
 * terms   has space for n terms; tile->terms becomes this array.
 * kept    has space for n indices; receives the indices of the segments that have terms. They are
 *         in the order of `list`, while `terms` may be sorted differently. */
void fieldterms_make(const FrameSegment *segments, const uint32_t *list, size_t n, FieldTile *tile,
                     TileTerm *terms, uint32_t *kept);

/* Prefetches into the cache the segments that fieldterms_make will read. Has no other effect. */
void fieldterms_fetch(const FrameSegment *segments, const uint32_t *list, size_t n);

/* Size of a kernel's workspace, in bytes per term. It suffices for the kernel with the most lanes;
 * kernel_packet.h and kernel_trace_flat.h check this at compile time. */
enum { TILE_WORK_BYTES = 2176 };

#endif
