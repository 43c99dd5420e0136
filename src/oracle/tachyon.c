/* One scene gives both planes: segments have flat colours, which Tachyon's low shading shows as
 * they are. In its medium shading, fog that grows linearly along the ray covers them; without light
 * they are black. Tachyon truncates codes, so a depth lies half a step beyond its code. */
#include "oracle/tachyon.h"

#include "oracle/tool.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the program ----------------------------------------------------------------------------- */

static Status add_arguments(const void *context, const char *scene, const char *picture,
                            Arguments *arguments, Err *err)
{
    const WitnessParams *params = context;
    const bool ids = params->plane == WITNESS_ID;
    const char *const words[] = {params->program ? params->program : "tachyon",
                                 scene,
                                 ids ? "-lowshade" : "-mediumshade",
                                 "-format",
                                 ids ? "PPM" : "PPM48",
                                 "-o",
                                 picture};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        TRY(arguments_add(arguments, err, "%s", words[i]));
    if (params->threads == 0)
        return STATUS_OK;
    TRY(arguments_add(arguments, err, "-numthreads"));
    return arguments_add(arguments, err, "%d", params->threads);
}

/* Whether what stands there is the picture that was asked for. */
static bool is_whole_picture(const char *path, const WitnessParams *params)
{
    Picture picture;
    Err ignored;
    if (picture_read(&picture, path, ALPHA_REFUSED, &ignored) != STATUS_OK)
        return false;
    bool whole = picture.width == params->width && picture.height == params->height &&
                 picture.channels == 3 && picture.bits == (params->plane == WITNESS_ID ? 8 : 16);
    picture_release(&picture);
    return whole;
}

/* The last line in which it says that something is wrong; it exits with 0 even then. */
static void reason_of_failure(const Text *said, char *reason, size_t size)
{
    static const char *const marks[] = {"rror", "ailed", "ound"};
    snprintf(reason, size, "it gave no reason");
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        const char *at = strstr(text_chars(said), marks[i]);
        if (!at)
            continue;
        while (at > text_chars(said) && at[-1] != '\n')
            at--;
        snprintf(reason, size, "%.*s", (int)strcspn(at, "\n"), at);
        return;
    }
}

static Status judge(const void *context, const Text *said, int exit_status, const char *picture,
                    Err *err)
{
    const WitnessParams *params = context;
    char reason[200];
    if (exit_status == 0 && is_whole_picture(picture, params))
        return STATUS_OK;
    reason_of_failure(said, reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "Tachyon drew no picture of %s (exit status %d): %s",
                   params->scene, exit_status, reason);
}

Status witness_run(const WitnessParams *params, double *seconds, char version[16], Err *err)
{
    static const char mark[] = "Version ";
    Text said = TEXT_INIT;
    const Tool tool = {.name = "Tachyon",
                       .package = "tachyon",
                       .scene = params->scene,
                       .output = params->output,
                       .patience = "CORCAST_POVRAY_PATIENCE",
                       .patience_s = params->patience_s,
                       .add_arguments = add_arguments,
                       .judge = judge,
                       .context = params};
    Status status = tool_draw(&tool, &said, seconds, err);
    const char *at = status == STATUS_OK ? strstr(text_chars(&said), mark) : NULL;
    snprintf(version, 16, "%s", "unknown");
    if (at)
        snprintf(version, 16, "%.*s", (int)strspn(at + strlen(mark), "0123456789."),
                 at + strlen(mark));
    text_release(&said);
    return status;
}

/* ---- planes ---------------------------------------------------------------------------------- */

Status witness_read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    return status;
}

Status witness_read_depth(Plane *depth, const char *path, const IdPlane *ids, double near_mm,
                          double far_mm, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, ALPHA_REFUSED, err));
    Status status = plane_init(depth, picture.width, picture.height, 1, err);
    size_t pixels = (size_t)picture.width * (size_t)picture.height;
    for (size_t i = 0; status == STATUS_OK && i < pixels; i++) {
        double fraction = (picture.codes16[3 * i] + 0.5) / 65535;
        depth->values[i] =
            ids->ids[i] ? (float)(near_mm + fraction * (far_mm - near_mm)) : HUGE_VALF;
    }
    picture_release(&picture);
    return status;
}
