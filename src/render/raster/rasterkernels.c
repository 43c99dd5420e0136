/* The kernels of primitives. */
#include "render/raster/kernel_light.h"

#ifdef LANES_PORTABLE
const RasterKernels *const rasterkernels[] = {EACH_KIND(rasterkernels)};
#endif
