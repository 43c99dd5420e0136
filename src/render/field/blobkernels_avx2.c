/* The kernels of the blob for x86 processors with AVX2 and FMA. */
#ifdef __x86_64__

#define LANES_AVX2
#define FIELD_KERNEL trace_blob_avx2
#define SHADOW_KERNEL shadow_blob_avx2
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

#else
typedef int NotForThisProcessor;
#endif
