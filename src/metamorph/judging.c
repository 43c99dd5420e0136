/* Each drawing has a scene, a picture and a log in the renderer's folder, with the index of the
 * drawing as name. A drawing without a picture is a finding, not an error: the pair decides what it
 * means. */
#include "metamorph/judging.h"

#include "oracle/shell.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const verdict_names[VERDICT_KINDS] = {[VERDICT_NONE] = "none",
                                                  [VERDICT_HOLDS] = "holds",
                                                  [VERDICT_EDGE] = "edge",
                                                  [VERDICT_SHADE] = "shade",
                                                  [VERDICT_REFUSED] = "refused"};

/* ---- drawing --------------------------------------------------------------------------------- */

/* The files and the command of one drawing; owned. */
typedef struct DrawingJob {
    char *scene, *picture, *log, *command;
} DrawingJob;

static void job_release(DrawingJob *job)
{
    free(job->scene);
    free(job->picture);
    free(job->log);
    free(job->command);
}

static Status name_file(const TrialRenderer *renderer, size_t index, const char *extension,
                        char **path, Err *err)
{
    char name[40];
    snprintf(name, sizeof name, "%zu.%s", index, extension);
    return file_join(renderer->folder, name, path, err);
}

/* Writes the scene and prepares the command. An old picture is removed. */
static Status job_prepare(const TrialRenderer *renderer, const TrialScene *scene, size_t index,
                          DrawingJob *job, Err *err)
{
    const TrialAdapter *adapter = &trial_adapters[renderer->format];
    Text text = TEXT_INIT, command = TEXT_INIT;
    Status status;
    TRY_GOTO(name_file(renderer, index, adapter->name, &job->scene, err));
    TRY_GOTO(name_file(renderer, index, adapter->picture, &job->picture, err));
    TRY_GOTO(name_file(renderer, index, "log", &job->log, err));
    adapter->write(scene, &text);
    TRY_GOTO(file_write_text(job->scene, &text, err));
    remove(job->picture);
    const TrialFiles files = {job->scene, job->picture};
    trial_command(renderer->command, renderer->format, scene, &files, &command);
    status = text_take(&command, &job->command, err);
done:
    text_release(&text);
    text_release(&command);
    return status;
}

/* Copies the last line of a log that is not empty. */
static void last_line(const char *path, char *line, size_t size)
{
    char buffer[4096] = "";
    FILE *file = fopen(path, "rb");
    if (file) {
        if (fseek(file, -(long)(sizeof buffer - 1), SEEK_END) != 0)
            rewind(file);
        buffer[fread(buffer, 1, sizeof buffer - 1, file)] = '\0';
        fclose(file);
    }
    size_t end = strlen(buffer);
    while (end > 0 && strchr("\n\r ", buffer[end - 1]))
        buffer[--end] = '\0';
    const char *start = strrchr(buffer, '\n');
    snprintf(line, size, "%.300s", start ? start + 1 : buffer);
}

static Status read_drawing(const TrialScene *scene, const char *path, TrialDrawing *drawing,
                           Err *err)
{
    static const float black[3] = {0, 0, 0};
    Image image;
    Status status;
    TRY(image_read(&image, path, ALPHA_KEPT, NULL, err));
    TRY_GOTO(image_composite(&image, black, err));
    const int width = image.plane.values ? image.plane.width : image.picture.width;
    const int height = image.plane.values ? image.plane.height : image.picture.height;
    const int channels = image.plane.values ? image.plane.channels : image.picture.channels;
    if (width != scene->width_px || height != scene->height_px || channels != 3)
        TRY_GOTO(err_set(err, STATUS_INPUT,
                         "the picture has %d x %d pixels of %d channels, not %d x %d of 3", width,
                         height, channels, scene->width_px, scene->height_px));
    status = image.plane.values
                 ? picture_from_plane(&drawing->picture, &image.plane, ENCODING_SRGB, 8, err)
                 : picture_to_srgb(&drawing->picture, &image.picture, 8, err);
done:
    image_release(&image);
    return status;
}

/* Writes the clause that tells why a drawing has no picture. */
static void give_reason(const TrialRenderer *renderer, const DrawingJob *job, const ShellEnd *end,
                        const Err *why, char *reason)
{
    char line[320];
    last_line(job->log, line, sizeof line);
    if (end->timed_out)
        snprintf(reason, TRIAL_REASON, "it did not end within %g s", renderer->timeout_s);
    else if (end->exit_status != 0)
        snprintf(reason, TRIAL_REASON, "exit status %d%s%s", end->exit_status, *line ? ": " : "",
                 line);
    else
        snprintf(reason, TRIAL_REASON, "%.390s",
                 file_bytes(job->picture) > 0 ? why->text : "it wrote no picture");
}

/* Reads the picture of a drawing that has ended, or tells why there is none. */
static Status take_drawing(const TrialRenderer *renderer, const TrialScene *scene,
                           const DrawingJob *job, const ShellEnd *end, TrialDrawing *drawing,
                           Err *err)
{
    Err why = {""};
    Status status = STATUS_TOOL;
    if (!end->timed_out && end->exit_status == 0)
        status = read_drawing(scene, job->picture, drawing, &why);
    if (status == STATUS_MEMORY)
        return err_set(err, STATUS_MEMORY, "%s", why.text);
    if (status != STATUS_OK)
        give_reason(renderer, job, end, &why, drawing->reason);
    return STATUS_OK;
}

Status trials_draw(const TrialRenderer *renderer, const TrialScene *scenes, size_t n,
                   TrialDrawing *drawings, Err *err)
{
    DrawingJob *jobs = NULL;
    ShellCommand *commands = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&jobs, n, sizeof *jobs, "drawings", err));
    TRY_GOTO(mem_calloc(&commands, n, sizeof *commands, "commands", err));
    for (size_t i = 0; i < n; i++) {
        TRY_GOTO(job_prepare(renderer, &scenes[i], i, &jobs[i], err));
        commands[i].command = jobs[i].command;
        commands[i].log = jobs[i].log;
    }
    TRY_GOTO(shell_run_all(commands, n, renderer->jobs, renderer->timeout_s, err));
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(take_drawing(renderer, &scenes[i], &jobs[i], &commands[i].end, &drawings[i], err));
done:
    for (size_t i = 0; jobs && i < n; i++)
        job_release(&jobs[i]);
    free(jobs);
    free(commands);
    return status;
}

void drawings_release(TrialDrawing *drawings, size_t n)
{
    for (size_t i = 0; drawings && i < n; i++)
        picture_release(&drawings[i].picture);
}

/* ---- comparison ------------------------------------------------------------------------------ */

static const uint8_t *pixel_at(const Picture *picture, int x, int y)
{
    return picture->codes8 + 3 * ((size_t)y * (size_t)picture->width + (size_t)x);
}

static int pixel_difference(const uint8_t *a, const uint8_t *b)
{
    int largest = 0;
    for (int i = 0; i < 3; i++)
        largest = abs(a[i] - b[i]) > largest ? abs(a[i] - b[i]) : largest;
    return largest;
}

/* Returns the color that most pixels have, if more than half have it [Boyer and Moore's majority
 * vote]: that of the background. Else returns any color. */
static const uint8_t *background_of(const Picture *picture)
{
    const uint8_t *best = picture->codes8;
    size_t votes = 0;
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            const uint8_t *pixel = pixel_at(picture, x, y);
            const bool same = pixel_difference(best, pixel) == 0;
            if (votes == 0)
                best = pixel;
            votes = votes == 0 || same ? votes + 1 : votes - 1;
        }
    return best;
}

static void grow_box(PixelRect *box, int x, int y)
{
    const int right = box->left + box->width, bottom = box->top + box->height;
    if (box->width == 0) {
        *box = (PixelRect){x, y, 1, 1};
        return;
    }
    box->left = x < box->left ? x : box->left;
    box->top = y < box->top ? y : box->top;
    box->width = (x + 1 > right ? x + 1 : right) - box->left;
    box->height = (y + 1 > bottom ? y + 1 : bottom) - box->top;
}

static void compare_pictures_of(const Relation *relation, const Picture *a, const Picture *b,
                                PairVerdict *verdict)
{
    const uint8_t *background = background_of(a);
    const int first_row = relation->crops ? a->height / 2 : 0;
    bool is_edge = false;
    verdict->is_empty = true;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const uint8_t *p = pixel_at(a, x, y);
            const uint8_t *q = pixel_at(b, relation->flips ? a->width - 1 - x : x, y + first_row);
            const int codes = pixel_difference(p, q);
            verdict->is_empty = verdict->is_empty && pixel_difference(p, a->codes8) == 0;
            verdict->codes = codes > verdict->codes ? codes : verdict->codes;
            if (codes <= relation->codes)
                continue;
            is_edge = is_edge || pixel_difference(p, background) == 0 ||
                      pixel_difference(q, background) == 0;
            grow_box(&verdict->box, x, y);
            verdict->pixels++;
        }
    verdict->kind = verdict->pixels == 0 ? VERDICT_HOLDS : is_edge ? VERDICT_EDGE : VERDICT_SHADE;
}

void pair_compare(const Relation *relation, const TrialDrawing drawings[2], PairVerdict *verdict)
{
    *verdict = (PairVerdict){0};
    for (int i = 0; i < 2; i++)
        if (!drawings[i].picture.codes8) {
            verdict->kind = i == 0 ? VERDICT_NONE : VERDICT_REFUSED;
            snprintf(verdict->reason, TRIAL_REASON, "%s", drawings[i].reason);
            return;
        }
    compare_pictures_of(relation, &drawings[0].picture, &drawings[1].picture, verdict);
}

Status pairs_judge(const TrialRenderer *renderer, const TrialPair *pairs, size_t n,
                   PairVerdict *verdicts, Err *err)
{
    TrialScene *scenes = NULL;
    TrialDrawing *drawings = NULL;
    size_t *owners = NULL, drawn = 0;
    Status status;
    TRY_GOTO(mem_calloc(&scenes, 2 * n, sizeof *scenes, "scenes", err));
    TRY_GOTO(mem_calloc(&drawings, 2 * n, sizeof *drawings, "drawings", err));
    TRY_GOTO(mem_calloc(&owners, n, sizeof *owners, "pairs", err));
    for (size_t i = 0; i < n; i++) {
        verdicts[i] = (PairVerdict){.kind = VERDICT_NONE};
        if (!pair_second(&pairs[i], &scenes[2 * drawn + 1]))
            continue;
        scenes[2 * drawn] = pairs[i].first;
        owners[drawn++] = i;
    }
    TRY_GOTO(trials_draw(renderer, scenes, 2 * drawn, drawings, err));
    for (size_t k = 0; k < drawn; k++)
        pair_compare(pairs[owners[k]].relation, &drawings[2 * k], &verdicts[owners[k]]);
done:
    drawings_release(drawings, 2 * n);
    free(drawings);
    free(scenes);
    free(owners);
    return status;
}
