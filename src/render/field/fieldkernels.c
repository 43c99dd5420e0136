/* The kernel for any processor, and all that there are. */
#define FIELD_KERNEL trace_portable
#define PLANE_KERNEL trace_plane_portable
#define SHADOW_KERNEL shadow_portable
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

FieldKernel *const fieldkernels[] = {
    trace_portable,
#ifdef __x86_64__
    trace_avx2,
    trace_avx512,
#endif
};

ShadowKernel *const shadowkernels[] = {
    shadow_portable,
#ifdef __x86_64__
    shadow_avx2,
    shadow_avx512,
#endif
};
