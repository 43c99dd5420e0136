/* The kernels of the potential, and the choice between them and those of the blob. */
#define FIELD_KERNEL LANES_NAME(trace)
#define PLANE_KERNEL LANES_NAME(trace_plane)
#define SHADOW_KERNEL LANES_NAME(shadow)
#include "render/field/fieldkernels.h"
#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

#ifdef LANES_PORTABLE
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
#endif
