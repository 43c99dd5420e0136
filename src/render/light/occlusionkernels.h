/* Kernels of ambient occlusion. A set of shading points traces cones along a set of lines, one cone
 * per point and line. The apex of a cone is the point. Its axis is the one of the line's two
 * directions that is on the side of the point's normal. For one line, `trace` computes which
 * fraction of the cone at each point the capsules of an OccluderSet leave unblocked. The caller
 * runs `trace` for all lines and stores one byte per cone, an answer. `ambient` then computes the
 * ambient visibility of a pixel from the answers of the shading points around it. occlusion.c
 * chooses lines and points.
 *
 * There is one version of the kernels per instruction set. All versions give the same bytes: they
 * use no fused multiply-add, and compute sums and products in the same order. */
#ifndef CORCAST_RENDER_LIGHT_OCCLUSIONKERNELS_H
#define CORCAST_RENDER_LIGHT_OCCLUSIONKERNELS_H

#include "render/light/occlusion.h"
#include "render/tile/tilekernels.h"

/* The shading points, which are the apexes of the cones. The arrays have space for n rounded up to
 * a multiple of OCCLUDER_BLOCK, and are 0 past the last point. They are parts of one block of
 * memory. */
typedef struct OcclusionPoints {
    uint32_t n;
    float *memory;      /* owned */
    float *position[3]; /* mm, relative to OccluderSet.origin */
    float *normal[3];   /* unit */
    float *ground_side; /* +1 above the ground plane, -1 below it; 0: the ground blocks no light */
} OcclusionPoints;

/* One line, given by its upward direction. If a shading point's normal has a positive component
 * along this direction, the point's cone is along it; otherwise it is along the opposite one. */
typedef struct OcclusionLine {
    float axes[3][3];    /* orthonormal: two axes perpendicular to the direction, and the
                          * direction */
    float widening;      /* upper bound of |ConeGroup.widening| */
    float ground_cosine; /* cosine of the angle between the direction and the ground's normal */
} OcclusionLine;

/* OCCLUDER_BLOCK capsules projected along the direction. x and y are perpendicular to the
 * direction, z is along it, in mm. */
typedef struct ProjectedBlock {
    float x[OCCLUDER_BLOCK], y[OCCLUDER_BLOCK], z[OCCLUDER_BLOCK]; /* the capsule's centre */
    float ux[OCCLUDER_BLOCK], uy[OCCLUDER_BLOCK];                  /* projected axis, unit */
    float half[OCCLUDER_BLOCK];  /* half the length of the projected axis */
    float slope[OCCLUDER_BLOCK]; /* increase of z per mm along the projected axis */
    float radius[OCCLUDER_BLOCK];
    float round[OCCLUDER_BLOCK]; /* length that each round end adds to `half`, mm, for cones whose
                                  * half width is at least `radius`. A narrower cone, whose axis
                                  * passes the projected axis at the distance t, uses sqrt(radius^2
                                  * - t^2) instead */
    /* A capsule can block only the cones whose apexes are in a rectangle around the projected
     * capsule, with sides along and perpendicular to the projected axis. The bounding box of the
     * rectangle is low <= y <= high and |x - centre's x| <= reach_x. The rectangle is the
     * intersection of two strips. With x and y relative to the centre, strip i covers
     * |x - y lean[i]| <= reach[i] in the row of the grid whose middle is at y; lean is dx/dy along
     * the strip. */
    float low[OCCLUDER_BLOCK], high[OCCLUDER_BLOCK];
    float lean[2][OCCLUDER_BLOCK], reach[2][OCCLUDER_BLOCK];
    float reach_x[OCCLUDER_BLOCK];
} ProjectedBlock;

/* OCCLUDER_BLOCK cones of one line, projected along its upward direction. */
typedef struct ConeGroup {
    float x[OCCLUDER_BLOCK], y[OCCLUDER_BLOCK], z[OCCLUDER_BLOCK]; /* apex, mm */
    /* increase of the cone's half width per mm of z; negative if the cone points downwards; 0:
     * padding, not a cone */
    float widening[OCCLUDER_BLOCK];
    /* fraction of the cone that no capsule has blocked yet, 0..1 */
    float unblocked[OCCLUDER_BLOCK];
} ConeGroup;

/* The workspace of one thread. Cones are sorted by their apexes into the cells of a grid that is
 * perpendicular to the direction. Each row of the grid begins with a new ConeGroup. All arrays are
 * owned. */
typedef struct ConeScratch {
    ProjectedBlock projected;   /* the block of capsules that is being processed */
    ConeGroup *listed, *sorted; /* `listed`: the cones in the order of the shading points; `sorted`:
                                 * the cones sorted by cell */
    uint32_t *slot;             /* per listed cone: its index in `sorted`. While cones are counted:
                                 * the index of its cell in `ends` */
    uint32_t *ends;             /* per row of the grid, columns + 1 numbers: the index of the row's
                                 * first sorted cone; then, per cell, the index past its last */
    int columns, rows;
    float low[2], high[2]; /* bounds of x and y of the apexes */
    float rows_per_mm, columns_per_mm;
} ConeScratch;

/* The grid has at most CONE_MAX_SQUARES x CONE_MAX_SQUARES squares; a larger scene gets larger
 * squares. Each square is divided into 4 cells along x. A row has at most 4 * 511 + 1 cells, so
 * CONE_MAX_CELLS is an upper bound of the number of elements of ConeScratch.ends: 4 MB per
 * thread. */
enum { CONE_MAX_SQUARES = 512, CONE_MAX_CELLS = 1 << 20 };

/* Allocates n zeroed points, whose values the caller sets. The caller releases `points` even after
 * an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status occlusionpoints_new(size_t n, OcclusionPoints *points, Err *err);
void occlusionpoints_release(OcclusionPoints *points);
/* Allocates the workspace for up to n points. *scratch must be zeroed; the caller releases it even
 * after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status conescratch_new(size_t n, ConeScratch *scratch, Err *err);
void conescratch_release(ConeScratch *scratch);

/* An answer is the result for one cone in one byte: the unblocked fraction times CONE_UNBLOCKED (7
 * bits), plus CONE_BACKWARD (the eighth bit) if the cone points downwards. */
enum { CONE_UNBLOCKED = 127, CONE_BACKWARD = 128 };
/* The number of answers per shading point is padded to a multiple of ANSWER_STEP, the maximum
 * number of lanes of a kernel. `trace` writes the answers of one line for all points; the caller
 * transposes them to the answers of one point for all lines, as `ambient` reads them. */
enum { ANSWER_STEP = 16 };

/* A set of lines, given by the unit vectors of their upward directions. Padding lines have the
 * vector (0, 0, 0). */
typedef struct OcclusionLines {
    float *upward[3]; /* x, y and z: n numbers each, in one block of memory; owned */
    int n;            /* a multiple of ANSWER_STEP */
} OcclusionLines;

/* The answers for one set of lines at the shading points of a quad and of its 8 neighbours. A quad
 * is a square of 2 x 2 pixels. */
enum { QUAD_SIDE = 2, QUAD = QUAD_SIDE * QUAD_SIDE, QUADS_AROUND = 9 };
typedef struct QuadAnswers {
    const uint8_t *of[QUADS_AROUND * QUAD]; /* per shading point: one answer per line; borrowed */
    uint8_t quad[QUADS_AROUND * QUAD];      /* per shading point: its quad, 0..8, row by row; the
                                             * quad in the middle is 4 */
    int n;                                  /* number of shading points */
} QuadAnswers;

/* The kernels for one instruction set. */
typedef struct OcclusionKernels {
    /* Sets answers[i] to the answer for the cone of point i, for all points->n >= 1 points. */
    void (*trace)(const OccluderSet *occluders, const OcclusionLine *direction,
                  const OcclusionPoints *points, ConeScratch *scratch, uint8_t *answers);
    /* Returns the ambient visibility, 0 to 1, of a pixel with the unit normal `normal`.
     *
     * For each line, averages those answers whose cone is on the side of the normal; answers of
     * nearer quads have larger weights. Then averages over all lines, weighted by the cosine
     * between line and normal. Returns 1 if no line has an answer on the side of the normal.
     *
     * lines, answers   n sets of lines and n sets of answers; answers[i] belongs to lines[i].
     * pixel            index of the pixel in the middle quad, 0..3, row by row. */
    float (*ambient)(const OcclusionLines *lines, const QuadAnswers *answers, int n, int pixel,
                     const float normal[3]);
} OcclusionKernels;

DECLARE_KERNELS(OcclusionKernels, occlusionkernels);
/* One entry per instruction set, in the order of tilekernels [tilekernels.h]. */
extern const OcclusionKernels *const occlusionkernels[KINDS_OF_KERNELS];

#endif
