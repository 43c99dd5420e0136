/* The kernels of the blob for x86 processors with AVX-512. */
#ifdef __x86_64__

#define LANES_AVX512
#define FIELD_KERNEL trace_blob_avx512
#define SHADOW_KERNEL shadow_blob_avx512
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

#else
typedef int NotForThisProcessor;
#endif
