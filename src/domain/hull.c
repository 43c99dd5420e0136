/* The domain around a tree (its hull): the union of the tree's tubes, each widened by a distance,
 * the reach.
 *
 * A bounding volume hierarchy finds the few tubes near a point. A grid knows of most of its cells
 * that they are wholly inside or wholly outside. A point or segment in cells that are inside needs
 * no test of tubes. Random points are drawn from the cells that are not outside, which is efficient
 * for a hull that is thin relative to its bounds.
 *
 * A segment is inside if tubes together cover it. A tube is convex, so it covers one interval of
 * the segment [interval_in_tube]. The covered part is extended from the segment's start: of the
 * tubes that contain its end, the one that reaches furthest extends it. */
#include "domain/hull.h"

#include "domain/kinds.h"
#include <stdlib.h>

/* Number of grid cells along the reach, and the maximum number of cells. More cells per reach
 * decide more points without tubes, but cost memory: 5 bytes per cell, 20 MB at most. The results
 * of tests do not depend on the grid; random points do. */
static const double cells_per_reach = 4, most_cells = 1 << 22;
/* Maximum number of cells along each axis that is_deep examines, at most 27 together. Longer
 * segments are rarely in inside cells only, and are tested against the tubes at once. */
enum { FEW_CELLS = 3 };

/* Returns the squared distance between a point and the axis of a tube, mm^2. */
static double tube_distance2(const DomainTube *tube, Vec3 point)
{
    return vec3_distance2_along(vec3_sub(point, tube->a), vec3_sub(tube->b, tube->a));
}

static Box tube_box(const DomainTube *tube)
{
    return box_with_ball(box_with_ball(box_empty(), tube->a, tube->radius), tube->b, tube->radius);
}

/* Returns true if the point is within the tolerance of a tube. */
static bool is_near(const Hull *hull, Vec3 point, double tolerance_mm)
{
    uint32_t i;
    Box around = box_with_ball(box_empty(), point, tolerance_mm);
    for (BoxWalk walk = boxwalk_box(&hull->tree, around); boxwalk_next(&walk, &i);) {
        double reach = hull->tube[i].radius + tolerance_mm;
        if (tube_distance2(&hull->tube[i], point) <= reach * reach)
            return true;
    }
    return false;
}

/* Finds the cell of a point. Returns false if the point is outside the grid. */
static bool find_cell(const Hull *hull, Vec3 point, int cell[3])
{
    for (int axis = 0; axis < 3; axis++) {
        double at = (vec3_component(point, axis) - vec3_component(hull->low, axis)) / hull->cell_mm;
        if (!(at >= 0 && at < hull->count[axis]))
            return false;
        cell[axis] = (int)at;
    }
    return true;
}

/* Returns the index of a cell. index_of(hull, 0, 0, count[2]) is the number of cells. */
static size_t index_of(const Hull *hull, int x, int y, int z)
{
    return ((size_t)z * (size_t)hull->count[1] + (size_t)y) * (size_t)hull->count[0] + (size_t)x;
}

/* Returns the position of a cell along each axis, counted in cells. */
static Vec3 cell_at(const Hull *hull, size_t index)
{
    size_t x = index % (size_t)hull->count[0], rest = index / (size_t)hull->count[0];
    size_t y = rest % (size_t)hull->count[1], z = rest / (size_t)hull->count[1];
    return vec3((double)x, (double)y, (double)z);
}

/* Tests whether a point is inside [DomainOps]. The grid answers for cells that are fully inside or
 * outside; only in cells at the boundary are distances from tubes computed. */
static bool hull_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    const Hull *hull = domain->hull;
    int cell[3];
    if (!find_cell(hull, point, cell))
        return tolerance_mm > 0 && is_near(hull, point, tolerance_mm);
    HullCell here = hull->cell[index_of(hull, cell[0], cell[1], cell[2])];
    if (here == HULL_INSIDE || (here == HULL_OUTSIDE && tolerance_mm == 0))
        return here == HULL_INSIDE;
    return is_near(hull, point, tolerance_mm);
}

/* Returns true if all cells of the segment's bounding box are inside. Also returns false if there
 * are many cells. */
static bool is_deep(const Hull *hull, Vec3 a, Vec3 b)
{
    int from[3], to[3];
    if (!find_cell(hull, a, from) || !find_cell(hull, b, to))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        int low = from[axis] < to[axis] ? from[axis] : to[axis];
        to[axis] += from[axis] - low;
        from[axis] = low;
        if (to[axis] - low >= FEW_CELLS)
            return false;
    }
    for (int z = from[2]; z <= to[2]; z++)
        for (int y = from[1]; y <= to[1]; y++)
            for (int x = from[0]; x <= to[0]; x++)
                if (hull->cell[index_of(hull, x, y, z)] != HULL_INSIDE)
                    return false;
    return true;
}

/* Extends the interval [out[0], out[1]] by the t at which the line a + t d is within `radius` of
 * the point c. */
static void add_ball(Vec3 a, Vec3 d, Vec3 c, double radius, double out[2])
{
    Vec3 from = vec3_sub(a, c);
    double dd = vec3_dot(d, d), half = vec3_dot(from, d) / dd;
    double root = half * half - (vec3_dot(from, from) - radius * radius) / dd;
    if (root < 0)
        return;
    out[0] = fmin(out[0], -half - sqrt(root));
    out[1] = fmax(out[1], -half + sqrt(root));
}

/* Extends the interval by the t at which the line a + t d is in the cylinder around the tube's
 * axis, between the two ends of the axis. */
static void add_cylinder(Vec3 a, Vec3 d, const DomainTube *tube, double radius, double out[2])
{
    Vec3 axis = vec3_sub(tube->b, tube->a), from = vec3_sub(a, tube->a);
    double length2 = vec3_dot(axis, axis);
    double start = vec3_dot(from, axis) / length2, rise = vec3_dot(d, axis) / length2;
    Vec3 across = vec3_add_scaled(from, axis, -start), drift = vec3_add_scaled(d, axis, -rise);
    double dd = vec3_dot(drift, drift), low = -INFINITY, high = INFINITY;
    if (dd > 0) {
        double half = vec3_dot(across, drift) / dd;
        double root = half * half - (vec3_dot(across, across) - radius * radius) / dd;
        if (root < 0)
            return;
        low = -half - sqrt(root);
        high = -half + sqrt(root);
    } else if (vec3_dot(across, across) > radius * radius) {
        return;
    }
    if (rise != 0) {
        low = fmax(low, fmin(-start / rise, (1 - start) / rise));
        high = fmin(high, fmax(-start / rise, (1 - start) / rise));
    } else if (start < 0 || start > 1) {
        return;
    }
    if (low > high)
        return;
    out[0] = fmin(out[0], low);
    out[1] = fmax(out[1], high);
}

/* Sets `out` to the interval of t in which the line a + t d is in the tube; to INFINITY and
 * -INFINITY if the line misses the tube. */
static void interval_in_tube(Vec3 a, Vec3 d, const DomainTube *tube, double out[2])
{
    out[0] = INFINITY;
    out[1] = -INFINITY;
    add_ball(a, d, tube->a, tube->radius, out);
    add_ball(a, d, tube->b, tube->radius, out);
    if (vec3_distance(tube->a, tube->b) > 0)
        add_cylinder(a, d, tube, tube->radius, out);
}

/* Tests whether a segment is inside [DomainOps]: whether tubes cover it from end to end. Each pass
 * over the tubes extends the covered part from a; it ends when a pass adds nothing. */
static bool hull_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    const Hull *hull = domain->hull;
    if (is_deep(hull, a, b))
        return true;
    Vec3 d = vec3_sub(b, a);
    double slack = domain->slack_mm / vec3_length(d), covered = 0;
    for (double before = -1; covered + slack < 1 && covered > before;) {
        uint32_t i;
        before = covered;
        for (BoxWalk walk = boxwalk_segment(&hull->tree, a, b); boxwalk_next(&walk, &i);) {
            double interval[2];
            interval_in_tube(a, d, &hull->tube[i], interval);
            if (interval[0] <= covered + slack)
                covered = fmax(covered, interval[1]);
        }
    }
    return covered + slack >= 1;
}

/* Returns a random point of a cell that is not outside [DomainOps]. The caller rejects points that
 * are not inside. */
static Vec3 hull_sample(const Domain *domain, Random *random)
{
    const Hull *hull = domain->hull;
    size_t index = hull->occupied[(size_t)(random_uniform(random) * (double)hull->n_occupied)];
    Vec3 point = hull->low, cell = cell_at(hull, index);
    point.x += (cell.x + random_uniform(random)) * hull->cell_mm;
    point.y += (cell.y + random_uniform(random)) * hull->cell_mm;
    if (domain->dimension == 3)
        point.z += (cell.z + random_uniform(random)) * hull->cell_mm;
    return point;
}

/* ---- building -------------------------------------------------------------------------------- */

/* Copies the tubes, widened by the reach, and builds their hierarchy. */
static Status set_tubes(Domain *domain, const DomainTube *tubes, size_t n, Err *err)
{
    Hull *hull = domain->hull;
    Box *boxes = NULL;
    TRY(mem_calloc(&hull->tube, n, sizeof *hull->tube, "tubes", err));
    TRY(mem_calloc(&boxes, n, sizeof *boxes, "boxes", err));
    domain->dimension = 2;
    domain->bounds = box_empty();
    hull->n = n;
    for (size_t i = 0; i < n; i++) {
        DomainTube *tube = &hull->tube[i];
        *tube = tubes[i];
        tube->radius += domain->parameter[0];
        if (tube->a.z != 0 || tube->b.z != 0)
            domain->dimension = 3;
        boxes[i] = tube_box(tube);
        domain->bounds = box_union(domain->bounds, boxes[i]);
    }
    if (domain->dimension == 2)
        domain->bounds.low.z = domain->bounds.high.z = 0;
    Status status = boxtree_build(boxes, n, &hull->tree, err);
    free(boxes);
    return status;
}

/* Chooses the size of the cells and allocates the grid. Cells are enlarged until there are at most
 * most_cells. */
static Status make_grid(Domain *domain, Err *err)
{
    Hull *hull = domain->hull;
    Vec3 size = vec3_sub(domain->bounds.high, domain->bounds.low);
    bool flat = domain->dimension == 2;
    double edge = domain->parameter[0] / cells_per_reach;
    while ((size.x / edge + 1) * (size.y / edge + 1) * (flat ? 1 : size.z / edge + 1) > most_cells)
        edge *= 1.25;
    hull->cell_mm = edge;
    hull->low = domain->bounds.low;
    for (int axis = 0; axis < 3; axis++)
        hull->count[axis] = (int)(vec3_component(size, axis) / edge) + 1;
    size_t cells = index_of(hull, 0, 0, hull->count[2]);
    return mem_calloc(&hull->cell, cells, sizeof *hull->cell, "cells", err);
}

/* Returns the centre of a cell; its z is the lowest z if the domain is flat. */
static Vec3 middle_of(const Hull *hull, int x, int y, int z, bool flat)
{
    Vec3 half = vec3(x + 0.5, y + 0.5, flat ? 0 : z + 0.5);
    return vec3_add_scaled(hull->low, half, hull->cell_mm);
}

/* Marks the cells that a tube may meet as boundary, and those that it contains as inside. `half` is
 * half the diagonal of a cell: the distance of its middle decides. */
static void mark_cells(Hull *hull, const DomainTube *tube, bool flat)
{
    double half = hull->cell_mm / 2 * sqrt(flat ? 2 : 3);
    double outer = tube->radius + half, inner = fmax(tube->radius - half, 0);
    Box box = tube_box(tube);
    int low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        double from = vec3_component(box.low, axis) - vec3_component(hull->low, axis);
        double to = vec3_component(box.high, axis) - vec3_component(hull->low, axis);
        low[axis] = flat && axis == 2 ? 0 : (int)fmax(0, floor(from / hull->cell_mm) - 1);
        high[axis] =
            flat && axis == 2 ? 0 : (int)fmin(hull->count[axis] - 1, floor(to / hull->cell_mm) + 1);
    }
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int x = low[0]; x <= high[0]; x++) {
                uint8_t *cell = &hull->cell[index_of(hull, x, y, z)];
                double apart2 = tube_distance2(tube, middle_of(hull, x, y, z, flat));
                if (apart2 < inner * inner)
                    *cell = HULL_INSIDE;
                else if (apart2 <= outer * outer && *cell == HULL_OUTSIDE)
                    *cell = HULL_BOUNDARY;
            }
}

/* Lists the cells that are not outside, and estimates the volume from STEPS points per axis in each
 * of them. The volume decides the density of terminals and is printed; with 2, a boundary cell
 * counts in eighths, and the errors of many cells cancel. */
static Status list_cells(Domain *domain, Err *err)
{
    enum { STEPS = 2 };
    Hull *hull = domain->hull;
    bool flat = domain->dimension == 2;
    size_t cells = index_of(hull, 0, 0, hull->count[2]);
    TRY(mem_calloc(&hull->occupied, cells, sizeof *hull->occupied, "cells", err));
    size_t inside = 0, of = 0;
    for (size_t i = 0; i < cells; i++) {
        if (hull->cell[i] == HULL_OUTSIDE)
            continue;
        hull->occupied[hull->n_occupied++] = (uint32_t)i;
        const Vec3 corner = cell_at(hull, i);
        for (int k = 0; k < (flat ? STEPS * STEPS : STEPS * STEPS * STEPS); k++, of++) {
            Vec3 at = vec3(corner.x + (k % STEPS + 0.5) / STEPS,
                           corner.y + (k / STEPS % STEPS + 0.5) / STEPS,
                           flat ? 0 : corner.z + (k / STEPS / STEPS + 0.5) / STEPS);
            inside += hull->cell[i] == HULL_INSIDE ||
                      is_near(hull, vec3_add_scaled(hull->low, at, hull->cell_mm), 0);
        }
    }
    double cell = elementary_pow(hull->cell_mm, domain->dimension);
    domain->volume = cell * (double)hull->n_occupied * (double)inside / (double)of;
    return STATUS_OK;
}

Status hull_build(Domain *domain, const DomainTube *tubes, size_t n, Err *err)
{
    double mm = domain->parameter[0];
    if (!(mm >= DOMAIN_MIN_MM && mm <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE,
                       "`domain` hull:%g: the reach must be a number of mm from %g to %g", mm,
                       DOMAIN_MIN_MM, DOMAIN_MAX_MM);
    TRY(mem_calloc(&domain->hull, 1, sizeof *domain->hull, "hulls", err));
    TRY(set_tubes(domain, tubes, n, err));
    TRY(make_grid(domain, err));
    for (size_t i = 0; i < n; i++)
        mark_cells(domain->hull, &domain->hull->tube[i], domain->dimension == 2);
    domain->inlet = tubes[0].a;
    return list_cells(domain, err);
}

static void hull_release(Domain *domain)
{
    if (!domain->hull)
        return;
    boxtree_release(&domain->hull->tree);
    free(domain->hull->tube);
    free(domain->hull->cell);
    free(domain->hull->occupied);
    free(domain->hull);
}

/* Refuses a hull that is named as text: hulls are made of a tree [domain_of_tubes]. */
static Status hull_load(Domain *domain, const char *values, Err *err)
{
    (void)domain;
    (void)values;
    return err_set(err, STATUS_USAGE, "needs a tree, which is not available here");
}

const DomainOps hull_ops = {
    .shape = {"hull", "[FILE,]MM",
              "everything within MM mm of the tree of --from, or of the tree in a file"},
    .load = hull_load,
    .inside = hull_inside,
    .holds_segment = hull_holds_segment,
    .sample = hull_sample,
    .release = hull_release,
};
