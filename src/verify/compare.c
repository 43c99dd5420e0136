/* One pass over the pixels gathers everything that is counted or summed; differences are integers
 * and their sums over a row exact, so that no result depends on order. Labels (what a pixel shows)
 * are worked out once and read by every class. Percentiles come from a partial selection. */
#include "verify/labels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *plane_kind_name(PlaneKind kind)
{
    static const char *const names[PLANE_KINDS] = {"color", "depth", "normal", "id"};
    return names[kind];
}

static CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                                  const Tolerance *tolerance)
{
    const PixelPlace nowhere = {.x = -1, .y = -1};
    return (CompareResult){.kind = kind,
                           .tolerance = *tolerance,
                           .width = width,
                           .height = height,
                           .pixels = (size_t)width * (size_t)height,
                           .judged_pixels = (size_t)width * (size_t)height,
                           .has_ids = ids != NULL,
                           .largest_region_at = nowhere,
                           .nan_at = nowhere,
                           .worst = nowhere,
                           .max_abs = NAN,
                           .mean_abs = NAN,
                           .rmse = NAN,
                           .max_code = NAN,
                           .psnr_db = NAN,
                           .flip_mean = NAN,
                           .ssim = NAN,
                           .interior_max_abs = NAN,
                           .edge_mismatch_fraction = NAN,
                           .median = NAN,
                           .p99 = NAN,
                           .max = NAN};
}

static PixelPlace place_of(size_t pixel, int width)
{
    return (PixelPlace){.x = (int)(pixel % (size_t)width), .y = (int)(pixel / (size_t)width)};
}

static void name_ids(PixelPlace *place, const IdPlane *a, const IdPlane *b)
{
    if (!a || place->x < 0)
        return;
    size_t pixel = (size_t)place->y * (size_t)a->width + (size_t)place->x;
    place->id_a = a->ids[pixel];
    place->id_b = b->ids[pixel];
}

/* Names the segments at the places found, and judges. */
static void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b)
{
    name_ids(&result->worst, a, b);
    name_ids(&result->largest_region_at, a, b);
    name_ids(&result->nan_at, a, b);
    compare_judge(result);
}

static Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err)
{
    if (width_a == width_b && height_a == height_b)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the images differ in size: %d x %d and %d x %d pixels; only images of one size "
                   "can be compared",
                   width_a, height_a, width_b, height_b);
}

/* ------------------------------------------------------------------------------------- pictures */

/* What is summed over the samples of a picture. */
typedef struct Sums {
    double abs, squares;   /* codes, codes^2 */
    int max, interior_max; /* codes */
    int beyond;            /* codes a pixel may be off */
    bool common_only;
} Sums;

/* The largest difference over the channels of a pixel, in codes; adds to the sums of its row. */
static int pixel_difference(const uint16_t *a, const uint16_t *b, int channels, uint64_t *total,
                            uint64_t *squares)
{
    int largest = 0;
    for (int c = 0; c < channels; c++) {
        int difference = abs(a[c] - b[c]);
        *total += (uint64_t)difference;
        *squares += (uint64_t)difference * (uint64_t)difference;
        largest = difference > largest ? difference : largest;
    }
    return largest;
}

static void count_pixel(CompareResult *result, Sums *sums, const Labels *labels, int x, int y,
                        int difference)
{
    size_t pixel = (size_t)y * (size_t)labels->width + (size_t)x;
    bool band = labels->a && labels_in_band(labels, x, y);
    bool common = labels->a && labels->a[pixel] && labels->b[pixel];
    ClassCounts *classes = &result->classes;
    if (!labels->a || !labels_classify(labels, pixel, band, classes)) {
        classes->identical += difference == 0;
        classes->rounding += difference == 1;
        classes->shading += difference > 1;
    }
    if (!band && difference > sums->interior_max)
        sums->interior_max = difference;
    result->differing_pixels += difference > 0;
    result->beyond_pixels += difference > sums->beyond && (common || !sums->common_only);
    if (difference > sums->max) {
        sums->max = difference;
        result->worst = (PixelPlace){.x = x, .y = y};
    }
}

static void measure_codes(const Picture *a, const Picture *b, const Labels *labels,
                          CompareResult *result)
{
    double code_levels = a->bits == 8 ? 1 : 1 / 257.0;
    bool common_only = result->tolerance.color_common_only && labels->a;
    Sums sums = {.beyond = (int)floor(result->tolerance.color_levels / code_levels + 1e-9),
                 .common_only = common_only};
    size_t i = 0, channels = (size_t)a->channels;
    for (int y = 0; y < a->height; y++) {
        uint64_t total = 0, squares = 0;
        for (int x = 0; x < a->width; x++, i += channels) {
            int difference =
                pixel_difference(a->codes + i, b->codes + i, a->channels, &total, &squares);
            count_pixel(result, &sums, labels, x, y, difference);
        }
        sums.abs += (double)total;
        sums.squares += (double)squares;
    }
    double samples = (double)i;
    result->max_code = sums.max;
    result->max_abs = sums.max * code_levels;
    result->mean_abs = sums.abs / samples * code_levels;
    result->rmse = sqrt(sums.squares / samples) * code_levels;
    result->psnr_db = result->rmse > 0 ? 20 * log10(255 / result->rmse) : (double)INFINITY;
    if (labels->a)
        result->interior_max_abs = sums.interior_max * code_levels;
    if (common_only)
        result->judged_pixels = result->common_pixels;
}

static Status measure_perception(const Picture *a, const Picture *b, CompareResult *result,
                                 Err *err)
{
    Plane map;
    TRY(flip_compute(a, b, &map, err));
    result->flip_mean = plane_mean(&map);
    plane_release(&map);
    return ssim_compute(a, b, &result->ssim, err);
}

Status compare_pictures(const Picture *a, const Picture *b, const IdPlane *id_a,
                        const IdPlane *id_b, const Tolerance *tolerance, CompareResult *result,
                        Err *err)
{
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    if (a->channels != b->channels || a->bits != b->bits)
        return err_set(err, STATUS_INPUT,
                       "the images differ in depth: %d x %d and %d x %d bits a pixel; only images "
                       "of one depth can be compared",
                       a->channels, a->bits, b->channels, b->bits);
    TRY(labels_check_ids(a->width, a->height, id_a, id_b, err));
    CompareResult made = result_start(PLANE_COLOR, a->width, a->height, id_a, tolerance);
    made.bits = a->bits;
    Labels labels = {0};
    Status status = STATUS_OK;
    if (id_a)
        labels_from_ids(&labels, id_a, id_b);
    else
        TRY(labels_from_background(&labels, a, b, err));
    TRY_GOTO(labels_measure(&labels, &made, err));
    measure_codes(a, b, &labels, &made);
    TRY_GOTO(measure_perception(a, b, &made, err));
    result_finish(&made, id_a, id_b);
    *result = made;
done:
    labels_release(&labels);
    return status;
}

/* --------------------------------------------------------------------------------------- planes */

/* The item of rank `rank` (0: smallest) of n numbers, which are reordered: Hoare's selection. */
static double select_rank(double *values, size_t n, size_t rank)
{
    size_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = values[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;; i++, j--) {
            while (values[i] < pivot)
                i++;
            while (values[j] > pivot)
                j--;
            if (i >= j)
                break;
            double swap = values[i];
            values[i] = values[j];
            values[j] = swap;
        }
        if (rank <= j)
            high = j;
        else
            low = j + 1;
    }
    return values[rank];
}

/* Nearest rank: the smallest value that at least `fraction` of all do not exceed. */
static double percentile(double *values, size_t n, double fraction)
{
    size_t rank = (size_t)ceil(fraction * (double)n);
    return select_rank(values, n, rank ? rank - 1 : 0);
}

typedef enum Seen { SEEN_NOTHING, SEEN_SURFACE, SEEN_NAN } Seen;

static Seen seen_at(PlaneKind kind, const float *value)
{
    if (kind == PLANE_DEPTH)
        return isfinite(*value) ? SEEN_SURFACE : *value > 0 ? SEEN_NOTHING : SEEN_NAN;
    if (!isfinite(value[0]) || !isfinite(value[1]) || !isfinite(value[2]))
        return SEEN_NAN;
    return value[0] == 0 && value[1] == 0 && value[2] == 0 ? SEEN_NOTHING : SEEN_SURFACE;
}

/* The angle between two vectors in degrees, exact also where it is small. */
static double angle_deg(const float *a, const float *b)
{
    double ax = (double)a[0], ay = (double)a[1], az = (double)a[2];
    double bx = (double)b[0], by = (double)b[1], bz = (double)b[2];
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    return atan2(sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz) * 180 /
           3.14159265358979323846;
}

static double plane_error(PlaneKind kind, const float *a, const float *b)
{
    return kind == PLANE_DEPTH ? fabs((double)*a - (double)*b) : angle_deg(a, b);
}

/* Labels the pixels that show a surface, and counts what is no number: such a pixel shows nothing.
 */
static void label_seen(PlaneKind kind, const Plane *a, const Plane *b, Labels *labels,
                       CompareResult *result)
{
    size_t n = result->pixels, channels = (size_t)a->channels;
    for (size_t i = 0; i < n; i++) {
        Seen in_a = seen_at(kind, a->values + i * channels);
        Seen in_b = seen_at(kind, b->values + i * channels);
        result->nan_pixels_a += in_a == SEEN_NAN;
        result->nan_pixels_b += in_b == SEEN_NAN;
        if (in_a == SEEN_NAN || in_b == SEEN_NAN) {
            if (result->nan_at.x < 0)
                result->nan_at = place_of(i, a->width);
            continue;
        }
        labels->owned[i] = in_a == SEEN_SURFACE;
        labels->owned[n + i] = in_b == SEEN_SURFACE;
    }
}

/* Errors of the common pixels into `errors`, which has room for them. */
static void measure_errors(PlaneKind kind, const Plane *a, const Plane *b, const Labels *labels,
                           double *errors, CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    double limit = kind == PLANE_DEPTH ? tolerance->depth_max_mm : tolerance->normal_max_deg;
    size_t channels = (size_t)a->channels, found = 0;
    double worst = -1;
    for (size_t i = 0; i < result->pixels; i++) {
        if (!labels->a[i] || !labels->b[i])
            continue;
        double error = plane_error(kind, a->values + i * channels, b->values + i * channels);
        errors[found++] = error;
        result->differing_pixels += error > 0;
        result->beyond_pixels += error > limit;
        if (error > worst) {
            worst = error;
            result->worst =
                (PixelPlace){.x = (int)(i % (size_t)a->width), .y = (int)(i / (size_t)a->width)};
        }
    }
    result->differing_pixels += result->missing_pixels + result->extra_pixels;
    result->judged_pixels = found;
    if (found == 0)
        return;
    result->median = percentile(errors, found, 0.5);
    result->p99 = percentile(errors, found, 0.99);
    result->max = worst;
}

Status compare_planes(PlaneKind kind, const Plane *a, const Plane *b, const IdPlane *id_a,
                      const IdPlane *id_b, const Tolerance *tolerance, CompareResult *result,
                      Err *err)
{
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    int channels = kind == PLANE_DEPTH ? 1 : 3;
    if (a->channels != channels || b->channels != channels)
        return err_set(err, STATUS_INPUT, "a %s plane must have %d channel%s, not %d and %d",
                       plane_kind_name(kind), channels, channels == 1 ? "" : "s", a->channels,
                       b->channels);
    TRY(labels_check_ids(a->width, a->height, id_a, id_b, err));
    CompareResult made = result_start(kind, a->width, a->height, id_a, tolerance);
    made.bits = 32;
    Labels labels = {0};
    double *errors = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(labels_init(&labels, a->width, a->height, err));
    label_seen(kind, a, b, &labels, &made);
    TRY_GOTO(labels_measure(&labels, &made, err));
    TRY_GOTO(mem_calloc(&errors, made.common_pixels, sizeof *errors, "errors of pixels", err));
    measure_errors(kind, a, b, &labels, errors, &made);
    result_finish(&made, id_a, id_b);
    *result = made;
done:
    free(errors);
    labels_release(&labels);
    return status;
}

Status compare_ids(const IdPlane *a, const IdPlane *b, const Tolerance *tolerance,
                   CompareResult *result, Err *err)
{
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    CompareResult made = result_start(PLANE_ID, a->width, a->height, a, tolerance);
    made.bits = 24;
    Labels labels;
    labels_from_ids(&labels, a, b);
    TRY(labels_measure(&labels, &made, err));
    size_t i = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++, i++) {
            if (!labels_classify(&labels, i, labels_in_band(&labels, x, y), &made.classes)) {
                made.classes.identical++;
                continue;
            }
            if (made.differing_pixels++ == 0)
                made.worst = (PixelPlace){.x = x, .y = y};
        }
    made.beyond_pixels = made.differing_pixels;
    result_finish(&made, a, b);
    *result = made;
    return STATUS_OK;
}
