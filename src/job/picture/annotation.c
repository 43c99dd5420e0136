/* Defines and checks the options for the legend, the scale bar and the panel letter of a picture,
 * and draws these on a page.
 *
 * The legend is at the right of the picture or below it. When the camera is fitted to the tree, the
 * tree is drawn beside the space that is reserved for the legend. The panel letter is in the upper
 * left corner, where publishers expect it. The scale bar is, by default, in the corner with the
 * fewest vessels. All distances are multiples of the font size (1 em). Reasons for the multiples
 * and for the default of 7 pt are not recorded, except where a comment has them. */
#include "job/picture/annotation.h"

#include "derive/derive.h"
#include <math.h>
#include <string.h>

static const char *const sides[] = {[LEGEND_RIGHT] = "right", [LEGEND_BOTTOM] = "bottom", NULL};

static const Option legend_rows[] = {
    {.name = "legend",
     SETS(SWITCH, Annotation, legend),
     .group = GROUP_PAGE,
     .when = WHEN(SURFACES),
     .help = "draw a color bar beside the tree, with ticks and the name and unit of the field"},
    {.name = "legend-at",
     SETS(CHOICE, Annotation, legend_at),
     GIVEN(Annotation, has_legend_at),
     .choices = sides,
     .group = GROUP_PAGE,
     .otherwise =
         "right; in an image taller than wide, bottom if this leaves room for a larger tree",
     .needs = "legend",
     .help = "position of the legend"},
    {.name = "legend-title",
     SETS(TEXT, Annotation, title),
     GIVEN(Annotation, has_title),
     .group = GROUP_PAGE,
     .argument = "TEXT",
     .otherwise = "name and unit of the field",
     .needs = "legend",
     .help = "text above the legend; " FIGURE_MARKUP},
    {.name = "text-size",
     SETS(NUMBER, Annotation, text_pt),
     FROM_TO(1, 1000),
     .group = GROUP_PAGE,
     .unit = "pt",
     .needs = "legend scale-bar letter",
     .help = "font size of legend and scale bar on paper; a letter is 1 pt larger. An image "
             "whose --size is in pixels has 300 pixels per inch, unless --dpi is set. In a .svg, "
             ".pdf or .eps of `corcast diagram`, the size holds if the longer side is printed "
             "180 mm long"},
};

static const Option rows[] = {
    {.name = "scale-bar",
     SETS(NUMBER, Annotation, scale_bar_mm),
     GIVEN(Annotation, has_scale_bar),
     FROM_TO(1e-6, 1e7),
     .group = GROUP_PAGE,
     .unit = "mm",
     .otherwise = "no scale bar",
     .help = "for --projection orthographic only: length in the tree that a scale bar shows"},
    {.name = "scale-bar-at",
     SETS(CHOICE, Annotation, scale_bar_at),
     .choices = corner_names,
     .group = GROUP_PAGE,
     .needs = "scale-bar",
     .help = "corner of the scale bar: bottom-left, bottom-right, top-left, top-right, or emptiest "
             "(where the bar covers the fewest vessels)"},
    {.name = "letter",
     SETS(TEXT, Annotation, letter),
     .group = GROUP_PAGE,
     .argument = "TEXT",
     .help = "bold text in the upper left corner, such as the letter of a panel"},
};

const OptionTable legend_table = OPTION_TABLE(legend_rows);
const OptionTable annotation_table = OPTION_TABLE(rows);

void annotation_set_defaults(Annotation *annotation)
{
    annotation->text_pt = 7;
}

bool annotation_is_wanted(const Annotation *annotation)
{
    return annotation->legend || annotation->has_scale_bar || annotation->letter;
}

Status annotation_check_legend(const Annotation *annotation, const Coloring *coloring, Err *err)
{
    if (annotation->legend && !coloring->field)
        return err_set(err, STATUS_USAGE, "--legend needs --color-by");
    return STATUS_OK;
}

Status annotation_check(const Annotation *annotation, const PictureOptions *picture, Err *err)
{
    const bool orthographic = picture->projection == PROJECTION_ORTHOGRAPHIC;
    TRY(annotation_check_legend(annotation, &picture->coloring, err));
    if (annotation->has_scale_bar && !orthographic)
        return err_set(
            err, STATUS_USAGE,
            "--scale-bar needs an orthographic picture: in perspective no scale bar is correct");
    return STATUS_OK;
}

Status annotation_check_file(const Annotation *annotation, const char *output, Err *err)
{
    if (!image_traits(output).floats || !annotation_is_wanted(annotation))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "-o: %s stores measured values and cannot have a legend, scale bar or letter",
                   strcmp(file_extension(output), "exr") ? "a .pfm" : "an .exr");
}

/* 300 dpi is a usual resolution of printed pictures. */
double annotation_dpi(const PictureSize *size)
{
    return size->dpi > 0 ? size->dpi : 300;
}

FigureColor annotation_color(Rgb linear)
{
    return (FigureColor){{(uint8_t)image_code(linear.r, ENCODING_SRGB, 8),
                          (uint8_t)image_code(linear.g, ENCODING_SRGB, 8),
                          (uint8_t)image_code(linear.b, ENCODING_SRGB, 8)}};
}

/* At a luminance of 0.18, black and white text have the same contrast, by the ratio of (luminance +
 * 0.05) of WCAG 2. */
FigureColor annotation_text_color(Rgb background)
{
    float luminance = 0.2126f * background.r + 0.7152f * background.g + 0.0722f * background.b;
    uint8_t code = luminance < 0.18f ? 255 : 0;
    return (FigureColor){{code, code, code}};
}

/* ---- words ----------------------------------------------------------------------------------- */

static void put_title(const Annotation *annotation, const ColorScale *scale, Text *text)
{
    if (annotation->title) {
        text_puts(text, annotation->title);
        return;
    }
    text_puts(text, derive_field_title(scale->name));
    if (*scale->unit) {
        text_puts(text, " (");
        text_unit(text, scale->unit);
        text_puts(text, ")");
    }
}

/* Appends a length such as "10 mm"; a length below 1 mm is in micrometres. */
static void put_length(double mm, Text *text)
{
    bool small = mm < 1;
    text_number(text, small ? round(mm * 1e6) / 1e3 : mm);
    text_puts(text, small ? " \xC2\xB5m" : " mm");
}

/* ---- the legend ------------------------------------------------------------------------------ */

/* Returns true if all values are integers. */
static bool are_whole(const Appearance *appearance)
{
    for (size_t i = 0; i < appearance->n_values; i++)
        if (isfinite(appearance->values[i]) &&
            appearance->values[i] != floor(appearance->values[i]))
            return false;
    return true;
}

/* Maximum number of swatches; a legend with more values has a bar. Readers cannot tell many more
 * colors apart than the dozen of a qualitative map. */
enum { MOST_SWATCHES = 12 };

/* Lists the different values that the scale can show, ascending. Returns their number, at most
 * MOST_SWATCHES + 1, which means: too many. */
static int list_values(const Appearance *appearance, double list[MOST_SWATCHES + 1])
{
    int n = 0;
    for (size_t i = 0; i < appearance->n_values && n <= MOST_SWATCHES; i++) {
        const double value = appearance->values[i];
        int at = n;
        if (isnan(colorscale_position(&appearance->scale, value)))
            continue;
        while (at > 0 && list[at - 1] >= value)
            at--;
        if (at < n && list[at] == value)
            continue;
        memmove(&list[at + 1], &list[at], (size_t)(n - at) * sizeof *list);
        list[at] = value;
        n++;
    }
    return n;
}

/* Returns the length that a swatch takes along the legend, in em. The numbers are those of
 * figure/legend.c, except that a digit is assumed to be 0.56 em wide. `across`: the swatches are
 * side by side, so the widest label decides. */
static double swatch_ems(bool across, double value)
{
    const double digit_ems = 0.56;
    const size_t digits = strlen(READABLE(value, 6));
    return across ? fmax(1.7, digit_ems * (double)digits + 0.6) : 1.35;
}

/* Chooses between swatches and a bar. A scale with classes has a bar. Otherwise a field with a
 * single value has one swatch. Integers have a swatch each if they are at most MOST_SWATCHES and
 * their swatches fit into a length of `ems` em. Returns the number of swatches; 0: the legend has a
 * bar. */
static int list_swatches(const Appearance *appearance, bool across, double ems,
                         double list[MOST_SWATCHES + 1])
{
    const ColorScale *scale = &appearance->scale;
    const int n = list_values(appearance, list);
    if (scale->n_bounds || scale->classes > 1)
        return 0;
    if (n == 1)
        return 1;
    const bool few = n > 0 && n <= MOST_SWATCHES && are_whole(appearance);
    return few && !appearance->positions && n * swatch_ems(across, list[n - 1]) <= ems ? n : 0;
}

/* Appends the legend of a picture of this size in mm, at an arbitrary position; the caller moves
 * it. An em is the size of the text. The bar is half as long as the picture's side, within 5 to 18
 * em: a shorter bar has no space for labels, a longer one shows nothing more. A vertical legend has
 * a title above it, which takes about 3 em. */
static Status add_legend(const Annotation *annotation, const Appearance *appearance, double width,
                         double height, FigureColor ink, FigurePage *page, Err *err)
{
    const double em = annotation->text_pt * MM_PER_POINT;
    const bool across = annotation->legend_at == LEGEND_BOTTOM;
    const double title_ems = 3, ems = across ? width / em : height / em - title_ems;
    double swatches[MOST_SWATCHES + 1];
    Text title = TEXT_INIT;
    put_title(annotation, &appearance->scale, &title);
    Status status = text_check(&title, err);
    const FigureLegend legend = {.scale = &appearance->scale,
                                 .outside = appearance->outside,
                                 .integers = are_whole(appearance),
                                 .swatches = swatches,
                                 .n_swatches = list_swatches(appearance, across, ems, swatches),
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

/* Returns the gap between annotations and the edge of the picture, mm. */
static double gap_of(const Annotation *annotation)
{
    return 0.9 * annotation->text_pt * MM_PER_POINT;
}

/* Sets `size` to the width and height in mm of the legend and its gap, for a picture that is as
 * large as `model`. The legend is drawn on a page that is discarded, so its color does not matter.
 */
static Status measure(const Annotation *annotation, const Appearance *appearance,
                      const FigurePage *model, double size[2], Err *err)
{
    FigurePage page;
    figure_init(&page, model->width_mm, model->height_mm, model->dpi, model->fonts);
    Status status = add_legend(annotation, appearance, page.width_mm, page.height_mm,
                               page.background, &page, err);
    const FigureBox box = figure_bounds(&page, 0);
    size[0] = box.right - box.left + gap_of(annotation);
    size[1] = box.bottom - box.top + gap_of(annotation);
    figure_release(&page);
    return status;
}

/* In an upright picture without --legend-at, the legend is on the side that leaves the larger
 * square for the tree. Both sides are measured; a tie is decided in favour of the right side. */
Status annotation_measure_legend(Annotation *annotation, const Appearance *appearance,
                                 const FigurePage *page, double size[2], Err *err)
{
    TRY(measure(annotation, appearance, page, size, err));
    if (annotation->has_legend_at || page->height_mm <= page->width_mm)
        return STATUS_OK;
    const double right_square = fmin(page->width_mm - size[0], page->height_mm);
    annotation->legend_at = LEGEND_BOTTOM;
    TRY(measure(annotation, appearance, page, size, err));
    if (fmin(page->width_mm, page->height_mm - size[1]) > right_square)
        return STATUS_OK;
    annotation->legend_at = LEGEND_RIGHT;
    return measure(annotation, appearance, page, size, err);
}

Status annotation_reserve_space(Annotation *annotation, const FigureFonts *fonts,
                                const Appearance *appearance, const PictureSize *picture,
                                int space[2], Err *err)
{
    const double pixel = MM_PER_INCH / annotation_dpi(picture);
    const int *pixels = picture->pixels;
    FigurePage page;
    double size[2];
    if (!annotation->legend)
        return STATUS_OK;
    figure_init(&page, pixels[0] * pixel, pixels[1] * pixel, annotation_dpi(picture), fonts);
    Status status = annotation_measure_legend(annotation, appearance, &page, size, err);
    figure_release(&page);
    TRY(status);
    int side = annotation->legend_at == LEGEND_RIGHT ? 0 : 1;
    int needed = (int)ceil(size[side] / pixel);
    /* A third of the picture is left for the tree. In less the tree would be smaller than its
     * legend. */
    if (needed > pixels[side] * 2 / 3)
        return err_set(err, STATUS_USAGE,
                       "--legend needs %.0f mm, but the picture has %.0f mm; use a larger --size "
                       "or a smaller --text-size",
                       needed * pixel, pixels[side] * pixel);
    space[side] = needed;
    return STATUS_OK;
}

/* Puts the legend at the right or the lower edge of `where`, centred along this edge. */
Status annotation_put_legend(const Annotation *annotation, const Appearance *appearance,
                             FigureColor ink, FigureBox where, FigurePage *page, Err *err)
{
    const size_t first = page->n;
    const double width = where.right - where.left, height = where.bottom - where.top;
    const double gap = gap_of(annotation);
    TRY(add_legend(annotation, appearance, width, height, ink, page, err));
    FigureBox box = figure_bounds(page, first);
    if (annotation->legend_at == LEGEND_RIGHT)
        figure_move(page, first, where.right - gap - box.right,
                    (where.top + where.bottom - box.top - box.bottom) / 2);
    else
        figure_move(page, first, (where.left + where.right - box.left - box.right) / 2,
                    where.bottom - gap - box.bottom);
    return STATUS_OK;
}

/* ---- scale bar and letter ----------------------------------------------------------------------
 */

static Status put_scale_bar(const Annotation *annotation, const Scene *scene, FigureBox where,
                            FigurePage *page, Err *err)
{
    const double width = where.right - where.left, gap = gap_of(annotation);
    /* orthographic: camera.right is as long as the picture is wide, in mm of the tree */
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
                             annotation->text_pt, annotation_text_color(scene->view.background));
    text_release(&label);
    TRY(status);
    const PlacedPicture picture = {scene, where};
    return placing_move(page, first, &picture, annotation->scale_bar_at, gap, err);
}

/* Appends the panel letter, 1 pt larger than the other text. Its baseline is the height of a
 * capital, 0.73 of the font size, below the gap. */
static void put_letter(const Annotation *annotation, const Scene *scene, FigureBox where,
                       FigurePage *page)
{
    const double gap = gap_of(annotation), size = annotation->text_pt + 1;
    const FigureText letter = {.text = annotation->letter,
                               .x = where.left + gap,
                               .y = where.top + gap + 0.73 * size * MM_PER_POINT,
                               .size_pt = size,
                               .bold = true,
                               .color = annotation_text_color(scene->view.background)};
    figure_add_text(page, &letter);
}

double annotation_halo_width(double text_pt)
{
    return 0.12 * text_pt * MM_PER_POINT;
}

Status annotation_put(const Annotation *annotation, const Scene *scene, FigureBox where,
                      FigurePage *page, Err *err)
{
    const size_t first = page->n;
    const PlacedPicture picture = {scene, where};
    if (annotation->legend)
        TRY(annotation_put_legend(annotation, &scene->appearance,
                                  annotation_text_color(scene->view.background), where, page, err));
    if (annotation->letter)
        put_letter(annotation, scene, where, page);
    if (annotation->has_scale_bar)
        TRY(put_scale_bar(annotation, scene, where, page, err));
    TRY(figure_check(page, err));
    return placing_add_halos(page, first, &picture, annotation_halo_width(annotation->text_pt),
                             err);
}
