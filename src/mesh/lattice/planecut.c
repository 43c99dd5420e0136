/* A plane is shifted into the widest gap between the points near it, so that no sliver is cut off.
 * A point is beyond a plane if it belongs to the stub's tube and is on the outer side of the plane.
 * Each edge that leads from a point that is not beyond to one that is gets one rim point. The rim
 * point is found on the straight edge, and is then moved to the circle or to the surface. */
#include "mesh/lattice/planecut.h"

#include <stdlib.h>

/* In units of the radius: maximum distance of a stub's surface from its axis. */
static const double tube_reach = 1.1;
/* Minimum cosine between the normal of a stub's surface and the direction from the point where the
 * plane meets the axis. The surface of a thin vessel close to the stub has a smaller one where the
 * stub's term is the larger one. */
static const double least_outward = 0.25;
/* Newton steps of a rim point from the edge to the surface. */
enum { SURFACE_STEPS = 4 };

typedef struct PlaneCut {
    PlaneCutter *cutter;
    const Octree *tree;
    const JunctionField *field;
    Patch *patch;
    BranchStub *stubs;
    size_t n_stubs;
    Err *err;
} PlaneCut;

void planecutter_release(PlaneCutter *cutter)
{
    keymap_release(&cutter->rim_points);
    ARRAY_RELEASE(&cutter->stub_beyond);
    ARRAY_RELEASE(&cutter->offsets);
    ARRAY_RELEASE(&cutter->stubs);
}

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
        vec3_dot(from, point->normal) < least_outward * sqrt(from2))
        return -HUGE_VAL;
    return along;
}

static int compare_offsets(const void *a, const void *b)
{
    const PlaneOffset *one = a, *other = b;
    if (one->stub != other->stub)
        return one->stub < other->stub ? -1 : 1;
    return (one->offset_mm > other->offset_mm) - (one->offset_mm < other->offset_mm);
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
static double room_of(const BranchStub *stub, double ratio)
{
    return fmin(0.25 * ratio, stub->is_close ? CLOSE_MOVE : PLANE_MOVE) * stub->radius_mm;
}

static Status shift_planes(const PlaneCut *cut, double ratio)
{
    PlaneCutter *cutter = cut->cutter;
    size_t n = 0;
    TRY(ARRAY_RESERVE(&cutter->offsets, cut->patch->n_points + 2 * cut->n_stubs,
                      "points of a junction", cut->err));
    PlaneOffset *offsets = cutter->offsets.items;
    for (size_t k = 0; k < cut->n_stubs; k++)
        for (int side = -1; side < 2; side += 2)
            offsets[n++] = (PlaneOffset){(uint16_t)k, side * room_of(&cut->stubs[k], ratio)};
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        double along = along_tube(cut, point);
        if (point->vessel_stub != NO_STUB &&
            fabs(along) < room_of(&cut->stubs[point->vessel_stub], ratio))
            offsets[n++] = (PlaneOffset){point->vessel_stub, along};
    }
    qsort(offsets, n, sizeof *offsets, compare_offsets);
    for (size_t from = 0, to = 0; from < n; from = to) {
        while (to < n && offsets[to].stub == offsets[from].stub)
            to++;
        shift_plane(&cut->stubs[offsets[from].stub], &offsets[from], to - from);
    }
    return STATUS_OK;
}

static void mark_beyond(const PlaneCut *cut)
{
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        bool is_beyond = along_tube(cut, point) > 0;
        cut->cutter->stub_beyond.items[i] = is_beyond ? point->vessel_stub : NO_STUB;
    }
}

/* Moves a point of a rim that is not a circle to the surface, along `away`, which leads away from
 * the axis in the plane. */
static void move_to_surface(const PlaneCut *cut, const BranchStub *stub, Vec3 away,
                            PatchPoint *point)
{
    const OctreeCell *cell = octree_leaf(cut->tree, point->x);
    if (!cell || cell->state != CELL_ACTIVE)
        return;
    for (int i = 0; i < SURFACE_STEPS; i++) {
        Vec3 gradient;
        FieldValue value = localfield_gradient(cut->field, &cut->tree->leaf_fields, &cell->local,
                                               point->x, &gradient);
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
    uint16_t index = cut->cutter->stub_beyond.items[beyond];
    const BranchStub *stub = &cut->stubs[index];
    Vec3 a = cut->patch->points[before].x, b = cut->patch->points[beyond].x;
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

static Status rim_point(const PlaneCut *cut, uint32_t before, uint32_t beyond, uint32_t *index)
{
    uint32_t *value;
    bool is_new;
    TRY(keymap_put(&cut->cutter->rim_points, key_of_pair(before, beyond), &value, &is_new,
                   cut->err));
    if (is_new)
        TRY(patch_add_point(cut->patch, cut_edge(cut, before, beyond), value, cut->err));
    *index = *value;
    return STATUS_OK;
}

/* Adds the part of a triangle before the plane. Its corner `lone` is alone on its side. */
static Status add_part(const PlaneCut *cut, PatchTriangle triangle, int lone, bool lone_is_before)
{
    uint32_t a = triangle.at[lone], b = triangle.at[(lone + 1) % 3],
             c = triangle.at[(lone + 2) % 3];
    uint32_t ab, ac;
    if (lone_is_before) {
        TRY(rim_point(cut, a, b, &ab));
        TRY(rim_point(cut, a, c, &ac));
        return patch_add_triangle(cut->patch, (PatchTriangle){{a, ab, ac}}, cut->err);
    }
    TRY(rim_point(cut, b, a, &ab));
    TRY(rim_point(cut, c, a, &ac));
    const PatchPoint *points = cut->patch->points;
    bool shorter =
        vec3_distance(points[b].x, points[ac].x) < vec3_distance(points[c].x, points[ab].x);
    TRY(patch_add_triangle(cut->patch, (PatchTriangle){{b, c, shorter ? ac : ab}}, cut->err));
    return patch_add_triangle(cut->patch,
                              shorter ? (PatchTriangle){{b, ac, ab}} : (PatchTriangle){{c, ac, ab}},
                              cut->err);
}

/* Removes a triangle if it is beyond a plane, and cuts it if the plane crosses it. */
static Status cut_triangle(const PlaneCut *cut, size_t i, bool *valid)
{
    const uint16_t *stub_beyond = cut->cutter->stub_beyond.items;
    const PatchTriangle triangle = cut->patch->triangles[i];
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
    cut->patch->triangles[i].at[0] = REMOVED;
    if (n_beyond == 3)
        return STATUS_OK;
    for (int k = 0; k < 3; k++)
        if ((stub_beyond[triangle.at[k]] != NO_STUB) == (n_beyond == 1))
            lone = k;
    return add_part(cut, triangle, lone, n_beyond == 2);
}

Status planecut_apply(PlaneCutter *cutter, const JunctionSurface *surface, double ratio,
                      bool *valid, Err *err)
{
    const JunctionPlan *plan = surface->plan;
    Patch *patch = surface->patch;
    const size_t n_whole = patch->n_triangles, n_stubs = plan->n_stubs;
    *valid = true;
    TRY(keymap_begin(&cutter->rim_points, 0, "points of a junction", err));
    TRY(ARRAY_RESERVE(&cutter->stub_beyond, patch->n_points, "points of a junction", err));
    TRY(ARRAY_RESERVE(&cutter->stubs, n_stubs, "stubs", err));
    for (size_t k = 0; k < n_stubs; k++)
        cutter->stubs.items[k] = plan->stubs[k];
    const PlaneCut cut = {cutter, surface->tree, &plan->field, patch, cutter->stubs.items, n_stubs,
                          err};
    TRY(shift_planes(&cut, ratio));
    mark_beyond(&cut);
    for (size_t i = 0; i < n_whole; i++)
        TRY(cut_triangle(&cut, i, valid));
    return patch_compact(patch, err);
}
