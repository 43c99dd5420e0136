/* Draws effects over the samples of a picture: outlines, halos (gaps in vessels that pass behind
 * others) and graded backgrounds. It works on the planes of depth, normal and segment id.
 *
 * Edges are found first. A sample of a vessel has an edge if a neighbour shows the background, or
 * another vessel that is deeper by some multiple of the first vessel's radius [scene/effects.h]. A
 * vessel at about the same depth is joined to the first one, and no line divides them. Then the
 * lines and gaps of each row of samples are collected from all edges near it. A line is drawn on
 * samples at about the depth of the edge, which belong to the same wall, and a gap on samples that
 * are deeper. A sample takes the maximum over all edges, so the order of edges does not matter.
 * Widths are distances from the edge itself, which is half a sample beyond the sample that has it.
 * The fraction of a sample that a line covers is the weight of the line's color.
 *
 * A line lies inside its vessel, so that a vessel is as wide with a line as without. Source of
 * lines: T. Saito and T. Takahashi: Comprehensible rendering of 3-D shapes, SIGGRAPH 1990, 197-206;
 * of gaps: A. Appel et al.: The haloed line effect for hidden line elimination, SIGGRAPH 1979,
 * 151-157. */
#include "render/effect/effect.h"

#include <math.h>
#include <stdlib.h>

/* Samples that are nearer to the viewer than the edge by more than this number of radii get no
 * line: they belong to another vessel. The wall that ends at the edge bulges towards the viewer by
 * one radius in a vessel across the view, and by more in one that leads towards the viewer. A
 * smaller value breaks the lines of such vessels; a larger one draws lines on vessels in front. */
static const double wall_radii = 3;

/* The edge at a sample. Zeroed, the sample has none. */
typedef struct EffectEdge {
    float line, gap; /* how far a line and a gap reach from the sample, in samples; 0: neither */
    float radius_mm; /* of the vessel that ends at the edge */
} EffectEdge;

/* What draw_row works with. All arrays are owned. */
typedef struct EffectEdges {
    const EffectSamples *samples;
    EffectEdge *edges; /* per sample */
    float *cover;      /* per worker two rows: the fraction of each sample that lines cover, and
                        * that gaps cover */
    int reach;         /* effects_reach() */
} EffectEdges;

/* ---- radii ----------------------------------------------------------------------------------- */

static int by_id(const void *a, const void *b)
{
    const IdRadius *x = a, *y = b;
    return x->id != y->id ? (x->id > y->id) - (x->id < y->id)
                          : (x->radius_mm < y->radius_mm) - (x->radius_mm > y->radius_mm);
}

Status radiustable_make(const Geometry *geometry, RadiusTable *table, Err *err)
{
    RadiusTable made = {0};
    TRY(mem_calloc(&made.rows, geometry->n_primitives + geometry->n_segments, sizeof *made.rows,
                   "radii", err));
    for (size_t i = 0; i < geometry->n_primitives; i++)
        made.rows[made.n++] = (IdRadius){geometry->ids[geometry->primitives[i].segment],
                                         (float)geometry->primitives[i].radius_mm};
    for (size_t i = 0; i < geometry->n_segments; i++)
        made.rows[made.n++] = (IdRadius){geometry->ids[geometry->segments[i].segment],
                                         (float)geometry->segments[i].radius_mm};
    qsort(made.rows, made.n, sizeof *made.rows, by_id);
    size_t kept = 0;
    for (size_t i = 0; i < made.n; i++)
        if (i == 0 || made.rows[i].id != made.rows[i - 1].id)
            made.rows[kept++] = made.rows[i];
    made.n = kept;
    *table = made;
    return STATUS_OK;
}

void radiustable_release(RadiusTable *table)
{
    free(table->rows);
    *table = (RadiusTable){0};
}

/* Returns the radius of a vessel, mm; 0 if the id is not in the table. */
static double find_radius(const RadiusTable *table, uint32_t id)
{
    const size_t row = sorted_find_row(table->rows, table->n, sizeof *table->rows, id);
    return row < table->n ? (double)table->rows[row].radius_mm : 0;
}

/* ---- edges ----------------------------------------------------------------------------------- */

int effects_reach(const Effects *effects, int side)
{
    return (int)ceil(fmax(effects->outline.width_px, effects->halo.width_px) * side) + 1;
}

/* Returns the cosine of the angle between two unit normals. */
static double cosine_of(const float *a, const float *b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

/* Returns true if the vessel at sample `at` has an edge towards the sample `beside`: that shows the
 * background, or is deeper by more than `deeper` radii. */
static bool has_edge(const EffectSamples *samples, size_t at, size_t beside, double radius_mm,
                     double deeper)
{
    const Frame *frame = samples->frame;
    double jump = (double)frame->depth.values[beside] - (double)frame->depth.values[at];
    return !frame->id.ids[beside] || jump > deeper * radius_mm;
}

/* Returns true if two vessels meet at an angle between the two samples, such that a line divides
 * them even at equal depth. */
static bool is_crease(const EffectSamples *samples, size_t at, size_t beside)
{
    const float *normals = samples->frame->normal.values;
    return normals && samples->frame->id.ids[beside] &&
           cosine_of(normals + 3 * at, normals + 3 * beside) <
               samples->view->effects.outline.crease_cosine;
}

/* Stores the edge of sample `at` if there is one towards one of its n neighbours `beside` that show
 * another segment. */
static void mark_edge(EffectEdges *edges, size_t at, const size_t *beside, int n)
{
    const EffectSamples *samples = edges->samples;
    const Effects *effects = &samples->view->effects;
    const Frame *frame = samples->frame;
    const Camera *camera = &samples->view->camera;
    double radius_mm = find_radius(samples->radii, frame->id.ids[at]);
    double sample_mm = vec3_length(camera->up) / camera->height;
    if (camera->projection == PROJECTION_PERSPECTIVE)
        sample_mm *= (double)frame->depth.values[at];
    double wide = radius_mm / sample_mm;
    double line = fmin(effects->outline.width_px * samples->side, effects->outline.radii * wide);
    double gap = fmin(effects->halo.width_px * samples->side, effects->halo.radii * wide);
    EffectEdge *edge = &edges->edges[at];
    edge->radius_mm = (float)radius_mm;
    for (int i = 0; i < n; i++) {
        if (frame->id.ids[beside[i]] == frame->id.ids[at])
            continue;
        if (has_edge(samples, at, beside[i], radius_mm, effects->outline.deeper) ||
            is_crease(samples, at, beside[i]))
            edge->line = (float)line;
        if (has_edge(samples, at, beside[i], radius_mm, effects->halo.deeper))
            edge->gap = (float)gap;
    }
}

static void find_in_row(size_t row, int worker, void *context)
{
    (void)worker;
    EffectEdges *edges = context;
    const uint32_t *ids = edges->samples->frame->id.ids;
    size_t width = (size_t)edges->samples->view->camera.width;
    size_t rows = (size_t)edges->samples->band.rows;
    for (size_t x = 0; x < width; x++) {
        size_t at = row * width + x, beside[4];
        int n = 0;
        if (!ids[at])
            continue;
        if (x > 0)
            beside[n++] = at - 1;
        if (x + 1 < width)
            beside[n++] = at + 1;
        if (row > 0)
            beside[n++] = at - width;
        if (row + 1 < rows)
            beside[n++] = at + width;
        bool inside = true;
        for (int i = 0; i < n; i++)
            inside &= ids[beside[i]] == ids[at];
        if (!inside)
            mark_edge(edges, at, beside, n);
    }
}

/* ---- lines and gaps -------------------------------------------------------------------------- */

static float raised(float cover, double by)
{
    return fmaxf(cover, (float)fmin(by, 1));
}

/* Draws the line and the gap of an edge into the coverages of a row that is `down` rows from it. */
static void spread_edge(const EffectEdges *edges, size_t at, int column, size_t row, int down,
                        float *line, float *gap)
{
    const EffectEdge edge = edges->edges[at];
    const EffectSamples *samples = edges->samples;
    const float *depths = samples->frame->depth.values;
    int width = samples->view->camera.width;
    double reach = fmax((double)edge.line, (double)edge.gap + 1);
    if (abs(down) > reach)
        return;
    int half = (int)sqrt(reach * reach - (double)down * down);
    double depth = (double)depths[at], radius = (double)edge.radius_mm;
    double nearest = depth - wall_radii * radius;
    double farthest = depth + samples->view->effects.outline.deeper / 2 * radius;
    double behind = depth + samples->view->effects.halo.deeper * radius;
    int first = column > half ? column - half : 0;
    int last = column + half < width - 1 ? column + half : width - 1;
    for (int x = first; x <= last; x++) {
        double here = (double)depths[row * (size_t)width + (size_t)x];
        double distance = elementary_hypot(x - column, down);
        if (here >= nearest && here <= farthest)
            line[x] = raised(line[x], (double)edge.line - distance);
        else if (here > behind && isfinite(here) && edge.gap > 0)
            gap[x] = raised(gap[x], (double)edge.gap + 1 - distance);
    }
}

/* Computes the fractions of the samples of a row that lines and gaps cover. */
static void cover_row(const EffectEdges *edges, size_t row, float *line, float *gap)
{
    const EffectSamples *samples = edges->samples;
    int width = samples->view->camera.width, rows = samples->band.rows, at = (int)row;
    for (int x = 0; x < width; x++)
        line[x] = gap[x] = 0;
    for (int y = at - edges->reach; y <= at + edges->reach; y++) {
        if (y < 0 || y >= rows)
            continue;
        for (int x = 0; x < width; x++) {
            size_t other = (size_t)y * (size_t)width + (size_t)x;
            if (edges->edges[other].line > 0 || edges->edges[other].gap > 0)
                spread_edge(edges, other, x, row, at - y, line, gap);
        }
    }
}

/* ---- colors --------------------------------------------------------------------------------- */

/* Returns the background's color at a sample. */
static Rgb paper_at(const EffectSamples *samples, size_t x, size_t row)
{
    const Grade *grade = &samples->view->effects.grade;
    const Camera *camera = &samples->view->camera;
    const double y = (double)row + samples->band.first + 0.5;
    return grade->present ? grade_at(grade, (double)x + 0.5, y, camera->width, camera->height)
                          : samples->view->background;
}

/* Returns a channel of a sample of the background in which `center`, its color in the middle of the
 * picture, is replaced by `paper`. `dither` is in 8-bit codes of sRGB, as a fraction of 1. */
static float graded(float color, float paper, float center, float dither)
{
    const float made = center > 0 ? color * paper / center : paper;
    return fmaxf(made + dither * 2.2f * sqrtf(made), 0); /* the slope of sRGB is about 2.2 sqrt */
}

/* Returns an offset of at most half an 8-bit code of sRGB, the same for all samples of a pixel.
 * Without it, the steps between codes show as rings. Interleaved gradient noise: J. Jimenez, Next
 * generation post processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014. */
static float dither_at(const EffectSamples *samples, size_t x, size_t row)
{
    const size_t side = (size_t)samples->side;
    const double line = (double)((row + (size_t)samples->band.first) / side);
    double whole;
    const double step = modf(0.06711056 * (double)(x / side) + 0.00583715 * line, &whole);
    return (float)((modf(52.9829189 * step, &whole) - 0.5) / 255);
}

/* Gives a sample of the background, or of a ground plane, its part of the graded background. */
static void grade(const EffectSamples *samples, Rgb paper, float dither, float color[3])
{
    const Rgb center = samples->view->effects.grade.center;
    color[0] = graded(color[0], paper.r, center.r, dither);
    color[1] = graded(color[1], paper.g, center.g, dither);
    color[2] = graded(color[2], paper.b, center.b, dither);
}

/* Draws the effects over a row of samples. */
static void draw_row(size_t number, int worker, void *context)
{
    const EffectEdges *edges = context;
    const EffectSamples *samples = edges->samples;
    const Effects *effects = &samples->view->effects;
    Frame *frame = samples->frame;
    size_t width = (size_t)samples->view->camera.width;
    size_t row = number + (size_t)samples->band.above;
    float *line = edges->cover + 2 * (size_t)worker * width, *gap = line + width;
    cover_row(edges, row, line, gap);
    for (size_t x = 0; x < width; x++) {
        size_t at = row * width + x;
        float *color = frame->color.values + 3 * at;
        const Rgb paper = paper_at(samples, x, row);
        if (!frame->id.ids[at]) {
            if (effects->grade.present)
                grade(samples, paper, dither_at(samples, x, row), color);
            continue;
        }
        const double faded = fade_at(&samples->view->fade, (double)frame->depth.values[at]);
        const Rgb drawn = {color[0] + (float)faded * (paper.r - samples->view->background.r),
                           color[1] + (float)faded * (paper.g - samples->view->background.g),
                           color[2] + (float)faded * (paper.b - samples->view->background.b)};
        const Rgb outline = rgb_mixed(effects->outline.color, paper, faded);
        Rgb seen = rgb_mixed(drawn, outline, (double)line[x]);
        seen = rgb_mixed(seen, paper, (double)gap[x]);
        color[0] = seen.r;
        color[1] = seen.g;
        color[2] = seen.b;
    }
}

Status effects_draw(const EffectSamples *samples, Err *err)
{
    const Band *band = &samples->band;
    size_t width = (size_t)samples->view->camera.width, n = width * (size_t)band->rows;
    EffectEdges edges = {.samples = samples,
                         .reach = effects_reach(&samples->view->effects, samples->side)};
    Status status;
    TRY_GOTO(mem_calloc(&edges.edges, n, sizeof *edges.edges, "edges", err));
    TRY_GOTO(mem_calloc(&edges.cover, 2 * width * (size_t)samples->threads, sizeof *edges.cover,
                        "edges", err));
    threads_for((size_t)band->rows, samples->threads, find_in_row, &edges);
    threads_for((size_t)(band->rows - band->above - band->below), samples->threads, draw_row,
                &edges);
done:
    free(edges.edges);
    free(edges.cover);
    return status;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

void effects_reduce(const EffectSamples *samples, Plane *color, int row)
{
    const int side = samples->side;
    const Band *band = &samples->band;
    size_t fine = 3 * (size_t)samples->view->camera.width, width = fine / (size_t)side;
    const float *from = samples->frame->color.values + (size_t)band->above * fine;
    float *to = color->values + (size_t)row * width;
    size_t rows = (size_t)(band->rows - band->above - band->below) / (size_t)side;
    for (size_t j = 0; j < rows; j++, from += (size_t)side * fine, to += width)
        for (size_t i = 0; i < width; i++) {
            size_t first = i / 3 * 3 * (size_t)side + i % 3;
            double sum = 0;
            for (size_t y = 0; y < (size_t)side; y++)
                for (size_t x = 0; x < (size_t)side; x++)
                    sum += (double)from[y * fine + first + 3 * x];
            to[i] = (float)(sum / (side * side));
        }
}
