/* Records which differing pixels are settled: a known cause explains what POV-Ray shows there, and
 * corcast is right [docs/METHODS.md, Settled pixels]. One table has the causes, and how many pixels
 * of each a picture may have: parts per million, but at least a few pixels, because in a small
 * picture a millionth is less than one pixel. */
#include "compare/checks/settled.h"

#include "compare/pixels.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Per cause: its names, and the number of pixels that may have it: `ppm` parts per million, or
 * `few` if that is more. With larger numbers a fault that looks like the cause passes; with smaller
 * numbers scenes fail in which only POV-Ray is wrong. How they were chosen is not recorded. */
static const struct {
    const char *name, *sentence;
    double ppm;
    size_t few;
} causes[SETTLED_CAUSES] = {
    [SETTLED_NOT] = {"unexplained", "", 0, 0},
    [SETTLED_ROOT] = {"missed root", "pixels at which POV-Ray missed a root", 40, 6},
    [SETTLED_INEXACT_ROOT] = {"inexact root", "pixels at which POV-Ray's root is a little off", 40,
                              6},
    [SETTLED_SHADOW_ROOT] = {"missed root of a shadow",
                             "pixels at which POV-Ray missed a root on the way to a light", 200,
                             12},
    [SETTLED_SHADOW_CACHE] = {"shadow cache",
                              "pixels on their own horizon, left to POV-Ray's shadow cache", 1000,
                              20},
};

const char *settled_cause_name(SettledCause cause)
{
    return causes[cause].name;
}

const char *settled_cause_sentence(SettledCause cause)
{
    return causes[cause].sentence;
}

Status settled_init(Settled *settled, size_t pixels, SettledCause from, SettledCause to, Err *err)
{
    Settled made = {.pixels = pixels, .from = from, .to = to};
    TRY(mem_calloc(&made.marks, pixels, 1, "pixel marks", err));
    *settled = made;
    return STATUS_OK;
}

void settled_release(Settled *settled)
{
    free(settled->marks);
    *settled = (Settled){0};
}

void settled_note(Settled *settled, size_t index, const SettledPixel *pixel)
{
    settled->examined++;
    settled->count[pixel->cause]++;
    settled->marks[index] = (uint8_t)pixel->cause;
    if (pixel->cause != SETTLED_NOT && settled->n_first < SETTLED_LISTED)
        settled->first[settled->n_first++] = *pixel;
}

size_t settled_allowed(const Settled *settled, SettledCause cause)
{
    size_t allowed = (size_t)(causes[cause].ppm * (double)settled->pixels / 1e6);
    return allowed > causes[cause].few ? allowed : causes[cause].few;
}

void settled_judge(Settled *settled)
{
    settled->agrees = true;
    settled->reason[0] = '\0';
    for (SettledCause cause = settled->from; cause <= settled->to && settled->agrees; cause++) {
        size_t allowed = settled_allowed(settled, cause);
        settled->agrees = settled->count[cause] <= allowed;
        if (!settled->agrees)
            snprintf(settled->reason, sizeof settled->reason,
                     "settled: %s: %zu, at most %zu allowed", causes[cause].sentence,
                     settled->count[cause], allowed);
    }
}

static void put_depth(Text *out, const char *who, double t)
{
    if (isfinite(t))
        text_printf(out, "%s hits a surface at %.9g mm", who, t);
    else
        text_printf(out, "%s hits nothing", who);
}

void settled_describe(const SettledPixel *pixel, const char *name_a, const char *name_b, Text *out)
{
    text_printf(out, "at (%d, %d)", pixel->x, pixel->y);
    if (pixel->id)
        text_printf(out, ", segment %u", pixel->id);
    text_puts(out, ": ");
    put_depth(out, name_a, pixel->a_mm);
    text_puts(out, ", ");
    put_depth(out, name_b, pixel->b_mm);
    if (pixel->cause == SETTLED_ROOT && pixel->a_mm == pixel->b_mm)
        text_puts(out, " in its middle, one of its samples shows it");
    if (isfinite(pixel->root_mm))
        text_printf(out, ", the first root is at %.9g mm", pixel->root_mm);
    if (isfinite(pixel->distance_mm))
        text_printf(out, ", the light is blocked %.6g mm away", pixel->distance_mm);
}

/* ---- which pixels are examined --------------------------------------------------------------- */

/* Returns true if ids differ, or depths or normals by more than the tolerance allows. */
static bool geometry_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                            const Tolerance *tolerance)
{
    double depth_a = (double)a->depth->values[pixel], depth_b = (double)b->depth->values[pixel];
    if (a->ids->ids[pixel] != b->ids->ids[pixel] || isfinite(depth_a) != isfinite(depth_b))
        return true;
    return isfinite(depth_a) && geometry_differs(a, b, pixel, tolerance->limits[LIMIT_DEPTH_MAX_MM],
                                                 tolerance->limits[LIMIT_NORMAL_MAX_DEG]);
}

unsigned pixel_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                      const Tolerance *tolerance)
{
    int off = largest_difference(a->picture, b->picture, pixel);
    return (off > allowed_codes(tolerance, a->picture) ? BEYOND_COLOR : 0u) |
           (geometry_beyond(a, b, pixel, tolerance) ? BEYOND_GEOMETRY : 0u);
}
