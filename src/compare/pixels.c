/* Implements what several comparisons compute of pixels: sizes, differences of colors and of
 * normals, percentiles, and sums over rows by threads. The angle between normals is computed from
 * sine and cosine together, because the arc cosine alone loses half of the digits of a small angle.
 */
#include "compare/pixels.h"

#include <math.h>
#include <stdlib.h>

CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                           const Tolerance *tolerance)
{
    const double pixels = (double)width * height;
    CompareResult result = {.kind = kind, .tolerance = *tolerance, .has_ids = ids != NULL};
    for (MeasureId i = 0; i < MEASURES; i++)
        result.values[i] = (double)NAN;
    for (PlaceId i = 0; i < PLACES; i++)
        result.places[i] = (PixelPlace){.x = -1, .y = -1};
    result.values[MEASURE_WIDTH] = width;
    result.values[MEASURE_HEIGHT] = height;
    result.values[MEASURE_PIXELS] = result.values[MEASURE_JUDGED_PIXELS] = pixels;
    result.values[MEASURE_DIFFERING_PIXELS] = result.values[MEASURE_NAN_PIXELS] = 0;
    result.values[MEASURE_BEYOND_PIXELS] = result.values[MEASURE_SETTLED_PIXELS] = 0;
    if (ids) {
        result.values[MEASURE_SEGMENTS] = result.values[MEASURE_SEGMENTS_MISSING] = 0;
        result.values[MEASURE_GAIN_EXCESS] = result.values[MEASURE_OFFSET_EXCESS] = 0;
    }
    return result;
}

bool pictures_have_same_form(const Picture *a, const Picture *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           a->bits == b->bits;
}

PixelPlace pixel_place(size_t pixel, int width)
{
    return (PixelPlace){.x = (int)(pixel % (size_t)width), .y = (int)(pixel / (size_t)width)};
}

Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err)
{
    if (width_a == width_b && height_a == height_b)
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "the images differ in size (%d x %d and %d x %d pixels); both must have the same size",
        width_a, height_a, width_b, height_b);
}

double percentile(double *values, size_t n, double fraction)
{
    size_t rank = (size_t)ceil(fraction * (double)n);
    return select_number(values, n, rank ? rank - 1 : 0);
}

int largest_difference(const Picture *a, const Picture *b, size_t pixel)
{
    size_t channels = (size_t)a->channels;
    int largest = 0;
    for (size_t c = pixel * channels; c < (pixel + 1) * channels; c++) {
        int difference = abs(picture_code(a, c) - picture_code(b, c));
        largest = difference > largest ? difference : largest;
    }
    return largest;
}

/* A little is added before rounding down, because a limit such as 1 / 257 times 257 may be just
 * below an integer. */
int allowed_codes(const Tolerance *tolerance, const Picture *picture)
{
    return (int)floor(tolerance->limits[LIMIT_COLOR_LEVELS] * (picture->bits == 8 ? 1 : 257) +
                      1e-9);
}

bool geometry_differs(const Rendering *a, const Rendering *b, size_t pixel, double mm, double deg)
{
    double depth = fabs((double)a->depth->values[pixel] - (double)b->depth->values[pixel]);
    return !(depth <= mm) ||
           !(angle_deg(&a->normal->values[3 * pixel], &b->normal->values[3 * pixel]) <= deg);
}

double angle_deg(const float *a, const float *b)
{
    double ax = (double)a[0], ay = (double)a[1], az = (double)a[2];
    double bx = (double)b[0], by = (double)b[1], bz = (double)b[2];
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    return elementary_atan2(sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz) * 180 / PI;
}

Status srgb_table(int bits, float **table, Err *err)
{
    const size_t n = (size_t)1 << bits;
    TRY(mem_calloc(table, n, sizeof **table, "decoded levels", err));
    for (size_t i = 0; i < n; i++)
        (*table)[i] = srgb_decode((float)i / (float)(n - 1));
    return STATUS_OK;
}

void add_integers(void *to, const void *from, size_t bytes)
{
    uint64_t *sums = to;
    const uint64_t *added = from;
    for (size_t i = 0; i < bytes / sizeof *sums; i++)
        sums[i] += added[i];
}

typedef struct RowsWork {
    RowSums *row;
    const void *context;
    double *sums; /* n for each row */
    size_t n;
} RowsWork;

static void sum_row(size_t y, int worker, void *context)
{
    (void)worker;
    const RowsWork *work = context;
    work->row(work->context, (int)y, work->sums + y * work->n);
}

Status rows_sum(int height, RowSums *row, const void *context, double *sums, size_t n, Err *err)
{
    RowsWork work = {.row = row, .context = context, .n = n};
    const size_t all = (size_t)height * n;
    TRY(mem_calloc(&work.sums, all, sizeof *work.sums, "sums of rows", err));
    threads_for((size_t)height, 0, sum_row, &work);
    for (size_t i = 0; i < all; i++)
        sums[i % n] += work.sums[i];
    free(work.sums);
    return STATUS_OK;
}
