/* What is done to beams several at once, in one version for each kind of processor, all of which
 * give the same bytes: nothing is fused, and sums have one order. */
#ifndef CORCAST_RENDER_BEAMKERNELS_H
#define CORCAST_RENDER_BEAMKERNELS_H

#include "render/sky/beams.h"
#include "render/tile/tilekernels.h"

enum { BEAMS_AT_ONCE = 512 };

/* Beams of one direction, which begin at places relative to Beams.origin. */
typedef struct BeamQueries {
    int n;
    float at[3][BEAMS_AT_ONCE];
    float widening[BEAMS_AT_ONCE]; /* of half their width with length */
    float open[BEAMS_AT_ONCE];     /* the answer: the part of the beam that is free, 0 to 1 */
} BeamQueries;

/* An answer is the part of a beam that is free, times BEAM_FREE; or, of a beam that leads into the
 * surface, BEAM_UNASKED. */
enum { BEAM_FREE = 254, BEAM_UNASKED = 255 };
/* Answers to one place are padded to multiples of this with BEAM_UNASKED. */
enum { SUMMED = 16 };

typedef struct BeamKernels {
    /* Sets queries->open; beams widen to half a width of `wide` mm. */
    void (*open)(const BeamView *view, float wide, BeamQueries *queries);
    /* Sets cosines[n] of n directions, given by coordinate, to a normal. */
    void (*cosines)(const float *const directions[3], const float normal[3], int n, float *cosines);
    /* Adds to sums[1] `part` times the sum of those of n cosines, a multiple of SUMMED, that are
     * positive and have an answer, and to sums[0] that of their products with the answers. */
    void (*sum)(const float *cosines, const uint8_t *answers, int n, float part, float sums[2]);
} BeamKernels;

extern const BeamKernels beamkernels_portable;
#ifdef __x86_64__
extern const BeamKernels beamkernels_avx2, beamkernels_avx512;
#endif
/* As tilekernels. */
extern const BeamKernels *const beamkernels[KINDS_OF_KERNELS];

#endif
