/* The kernels for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define RASTER_KERNEL(name) name##_avx2
#include "render/raster/kernel_raster.h"

#include "render/raster/kernel_light.h"

const RasterKernels rasterkernels_avx2 = {trace_avx2, resolve_avx2, clear_avx2,
                                          paint_avx2, locate_avx2,  face_avx2,
                                          aim_avx2,   within_avx2,  cover_avx2};

#else
typedef int NotForThisProcessor;
#endif
