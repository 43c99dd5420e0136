/* Computes the mean structural similarity (SSIM) of two pictures [Wang et al. 2004]. A window is a
 * square of 11 x 11 pixels; its similarity follows from five weighted means, the moments: of the
 * lumas a and b, and of aa, bb and ab. The moments are blurred by a
 * separable Gaussian: first down the columns of the 11 rows around an output row, then along the
 * row. Threads compute bands of output rows, so each holds the luma of one band only. The sums of
 * rows are added in order. A window that is equal in both pictures has similarity 1, so only the
 * windows around pixels that differ are blurred. */
#include "compare/measures/perception.h"

#include "compare/measures/wide.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RADIUS = 5, TAPS = 2 * RADIUS + 1, MOMENTS = 5, BAND = 32, SPAN = BAND + TAPS - 1 };
/* BAND: number of output rows per band; a taller band recomputes fewer of its 10 shared rows, but
 * needs more memory per thread. SPAN: number of input rows of a band. STRETCH: number of windows
 * that compare_windows computes at once, a multiple of the lanes of a vector. */
enum { STRETCH = 32 };

typedef struct Ssim {
    const Picture *pictures[2];
    int width;         /* of the pictures */
    int rows, columns; /* of the output */
    double weights[TAPS];
    double *row_sums;   /* owned; one for each row of the output */
    double *workspaces; /* owned; workspace_size for each worker */
    uint8_t *equal;     /* owned; width for each worker */
    size_t workspace_size;
} Ssim;

/* Computes the luma of ITU-R BT.601 of a row in 8-bit levels, rounded to codes as image libraries
 * do. */
static void fill_luma(const Picture *picture, int y, double *luma)
{
    double scale = picture->bits == 8 ? 1 : 1 / 257.0;
    size_t next = (size_t)y * picture_stride(picture);
    for (int x = 0; x < picture->width; x++, next += (size_t)picture->channels) {
        uint64_t rounded = picture_code(picture, next);
        if (picture->channels == 3)
            rounded = (19595 * rounded + 38470ull * picture_code(picture, next + 1) +
                       7471ull * picture_code(picture, next + 2) + 32768) >>
                      16;
        luma[x] = scale * (double)rounded;
    }
}

/* Blurs the columns [from, to) of the 11 rows that begin at `a` and `b`. */
static void blur_columns(const Ssim *ssim, const double *restrict a, const double *restrict b,
                         size_t from, size_t to, double *restrict moments)
{
    size_t width = (size_t)ssim->width;
    for (size_t i = 0; i < MOMENTS; i++)
        memset(moments + i * width + from, 0, (to - from) * sizeof *moments);
    for (size_t k = 0; k < TAPS; k++, a += width, b += width) {
        double weight = ssim->weights[k];
        for (size_t x = from; x < to; x++) {
            moments[x] += weight * a[x];
            moments[width + x] += weight * b[x];
            moments[2 * width + x] += weight * a[x] * a[x];
            moments[3 * width + x] += weight * b[x] * b[x];
            moments[4 * width + x] += weight * a[x] * b[x];
        }
    }
}

/* Computes the similarities of STRETCH consecutive windows. `moments` points to the first column of
 * the first window. */
static void compare_windows(const Ssim *ssim, const double *restrict moments,
                            double *restrict similarities)
{
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    double m[MOMENTS][STRETCH];
    for (int i = 0; i < MOMENTS; i++)
        for (int x = 0; x < STRETCH; x++) {
            const double *in = moments + i * ssim->width + x;
            double sum = ssim->weights[RADIUS] * in[RADIUS];
            for (int k = 0; k < RADIUS; k++)
                sum += ssim->weights[k] * (in[k] + in[TAPS - 1 - k]);
            m[i][x] = sum;
        }
    for (int x = 0; x < STRETCH; x++) {
        double a = m[0][x], b = m[1][x], variance_a = m[2][x] - a * a, variance_b = m[3][x] - b * b;
        similarities[x] = (2 * a * b + c1) * (2 * (m[4][x] - a * b) + c2) /
                          ((a * a + b * b + c1) * (variance_a + variance_b + c2));
    }
}

/* Returns the sum over the windows [from, to) of a row. The last call of compare_windows may
 * compute windows beyond `to`. They are ignored, and the workspace has STRETCH spare elements for
 * them. */
static double sum_windows(const Ssim *ssim, const double *moments, int from, int to)
{
    double sum = 0, similarities[STRETCH];
    for (int x = from; x < to; x += STRETCH) {
        compare_windows(ssim, moments + x, similarities);
        for (int i = 0; i < STRETCH && x + i < to; i++)
            sum += similarities[i];
    }
    return sum;
}

/* Counts per column how many of the last rows are equal in both pictures, up to TAPS. */
static void count_equal(const Picture *a, const Picture *b, int y, uint8_t *equal)
{
    bool all = picture_rows_equal(a, b, y, 0, a->width);
    size_t next = (size_t)y * picture_stride(a);
    for (int x = 0; x < a->width; x++) {
        bool same = true;
        for (int c = 0; c < a->channels && !all; c++)
            same &= picture_code(a, next + (size_t)c) == picture_code(b, next + (size_t)c);
        next += (size_t)a->channels;
        equal[x] = same ? (uint8_t)(equal[x] < TAPS ? equal[x] + 1 : TAPS) : 0;
    }
}

/* Returns the first window at or after `x` that is equal in both pictures (is_equal) or that
 * differs (!is_equal). Returns ssim->columns if there is none. */
static int next_window(const Ssim *ssim, const uint8_t *equal, int x, bool is_equal)
{
    int run = 0; /* number of consecutive equal columns that end at the current column */
    for (int u = x; u < x + TAPS - 1; u++)
        run = equal[u] == TAPS ? run + 1 : 0;
    for (; x < ssim->columns; x++) {
        run = equal[x + TAPS - 1] == TAPS ? run + 1 : 0;
        if ((run >= TAPS) == is_equal)
            break;
    }
    return x;
}

/* Returns the sum over a row of windows. `a` and `b` are the first of its 11 rows of luma. */
static double row_sum(const Ssim *ssim, const double *a, const double *b, const uint8_t *equal,
                      double *moments)
{
    double sum = 0;
    for (int x = 0, end; x < ssim->columns; x = end) {
        int from = next_window(ssim, equal, x, false);
        sum += from - x;
        end = from < ssim->columns ? next_window(ssim, equal, from, true) : from;
        if (from == end)
            continue;
        blur_columns(ssim, a, b, (size_t)from, (size_t)end + TAPS - 1, moments);
        sum += sum_windows(ssim, moments, from, end);
    }
    return sum;
}

/* Sums the similarities of the output rows of one band. */
static void do_band(size_t index, int worker, void *context)
{
    Ssim *ssim = context;
    const Picture *a = ssim->pictures[0], *b = ssim->pictures[1];
    size_t width = (size_t)ssim->width;
    double *luma_a = ssim->workspaces + (size_t)worker * ssim->workspace_size;
    double *luma_b = luma_a + SPAN * width, *moments = luma_b + SPAN * width;
    uint8_t *equal = ssim->equal + (size_t)worker * width;
    int top = (int)index * BAND;
    int rows = ssim->rows - top < BAND ? ssim->rows - top : BAND;
    memset(equal, 0, width);
    for (int y = 0; y < rows + TAPS - 1; y++) {
        fill_luma(a, top + y, luma_a + (size_t)y * width);
        fill_luma(b, top + y, luma_b + (size_t)y * width);
        count_equal(a, b, top + y, equal);
        int row = y - TAPS + 1;
        if (row >= 0)
            ssim->row_sums[top + row] = row_sum(ssim, luma_a + (size_t)row * width,
                                                luma_b + (size_t)row * width, equal, moments);
    }
}

/* do_band, compiled for AVX2 [wide.h]. */
WIDE static void do_band_wide(size_t index, int worker, void *context)
{
    do_band(index, worker, context);
}

/* The Gaussian has a sigma of 1.5 pixels and 11 taps [Wang et al. 2004]. */
static Status ssim_init(Ssim *ssim, int threads, Err *err)
{
    double sum = 0;
    for (int k = 0; k < TAPS; k++)
        sum += ssim->weights[k] = elementary_exp(-(k - RADIUS) * (k - RADIUS) / (2 * 1.5 * 1.5));
    for (int k = 0; k < TAPS; k++)
        ssim->weights[k] /= sum;
    ssim->workspace_size = (2 * SPAN + MOMENTS) * (size_t)ssim->width + STRETCH;
    TRY(mem_calloc(&ssim->row_sums, (size_t)ssim->rows, sizeof(double), "row sums", err));
    TRY(mem_calloc(&ssim->equal, (size_t)threads, (size_t)ssim->width, "equal columns", err));
    return mem_calloc(&ssim->workspaces, (size_t)threads * ssim->workspace_size, sizeof(double),
                      "luma of a band", err);
}

Status ssim_find(const Picture *a, const Picture *b, double values[MEASURES], Err *err)
{
    values[MEASURE_SSIM] = (double)NAN;
    if (a->width < TAPS || a->height < TAPS)
        return STATUS_OK;
    Ssim self = {.pictures = {a, b},
                 .width = a->width,
                 .rows = a->height - TAPS + 1,
                 .columns = a->width - TAPS + 1};
    int threads = threads_available();
    Status status = ssim_init(&self, threads, err);
    if (status == STATUS_OK) {
        threads_for(((size_t)self.rows + BAND - 1) / BAND, threads,
                    wide_usable() ? do_band_wide : do_band, &self);
        double sum = 0;
        for (int row = 0; row < self.rows; row++)
            sum += self.row_sums[row];
        values[MEASURE_SSIM] = sum / ((double)self.rows * self.columns);
    }
    free(self.row_sums);
    free(self.workspaces);
    free(self.equal);
    return status;
}
