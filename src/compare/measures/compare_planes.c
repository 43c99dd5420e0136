/* Depth, normal and id planes. The values of a pixel say what it shows. */
#include "compare/measures/labels.h"
#include "compare/measures/result.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static bool is_settled(const Tolerance *tolerance, size_t pixel)
{
    return tolerance->settled && tolerance->settled[pixel];
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
        labels->seen[0][i] = in_a == SEEN_SURFACE;
        labels->seen[1][i] = in_b == SEEN_SURFACE;
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
        if (!labels->seen[0][i] || !labels->seen[1][i])
            continue;
        double error = plane_error(kind, a->values + i * channels, b->values + i * channels);
        result->differing_pixels += error > 0;
        if (is_settled(tolerance, i))
            continue;
        errors[found++] = error;
        result->beyond_pixels += error > limit;
        if (error > worst) {
            worst = error;
            result->worst = place_of(i, a->width);
        }
    }
    result->differing_pixels += result->missing_pixels + result->extra_pixels;
    result->judged_pixels = found;
    if (found == 0)
        return;
    result->median = percentile(errors, found, 0.5);
    result->p99 = percentile(errors, found, 0.99);
    result->max = worst;
    if (kind != PLANE_DEPTH)
        return;
    found = 0;
    for (size_t i = 0; i < result->pixels; i++)
        if (labels->seen[0][i] && labels->seen[1][i] && !is_settled(tolerance, i))
            errors[found++] = plane_error(kind, a->values + i, b->values + i) /
                              fmax(fabs((double)a->values[i]), DBL_MIN);
    result->p99_part = percentile(errors, found, 0.99);
}

/* Coverage, regions and the band of any labels; the class of pixels whose labels differ. */
static Status measure_labels(const Labels *labels, CompareResult *result, Err *err)
{
    uint8_t *scratch = NULL, *coverage = NULL;
    size_t band_differs = 0, band_settled = 0;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&scratch, label_window_size(labels->width), 1, "rows of labels", err));
    TRY_GOTO(mem_calloc(&coverage, result->pixels, 1, "pixel marks", err));
    result->has_mask = true;
    LabelWindow window;
    label_window_open(&window, labels, 0, scratch);
    for (int y = 0; y < labels->height; y++) {
        const uint32_t *a = window.rows[0][1], *b = window.rows[1][1];
        for (int x = 0; x < labels->width; x++) {
            size_t pixel = (size_t)y * (size_t)labels->width + (size_t)x;
            bool band = window.band[x], differs = a[x] != b[x];
            bool settled = differs && is_settled(&result->tolerance, pixel);
            result->settled_pixels += settled;
            if (!a[x] != !b[x] && !settled) {
                coverage[pixel] = a[x] ? COVERED_MISSING : COVERED_EXTRA;
                result->missing_pixels += a[x] != 0;
                result->extra_pixels += b[x] != 0;
            }
            result->common_pixels += a[x] && b[x];
            result->band_pixels += band;
            band_differs += band && differs;
            band_settled += band && settled;
            result->classes[settled   ? PIXEL_SETTLED
                            : differs ? labels_class(a[x], b[x], band)
                                      : PIXEL_IDENTICAL]++;
            if (differs && result->kind == PLANE_ID && result->differing_pixels++ == 0)
                result->worst = (PixelPlace){.x = x, .y = y};
        }
        if (y + 1 < labels->height)
            label_window_next(&window);
    }
    result->edge_mismatch_fraction =
        result->band_pixels ? (double)band_differs / (double)result->band_pixels : 0;
    if (result->kind == PLANE_ID) {
        result->beyond_pixels = result->differing_pixels - result->settled_pixels;
        result->band_beyond = band_differs - band_settled;
        result->interior_beyond = result->beyond_pixels - result->band_beyond;
    }
    if (result->missing_pixels + result->extra_pixels > 0)
        status = largest_region(coverage, labels->width, labels->height, &result->largest_region,
                                &result->largest_region_at, err);
done:
    free(scratch);
    free(coverage);
    return status;
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
    TRY_GOTO(labels_init_seen(&labels, a->width, a->height, err));
    label_seen(kind, a, b, &labels, &made);
    TRY_GOTO(measure_labels(&labels, &made, err));
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
    Labels labels = labels_from_ids(a, b);
    TRY(measure_labels(&labels, &made, err));
    result_finish(&made, a, b);
    *result = made;
    return STATUS_OK;
}
