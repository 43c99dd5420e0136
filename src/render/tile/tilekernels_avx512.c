/* The kernels for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define FIELD_KERNEL trace_avx512
#define PLANE_KERNEL trace_plane_avx512
#define SHADE_KERNEL shade_avx512
#define ENCODE_KERNEL encode_avx512
#include "render/field/kernel_trace.h"
#include "render/tile/kernel_shade.h"

const TileKernels tilekernels_avx512 = {trace_avx512, shade_avx512, encode_avx512};

#else
typedef int NotForThisProcessor;
#endif
