/* Checks whether a scene can be drawn as lines (--ink), and writes the drawing. A drawing consists
 * of lines and paper, so options about the look of surfaces have no effect. render/ink/ink.c finds
 * the lines. */
#include "job/picture/line_drawing.h"

#include "render/render.h"

/* Reasons of the limits not recorded. 0.01 mm is about the width of a dot at 2400 per inch. */
const Range ink_range = {0.01, 10};

Status line_drawing_check(const PictureOptions *picture, const char *output, Err *err)
{
    if (!frames_is_page(output))
        return err_set(err, STATUS_USAGE,
                       "--ink writes .svg, .pdf or .eps only; for pixels use --look ink");
    if (!model_is_of(picture->model, MODEL_PRIMITIVES))
        return err_set(err, STATUS_USAGE, "--ink needs --model %s, not %s",
                       models_of(MODEL_PRIMITIVES).text, models[picture->model].name);
    return STATUS_OK;
}

Status line_drawing_write(const Scene *scene, double line_mm, int threads, const FramesForm *form,
                          Err *err)
{
    static const FigureColor black;
    const InkParams params = {form->page->width_mm, line_mm, threads};
    Strokes strokes = {0};
    Status status;
    TRY_GOTO(ink_strokes(&scene->geometry, &scene->view, &params, &strokes, err));
    figure_add_strokes(form->page, &strokes, (FigurePoint){0, 0}, black);
    TRY_GOTO(figure_check(form->page, err));
    status = frames_write_page(form->page, form->notes, form->path, err);
done:
    strokes_release(&strokes);
    return status;
}
