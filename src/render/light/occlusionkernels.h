/* What is done to beams several at once, in one version for each kind of processor, all of which
 * give the same bytes: nothing is fused, and sums and products have one order. */
#ifndef CORCAST_RENDER_OCCLUSIONKERNELS_H
#define CORCAST_RENDER_OCCLUSIONKERNELS_H

#include "render/light/occluders.h"
#include "render/tile/tilekernels.h"

/* Places from which beams begin. Arrays have room for a multiple of BEAM_BLOCK, and hold zeros
 * behind the last place. */
typedef struct BeamPlaces {
    uint32_t n;
    float *at[3];     /* owned, as all that follows; mm from OccluderSet.origin */
    float *normal[3]; /* unit */
    float *above;     /* the ground: its sign; 0: the ground hides no sky */
} BeamPlaces;

/* The direction of the parallel lines through all places, and how wide beams along them are. */
typedef struct BeamDirection {
    float axes[3][3]; /* across, across, and the direction */
    float widening;   /* the most that half a beam's width grows with its length */
    float ground;     /* the direction's cosine to the ground's normal */
} BeamDirection;

/* The capsules as one direction sees them: x and y across it, z along it, mm. */
typedef struct SeenBlock {
    float x[BEAM_BLOCK], y[BEAM_BLOCK], z[BEAM_BLOCK]; /* the middle */
    float ux[BEAM_BLOCK], uy[BEAM_BLOCK];              /* the axis: unit, across the view */
    float half[BEAM_BLOCK], slope[BEAM_BLOCK]; /* half its length across the view, and the rise of
                                                * z with that */
    float radius[BEAM_BLOCK];
    float round[BEAM_BLOCK]; /* what its ends add to it where a beam is wider than it is */
    /* The beams that it touches begin in a rectangle about it, turned as it is. That lies between
     * `low` and `high` in y and within reach_x of the middle in x, and is what two strips have in
     * common: one along the axis, one across it. In a row of the grid at y, mm from the middle,
     * strip i lies within reach[i] of x = lean[i] y. */
    float low[BEAM_BLOCK], high[BEAM_BLOCK];
    float lean[2][BEAM_BLOCK], reach[2][BEAM_BLOCK];
    float reach_x[BEAM_BLOCK];
} SeenBlock;

/* OccluderSet of one line, as its direction sees them. */
typedef struct BeamGroup {
    float x[BEAM_BLOCK], y[BEAM_BLOCK], z[BEAM_BLOCK]; /* where each begins */
    float widening[BEAM_BLOCK]; /* of half its width with z: below 0 of what leads against the
                                 * direction, 0 of one that fills up its group */
    float free[BEAM_BLOCK];     /* what is left of each */
} BeamGroup;

/* What one thread asks with. Each row of the grid begins with a group. */
typedef struct BeamWork {
    SeenBlock seen;             /* a block of capsules */
    BeamGroup *listed, *sorted; /* owned, as all that follows; by place, and by cell of a grid
                                 * across the direction */
    uint32_t *at;               /* of each listed beam its cell, then its number among the sorted */
    uint32_t *ends;             /* row by row, where the row begins, and the end of each cell */
    int columns, rows;
    float low[2], high[2], per_row, per_column; /* between what the beams begin */
} BeamWork;

/* Squares on a side of the grid, which are parted into cells, and cells in all. */
enum { BEAM_MOST_SQUARES = 512, BEAM_MOST_CELLS = 1 << 20 };

/* Make room for n places, to be set, or for asking about at most so many. *places and *work are the
 * caller's even when these fail. STATUS_MEMORY. */
MUST_CHECK Status beamplaces_new(size_t n, BeamPlaces *places, Err *err);
void beamplaces_release(BeamPlaces *places);
MUST_CHECK Status beamwork_new(size_t n, BeamWork *work, Err *err);
void beamwork_release(BeamWork *work);

/* An answer is the part of a beam that is free, times BEAM_FREE, and BEAM_AGAINST where the beam
 * leads against the direction. */
enum { BEAM_FREE = 127, BEAM_AGAINST = 128 };
/* Answers to one place are padded to multiples of this. */
enum { SUMMED = 16 };

/* The directions of lines, unit and by coordinate, and zeros for what pads answers. */
typedef struct BeamLines {
    float *towards[3]; /* owned */
    int n;             /* a multiple of SUMMED */
} BeamLines;

/* What the askers of a quad, 2 x 2 pixels, and of the quads about it were answered about the same
 * lines. */
enum { QUAD_SIDE = 2, QUAD = QUAD_SIDE * QUAD_SIDE, QUADS_ABOUT = 9 };
typedef struct BeamAnswers {
    const uint8_t *of[QUADS_ABOUT * QUAD];
    uint8_t quad[QUADS_ABOUT * QUAD]; /* that each is of, row by row of the quads */
    int n;
} BeamAnswers;

typedef struct BeamKernels {
    /* Sets answers[i] for each place i, of which there is one at least. A place asks about the end
     * of the line that its surface faces. */
    void (*ask)(const OccluderSet *beams, const BeamDirection *direction, const BeamPlaces *places,
                BeamWork *work, uint8_t *answers);
    /* The part of the sky that is free, from 0 to 1, about the normal of a pixel of a quad: of each
     * line the mean of the answers about the end that the normal faces, by the pixel's
     * weights, and of these the mean by their cosines to the normal; 1 where there are none.
     * answers[i] is of lines[i]. */
    float (*open)(const BeamLines *lines, const BeamAnswers *answers, int n, int pixel,
                  const float normal[3]);
} BeamKernels;

extern const BeamKernels beamkernels_portable;
#ifdef __x86_64__
extern const BeamKernels beamkernels_avx2, beamkernels_avx512;
#endif
/* As tilekernels. */
extern const BeamKernels *const beamkernels[KINDS_OF_KERNELS];

#endif
