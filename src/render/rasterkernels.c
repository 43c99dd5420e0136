/* The kernels for any processor, and the choice among all. */
#define RASTER_KERNEL(name) name##_portable
#include "render/rasterkernel.h"

#include "render/rastercover.h"

const RasterKernels rasterkernels_portable = {trace_portable, resolve_portable, clear_portable,
                                              paint_portable, locate_portable,  face_portable,
                                              aim_portable,   within_portable,  cover_portable};

int rasterkernels_usable(const RasterKernels *kernels[KINDS_OF_KERNELS])
{
    int n = 0;
#ifdef __x86_64__
    if (LANES_AVX512_RUN)
        kernels[n++] = &rasterkernels_avx512;
    if (LANES_AVX2_RUN)
        kernels[n++] = &rasterkernels_avx2;
#endif
    kernels[n++] = &rasterkernels_portable;
    return n;
}

const RasterKernels *rasterkernels_best(void)
{
    const RasterKernels *kernels[KINDS_OF_KERNELS];
    rasterkernels_usable(kernels);
    return kernels[0];
}
