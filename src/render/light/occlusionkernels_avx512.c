/* The kernels for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define OCCLUSION_KERNEL(name) name##_avx512
#include "render/light/kernel_occlusion.h"

#else
typedef int NotForThisProcessor;
#endif
