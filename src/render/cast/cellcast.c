/* Intersects rays with isosurfaces in boxes (cells) exactly as POV-Ray's IsoSurface object does
 * (shape/isosurf.cpp of 3.7.0.10, open, max_trace 1), with the operations in the same order.
 *
 * The surface of a cell is where its function f is 0. Within [t0, t1], the part of the ray in the
 * cell's box, R(t0, t1) searches the first point with f < 0:
 *
 *     R(a, b):  if b - a < accuracy:                          a hit at b if f(b) < 0
 *               else if f(a) + f(b) < max_gradient (b - a):    R(a, m); without a hit, R(m, b);
 *                                                              m is the middle of a and b
 *
 * If f(t0) is negative, the sign of f is inverted, so that a ray from inside finds the point where
 * it leaves. If t0 < accuracy and |f(t0)| < 4 max_gradient accuracy, the ray starts on the surface:
 * t0 becomes 5 accuracy, and the rule for the sign applies there. As a result, a shadow ray, which
 * starts up to `accuracy` inside, hits its own surface again if it runs nearly along the surface.
 *
 * POV-Ray also remembers the last cell that was tested and missed. It treats a neighbouring ray as
 * a miss of that cell, without a search, if the minimum of f along the first ray exceeds
 * max_gradient times the distance between the two rays. This cannot happen in corcast's scenes:
 * every ray tests Cell_Guard of templates/povray/isosurface.inc first and misses it, so no cell is
 * remembered from the ray before. */
#include "render/cast/boxcast.h"
#include "render/cast/povray_bound.h"

#include <float.h>
#include <stdlib.h>

/* What POV-Ray calls EPSILON, CLOSE_TOLERANCE, DEPTH_TOLERANCE and BOUND_HUGE (shape/boxes.cpp). */
static const double epsilon = 1e-10, close_tolerance = 1e-6, depth_tolerance = 1e-6,
                    bound_huge = 2e10;

/* ---- one cell -------------------------------------------------------------------------------- */

/* Cuts the interval [*t0, *t1] of a ray to the part between two planes across one axis, as
 * POV-Ray's box test does. Returns false if nothing is left. `from` and `direction` are the
 * components of the ray. An end of the interval moves only if it moves inwards by at least `slack`,
 * which POV-Ray sets for the second and third axis. */
static bool cut_axis(double from, double direction, double low, double high, double slack,
                     double *t0, double *t1)
{
    if (fabs(direction) <= epsilon)
        return from >= low && from <= high;
    double far = ((direction < 0 ? low : high) - from) / direction;
    if (far < *t0)
        return false;
    if (far <= *t1 - slack)
        *t1 = far;
    double near = ((direction < 0 ? high : low) - from) / direction;
    if (near >= *t0 + slack) {
        if (near > *t1)
            return false;
        *t0 = near;
    }
    return true;
}

/* Finds the interval of the ray in the cell's box. Returns false if the ray misses the box. */
static bool cut_box(Ray ray, const Cell *cell, double *t0, double *t1)
{
    Vec3 o = ray.origin, d = ray.direction;
    *t0 = 0;
    *t1 = bound_huge;
    return cut_axis(o.x, d.x, cell->low.x, cell->high.x, 0, t0, t1) &&
           cut_axis(o.y, d.y, cell->low.y, cell->high.y, close_tolerance, t0, t1) &&
           cut_axis(o.z, d.z, cell->low.z, cell->high.z, close_tolerance, t0, t1) &&
           *t1 >= depth_tolerance;
}

/* A search along a ray in a cell. */
typedef struct CellSearch {
    const CellTree *tree;
    const Cell *cell;
    Ray ray;
    double sign; /* 1, or -1: f is inverted */
} CellSearch;

static double value_at(const CellSearch *search, double t)
{
    return search->sign * cell_function(search->tree, search->cell, ray_at(search->ray, t));
}

/* A value f of the cell's function at the position t of the ray. */
typedef struct CellSample {
    double t, f;
} CellSample;

/* The function R of the head, on [a.t, a.t + width]. `rise` is max_gradient times the width.
 * Returns true and sets *t if there is a hit. */
static bool find_root(const CellSearch *search, CellSample a, CellSample b, double rise,
                      double width, double *t)
{
    if (width < search->cell->accuracy) {
        *t = b.t;
        return b.f < 0;
    }
    if (!(a.f + b.f - rise < 0))
        return false;
    width *= 0.5;
    rise *= 0.5;
    CellSample middle = {a.t + width, 0};
    middle.f = value_at(search, middle.t);
    return find_root(search, a, middle, rise, width, t) ||
           find_root(search, middle, b, rise, width, t);
}

/* The cells, and the rounded ray that is tested against their bounds. */
typedef struct CellQuery {
    const CellTree *cells;
    BoundRay rounded;
} CellQuery;

/* Callback of type ItemCrossings. Returns the number of hits, 0 or 1. Sets hits[0].t, and *rank, by
 * which POV-Ray orders the cells. */
static int cell_crossings(const void *items, uint32_t index, Ray ray, Hit hits[ITEM_CROSSINGS],
                          double *rank)
{
    const CellQuery *query = items;
    const CellTree *tree = query->cells;
    const Cell *cell = &tree->cells[index];
    CellSearch search = {tree, cell, ray, 1};
    double t0, t1, accuracy = cell->accuracy;
    if (!cut_box(ray, cell, &t0, &t1) || t1 - t0 < accuracy ||
        !povray_looks_into(&query->rounded, (Box){cell->low, cell->high}, rank))
        return 0;
    /* The ray starts on the surface. */
    if (t0 < accuracy && fabs(value_at(&search, t0)) < cell->max_gradient * accuracy * 4) {
        t0 = accuracy * 5;
        if (value_at(&search, t0) < 0)
            search.sign = -1;
    }
    CellSample a = {t0, value_at(&search, t0)};
    if (a.f < 0) {
        search.sign *= -1;
        a.f *= -1;
    }
    CellSample b = {t1, value_at(&search, t1)};
    double rise = cell->max_gradient * vec3_length(ray.direction) * (t1 - t0);
    return find_root(&search, a, b, rise, t1 - t0, &hits->t);
}

/* Returns the unit normal at x by POV-Ray's forward differences, outward where f falls inwards. */
static Vec3 cell_normal(const CellTree *tree, const Cell *cell, Vec3 x)
{
    double f = cell_function(tree, cell, x), step = cell->accuracy;
    Vec3 n = {cell_function(tree, cell, vec3(x.x + step, x.y, x.z)) - f,
              cell_function(tree, cell, vec3(x.x, x.y + step, x.z)) - f,
              cell_function(tree, cell, vec3(x.x, x.y, x.z + step)) - f};
    return n.x == 0 && n.y == 0 && n.z == 0 ? vec3(1, 0, 0) : vec3_normalized(n);
}

/* ---- all cells ------------------------------------------------------------------------------- */

static Box cell_box(const RayIndex *index, size_t i)
{
    return (Box){index->cells.cells[i].low, index->cells.cells[i].high};
}

static Status build(RayIndex *index, const CellParams *params, Err *err)
{
    TRY(celltree_build(index->geometry, params, &index->cells, err));
    return rayindex_build_boxes(index, index->cells.n_cells, cell_box, err);
}

/* If two cells are hit at the same t, the hit belongs to the cell that POV-Ray intersects first. If
 * both boxes begin at the same t, the cell with the lower index wins; the shifts of the cells
 * [field/celltree.c] avoid this case. */
static bool first_cell(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit)
{
    (void)workspace;
    const CellQuery query = {&index->cells, bound_ray(part->ray)};
    Hit nearest;
    if (!boxcast_first(&index->boxes, part, 0, cell_crossings, &query, &nearest, &hit->cell))
        return false;
    const Cell *cell = &index->cells.cells[hit->cell];
    const Vec3 x = ray_at(part->ray, nearest.t);
    hit->t = nearest.t;
    hit->normal = cell_normal(&index->cells, cell, x);
    hit->index = cell_largest_term(&index->cells, cell, x);
    return true;
}

static bool any_cell(const RayIndex *index, void *workspace, const RayPart *part)
{
    (void)workspace;
    const CellQuery query = {&index->cells, bound_ray(part->ray)};
    return boxcast_any(&index->boxes, part, 0, cell_crossings, &query);
}

const RaySearch cell_search = {
    .nearest_mm = NEAREST_VISIBLE_MM, .build = build, .first = first_cell, .any = any_cell};
