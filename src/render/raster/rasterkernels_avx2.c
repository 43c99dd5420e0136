/* The kernels for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define RASTER_KERNEL(name) name##_avx2
#include "render/raster/kernel_light.h"

#else
typedef int NotForThisProcessor;
#endif
