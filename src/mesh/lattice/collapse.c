/* Simplifies a patch by half-edge collapses: a point is merged into its nearest neighbour that
 * permits it.
 *
 * Accuracy: if an edge e between points with the normals n1 and n2 is the chord of an arc, the
 * distance between the middles of chord and arc is |e . (n2 - n1)| / 8. No new edge may have a
 * larger distance than the sagitta.
 *
 * Topology: an edge is collapsed only if its two ends have no common neighbours except the third
 * corners of the triangles at the edge. This link condition [T. Dey et al.: Topology preserving
 * edge contraction, 1999] keeps the topology.
 *
 * The corners of the triangles at a point form a linked list through `next`. Corners of removed
 * triangles leave the list the next time that it is walked. Each sweep costs O(points). */
#include "mesh/lattice/patch.h"

#include <stdlib.h>

/* MAX_RING is the size of a Ring on the stack: a point with more triangles stays. A collapse adds
 * two triangles less than the removed point has to its target, so rings grow slowly. All points are
 * tried in up to MAX_SWEEPS sweeps, because a collapse may permit others nearby. A later sweep
 * removes far fewer points than the first; it tests only points whose neighbourhood has changed.
 * Larger numbers would remove a few more points. */
enum { MAX_RING = 48, MAX_SWEEPS = 4 };
#define NONE UINT32_MAX

/* Minimum cosine between the normal of a new triangle and the field's normals at its corners: 44
 * degrees. A smaller value permits triangles that cut across bends; a larger one keeps more points
 * where vessels are thin for their cells. */
static const double min_cosine = 0.72;
/* Minimum height of a new triangle divided by its longest side, unless the triangle that it
 * replaces was narrower. A smaller value permits slivers, whose normals and crossings suffer from
 * rounding; a larger one keeps more points. */
static const double min_height_ratio = 0.04;

typedef struct CollapseWork {
    Patch *patch;
    double sagitta;  /* in local radii */
    uint32_t *next;  /* per corner of a triangle: the next corner at the same point; owned */
    uint32_t *first; /* per point: its first corner; owned */
    uint32_t *stamp; /* per point: marks neighbours while a collapse is tested; owned */
    bool *settled;   /* per point: it was tested, must stay, and nothing near has changed; owned */
} CollapseWork;

/* The ring of a point: its triangles are (point, from[i], to[i]). */
typedef struct Ring {
    uint32_t from[MAX_RING], to[MAX_RING], corner[MAX_RING];
    int n;
} Ring;

/* Finds the ring of a point. Returns false if the point has no triangles, or too many. */
static bool find_ring(const CollapseWork *work, uint32_t point, Ring *ring)
{
    const PatchTriangle *triangles = work->patch->triangles;
    uint32_t *link = &work->first[point];
    ring->n = 0;
    while (*link != NONE) {
        uint32_t corner = *link;
        const PatchTriangle *triangle = &triangles[corner / 3];
        if (triangle->at[0] == PATCH_REMOVED) {
            *link = work->next[corner];
            continue;
        }
        if (ring->n == MAX_RING)
            return false;
        ring->from[ring->n] = triangle->at[(corner + 1) % 3];
        ring->to[ring->n] = triangle->at[(corner + 2) % 3];
        ring->corner[ring->n++] = corner;
        link = &work->next[corner];
    }
    return ring->n > 0;
}

/* Returns true if the edge, as the chord of an arc, is within the sagitta of its surface. */
static inline bool edge_is_within_sagitta(const CollapseWork *work, uint32_t a, uint32_t b)
{
    const PatchPoint *one = &work->patch->points[a], *other = &work->patch->points[b];
    Vec3 edge = vec3_sub(other->x, one->x), turn = vec3_sub(other->normal, one->normal);
    double off = fabs(vec3_dot(edge, turn)) / 8;
    return off <= work->sagitta * one->radius_mm && off <= work->sagitta * other->radius_mm;
}

/* Returns the height of a triangle over its longest side, divided by that side. */
static double height_ratio(Vec3 a, Vec3 b, Vec3 c, double twice_area)
{
    Vec3 ab = vec3_sub(b, a), bc = vec3_sub(c, b), ca = vec3_sub(a, c);
    return twice_area / fmax(vec3_dot(ab, ab), fmax(vec3_dot(bc, bc), vec3_dot(ca, ca)));
}

static double twice_area(Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* Returns true if the triangle (a, b, c) may replace the triangle (old, b, c): it faces as the
 * surface does at its corners, and is no sliver. */
static bool is_replacement_valid(const CollapseWork *work, uint32_t a, uint32_t b, uint32_t c,
                                 uint32_t old)
{
    const PatchPoint *points = work->patch->points;
    Vec3 normal =
        vec3_cross(vec3_sub(points[b].x, points[a].x), vec3_sub(points[c].x, points[a].x));
    double area = vec3_length(normal), least = min_cosine * area;
    if (vec3_dot(normal, points[a].normal) < least || vec3_dot(normal, points[b].normal) < least ||
        vec3_dot(normal, points[c].normal) < least || !(area > 0))
        return false;
    double shape = height_ratio(points[a].x, points[b].x, points[c].x, area);
    return shape >= min_height_ratio ||
           shape > height_ratio(points[old].x, points[b].x, points[c].x,
                                twice_area(points[old].x, points[b].x, points[c].x));
}

/* Returns the number of triangles at the edge from the ring's point to `other`. */
static int shared_triangles(const Ring *ring, uint32_t other)
{
    int n = 0;
    for (int i = 0; i < ring->n; i++)
        n += ring->from[i] == other || ring->to[i] == other;
    return n;
}

static void stamp_ring(const CollapseWork *work, const Ring *ring, uint32_t value)
{
    for (int i = 0; i < ring->n; i++)
        work->stamp[ring->from[i]] = work->stamp[ring->to[i]] = value;
}

/* Counts the neighbours of the ring's point that have the stamp, and removes their stamps. */
static int count_stamped(const CollapseWork *work, const Ring *ring, uint32_t value)
{
    int n = 0;
    for (int i = 0; i < ring->n; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t *stamp = &work->stamp[k ? ring->to[i] : ring->from[i]];
            n += *stamp == value;
            if (*stamp == value)
                *stamp = NONE;
        }
    return n;
}

static bool meets_link_condition(const CollapseWork *work, const Ring *ring,
                                 const Ring *target_ring, uint32_t target, int shared)
{
    stamp_ring(work, target_ring, target);
    return count_stamped(work, ring, target) == shared &&
           shared_triangles(target_ring, target) == 0;
}

/* Returns true if `point` may be merged into its neighbour `target`. */
static bool may_collapse(const CollapseWork *work, uint32_t point, const Ring *ring,
                         uint32_t target)
{
    const PatchPoint *points = work->patch->points;
    int shared = shared_triangles(ring, target);
    bool on_rim = points[point].rim_stub != NO_STUB;
    if (on_rim && (shared != 1 || points[target].rim_stub != points[point].rim_stub))
        return false;
    for (int i = 0; i < ring->n; i++)
        if (ring->to[i] != target && !edge_is_within_sagitta(work, target, ring->to[i]))
            return false;
    for (int i = 0; i < ring->n && on_rim; i++)
        if (ring->from[i] != target && !edge_is_within_sagitta(work, target, ring->from[i]))
            return false;
    for (int i = 0; i < ring->n; i++)
        if (ring->from[i] != target && ring->to[i] != target &&
            !is_replacement_valid(work, target, ring->from[i], ring->to[i], point))
            return false;
    Ring target_ring;
    return find_ring(work, target, &target_ring) &&
           ring->n + target_ring.n - 2 * shared <= MAX_RING &&
           meets_link_condition(work, ring, &target_ring, target, shared);
}

/* Moves the triangles of `point` to `target`, and removes the triangles at the edge between the
 * two. */
static void collapse_edge(const CollapseWork *work, uint32_t point, const Ring *ring,
                          uint32_t target)
{
    for (int i = 0; i < ring->n; i++) {
        PatchTriangle *triangle = &work->patch->triangles[ring->corner[i] / 3];
        work->settled[ring->from[i]] = work->settled[ring->to[i]] = false;
        if (ring->from[i] == target || ring->to[i] == target) {
            triangle->at[0] = PATCH_REMOVED;
            continue;
        }
        triangle->at[ring->corner[i] % 3] = target;
        work->next[ring->corner[i]] = work->first[target];
        work->first[target] = ring->corner[i];
    }
    work->first[point] = NONE;
}

/* A neighbour and its squared distance. */
typedef struct Neighbor {
    uint32_t point;
    double length2;
} Neighbor;

/* Inserts a neighbour of a point into a list of `n` others, the nearest first. */
static void insert_neighbor(const CollapseWork *work, uint32_t point, uint32_t other,
                            Neighbor *list, int n)
{
    const PatchPoint *points = work->patch->points;
    Vec3 edge = vec3_sub(points[other].x, points[point].x);
    double length2 = vec3_dot(edge, edge);
    for (; n > 0 && list[n - 1].length2 > length2; n--)
        list[n] = list[n - 1];
    list[n] = (Neighbor){other, length2};
}

/* Merges the point into the nearest neighbour that allows it. Going round the point, each triangle
 * ends at another neighbour. On a rim there is one more neighbour, where the first triangle begins.
 */
static bool try_point(const CollapseWork *work, uint32_t point)
{
    Ring ring;
    Neighbor list[MAX_RING + 1];
    if (!find_ring(work, point, &ring))
        return false;
    int n = 0;
    for (; n < ring.n; n++)
        insert_neighbor(work, point, ring.to[n], list, n);
    bool on_rim = work->patch->points[point].rim_stub != NO_STUB;
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

/* Lists the corners of the triangles at each point. */
static Status prepare(CollapseWork *work, Err *err)
{
    const Patch *patch = work->patch;
    size_t points = patch->n_points, corners = 3 * patch->n_triangles;
    TRY(mem_alloc(&work->next, corners, sizeof *work->next, patch_items, err));
    TRY(mem_alloc(&work->first, points, sizeof *work->first, patch_items, err));
    TRY(mem_alloc(&work->stamp, points, sizeof *work->stamp, patch_items, err));
    TRY(mem_calloc(&work->settled, points, sizeof *work->settled, patch_items, err));
    for (size_t i = 0; i < points; i++)
        work->first[i] = work->stamp[i] = NONE;
    for (size_t i = corners; i-- > 0;) {
        uint32_t *first = &work->first[patch->triangles[i / 3].at[i % 3]];
        work->next[i] = *first;
        *first = (uint32_t)i;
    }
    return STATUS_OK;
}

Status collapse_apply(Patch *patch, double sagitta, Err *err)
{
    CollapseWork work = {.patch = patch, .sagitta = sagitta};
    bool changed = true;
    Status status;
    TRY_GOTO(prepare(&work, err));
    for (int sweep = 0; sweep < MAX_SWEEPS && changed; sweep++) {
        changed = false;
        for (uint32_t i = 0; i < patch->n_points; i++) {
            if (work.settled[i])
                continue;
            work.settled[i] = true;
            changed |= try_point(&work, i);
        }
    }
    TRY_GOTO(patch_compact(patch, err));
done:
    free(work.next);
    free(work.first);
    free(work.stamp);
    free(work.settled);
    return status;
}
