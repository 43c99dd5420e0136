/* Draws the pictures of `render` band by band. A band is a range of whole rows, as many as --memory
 * holds, and is written or copied before the next is drawn. A picture of any size therefore needs
 * the memory of one band beside its own. */
#include "job/picture/render_bands.h"

#include "options/talk.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns the bytes per pixel of the light that pixels share; 0 if they share none. Half of the
 * pixels are taken to show a surface. A surface point of a pixel has 32 bytes [ShadingPoint in
 * render/light/visibility.h]; the rest of 84 bytes is data of the method. Ambient occlusion also
 * stores an answer of one byte per direction, in two orders [render/light/occlusion.c]. Soft
 * shadows take 46 bytes; how the numbers 42 and 46 were found is not recorded. Larger: bands of
 * fewer rows. */
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

/* Maximum number of rows of a band. The memory of one band is used again for the next, whereas
 * clearing the memory of a whole picture takes longer than filling it. 512 rows have enough tiles
 * for many threads. There are two exceptions. Where pixels share light, each band computes rows of
 * its neighbours. A PFM begins with its last row, and so can go to a pipe only as a whole. */
enum { MOST_ROWS = 512 };

/* Returns the number of rows of a band, a multiple of RENDER_BAND_STEP. The bytes per pixel are
 * those of the band and of its file: color 12 (3 floats), its codes of 1 or 2 bytes per channel, a
 * mask 1, depth 4, normal 12, id 7 (a number of 4 bytes and a color of 3). A file of floats has a
 * copy of the floats. The bytes of shared light are added. */
int render_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
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

/* Returns true if all colors of a band, which begins at row `first`, are the background's. A mean
 * of samples may differ from it in its last digits: 1e-6 is about 16 steps of a float near 1. A
 * graded background has noise of at most 0.5 / 255 * 2.2 = 0.0043 [render/effect/effect.c], below
 * 0.006. Larger: a faint vessel passes for background, and the note that the picture is empty is
 * wrong. */
static bool colors_show_nothing(const Plane *color, const View *view, int first)
{
    const Grade *grade = &view->effects.grade;
    const Camera *camera = &view->camera;
    const float tolerance = grade->present ? 0.006f : 1e-6f;
    for (int row = 0; row < color->height; row++)
        for (int x = 0; x < color->width; x++) {
            const float *at = color->values + 3 * ((size_t)row * (size_t)color->width + (size_t)x);
            const Rgb paper = grade->present ? grade_at(grade, x + 0.5, first + row + 0.5,
                                                        camera->width, camera->height)
                                             : view->background;
            if (!(fabsf(at[0] - paper.r) <= tolerance && fabsf(at[1] - paper.g) <= tolerance &&
                  fabsf(at[2] - paper.b) <= tolerance))
                return false;
        }
    return true;
}

/* Returns true if all pixels of a band show the background. */
static bool shows_nothing(const Frame *band, const View *view, int first)
{
    const Rgb paper = view->background;
    const Plane *alpha = &band->alpha;
    const Picture *codes = &band->codes;
    if (alpha->values) {
        for (size_t i = 0; i < (size_t)alpha->width * (size_t)alpha->height; i++)
            if (alpha->values[i] > 0)
                return false;
        return true;
    }
    if (band->color.values)
        return colors_show_nothing(&band->color, view, first);
    if (!codes->codes8)
        return false;
    const uint8_t code[3] = {(uint8_t)image_code(paper.r, ENCODING_SRGB, 8),
                             (uint8_t)image_code(paper.g, ENCODING_SRGB, 8),
                             (uint8_t)image_code(paper.b, ENCODING_SRGB, 8)};
    for (size_t i = 0; i < 3 * (size_t)codes->width * (size_t)codes->height; i++)
        if (codes->codes8[i] != code[i % 3])
            return false;
    return true;
}

/* Warns of a picture that shows nothing. A tile or a picture of an animation may be empty. */
static void warn_of_nothing(const Rendering *rendering, const FramesForm *form)
{
    if (rendering->shard.rows < rendering->shard.height ||
        rendering->animation.kind != ANIMATION_NONE)
        return;
    talk_note(rendering->parsed->common.talk,
              "%s shows no vessel: the camera misses the tree, or the vessels are too small",
              rendering->name ? rendering->name : form->path);
}

/* Draws the rows of the form band after band. *empty is whether they show no vessel. */
static Status draw_bands(const Rendering *rendering, Renderer *renderer, const Scene *scene,
                         FramesWriter *writer, const FramesForm *form, bool *empty, Err *err)
{
    const int end = form->first + form->height;
    const int step =
        render_band_rows(form, &rendering->params, &scene->view, rendering->options->memory_mb);
    if (step < form->height)
        system_keep_memory();
    *empty = true;
    for (int first = form->first; first < end; first += step) {
        Frame band;
        int rows = step < end - first ? step : end - first;
        TRY(renderer_rows(renderer, &scene->view, &scene->appearance, first, rows, &band, err));
        *empty = *empty && shows_nothing(&band, &scene->view, first);
        Status status = frames_rows(writer, &band, err);
        frame_release(&band);
        TRY(status);
    }
    return STATUS_OK;
}

/* Draws one picture of a scene, whose geometry is the renderer's. */
static Status draw_picture(const Rendering *rendering, Renderer *renderer, const Scene *scene,
                           const FramesForm *form, bool *empty, Err *err)
{
    FramesWriter *writer = NULL;
    TRY(frames_open(&writer, form, err));
    Status status = draw_bands(rendering, renderer, scene, writer, form, empty, err);
    if (status == STATUS_OK)
        return frames_commit(writer, err);
    frames_discard(writer);
    return status;
}

/* Makes the note of picture `number` and sets form->shard to it. With --resume, sets *there to true
 * if a valid file of the picture exists. */
static Status find_shard(const Rendering *rendering, FramesForm *form, int number, Text *note,
                         bool *there, Err *err)
{
    Shard shard = rendering->shard;
    const ShardSource source = {.line = form->provenance,
                                .tree = &rendering->source.of.tree,
                                .domain = rendering->source.domain,
                                .has_text = form->page != NULL};
    TRY(shard_hash(&shard, rendering->parsed, &source, number, err));
    shard_put(&shard, note);
    TRY(text_check(note, err));
    form->shard = text_chars(note);
    if (rendering->options->shard.resume)
        TRY(shard_exists(form->path, &shard, there, err));
    if (*there)
        talk_note(rendering->parsed->common.talk, "%s is there", form->path);
    return STATUS_OK;
}

/* Makes the renderer that all pictures of one geometry share. */
static Status prepare(Rendering *rendering, Err *err)
{
    return rendering->renderer ? STATUS_OK
                               : renderer_new(&rendering->scene.geometry, &rendering->params,
                                              &rendering->renderer, err);
}

/* Makes the scene of picture `number` and draws it. The tree as it grows has another geometry, and
 * so another renderer, in each picture. All other pictures share rendering->renderer. */
static Status draw_number(Rendering *rendering, int number, const FramesForm *form, Err *err)
{
    const AnimationInput subject = {&rendering->options->picture, &rendering->parsed->common,
                                    &rendering->source, &rendering->scene};
    Scene shown, grown = {0};
    const bool grows =
        animation_changes_geometry(&rendering->animation, &rendering->options->picture);
    Renderer *grown_renderer = NULL;
    bool empty;
    Status status;
    TRY_GOTO(animation_scene(&rendering->animation, &subject, number, &shown, &grown, err));
    if (grows)
        TRY_GOTO(renderer_new(&grown.geometry, &rendering->params, &grown_renderer, err));
    else
        TRY_GOTO(prepare(rendering, err));
    TRY_GOTO(draw_picture(rendering, grows ? grown_renderer : rendering->renderer, &shown, form,
                          &empty, err));
    if (empty)
        warn_of_nothing(rendering, form);
    if (grows) {
        const RenderStats one = renderer_stats(grown_renderer);
        renderstats_add(&rendering->stats, &one);
    }
done:
    renderer_free(grown_renderer);
    scene_release(&grown);
    return status;
}

/* Draws picture `number` to form->path, unless --resume finds its valid file there. */
static Status draw_named(Rendering *rendering, int number, FramesForm *form, Err *err)
{
    Text note = TEXT_INIT;
    bool there = false;
    Status status = STATUS_OK;
    if (rendering->options->shard.resume || rendering->options->shard.tile)
        status = find_shard(rendering, form, number, &note, &there, err);
    if (status == STATUS_OK && !there)
        status = draw_number(rendering, number, form, err);
    text_release(&note);
    return status;
}

Status rendering_draw(Rendering *rendering, int number, Frame *kept, Err *err)
{
    FramesForm form = rendering->form;
    char *path, what[48];
    TRY(animation_path(&rendering->animation, rendering->form.path, number, &path, err));
    form.path = path;
    form.kept = kept;
    snprintf(what, sizeof what, "rendering %d of %d", number, rendering->animation.last);
    progress_start(&rendering->progress, rendering->animation.kind ? what : "rendering",
                   rendering->parsed->common.talk);
    Status status = draw_named(rendering, number, &form, err);
    progress_end(&rendering->progress);
    free(path);
    return status;
}

Status rendering_draw_view(Rendering *rendering, const View *view, Frame *kept, Err *err)
{
    FramesForm form = rendering->form;
    Scene shown = rendering->scene;
    bool empty;
    shown.view = *view;
    form.width = view->camera.width;
    form.height = view->camera.height;
    form.kept = kept;
    TRY(prepare(rendering, err));
    return draw_picture(rendering, rendering->renderer, &shown, &form, &empty, err);
}

RenderStats render_stats(const Rendering *rendering)
{
    return rendering->renderer ? renderer_stats(rendering->renderer) : rendering->stats;
}
