/* Draws band by band, each as many rows as --memory holds, and writes each before the next, so that
 * a picture of any size needs the memory of one band. */
#include "job/picture/render_film.h"

#include "options/talk.h"
#include <stdio.h>
#include <stdlib.h>

/* Bytes of a pixel of what pixels share: with occlusion half of them see something. */
static int shared_bytes(const RenderParams *params, const View *view)
{
    if (params && params->occlusion > 0)
        return 42 + params->occlusion;
    return params && view && params->shadows && view_has_soft_shadows(view) ? 46 : 0;
}

static bool has_floats(const FramesForm *form)
{
    return image_traits(form->path).floats || form->color || form->depth || form->normal;
}

/* The memory of one band serves the next, while that of a whole picture would take longer to be
 * cleared than to be filled. So bands have no more rows, enough for each of many threads to have
 * some tiles, but for two: where pixels share light each sees rows of its neighbours, and a PFM,
 * which begins with its last row, can go to a pipe only if it is whole. */
enum { MOST_ROWS = 512 };

/* Floats, codes and masks, and what is shared. */
int film_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                   double memory_mb)
{
    int bytes = 12 + form->bits / 8 * 3 + 1 + 4 * form->depth + 12 * form->normal + 7 * form->id;
    if (image_traits(form->path).floats)
        bytes += 12 + 4 * form->depth + 12 * form->normal + 4 * form->id;
    int shared = shared_bytes(params, view);
    double rows = memory_mb * 1e6 / ((double)(bytes + shared) * form->width);
    if (rows > MOST_ROWS && !shared && !has_floats(form))
        rows = MOST_ROWS;
    if (rows >= form->height)
        return form->height;
    return rows < 2 * RENDER_BAND_STEP ? RENDER_BAND_STEP
                                       : (int)rows / RENDER_BAND_STEP * RENDER_BAND_STEP;
}

/* Returns true if all pixels of a band show the background. */
static bool shows_nothing(const Frame *band, const View *view)
{
    const Rgb paper = view->background;
    const float colors[3] = {paper.r, paper.g, paper.b};
    const Plane *color = &band->color, *alpha = &band->alpha;
    const Picture *codes = &band->codes;
    if (alpha->values) {
        for (size_t i = 0; i < (size_t)alpha->width * (size_t)alpha->height; i++)
            if (alpha->values[i] > 0)
                return false;
        return true;
    }
    for (size_t i = 0; color->values && i < 3 * (size_t)color->width * (size_t)color->height; i++)
        if (color->values[i] != colors[i % 3])
            return false;
    if (color->values || !codes->codes8)
        return color->values != NULL;
    const uint8_t code[3] = {(uint8_t)image_code(paper.r, ENCODING_SRGB, 8),
                             (uint8_t)image_code(paper.g, ENCODING_SRGB, 8),
                             (uint8_t)image_code(paper.b, ENCODING_SRGB, 8)};
    for (size_t i = 0; i < 3 * (size_t)codes->width * (size_t)codes->height; i++)
        if (codes->codes8[i] != code[i % 3])
            return false;
    return true;
}

/* Warns of a whole picture that shows nothing. A tile or a moment of an animation may. */
static void warn_of_nothing(const Film *film, const FramesForm *form)
{
    if (film->subject.common->quiet || film->shard.rows < film->shard.height ||
        film->animation->kind != ANIMATION_NONE)
        return;
    fprintf(stderr,
            "corcast: %s shows no vessel: the camera looks past the tree, or the vessels are too "
            "small to be drawn\n",
            form->path);
}

/* Draws the shard's rows band after band and writes each before the next. */
static Status draw_bands(Renderer *renderer, const Scene *scene, const FramesForm *form,
                         FramesWriter *writer, const Film *film, Err *err)
{
    bool empty = true;
    const int end = film->shard.first + film->shard.rows;
    const int step = film_band_rows(form, film->params, &scene->view, film->memory_mb);
    if (step < film->shard.rows)
        mem_keep();
    for (int first = film->shard.first; first < end; first += step) {
        Frame band;
        int rows = step < end - first ? step : end - first;
        TRY(renderer_rows(renderer, &scene->view, &scene->appearance, first, rows, &band, err));
        empty = empty && shows_nothing(&band, &scene->view);
        Status status = frames_rows(writer, &band, err);
        frame_release(&band);
        TRY(status);
    }
    if (empty)
        warn_of_nothing(film, form);
    return STATUS_OK;
}

Status film_draw_one(const Film *film, Renderer *renderer, const Scene *scene,
                     const FramesForm *form, Err *err)
{
    FramesWriter *writer = NULL;
    TRY(frames_open(&writer, form, err));
    Status status = draw_bands(renderer, scene, form, writer, film, err);
    if (status == STATUS_OK)
        return frames_commit(writer, err);
    frames_discard(writer);
    return status;
}

/* The note of picture `number`, which the form then has, and whether the file has it already. */
static Status find_shard(const Film *film, FramesForm *form, int number, Text *note, bool *there,
                         Err *err)
{
    Shard shard = film->shard;
    const ShardSource source = {.line = form->provenance,
                                .tree = &film->subject.source->of.tree,
                                .domain = film->subject.source->domain,
                                .has_text = form->page != NULL};
    TRY(shard_hash(&shard, film->parsed, &source, number, err));
    shard_put(&shard, note);
    TRY(text_check(note, err));
    form->shard = text_chars(note);
    if (film->resume)
        TRY(shard_is_there(form->path, &shard, there, err));
    if (*there && !film->subject.common->quiet)
        fprintf(stderr, "%s is there\n", form->path);
    return STATUS_OK;
}

/* The tree as it grows has a geometry, and with it a renderer, for each picture; else the first
 * picture that is drawn makes *prepared for all. */
static Status draw_frame(const Film *film, int number, const FramesForm *form, Renderer **prepared,
                         RenderStats *stats, Err *err)
{
    Scene shown, grown = {0};
    Renderer *young = NULL;
    Renderer **renderer = film->animation->kind == ANIMATION_GROWTH ? &young : prepared;
    FramesForm named = *form;
    Text note = TEXT_INIT;
    bool there = false;
    char *path = NULL;
    Status status;
    TRY_GOTO(animation_path(film->animation, form->path, number, &path, err));
    named.path = path;
    if (film->part)
        TRY_GOTO(find_shard(film, &named, number, &note, &there, err));
    if (there)
        goto done;
    TRY_GOTO(animation_scene(film->animation, &film->subject, number, &shown, &grown, err));
    if (!*renderer)
        TRY_GOTO(renderer_new(&shown.geometry, film->params, renderer, err));
    TRY_GOTO(film_draw_one(film, *renderer, &shown, &named, err));
    if (young) {
        const RenderStats one = renderer_stats(young);
        renderstats_add(stats, &one);
    }
done:
    renderer_free(young);
    scene_release(&grown);
    text_release(&note);
    free(path);
    return status;
}

Status film_draw(const Film *film, const FramesForm *form, RenderStats *stats, Err *err)
{
    const Animation *animation = film->animation;
    Progress *progress = film->params->progress_context;
    Renderer *prepared = NULL;
    Status status = STATUS_OK;
    for (int k = animation->first; k <= animation->last && status == STATUS_OK; k++) {
        char what[48];
        snprintf(what, sizeof what, "rendering %d of %d", k, animation->last);
        progress_start(progress, animation->kind ? what : "rendering", film->subject.common->talk);
        status = draw_frame(film, k, form, &prepared, stats, err);
        progress_end(progress);
    }
    if (prepared)
        *stats = renderer_stats(prepared);
    renderer_free(prepared);
    return status;
}
