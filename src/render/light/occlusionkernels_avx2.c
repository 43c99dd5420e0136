/* The kernels for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define OCCLUSION_KERNEL(name) name##_avx2
#include "render/light/kernel_occlusion.h"

#else
typedef int NotForThisProcessor;
#endif
