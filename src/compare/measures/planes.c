/* Compares depth, normal and id planes. The value of a pixel itself states whether it shows a
 * surface, so coverage needs no id planes. */
#include "compare/measures/planes.h"

#include "compare/measures/labels.h"
#include "compare/pixels.h"
#include "compare/rules/judge.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Returns true if a known cause explains the pixel's difference, which then does not count. */
static bool is_settled(const Tolerance *tolerance, size_t pixel)
{
    return tolerance->settled && tolerance->settled[pixel];
}

typedef enum Seen { SEEN_NOTHING, SEEN_SURFACE, SEEN_NAN } Seen;

/* Returns what a value shows. A positive infinite depth, or a normal of 0, shows nothing. */
static Seen seen_at(PlaneKind kind, const float *value)
{
    if (kind == PLANE_DEPTH)
        return isfinite(*value) ? SEEN_SURFACE : *value > 0 ? SEEN_NOTHING : SEEN_NAN;
    if (!isfinite(value[0]) || !isfinite(value[1]) || !isfinite(value[2]))
        return SEEN_NAN;
    return value[0] == 0 && value[1] == 0 && value[2] == 0 ? SEEN_NOTHING : SEEN_SURFACE;
}

static double plane_error(PlaneKind kind, const float *a, const float *b)
{
    return kind == PLANE_DEPTH ? fabs((double)*a - (double)*b) : angle_deg(a, b);
}

/* Labels the pixels that show a surface, and counts values that are not numbers. A pixel with such
 * a value shows nothing. */
static void label_seen(PlaneKind kind, const Plane *a, const Plane *b, Labels *labels,
                       CompareResult *result)
{
    size_t n = result_count(result, MEASURE_PIXELS), channels = (size_t)a->channels;
    for (size_t i = 0; i < n; i++) {
        Seen in_a = seen_at(kind, a->values + i * channels);
        Seen in_b = seen_at(kind, b->values + i * channels);
        bool is_nan = in_a == SEEN_NAN || in_b == SEEN_NAN;
        result->values[MEASURE_NAN_PIXELS] += (in_a == SEEN_NAN) + (in_b == SEEN_NAN);
        if (is_nan && result->places[PLACE_NAN].x < 0)
            result->places[PLACE_NAN] = pixel_place(i, a->width);
        labels->given[0][i] = !is_nan && in_a == SEEN_SURFACE;
        labels->given[1][i] = !is_nan && in_b == SEEN_SURFACE;
    }
}

/* Measures the pixels seen in both images. `errors` has space for one number for each of them. */
static void measure_errors(PlaneKind kind, const Plane *a, const Plane *b, const Labels *labels,
                           double *errors, CompareResult *result)
{
    const Tolerance *tolerance = &result->tolerance;
    const double limit =
        tolerance->limits[kind == PLANE_DEPTH ? LIMIT_DEPTH_MAX_MM : LIMIT_NORMAL_MAX_DEG];
    const size_t n = result_count(result, MEASURE_PIXELS), channels = (size_t)a->channels;
    size_t found = 0, differing = result_count(result, MEASURE_UNCOMMON_PIXELS), beyond = 0;
    double worst = -1, *values = result->values;
    for (size_t i = 0; i < n; i++) {
        if (!labels->given[0][i] || !labels->given[1][i])
            continue;
        double error = plane_error(kind, a->values + i * channels, b->values + i * channels);
        differing += error > 0;
        if (is_settled(tolerance, i))
            continue;
        errors[found++] = error;
        beyond += error > limit;
        if (error > worst) {
            worst = error;
            result->places[PLACE_WORST] = pixel_place(i, a->width);
        }
    }
    values[MEASURE_DIFFERING_PIXELS] = (double)differing;
    values[MEASURE_BEYOND_PIXELS] = (double)beyond;
    values[MEASURE_JUDGED_PIXELS] = (double)found;
    if (found == 0)
        return;
    values[MEASURE_MEDIAN] = percentile(errors, found, 0.5);
    values[MEASURE_P99] = percentile(errors, found, 0.99);
    values[MEASURE_MAX] = worst;
}

/* Measures depth differences over the depth in A, of pixels seen in both images. */
static void measure_parts(const Plane *a, const Plane *b, const Labels *labels, double *errors,
                          CompareResult *result)
{
    size_t n = result_count(result, MEASURE_PIXELS), found = 0;
    for (size_t i = 0; i < n; i++)
        if (labels->given[0][i] && labels->given[1][i] && !is_settled(&result->tolerance, i))
            errors[found++] = plane_error(PLANE_DEPTH, a->values + i, b->values + i) /
                              fmax(fabs((double)a->values[i]), DBL_MIN);
    if (found)
        result->values[MEASURE_P99_PART] = percentile(errors, found, 0.99);
}

/* Counts a pixel of the middle row. */
static void count_pixel(const LabelWindow *window, int x, uint8_t *coverage,
                        uint64_t counts[PIXEL_COUNTS], CompareResult *result)
{
    const size_t pixel = (size_t)window->y * (size_t)window->labels->width + (size_t)x;
    const uint32_t a = window->rows[0][1][x], b = window->rows[1][1][x];
    const bool band = window->band[x], differs = a != b;
    const bool settled = differs && is_settled(&result->tolerance, pixel);
    const bool beyond = differs && !settled;
    count_label((LabelPair){a, b, band, settled}, pixel, coverage, counts);
    if (differs && result->kind == PLANE_ID && counts[COUNT_DIFFERING] == 0)
        result->places[PLACE_WORST] = (PixelPlace){.x = x, .y = window->y};
    counts[COUNT_DIFFERING] += differs;
    counts[COUNT_BEYOND] += beyond;
    counts[COUNT_BAND_BEYOND] += band && beyond;
    counts[COUNT_INTERIOR_BEYOND] += !band && beyond;
    result->classes[settled   ? PIXEL_SETTLED
                    : differs ? labels_class(a, b, band)
                              : PIXEL_IDENTICAL]++;
}

/* Measures coverage, regions and edges of any labels, and the classes of pixels. */
static Status measure_labels(const Labels *labels, CompareResult *result, Err *err)
{
    uint8_t *scratch = NULL, *coverage = NULL;
    uint64_t counts[PIXEL_COUNTS] = {0};
    LabelWindow window;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&scratch, label_window_size(labels->width), 1, "rows of labels", err));
    TRY_GOTO(mem_calloc(&coverage, result_count(result, MEASURE_PIXELS), 1, "pixel marks", err));
    label_window_open(&window, labels, 0, scratch);
    for (int y = 0; y < labels->height; y++) {
        for (int x = 0; x < labels->width; x++)
            count_pixel(&window, x, coverage, counts, result);
        if (y + 1 < labels->height)
            label_window_next(&window);
    }
    result_set_counts(counts, true, result);
    status = result_set_region(coverage, labels, result, err);
done:
    free(scratch);
    free(coverage);
    return status;
}

Status compare_planes(PlaneKind kind, const Rendering *of_a, const Rendering *of_b,
                      const Tolerance *tolerance, CompareResult *result, Err *err)
{
    const Plane *a = kind == PLANE_DEPTH ? of_a->depth : of_a->normal;
    const Plane *b = kind == PLANE_DEPTH ? of_b->depth : of_b->normal;
    TRY(check_sizes(a->width, a->height, b->width, b->height, err));
    int channels = kind == PLANE_DEPTH ? 1 : 3;
    if (a->channels != channels || b->channels != channels)
        return err_set(err, STATUS_INPUT, "a %s plane must have %d channel%s, not %d and %d",
                       plane_kind_name(kind), channels, channels == 1 ? "" : "s", a->channels,
                       b->channels);
    TRY(labels_check_ids(a->width, a->height, of_a->ids, of_b->ids, err));
    CompareResult made = result_start(kind, a->width, a->height, of_a->ids, tolerance);
    made.values[MEASURE_BITS] = 32;
    Labels labels = {0};
    double *errors = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(labels_init_given(&labels, a->width, a->height, err));
    label_seen(kind, a, b, &labels, &made);
    TRY_GOTO(measure_labels(&labels, &made, err));
    TRY_GOTO(mem_calloc(&errors, result_count(&made, MEASURE_COMMON_PIXELS), sizeof *errors,
                        "errors of pixels", err));
    measure_errors(kind, a, b, &labels, errors, &made);
    if (kind == PLANE_DEPTH)
        measure_parts(a, b, &labels, errors, &made);
    result_finish(&made, of_a->ids, of_b->ids);
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
    made.values[MEASURE_BITS] = 24;
    Labels labels = labels_from_ids(a, b);
    TRY(measure_labels(&labels, &made, err));
    result_finish(&made, a, b);
    *result = made;
    return STATUS_OK;
}
