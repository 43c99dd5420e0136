/* Splits triangles that are too far from the exact surface.
 *
 * Triangles are split in rounds. Each round measures the new triangles. If a triangle is too far
 * from the surface, its longest edge is split at a point of the surface. Newton steps along the
 * field's gradient lead to this point from the middle of the edge.
 *
 * An edge is not split if the split would turn one of its triangles over. It is not split either if
 * the normal at the new point is unlike the normals at the edge's ends, because two surfaces then
 * face each other in a groove. A triangle with several edges to be split is halved at the longest
 * of these edges first. So the two triangles at an edge agree on its split. */
#include "mesh/lattice/patch.h"

#include <stdlib.h>

/* Maximum number of rounds of splits, and of Newton steps to the surface. A round halves the edges
 * that are too long, so 6 rounds make an edge 64 times shorter. Newton's method doubles the correct
 * digits in each step, so a search that needs more than 8 steps does not converge, as in a groove.
 */
enum { MAX_ROUNDS = 6, MAX_NEWTON_STEPS = 8 };
#define NONE UINT32_MAX
/* Minimum cosine between the normal at a new point and the normals at the ends of its edge: 73
 * degrees. With a smaller value, an edge could be split at a point on the opposite wall of a
 * groove; with a larger one, creases would stay unsplit. */
static const double min_normal_cosine = 0.3;
/* Minimum cosine between the normal at a new point and the normals of the triangles at it: 84
 * degrees. At 0, a triangle would stand upright on the surface. */
static const double min_triangle_cosine = 0.1;
/* In units of the limit: a triangle whose first two measured distances are below this fraction is
 * not measured at other points. It saves time; at 1, triangles just beyond the limit could be
 * missed. */
static const double near_fraction = 0.6;
/* In units of the edge's length: maximum distance of a new point from the middle of its edge. A
 * point that is farther away would leave a narrow triangle, or is on another vessel's surface. */
static const double max_move = 0.3;
/* In units of FIELD_LEVEL: maximum difference of the field from the level at a point that counts as
 * a point of the surface. As the field's slope is 4 FIELD_LEVEL / r, this is 2.5e-7 radii, far
 * below every tolerance. */
static const double level_tolerance = 1e-6;

typedef enum TriangleState {
    TRIANGLE_NEW,
    TRIANGLE_FAR,    /* to be split */
    TRIANGLE_SETTLED /* near enough, or cannot be split */
} TriangleState;

typedef struct FaceRefining {
    const JunctionField *field;
    const Octree *tree;
    Patch *patch;
    MeshDeviation *deviation;
    double split,
        limit;    /* distances in local radii: the caller's limit, and the limit of this round. The
                   * limit of the last    round is infinite, so that the round only measures. */
    KeyMap edges; /* edge to be split -> index of the point that splits it, or NONE; owned */
    ARRAY(uint8_t) states; /* per triangle: TriangleState */
    Err *err;
} FaceRefining;

/* Returns true if x is inside the surface. Returns `otherwise` beyond a plane, where the surface is
 * not known. */
static bool is_inside(const FaceRefining *refining, Vec3 x, bool otherwise)
{
    const Octree *tree = refining->tree;
    const OctreeCell *cell = octree_leaf(tree, x);
    if (!cell || cell->state == CELL_OUTSIDE)
        return false;
    if (cell->state == CELL_ACTIVE)
        return localfield_value(refining->field, &tree->leaf_fields, &cell->local, x).phi >=
               FIELD_LEVEL;
    return cell->state == CELL_INSIDE || otherwise;
}

/* Returns the distance of x from the surface, mm, but at most radius_mm. The search goes along
 * `outward` if x is inside, and against it if not. Steps that grow by half each time, from 0.01
 * radii on, bracket the surface; 8 bisections then reduce the bracket 256 times, to at most 0.2 %
 * of the distance or 4e-5 radii. */
static double search_surface(const FaceRefining *refining, Vec3 x, bool inside, Vec3 outward,
                             double radius_mm)
{
    double low = 0, high = 0.01 * radius_mm, sign = inside ? 1 : -1;
    while (high < radius_mm &&
           is_inside(refining, vec3_add_scaled(x, outward, sign * high), inside) == inside) {
        low = high;
        high *= 1.5;
    }
    for (int i = 0; i < 8 && high < radius_mm; i++) {
        double middle = 0.5 * (low + high);
        Vec3 at = vec3_add_scaled(x, outward, sign * middle);
        *(is_inside(refining, at, inside) == inside ? &low : &high) = middle;
    }
    return fmin(high, radius_mm);
}

/* Returns the distance of the point x of a triangle from the surface, mm. At a vessel's surface the
 * slope of the field is 4 FIELD_LEVEL / r. Where the slope is not much smaller, and x is near the
 * surface, the distance follows from the field's value and slope. Elsewhere the surface is searched
 * for along the field's gradient and along the triangle's normal. */
static double distance_to_surface(const FaceRefining *refining, Vec3 x, Vec3 normal,
                                  double radius_mm)
{
    /* A distance in units of the radius, and a slope in units of 1 / radius: a quarter of the slope
     * at a lone vessel's surface. Within these limits, the first-order distance is exact enough;
     * smaller limits search more often. */
    static const double near = 0.02, steep = FIELD_LEVEL;
    const Octree *tree = refining->tree;
    const OctreeCell *cell = octree_leaf(tree, x);
    Vec3 gradient;
    if (!cell || cell->state == CELL_BEYOND_PLANE)
        return 0;
    if (cell->state != CELL_ACTIVE)
        return search_surface(refining, x, cell->state == CELL_INSIDE, normal, radius_mm);
    FieldValue value =
        localfield_gradient(refining->field, &tree->leaf_fields, &cell->local, x, &gradient);
    double slope = vec3_length(gradient), off = fabs(value.phi - FIELD_LEVEL) / slope;
    if (off <= near * radius_mm && slope * radius_mm >= steep)
        return off;
    bool inside = value.phi >= FIELD_LEVEL;
    double one = search_surface(refining, x, inside, normal, radius_mm);
    if (!(slope > 0))
        return one;
    Vec3 down = vec3_scale(gradient, -1 / slope);
    return fmin(one, search_surface(refining, x, inside, down, radius_mm));
}

static const PatchPoint *corner(const FaceRefining *refining, const PatchTriangle *triangle, int i)
{
    return &refining->patch->points[triangle->at[i % 3]];
}

static Vec3 middle_of(const FaceRefining *refining, uint32_t a, uint32_t b)
{
    const PatchPoint *points = refining->patch->points;
    return vec3_scale(vec3_add(points[a].x, points[b].x), 0.5);
}

static double length_of(const FaceRefining *refining, uint32_t a, uint32_t b)
{
    const PatchPoint *points = refining->patch->points;
    return vec3_distance(points[a].x, points[b].x);
}

/* Returns the first corner of the longest edge of a triangle. */
static int longest_edge(const FaceRefining *refining, const PatchTriangle *triangle)
{
    int longest = 0;
    double length[3];
    for (int i = 0; i < 3; i++) {
        length[i] = length_of(refining, triangle->at[i], triangle->at[(i + 1) % 3]);
        longest = length[i] > length[longest] ? i : longest;
    }
    return longest;
}

/* Returns the normal of a triangle, of a length of twice its area. */
static Vec3 normal_of(Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
}

/* Finds the point of the surface near the middle of an edge. Returns false if there is no point
 * that may split the edge. */
static bool find_split_point(const FaceRefining *refining, uint32_t a, uint32_t b,
                             PatchPoint *point)
{
    const PatchPoint *one = &refining->patch->points[a], *other = &refining->patch->points[b];
    Vec3 middle = middle_of(refining, a, b), x = middle, gradient;
    double most = max_move * length_of(refining, a, b);
    for (int i = 0; i < MAX_NEWTON_STEPS; i++) {
        const OctreeCell *cell = octree_leaf(refining->tree, x);
        if (!cell || cell->state != CELL_ACTIVE || vec3_distance(x, middle) > most)
            return false;
        FieldValue value = localfield_gradient(refining->field, &refining->tree->leaf_fields,
                                               &cell->local, x, &gradient);
        double steepness = vec3_length(gradient);
        if (fabs(value.phi - FIELD_LEVEL) <= level_tolerance * FIELD_LEVEL) {
            *point = patch_surface_point(refining->field, x, &value, gradient);
            return vec3_dot(point->normal, one->normal) >= min_normal_cosine &&
                   vec3_dot(point->normal, other->normal) >= min_normal_cosine;
        }
        if (!(steepness > 0))
            return false;
        x = vec3_add_scaled(x, gradient, (FIELD_LEVEL - value.phi) / (steepness * steepness));
    }
    return false;
}

/* Marks an edge to be split, if it can be. */
static Status mark_edge(FaceRefining *refining, uint32_t a, uint32_t b, bool *marked)
{
    const PatchPoint *points = refining->patch->points;
    uint32_t *place;
    PatchPoint point;
    bool is_new, on_rim = points[a].rim_stub != NO_STUB && points[a].rim_stub == points[b].rim_stub;
    *marked = false;
    if (on_rim)
        return STATUS_OK;
    TRY(keymap_put(&refining->edges, key_of_pair(a, b), &place, &is_new, refining->err));
    if (is_new) {
        *place = NONE;
        if (find_split_point(refining, a, b, &point))
            TRY(patch_add_point(refining->patch, point, place, refining->err));
    }
    *marked = *place != NONE;
    return STATUS_OK;
}

/* Returns the distance of the point x of a triangle from the surface, mm. Where a triangle closes a
 * tunnel, neither its normal nor the gradient leads to the surface. So the path over a corner of
 * the triangle counts, too, if it is shorter. */
static double distance_from_triangle_point(const FaceRefining *refining,
                                           const PatchTriangle *triangle, Vec3 x, Vec3 normal,
                                           double radius_mm)
{
    double off = distance_to_surface(refining, x, normal, radius_mm);
    for (int i = 0; i < 3 && off > refining->split * radius_mm; i++) {
        Vec3 at = corner(refining, triangle, i)->x;
        off =
            fmin(off, vec3_distance(x, at) + distance_to_surface(refining, at, normal, radius_mm));
    }
    return off;
}

/* Returns the distance of a triangle from the surface, mm, at its middle and at the middle of its
 * longest edge. If that is not small, the middles of the other edges are measured, too. */
static double triangle_distance(const FaceRefining *refining, const PatchTriangle *triangle,
                                int longest, double radius_mm)
{
    const PatchPoint *a = corner(refining, triangle, 0), *b = corner(refining, triangle, 1);
    const PatchPoint *c = corner(refining, triangle, 2);
    Vec3 normal = vec3_normalized(normal_of(a->x, b->x, c->x));
    Vec3 middle = vec3_scale(vec3_add(vec3_add(a->x, b->x), c->x), 1.0 / 3);
    double off = distance_from_triangle_point(refining, triangle, middle, normal, radius_mm);
    for (int i = 0; i < 3 && (i == 0 || off > near_fraction * refining->split * radius_mm); i++) {
        uint32_t from = triangle->at[(longest + i) % 3], to = triangle->at[(longest + i + 1) % 3];
        Vec3 half_way = middle_of(refining, from, to);
        off = fmax(off,
                   distance_from_triangle_point(refining, triangle, half_way, normal, radius_mm));
    }
    return off;
}

/* Measures a new triangle, and marks its longest edge if the triangle is too far from the surface.
 */
static Status judge_triangle(FaceRefining *refining, size_t index)
{
    const PatchTriangle triangle = refining->patch->triangles[index];
    uint8_t *state = &refining->states.items[index];
    int longest = longest_edge(refining, &triangle);
    double radius = HUGE_VAL;
    for (int i = 0; i < 3; i++)
        radius = fmin(radius, corner(refining, &triangle, i)->radius_mm);
    double off = triangle_distance(refining, &triangle, longest, radius);
    bool marked = false;
    if (off > refining->limit * radius && *state == TRIANGLE_NEW)
        TRY(mark_edge(refining, triangle.at[longest], triangle.at[(longest + 1) % 3], &marked));
    *state = marked ? TRIANGLE_FAR : TRIANGLE_SETTLED;
    if (!marked)
        meshdeviation_add(refining->deviation, off, radius);
    return STATUS_OK;
}

/* Returns the point that splits an edge, or NONE. */
static uint32_t split_point_of(const FaceRefining *refining, uint32_t a, uint32_t b)
{
    const uint32_t *place = keymap_find(&refining->edges, key_of_pair(a, b));
    return place ? *place : NONE;
}

/* Returns true if a triangle faces roughly in the direction of a normal. */
static bool faces(Vec3 a, Vec3 b, Vec3 c, Vec3 normal)
{
    Vec3 own = normal_of(a, b, c);
    return vec3_dot(own, normal) >= min_triangle_cosine * vec3_length(own);
}

/* Unmarks the edges of a triangle whose split would turn it over. */
static void unmark_bad_splits(const FaceRefining *refining, const PatchTriangle *triangle)
{
    const PatchPoint *points = refining->patch->points;
    for (int i = 0; i < 3; i++) {
        uint32_t a = triangle->at[i], b = triangle->at[(i + 1) % 3], c = triangle->at[(i + 2) % 3];
        uint32_t *place = keymap_find(&refining->edges, key_of_pair(a, b));
        if (!place || *place == NONE)
            continue;
        const PatchPoint *at = &points[*place];
        if (!faces(points[a].x, at->x, points[c].x, at->normal) ||
            !faces(at->x, points[b].x, points[c].x, at->normal))
            *place = NONE;
    }
}

/* Splits a triangle at its longest marked edge, and then splits both halves. The first half
 * replaces the triangle; the second is appended. */
static Status split(FaceRefining *refining, size_t index)
{
    Patch *patch = refining->patch;
    const PatchTriangle triangle = patch->triangles[index];
    int best = -1;
    uint32_t at[3];
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t a = triangle.at[i], b = triangle.at[(i + 1) % 3];
        double length = length_of(refining, a, b);
        at[i] = split_point_of(refining, a, b);
        if (at[i] == NONE || !(length > longest))
            continue;
        longest = length;
        best = i;
    }
    if (best < 0)
        return STATUS_OK;
    uint32_t a = triangle.at[best], b = triangle.at[(best + 1) % 3],
             c = triangle.at[(best + 2) % 3];
    patch->triangles[index] = (PatchTriangle){{a, at[best], c}};
    TRY(patch_add_triangle(patch, (PatchTriangle){{at[best], b, c}}, refining->err));
    size_t other = patch->n_triangles - 1;
    TRY(ARRAY_PUSH(&refining->states, patch_items, refining->err, TRIANGLE_NEW));
    refining->states.items[index] = TRIANGLE_NEW;
    TRY(split(refining, index));
    return split(refining, other);
}

/* Runs one round. *changed receives true if an edge was marked to be split. */
static Status refine_once(FaceRefining *refining, bool *changed)
{
    const Patch *patch = refining->patch;
    size_t n = patch->n_triangles, n_points = patch->n_points;
    TRY(keymap_begin(&refining->edges, 0, patch_items, refining->err));
    for (size_t i = 0; i < n; i++)
        if (refining->states.items[i] != TRIANGLE_SETTLED)
            TRY(judge_triangle(refining, i));
    *changed = patch->n_points > n_points;
    for (size_t i = 0; i < n && *changed; i++)
        unmark_bad_splits(refining, &patch->triangles[i]);
    for (size_t i = 0; i < n && *changed; i++)
        TRY(split(refining, i));
    return STATUS_OK;
}

Status facerefine_apply(const JunctionSurface *surface, double limit, MeshDeviation *deviation,
                        Err *err)
{
    Patch *patch = surface->patch;
    FaceRefining refining = {.field = &surface->plan->field,
                             .tree = surface->tree,
                             .patch = patch,
                             .deviation = deviation,
                             .split = limit,
                             .err = err};
    size_t n_points = patch->n_points;
    bool changed = true;
    Status status;
    TRY_GOTO(ARRAY_RESERVE(&refining.states, patch->n_triangles, patch_items, err));
    for (; refining.states.n < patch->n_triangles; refining.states.n++)
        refining.states.items[refining.states.n] = TRIANGLE_NEW;
    for (int round = 0; round <= MAX_ROUNDS && changed; round++) {
        refining.limit = round < MAX_ROUNDS ? limit : HUGE_VAL;
        TRY_GOTO(refine_once(&refining, &changed));
    }
    if (patch->n_points > n_points)
        TRY_GOTO(patch_compact(patch, err));
done:
    keymap_release(&refining.edges);
    ARRAY_RELEASE(&refining.states);
    return status;
}
