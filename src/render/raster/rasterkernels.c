/* The kernels for any processor, and the choice among all. */
#define RASTER_KERNEL(name) name##_portable
#include "render/raster/kernel_light.h"

const RasterKernels *const rasterkernels[] = {
    &rasterkernels_portable,
#ifdef __x86_64__
    &rasterkernels_avx2,
    &rasterkernels_avx512,
#endif
};
