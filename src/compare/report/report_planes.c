/* Stores depths and normals in pictures of 8 bits, which the script of the report's page decodes to
 * show the values of a pixel. The pictures of B contain B - A, which is mostly 0, so that they
 * compress well. */
#include "compare/pixels.h"
#include "compare/report/page.h"

#include <math.h>

/* DEPTH_CODES: steps between the nearest and the farthest depth. With 0 for "nothing", the codes go
 * up to 65534 and fit into 16 bits. MOST_PIXELS: larger planes are left out, because the page would
 * become too large for browsers. */
enum { DEPTH_CODES = 65533, MOST_PIXELS = 1 << 22 };
/* Step of the stored angles between normals: below the limits of all tiers, and 16 bits of it reach
 * to 65 degrees; larger angles are stored as 65.535. */
static const double angle_step_deg = 0.001;

/* Stores a two-byte number in red and green. */
static void put_word(Picture *picture, size_t pixel, unsigned word)
{
    picture->codes8[3 * pixel] = (uint8_t)(word >> 8 & 255);
    picture->codes8[3 * pixel + 1] = (uint8_t)(word & 255);
}

static void widen_range(const Plane *depth, double range_mm[2])
{
    for (size_t i = 0; i < (size_t)depth->width * (size_t)depth->height; i++)
        if (isfinite(depth->values[i])) {
            range_mm[0] = fmin(range_mm[0], (double)depth->values[i]);
            range_mm[1] = fmax(range_mm[1], (double)depth->values[i]);
        }
}

/* Returns 0 if no surface is visible, else 1 (nearest) to DEPTH_CODES + 1 (farthest). */
static unsigned depth_code(float depth, const double range_mm[2])
{
    double extent = range_mm[1] - range_mm[0];
    if (!isfinite(depth))
        return 0;
    double fraction = extent > 0 ? ((double)depth - range_mm[0]) / extent : 0;
    return 1 + (unsigned)(fraction * DEPTH_CODES + 0.5);
}

static void fill_depths(const Plane *a, const Plane *b, const double range_mm[2],
                        Picture pictures[REPORT_PLANES])
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++) {
        unsigned in_a = depth_code(a->values[i], range_mm);
        put_word(&pictures[REPORT_DEPTH_A], i, in_a);
        put_word(&pictures[REPORT_DEPTH_B], i, depth_code(b->values[i], range_mm) - in_a);
    }
}

/* Returns 1 to 255 for a component from -1 to 1; 0 if no surface is visible. */
static unsigned normal_code(const float *normal, int axis)
{
    bool seen = normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
    return seen ? (unsigned)(128.5F + 127 * fminf(fmaxf(normal[axis], -1), 1)) : 0;
}

static void fill_normals(const Plane *a, const Plane *b, Picture pictures[REPORT_PLANES])
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height; i++) {
        const float *in_a = a->values + 3 * i, *in_b = b->values + 3 * i;
        for (int axis = 0; axis < 3; axis++) {
            unsigned code = normal_code(in_a, axis);
            pictures[REPORT_NORMAL_A].codes8[3 * i + (size_t)axis] = (uint8_t)code;
            pictures[REPORT_NORMAL_B].codes8[3 * i + (size_t)axis] =
                (uint8_t)(normal_code(in_b, axis) - code);
        }
        if (normal_code(in_a, 0) && normal_code(in_b, 0))
            put_word(&pictures[REPORT_ANGLES], i,
                     (unsigned)fmin(angle_deg(in_a, in_b) / angle_step_deg + 0.5, 65535));
    }
}

/* Appends the pictures from `first` to `last`, or an empty document for each where there are
 * none. */
static Status put_pictures(Picture pictures[REPORT_PLANES], bool filled, ReportPlane first,
                           ReportPlane last, Text *parts[REPORT_PLANES], Err *err)
{
    for (ReportPlane i = first; i <= last; i++) {
        if (filled)
            TRY(picture_put_uri(&pictures[i], parts[i], err));
        else
            text_puts(parts[i], "data:,");
    }
    return STATUS_OK;
}

static bool can_show(const Plane *a, const Plane *b)
{
    return a && b && (double)a->width * a->height <= MOST_PIXELS;
}

Status report_planes(const Rendering *a, const Rendering *b, Text *parts[REPORT_PLANES],
                     double range_mm[2], Err *err)
{
    Picture pictures[REPORT_PLANES] = {0};
    const Picture *size = a->picture;
    bool depths = can_show(a->depth, b->depth), normals = can_show(a->normal, b->normal);
    Status status = STATUS_OK;
    range_mm[0] = (double)INFINITY;
    range_mm[1] = -(double)INFINITY;
    for (ReportPlane i = 0; i < REPORT_PLANES; i++)
        if (i <= REPORT_DEPTH_B ? depths : normals)
            TRY_GOTO(picture_init(&pictures[i], size->width, size->height, 3, 8, err));
    if (depths) {
        widen_range(a->depth, range_mm);
        widen_range(b->depth, range_mm);
        fill_depths(a->depth, b->depth, range_mm, pictures);
    }
    if (normals)
        fill_normals(a->normal, b->normal, pictures);
    TRY_GOTO(put_pictures(pictures, depths, REPORT_DEPTH_A, REPORT_DEPTH_B, parts, err));
    status = put_pictures(pictures, normals, REPORT_NORMAL_A, REPORT_ANGLES, parts, err);
done:
    for (ReportPlane i = 0; i < REPORT_PLANES; i++)
        picture_release(&pictures[i]);
    if (!(range_mm[0] <= range_mm[1]))
        range_mm[0] = range_mm[1] = 0;
    return status;
}
