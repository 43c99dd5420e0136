/* Mean structural similarity. Five moments (a, b, aa, bb, ab) are blurred, first down the columns
 * of the eleven rows about an output row, then along it; rows are independent, and their sums are
 * added in order. */
#include "verify/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RADIUS = 5, TAPS = 2 * RADIUS + 1, MOMENTS = 5 };

typedef struct Ssim {
    int width, height;
    double *luma[2];   /* owned; 0 to 255 */
    double *row_sums;  /* owned; one for each row of the output */
    double *workspace; /* owned; MOMENTS rows for each worker */
    double weights[TAPS];
} Ssim;

/* Luma of ITU-R BT.601, rounded to whole codes as image libraries do, in 8-bit levels. */
static void fill_luma(const Picture *picture, double *luma)
{
    size_t n = (size_t)picture->width * (size_t)picture->height;
    double scale = picture->bits == 8 ? 1 : 1 / 257.0;
    for (size_t i = 0; i < n; i++) {
        size_t first = i * (size_t)picture->channels;
        uint64_t rounded = picture_code(picture, first);
        if (picture->channels == 3)
            rounded = (19595 * rounded + 38470ull * picture_code(picture, first + 1) +
                       7471ull * picture_code(picture, first + 2) + 32768) >>
                      16;
        luma[i] = scale * (double)rounded;
    }
}

static void blur_columns(const Ssim *ssim, size_t top, double *const moments[MOMENTS])
{
    size_t width = (size_t)ssim->width;
    memset(moments[0], 0, MOMENTS * width * sizeof **moments);
    for (size_t k = 0; k < TAPS; k++) {
        const double *a = ssim->luma[0] + (top + k) * width;
        const double *b = ssim->luma[1] + (top + k) * width;
        double weight = ssim->weights[k];
        for (size_t x = 0; x < width; x++) {
            moments[0][x] += weight * a[x];
            moments[1][x] += weight * b[x];
            moments[2][x] += weight * a[x] * a[x];
            moments[3][x] += weight * b[x] * b[x];
            moments[4][x] += weight * a[x] * b[x];
        }
    }
}

static void do_row(size_t row, int worker, void *context)
{
    Ssim *ssim = context;
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    double *moments[MOMENTS];
    for (int m = 0; m < MOMENTS; m++)
        moments[m] = ssim->workspace + ((size_t)worker * MOMENTS + (size_t)m) * (size_t)ssim->width;
    blur_columns(ssim, row, moments);
    double sum = 0;
    for (int x = 0; x + TAPS <= ssim->width; x++) {
        double m[MOMENTS] = {0};
        for (int i = 0; i < MOMENTS; i++)
            for (int k = 0; k < TAPS; k++)
                m[i] += ssim->weights[k] * moments[i][x + k];
        double variance_a = m[2] - m[0] * m[0], variance_b = m[3] - m[1] * m[1];
        double covariance = m[4] - m[0] * m[1];
        sum += (2 * m[0] * m[1] + c1) * (2 * covariance + c2) /
               ((m[0] * m[0] + m[1] * m[1] + c1) * (variance_a + variance_b + c2));
    }
    ssim->row_sums[row] = sum;
}

static Status ssim_init(Ssim *ssim, const Picture *a, const Picture *b, int threads, Err *err)
{
    size_t n = (size_t)a->width * (size_t)a->height;
    ssim->width = a->width;
    ssim->height = a->height;
    TRY(mem_calloc(&ssim->luma[0], n, sizeof(double), "luma values", err));
    TRY(mem_calloc(&ssim->luma[1], n, sizeof(double), "luma values", err));
    TRY(mem_calloc(&ssim->row_sums, (size_t)a->height, sizeof(double), "row sums", err));
    TRY(mem_calloc(&ssim->workspace, (size_t)threads * MOMENTS * (size_t)a->width, sizeof(double),
                   "moments of a row", err));
    fill_luma(a, ssim->luma[0]);
    fill_luma(b, ssim->luma[1]);
    double sum = 0;
    for (int k = 0; k < TAPS; k++)
        sum += ssim->weights[k] = exp(-(k - RADIUS) * (k - RADIUS) / (2 * 1.5 * 1.5));
    for (int k = 0; k < TAPS; k++)
        ssim->weights[k] /= sum;
    return STATUS_OK;
}

Status ssim_compute(const Picture *a, const Picture *b, double *ssim, Err *err)
{
    if (a->width < TAPS || a->height < TAPS) {
        *ssim = NAN;
        return STATUS_OK;
    }
    Ssim self = {0};
    int threads = threads_available();
    size_t rows = (size_t)(a->height - TAPS + 1), columns = (size_t)(a->width - TAPS + 1);
    Status status = ssim_init(&self, a, b, threads, err);
    if (status == STATUS_OK) {
        threads_for(rows, threads, do_row, &self);
        double sum = 0;
        for (size_t row = 0; row < rows; row++)
            sum += self.row_sums[row];
        *ssim = sum / (double)(rows * columns);
    }
    free(self.luma[0]);
    free(self.luma[1]);
    free(self.row_sums);
    free(self.workspace);
    return status;
}
