/* Compiles the kernels of primitives for one instruction set. The build compiles this file once per
 * instruction set. */
#include "render/raster/kernel_light.h"

#ifdef LANES_PORTABLE
const RasterKernels *const rasterkernels[] = {EACH_KIND(rasterkernels)};
#endif
