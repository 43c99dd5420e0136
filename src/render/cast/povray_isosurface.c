/* POV-Ray's IsoSurface object (shape/isosurf.cpp of 3.7.0.10), open and with max_trace 1, in its
 * own order of operations. On the part [t0, t1] of the ray in the box:
 *
 *   R(a, b):  if b - a < accuracy:                           a hit at b if f(b) < 0
 *             else if f(a) + f(b) < max_gradient (b - a):     R(a, m), then R(m, b), m the middle
 *
 * with f's sign turned when it is negative at t0, so that a ray from within finds its way out. A
 * ray that starts within an accuracy of the box and has |f| < 4 max_gradient accuracy there starts
 * on the surface: it is moved on by five accuracies, and f's sign is turned if it is negative
 * there. So a shadow ray, which starts up to an accuracy inside, sees its own surface again where
 * it runs nearly along it.
 *
 * POV-Ray also remembers the last cell that a ray missed, and takes a near ray for a miss of the
 * same cell if the least f it saw exceeds max_gradient times the distance of the two. Scenes of
 * ours do not let it: the last cell missed is always Cell_Guard of templates/povray/isosurface.inc.
 */
#include "render/cast/povray_isosurface.h"

#include "render/cast/povray_bound.h"

#include <float.h>
#include <stdlib.h>

/* What POV-Ray calls EPSILON, CLOSE_TOLERANCE, DEPTH_TOLERANCE and BOUND_HUGE (shape/boxes.cpp). */
static const double flat = 1e-10, close_by = 1e-6, behind = 1e-6, endless = 2e10;

struct PovrayIsosurface {
    CellTree tree;
    BoxTree boxes; /* of its cells */
};

/* ---- one cell -------------------------------------------------------------------------------- */

/* One axis of POV-Ray's box test. Beyond the first axis, `slack` keeps an end of the interval where
 * it is unless the new one is nearer by more. */
static bool cut_axis(double from, double along, double low, double high, double slack, double *t0,
                     double *t1)
{
    if (fabs(along) <= flat)
        return from >= low && from <= high;
    double far = ((along < 0 ? low : high) - from) / along;
    if (far < *t0)
        return false;
    if (far <= *t1 - slack)
        *t1 = far;
    double near = ((along < 0 ? high : low) - from) / along;
    if (near >= *t0 + slack) {
        if (near > *t1)
            return false;
        *t0 = near;
    }
    return true;
}

static bool cut_box(Ray ray, const Cell *cell, double *t0, double *t1)
{
    Vec3 o = ray.origin, d = ray.direction;
    *t0 = 0;
    *t1 = endless;
    return cut_axis(o.x, d.x, cell->low.x, cell->high.x, 0, t0, t1) &&
           cut_axis(o.y, d.y, cell->low.y, cell->high.y, close_by, t0, t1) &&
           cut_axis(o.z, d.z, cell->low.z, cell->high.z, close_by, t0, t1) && *t1 >= behind;
}

/* A search along a ray in a cell. */
typedef struct CellSearch {
    const CellTree *tree;
    const Cell *cell;
    Ray ray;
    double sign;
} CellSearch;

static double value_at(const CellSearch *search, double t)
{
    return search->sign * cell_function(search->tree, search->cell, ray_at(search->ray, t));
}

typedef struct Place {
    double t, f;
} Place;

/* R of above; `rise` is max_gradient times the width. */
static bool find_root(const CellSearch *search, Place a, Place b, double rise, double width,
                      double *t)
{
    if (width < search->cell->accuracy) {
        *t = b.t;
        return b.f < 0;
    }
    if (!(a.f + b.f - rise < 0))
        return false;
    width *= 0.5;
    rise *= 0.5;
    Place middle = {a.t + width, 0};
    middle.f = value_at(search, middle.t);
    return find_root(search, a, middle, rise, width, t) ||
           find_root(search, middle, b, rise, width, t);
}

/* The hit of a cell, at *t, and the order in which POV-Ray looks into it. */
static bool hit_cell(const CellTree *tree, const Cell *cell, Ray ray, const BoundRay *rounded,
                     double *t, double *order)
{
    CellSearch search = {tree, cell, ray, 1};
    double t0, t1, accuracy = cell->accuracy;
    if (!cut_box(ray, cell, &t0, &t1) || t1 - t0 < accuracy ||
        !povray_looks_into(rounded, (Box){cell->low, cell->high}, order))
        return false;
    if (t0 < accuracy && fabs(value_at(&search, t0)) < cell->max_gradient * accuracy * 4) {
        t0 = accuracy * 5;
        if (value_at(&search, t0) < 0)
            search.sign = -1;
    }
    Place a = {t0, value_at(&search, t0)};
    if (a.f < 0) {
        search.sign *= -1;
        a.f *= -1;
    }
    Place b = {t1, value_at(&search, t1)};
    double rise = cell->max_gradient * vec3_length(ray.direction) * (t1 - t0);
    return find_root(&search, a, b, rise, t1 - t0, t);
}

static Vec3 cell_normal(const CellTree *tree, const Cell *cell, Vec3 x)
{
    double f = cell_function(tree, cell, x), step = cell->accuracy;
    Vec3 n = {cell_function(tree, cell, vec3(x.x + step, x.y, x.z)) - f,
              cell_function(tree, cell, vec3(x.x, x.y + step, x.z)) - f,
              cell_function(tree, cell, vec3(x.x, x.y, x.z + step)) - f};
    return n.x == 0 && n.y == 0 && n.z == 0 ? vec3(1, 0, 0) : vec3_normalized(n);
}

/* ---- all cells ------------------------------------------------------------------------------- */

Status povray_isosurface_new(const Geometry *geometry, const CellParams *params,
                             PovrayIsosurface **out, Err *err)
{
    PovrayIsosurface *made = NULL;
    Box *boxes = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&made, 1, sizeof *made, "cells", err));
    TRY_GOTO(celltree_build(geometry, params, &made->tree, err));
    TRY_GOTO(mem_calloc(&boxes, made->tree.n_cells, sizeof *boxes, "boxes of cells", err));
    for (size_t i = 0; i < made->tree.n_cells; i++)
        boxes[i] = (Box){made->tree.cells[i].low, made->tree.cells[i].high};
    TRY_GOTO(boxtree_build(boxes, made->tree.n_cells, &made->boxes, err));
    *out = made;
    made = NULL;
done:
    free(boxes);
    povray_isosurface_free(made);
    return status;
}

void povray_isosurface_free(PovrayIsosurface *isosurface)
{
    if (!isosurface)
        return;
    celltree_release(&isosurface->tree);
    boxtree_release(&isosurface->boxes);
    free(isosurface);
}

/* The nearest hit in [t_min, t_max), or any with `any`, as *cell and *t. Where
 * two cells are hit at one place, it is the hit of the cell that POV-Ray looks into first; where
 * both boxes begin at one place, which their shifts [surface/celltree.c] avoid, of the lower
 * number. */
static bool find_hit(const PovrayIsosurface *isosurface, Ray ray, double t_min, double t_max,
                     bool any, uint32_t *cell, double *t)
{
    BoxWalk walk;
    BoundRay rounded = bound_ray(ray);
    double first = 0;
    bool found = false;
    *t = t_max;
    boxwalk_start(&walk, &isosurface->boxes, ray.origin, ray.direction, 0, !any);
    for (const BoxNode *leaf; !(any && found) && (leaf = boxwalk_leaf(&walk, *t));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            uint32_t number = isosurface->boxes.items[i];
            double at, order;
            bool hit = hit_cell(&isosurface->tree, &isosurface->tree.cells[number], ray, &rounded,
                                &at, &order);
            if (!hit || at < t_min)
                continue;
            bool sooner = order < first || (order == first && number < *cell);
            if (at < *t || (found && at == *t && sooner)) {
                found = true;
                first = order;
                *t = at;
                *cell = number;
            }
        }
    return found;
}

bool povray_isosurface_first_hit(const PovrayIsosurface *isosurface, Ray ray, double t_min,
                                 Hit *hit, uint32_t *segment, uint32_t *number)
{
    if (!find_hit(isosurface, ray, t_min, HUGE_VAL, false, number, &hit->t))
        return false;
    const Cell *cell = &isosurface->tree.cells[*number];
    Vec3 x = ray_at(ray, hit->t);
    hit->normal = cell_normal(&isosurface->tree, cell, x);
    *segment = cell_largest_term(&isosurface->tree, cell, x);
    return true;
}

double povray_isosurface_mean(const PovrayIsosurface *isosurface, uint32_t cell,
                              const FieldSegment *segments, const double *numbers, Vec3 x)
{
    return cell_mean(&isosurface->tree, &isosurface->tree.cells[cell], segments, numbers, x);
}

bool povray_isosurface_any_hit(const PovrayIsosurface *isosurface, Ray ray, double t_min,
                               double t_max)
{
    uint32_t cell;
    double t;
    return find_hit(isosurface, ray, nextafter(t_min, HUGE_VAL), t_max, true, &cell, &t);
}
