/* Compiles the kernels of the blob for one instruction set. The kernels of tracing and of shadows
 * are those of the isosurface, with the terms of kernel_blob.h. */
#include "render/field/fieldkernels.h"
#include "render/field/kernel_blob.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

const FieldKernels LANES_NAME(blobkernels) = {LANES_NAME(trace), LANES_NAME(shadow)};
