/* Draws the depths and ids of a scene with the ray tracer Tachyon, a witness independent of
 * POV-Ray.
 *
 * Tachyon draws both planes from one scene. The id plane uses Tachyon's low shading, which shows
 * the flat colors of the segments unchanged; a color encodes an id. The depth plane uses the medium
 * shading. The scene has no lights, so the segments are black, and a fog whose density grows
 * linearly along the ray covers them. Tachyon truncates codes, so half a step is added to each
 * depth. */
#include "oracle/tachyon.h"

#include "oracle/planes.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the program ----------------------------------------------------------------------------- */

typedef enum TachyonPlane { TACHYON_ID, TACHYON_DEPTH, TACHYON_PLANES } TachyonPlane;

/* A run of Tachyon. All pointers are borrowed. */
typedef struct TachyonPlaneRun {
    const TachyonParams *params;
    TachyonPlane plane;
    const char *scene, *output; /* files */
} TachyonPlaneRun;

static const Camera *camera_of(const TachyonPlaneRun *run)
{
    return &run->params->emit.scene->view.camera;
}

static Status add_arguments(const void *context, const ProgramPaths *paths, Arguments *arguments,
                            Err *err)
{
    const TachyonPlaneRun *run = context;
    const TachyonParams *params = run->params;
    const bool ids = run->plane == TACHYON_ID;
    const char *const words[] = {params->program.path ? params->program.path : "tachyon",
                                 paths->scene,
                                 ids ? "-lowshade" : "-mediumshade",
                                 "-format",
                                 ids ? "PPM" : "PPM48",
                                 "-o",
                                 paths->picture};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        TRY(arguments_add(arguments, err, "%s", words[i]));
    if (params->threads == 0)
        return STATUS_OK;
    TRY(arguments_add(arguments, err, "-numthreads"));
    return arguments_add(arguments, err, "%d", params->threads);
}

/* Returns true if the file is a picture of the expected size, channels and bits. */
static bool is_whole_picture(const char *path, const TachyonPlaneRun *run)
{
    Picture picture;
    Err ignored;
    if (picture_read(&picture, path, ALPHA_REFUSED, &ignored) != STATUS_OK)
        return false;
    bool whole = picture.width == camera_of(run)->width &&
                 picture.height == camera_of(run)->height && picture.channels == 3 &&
                 picture.bits == (run->plane == TACHYON_ID ? 8 : 16);
    picture_release(&picture);
    return whole;
}

/* Writes the line of the output that reports an error. Tachyon exits with 0 even then. */
static void reason_of_failure(const Text *printed, char *reason, size_t size)
{
    static const char *const marks[] = {"rror", "ailed", "ound"};
    snprintf(reason, size, "it gave no reason");
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        const char *at = strstr(text_chars(printed), marks[i]);
        if (!at)
            continue;
        while (at > text_chars(printed) && at[-1] != '\n')
            at--;
        snprintf(reason, size, "%.*s", (int)strcspn(at, "\n"), at);
        return;
    }
}

static Status judge(const void *context, const Text *printed, int exit_status, const char *picture,
                    Err *err)
{
    const TachyonPlaneRun *run = context;
    char reason[200];
    if (exit_status == 0 && is_whole_picture(picture, run))
        return STATUS_OK;
    reason_of_failure(printed, reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "Tachyon drew no picture of %s (exit status %d): %s",
                   run->scene, exit_status, reason);
}

static void read_version(const Text *printed, char version[16])
{
    static const char mark[] = "Version ";
    const char *at = strstr(text_chars(printed), mark);
    const char *start = at ? at + strlen(mark) : "unknown";
    snprintf(version, 16, "%.*s", (int)(at ? strspn(start, "0123456789.") : strlen(start)), start);
}

static Status draw_plane(const TachyonPlaneRun *run, TachyonRun *took, Err *err)
{
    Text printed = TEXT_INIT;
    double seconds;
    const Program program = {.name = "Tachyon",
                             .package = "tachyon",
                             .scene = run->scene,
                             .output = run->output,
                             .choice = run->params->program,
                             .add_arguments = add_arguments,
                             .judge = judge,
                             .context = run};
    Status status;
    TRY_GOTO(program_draw(&program, &printed, &seconds, err));
    took->seconds += seconds;
    read_version(&printed, took->version);
done:
    text_release(&printed);
    return status;
}

/* ---- planes ---------------------------------------------------------------------------------- */

/* Converts the codes of Tachyon's depth picture, a fraction of the range of depths, to mm. Pixels
 * without a vessel become infinite. */
static Status take_depth(const Scene *scene, const Picture *picture, Frame *frame, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&scene->view.camera, scene->geometry.bounds, &near_mm, &far_mm);
    TRY(plane_init(&frame->depth, picture->width, picture->height, 1, err));
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++) {
        double fraction = (picture->codes16[3 * i] + 0.5) / 65535;
        frame->depth.values[i] =
            frame->id.ids[i] ? (float)(near_mm + fraction * (far_mm - near_mm)) : HUGE_VALF;
    }
    return STATUS_OK;
}

static Status take_plane(const TachyonPlaneRun *run, Frame *frame, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, run->output, ALPHA_REFUSED, err));
    Status status = run->plane == TACHYON_ID
                        ? ids_take_picture(&frame->id, &picture, err)
                        : take_depth(run->params->emit.scene, &picture, frame, err);
    picture_release(&picture);
    return status;
}

Status tachyon_draw(const TachyonParams *params, Frame *frame, TachyonRun *run, Err *err)
{
    static const char *const names[TACHYON_PLANES] = {
        [TACHYON_ID] = "tachyon.id.ppm", [TACHYON_DEPTH] = "tachyon.depth.ppm"};
    EmitParams emit = params->emit;
    char *scene = NULL, *path = NULL;
    Status status;
    run->seconds = 0;
    emit.planes = true;
    TRY_GOTO(file_join(params->folder, "scene.tachyon", &scene, err));
    TRY_GOTO(oracle_write_scene(&emit, "tachyon", scene, err));
    for (TachyonPlane plane = 0; plane < TACHYON_PLANES; plane++) {
        free(path);
        path = NULL;
        TRY_GOTO(file_join(params->folder, names[plane], &path, err));
        const TachyonPlaneRun one = {params, plane, scene, path};
        TRY_GOTO(draw_plane(&one, run, err));
        TRY_GOTO(take_plane(&one, frame, err));
    }
done:
    free(scene);
    free(path);
    return status;
}
