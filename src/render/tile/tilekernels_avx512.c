/* The kernels for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define SHADE_KERNEL shade_avx512
#define ENCODE_KERNEL encode_avx512
#include "render/tile/kernel_shade.h"

const TileKernels tilekernels_avx512 = {shade_avx512, encode_avx512};

#else
typedef int NotForThisProcessor;
#endif
