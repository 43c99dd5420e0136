/* Computes the weights of FLIP's filters, in float as its authors' program. The numbers are those
 * of the paper [perception.h]. csf: contrast sensitivity function, the blur of the eye. */
#include "compare/measures/flip.h"

#include <math.h>
#include <string.h>

static const float pixels_per_degree = 67.0206451f; /* a 0.7 m wide 4K screen seen from 0.7 m */

/* Sets the weights a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees. `root` takes the root of the
 * amplitude, for one of two summed Gaussians, which is applied along both axes. Returns the sum of
 * the weights. */
static float csf_fill(FlipKernel *kernel, float a, float b, bool root)
{
    const float pi = 3.14159265358979f;
    float amplitude = a * sqrtf(pi / b), sum = 0;
    if (root)
        amplitude = sqrtf(amplitude);
    for (int i = -FLIP_RADIUS; i <= FLIP_RADIUS; i++) {
        float x = (float)i / pixels_per_degree;
        float weight = amplitude * expf(-pi * pi * x * x / b);
        kernel->weights[i + FLIP_RADIUS] = weight;
        sum += weight;
    }
    return sum;
}

static void kernel_scale(FlipKernel *kernel, float factor)
{
    for (int i = 0; i < FLIP_TAPS; i++)
        kernel->weights[i] *= factor;
}

static void csf_kernels(FlipKernel kernels[FLIP_FILTERS])
{
    kernel_scale(&kernels[F_Y], 1 / csf_fill(&kernels[F_Y], 1, 0.0047f, false));
    kernel_scale(&kernels[F_CX], 1 / csf_fill(&kernels[F_CX], 1, 0.0053f, false));
    float sum1 = csf_fill(&kernels[F_CZ1], 34.1f, 0.04f, true);
    float sum2 = csf_fill(&kernels[F_CZ2], 13.5f, 0.025f, true);
    float joint = 1 / sqrtf(sum1 * sum1 + sum2 * sum2);
    kernel_scale(&kernels[F_CZ1], joint);
    kernel_scale(&kernels[F_CZ2], joint);
}

/* Makes the positive weights sum to 1 and the negative ones, if any, to -1. */
static void kernel_balance(FlipKernel *kernel)
{
    float positive = 0, negative = 0;
    for (int i = 0; i < FLIP_TAPS; i++) {
        float weight = kernel->weights[i];
        if (weight > 0)
            positive += weight;
        else
            negative -= weight;
    }
    for (int i = 0; i < FLIP_TAPS; i++)
        kernel->weights[i] /= kernel->weights[i] > 0 ? positive : negative > 0 ? negative : 1;
}

static void feature_kernels(FlipKernel kernels[FLIP_FILTERS])
{
    const float sigma = 0.5f * 0.082f * pixels_per_degree;
    for (int i = -FLIP_RADIUS_FEATURE; i <= FLIP_RADIUS_FEATURE; i++) {
        float x = (float)i;
        float gauss = expf(-(x * x) / (2 * sigma * sigma));
        kernels[F_GAUSS].weights[i + FLIP_RADIUS] = gauss;
        kernels[F_EDGE].weights[i + FLIP_RADIUS] = -x * gauss;
        kernels[F_POINT].weights[i + FLIP_RADIUS] = (x * x / (sigma * sigma) - 1) * gauss;
    }
    for (int filter = F_GAUSS; filter <= F_POINT; filter++)
        kernel_balance(&kernels[filter]);
}

void flip_kernels(FlipKernel kernels[FLIP_FILTERS])
{
    memset(kernels, 0, FLIP_FILTERS * sizeof *kernels);
    csf_kernels(kernels);
    feature_kernels(kernels);
}
