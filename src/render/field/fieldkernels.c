/* Compiles the kernels of isosurfaces (the potential) for one instruction set, and chooses between
 * them and the kernels of the blob. The build compiles this file once per instruction set. */
#include "render/field/fieldkernels.h"
#include "render/field/kernel_potential.h"
#include "render/field/kernel_trace_flat.h"

#include "render/field/kernel_trace.h"

#include "render/field/kernel_shadow.h"

const FieldKernels LANES_NAME(potentialkernels) = {LANES_NAME(trace), LANES_NAME(shadow)};

#ifdef LANES_PORTABLE
const FieldKernels *fieldkernels_for(const Geometry *geometry, RenderKernels kernels)
{
    static const FieldKernels *const blob[] = {EACH_KIND(blobkernels)}, *const potential[] = {
                                                                            EACH_KIND(
                                                                                potentialkernels)};
    return (model_has(geometry->model, MODEL_BLOB) ? blob : potential)[kernels_kind(kernels)];
}
#endif
