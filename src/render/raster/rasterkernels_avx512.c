/* The kernels for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define RASTER_KERNEL(name) name##_avx512
#include "render/raster/kernel_raster.h"

#include "render/raster/kernel_light.h"

const RasterKernels rasterkernels_avx512 = {trace_avx512, resolve_avx512, clear_avx512,
                                            paint_avx512, locate_avx512,  face_avx512,
                                            aim_avx512,   within_avx512,  cover_avx512};

#else
typedef int NotForThisProcessor;
#endif
