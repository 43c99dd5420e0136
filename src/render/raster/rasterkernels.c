/* The kernels of primitives. */
#define RASTER_KERNEL(name) LANES_NAME(name)
#include "render/raster/kernel_light.h"

#ifdef LANES_PORTABLE

const RasterKernels *const rasterkernels[] = {
    &rasterkernels_portable,
#ifdef __x86_64__
    &rasterkernels_avx2,
    &rasterkernels_avx512,
#endif
};
#endif
