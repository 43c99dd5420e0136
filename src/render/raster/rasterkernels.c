/* The kernels for any processor, and the choice among all. */
#define RASTER_KERNEL(name) name##_portable
#include "render/raster/kernel_raster.h"

#include "render/raster/kernel_light.h"

static const RasterKernels portable = {trace_portable, resolve_portable, clear_portable,
                                       paint_portable, locate_portable,  face_portable,
                                       aim_portable,   within_portable,  cover_portable};

const RasterKernels *const rasterkernels[] = {
    &portable,
#ifdef __x86_64__
    &rasterkernels_avx2,
    &rasterkernels_avx512,
#endif
};
