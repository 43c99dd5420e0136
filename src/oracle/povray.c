/* Formats POV-Ray's command line, interprets its output, and decodes its planes.
 *
 * POV-Ray prints everything to standard error. First comes a banner with its version. Progress
 * lines such as "Rendered 120 of 400 pixels (30%)" follow, which end in a carriage return. The
 * reason of a failure is near the end, between statistics.
 *
 * A plane is a picture whose pixels encode colors, depth, normals or ids [povray_decode_plane]. */
#include "oracle/povray.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The version follows this text in the banner. */
static const char banner_mark[] = "Ray Tracer Version ";

static int bits_of(const PovrayParams *params)
{
    if (params->plane == POVRAY_COLOR)
        return params->bits;
    return params->plane == POVRAY_ID || params->plane == POVRAY_ALPHA ? 8 : 16;
}

static bool has_alpha(const PovrayParams *params)
{
    return params->plane == POVRAY_ALPHA || (params->plane == POVRAY_COLOR && params->alpha);
}

/* POV-Ray counts rows and columns from 1. It interprets an end of 1 or less as a fraction of the
 * picture; MIN_TILE_SIDE keeps ends above 1. */
static Status add_part(const PixelRect *part, Arguments *arguments, Err *err)
{
    TRY(arguments_add(arguments, err, "+SC%d", part->left + 1));
    TRY(arguments_add(arguments, err, "+EC%d", part->left + part->width));
    TRY(arguments_add(arguments, err, "+SR%d", part->top + 1));
    return arguments_add(arguments, err, "+ER%d", part->top + part->height);
}

/* Sets every switch that a user's povray.ini could set, so that pictures do not depend on that
 * file. */
static Status add_arguments(const void *context, const ProgramPaths *paths, Arguments *arguments,
                            Err *err)
{
    const PovrayParams *params = context;
    bool alpha = params->plane == POVRAY_ALPHA, color = params->plane == POVRAY_COLOR || alpha;
    bool deep = bits_of(params) == 16;
    TRY(arguments_add(arguments, err, "%s",
                      params->program.path ? params->program.path : "povray"));
    TRY(arguments_add(arguments, err, "+I%s", paths->scene));
    if (!color)
        TRY(arguments_add(arguments, err, "+HI%s", paths->header));
    TRY(arguments_add(arguments, err, "+O%s", paths->picture));
    TRY(arguments_add(arguments, err, "+W%d", params->width));
    TRY(arguments_add(arguments, err, "+H%d", params->height));
    if (params->part.width > 0)
        TRY(add_part(&params->part, arguments, err));
    TRY(arguments_add(arguments, err, "+FN%d", deep ? 16 : 8));
    TRY(arguments_add(arguments, err, "File_Gamma=%s", color && !deep ? "srgb" : "1.0"));
    TRY(arguments_add(arguments, err, "Declare=Corcast_Plane=%d",
                      alpha ? (int)POVRAY_COLOR : (int)params->plane));
    if (alpha)
        TRY(arguments_add(arguments, err, "Declare=Background_Transmit=1"));
    if (color && params->antialias > 1) {
        TRY(arguments_add(arguments, err, "+A0.0"));
        TRY(arguments_add(arguments, err, "+AM1"));
        TRY(arguments_add(arguments, err, "+R%d", params->antialias));
        TRY(arguments_add(arguments, err, "-J"));
    } else {
        TRY(arguments_add(arguments, err, "-A"));
    }
    TRY(arguments_add(arguments, err, has_alpha(params) ? "+UA" : "-UA"));
    if (params->clock > 0) {
        char clock[NUMBER_TEXT_SIZE];
        TRY(arguments_add(arguments, err, "+K%s", number_text(params->clock, clock)));
    }
    if (params->threads > 0)
        TRY(arguments_add(arguments, err, "+WT%d", params->threads));
    static const char *const always[] = {"+Q9", "-TH", "-C", "-D", "+GW", "+V"};
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        TRY(arguments_add(arguments, err, "%s", always[i]));
    return STATUS_OK;
}

Status povray_command(const PovrayParams *params, char **out, Err *err)
{
    Arguments arguments = {0};
    Text line = TEXT_INIT;
    const ProgramPaths paths = {file_name(params->scene), POVRAY_PLANES_FILE,
                                file_name(params->output)};
    Status status = add_arguments(params, &paths, &arguments, err);
    for (int i = 0; i < arguments.n; i++) {
        text_puts(&line, i ? " " : "");
        text_put_shell_word(&line, arguments.list[i]);
    }
    arguments_release(&arguments);
    if (status == STATUS_OK)
        status = text_take(&line, out, err);
    text_release(&line);
    return status;
}

/* Returns the start of the last line that contains `mark`, or NULL. */
static const char *last_line_with(const char *printed, const char *mark)
{
    const char *found = NULL;
    for (const char *at = printed; (at = strstr(at, mark)); at++)
        found = at;
    while (found && found > printed && found[-1] != '\n')
        found--;
    return found;
}

/* Returns the start of the last LAST_LINES lines that are not empty. Larger: longer errors, which
 * more likely contain the reason. */
static const char *last_lines(const char *printed)
{
    enum { LAST_LINES = 3 };
    const char *start = printed + strlen(printed);
    int lines = 0;
    while (start > printed && lines < LAST_LINES) {
        const char *end = start;
        start--;
        while (start > printed && start[-1] != '\n')
            start--;
        lines += end - start > 1;
    }
    return start;
}

/* Returns the start of the reason of a failure. Lines before the banner concern POV-Ray's settings
 * and state no reason. The last error is the error that ended POV-Ray. If there is no error, the
 * last lines are returned. */
static const char *start_of_reason(const char *printed)
{
    static const char *const marks[] = {"rror:", "Fatal error", "annot "};
    const char *banner = strstr(printed, banner_mark), *start = NULL;
    for (size_t i = 0; !start && i < sizeof marks / sizeof *marks; i++)
        start = last_line_with(banner ? banner : printed, marks[i]);
    return start ? start : last_lines(printed);
}

/* Writes the reason of a failure as one line. Replaces the private name of the scene by `scene`. */
static void reason_of_failure(const Text *log, const char *scene, char *reason, size_t size)
{
    static const char given[] = PROGRAM_FOLDER PROGRAM_SCENE;
    const char *printed = text_chars(log), *start = printed ? start_of_reason(printed) : NULL;
    size_t length = 0;
    for (; start && *start && length + 1 < size; start++) {
        if (*start == '\n') {
            if (strncmp(start + 1, "Fatal error", 11) == 0 ||
                strncmp(start + 1, "Render failed", 13) == 0 || start[1] == '\0')
                break;
            if (length > 0 && reason[length - 1] != ' ')
                reason[length++] = ' ';
        } else if (strncmp(start, given, sizeof given - 1) == 0) {
            length += (size_t)snprintf(reason + length, size - length, "%s", scene);
            length = length < size ? length : size - 1;
            start += sizeof given - 2;
        } else {
            reason[length++] = *start;
        }
    }
    while (length > 0 && reason[length - 1] == ' ')
        length--;
    reason[length] = '\0';
}

static void read_version(const Text *log, char *version, size_t size)
{
    const char *start = strstr(text_chars(log), banner_mark);
    snprintf(version, size, "unknown");
    if (start) {
        start += sizeof banner_mark - 1;
        size_t length =
            strspn(start, "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-_+");
        snprintf(version, size, "%.*s", (int)length, start);
    }
}

/* Returns true if a file is a PNG of the expected size, channels and bits, complete up to its end
 * mark. */
static bool is_whole_picture(const char *path, const PovrayParams *params)
{
    static const unsigned char begin[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    static const unsigned char end[] = "\0\0\0\0IEND\xae\x42\x60\x82";
    enum { BEGIN = sizeof begin - 1, HEADER = BEGIN + 10, END = sizeof end - 1, RGB = 2, RGBA = 6 };
    unsigned char header[HEADER] = {0}, tail[END] = {0};
    struct stat about;
    FILE *file = lstat(path, &about) == 0 && S_ISREG(about.st_mode) ? fopen(path, "rb") : NULL;
    if (!file)
        return false;
    bool read = fread(header, HEADER, 1, file) == 1 && fseeko(file, -END, SEEK_END) == 0 &&
                fread(tail, END, 1, file) == 1;
    fclose(file);
    const uint32_t sides[] = {(uint32_t)params->width, (uint32_t)params->height};
    for (int i = 0; i < 8; i++)
        read = read && header[BEGIN + i] == (sides[i / 4] >> (24 - 8 * (i % 4)) & 255);
    return read && memcmp(header, begin, BEGIN) == 0 && header[BEGIN + 8] == bits_of(params) &&
           header[BEGIN + 9] == (has_alpha(params) ? RGBA : RGB) && memcmp(tail, end, END) == 0;
}

/* Returns true once POV-Ray has completed the picture. It then prints the time that it took, within
 * the LAST bytes of its output, and exits 0.3 s later. If LAST is too small, POV-Ray's own end is
 * awaited; if it is large, more text is searched each time. */
static bool is_done(const void *context, const Text *printed, const char *picture)
{
    enum { LAST = 400 };
    const char *chars = text_chars(printed);
    if (!chars)
        return false;
    const char *last = chars + (printed->length > LAST ? printed->length - LAST : 0);
    return strstr(last, "Trace Time:") && is_whole_picture(picture, context);
}

static Status judge(const void *context, const Text *printed, int exit_status, const char *picture,
                    Err *err)
{
    const PovrayParams *params = context;
    char reason[700];
    if (exit_status == 0 && is_whole_picture(picture, params))
        return STATUS_OK;
    if (exit_status == 0)
        return err_set(
            err, STATUS_TOOL,
            "POV-Ray ended without a complete picture of %s: expected a PNG of %d x %d pixels with "
            "%d x %d bits",
            params->scene, params->width, params->height, has_alpha(params) ? 4 : 3,
            bits_of(params));
    reason_of_failure(printed, file_name(params->scene), reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "POV-Ray failed on %s (exit status %d): %s", params->scene,
                   exit_status, reason[0] ? reason : "it gave no reason");
}

Status povray_draw(const PovrayParams *params, PovrayRun *run, Err *err)
{
    Text printed = TEXT_INIT;
    double seconds;
    const Program program = {.name = "POV-Ray",
                             .package = "povray",
                             .scene = params->scene,
                             .header = params->planes,
                             .output = params->output,
                             .choice = params->program,
                             .progress = params->progress,
                             .progress_context = params->progress_context,
                             .add_arguments = add_arguments,
                             .judge = judge,
                             .is_done = is_done,
                             .executable = "povray",
                             .context = params};
    Status status = program_draw(&program, &printed, &seconds, err);
    if (status == STATUS_OK && run) {
        run->seconds = seconds;
        read_version(&printed, run->version, sizeof run->version);
    }
    text_release(&printed);
    return status;
}

/* ---- planes ---------------------------------------------------------------------------------- */

/* Decodes depths: red and green are the high and the low digit of the fraction of the depth range,
 * in base 65535. Blue is 0 where nothing is visible. */
static Status take_depth(const Picture *picture, const Scene *scene, Plane *depth, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&scene->view.camera, scene->geometry.bounds, &near_mm, &far_mm);
    TRY(plane_init(depth, picture->width, picture->height, 1, err));
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *code = &picture->codes16[3 * i];
        double fraction = (code[0] + code[1] / 65535.0) / 65535.0;
        depth->values[i] =
            code[2] > 0 ? (float)(near_mm + fraction * (far_mm - near_mm)) : HUGE_VALF;
    }
    return STATUS_OK;
}

/* Takes the ids from the blue channel of a picture of depth and ids. */
static Status take_blue_ids(const Picture *picture, IdPlane *ids, Err *err)
{
    TRY(idplane_init(ids, picture->width, picture->height, err));
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++)
        ids->ids[i] = picture->codes16[3 * i + 2];
    return STATUS_OK;
}

/* Decodes normals: a channel is a component from -1 to 1, mapped to the codes. */
static Status take_normal(const Picture *picture, Plane *normal, Err *err)
{
    TRY(plane_init(normal, picture->width, picture->height, 3, err));
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *code = &picture->codes16[3 * i];
        if (code[0] == 0 && code[1] == 0 && code[2] == 0)
            continue; /* nothing is visible: no unit vector is (-1, -1, -1) */
        double xyz[3], square = 0;
        for (int c = 0; c < 3; c++) {
            xyz[c] = 2 * code[c] / 65535.0 - 1;
            square += xyz[c] * xyz[c];
        }
        for (int c = 0; c < 3; c++)
            normal->values[3 * i + (size_t)c] = (float)(xyz[c] / sqrt(square));
    }
    return STATUS_OK;
}

Status picture_take_alpha(Picture *alpha, const Picture *picture, Err *err)
{
    size_t channels = (size_t)picture->channels,
           n = (size_t)picture->width * (size_t)picture->height;
    TRY(picture_init(alpha, picture->width, picture->height, 1, 8, err));
    for (size_t i = 0; i < n; i++)
        alpha->codes8[i] = channels == 4 ? picture->codes8[channels * i + 3] : 255;
    return STATUS_OK;
}

Status povray_decode_plane(PovrayPlane plane, Picture *picture, const Scene *scene,
                           OraclePlanes *planes, Err *err)
{
    const bool deep = plane == POVRAY_DEPTH || plane == POVRAY_NORMAL || plane == POVRAY_DEPTH_ID;
    Frame *frame = &planes->frame;
    if (deep && (picture->channels != 3 || picture->bits != 16))
        return err_set(err, STATUS_INPUT,
                       "is not a plane that POV-Ray wrote: it must have 3 channels of 16 bits");
    switch (plane) {
    case POVRAY_COLOR:
        planes->picture = *picture;
        *picture = (Picture){0};
        return STATUS_OK;
    case POVRAY_DEPTH_ID:
        TRY(take_blue_ids(picture, &frame->id, err));
        return take_depth(picture, scene, &frame->depth, err);
    case POVRAY_DEPTH:
        return take_depth(picture, scene, &frame->depth, err);
    case POVRAY_NORMAL:
        return take_normal(picture, &frame->normal, err);
    case POVRAY_ID:
        return ids_take_picture(&frame->id, picture, err);
    case POVRAY_ALPHA:
        return picture_take_alpha(&planes->alpha, picture, err);
    case POVRAY_PLANES:
        break;
    }
    return STATUS_OK;
}
