/* Kernels of ambient occlusion. A cone begins as a line at a shading point and widens along an
 * occlusion direction. Kernels work on several cones at once. There is one version for each kind of
 * processor. All give the same bytes: nothing is fused, and sums and products have one order. */
#ifndef CORCAST_RENDER_LIGHT_OCCLUSIONKERNELS_H
#define CORCAST_RENDER_LIGHT_OCCLUSIONKERNELS_H

#include "render/light/occlusion.h"
#include "render/tile/tilekernels.h"

/* Shading points at which cones begin. Arrays have room for a multiple of OCCLUDER_BLOCK, and hold
 * zeros behind the last point. They are parts of one block of memory. */
typedef struct OcclusionPoints {
    uint32_t n;
    float *memory;    /* owned */
    float *at[3];     /* mm, relative to OccluderSet.origin */
    float *normal[3]; /* unit */
    float *above;     /* +1 above the ground, -1 below it; 0: the ground blocks no light */
} OcclusionPoints;

/* A line through all shading points. Each point begins one cone: along the direction if its normal
 * faces it, against it otherwise. */
typedef struct OcclusionDirection {
    float axes[3][3]; /* orthonormal: two across the direction, and the direction */
    float widening;   /* largest growth of half a cone's width per length */
    float ground;     /* cosine of the direction to the ground's normal */
} OcclusionDirection;

/* A block of capsules projected along the direction: x and y across it, z along it, mm. */
typedef struct ProjectedBlock {
    float x[OCCLUDER_BLOCK], y[OCCLUDER_BLOCK], z[OCCLUDER_BLOCK]; /* the middle */
    float ux[OCCLUDER_BLOCK], uy[OCCLUDER_BLOCK];                  /* projected axis, unit */
    float half[OCCLUDER_BLOCK];                                    /* half the projected length */
    float slope[OCCLUDER_BLOCK]; /* growth of z along the projected axis */
    float radius[OCCLUDER_BLOCK];
    float round[OCCLUDER_BLOCK]; /* length that the round ends add to `half` for cones wider than
                                  * the radius */
    /* The cones that a capsule touches begin in a rectangle about it, turned like it. The rectangle
     * lies in [low, high] in y and within reach_x of the middle in x. It is the intersection of two
     * strips, one along the axis and one across it. In a row of the grid at y, mm from the middle,
     * strip i lies within reach[i] of x = lean[i] y. */
    float low[OCCLUDER_BLOCK], high[OCCLUDER_BLOCK];
    float lean[2][OCCLUDER_BLOCK], reach[2][OCCLUDER_BLOCK];
    float reach_x[OCCLUDER_BLOCK];
} ProjectedBlock;

/* Cones of one line, projected along its direction. */
typedef struct ConeGroup {
    float x[OCCLUDER_BLOCK], y[OCCLUDER_BLOCK], z[OCCLUDER_BLOCK]; /* where each begins */
    float widening[OCCLUDER_BLOCK]; /* growth of half the width with z: negative if the cone points
                                     * against the direction; 0: the cone fills up its group */
    float free[OCCLUDER_BLOCK];     /* fraction of the cone that is not blocked so far, 0..1 */
} ConeGroup;

/* The workspace of one thread. Cones are sorted into the cells of a grid across the direction. Each
 * row of the grid begins with a new group. All arrays are owned. */
typedef struct ConeScratch {
    ProjectedBlock projected;   /* present block of capsules */
    ConeGroup *listed, *sorted; /* by shading point, and by cell */
    uint32_t *at;   /* per listed cone: its cell, then its index among the sorted cones */
    uint32_t *ends; /* row by row: where the row begins, and the end of each of its cells */
    int columns, rows;
    float low[2], high[2]; /* bounds of the beginnings of the cones */
    float per_row, per_column;
} ConeScratch;

/* Squares on a side of the grid, which are divided into cells, and cells in all. */
enum { CONE_MAX_SQUARES = 512, CONE_MAX_CELLS = 1 << 20 };

/* Allocates n points, to be set. Release them even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status occlusionpoints_new(size_t n, OcclusionPoints *points, Err *err);
void occlusionpoints_release(OcclusionPoints *points);
/* Allocates the workspace for up to n points. Release it even after an error. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status conescratch_new(size_t n, ConeScratch *scratch, Err *err);
void conescratch_release(ConeScratch *scratch);

/* The result for a cone in one byte: its free fraction times CONE_CLEAR, plus CONE_BACKWARD if the
 * cone points against the direction. */
enum { CONE_CLEAR = 127, CONE_BACKWARD = 128 };
/* The answers for one point are padded to a multiple of this. */
enum { ANSWER_STEP = 16 };

/* Unit directions of lines, by coordinate; zeros for lines that pad the answers. */
typedef struct OcclusionLines {
    float *towards[3]; /* `n` numbers each, in one block of memory; owned */
    int n;             /* a multiple of ANSWER_STEP */
} OcclusionLines;

/* The answers for the same lines at the points of a quad, 2 x 2 pixels, and of the quads about it.
 */
enum { QUAD_SIDE = 2, QUAD = QUAD_SIDE * QUAD_SIDE, QUADS_ABOUT = 9 };
typedef struct QuadAnswers {
    const uint8_t *of[QUADS_ABOUT * QUAD]; /* per point: its answers */
    uint8_t quad[QUADS_ABOUT * QUAD];      /* per point: its quad, row by row of the nine quads */
    int n;                                 /* number of points */
} QuadAnswers;

typedef struct OcclusionKernels {
    /* Sets answers[i] for the cone of each point i. There must be at least one point. */
    void (*trace)(const OccluderSet *occluders, const OcclusionDirection *direction,
                  const OcclusionPoints *points, ConeScratch *scratch, uint8_t *answers);
    /* Returns the ambient visibility, 0..1, about the normal of a pixel of a quad. For each line
     * takes the mean of the answers for the end that the normal faces, weighted by the distance
     * from the pixel to the quads. Then takes the mean over the lines, weighted by their cosines to
     * the normal. Returns 1 if there are no answers. answers[i] belongs to lines[i]. */
    float (*ambient)(const OcclusionLines *lines, const QuadAnswers *answers, int n, int pixel,
                     const float normal[3]);
} OcclusionKernels;

DECLARE_KERNELS(OcclusionKernels, occlusionkernels);
/* One entry per instruction set, in the order of tilekernels [tilekernels.h]. */
extern const OcclusionKernels *const occlusionkernels[KINDS_OF_KERNELS];

#endif
