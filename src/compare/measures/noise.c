/* Tests with a known false alarm rate whether two noisy renderings have one mean: whether they
 * differ by noise only.
 *
 * Both have the same variance v per value. The difference d = B - A then has the variance 2 v. It
 * is independent of the mean m = (A + B) / 2 if the noise is normal, and otherwise uncorrelated. So
 * T = sum(m d) / sqrt(sum(2 m^2 v)) is normal with variance 1 if A and B differ by noise only, and
 * sum(m d) / sum(m^2) estimates the gain of B, minus 1. The weights m do not contain v: v may be an
 * estimate from few renderings, whose errors then average out. T is computed per channel and for
 * all channels, over the whole picture and over tiles of 32 x 32 pixels. Half of the rate is for
 * the whole picture and half for the tiles, each divided evenly among its tests [Bonferroni]. */
#include "compare/measures/noise.h"

#include <math.h>
#include <stdlib.h>

/* Side of a tile in pixels. A fault of a part shows in few tiles; smaller tiles find smaller parts,
 * but are more tests, each with a smaller rate and fewer pixels. */
enum { TILE = 32 };

/* Sums of m d, of m^2, and of 2 m^2 v. */
typedef struct NoiseSums {
    double md, mm, mmv;
} NoiseSums;

/* Returns the x such that a standard normal variable exceeds x in magnitude at this rate. */
static double two_sided_limit(double rate)
{
    double low = 0, high = 40;
    for (int i = 0; i < 100; i++) {
        double middle = (low + high) / 2;
        *(elementary_erfc(middle / sqrt(2)) > rate ? &low : &high) = middle;
    }
    return high;
}

/* Sums over a square of one channel; if `channel` is the number of channels, over all channels. */
static NoiseSums sum_box(const Plane *const planes[3], int channel, int left, int top, int side)
{
    const Plane *a = planes[0], *b = planes[1], *v = planes[2];
    int channels = a->channels, first = channel < channels ? channel : 0;
    int last = channel < channels ? channel : channels - 1;
    NoiseSums sums = {0};
    for (int y = top; y < top + side && y < a->height; y++)
        for (int x = left; x < left + side && x < a->width; x++)
            for (int c = first; c <= last; c++) {
                size_t i =
                    ((size_t)y * (size_t)a->width + (size_t)x) * (size_t)channels + (size_t)c;
                double in_a = (double)a->values[i], in_b = (double)b->values[i];
                double m = (in_a + in_b) / 2;
                sums.md += m * (in_b - in_a);
                sums.mm += m * m;
                sums.mmv += 2 * m * m * (double)v->values[i];
            }
    return sums;
}

/* Returns T. Without noise, any difference is infinitely many sigmas. */
static double sigmas_of(const NoiseSums *sums)
{
    return sums->mmv > 0   ? sums->md / sqrt(sums->mmv)
           : sums->md == 0 ? 0
                           : copysign((double)INFINITY, sums->md);
}

static Status check_planes(const Plane *const planes[3], Err *err)
{
    const Plane *a = planes[0];
    for (int number = 0; number < 3; number++) {
        const Plane *plane = planes[number];
        if (plane->width != a->width || plane->height != a->height ||
            plane->channels != a->channels)
            return err_set(err, STATUS_INPUT,
                           "both pictures and the variance must have the same size and the same "
                           "number of channels");
        for (size_t i = 0; i < (size_t)a->width * (size_t)a->height * (size_t)a->channels; i++)
            if (!isfinite(plane->values[i]) || (number == 2 && plane->values[i] < 0))
                return err_set(err, STATUS_INPUT,
                               "a color is not finite, or a variance is negative");
    }
    return STATUS_OK;
}

Status compare_noise(const Plane *a, const Plane *b, const Plane *variance, double rate,
                     NoiseResult *result, Err *err)
{
    const Plane *const planes[3] = {a, b, variance};
    TRY(check_planes(planes, err));
    int columns = (a->width + TILE - 1) / TILE, rows = (a->height + TILE - 1) / TILE;
    int side = a->width > a->height ? a->width : a->height, parts = a->channels + 1;
    NoiseResult made = {.rate = rate,
                        .limit = two_sided_limit(rate / 2 / parts),
                        .tile_limit = two_sided_limit(rate / 2 / parts / columns / rows)};
    for (int c = 0; c < parts; c++) {
        NoiseSums whole = sum_box(planes, c, 0, 0, side);
        if (c == 0 || fabs(sigmas_of(&whole)) > fabs(made.sigmas)) {
            made.sigmas = sigmas_of(&whole);
            made.gain = whole.mm > 0 ? 1 + whole.md / whole.mm : 1;
        }
        for (int tile = 0; tile < columns * rows; tile++) {
            int left = tile % columns * TILE, top = tile / columns * TILE;
            NoiseSums sums = sum_box(planes, c, left, top, TILE);
            if (fabs(sigmas_of(&sums)) > fabs(made.tile_sigmas)) {
                made.tile_sigmas = sigmas_of(&sums);
                made.tile = (PixelPlace){.x = left, .y = top};
            }
        }
    }
    made.agrees = fabs(made.sigmas) <= made.limit && fabs(made.tile_sigmas) <= made.tile_limit;
    *result = made;
    return STATUS_OK;
}

Status noise_of_renderings(const Plane *renderings, size_t n, Plane *variance, Err *err)
{
    const Plane *first = &renderings[0];
    Plane made;
    for (size_t k = 1; k < n; k++)
        if (renderings[k].width != first->width || renderings[k].height != first->height ||
            renderings[k].channels != first->channels)
            return err_set(err, STATUS_INPUT, "the renderings for --noise differ in size");
    TRY(plane_init(&made, first->width, first->height, first->channels, err));
    for (size_t i = 0; i < (size_t)first->width * (size_t)first->height * (size_t)first->channels;
         i++) {
        double sum = 0, squares = 0;
        for (size_t k = 0; k < n; k++)
            sum += (double)renderings[k].values[i];
        for (size_t k = 0; k < n; k++) {
            double off = (double)renderings[k].values[i] - sum / (double)n;
            squares += off * off;
        }
        made.values[i] = (float)(squares / (double)(n - 1));
    }
    *variance = made;
    return STATUS_OK;
}
