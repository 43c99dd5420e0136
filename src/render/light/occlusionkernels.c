/* The kernels for any processor, and the choice among all. */
#define BEAM_KERNEL(name) LANES_NAME(name)
#include "render/light/kernel_occlusion.h"

#include <stdlib.h>

#ifdef LANES_PORTABLE

const BeamKernels *const beamkernels[] = {
    &beamkernels_portable,
#ifdef __x86_64__
    &beamkernels_avx2,
    &beamkernels_avx512,
#endif
};

Status beamplaces_new(size_t n, BeamPlaces *places, Err *err)
{
    places->n = (uint32_t)n;
    for (int c = 0; c < 3; c++) {
        TRY(mem_calloc(&places->at[c], n + BEAM_BLOCK, sizeof(float), "occlusion", err));
        TRY(mem_calloc(&places->normal[c], n + BEAM_BLOCK, sizeof(float), "occlusion", err));
    }
    return mem_calloc(&places->above, n + BEAM_BLOCK, sizeof(float), "occlusion", err);
}

void beamplaces_release(BeamPlaces *places)
{
    for (int c = 0; c < 3; c++) {
        free(places->at[c]);
        free(places->normal[c]);
    }
    free(places->above);
}

Status beamwork_new(size_t n, BeamWork *work, Err *err)
{
    size_t groups = n / BEAM_BLOCK + 1;
    TRY(mem_alloc(&work->ends, BEAM_MOST_CELLS, sizeof *work->ends, "occlusion", err));
    TRY(mem_alloc(&work->at, n, sizeof *work->at, "occlusion", err));
    TRY(mem_alloc(&work->listed, groups, sizeof *work->listed, "occlusion", err));
    return mem_alloc(&work->sorted, groups + BEAM_MOST_SQUARES, sizeof *work->sorted, "occlusion",
                     err);
}

void beamwork_release(BeamWork *work)
{
    free(work->ends);
    free(work->at);
    free(work->listed);
    free(work->sorted);
}

#endif
