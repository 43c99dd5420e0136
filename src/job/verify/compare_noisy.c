/* Decides whether two pictures of path tracers differ by more than their noise. The variance of the
 * noise of a pixel comes from a file of variances, or from several renderings of the scene. */
#include "job/verify/compare_parts.h"

#include <stdlib.h>
#include <string.h>

/* Reads a file of any kind as linear colors. */
static Status read_colors(Plane *plane, const char *path, Err *err)
{
    Image image = {0};
    TRY(image_read(&image, path, ALPHA_REFUSED, NULL, err));
    if (image.plane.values) {
        *plane = image.plane;
        return STATUS_OK;
    }
    Status status = plane_from_picture(plane, &image.picture, err);
    image_release(&image);
    return status;
}

/* Computes the variance of each value from renderings, whose names are separated by commas. */
static Status variance_of_renderings(Plane *variance, const char *names, Err *err)
{
    /* A variance needs two renderings. All are in memory at the same time, so 64 limits the memory;
     * reason of the number not recorded. */
    enum { FEWEST = 2, MOST = 64 };
    Plane planes[MOST] = {{0}};
    size_t n = 0;
    char *copy = NULL, *rest = NULL;
    Status status;
    TRY(mem_strdup(&copy, names, err));
    for (char *name = strtok_r(copy, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
        if (n == MOST)
            TRY_GOTO(err_set(err, STATUS_USAGE, "--noise takes at most %d files", MOST));
        TRY_GOTO(read_colors(&planes[n], name, err));
        n++;
    }
    if (n < FEWEST)
        TRY_GOTO(err_set(err, STATUS_USAGE,
                         "--noise is '%s'; it must name at least %d more renderings of the scene, "
                         "with commas between them; use --variance for a file of variances",
                         names, FEWEST));
    status = noise_of_renderings(planes, n, variance, err);
done:
    for (size_t i = 0; i < n; i++)
        plane_release(&planes[i]);
    free(copy);
    return status;
}

/* Reads the variance of each value. Codes of 8 or 16 bits are a picture, not variances. */
static Status read_variance(Plane *variance, const char *path, Err *err)
{
    Image image = {0};
    TRY(image_read(&image, path, ALPHA_REFUSED, NULL, err));
    if (image.plane.values) {
        *variance = image.plane;
        return STATUS_OK;
    }
    int bits = image.picture.bits;
    image_release(&image);
    return err_set(err, STATUS_INPUT,
                   "%s: holds integers of %d bits; --variance needs floats (PFM, OpenEXR or TIFF)",
                   path, bits);
}

json_t *noise_json(const NoiseResult *result)
{
    return JSON_OBJECT(
        {"verdict", json_text(result->agrees ? "agree" : "differ")},
        {"alarm_rate", json_number(result->rate)}, {"sigmas", json_number(result->sigmas)},
        {"sigmas_allowed", json_number(result->limit)}, {"gain", json_number(result->gain)},
        {"tile_sigmas", json_number(result->tile_sigmas)},
        {"tile_sigmas_allowed", json_number(result->tile_limit)});
}

void noise_text(const NoiseResult *result, Text *out)
{
    text_printf(out,
                "%s (noise test, false alarm rate %.3g): B is %.5g times as bright as A (%.3g "
                "sigmas, limit %.3g); worst block of 32 x 32 pixels: %.3g sigmas (limit %.3g), "
                "upper left pixel (%d, %d)\n",
                result->agrees ? "agree" : "differ", result->rate, result->gain, result->sigmas,
                result->limit, result->tile_sigmas, result->tile_limit, result->tile.x,
                result->tile.y);
}

Status compare_noisy(const CompareOptions *options, const Parsed *parsed, NoiseResult *result,
                     Err *err)
{
    Plane a = {0}, b = {0}, variance = {0};
    Status status = STATUS_OK;
    TRY_GOTO(read_colors(&a, parsed->operands[0], err));
    TRY_GOTO(read_colors(&b, parsed->operands[1], err));
    if (options->variance)
        TRY_GOTO(read_variance(&variance, options->variance, err));
    else
        TRY_GOTO(variance_of_renderings(&variance, options->noise, err));
    status = compare_noise(&a, &b, &variance, options->alarms, result, err);
done:
    plane_release(&a);
    plane_release(&b);
    plane_release(&variance);
    return status;
}
