/* The kernels for any processor, and the choice among all. */
#define OCCLUSION_KERNEL(name) LANES_NAME(name)
#include "render/light/kernel_occlusion.h"

#include <stdlib.h>

#ifdef LANES_PORTABLE

const OcclusionKernels *const occlusionkernels[] = {
    &occlusionkernels_portable,
#ifdef __x86_64__
    &occlusionkernels_avx2,
    &occlusionkernels_avx512,
#endif
};

Status occlusionpoints_new(size_t n, OcclusionPoints *points, Err *err)
{
    points->n = (uint32_t)n;
    for (int c = 0; c < 3; c++) {
        TRY(mem_calloc(&points->at[c], n + OCCLUDER_BLOCK, sizeof(float), "occlusion", err));
        TRY(mem_calloc(&points->normal[c], n + OCCLUDER_BLOCK, sizeof(float), "occlusion", err));
    }
    return mem_calloc(&points->above, n + OCCLUDER_BLOCK, sizeof(float), "occlusion", err);
}

void occlusionpoints_release(OcclusionPoints *points)
{
    for (int c = 0; c < 3; c++) {
        free(points->at[c]);
        free(points->normal[c]);
    }
    free(points->above);
}

Status conescratch_new(size_t n, ConeScratch *scratch, Err *err)
{
    size_t groups = n / OCCLUDER_BLOCK + 1;
    TRY(mem_alloc(&scratch->ends, CONE_MAX_CELLS, sizeof *scratch->ends, "occlusion", err));
    TRY(mem_alloc(&scratch->at, n, sizeof *scratch->at, "occlusion", err));
    TRY(mem_alloc(&scratch->listed, groups, sizeof *scratch->listed, "occlusion", err));
    return mem_alloc(&scratch->sorted, groups + CONE_MAX_SQUARES, sizeof *scratch->sorted,
                     "occlusion", err);
}

void conescratch_release(ConeScratch *scratch)
{
    free(scratch->ends);
    free(scratch->at);
    free(scratch->listed);
    free(scratch->sorted);
}

#endif
