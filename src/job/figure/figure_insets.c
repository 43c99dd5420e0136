/* Reads the insets of a figure and draws them on the page. An inset is a picture of its own: the
 * camera of its panel, restricted to a part of the view. Two lines, the leaders, lead from the
 * magnified part to the inset. A leader is interrupted where vessels are, and the pair of leaders
 * is chosen that vessels cover least. */
#include "job/figure/figure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the index of the panel of this name; plan->n if there is none. */
static size_t find_panel(const FigurePlan *plan, const char *name)
{
    size_t i = 0;
    while (i < plan->n &&
           (plan->sections[i]->kind != SECTION_PANEL || strcmp(plan->sections[i]->name, name) != 0))
        i++;
    return i;
}

/* Largest distance of an inset, in sides of its panel. An inset may be beside its panel, even
 * several panels away; a larger number is taken for a mistake, such as millimetres. */
static const double max_distance_sides = 10;

static Status check_inset(const FigurePlan *plan, const Section *section, Err *err)
{
    const InsetOptions *inset = section->own.options;
    if (!inset->of || find_panel(plan, inset->of) == plan->n)
        return err_set(err, STATUS_USAGE, "[inset %s]: of: %s%s is not the name of a panel",
                       section->name, inset->of ? "" : "nothing", inset->of ? inset->of : "");
    const Section *panel = plan->sections[find_panel(plan, inset->of)];
    if (((const PanelOptions *)panel->own.options)->image)
        return err_set(err, STATUS_USAGE,
                       "[inset %s]: of: %s shows an image; an inset needs a tree", section->name,
                       inset->of);
    if (!inset->has_at || !inset->has_place)
        return err_set(
            err, STATUS_USAGE,
            "[inset %s] needs 'at' (center of the part that it shows) and 'place' (its own "
            "center), both as fractions of the panel's width and height, such as 0.3,0.6",
            section->name);
    const double all[] = {inset->at.x, inset->at.y, inset->place.x, inset->place.y};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!(fabs(all[i]) <= max_distance_sides))
            return err_set(
                err, STATUS_USAGE,
                "[inset %s]: %s: %g is not a fraction of the panel's width or height, from 0 to 1",
                section->name, i < 2 ? "at" : "place", all[i]);
    return STATUS_OK;
}

/* The insets of a panel are stored one after another, from `first` on. */
Status figure_plan_insets(Figure *figure, size_t of, size_t first, size_t *n, Err *err)
{
    *n = 0;
    for (size_t i = 0; i < figure->plan.n; i++) {
        const Section *section = figure->plan.sections[i];
        const InsetOptions *inset = section->own.options;
        if (section->kind != SECTION_INSET)
            continue;
        TRY(check_inset(&figure->plan, section, err));
        if (find_panel(&figure->plan, inset->of) != of)
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

/* Returns true if a part of the line is inside the box. The edges of the box do not count. `begin`
 * and `end` are the fractions of the line between which it is inside [Liang and Barsky]. */
static bool crosses(FigurePoint from, FigurePoint to, const FigureBox *box)
{
    double begin = 0, end = 1;
    const double start[] = {from.x, from.y}, span[] = {to.x - from.x, to.y - from.y};
    const double low[] = {box->left, box->top}, high[] = {box->right, box->bottom};
    for (int k = 0; k < 2; k++) {
        double a = (low[k] - start[k]) / span[k], b = (high[k] - start[k]) / span[k];
        if (span[k] == 0 && (start[k] <= low[k] || start[k] >= high[k]))
            return false;
        if (span[k] == 0)
            continue;
        begin = fmax(begin, fmin(a, b));
        end = fmin(end, fmax(a, b));
    }
    return end - begin > 1e-6;
}

/* Returns true if two lines cross. */
static bool lines_cross(const FigurePoint a[2], const FigurePoint b[2])
{
    double side[4];
    for (int k = 0; k < 2; k++) {
        side[k] = (a[1].x - a[0].x) * (b[k].y - a[0].y) - (a[1].y - a[0].y) * (b[k].x - a[0].x);
        side[2 + k] = (b[1].x - b[0].x) * (a[k].y - b[0].y) - (b[1].y - b[0].y) * (a[k].x - b[0].x);
    }
    return side[0] * side[1] < 0 && side[2] * side[3] < 0;
}

/* ---- leaders --------------------------------------------------------------------------------- */

/* The cells of a panel that vessels cover, with a narrow border around each vessel: the shadow that
 * the vessels cast on the page. */
typedef struct Shadow {
    FigureBox box; /* of the panel */
    double cell_mm;
    int width, height;
    uint8_t *covered; /* owned */
} Shadow;

/* Side of a cell, half the width of a leader's line; and width of the border, which keeps a visible
 * gap between a leader and a vessel. */
static const double shadow_cell_mm = 0.1, shadow_border_mm = 0.25;

static bool is_covered(const Shadow *shadow, FigurePoint at)
{
    const double x = floor((at.x - shadow->box.left) / shadow->cell_mm);
    const double y = floor((at.y - shadow->box.top) / shadow->cell_mm);
    return x >= 0 && y >= 0 && x < shadow->width && y < shadow->height &&
           shadow->covered[(size_t)y * (size_t)shadow->width + (size_t)x];
}

/* Covers a disk. `radius` is in cells, as `x` and `y`. */
static void cover_disk(Shadow *shadow, double x, double y, double radius)
{
    const int top = (int)fmax(0, ceil(y - radius)),
              bottom = (int)fmin(shadow->height - 1, y + radius);
    for (int row = top; row <= bottom; row++) {
        const double half = sqrt(fmax(0, radius * radius - (row - y) * (row - y)));
        const int left = (int)fmax(0, ceil(x - half)),
                  right = (int)fmin(shadow->width - 1, x + half);
        if (right >= left)
            memset(&shadow->covered[(size_t)row * (size_t)shadow->width + (size_t)left], 1,
                   (size_t)(right - left + 1));
    }
}

/* Returns a point's position in the shadow, in cells. */
static FigurePoint project(const Shadow *shadow, const Camera *camera, Vec3 point)
{
    const Vec3 from = vec3_sub(point, camera->location);
    const double right = vec3_dot(camera->right, camera->right);
    const double up = vec3_dot(camera->up, camera->up);
    return (FigurePoint){(0.5 + vec3_dot(from, camera->right) / right) * shadow->width,
                         (0.5 - vec3_dot(from, camera->up) / up) * shadow->height};
}

/* Covers a vessel between two points by disks that are half a radius apart, so that their union is
 * nearly straight at the sides. The number of disks is bounded, for vessels of tiny radius. */
static void cover_vessel(Shadow *shadow, const Camera *camera, Vec3 a, Vec3 b, double radius_mm)
{
    const FigurePoint from = project(shadow, camera, a), to = project(shadow, camera, b);
    const double radius =
        radius_mm / vec3_length(camera->right) * shadow->width + shadow_border_mm / shadow->cell_mm;
    const double length = elementary_hypot(to.x - from.x, to.y - from.y);
    const bool is_far = fmax(from.x, to.x) < -radius || fmax(from.y, to.y) < -radius ||
                        fmin(from.x, to.x) > shadow->width + radius ||
                        fmin(from.y, to.y) > shadow->height + radius;
    const int steps = is_far ? -1 : (int)fmin(1e5, ceil(2 * length / radius));
    for (int i = 0; i <= steps; i++) {
        const double t = steps > 0 ? (double)i / steps : 0;
        cover_disk(shadow, from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), radius);
    }
}

/* Marks the cells of the page that vessels cover. */
static Status cast_shadow(const Scene *scene, FigureBox box, Shadow *shadow, Err *err)
{
    const Geometry *geometry = &scene->geometry;
    const Camera *camera = &scene->view.camera;
    *shadow = (Shadow){.box = box, .cell_mm = shadow_cell_mm};
    shadow->width = (int)ceil((box.right - box.left) / shadow_cell_mm);
    shadow->height = (int)ceil((box.bottom - box.top) / shadow_cell_mm);
    TRY(mem_calloc(&shadow->covered, (size_t)shadow->width, (size_t)shadow->height, "leaders",
                   err));
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *vessel = &geometry->primitives[i];
        cover_vessel(shadow, camera, vessel->a,
                     vessel->kind == PRIMITIVE_SPHERE ? vessel->a : vessel->b,
                     fmax(vessel->radius_mm, vessel->radius_b_mm));
    }
    for (size_t i = 0; i < geometry->n_segments; i++)
        cover_vessel(shadow, camera, geometry->segments[i].a, geometry->segments[i].b,
                     geometry->segments[i].radius_mm);
    return STATUS_OK;
}

/* A line from a corner of the part to a corner of the inset. */
typedef struct Leader {
    FigurePoint at[2];
    double length_mm, covered_mm;
    bool possible; /* it crosses neither the part nor the inset */
} Leader;

/* Returns the point of a leader at a distance from its beginning. */
static FigurePoint along(const Leader *leader, double mm)
{
    const double t = leader->length_mm > 0 ? mm / leader->length_mm : 0;
    return (FigurePoint){leader->at[0].x + t * (leader->at[1].x - leader->at[0].x),
                         leader->at[0].y + t * (leader->at[1].y - leader->at[0].y)};
}

static Leader make_leader(FigurePoint from, FigurePoint to, const FigureBox *part,
                          const FigureBox *inset, const Shadow *shadow)
{
    Leader leader = {.at = {from, to}, .length_mm = elementary_hypot(to.x - from.x, to.y - from.y)};
    leader.possible = !crosses(from, to, part) && !crosses(from, to, inset);
    for (double mm = 0; leader.possible && mm < leader.length_mm; mm += shadow_cell_mm)
        leader.covered_mm += is_covered(shadow, along(&leader, mm)) ? shadow_cell_mm : 0;
    return leader;
}

/* Draws the parts of a leader that no vessel covers. Short parts would look like dirt: an end must
 * be half a millimetre long, and a part between two vessels, which is not seen to belong to a line,
 * two millimetres. */
static void put_leader(FigurePage *page, const Leader *leader, const Shadow *shadow,
                       double width_mm, FigureColor ink)
{
    const double shortest_end_mm = 0.5, shortest_mm = 2;
    double begin = 0;
    for (double mm = 0; begin < leader->length_mm; mm += shadow_cell_mm) {
        const bool ends = mm >= leader->length_mm;
        if (!ends && !is_covered(shadow, along(leader, mm)))
            continue;
        const double end = ends ? leader->length_mm : mm;
        const FigurePoint line[] = {along(leader, begin), along(leader, end)};
        const bool is_end = begin == 0 || ends;
        if (end - begin >= (is_end ? shortest_end_mm : shortest_mm) || (begin == 0 && ends))
            figure_add_line(page, line, 2, false, width_mm, ink);
        begin = end + shadow_cell_mm;
    }
}

/* Draws the pair of leaders of which vessels cover the least. Of pairs that are nearly equal, the
 * shortest is drawn: a covered millimetre costs as much as 100 mm of length. */
static void put_leaders(FigurePage *page, const FigureBox *part, const FigureBox *inset,
                        const Shadow *shadow, double width_mm, FigureColor ink)
{
    enum { CORNERS = 4, ALL = CORNERS * CORNERS };
    FigurePoint from[CORNERS], to[CORNERS];
    Leader all[ALL];
    double least = HUGE_VAL;
    int best[2] = {-1, -1};
    corners_of(part, from);
    corners_of(inset, to);
    for (int i = 0; i < ALL; i++)
        all[i] = make_leader(from[i / CORNERS], to[i % CORNERS], part, inset, shadow);
    for (int i = 0; i < ALL; i++)
        for (int k = i + 1; k < ALL; k++) {
            const Leader *a = &all[i], *b = &all[k];
            const double cost = 100 * (a->covered_mm + b->covered_mm) + a->length_mm + b->length_mm;
            if (!a->possible || !b->possible || i / CORNERS == k / CORNERS ||
                i % CORNERS == k % CORNERS || lines_cross(a->at, b->at) || cost >= least)
                continue;
            least = cost;
            best[0] = i;
            best[1] = k;
        }
    for (int k = 0; k < 2 && best[0] >= 0; k++)
        put_leader(page, &all[best[k]], shadow, width_mm, ink);
}

/* Draws a frame around a box. */
static void put_frame(FigurePage *page, const FigureBox *box, double width_mm, FigureColor ink)
{
    FigurePoint corner[4];
    corners_of(box, corner);
    figure_add_line(page, corner, 4, true, width_mm, ink);
}

static Status put_inset(Figure *figure, const Section *section, size_t of, const PanelInset *inset,
                        Err *err)
{
    const InsetOptions *options = section->own.options;
    const Panel *panel = &figure->panels[of];
    const PanelRect *rect = &figure->rects[of];
    FigurePage *page = &figure->sheet.page;
    const double pixel = MM_PER_INCH / page->dpi, line_mm = 0.18;
    const FigureBox box = figure_panel_box(figure, of);
    const double width = box.right - box.left, height = box.bottom - box.top;
    int left = rect->left + (int)lround(options->place.x * rect->width) - inset->pixels[0] / 2;
    int top = rect->top + (int)lround(options->place.y * rect->height) - inset->pixels[1] / 2;
    if (left < 0 || top < 0 || left + inset->pixels[0] > figure_pixels(page, page->width_mm) ||
        top + inset->pixels[1] > figure_pixels(page, page->height_mm))
        return err_set(err, STATUS_USAGE, "[inset %s] extends beyond the page", section->name);
    const FigureBox shown = {left * pixel, top * pixel, (left + inset->pixels[0]) * pixel,
                             (top + inset->pixels[1]) * pixel};
    if (panel->in_lines) { /* a box of paper covers the lines of the panel */
        figure_add_box(page, shown, page->background);
        figure_add_strokes(page, &inset->strokes, (FigurePoint){shown.left, shown.top},
                           figure->ink);
    } else {
        figure_add_picture(page, &inset->picture, left, top);
    }
    FigureBox part = panel_part(inset, &panel->scene.view.camera);
    part = (FigureBox){box.left + part.left * width, box.top + part.top * height,
                       box.left + part.right * width, box.top + part.bottom * height};
    FigureColor ink = annotation_text_color(panel->scene.view.background);
    put_frame(page, &part, line_mm, ink);
    put_frame(page, &shown, line_mm, ink);
    if (options->leaders) {
        Shadow shadow;
        TRY(cast_shadow(&panel->scene, box, &shadow, err));
        put_leaders(page, &part, &shown, &shadow, line_mm, ink);
        free(shadow.covered);
    }
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
        if (section->kind != SECTION_INSET || find_panel(&figure->plan, inset->of) != of)
            continue;
        TRY(put_inset(figure, section, of, &panel->insets[k++], err));
    }
    return STATUS_OK;
}
