/* The kernels for any processor, and the choice between the two. */
#define FIELD_KERNEL trace_portable
#define PLANE_KERNEL trace_plane_portable
#define SHADE_KERNEL shade_portable
#include "render/fieldkernel.h"
#include "render/shadekernel.h"

const TileKernels tilekernels_portable = {trace_portable, shade_portable};

const TileKernels *tilekernels_best(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return &tilekernels_avx2;
#endif
    return &tilekernels_portable;
}
