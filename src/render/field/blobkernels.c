/* The kernels of the blob. */
#define FIELD_KERNEL LANES_NAME(trace_blob)
#define SHADOW_KERNEL LANES_NAME(shadow_blob)
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

#ifdef LANES_PORTABLE
const FieldKernels blobkernels[] = {
    {trace_blob_portable, shadow_blob_portable},
#ifdef __x86_64__
    {trace_blob_avx2, shadow_blob_avx2},
    {trace_blob_avx512, shadow_blob_avx512},
#endif
};
#endif
