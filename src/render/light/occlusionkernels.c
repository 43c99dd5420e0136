/* Compiles the kernels of ambient occlusion for one instruction set, and allocates the memory that
 * they work on. The build compiles this file once per instruction set; the memory belongs to the
 * portable one (LANES_PORTABLE). */
#include "render/light/kernel_occlusion.h"

#include <stdlib.h>

#ifdef LANES_PORTABLE

const OcclusionKernels *const occlusionkernels[] = {EACH_KIND(occlusionkernels)};

Status occlusionpoints_new(size_t n, OcclusionPoints *points, Err *err)
{
    const size_t padded = n + OCCLUDER_BLOCK; /* kernels read whole blocks */
    TRY(mem_calloc(&points->memory, 7 * padded, sizeof *points->memory, "occlusion", err));
    points->n = (uint32_t)n;
    for (size_t c = 0; c < 3; c++) {
        points->position[c] = points->memory + c * padded;
        points->normal[c] = points->memory + (3 + c) * padded;
    }
    points->ground_side = points->memory + 6 * padded;
    return STATUS_OK;
}

void occlusionpoints_release(OcclusionPoints *points)
{
    free(points->memory);
}

Status conescratch_new(size_t n, ConeScratch *scratch, Err *err)
{
    size_t groups = n / OCCLUDER_BLOCK + 1;
    TRY(mem_alloc(&scratch->ends, CONE_MAX_CELLS, sizeof *scratch->ends, "occlusion", err));
    TRY(mem_alloc(&scratch->slot, n, sizeof *scratch->slot, "occlusion", err));
    TRY(mem_alloc(&scratch->listed, groups, sizeof *scratch->listed, "occlusion", err));
    return mem_alloc(&scratch->sorted, groups + CONE_MAX_SQUARES, sizeof *scratch->sorted,
                     "occlusion", err);
}

void conescratch_release(ConeScratch *scratch)
{
    free(scratch->ends);
    free(scratch->slot);
    free(scratch->listed);
    free(scratch->sorted);
}

#endif
