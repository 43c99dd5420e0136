/* A drawing has lines and paper: what says how surfaces look has no effect on it. */
#include "job/picture/line_drawing.h"

#include "options/output.h"
#include "render/render.h"

const Range ink_range = {0.01, 10};

/* Whether an option, if given, says of light, colours or pixels. */
static bool is_of_surfaces(const Option *option)
{
    static const char *const others[] = {
        "potential", "joints", "min-width", "exact",         "method", "legend", "planes",
        "antialias", "frames", "turntable", "growth",        "tile",   "tiles",  "json",
        "memory",    "bits",   "kernels",   "part-overlaps", NULL};
    return is_one_of(option->name, others) || option->group == GROUP_LIGHT ||
           option->group == GROUP_COLOR || option->group == GROUP_POVRAY;
}

Status line_drawing_check(const PictureOptions *picture, const char *output, const Parsed *parsed,
                          Err *err)
{
    if (!frames_is_page(output))
        return err_set(err, STATUS_USAGE,
                       "--ink draws lines for an .svg or .pdf; --look ink draws pixels");
    if (!model_is_of(picture->model, MODEL_PRIMITIVES))
        return err_set(err, STATUS_USAGE, "--ink is for --model %s, not %s",
                       models_of(MODEL_PRIMITIVES).text, models[picture->model].name);
    for (size_t i = 0; i < parsed->n_settings; i++)
        if (parsed->settings[i].typed && is_of_surfaces(parsed->settings[i].option))
            return err_set(err, STATUS_USAGE, "--%s has no effect on a line drawing (--ink)",
                           parsed->settings[i].option->name);
    return STATUS_OK;
}

static Status write_lines(const Strokes *strokes, const FramesForm *form, Err *err)
{
    static const FigureColor black;
    figure_add_strokes(form->page, strokes, (FigurePoint){0, 0}, black);
    TRY(figure_check(form->page, err));
    return frames_write_page(form->page, form->notes, form->path, err);
}

Status line_drawing_write(const Scene *scene, double line_mm, int threads, const FramesForm *form,
                          Err *err)
{
    const InkParams params = {form->page->width_mm, line_mm, threads};
    Strokes strokes;
    TRY(ink_draw(&scene->geometry, &scene->view, &params, &strokes, err));
    Status status = write_lines(&strokes, form, err);
    strokes_release(&strokes);
    return status;
}
