/* Computes HDR-FLIP, a perceptual difference of two images in linear light without an upper limit:
 * the error of a pixel is its largest FLIP error over a range of exposures, after
 * tone mapping by a fit of ACES. The exposures are about one stop (a factor of 2) apart. The first
 * maps the brightest pixel of the reference to 0.85, and the last maps its median pixel to 0.85. */
#include "compare/measures/flip.h"

#include <math.h>
#include <stdlib.h>

/* The coefficients a to f of the tone map (x (a x + b) + c) / (x (d x + e) + f) of FLIP 1.6. The
 * factor 0.6 scales x. */
static const float aces[6] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0,
                              0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};

typedef struct Hdr {
    const Plane *planes[2];
    double start, stop; /* first and last exposure, log2 */
    int exposures;
} Hdr;

static float tone_map(float x)
{
    float mapped =
        (x * (aces[0] * x + aces[1]) + aces[2]) / (x * (aces[3] * x + aces[4]) + aces[5]);
    return mapped < 0 ? 0 : mapped > 1 ? 1 : mapped;
}

static void hdr_colors(const FlipPair *pair, const FlipSpan *span, float *out, size_t stride)
{
    const Hdr *self = pair->context;
    const Plane *plane = self->planes[span->image];
    double step = (self->stop - self->start) / (self->exposures - 1);
    float factor = (float)elementary_exp2(self->start + span->exposure * step);
    size_t channels = (size_t)plane->channels;
    const float *values =
        plane->values + ((size_t)span->y * (size_t)plane->width + (size_t)span->x) * channels;
    for (size_t i = 0; i < (size_t)span->n; i++)
        for (size_t c = 0; c < 3; c++)
            out[c * stride + i] = tone_map(factor * values[i * channels + (channels == 1 ? 0 : c)]);
}

static bool hdr_equal(const FlipPair *pair, int x, int y, int n)
{
    const Hdr *self = pair->context;
    const Plane *a = self->planes[0], *b = self->planes[1];
    size_t channels = (size_t)a->channels;
    size_t first = ((size_t)y * (size_t)a->width + (size_t)x) * channels;
    for (size_t i = first; i < first + (size_t)n * channels; i++)
        if (a->values[i] != b->values[i])
            return false;
    return true;
}

static int ascending(const void *left, const void *right)
{
    float a = *(const float *)left, b = *(const float *)right;
    return (a > b) - (a < b);
}

/* Returns the value that the tone map maps to t = 0.85: the positive root of (a - t d) x^2 + (b - t
 * e) x + c - t f. */
static double bright_of_tone_map(void)
{
    const double t = 0.85;
    double a = (double)aces[0] - t * (double)aces[3], b = (double)aces[1] - t * (double)aces[4];
    double c = (double)aces[2] - t * (double)aces[5];
    double half = -0.5 * b / a, root = sqrt(half * half - c / a);
    return fmax(half - root, half + root);
}

/* Chooses the range of exposures from the maximum and the median luminance of the reference. The
 * median counts as at least 1e-6 of the maximum, so that a picture whose median is black has at
 * most 20 exposures, log2(1e6), and not infinitely many. */
static Status choose_exposures(Hdr *self, Err *err)
{
    const Plane *a = self->planes[0];
    size_t n = (size_t)a->width * (size_t)a->height, channels = (size_t)a->channels;
    float *luminance;
    TRY(mem_calloc(&luminance, n, sizeof *luminance, "luminances", err));
    for (size_t i = 0; i < n; i++) {
        const float *v = a->values + i * channels;
        luminance[i] = channels == 1 ? v[0] : 0.2126f * v[0] + 0.7152f * v[1] + 0.0722f * v[2];
    }
    qsort(luminance, n, sizeof *luminance, ascending);
    double bright = bright_of_tone_map(), most = (double)luminance[n - 1];
    double middle = fmax((double)luminance[n / 2], most * 1e-6);
    free(luminance);
    if (!(most > 0))
        most = middle = bright; /* black: its exposure does not matter */
    self->start = elementary_log2(bright / most);
    self->stop = elementary_log2(bright / middle);
    self->exposures = (int)fmax(2, ceil(self->stop - self->start));
    return STATUS_OK;
}

Status hdr_flip_compute(const Plane *a, const Plane *b, Plane *map, FlipSummary *summary, Err *err)
{
    Hdr self = {.planes = {a, b}};
    TRY(choose_exposures(&self, err));
    const FlipPair pair = {.width = a->width,
                           .height = a->height,
                           .colors = hdr_colors,
                           .equal = hdr_equal,
                           .exposures = self.exposures,
                           .context = &self};
    return flip_run(&pair, map, summary, err);
}
