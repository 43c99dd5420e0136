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
static Status draw_view(Rendering *r, const View *view, Picture *picture, Strokes *strokes,
                        Err *err)
{
    const InkParams ink = {.width_mm = view->camera.width * MM_PER_INCH / r->form.dpi,
                           .line_mm = r->options->ink_mm,
                           .threads = r->params.threads};
    Frame frame = {0};
    if (ink.line_mm > 0)
        return ink_strokes(&r->scene.geometry, view, &ink, strokes, err);
    Status status = view == &r->scene.view ? rendering_draw(r, 1, &frame, err)
                                           : rendering_draw_view(r, view, &frame, err);
    if (status == STATUS_OK)
        *picture = frame.codes;
    else
        frame_release(&frame);
    return status;
}

static Status draw_views(Rendering *r, Panel *panel, Err *err)
{
    if (panel->in_lines && r->options->annotation.legend)
        return err_set(err, STATUS_USAGE, "--legend has no effect on a line drawing (--ink)");
    TRY(draw_view(r, &r->scene.view, &panel->picture, &panel->strokes, err));
    for (size_t i = 0; i < panel->n_insets; i++) {
        PanelInset *inset = &panel->insets[i];
        const View view = panel_inset_view(inset, &r->scene.view);
        TRY(draw_view(r, &view, &inset->picture, &inset->strokes, err));
    }
    return STATUS_OK;
}

Status panel_scale(Parsed *parsed, const FigureFonts *fonts, double *mm_per_pixel, Err *err)
{
    RenderOptions *options = parsed->options;
    Rendering r;
    if (options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "same-scale needs orthographic panels");
    TRY(rendering_open(options, parsed, fonts, &r, err));
    *mm_per_pixel = vec3_length(r.scene.view.camera.up) / r.scene.view.camera.height;
    rendering_close(&r);
    return STATUS_OK;
}

Status panel_draw(Parsed *parsed, Panel *panel, Err *err)
{
    RenderOptions *options = parsed->options;
    Rendering r;
    panel->in_lines = options->ink_mm > 0;
    TRY(options_settle(parsed, err));
    if (panel->n_insets > 0 && !options->picture.has_projection)
        options->picture.projection = PROJECTION_ORTHOGRAPHIC;
    if (panel->n_insets > 0 && options->picture.projection == PROJECTION_PERSPECTIVE)
        return err_set(err, STATUS_USAGE, "an inset needs an orthographic panel");
    TRY(rendering_open(options, parsed, panel->fonts, &r, err));
    r.name = panel->name;
    Status status = draw_views(&r, panel, err);
    panel->scene = r.scene;
    panel->report = r.report;
    panel->annotation = options->annotation;
    r.scene = (Scene){0};
    rendering_close(&r);
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
