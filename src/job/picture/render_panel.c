/* Draws a panel of a figure with its insets. A panel is a picture of `render` in memory. Its insets
 * are drawn by the same renderer, with cameras that see a part of the panel's view. */
#include "job/picture/render_panel.h"

#include "options/talk.h"

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

/* Draws the panel's own view, or an inset's. */
static Status draw_view(Rendering *rendering, const View *view, Picture *picture, Strokes *strokes,
                        Err *err)
{
    const InkParams ink = {.width_mm = view->camera.width * MM_PER_INCH / rendering->form.dpi,
                           .line_mm = rendering->options->ink_mm,
                           .threads = rendering->params.threads};
    Frame frame = {0};
    if (ink.line_mm > 0)
        return ink_strokes(&rendering->scene.geometry, view, &ink, strokes, err);
    Status status = view == &rendering->scene.view
                        ? rendering_draw(rendering, 1, &frame, err)
                        : rendering_draw_view(rendering, view, &frame, err);
    if (status == STATUS_OK)
        *picture = frame.codes;
    else
        frame_release(&frame);
    return status;
}

static Status draw_views(Rendering *rendering, Panel *panel, Err *err)
{
    if (panel->in_lines && rendering->options->annotation.legend)
        return err_set(err, STATUS_USAGE, "--legend has no effect on a line drawing (--ink)");
    TRY(draw_view(rendering, &rendering->scene.view, &panel->picture, &panel->strokes, err));
    for (size_t i = 0; i < panel->n_insets; i++) {
        PanelInset *inset = &panel->insets[i];
        const View view = panel_inset_view(inset, &rendering->scene.view);
        TRY(draw_view(rendering, &view, &inset->picture, &inset->strokes, err));
    }
    return STATUS_OK;
}

Status panel_scale(Parsed *parsed, const FigureFonts *fonts, double *mm_per_pixel, Err *err)
{
    RenderOptions *options = parsed->options;
    Rendering rendering;
    if (options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "same-scale needs orthographic panels");
    TRY(rendering_open(options, parsed, fonts, &rendering, err));
    *mm_per_pixel =
        vec3_length(rendering.scene.view.camera.up) / rendering.scene.view.camera.height;
    rendering_close(&rendering);
    return STATUS_OK;
}

Status panel_draw(Parsed *parsed, Panel *panel, Err *err)
{
    RenderOptions *options = parsed->options;
    Rendering rendering;
    panel->in_lines = options->ink_mm > 0;
    TRY(options_settle(parsed, err));
    if (panel->n_insets > 0 && !options->picture.has_projection)
        options->picture.projection = PROJECTION_ORTHOGRAPHIC;
    if (panel->n_insets > 0 && options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "an inset needs an orthographic panel");
    TRY(rendering_open(options, parsed, panel->fonts, &rendering, err));
    rendering.name = panel->name;
    Status status = draw_views(&rendering, panel, err);
    panel->scene = rendering.scene;
    panel->report = rendering.report;
    panel->annotation = options->annotation;
    rendering.scene = (Scene){0};
    rendering_close(&rendering);
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
