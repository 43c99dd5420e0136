/* Names planes and classes of pixels in files and texts, and writes the sentence about a result. */
#include "compare/result.h"

#include <stdio.h>

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

void pixelrect_include(PixelRect *rect, int x, int y)
{
    const int right = rect->left + rect->width, bottom = rect->top + rect->height;
    if (rect->width == 0) {
        *rect = (PixelRect){x, y, 1, 1};
        return;
    }
    rect->left = x < rect->left ? x : rect->left;
    rect->top = y < rect->top ? y : rect->top;
    rect->width = (x + 1 > right ? x + 1 : right) - rect->left;
    rect->height = (y + 1 > bottom ? y + 1 : bottom) - rect->top;
}

void result_sentence(const CompareResult *result, char *out, size_t size)
{
    const PixelRect *box = &result->box;
    const double area = (double)box->width * box->height;
    char cause[sizeof result->cause + 40] = "";
    if (*result->cause)
        snprintf(cause, sizeof cause, "likely cause: %s; ", result->cause);
    else if (box->width > 0 && 2 * area < result->values[MEASURE_PIXELS])
        snprintf(cause, sizeof cause,
                 "cause unknown, but all differences are in the %d x %d pixels at (%d, %d); ",
                 box->width, box->height, box->left, box->top);
    else if (result->kind == PLANE_COLOR)
        snprintf(cause, sizeof cause, "cause unknown; ");
    snprintf(out, size, "%s%s", cause, result->reason);
}
