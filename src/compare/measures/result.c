/* What comparisons of all kinds begin with: a result of which nothing is measured yet, the names of
 * planes and of classes of pixels, and the angle between two normals. */
#include "compare/measures/result.h"

#include <math.h>
#include <stdlib.h>

const char *plane_kind_name(PlaneKind kind)
{
    static const char *const names[PLANE_KINDS] = {"color", "depth", "normal", "id"};
    return names[kind];
}

const char *pixel_class_name(PixelClass pixel_class)
{
    static const char *const names[PIXEL_CLASSES] = {[PIXEL_SETTLED] = "settled",
                                                     [PIXEL_MISSING] = "missing",
                                                     [PIXEL_EXTRA] = "extra",
                                                     [PIXEL_EDGE] = "edge",
                                                     [PIXEL_WRONG_SEGMENT] = "wrong_segment",
                                                     [PIXEL_SHADOW] = "shadow",
                                                     [PIXEL_GEOMETRY] = "geometry",
                                                     [PIXEL_SHADING] = "shading",
                                                     [PIXEL_ROUNDING] = "rounding",
                                                     [PIXEL_IDENTICAL] = "identical"};
    return names[pixel_class];
}

const char *result_title(const CompareResult *result)
{
    return result->tolerance.title ? result->tolerance.title : plane_kind_name(result->kind);
}

CompareResult result_start(PlaneKind kind, int width, int height, const IdPlane *ids,
                           const Tolerance *tolerance)
{
    const PixelPlace nowhere = {.x = -1, .y = -1};
    const double unknown = (double)NAN;
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
                           .max_abs = unknown,
                           .unsettled_max_abs = unknown,
                           .mean_abs = unknown,
                           .rmse = unknown,
                           .max_code = unknown,
                           .psnr_db = unknown,
                           .bias_levels = unknown,
                           .sign_sigma = unknown,
                           .interior_max_abs = unknown,
                           .edge_mismatch_fraction = unknown,
                           .silhouette_px = unknown,
                           .gain = unknown,
                           .offset_levels = unknown,
                           .segment_levels = unknown,
                           .segment_px = unknown,
                           .segment_levels_at = nowhere,
                           .segment_px_at = nowhere,
                           .segment_missing_at = nowhere,
                           .flip_mean = unknown,
                           .flip_max = unknown,
                           .hdr_flip_mean = unknown,
                           .ssim = unknown,
                           .de2000_mean = unknown,
                           .de2000_max = unknown,
                           .pixelmatch_pixels = unknown,
                           .median = unknown,
                           .p99 = unknown,
                           .p99_part = unknown,
                           .max = unknown};
}

PixelPlace place_of(size_t pixel, int width)
{
    return (PixelPlace){.x = (int)(pixel % (size_t)width), .y = (int)(pixel / (size_t)width)};
}

Status check_sizes(int width_a, int height_a, int width_b, int height_b, Err *err)
{
    if (width_a == width_b && height_a == height_b)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the images differ in size: %d x %d and %d x %d pixels; only images of one size "
                   "can be compared",
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

int allowed_codes(const Tolerance *tolerance, const Picture *picture)
{
    return (int)floor(tolerance->color_levels * (picture->bits == 8 ? 1 : 257) + 1e-9);
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
