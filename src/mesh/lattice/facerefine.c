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

/* Limits that end the rounds and the Newton steps. Reasons for the numbers not recorded. */
enum { MAX_ROUNDS = 6, MAX_NEWTON_STEPS = 8 };
#define NONE UINT32_MAX
/* The reasons for the next five numbers are not recorded.
 *
 * Minimum cosine between the normal at a new point and the normals at the ends of its edge. */
static const double alike = 0.3;
/* Minimum cosine between the normal at a new point and the normals of the triangles at it. */
static const double least_facing = 0.1;
/* In units of the limit: a triangle whose first two measurements are below this distance is not
 * measured at other points. */
static const double little = 0.6;
/* In units of the edge's length: maximum distance of a new point from the middle of its edge. */
static const double most_moved = 0.3;
/* In units of FIELD_LEVEL: maximum difference of the field from the level at a point that counts as
 * a point of the surface. */
static const double precisely = 1e-6;

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
    double split, limit; /* in local radii; in the last round the limit is infinite */
    KeyMap edges;        /* edge to be split -> index of the point that splits it, or NONE; owned */
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

/* Returns the distance of x from the surface, at most radius_mm: along `outward` if x is inside, in
 * the opposite direction if not. `inside` is true if x is inside. */
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
static double measure_at(const FaceRefining *refining, Vec3 x, Vec3 normal, double radius_mm)
{
    /* In units of the radius, and of 1 / radius. */
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
static bool find_point(const FaceRefining *refining, uint32_t a, uint32_t b, PatchPoint *point)
{
    const PatchPoint *one = &refining->patch->points[a], *other = &refining->patch->points[b];
    Vec3 middle = middle_of(refining, a, b), x = middle, gradient;
    double most = most_moved * length_of(refining, a, b);
    for (int i = 0; i < MAX_NEWTON_STEPS; i++) {
        const OctreeCell *cell = octree_leaf(refining->tree, x);
        if (!cell || cell->state != CELL_ACTIVE || vec3_distance(x, middle) > most)
            return false;
        FieldValue value = localfield_gradient(refining->field, &refining->tree->leaf_fields,
                                               &cell->local, x, &gradient);
        double steepness = vec3_length(gradient);
        if (fabs(value.phi - FIELD_LEVEL) <= precisely * FIELD_LEVEL) {
            *point = patch_surface_point(refining->field, x, &value, gradient);
            return vec3_dot(point->normal, one->normal) >= alike &&
                   vec3_dot(point->normal, other->normal) >= alike;
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
        if (find_point(refining, a, b, &point))
            TRY(patch_add_point(refining->patch, point, place, refining->err));
    }
    *marked = *place != NONE;
    return STATUS_OK;
}

/* Returns the distance of the point x of a triangle from the surface, mm. Where a triangle closes a
 * tunnel, neither its normal nor the gradient leads to the surface. So the path over a corner of
 * the triangle counts, too, if it is shorter. */
static double measure_on(const FaceRefining *refining, const PatchTriangle *triangle, Vec3 x,
                         Vec3 normal, double radius_mm)
{
    double off = measure_at(refining, x, normal, radius_mm);
    for (int i = 0; i < 3 && off > refining->split * radius_mm; i++) {
        Vec3 at = corner(refining, triangle, i)->x;
        off = fmin(off, vec3_distance(x, at) + measure_at(refining, at, normal, radius_mm));
    }
    return off;
}

/* Returns the distance of a triangle from the surface, mm, at its middle and at the middle of its
 * longest edge. If that is not small, the middles of the other edges are measured, too. */
static double measure_triangle(const FaceRefining *refining, const PatchTriangle *triangle,
                               int longest, double radius_mm)
{
    const PatchPoint *a = corner(refining, triangle, 0), *b = corner(refining, triangle, 1);
    const PatchPoint *c = corner(refining, triangle, 2);
    Vec3 normal = vec3_normalized(normal_of(a->x, b->x, c->x));
    Vec3 middle = vec3_scale(vec3_add(vec3_add(a->x, b->x), c->x), 1.0 / 3);
    double off = measure_on(refining, triangle, middle, normal, radius_mm);
    for (int i = 0; i < 3 && (i == 0 || off > little * refining->split * radius_mm); i++) {
        uint32_t from = triangle->at[(longest + i) % 3], to = triangle->at[(longest + i + 1) % 3];
        Vec3 half_way = middle_of(refining, from, to);
        off = fmax(off, measure_on(refining, triangle, half_way, normal, radius_mm));
    }
    return off;
}

/* Measures a triangle. If it is too far from the surface, marks its longest edge. */
static Status look_at(FaceRefining *refining, size_t index)
{
    const PatchTriangle triangle = refining->patch->triangles[index];
    uint8_t *state = &refining->states.items[index];
    int longest = longest_edge(refining, &triangle);
    double radius = HUGE_VAL;
    for (int i = 0; i < 3; i++)
        radius = fmin(radius, corner(refining, &triangle, i)->radius_mm);
    double off = measure_triangle(refining, &triangle, longest, radius);
    bool marked = false;
    if (off > refining->limit * radius && *state == TRIANGLE_NEW)
        TRY(mark_edge(refining, triangle.at[longest], triangle.at[(longest + 1) % 3], &marked));
    *state = marked ? TRIANGLE_FAR : TRIANGLE_SETTLED;
    if (!marked)
        meshdeviation_add(refining->deviation, off, radius);
    return STATUS_OK;
}

/* Returns the point that splits an edge, or NONE. */
static uint32_t point_on(const FaceRefining *refining, uint32_t a, uint32_t b)
{
    const uint32_t *place = keymap_find(&refining->edges, key_of_pair(a, b));
    return place ? *place : NONE;
}

/* Returns true if a triangle faces roughly in the direction of a normal. */
static bool faces(Vec3 a, Vec3 b, Vec3 c, Vec3 normal)
{
    Vec3 own = normal_of(a, b, c);
    return vec3_dot(own, normal) >= least_facing * vec3_length(own);
}

/* Unmarks the edges of a triangle whose split would turn it over. */
static void spare_edges(const FaceRefining *refining, const PatchTriangle *triangle)
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

/* Replaces a triangle by the first of its parts, and appends the others. */
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
        at[i] = point_on(refining, a, b);
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
            TRY(look_at(refining, i));
    *changed = patch->n_points > n_points;
    for (size_t i = 0; i < n && *changed; i++)
        spare_edges(refining, &patch->triangles[i]);
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
