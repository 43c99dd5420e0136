/* The kernels of the potential for any processor, all that there are, and the choice. */
#define FIELD_KERNEL trace_portable
#define PLANE_KERNEL trace_plane_portable
#define SHADOW_KERNEL shadow_portable
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

const FieldKernels potentialkernels[] = {
    {trace_portable, shadow_portable},
#ifdef __x86_64__
    {trace_avx2, shadow_avx2},
    {trace_avx512, shadow_avx512},
#endif
};

const FieldKernels *fieldkernels_for(const Geometry *geometry, RenderKernels kernels)
{
    const FieldKernels *all =
        model_has(geometry->model, MODEL_BLOB) ? blobkernels : potentialkernels;
    return &all[kernels_kind(kernels)];
}
