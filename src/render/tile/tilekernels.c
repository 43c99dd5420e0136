/* Compiles the shading kernels of tiles for one instruction set, and chooses among the sets that
 * the processor supports. The build compiles this file once per instruction set; the choice belongs
 * to the portable one (LANES_PORTABLE). */
#include "render/tile/kernel_shade.h"

#ifdef LANES_PORTABLE

const TileKernels *const tilekernels[] = {EACH_KIND(tilekernels)};

int kernels_usable(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                       __builtin_cpu_supports("avx512vl")
                   ? 3
                   : 2;
#endif
    return 1;
}

int kernels_kind(RenderKernels kernels)
{
    return kernels == KERNELS_FASTEST ? kernels_usable() - 1 : (int)kernels - KERNELS_PORTABLE;
}

#endif
