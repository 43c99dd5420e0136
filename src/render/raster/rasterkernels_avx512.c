/* The kernels for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define RASTER_KERNEL(name) name##_avx512
#include "render/raster/kernel_light.h"

#else
typedef int NotForThisProcessor;
#endif
