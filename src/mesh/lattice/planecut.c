/* Cuts the surface of a junction region at the end planes of its stubs, so that each stub ends in a
 * rim.
 *
 * First, a plane is shifted into the widest gap between the points near it, so that no sliver is
 * cut off. A point is beyond a plane if it is on the stub's tube and on the outer side of the
 * plane. An edge between a point beyond the plane and another point gets one rim point. The rim
 * point is found on the straight edge. Then it is moved to the circle about the axis or, for a
 * close stub, to the surface. O(points log points). */
#include "mesh/lattice/patch.h"

#include <stdlib.h>

/* In units of the stub's radius: a point farther from the axis is not on the stub's tube. Other
 * vessels move the surface of a tube by far less than 0.1 radii at its planes [MAX_SHIFT in
 * junctions.c]. A larger value could include points of other vessels. */
static const double tube_reach = 1.1;
/* Minimum cosine, at a point of a stub's surface, between the normal and the direction from the
 * point where the plane meets the axis: 76 degrees. The surface of a thin vessel close to the stub
 * has a smaller cosine, even where the stub's term is the larger one. At the end of a stub's tail,
 * the cosine on its own tube is smaller, too. */
static const double min_outward_cosine = 0.25;
/* Newton steps that move a rim point from its edge to the surface. The edge is short, so the first
 * step already leaves an error of second order; 4 steps converge to rounding. */
enum { SURFACE_STEPS = 4 };

/* The position of a point relative to the end plane of its stub. */
typedef struct PlaneOffset {
    uint16_t stub;
    double offset_mm; /* distance beyond the plane along the stub's axis; below 0: inside */
} PlaneOffset;

typedef struct PlaneCut {
    const JunctionSurface *surface;
    BranchStub *stubs;     /* copies of the plan's stubs, with shifted planes; owned */
    PlaneOffset *offsets;  /* of the stubs' limits and of points near planes; owned */
    uint16_t *stub_beyond; /* per point: the stub whose plane it is beyond, or NO_STUB; owned */
    KeyMap rim_points;     /* edge -> index of the point where the edge crosses a plane; owned */
    Err *err;
} PlaneCut;

/* Returns how far a point is beyond the plane of its stub, mm, or -HUGE_VAL if it is not on the
 * tube of a stub. */
static double along_tube(const PlaneCut *cut, const PatchPoint *point)
{
    if (point->vessel_stub == NO_STUB)
        return -HUGE_VAL;
    const BranchStub *stub = &cut->stubs[point->vessel_stub];
    Vec3 from = vec3_sub(point->x, stub->at);
    double along = vec3_dot(from, stub->outward), reach = tube_reach * stub->radius_mm;
    double from2 = vec3_dot(from, from), across2 = from2 - along * along;
    if (across2 > reach * reach || along > (STUB_TAIL + 1) * stub->radius_mm ||
        vec3_dot(from, point->normal) < min_outward_cosine * sqrt(from2))
        return -HUGE_VAL;
    return along;
}

static int compare_offsets(const void *a, const void *b)
{
    const PlaneOffset *one = a, *other = b;
    int order = one->stub - other->stub;
    return order ? order : compare_numbers(one->offset_mm, other->offset_mm);
}

/* Shifts the plane into the middle of the widest gap between at least two offsets. */
static void shift_plane(BranchStub *stub, const PlaneOffset *offsets, size_t n)
{
    double by = 0, widest = -1;
    for (size_t i = 0; i + 1 < n; i++) {
        double gap = offsets[i + 1].offset_mm - offsets[i].offset_mm;
        if (gap > widest) {
            widest = gap;
            by = 0.5 * (offsets[i].offset_mm + offsets[i + 1].offset_mm);
        }
    }
    stub->at = vec3_add_scaled(stub->at, stub->outward, by);
}

/* Returns the maximum shift of a stub's plane, mm. */
static double max_shift(const BranchStub *stub, double ratio)
{
    return fmin(0.25 * ratio, stub->is_close ? CLOSE_MOVE : PLANE_MOVE) * stub->radius_mm;
}

/* Shifts all planes. The limits of each plane's shift are offsets, too, so a plane without points
 * near it has one gap. */
static void shift_planes(const PlaneCut *cut, double ratio)
{
    const Patch *patch = cut->surface->patch;
    PlaneOffset *offsets = cut->offsets;
    size_t n = 0;
    for (size_t k = 0; k < cut->surface->plan->n_stubs; k++)
        for (int side = -1; side < 2; side += 2)
            offsets[n++] = (PlaneOffset){(uint16_t)k, side * max_shift(&cut->stubs[k], ratio)};
    for (size_t i = 0; i < patch->n_points; i++) {
        const PatchPoint *point = &patch->points[i];
        double along = along_tube(cut, point);
        if (point->vessel_stub != NO_STUB &&
            fabs(along) < max_shift(&cut->stubs[point->vessel_stub], ratio))
            offsets[n++] = (PlaneOffset){point->vessel_stub, along};
    }
    qsort(offsets, n, sizeof *offsets, compare_offsets);
    for (size_t from = 0, to = 0; from < n; from = to) {
        while (to < n && offsets[to].stub == offsets[from].stub)
            to++;
        shift_plane(&cut->stubs[offsets[from].stub], &offsets[from], to - from);
    }
}

/* Notes, per point, the stub whose plane it is beyond. */
static void mark_beyond(const PlaneCut *cut)
{
    const Patch *patch = cut->surface->patch;
    for (size_t i = 0; i < patch->n_points; i++)
        cut->stub_beyond[i] =
            along_tube(cut, &patch->points[i]) > 0 ? patch->points[i].vessel_stub : NO_STUB;
}

/* Moves a point of a rim that is not a circle to the surface, along `away`, which leads away from
 * the axis in the plane. */
static void move_to_surface(const PlaneCut *cut, const BranchStub *stub, Vec3 away,
                            PatchPoint *point)
{
    const Octree *tree = cut->surface->tree;
    const OctreeCell *cell = octree_leaf(tree, point->x);
    if (!cell || cell->state != CELL_ACTIVE)
        return;
    for (int i = 0; i < SURFACE_STEPS; i++) {
        Vec3 gradient;
        FieldValue value = localfield_gradient(&cut->surface->plan->field, &tree->leaf_fields,
                                               &cell->local, point->x, &gradient);
        double slope = vec3_dot(gradient, away), most = 0.1 * stub->radius_mm;
        double by = (FIELD_LEVEL - value.phi) / slope;
        if (!(slope < 0) || !(fabs(by) < most))
            return;
        point->x = vec3_add_scaled(point->x, away, by);
        point->normal = vec3_scale(gradient, -1 / vec3_length(gradient));
    }
}

/* Returns the rim point of an edge. */
static PatchPoint cut_edge(const PlaneCut *cut, uint32_t before, uint32_t beyond)
{
    uint16_t index = cut->stub_beyond[beyond];
    const BranchStub *stub = &cut->stubs[index];
    const PatchPoint *points = cut->surface->patch->points;
    Vec3 a = points[before].x, b = points[beyond].x;
    double from = vec3_dot(vec3_sub(a, stub->at), stub->outward);
    double to = vec3_dot(vec3_sub(b, stub->at), stub->outward);
    Vec3 x = vec3_add_scaled(a, vec3_sub(b, a), from / (from - to));
    Vec3 across = vec3_sub(x, stub->at);
    across = vec3_add_scaled(across, stub->outward, -vec3_dot(across, stub->outward));
    Vec3 normal = vec3_normalized(across);
    PatchPoint point = {.x = vec3_add_scaled(stub->at, normal, stub->radius_mm),
                        .normal = normal,
                        .radius_mm = stub->radius_mm,
                        .segment = stub->segment,
                        .vessel_stub = index,
                        .rim_stub = index};
    if (stub->is_close) {
        point.x = vec3_add(stub->at, across);
        move_to_surface(cut, stub, normal, &point);
    }
    return point;
}

static Status rim_point(PlaneCut *cut, uint32_t before, uint32_t beyond, uint32_t *index)
{
    uint32_t *value;
    bool is_new;
    TRY(keymap_put(&cut->rim_points, key_of_pair(before, beyond), &value, &is_new, cut->err));
    if (is_new)
        TRY(patch_add_point(cut->surface->patch, cut_edge(cut, before, beyond), value, cut->err));
    *index = *value;
    return STATUS_OK;
}

/* Adds the part of a triangle before the plane. Its corner `lone` is alone on its side. */
static Status add_part(PlaneCut *cut, PatchTriangle triangle, int lone, bool lone_is_before)
{
    Patch *patch = cut->surface->patch;
    uint32_t a = triangle.at[lone], b = triangle.at[(lone + 1) % 3],
             c = triangle.at[(lone + 2) % 3];
    uint32_t ab, ac;
    if (lone_is_before) {
        TRY(rim_point(cut, a, b, &ab));
        TRY(rim_point(cut, a, c, &ac));
        return patch_add_triangle(patch, (PatchTriangle){{a, ab, ac}}, cut->err);
    }
    TRY(rim_point(cut, b, a, &ab));
    TRY(rim_point(cut, c, a, &ac));
    const PatchPoint *points = patch->points;
    bool shorter =
        vec3_distance(points[b].x, points[ac].x) < vec3_distance(points[c].x, points[ab].x);
    TRY(patch_add_triangle(patch, (PatchTriangle){{b, c, shorter ? ac : ab}}, cut->err));
    return patch_add_triangle(patch, (PatchTriangle){{shorter ? b : c, ac, ab}}, cut->err);
}

/* Removes a triangle if it is beyond a plane, and cuts it if the plane crosses it. */
static Status cut_triangle(PlaneCut *cut, size_t i, bool *valid)
{
    const uint16_t *stub_beyond = cut->stub_beyond;
    const PatchTriangle triangle = cut->surface->patch->triangles[i];
    int n_beyond = 0, lone = 0;
    uint16_t stub = NO_STUB;
    for (int k = 0; k < 3; k++) {
        uint16_t beyond = stub_beyond[triangle.at[k]];
        n_beyond += beyond != NO_STUB;
        *valid = *valid && (beyond == NO_STUB || stub == NO_STUB || beyond == stub);
        stub = beyond != NO_STUB ? beyond : stub;
    }
    if (n_beyond == 0)
        return STATUS_OK;
    cut->surface->patch->triangles[i].at[0] = PATCH_REMOVED;
    if (n_beyond == 3)
        return STATUS_OK;
    for (int k = 0; k < 3; k++)
        if ((stub_beyond[triangle.at[k]] != NO_STUB) == (n_beyond == 1))
            lone = k;
    return add_part(cut, triangle, lone, n_beyond == 2);
}

static Status reserve(PlaneCut *cut)
{
    const JunctionPlan *plan = cut->surface->plan;
    size_t n_points = cut->surface->patch->n_points, n_offsets = n_points + 2 * plan->n_stubs;
    TRY(mem_alloc(&cut->stubs, plan->n_stubs, sizeof *cut->stubs, "stubs", cut->err));
    TRY(mem_alloc(&cut->offsets, n_offsets, sizeof *cut->offsets, patch_items, cut->err));
    TRY(mem_alloc(&cut->stub_beyond, n_points, sizeof *cut->stub_beyond, patch_items, cut->err));
    return keymap_begin(&cut->rim_points, 0, patch_items, cut->err);
}

Status planecut_apply(const JunctionSurface *surface, double ratio, bool *valid, Err *err)
{
    const JunctionPlan *plan = surface->plan;
    const size_t n_whole = surface->patch->n_triangles;
    PlaneCut cut = {.surface = surface, .err = err};
    Status status;
    *valid = true;
    TRY_GOTO(reserve(&cut));
    for (size_t k = 0; k < plan->n_stubs; k++)
        cut.stubs[k] = plan->stubs[k];
    shift_planes(&cut, ratio);
    mark_beyond(&cut);
    for (size_t i = 0; i < n_whole; i++)
        TRY_GOTO(cut_triangle(&cut, i, valid));
    TRY_GOTO(patch_compact(surface->patch, err));
done:
    free(cut.stubs);
    free(cut.offsets);
    free(cut.stub_beyond);
    keymap_release(&cut.rim_points);
    return status;
}
