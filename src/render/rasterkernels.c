/* The kernels for any processor, and the choice between the two. */
#define RASTER_KERNEL(name) name##_portable
#include "render/rasterkernel.h"

#include "render/rastercover.h"

const RasterKernels rasterkernels_portable = {trace_portable, resolve_portable, clear_portable,
                                              paint_portable, locate_portable,  face_portable,
                                              aim_portable,   cover_portable};

const RasterKernels *rasterkernels_best(void)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return &rasterkernels_avx2;
#endif
    return &rasterkernels_portable;
}
