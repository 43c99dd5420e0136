/* Compares the alpha channels of two pictures whose colors were compared over one background. Two
 * such composites may agree although their alpha differs, if the vessel has the background's color.
 */
#include "compare/measures/planes.h"

#include <math.h>
#include <stdio.h>

Status alpha_of_image(Picture *alpha, const Image *image, Err *err)
{
    const Plane *plane = &image->plane;
    const Picture *picture = &image->picture;
    const bool floats = plane->values != NULL;
    const int channels = floats ? plane->channels : picture->channels;
    if (channels != 2 && channels != 4)
        return STATUS_OK;
    TRY(picture_init(alpha, floats ? plane->width : picture->width,
                     floats ? plane->height : picture->height, 1, 16, err));
    const int scale = picture->bits == 8 ? 257 : 1;
    for (size_t i = 0; i < (size_t)alpha->width * (size_t)alpha->height; i++) {
        size_t at = (i + 1) * (size_t)channels - 1;
        alpha->codes16[i] = floats ? image_code(plane->values[at], ENCODING_LINEAR, 16)
                                   : (uint16_t)(picture_code(picture, at) * scale);
    }
    return STATUS_OK;
}

Status result_judge_alpha(const Picture *a, const Picture *b, CompareResult *result, Err *err)
{
    CompareResult alpha;
    Tolerance tolerance = result->tolerance;
    if (!a->codes16 || !b->codes16 || !result->agrees)
        return STATUS_OK;
    tolerance.title = "alpha";
    tolerance.limits[LIMIT_PIXELMATCH] = (double)NAN; /* pixelmatch looks at alpha itself */
    const Rendering in_a = {.picture = a}, in_b = {.picture = b};
    TRY(compare_pictures(&in_a, &in_b, &tolerance, &alpha, NULL, err));
    if (alpha.agrees)
        return STATUS_OK;
    result->agrees = false;
    snprintf(result->reason, sizeof result->reason, "%s", alpha.reason);
    snprintf(result->cause, sizeof result->cause, "only alpha differs, on %zu pixels",
             result_count(&alpha, MEASURE_DIFFERING_PIXELS));
    return STATUS_OK;
}
