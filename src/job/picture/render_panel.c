/* A panel is drawn as `render` draws, kept instead of written, and its insets by the same renderer
 * with cameras that see a part of its view. */
#include "job/picture/render_panel.h"

#include "job/picture/render_film.h"
#include "job/picture/render_options.h"
#include "options/talk.h"
#include "render/render.h"

FigureBox panel_part(const PanelInset *inset, const Camera *camera)
{
    double wide = inset->pixels[0] / inset->magnify / camera->width / 2;
    double high = inset->pixels[1] / inset->magnify / camera->height / 2;
    return (FigureBox){inset->at[0] - wide, inset->at[1] - high, inset->at[0] + wide,
                       inset->at[1] + high};
}

View panel_inset_view(const PanelInset *inset, const View *view)
{
    View shown = *view;
    Camera *camera = &shown.camera;
    const FigureBox part = panel_part(inset, camera);
    camera->location = vec3_add_scaled(camera->location, camera->right, inset->at[0] - 0.5);
    camera->location = vec3_add_scaled(camera->location, camera->up, 0.5 - inset->at[1]);
    camera->right = vec3_scale(camera->right, part.right - part.left);
    camera->up = vec3_scale(camera->up, part.bottom - part.top);
    camera->width = inset->pixels[0];
    camera->height = inset->pixels[1];
    return shown;
}

static Status draw_kept(Renderer *renderer, const Scene *scene, Picture *kept, Err *err)
{
    const Camera *camera = &scene->view.camera;
    const FramesForm form = {.width = camera->width,
                             .height = camera->height,
                             .path = "panel",
                             .bits = 8,
                             .encoding = ENCODING_SRGB,
                             .picture = true,
                             .kept = kept};
    const Film film = {.shard = {.rows = camera->height}, .memory_mb = 128};
    return film_draw_one(&film, renderer, scene, &form, err);
}

static Status draw_panel(const RenderParams *params, Panel *panel, Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(&panel->scene.geometry, params, &renderer, err));
    Status status = draw_kept(renderer, &panel->scene, &panel->picture, err);
    for (size_t i = 0; i < panel->n_insets && status == STATUS_OK; i++) {
        Scene shown = panel->scene;
        shown.view = panel_inset_view(&panel->insets[i], &panel->scene.view);
        status = draw_kept(renderer, &shown, &panel->insets[i].picture, err);
    }
    renderer_free(renderer);
    return status;
}

static Status draw_strokes(const RenderOptions *options, int threads, const Geometry *geometry,
                           const View *view, Strokes *strokes, Err *err)
{
    const InkParams params = {.width_mm =
                                  view->camera.width * MM_PER_INCH / options->picture.size.dpi,
                              .line_mm = options->ink_mm,
                              .threads = threads};
    return ink_draw(geometry, view, &params, strokes, err);
}

/* --ink: lines of the same width in the panel and its insets. */
static Status draw_lines(const RenderOptions *options, int threads, Panel *panel, Err *err)
{
    const Geometry *geometry = &panel->scene.geometry;
    if (options->annotation.legend)
        return err_set(err, STATUS_USAGE, "--legend has no effect on a line drawing (--ink)");
    TRY(draw_strokes(options, threads, geometry, &panel->scene.view, &panel->strokes, err));
    for (size_t i = 0; i < panel->n_insets; i++) {
        PanelInset *inset = &panel->insets[i];
        const View view = panel_inset_view(inset, &panel->scene.view);
        TRY(draw_strokes(options, threads, geometry, &view, &inset->strokes, err));
    }
    return STATUS_OK;
}

Status panel_draw(Parsed *parsed, Panel *panel, Err *err)
{
    RenderOptions *options = parsed->options;
    const int *pixels = options->picture.size.pixels;
    PictureSource source = {0};
    Animation still = {.first = 1, .last = 1, .n = 1};
    Progress progress;
    panel->in_lines = options->ink_mm > 0;
    options->output = panel->in_lines ? "panel.pdf" : "panel"; /* pages hold lines */
    render_settle(options);
    CellParams cells;
    RenderParams params = render_params_of(options, parsed->common.threads, &cells);
    params.want_color = true;
    params.progress = progress_report;
    params.progress_context = &progress;
    if (panel->n_insets > 0 && options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "an inset is a part of an orthographic picture");
    TRY(render_check(options, parsed, err));
    TRY(picture_fits(pixels[0], pixels[1], 40, err));
    const bool quiet = parsed->common.quiet;
    parsed->common.quiet = quiet || panel->made_tree;
    Status status = picture_read_source(&options->picture, parsed, &source, err);
    parsed->common.quiet = quiet;
    if (status == STATUS_OK)
        status = render_make_scene(options, parsed, &source, panel->fonts, &panel->scene,
                                   &panel->made, &still, err);
    progress_start(&progress, "rendering", parsed->common.talk);
    if (status == STATUS_OK)
        status = panel->in_lines ? draw_lines(options, params.threads, panel, err)
                                 : draw_panel(&params, panel, err);
    progress_end(&progress);
    panel->annotation = options->annotation;
    picture_source_release(&source);
    return status;
}

void panel_release(Panel *panel)
{
    for (size_t i = 0; i < panel->n_insets; i++) {
        picture_release(&panel->insets[i].picture);
        strokes_release(&panel->insets[i].strokes);
    }
    picture_release(&panel->picture);
    strokes_release(&panel->strokes);
    scene_release(&panel->scene);
}
