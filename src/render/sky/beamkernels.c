/* The kernels for any processor, and the choice among all. */
#define BEAM_KERNEL(name) name##_portable
#include "render/sky/kernel_beam.h"

#include <stdlib.h>

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

static Status make_list(BeamList *list, size_t n, Err *err)
{
    float **const values[] = {&list->x, &list->y, &list->z, &list->widening, &list->free};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        TRY(mem_alloc(values[i], n + BEAM_BLOCK, sizeof(float), "occlusion", err));
    return STATUS_OK;
}

static void release_list(BeamList *list)
{
    free(list->x);
    free(list->y);
    free(list->z);
    free(list->widening);
    free(list->free);
}

Status beamwork_new(size_t n, BeamWork *work, Err *err)
{
    TRY(mem_alloc(&work->first, BEAM_MOST_CELLS + 1, sizeof *work->first, "occlusion", err));
    TRY(mem_alloc(&work->cell, n, sizeof *work->cell, "occlusion", err));
    TRY(mem_alloc(&work->place, n, sizeof *work->place, "occlusion", err));
    TRY(make_list(&work->listed, n, err));
    return make_list(&work->sorted, n, err);
}

void beamwork_release(BeamWork *work)
{
    free(work->first);
    free(work->cell);
    free(work->place);
    release_list(&work->listed);
    release_list(&work->sorted);
}
