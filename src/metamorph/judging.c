/* Draws pairs of scenes with the renderer under test and compares the pictures. A drawing without a
 * picture is a finding about the pair, not an error of this program. */
#include "metamorph/judging.h"

#include "compare/compare.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const verdict_names[VERDICT_KINDS] = {[VERDICT_NONE] = "none",
                                                  [VERDICT_HOLDS] = "holds",
                                                  [VERDICT_EDGE] = "edge",
                                                  [VERDICT_SHADE] = "shade",
                                                  [VERDICT_UNDRAWN] = "undrawn"};

/* ---- drawing --------------------------------------------------------------------------------- */

/* Writes the scene and prepares the command. The name is the index of the drawing. */
static Status prepare_drawing(const TrialRenderer *renderer, const TrialScene *scene, size_t index,
                              ShellDrawing *drawing, Err *err)
{
    const TrialAdapter *adapter = &trial_adapters[renderer->format];
    Text text = TEXT_INIT, command = TEXT_INIT;
    char name[24];
    Status status;
    snprintf(name, sizeof name, "%zu", index);
    TRY_GOTO(drawing_name(drawing, renderer->folder, name, adapter->name, adapter->picture, err));
    adapter->write(scene, &text);
    TRY_GOTO(file_write_text(drawing->scene, &text, err));
    trial_command(renderer->shell.command, renderer->format, scene, drawing->scene,
                  drawing->picture, &command);
    status = text_take(&command, &drawing->command, err);
done:
    text_release(&text);
    text_release(&command);
    return status;
}

/* Converts the picture of a scene to codes. */
static Status take_picture(const TrialScene *scene, const Image *image, Picture *picture, Err *err)
{
    const bool floats = image->plane.values;
    const int width = floats ? image->plane.width : image->picture.width;
    const int height = floats ? image->plane.height : image->picture.height;
    const int channels = floats ? image->plane.channels : image->picture.channels;
    if (width != scene->width_px || height != scene->height_px || channels != 3)
        return err_set(err, STATUS_INPUT,
                       "the picture has %d x %d pixels of %d channels, not %d x %d of 3", width,
                       height, channels, scene->width_px, scene->height_px);
    return floats ? picture_from_plane(picture, &image->plane, ENCODING_SRGB, 8, err)
                  : picture_to_srgb(picture, &image->picture, 8, err);
}

/* Reads the picture of a drawing, or takes the reason why there is none. */
static Status take_drawing(const TrialScene *scene, ShellDrawing *drawing, TrialDrawing *out,
                           Err *err)
{
    Image image;
    Err why = {""};
    TRY(drawing_read(drawing, &image, err));
    Status status = STATUS_OK;
    if (drawing->is_drawn)
        status = take_picture(scene, &image, &out->picture, &why);
    image_release(&image);
    if (status != STATUS_OK)
        TRY(drawing_refuse(drawing, status, &why, err));
    snprintf(out->reason, sizeof out->reason, "%s", drawing->reason);
    return STATUS_OK;
}

Status trials_draw(const TrialRenderer *renderer, const TrialScene *scenes, size_t n,
                   TrialDrawing *out, Err *err)
{
    ShellDrawing *drawings;
    Status status = STATUS_OK;
    TRY(mem_calloc(&drawings, n, sizeof *drawings, "drawings", err));
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(prepare_drawing(renderer, &scenes[i], i, &drawings[i], err));
    TRY_GOTO(drawings_run(&renderer->shell, drawings, n, err));
    for (size_t i = 0; i < n; i++)
        TRY_GOTO(take_drawing(&scenes[i], &drawings[i], &out[i], err));
done:
    for (size_t i = 0; i < n; i++)
        drawing_release(&drawings[i]);
    free(drawings);
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

/* Compares the pictures of a pair, pixel by pixel, as the relation maps them onto each other. A
 * pixel differs if a channel is off by more than relation->codes. If one side of a differing pixel
 * shows the background, a shape has appeared or vanished (VERDICT_EDGE); else only colors differ.
 */
static void compare_pictures_of(const Relation *relation, const Picture *a, const Picture *b,
                                PairVerdict *verdict)
{
    const uint8_t *background = background_of(a);
    const int first_row = relation->crops ? a->height / 2 : 0;
    bool is_edge = false;
    verdict->is_empty = true;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const uint8_t *in_a = pixel_at(a, x, y);
            const uint8_t *in_b =
                pixel_at(b, relation->flips ? a->width - 1 - x : x, y + first_row);
            const int codes = pixel_difference(in_a, in_b);
            verdict->is_empty = verdict->is_empty && pixel_difference(in_a, a->codes8) == 0;
            verdict->codes = codes > verdict->codes ? codes : verdict->codes;
            if (codes <= relation->codes)
                continue;
            is_edge = is_edge || pixel_difference(in_a, background) == 0 ||
                      pixel_difference(in_b, background) == 0;
            pixelrect_include(&verdict->box, x, y);
            verdict->pixels++;
        }
    verdict->kind = verdict->pixels == 0 ? VERDICT_HOLDS : is_edge ? VERDICT_EDGE : VERDICT_SHADE;
}

void pair_compare(const Relation *relation, const TrialDrawing drawings[2], PairVerdict *verdict)
{
    *verdict = (PairVerdict){0};
    for (int i = 0; i < 2; i++)
        if (!drawings[i].picture.codes8) {
            verdict->kind = i == 0 ? VERDICT_NONE : VERDICT_UNDRAWN;
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
