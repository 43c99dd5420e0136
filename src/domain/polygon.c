/* The domain inside a polygon of one or more closed outlines (rings).
 *
 * A point is inside if the ray from it in the direction x crosses an odd number of edges. An edge
 * includes its lower end and excludes its upper end, so that a ray through a corner counts
 * correctly. A bounding volume hierarchy of the edges makes the test O(log n), unless the ray
 * crosses many edges. */
#include "domain/polygon.h"

#include "domain/contacts.h"
#include "domain/kinds.h"
#include <stdlib.h>

#define NO_EDGE UINT32_MAX

/* Returns true if the ray from the point in the direction x crosses the edge. */
static bool crosses_ray(const Edge *edge, Vec3 point)
{
    bool up = edge->a.y <= edge->b.y;
    Vec3 low = up ? edge->a : edge->b, high = up ? edge->b : edge->a;
    return low.y <= point.y && point.y < high.y && polygon_twice_area(low, high, point) > 0;
}

/* Returns true if the ray from the point crosses an odd number of edges, not counting the
 * edge `except`. */
static bool is_odd(const Polygon *polygon, const Box *bounds, Vec3 point, uint32_t except)
{
    bool odd = false;
    uint32_t i;
    Box ray = {point, vec3(fmax(point.x, bounds->high.x), point.y, 0)};
    for (BoxWalk walk = boxwalk_box(&polygon->tree, ray); boxwalk_next(&walk, &i);)
        odd ^= i != except && crosses_ray(&polygon->edges[i], point);
    return odd;
}

/* Returns true if an edge is within `reach` of the point. */
static bool is_near(const Polygon *polygon, Vec3 point, double reach)
{
    uint32_t i;
    Box around = box_with_ball(box_empty(), point, reach);
    for (BoxWalk walk = boxwalk_box(&polygon->tree, around); boxwalk_next(&walk, &i);) {
        const Edge *edge = &polygon->edges[i];
        Vec3 to = vec3_sub(point, edge->a);
        if (vec3_distance2_along(to, vec3_sub(edge->b, edge->a)) <= reach * reach)
            return true;
    }
    return false;
}

/* Tests whether a point is inside [DomainOps]: the number of edges beyond it is odd, or one is
 * within the tolerance. */
static bool polygon_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    return is_odd(domain->polygon, &domain->own_bounds, point, NO_EDGE) ||
           (tolerance_mm > 0 && is_near(domain->polygon, point, tolerance_mm));
}

/* Adds the contact of the segment from `a` to `b` with an edge. Parallel lines make no contact; if
 * they coincide, the neighbouring edges make the contacts. */
static void find_contact(const Edge *edge, Vec3 a, Vec3 b, Contacts *contacts)
{
    Vec3 d = vec3_sub(b, a), e = vec3_sub(edge->b, edge->a), to = vec3_sub(edge->a, a);
    double determinant = d.x * e.y - d.y * e.x;
    if (determinant == 0)
        return;
    double t = (to.x * e.y - to.y * e.x) / determinant;
    double s = (to.x * d.y - to.y * d.x) / determinant;
    const double margin = CONTACT_MARGIN;
    if (t >= -margin && t <= 1 + margin && s >= -margin && s <= 1 + margin)
        contacts_add(contacts, t);
}

/* Tests whether a segment is inside [DomainOps]: finds its contacts with edges, and tests the parts
 * between them. */
static bool polygon_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    Contacts contacts = {.n = 0};
    uint32_t i;
    for (BoxWalk walk = boxwalk_segment(&domain->polygon->tree, a, b); boxwalk_next(&walk, &i);)
        find_contact(&domain->polygon->edges[i], a, b, &contacts);
    return contacts_hold_segment(&contacts, domain, a, b);
}

/* Sets the inlet: at a thousandth of the polygon's height below its top, the middle of the widest
 * interval inside the polygon. */
static Status find_inlet(Domain *domain, Err *err)
{
    const Polygon *polygon = domain->polygon;
    const Box *bounds = &domain->bounds;
    double y = bounds->high.y - 1e-3 * (bounds->high.y - bounds->low.y), widest = -1;
    double *x = NULL;
    size_t n = 0;
    TRY(mem_calloc(&x, polygon->n, sizeof *x, "crossings", err));
    for (size_t i = 0; i < polygon->n; i++) {
        Vec3 a = polygon->edges[i].a, b = polygon->edges[i].b;
        if ((a.y <= y) != (b.y <= y))
            x[n++] = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
    }
    sort_numbers(x, n);
    for (size_t i = 0; i + 1 < n; i += 2) {
        if (x[i + 1] - x[i] <= widest)
            continue;
        widest = x[i + 1] - x[i];
        domain->inlet = vec3((x[i] + x[i + 1]) / 2, y, 0);
    }
    free(x);
    return STATUS_OK;
}

/* Computes the area of the polygon, ring by ring. The signed area of a ring is positive if the ring
 * runs counter-clockwise. It is added if the inside of the polygon is to the left of the ring, and
 * subtracted otherwise. The ring's steepest edge decides this: is_odd tests a point just to the
 * right (in the direction x) of the edge's middle, which is on the left side of an edge that runs
 * down. */
static double area(const Polygon *polygon, const Box *bounds)
{
    const Edge *edges = polygon->edges;
    double sum = 0;
    for (size_t first = 0, last; first < polygon->n; first = last + 1) {
        double twice = 0;
        size_t steepest = first;
        last = first;
        for (size_t i = first; i <= last; i++) {
            twice += polygon_twice_area(edges[first].a, edges[i].a, edges[i].b);
            if (fabs(edges[i].b.y - edges[i].a.y) > fabs(edges[steepest].b.y - edges[steepest].a.y))
                steepest = i;
            if (edges[i].next > i)
                last = i + 1;
        }
        const Edge *edge = &edges[steepest];
        Vec3 middle = vec3_scale(vec3_add(edge->a, edge->b), 0.5);
        bool right_is_inside = is_odd(polygon, bounds, middle, (uint32_t)steepest);
        bool left_is_inside = right_is_inside == (edge->b.y < edge->a.y);
        sum += left_is_inside ? twice / 2 : -twice / 2;
    }
    return sum;
}

/* Reads the polygon, builds the tree of boxes of its edges, and sets bounds, area and inlet. */
static Status build(Domain *domain, Err *err)
{
    Polygon *polygon = domain->polygon;
    Box *boxes = NULL;
    TRY(polygon_read(polygon, domain->file, domain->parameter[0], err));
    TRY(mem_calloc(&boxes, polygon->n, sizeof *boxes, "boxes", err));
    domain->bounds = box_empty();
    for (size_t i = 0; i < polygon->n; i++) {
        boxes[i] = box_with_ball(box_empty(), polygon->edges[i].a, 0);
        boxes[i] = box_with_ball(boxes[i], polygon->edges[i].b, 0);
        domain->bounds = box_union(domain->bounds, boxes[i]);
    }
    Status status = boxtree_build(boxes, polygon->n, &polygon->tree, err);
    free(boxes);
    TRY(status);
    TRY(polygon_check_crossings(polygon, domain->file, err));
    domain->volume = area(polygon, &domain->bounds);
    return find_inlet(domain, err);
}

static Status polygon_load(Domain *domain, const char *values, Err *err)
{
    domain->dimension = 2;
    TRY(domain_load_file_name(domain, values, err));
    TRY(mem_calloc(&domain->polygon, 1, sizeof *domain->polygon, "polygons", err));
    return build(domain, err);
}

static void polygon_release(Domain *domain)
{
    if (!domain->polygon)
        return;
    boxtree_release(&domain->polygon->tree);
    free(domain->polygon->edges);
    free(domain->polygon);
}

const DomainOps polygon_ops = {
    .shape = {"polygon", "FILE[,MM]",
              "inside of the closed outlines in a text file, whose unit is MM mm"},
    .load = polygon_load,
    .inside = polygon_inside,
    .holds_segment = polygon_holds_segment,
    .release = polygon_release,
};
