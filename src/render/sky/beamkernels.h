/* What is done to beams several at once, in one version for each kind of processor, all of which
 * give the same bytes: nothing is fused, and sums and products have one order. */
#ifndef CORCAST_RENDER_BEAMKERNELS_H
#define CORCAST_RENDER_BEAMKERNELS_H

#include "render/sky/beams.h"
#include "render/tile/tilekernels.h"

/* Places from which beams begin. Arrays have room for a multiple of BEAM_BLOCK, and hold zeros
 * behind the last place. */
typedef struct BeamPlaces {
    uint32_t n;
    float *at[3];     /* owned, as all that follows; mm from Beams.origin */
    float *normal[3]; /* unit */
    float *above;     /* the ground: its sign; 0: the ground hides no sky */
} BeamPlaces;

/* One direction, and how beams along it are cut. */
typedef struct BeamDirection {
    float axes[3][3]; /* across, across, and towards the sky */
    float widening;   /* the most that half a beam's width grows with its length */
    float ground;     /* the direction's cosine to the ground's normal */
} BeamDirection;

/* The capsules as one direction sees them: x and y across it, z along it, mm. */
typedef struct SeenBlock {
    float x[BEAM_BLOCK], y[BEAM_BLOCK], z[BEAM_BLOCK]; /* one end */
    float ux[BEAM_BLOCK], uy[BEAM_BLOCK];              /* unit, across the view, to the other */
    float length[BEAM_BLOCK], slope[BEAM_BLOCK];       /* across the view, and rise of z with it */
    float radius[BEAM_BLOCK];
    float round[BEAM_BLOCK]; /* what its ends add to it where a beam is wider than it is */
} SeenBlock;

/* Beams of one direction, as it sees them; those that are asked for, and the same sorted into the
 * cells of a grid. */
typedef struct BeamList {
    float *x, *y, *z, *widening; /* owned, as all that follows; where each begins; of half its width
                                    with length */
    uint32_t *place, *cell;
} BeamList;

/* What one thread asks with. */
typedef struct BeamWork {
    SeenBlock seen; /* a block of capsules */
    BeamList listed, sorted;
    float *free;     /* owned; of the sorted beams, what capsules leave of each */
    uint32_t *first; /* owned; sorted beam of each cell, row by row, and behind the last */
    int columns, rows;
    float low[3], high[3], per_cell; /* between what the beams begin */
    uint32_t n;
} BeamWork;

enum { BEAM_MOST_CELLS = 512 }; /* on a side of the grid */

/* Make room for n places, to be set, or for asking about at most so many. *places and *work are the
 * caller's even when these fail. STATUS_MEMORY. */
MUST_CHECK Status beamplaces_new(size_t n, BeamPlaces *places, Err *err);
void beamplaces_release(BeamPlaces *places);
MUST_CHECK Status beamwork_new(size_t n, BeamWork *work, Err *err);
void beamwork_release(BeamWork *work);

/* An answer is the part of a beam that is free, times BEAM_FREE; or, of a beam that leads into the
 * surface, BEAM_UNASKED. */
enum { BEAM_FREE = 254, BEAM_UNASKED = 255 };
/* Answers to one place are padded to multiples of this with BEAM_UNASKED. */
enum { SUMMED = 16 };

typedef struct BeamKernels {
    /* Sets answers[i] for each place i, of which there is one at least. */
    void (*ask)(const Beams *beams, const BeamDirection *direction, const BeamPlaces *places,
                BeamWork *work, uint8_t *answers);
    /* Adds to asked[n] `weight` where there is an answer, and to free[n] the answer as often. n is
     * a multiple of SUMMED. */
    void (*add)(const uint8_t *answers, int n, int weight, uint16_t *free, uint16_t *asked);
    /* The mean of such sums of answers in n directions, given by coordinate, by the cosines to a
     * normal that are positive: the part that is free, from 0 to 1. */
    float (*mean)(const float *const directions[3], const float normal[3], const uint16_t *free,
                  const uint16_t *asked, int n);
} BeamKernels;

extern const BeamKernels beamkernels_portable;
#ifdef __x86_64__
extern const BeamKernels beamkernels_avx2, beamkernels_avx512;
#endif
/* As tilekernels. */
extern const BeamKernels *const beamkernels[KINDS_OF_KERNELS];

#endif
