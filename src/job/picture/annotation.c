/* The legend stands at the right of the picture or below it, and a camera that frames the tree
 * leaves that room free; scale bar and letter stand in corners, which trees hardly ever fill. All
 * distances follow from the size of the text. */
#include "job/picture/annotation.h"

#include "derive/derive.h"
#include <math.h>
#include <string.h>

static const char *const sides[] = {[LEGEND_RIGHT] = "right", [LEGEND_BOTTOM] = "bottom", NULL};

static const Option rows[] = {
    {.name = "legend",
     SETS(SWITCH, Annotation, legend),
     .group = GROUP_PAGE,
     .when = WHEN(SURFACES),
     .help = "draw a color bar beside the tree, with ticks and the name and unit of the field"},
    {.name = "legend-at",
     SETS(CHOICE, Annotation, legend_at),
     GIVEN(Annotation, has_side),
     .choices = sides,
     .group = GROUP_PAGE,
     .needs = "legend",
     .help = "position of the legend"},
    {.name = "legend-title",
     SETS(TEXT, Annotation, title),
     GIVEN(Annotation, has_title),
     .group = GROUP_PAGE,
     .argument = "TEXT",
     .otherwise = "name and unit of the field",
     .needs = "legend",
     .help = "with --legend on: text above the legend"},
    {.name = "scale-bar",
     SETS(NUMBER, Annotation, scale_bar_mm),
     GIVEN(Annotation, has_scale_bar),
     FROM_TO(1e-6, 1e7),
     .group = GROUP_PAGE,
     .unit = "mm",
     .otherwise = "",
     .help =
         "draw a scale bar that represents this length of the tree; orthographic projection only"},
    {.name = "letter",
     SETS(TEXT, Annotation, letter),
     .group = GROUP_PAGE,
     .argument = "TEXT",
     .help = "draw a bold letter in the upper left corner, as for a panel of a figure"},
    {.name = "text-size",
     SETS(NUMBER, Annotation, text_pt),
     FROM_TO(1, 1000),
     .group = GROUP_PAGE,
     .unit = "pt",
     .needs = "legend scale-bar letter",
     .help =
         "size of the text of legend and scale bar; an image sized in pixels counts as 300 dpi"},
};

const OptionTable annotation_table = OPTION_TABLE(rows);

void annotation_set_defaults(Annotation *annotation)
{
    annotation->text_pt = 7;
}

bool annotation_is_any(const Annotation *annotation)
{
    return annotation->legend || annotation->has_scale_bar || annotation->letter;
}

Status annotation_check(const Annotation *annotation, const PictureOptions *picture, Err *err)
{
    const bool flat = picture->projection == PROJECTION_ORTHOGRAPHIC;
    if (annotation->legend && !picture->coloring.field)
        return err_set(err, STATUS_USAGE, "--legend needs --color-by");
    if (annotation->has_scale_bar && !flat)
        return err_set(
            err, STATUS_USAGE,
            "--scale-bar needs an orthographic picture: in perspective no scale bar is correct");
    return STATUS_OK;
}

double annotation_dpi(const PictureOptions *picture)
{
    return picture->size.dpi > 0 ? picture->size.dpi : 300;
}

FigureColor annotation_color(Rgb linear)
{
    return (FigureColor){{(uint8_t)image_code(linear.r, ENCODING_SRGB, 8),
                          (uint8_t)image_code(linear.g, ENCODING_SRGB, 8),
                          (uint8_t)image_code(linear.b, ENCODING_SRGB, 8)}};
}

FigureColor annotation_ink(Rgb background)
{
    float luminance = 0.2126f * background.r + 0.7152f * background.g + 0.0722f * background.b;
    uint8_t code = luminance < 0.18f ? 255 : 0;
    return (FigureColor){{code, code, code}};
}

/* ---- words ----------------------------------------------------------------------------------- */

/* "mm3/s" with its exponent raised, and "um" with its Greek letter. */
static void put_unit(const char *unit, Text *text)
{
    for (const char *c = unit; *c; c++)
        if (c > unit && (*c == '2' || *c == '3') && c[-1] >= 'a' && c[-1] <= 'z')
            text_puts(text, *c == '2' ? "\xC2\xB2" : "\xC2\xB3");
        else if (*c == 'u' && c[1] == 'm')
            text_puts(text, "\xC2\xB5");
        else
            text_append(text, c, 1);
}

static void put_title(const Annotation *annotation, const ColorScale *scale, Text *text)
{
    if (annotation->title) {
        text_puts(text, annotation->title);
        return;
    }
    text_puts(text, derive_field_title(scale->name));
    if (*scale->unit) {
        text_puts(text, " (");
        put_unit(scale->unit, text);
        text_puts(text, ")");
    }
}

/* "10 mm", and in micrometres what is less than one. */
static void put_length(double mm, Text *text)
{
    bool small = mm < 1;
    text_number(text, small ? round(mm * 1e6) / 1e3 : mm);
    text_puts(text, small ? " \xC2\xB5m" : " mm");
}

/* ---- the legend ------------------------------------------------------------------------------ */

static bool are_whole(const Appearance *appearance)
{
    for (size_t i = 0; i < appearance->n_values; i++)
        if (isfinite(appearance->values[i]) &&
            appearance->values[i] != floor(appearance->values[i]))
            return false;
    return true;
}

/* Appends the legend of a picture of this size, anywhere. */
static Status add_legend(const Annotation *annotation, const Appearance *appearance, double width,
                         double height, FigureColor ink, FigurePage *page, Err *err)
{
    const double em = annotation->text_pt * MM_PER_POINT;
    const bool across = annotation->legend_at == LEGEND_BOTTOM;
    Text title = TEXT_INIT;
    put_title(annotation, &appearance->scale, &title);
    Status status = text_check(&title, err);
    const FigureLegend legend = {.scale = &appearance->scale,
                                 .outside = appearance->outside,
                                 .integers = are_whole(appearance),
                                 .title = text_chars(&title),
                                 .horizontal = across,
                                 .length_mm =
                                     fmin(fmax((across ? width : height) / 2, 5 * em), 18 * em),
                                 .size_pt = annotation->text_pt,
                                 .ink = ink};
    if (status == STATUS_OK)
        figure_add_legend(page, &legend);
    text_release(&title);
    return status == STATUS_OK ? figure_check(page, err) : status;
}

static double gap_of(const Annotation *annotation)
{
    return 0.9 * annotation->text_pt * MM_PER_POINT;
}

static Status measure(const Annotation *annotation, const Appearance *appearance, FigurePage *page,
                      double size[2], Err *err)
{
    TRY(add_legend(annotation, appearance, page->width_mm, page->height_mm, page->background, page,
                   err));
    FigureBox box = figure_bounds(page, 0);
    size[0] = box.right - box.left;
    size[1] = box.bottom - box.top;
    return STATUS_OK;
}

Status annotation_make_room(const Annotation *annotation, const FigureFonts *fonts,
                            const Appearance *appearance, PictureOptions *picture, Err *err)
{
    const double pixel = MM_PER_INCH / annotation_dpi(picture);
    const int *pixels = picture->size.pixels;
    FigurePage page;
    double size[2];
    if (!annotation->legend)
        return STATUS_OK;
    figure_init(&page, pixels[0] * pixel, pixels[1] * pixel, annotation_dpi(picture), fonts);
    Status status = measure(annotation, appearance, &page, size, err);
    figure_release(&page);
    TRY(status);
    int side = annotation->legend_at == LEGEND_RIGHT ? 0 : 1;
    int needed = (int)ceil((size[side] + gap_of(annotation)) / pixel);
    if (needed > pixels[side] * 2 / 3)
        return err_set(err, STATUS_USAGE,
                       "--legend needs %.0f mm, but the picture has %.0f mm; use a larger --size "
                       "or a smaller --text-size",
                       needed * pixel, pixels[side] * pixel);
    picture->stage.room[side] = needed;
    return STATUS_OK;
}

/* At the edge, in the middle of it. */
static Status put_legend(const Annotation *annotation, const Scene *scene, FigureBox where,
                         FigurePage *page, Err *err)
{
    const size_t first = page->n;
    const double width = where.right - where.left, height = where.bottom - where.top;
    const double gap = gap_of(annotation);
    TRY(add_legend(annotation, &scene->appearance, width, height,
                   annotation_ink(scene->view.background), page, err));
    FigureBox box = figure_bounds(page, first);
    if (annotation->legend_at == LEGEND_RIGHT)
        figure_move(page, first, where.right - gap - box.right,
                    (where.top + where.bottom - box.top - box.bottom) / 2);
    else
        figure_move(page, first, (where.left + where.right - box.left - box.right) / 2,
                    where.bottom - gap - box.bottom);
    return STATUS_OK;
}

/* ---- the rest -------------------------------------------------------------------------------- */

static Status put_scale_bar(const Annotation *annotation, const Scene *scene, FigureBox where,
                            FigurePage *page, Err *err)
{
    const double width = where.right - where.left, gap = gap_of(annotation);
    const double shown = vec3_length(scene->view.camera.right);
    const size_t first = page->n;
    if (annotation->scale_bar_mm > shown)
        return err_set(err, STATUS_USAGE,
                       "--scale-bar: %g mm is longer than the width of the picture, %.4g mm",
                       annotation->scale_bar_mm, shown);
    Text label = TEXT_INIT;
    put_length(annotation->scale_bar_mm, &label);
    Status status = text_check(&label, err);
    if (status == STATUS_OK)
        figure_add_scale_bar(page, annotation->scale_bar_mm / shown * width, text_chars(&label),
                             annotation->text_pt, annotation_ink(scene->view.background));
    text_release(&label);
    TRY(status);
    FigureBox box = figure_bounds(page, first);
    figure_move(page, first, where.left + gap - box.left, where.bottom - gap - box.bottom);
    return STATUS_OK;
}

static void put_letter(const Annotation *annotation, const Scene *scene, FigureBox where,
                       FigurePage *page)
{
    const double gap = gap_of(annotation), size = annotation->text_pt + 1;
    const FigureText letter = {.text = annotation->letter,
                               .x = where.left + gap,
                               .y = where.top + gap + 0.73 * size * MM_PER_POINT,
                               .size_pt = size,
                               .bold = true,
                               .color = annotation_ink(scene->view.background)};
    figure_add_text(page, &letter);
}

Status annotation_put(const Annotation *annotation, const Scene *scene, FigureBox where,
                      FigurePage *page, Err *err)
{
    if (annotation->legend)
        TRY(put_legend(annotation, scene, where, page, err));
    if (annotation->has_scale_bar)
        TRY(put_scale_bar(annotation, scene, where, page, err));
    if (annotation->letter)
        put_letter(annotation, scene, where, page);
    return figure_check(page, err);
}
