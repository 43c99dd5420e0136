/* The kernels of the blob. */
#include "render/field/fieldkernels.h"
#include "render/field/kernel_blob.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

const FieldKernels LANES_NAME(blobkernels) = {LANES_NAME(trace), LANES_NAME(shadow)};
