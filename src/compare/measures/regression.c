/* Fits the straight line b = gain a + offset to the codes of pixels that show a vessel in both
 * pictures, by least squares, and finds its standard errors. A few pixels at the rims of shadows
 * move the line without a fault, so a distance counts only beyond two standard errors.
 *
 * The usual error supposes that the samples are independent. They are not where a picture repeats
 * itself: all rows of an upright tube are alike, and a hundred of them say no more than one. Pixels
 * in a row, a column or a diagonal that follow each other with the same codes in A and the same
 * codes in B are a run, and count as one measurement with the weight of all its pixels
 * [cluster-robust errors, Liang and Zeger 1986]. The largest error counts: that of independent
 * samples, or that of the runs in one of the four directions. */
#include "compare/measures/pixel_counts.h"
#include "compare/pixels.h"

#include <math.h>
#include <string.h>

/* With d = b - a: gain - 1 = cov(a, d) / var(a). All in codes. */
typedef struct Line {
    double n, mean_a, mean_d, slope; /* slope: gain - 1 */
    double squares_a;                /* sum of (a - mean_a)^2 */
} Line;

/* Squares of the standard errors, codes. */
typedef struct LineError {
    double slope, offset;
} LineError;

/* The steps to the neighbours of a pixel; the opposite four follow from them. */
enum { DIRECTIONS = 4 };
static const int directions[DIRECTIONS][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};

typedef struct Runs {
    const Rendering *a, *b;
    const Line *line;
} Runs;

/* Returns the errors of the line if the differences of all pixels are independent. */
static LineError error_of_samples(const PixelSums *sums, const Line *line)
{
    double rest = (double)sums->total.line.dd - line->n * line->mean_d * line->mean_d -
                  line->slope * line->slope * line->squares_a;
    double variance = fmax(0, rest) / line->n;
    return (LineError){variance / line->squares_a,
                       variance * (1 / line->n + line->mean_a * line->mean_a / line->squares_a)};
}

/* Returns true if a pixel shows a vessel in both pictures. */
static bool is_common(const Runs *runs, int x, int y)
{
    int width = runs->a->picture->width;
    if (x < 0 || y < 0 || x >= width || y >= runs->a->picture->height)
        return false;
    size_t pixel = (size_t)y * (size_t)width + (size_t)x;
    return runs->a->ids->ids[pixel] && runs->b->ids->ids[pixel];
}

static bool has_same_codes(const Picture *picture, int x, int y, int u, int v)
{
    size_t size = (size_t)picture->channels * ((size_t)picture->bits / 8);
    const char *codes =
        picture->bits == 8 ? (const char *)picture->codes8 : (const char *)picture->codes16;
    size_t width = (size_t)picture->width;
    return memcmp(codes + ((size_t)y * width + (size_t)x) * size,
                  codes + ((size_t)v * width + (size_t)u) * size, size) == 0;
}

/* Returns true if pixel (u, v) shows a vessel in both and has the codes of pixel (x, y). */
static bool repeats(const Runs *runs, int x, int y, int u, int v)
{
    return is_common(runs, u, v) && has_same_codes(runs->a->picture, x, y, u, v) &&
           has_same_codes(runs->b->picture, x, y, u, v);
}

/* Adds to the squares of the errors what a run of `length` pixels like (x, y) contributes. */
static void add_run(const Runs *runs, int x, int y, int length, LineError *error)
{
    const Line *line = runs->line;
    const Picture *a = runs->a->picture, *b = runs->b->picture;
    size_t first = ((size_t)y * (size_t)a->width + (size_t)x) * (size_t)a->channels;
    for (size_t i = first; i < first + (size_t)a->channels; i++) {
        double in_a = picture_code(a, i), beside = in_a - line->mean_a;
        double rest = length * (picture_code(b, i) - in_a - line->mean_d - line->slope * beside);
        double of_slope = rest * beside / line->squares_a;
        double of_offset = rest / line->n - line->mean_a * of_slope;
        error->slope += of_slope * of_slope;
        error->offset += of_offset * of_offset;
    }
}

/* Adds the errors of the runs that begin in a row, DIRECTIONS LineErrors. */
static void add_row_of_runs(const void *context, int y, double *sums)
{
    const Runs *runs = context;
    LineError *errors = (LineError *)sums;
    for (int x = 0; x < runs->a->picture->width; x++) {
        if (!is_common(runs, x, y))
            continue;
        for (int i = 0; i < DIRECTIONS; i++) {
            const int *step = directions[i];
            int length = 1;
            if (repeats(runs, x, y, x - step[0], y - step[1]))
                continue;
            while (repeats(runs, x, y, x + length * step[0], y + length * step[1]))
                length++;
            add_run(runs, x, y, length, &errors[i]);
        }
    }
}

/* Raises the errors to those of the runs in each direction. */
static Status raise_by_runs(const PixelCounter *counting, const Line *line, LineError *error,
                            Err *err)
{
    const Runs runs = {.a = counting->a, .b = counting->b, .line = line};
    LineError sums[DIRECTIONS] = {{0}};
    TRY(rows_sum(counting->labels->height, add_row_of_runs, &runs, &sums[0].slope, 2 * DIRECTIONS,
                 err));
    for (int i = 0; i < DIRECTIONS; i++) {
        error->slope = fmax(error->slope, sums[i].slope);
        error->offset = fmax(error->offset, sums[i].offset);
    }
    return STATUS_OK;
}

/* Returns what is left of a distance beyond two of its standard errors. */
static double beyond_error(double distance, double error)
{
    return fmax(0, fabs(distance) - 2 * error);
}

Status result_set_regression(const PixelCounter *counting, double code_levels,
                             CompareResult *result, Err *err)
{
    const PixelSums *sums = counting->sums;
    double n = (double)sums->total.line.n, a = (double)sums->total.line.a,
           d = (double)sums->total.line.d;
    double variance = n * (double)sums->total.line.aa - a * a;
    if (!(variance > 0))
        return STATUS_OK;
    const Line line = {.n = n,
                       .mean_a = a / n,
                       .mean_d = d / n,
                       .slope = (n * (double)sums->total.line.ad - a * d) / variance,
                       .squares_a = variance / n};
    LineError error = error_of_samples(sums, &line);
    if (sums->total.line.dd > 0)
        TRY(raise_by_runs(counting, &line, &error, err));
    double *values = result->values;
    values[MEASURE_GAIN] = 1 + line.slope;
    values[MEASURE_OFFSET_LEVELS] = (line.mean_d - line.slope * line.mean_a) * code_levels;
    values[MEASURE_GAIN_ERROR] = sqrt(error.slope);
    values[MEASURE_OFFSET_ERROR] = sqrt(error.offset) * code_levels;
    values[MEASURE_GAIN_EXCESS] =
        beyond_error(values[MEASURE_GAIN] - 1, values[MEASURE_GAIN_ERROR]);
    values[MEASURE_OFFSET_EXCESS] =
        beyond_error(values[MEASURE_OFFSET_LEVELS], values[MEASURE_OFFSET_ERROR]);
    return STATUS_OK;
}
