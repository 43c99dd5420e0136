/* Compares the depths that POV-Ray found (a) with the proven depths of a surface (b), pixel by
 * pixel, by a plane of allowed differences. An infinite allowed difference marks a ray that grazes
 * the surface; its pixel is not judged. */
#include "compare/checks/surface_check.h"

#include "compare/pixels.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The planes of a check. */
typedef struct SurfaceCheckPlanes {
    const Plane *a, *b, *allowed;
} SurfaceCheckPlanes;

/* Counts one pixel. Appends its error to `errors` if it is common. */
static void count_pixel(const SurfaceCheckPlanes *planes, size_t i, SurfaceCheck *check,
                        double *errors)
{
    const double a = (double)planes->a->values[i], b = (double)planes->b->values[i];
    const double allowed = (double)planes->allowed->values[i];
    bool in_a = isfinite(a), in_b = isfinite(b);
    if (!in_a && !in_b)
        return;
    if (isinf(allowed)) {
        check->grazing++;
        return;
    }
    check->missing += !in_b;
    check->extra += !in_a;
    if (!in_a || !in_b)
        return;
    double error = fabs(a - b);
    errors[check->common++] = error;
    check->beyond += !(error <= allowed);
    if (!(error / allowed <= check->max_ratio)) {
        check->max_ratio = error / allowed;
        check->worst_x = (int)(i % (size_t)planes->a->width);
        check->worst_y = (int)(i / (size_t)planes->a->width);
    }
}

static void judge(SurfaceCheck *check)
{
    check->agrees = check->missing == 0 && check->extra == 0 && check->beyond == 0;
    check->reason[0] = '\0';
    if (check->missing || check->extra)
        snprintf(check->reason, sizeof check->reason,
                 "surface: hits found only by POV-Ray: %zu, only by proof: %zu, on rays that do "
                 "not graze",
                 check->missing, check->extra);
    else if (check->beyond)
        snprintf(check->reason, sizeof check->reason,
                 "surface: %zu pixels are farther from the surface than POV-Ray's accuracy allows, "
                 "the worst by a factor of %.3g at (%d, %d)",
                 check->beyond, check->max_ratio, check->worst_x, check->worst_y);
}

Status surface_check(const Plane *a, const Plane *b, const Plane *allowed, SurfaceCheck *out,
                     Err *err)
{
    if (a->width != b->width || a->height != b->height || a->width != allowed->width ||
        a->height != allowed->height)
        return err_set(err, STATUS_INPUT,
                       "the depth planes differ in size: %d x %d, %d x %d and %d x %d pixels",
                       a->width, a->height, b->width, b->height, allowed->width, allowed->height);
    SurfaceCheck check = {.pixels = (size_t)a->width * (size_t)a->height,
                          .median_mm = NAN,
                          .p99_mm = NAN,
                          .max_mm = NAN,
                          .worst_x = -1,
                          .worst_y = -1};
    const SurfaceCheckPlanes planes = {a, b, allowed};
    double *errors;
    TRY(mem_calloc(&errors, check.pixels, sizeof *errors, "errors of pixels", err));
    for (size_t i = 0; i < check.pixels; i++)
        count_pixel(&planes, i, &check, errors);
    if (check.common) {
        check.median_mm = percentile(errors, check.common, 0.5);
        check.p99_mm = percentile(errors, check.common, 0.99);
        check.max_mm = percentile(errors, check.common, 1);
    }
    free(errors);
    judge(&check);
    *out = check;
    return STATUS_OK;
}
