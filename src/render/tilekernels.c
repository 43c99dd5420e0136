/* The kernels for any processor, and the choice among all. */
#define FIELD_KERNEL trace_portable
#define PLANE_KERNEL trace_plane_portable
#define SHADE_KERNEL shade_portable
#define ENCODE_KERNEL encode_portable
#include "render/fieldkernel.h"
#include "render/shadekernel.h"

const TileKernels tilekernels_portable = {trace_portable, shade_portable, encode_portable};

int tilekernels_usable(const TileKernels *kernels[KINDS_OF_KERNELS])
{
    int n = 0;
#ifdef __x86_64__
    if (LANES_AVX512_RUN)
        kernels[n++] = &tilekernels_avx512;
    if (LANES_AVX2_RUN)
        kernels[n++] = &tilekernels_avx2;
#endif
    kernels[n++] = &tilekernels_portable;
    return n;
}

const TileKernels *tilekernels_best(void)
{
    const TileKernels *kernels[KINDS_OF_KERNELS];
    tilekernels_usable(kernels);
    return kernels[0];
}
