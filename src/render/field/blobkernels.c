/* The kernels of the blob for any processor, and all that there are. */
#define FIELD_KERNEL trace_blob_portable
#define SHADOW_KERNEL shadow_blob_portable
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

const FieldKernels blobkernels[] = {
    {trace_blob_portable, shadow_blob_portable},
#ifdef __x86_64__
    {trace_blob_avx2, shadow_blob_avx2},
    {trace_blob_avx512, shadow_blob_avx512},
#endif
};
