/* Half-edge collapses, of each point into the nearest neighbour that takes it. An edge e between
 * points with normals n1 and n2 is |e . (n2 - n1)| / 8 off the surface half way, if that is an arc.
 * The link condition [T. Dey et al.: Topology preserving edge contraction, 1999] keeps the
 * topology: the two points have no other common neighbours than those of their common triangles.
 * The corners of a point are a list through `next`; the corners of triangles that are gone are
 * taken out of it when it is walked. */
#include "mesh/lattice/collapse.h"

#include <stdlib.h>

enum { MOST_NEIGHBORS = 48, MOST_SWEEPS = 4 };
#define NONE UINT32_MAX

/* Cosine of the most that a triangle may lean from the normals at its corners. */
static const double least_cosine = 0.72;
/* Least height of a new triangle over its longest side, unless it was worse before. */
static const double least_shape = 0.04;

typedef struct Work {
    Collapser *collapser;
    Patch *patch;
    double sagitta; /* of the local radius */
} Work;

/* The ring of a point: its triangles are (point, from[i], to[i]). */
typedef struct Ring {
    uint32_t from[MOST_NEIGHBORS], to[MOST_NEIGHBORS], corner[MOST_NEIGHBORS];
    int n;
} Ring;

void collapser_release(Collapser *collapser)
{
    free(collapser->next);
    free(collapser->first);
    free(collapser->stamp);
    free(collapser->renamed);
    free(collapser->settled);
    *collapser = (Collapser){0};
}

/* False when it has too many triangles to be looked at. */
static bool find_ring(const Work *work, uint32_t point, Ring *ring)
{
    const Triangle *triangles = work->patch->triangles;
    uint32_t *link = &work->collapser->first[point];
    ring->n = 0;
    while (*link != NONE) {
        uint32_t corner = *link;
        const Triangle *triangle = &triangles[corner / 3];
        if (triangle->at[0] == NONE) {
            *link = work->collapser->next[corner];
            continue;
        }
        if (ring->n == MOST_NEIGHBORS)
            return false;
        ring->from[ring->n] = triangle->at[(corner + 1) % 3];
        ring->to[ring->n] = triangle->at[(corner + 2) % 3];
        ring->corner[ring->n++] = corner;
        link = &work->collapser->next[corner];
    }
    return ring->n > 0;
}

static inline bool edge_is_near(const Work *work, uint32_t a, uint32_t b)
{
    const PatchPoint *one = &work->patch->points[a], *other = &work->patch->points[b];
    Vec3 edge = vec3_sub(other->x, one->x), turn = vec3_sub(other->normal, one->normal);
    double off = fabs(vec3_dot(edge, turn)) / 8;
    return off <= work->sagitta * one->radius_mm && off <= work->sagitta * other->radius_mm;
}

/* Twice the area over the square of the longest side. */
static double shape_of(Vec3 a, Vec3 b, Vec3 c, double twice_area)
{
    Vec3 ab = vec3_sub(b, a), bc = vec3_sub(c, b), ca = vec3_sub(a, c);
    return twice_area / fmax(vec3_dot(ab, ab), fmax(vec3_dot(bc, bc), vec3_dot(ca, ca)));
}

static double twice_area(Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* Whether the triangle (a, b, c) may take the place of (old, b, c). */
static bool triangle_is_fit(const Work *work, uint32_t a, uint32_t b, uint32_t c, uint32_t old)
{
    const PatchPoint *points = work->patch->points;
    Vec3 normal =
        vec3_cross(vec3_sub(points[b].x, points[a].x), vec3_sub(points[c].x, points[a].x));
    double area = vec3_length(normal), least = least_cosine * area;
    if (vec3_dot(normal, points[a].normal) < least || vec3_dot(normal, points[b].normal) < least ||
        vec3_dot(normal, points[c].normal) < least || !(area > 0))
        return false;
    double shape = shape_of(points[a].x, points[b].x, points[c].x, area);
    return shape >= least_shape ||
           shape > shape_of(points[old].x, points[b].x, points[c].x,
                            twice_area(points[old].x, points[b].x, points[c].x));
}

/* How many triangles have the edge from the ring's point to `other`. */
static int shared_triangles(const Ring *ring, uint32_t other)
{
    int n = 0;
    for (int i = 0; i < ring->n; i++)
        n += ring->from[i] == other || ring->to[i] == other;
    return n;
}

static void stamp_ring(const Work *work, const Ring *ring, uint32_t value)
{
    for (int i = 0; i < ring->n; i++)
        work->collapser->stamp[ring->from[i]] = work->collapser->stamp[ring->to[i]] = value;
}

/* The neighbours of the ring's point that bear the stamp. */
static int count_stamped(const Work *work, const Ring *ring, uint32_t value)
{
    int n = 0;
    for (int i = 0; i < ring->n; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t *stamp = &work->collapser->stamp[k ? ring->to[i] : ring->from[i]];
            n += *stamp == value;
            if (*stamp == value)
                *stamp = NONE;
        }
    return n;
}

static bool link_allows(const Work *work, const Ring *ring, const Ring *target_ring,
                        uint32_t target, int shared)
{
    stamp_ring(work, target_ring, target);
    return count_stamped(work, ring, target) == shared &&
           shared_triangles(target_ring, target) == 0;
}

/* Whether `point` may be moved into its neighbour `target`. */
static bool may_collapse(const Work *work, uint32_t point, const Ring *ring, uint32_t target)
{
    const PatchPoint *points = work->patch->points;
    int shared = shared_triangles(ring, target);
    bool on_rim = points[point].arm != NO_ARM;
    if (on_rim && (shared != 1 || points[target].arm != points[point].arm))
        return false;
    for (int i = 0; i < ring->n; i++)
        if (ring->to[i] != target && !edge_is_near(work, target, ring->to[i]))
            return false;
    for (int i = 0; i < ring->n && on_rim; i++)
        if (ring->from[i] != target && !edge_is_near(work, target, ring->from[i]))
            return false;
    for (int i = 0; i < ring->n; i++)
        if (ring->from[i] != target && ring->to[i] != target &&
            !triangle_is_fit(work, target, ring->from[i], ring->to[i], point))
            return false;
    Ring target_ring;
    return find_ring(work, target, &target_ring) &&
           ring->n + target_ring.n - 2 * shared <= MOST_NEIGHBORS &&
           link_allows(work, ring, &target_ring, target, shared);
}

static void collapse_edge(const Work *work, uint32_t point, const Ring *ring, uint32_t target)
{
    Collapser *collapser = work->collapser;
    for (int i = 0; i < ring->n; i++) {
        Triangle *triangle = &work->patch->triangles[ring->corner[i] / 3];
        collapser->settled[ring->from[i]] = collapser->settled[ring->to[i]] = false;
        if (ring->from[i] == target || ring->to[i] == target) {
            triangle->at[0] = NONE;
            continue;
        }
        triangle->at[ring->corner[i] % 3] = target;
        collapser->next[ring->corner[i]] = collapser->first[target];
        collapser->first[target] = ring->corner[i];
    }
    collapser->first[point] = NONE;
}

/* A neighbour and how far it is. */
typedef struct Neighbor {
    uint32_t point;
    double length2;
} Neighbor;

/* Puts a neighbour of a point among `n` others, the nearest first. */
static void insert_neighbor(const Work *work, uint32_t point, uint32_t other, Neighbor *list, int n)
{
    const PatchPoint *points = work->patch->points;
    Vec3 edge = vec3_sub(points[other].x, points[point].x);
    double length2 = vec3_dot(edge, edge);
    for (; n > 0 && list[n - 1].length2 > length2; n--)
        list[n] = list[n - 1];
    list[n] = (Neighbor){other, length2};
}

/* Moves the point into the nearest neighbour that it may be moved into. Going round it, each
 * triangle ends at another neighbour; on a rim one more is where the first begins. */
static bool try_point(const Work *work, uint32_t point)
{
    Ring ring;
    Neighbor list[MOST_NEIGHBORS + 1];
    if (!find_ring(work, point, &ring))
        return false;
    int n = 0;
    for (; n < ring.n; n++)
        insert_neighbor(work, point, ring.to[n], list, n);
    bool on_rim = work->patch->points[point].arm != NO_ARM;
    for (int i = 0; i < ring.n && on_rim; i++)
        if (shared_triangles(&ring, ring.from[i]) == 1)
            insert_neighbor(work, point, ring.from[i], list, n++);
    for (int i = 0; i < n; i++)
        if (may_collapse(work, point, &ring, list[i].point)) {
            collapse_edge(work, point, &ring, list[i].point);
            return true;
        }
    return false;
}

static Status prepare(Collapser *collapser, const Patch *patch, Err *err)
{
    size_t points = patch->n_points, corners = 3 * patch->n_triangles;
    TRY(mem_reserve(&collapser->next, &collapser->next_capacity, corners, sizeof *collapser->next,
                    "points of a junction", err));
    TRY(mem_reserve(&collapser->first, &collapser->first_capacity, points, sizeof *collapser->first,
                    "points of a junction", err));
    TRY(mem_reserve(&collapser->stamp, &collapser->stamp_capacity, points, sizeof *collapser->stamp,
                    "points of a junction", err));
    TRY(mem_reserve(&collapser->renamed, &collapser->renamed_capacity, points,
                    sizeof *collapser->renamed, "points of a junction", err));
    TRY(mem_reserve(&collapser->settled, &collapser->settled_capacity, points,
                    sizeof *collapser->settled, "points of a junction", err));
    for (size_t i = 0; i < points; i++)
        collapser->first[i] = collapser->stamp[i] = NONE;
    for (size_t i = corners; i-- > 0;) {
        uint32_t *first = &collapser->first[patch->triangles[i / 3].at[i % 3]];
        collapser->next[i] = *first;
        *first = (uint32_t)i;
    }
    return STATUS_OK;
}

Status collapse_make(Collapser *collapser, Patch *patch, double sagitta, Err *err)
{
    const Work work = {collapser, patch, sagitta};
    TRY(prepare(collapser, patch, err));
    for (size_t i = 0; i < patch->n_points; i++)
        collapser->settled[i] = false;
    bool changed = true;
    for (int sweep = 0; sweep < MOST_SWEEPS && changed; sweep++) {
        changed = false;
        for (uint32_t i = 0; i < patch->n_points; i++) {
            if (collapser->settled[i])
                continue;
            collapser->settled[i] = true;
            changed |= try_point(&work, i);
        }
    }
    patch_compact(patch, collapser->renamed);
    return STATUS_OK;
}
