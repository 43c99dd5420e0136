/* The kernels of ambient occlusion, and the memory that they work on. */
#include "render/light/kernel_occlusion.h"

#include <stdlib.h>

#ifdef LANES_PORTABLE

const OcclusionKernels *const occlusionkernels[] = {EACH_KIND(occlusionkernels)};

Status occlusionpoints_new(size_t n, OcclusionPoints *points, Err *err)
{
    const size_t room = n + OCCLUDER_BLOCK;
    TRY(mem_calloc(&points->memory, 7 * room, sizeof *points->memory, "occlusion", err));
    points->n = (uint32_t)n;
    for (size_t c = 0; c < 3; c++) {
        points->position[c] = points->memory + c * room;
        points->normal[c] = points->memory + (3 + c) * room;
    }
    points->ground_side = points->memory + 6 * room;
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
