/* The kernels for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define TILE_KERNEL(name) name##_avx2
#include "render/tile/kernel_shade.h"

#else
typedef int NotForThisProcessor;
#endif
