/* Writes the folder of a cause: the pair that shows it, its pictures and a report. The pair is
 * drawn once more for this, so that the search keeps no pictures. */
#include "metamorph/reports.h"

#include "compare/compare.h"
#include <stdio.h>
#include <string.h>

static const char *const sides[2] = {"first", "second"};

/* ---- the sweep over scales ------------------------------------------------------------------- */

/* Draws the first scene with all lengths times 2^k, |k| <= SWEEP, and counts the pixels that differ
 * from k = 0. */
static Status sweep_scales(MetamorphCause *cause, const TrialRenderer *renderer, Err *err)
{
    enum { N = 2 * SWEEP + 1 };
    TrialScene scenes[N];
    TrialDrawing drawings[N] = {{{0}, ""}};
    Status status;
    for (int i = 0; i < N; i++) {
        scenes[i] = cause->pair.first;
        scene_scale(&scenes[i], i - SWEEP);
    }
    TRY_GOTO(trials_draw(renderer, scenes, N, drawings, err));
    for (int i = 0; i < N; i++) {
        const TrialDrawing pair[2] = {drawings[SWEEP], drawings[i]};
        PairVerdict verdict;
        pair_compare(cause->pair.relation, pair, &verdict);
        cause->sweep[i] = drawings[i].picture.codes8 ? verdict.pixels : -1;
    }
done:
    drawings_release(drawings, N);
    return status;
}

static void put_sweep(const MetamorphCause *cause, Text *out)
{
    text_puts(out, "\nPixels that differ from the first scene, with all lengths times 2^k:\n");
    for (int i = 0; i <= 2 * SWEEP; i++)
        if (cause->sweep[i] < 0)
            text_printf(out, "  k = %3d  not drawn\n", i - SWEEP);
        else
            text_printf(out, "  k = %3d  %d\n", i - SWEEP, cause->sweep[i]);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Where the files of a cause are written. */
typedef struct CauseFolder {
    const MetamorphParams *params;
    char *path; /* owned */
} CauseFolder;

static Status write_text(const CauseFolder *folder, const char *name, const Text *text, Err *err)
{
    char *path = NULL;
    TRY(file_join(folder->path, name, &path, err));
    Status status = file_write_text(path, text, err);
    free(path);
    return status;
}

static Status write_picture(const CauseFolder *folder, const char *name, const Picture *picture,
                            Err *err)
{
    char *path = NULL;
    TRY(file_join(folder->path, name, &path, err));
    Status status = picture_write(picture, path, ENCODING_SRGB, NULL, NULL, err);
    free(path);
    return status;
}

static Status write_scene(const CauseFolder *folder, const TrialScene *scene, int side, Err *err)
{
    const TrialAdapter *adapter = &trial_adapters[folder->params->renderer.format];
    Text text = TEXT_INIT;
    char name[40];
    snprintf(name, sizeof name, "%s.%s", sides[side], adapter->name);
    adapter->write(scene, &text);
    Status status = write_text(folder, name, &text, err);
    text_release(&text);
    return status;
}

/* Makes the part of the second picture that corresponds to the first picture. */
static Status corresponding(const Relation *relation, const Picture *a, const Picture *b,
                            Picture *part, Err *err)
{
    TRY(picture_init(part, a->width, a->height, 3, 8, err));
    const int first_row = relation->crops ? a->height / 2 : 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const int from = relation->flips ? a->width - 1 - x : x;
            memcpy(part->codes8 + 3 * ((size_t)y * (size_t)a->width + (size_t)x),
                   b->codes8 + 3 * ((size_t)(y + first_row) * (size_t)b->width + (size_t)from), 3);
        }
    return STATUS_OK;
}

static Status write_pictures(const CauseFolder *folder, const Relation *relation,
                             const TrialDrawing drawings[2], Err *err)
{
    Picture part = {0}, difference = {0};
    Status status = STATUS_OK;
    for (int side = 0; side < 2; side++)
        if (drawings[side].picture.codes8)
            TRY_GOTO(write_picture(folder, side ? "second.png" : "first.png",
                                   &drawings[side].picture, err));
    if (!drawings[0].picture.codes8 || !drawings[1].picture.codes8)
        goto done;
    TRY_GOTO(corresponding(relation, &drawings[0].picture, &drawings[1].picture, &part, err));
    TRY_GOTO(heat_picture(&difference, &drawings[0].picture, &part, err));
    status = write_picture(folder, "difference.png", &difference, err);
done:
    picture_release(&part);
    picture_release(&difference);
    return status;
}

/* ---- report.txt ------------------------------------------------------------------------------ */

static void put_commands(const MetamorphParams *params, const TrialScene scenes[2], Text *out)
{
    const TrialAdapter *adapter = &trial_adapters[params->renderer.format];
    text_puts(out, "\nTo repeat it in this folder:\n");
    for (int side = 0; side < 2; side++) {
        char scene[40], picture[40];
        snprintf(scene, sizeof scene, "%s.%s", sides[side], adapter->name);
        snprintf(picture, sizeof picture, "%s.%s", sides[side], adapter->picture);
        text_puts(out, "  ");
        trial_command(params->renderer.shell.command, params->renderer.format, &scenes[side], scene,
                      picture, out);
        text_puts(out, "\n");
    }
}

/* Appends what is wrong with the second picture. */
static void put_finding(const MetamorphCause *cause, Text *out)
{
    const PairVerdict *verdict = &cause->verdict;
    if (verdict->kind == VERDICT_UNDRAWN)
        text_printf(out, "The second scene is not drawn: %s.\n", verdict->reason);
    else
        text_printf(out, "%d of %d pixels differ by more than %d of 255 codes, by up to %d; %s.\n",
                    verdict->pixels, cause->pair.first.width_px * cause->pair.first.height_px,
                    cause->pair.relation->codes, verdict->codes,
                    verdict->kind == VERDICT_EDGE ? "a shape appears or vanishes"
                                                  : "only the color of shapes differs");
}

static void put_report(const MetamorphCause *cause, const MetamorphParams *params,
                       const TrialScene scenes[2], Text *out)
{
    text_printf(out, "%s\n\nRelation: %s: %s.\nThe two pictures must be the same.\n", cause->name,
                cause->pair.relation->name, cause->pair.relation->change);
    put_finding(cause, out);
    text_printf(out, "Confirmed pairs with this cause: %zu.\n", cause->confirmed);
    put_commands(params, scenes, out);
    for (int side = 0; side < 2; side++) {
        text_printf(out, "\n%s.%s:\n", sides[side], trial_adapters[params->renderer.format].name);
        trial_adapters[params->renderer.format].write(&scenes[side], out);
    }
    if (relation_scales(cause->pair.relation))
        put_sweep(cause, out);
}

Status cause_report(MetamorphCause *cause, const MetamorphParams *params, Err *err)
{
    CauseFolder folder = {.params = params};
    TrialScene scenes[2];
    TrialDrawing drawings[2] = {{{0}, ""}, {{0}, ""}};
    Text report = TEXT_INIT;
    Status status;
    TRY_GOTO(file_join(params->output, cause->name, &folder.path, err));
    TRY_GOTO(file_make_folder(folder.path, err));
    scenes[0] = cause->pair.first;
    (void)pair_second(&cause->pair, &scenes[1]);
    TRY_GOTO(trials_draw(&params->renderer, scenes, 2, drawings, err));
    TRY_GOTO(write_pictures(&folder, cause->pair.relation, drawings, err));
    if (relation_scales(cause->pair.relation))
        TRY_GOTO(sweep_scales(cause, &params->renderer, err));
    for (int side = 0; side < 2; side++)
        TRY_GOTO(write_scene(&folder, &scenes[side], side, err));
    put_report(cause, params, scenes, &report);
    status = write_text(&folder, "report.txt", &report, err);
done:
    text_release(&report);
    drawings_release(drawings, 2);
    free(folder.path);
    return status;
}

/* ---- results --------------------------------------------------------------------------------- */

static size_t total_pairs(const Metamorph *result)
{
    size_t pairs = 0;
    for (int i = 0; i < MAX_RELATIONS; i++)
        pairs += result->counts[i].pairs;
    return pairs;
}

void metamorph_text(const Metamorph *result, Text *out)
{
    text_printf(out, "%zu pairs in %.1f s: %zu %s\n", total_pairs(result), result->seconds,
                result->causes.n, result->causes.n == 1 ? "cause" : "causes");
    for (int i = 0; relations[i].name; i++) {
        const RelationCount *count = &result->counts[i];
        if (count->pairs > 0)
            text_printf(out, "  %-12s %6zu pairs %5zu failed %5zu confirmed %7.1f s\n",
                        relations[i].name, count->pairs, count->failed, count->confirmed,
                        count->seconds);
    }
    for (size_t i = 0; i < result->causes.n; i++) {
        text_printf(out, "%s: ", result->causes.items[i].name);
        put_finding(&result->causes.items[i], out);
    }
}

static json_t *count_json(const Relation *relation, const RelationCount *count)
{
    return JSON_OBJECT(
        {"relation", json_text(relation->name)}, {"change", json_text(relation->change)},
        {"pairs", json_count(count->pairs)}, {"not_drawn", json_count(count->none)},
        {"failed", json_count(count->failed)}, {"confirmed", json_count(count->confirmed)},
        {"seconds", json_number(count->seconds)});
}

static json_t *cause_json(const MetamorphCause *cause)
{
    json_t *object = JSON_OBJECT({"name", json_text(cause->name)},
                                 {"relation", json_text(cause->pair.relation->name)},
                                 {"failure", json_text(verdict_names[cause->verdict.kind])},
                                 {"shapes", json_count((uint64_t)cause->pair.first.n_shapes)},
                                 {"width_px", json_count((uint64_t)cause->pair.first.width_px)},
                                 {"height_px", json_count((uint64_t)cause->pair.first.height_px)},
                                 {"pixels", json_count((uint64_t)cause->verdict.pixels)},
                                 {"codes", json_count((uint64_t)cause->verdict.codes)},
                                 {"confirmed", json_count(cause->confirmed)});
    if (!relation_scales(cause->pair.relation))
        return object;
    json_t *sweep = json_array();
    for (int i = 0; i <= 2 * SWEEP; i++)
        sweep = json_with_item(sweep, cause->sweep[i] < 0 ? json_null()
                                                          : json_count((uint64_t)cause->sweep[i]));
    return json_with(object, "pixels_from_2^-20_to_2^20", sweep);
}

json_t *metamorph_json(const Metamorph *result)
{
    json_t *counts = json_array(), *causes = json_array();
    for (int i = 0; relations[i].name; i++)
        if (result->counts[i].pairs > 0)
            counts = json_with_item(counts, count_json(&relations[i], &result->counts[i]));
    for (size_t i = 0; i < result->causes.n; i++)
        causes = json_with_item(causes, cause_json(&result->causes.items[i]));
    return JSON_OBJECT({"format", json_text(trial_adapters[result->format].name)},
                       {"pairs", json_count(total_pairs(result))},
                       {"seconds", json_number(result->seconds)}, {"relations", counts},
                       {"causes", causes});
}
