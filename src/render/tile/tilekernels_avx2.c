/* The kernels for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define SHADE_KERNEL shade_avx2
#define ENCODE_KERNEL encode_avx2
#include "render/tile/kernel_shade.h"

const TileKernels tilekernels_avx2 = {shade_avx2, encode_avx2};

#else
typedef int NotForThisProcessor;
#endif
