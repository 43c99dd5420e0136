/* The kernels for any processor, and the choice among all. */
#define BEAM_KERNEL(name) name##_portable
#include "render/sky/kernel_beam.h"

const BeamKernels *const beamkernels[] = {
    &beamkernels_portable,
#ifdef __x86_64__
    &beamkernels_avx2,
    &beamkernels_avx512,
#endif
};
