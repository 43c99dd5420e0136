/* An inset is a picture of its own, drawn by the camera of its panel's, cropped; two lines lead
 * from the part that it shows to it. */
#include "job/figure/figure.h"

#include <math.h>
#include <string.h>

/* The section of this kind and name; plan.n when there is none. */
static size_t find_section(const FigurePlan *plan, SectionKind kind, const char *name)
{
    size_t i = 0;
    while (i < plan->n &&
           (plan->sections[i]->kind != kind || strcmp(plan->sections[i]->name, name) != 0))
        i++;
    return i;
}

/* An inset may lie beside its panel. What is farther off than this many sides of the panel is a
 * mistake. */
static const double far_sides = 10;

static Status check_inset(const FigurePlan *plan, const Section *section, Err *err)
{
    const InsetOptions *inset = section->own.options;
    if (!inset->of || find_section(plan, SECTION_PANEL, inset->of) == plan->n)
        return err_set(err, STATUS_USAGE, "[inset %s]: of: %s%s is not the name of a panel",
                       section->name, inset->of ? "" : "nothing", inset->of ? inset->of : "");
    if (!inset->has_at || !inset->has_place)
        return err_set(
            err, STATUS_USAGE,
            "[inset %s] needs 'at' (centre of the part that it shows) and 'place' (its own "
            "centre), both as fractions of the panel's width and height, such as 0.3,0.6",
            section->name);
    const double all[] = {inset->at.x, inset->at.y, inset->place.x, inset->place.y};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!(fabs(all[i]) <= far_sides))
            return err_set(
                err, STATUS_USAGE,
                "[inset %s]: %s: %g is not a fraction of the panel's width or height, from 0 to 1",
                section->name, i < 2 ? "at" : "place", all[i]);
    return STATUS_OK;
}

/* The insets of panel `of`, which follow each other from `first` on. */
Status figure_plan_insets(Figure *figure, size_t of, size_t first, size_t *n, Err *err)
{
    *n = 0;
    for (size_t i = 0; i < figure->plan.n; i++) {
        const Section *section = figure->plan.sections[i];
        const InsetOptions *inset = section->own.options;
        if (section->kind != SECTION_INSET)
            continue;
        TRY(check_inset(&figure->plan, section, err));
        if (find_section(&figure->plan, SECTION_PANEL, inset->of) != of)
            continue;
        double height = inset->height_mm > 0 ? inset->height_mm : inset->width_mm;
        figure->insets[first + (*n)++] =
            (PanelInset){.at = {inset->at.x, inset->at.y},
                         .magnify = inset->magnify,
                         .pixels = {figure_pixels(&figure->sheet.page, inset->width_mm),
                                    figure_pixels(&figure->sheet.page, height)}};
    }
    return STATUS_OK;
}

static void corners_of(const FigureBox *box, FigurePoint corner[4])
{
    corner[0] = (FigurePoint){box->left, box->top};
    corner[1] = (FigurePoint){box->right, box->top};
    corner[2] = (FigurePoint){box->right, box->bottom};
    corner[3] = (FigurePoint){box->left, box->bottom};
}

/* Whether a line has a part within the box, whose edges do not count. */
static bool crosses(FigurePoint from, FigurePoint to, const FigureBox *box)
{
    double begin = 0, end = 1;
    const double start[] = {from.x, from.y}, way[] = {to.x - from.x, to.y - from.y};
    const double low[] = {box->left, box->top}, high[] = {box->right, box->bottom};
    for (int k = 0; k < 2; k++) {
        double a = (low[k] - start[k]) / way[k], b = (high[k] - start[k]) / way[k];
        if (way[k] == 0 && (start[k] <= low[k] || start[k] >= high[k]))
            return false;
        if (way[k] == 0)
            continue;
        begin = fmax(begin, fmin(a, b));
        end = fmin(end, fmax(a, b));
    }
    return end - begin > 1e-6;
}

/* Lines from corners of the part to those of the inset that cross neither: two, where one does not
 * lie over the other. */
static void put_ties(FigurePage *page, const FigureBox *part, const FigureBox *inset,
                     double width_mm, FigureColor ink)
{
    FigurePoint from[4], to[4];
    corners_of(part, from);
    corners_of(inset, to);
    for (int k = 0; k < 4; k++) {
        const FigurePoint line[] = {from[k], to[k]};
        if (!crosses(from[k], to[k], part) && !crosses(from[k], to[k], inset))
            figure_add_line(page, line, 2, false, width_mm, ink);
    }
}

/* Its paper covers the panel's lines. */
static void put_lines(Figure *figure, const PanelInset *inset, const FigureBox *shown)
{
    FigurePage *page = &figure->sheet.page;
    figure_add_box(page, *shown, page->background);
    figure_add_strokes(page, &inset->strokes, (FigurePoint){shown->left, shown->top}, figure->ink);
}

static Status put_inset(Figure *figure, const Section *section, size_t of, const PanelInset *inset,
                        Err *err)
{
    enum { CORNERS = 4 };
    const InsetOptions *options = section->own.options;
    const Panel *panel = &figure->panels[of];
    const Place *place = &figure->places[of];
    FigurePage *page = &figure->sheet.page;
    const double pixel = MM_PER_INCH / page->dpi, line_mm = 0.18;
    const FigureBox box = figure_panel_box(figure, of);
    const double width = box.right - box.left, height = box.bottom - box.top;
    int left = place->left + (int)lround(options->place.x * place->width) - inset->pixels[0] / 2;
    int top = place->top + (int)lround(options->place.y * place->height) - inset->pixels[1] / 2;
    if (left < 0 || top < 0 || left + inset->pixels[0] > figure_pixels(page, page->width_mm) ||
        top + inset->pixels[1] > figure_pixels(page, page->height_mm))
        return err_set(err, STATUS_USAGE, "[inset %s] extends beyond the page", section->name);
    const FigureBox shown = {left * pixel, top * pixel, (left + inset->pixels[0]) * pixel,
                             (top + inset->pixels[1]) * pixel};
    if (!panel->in_lines)
        figure_add_picture(page, &inset->picture, left, top);
    else
        put_lines(figure, inset, &shown);
    FigureBox part = panel_part(inset, &panel->scene.view.camera);
    part = (FigureBox){box.left + part.left * width, box.top + part.top * height,
                       box.left + part.right * width, box.top + part.bottom * height};
    FigureColor ink = annotation_ink(panel->scene.view.background);
    FigurePoint corner[CORNERS];
    corners_of(&part, corner);
    figure_add_line(page, corner, CORNERS, true, line_mm, ink);
    corners_of(&shown, corner);
    figure_add_line(page, corner, CORNERS, true, line_mm, ink);
    put_ties(page, &part, &shown, line_mm, ink);
    Scene larger = panel->scene;
    larger.view = panel_inset_view(inset, &panel->scene.view);
    const Annotation annotation = {.scale_bar_mm = options->scale_bar_mm,
                                   .has_scale_bar = options->has_scale_bar,
                                   .scale_bar_at = options->scale_bar_at,
                                   .text_pt = figure->options->text_pt};
    return annotation_put(&annotation, &larger, shown, page, err);
}

Status figure_put_insets(Figure *figure, size_t of, Err *err)
{
    const Panel *panel = &figure->panels[of];
    size_t k = 0;
    for (size_t i = 0; i < figure->plan.n; i++) {
        const Section *section = figure->plan.sections[i];
        const InsetOptions *inset = section->own.options;
        if (section->kind != SECTION_INSET ||
            find_section(&figure->plan, SECTION_PANEL, inset->of) != of)
            continue;
        TRY(put_inset(figure, section, of, &panel->insets[k++], err));
    }
    return STATUS_OK;
}
