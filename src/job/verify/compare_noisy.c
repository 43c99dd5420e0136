/* Compares pictures of path tracers. The variance of their noise comes from a file of variances or
 * from several renderings. */
#include "job/verify/compare_options.h"
#include "options/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Linear colours, whatever the file holds. */
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
    enum { FEWEST = 2, MOST = 64 };
    Plane planes[MOST] = {{0}};
    size_t n = 0;
    char *copy = NULL, *rest = NULL;
    Status status = mem_strdup(&copy, names, err);
    char *name = status == STATUS_OK ? strtok_r(copy, ",", &rest) : NULL;
    for (; name && status == STATUS_OK; name = strtok_r(NULL, ",", &rest)) {
        status = n < MOST ? read_colors(&planes[n], name, err)
                          : err_set(err, STATUS_USAGE, "--noise takes at most %d files", MOST);
        n += status == STATUS_OK;
    }
    if (status == STATUS_OK && n < FEWEST)
        status = err_set(err, STATUS_USAGE,
                         "--noise is '%s'; it must name at least %d more renderings of the scene, "
                         "with commas between them; a file of variances is given by --variance",
                         names, FEWEST);
    if (status == STATUS_OK)
        status = noise_of_renderings(planes, n, variance, err);
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

static Status print_noise(const NoiseResult *result, bool json, bool quiet, Err *err)
{
    const JsonMember members[] = {
        {"verdict", json_text(result->agrees ? "agree" : "differ")},
        {"alarm_rate", json_number(result->rate)},
        {"sigmas", json_number(result->sigmas)},
        {"sigmas_allowed", json_number(result->limit)},
        {"gain", json_number(result->gain)},
        {"tile_sigmas", json_number(result->tile_sigmas)},
        {"tile_sigmas_allowed", json_number(result->tile_limit)},
    };
    json_t *object = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (json)
        return json_write(object, "-", err);
    json_decref(object);
    if (!quiet)
        printf("%s (noise, false alarms %.3g): B is %.5g times as bright as A, %.3g sigmas, at "
               "most %.3g allowed; the worst tile of 32 x 32 pixels, %.3g sigmas, at most %.3g "
               "allowed, begins at (%d, %d)\n",
               result->agrees ? "agree" : "differ", result->rate, result->gain, result->sigmas,
               result->limit, result->tile_sigmas, result->tile_limit, result->tile.x,
               result->tile.y);
    return STATUS_OK;
}

Status compare_noisy(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    Plane a = {0}, b = {0}, variance = {0};
    NoiseResult result;
    Status status = STATUS_OK;
    TRY_GOTO(read_colors(&a, parsed->operands[0], err));
    TRY_GOTO(read_colors(&b, parsed->operands[1], err));
    if (options->variance)
        TRY_GOTO(read_variance(&variance, options->variance, err));
    else
        TRY_GOTO(variance_of_renderings(&variance, options->noise, err));
    TRY_GOTO(compare_noise(&a, &b, &variance, options->alarms, &result, err));
    TRY_GOTO(print_noise(&result, options->json, parsed->common.quiet, err));
    status = result.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    plane_release(&a);
    plane_release(&b);
    plane_release(&variance);
    return status;
}
