/* A plane is put into the widest gap between the points near it, so that no sliver is cut off. What
 * is on an stub's tube and beyond its plane is behind; each edge from before to behind gets
 * one point, found by the lattice's straight line and put on the circle, or on the wall. */
#include "mesh/lattice/planecut.h"

#include <stdlib.h>

/* How far the wall of an stub may be from its axis, in radii. */
static const double tube_reach = 1.1;
/* Cosine: the wall of an stub faces away from where its plane meets its axis. That of a thin vessel
 * close to it may not, where the stub's term is the larger one. */
static const double least_outward = 0.25;

/* Newton's steps of a point from a triangle to the wall. */
enum { WALL_STEPS = 4 };

typedef struct Cut {
    PlaneCutter *cutter;
    const Octree *tree;
    const JunctionField *field;
    Patch *patch;
    BranchStub *stubs;
    size_t n_stubs;
    size_t n_whole; /* triangles before any is cut */
} Cut;

void planecutter_release(PlaneCutter *cutter)
{
    keymap_release(&cutter->crossings);
    free(cutter->behind);
    free(cutter->renamed);
    free(cutter->near);
    free(cutter->stubs);
    *cutter = (PlaneCutter){0};
}

/* How far a point lies beyond the plane of its stub, mm; -HUGE_VAL when it is on no stub's tube. */
static double along_tube(const Cut *cut, const PatchPoint *point)
{
    if (point->tube == NO_STUB)
        return -HUGE_VAL;
    const BranchStub *stub = &cut->stubs[point->tube];
    Vec3 from = vec3_sub(point->x, stub->at);
    double along = vec3_dot(from, stub->outward), reach = tube_reach * stub->radius_mm;
    double from2 = vec3_dot(from, from), across2 = from2 - along * along;
    if (across2 > reach * reach || along > (STUB_TAIL + 1) * stub->radius_mm ||
        vec3_dot(from, point->normal) < least_outward * sqrt(from2))
        return -HUGE_VAL;
    return along;
}

static int compare_places(const void *a, const void *b)
{
    const PlaneOffset *one = a, *other = b;
    return one->stub != other->stub ? (one->stub > other->stub) - (one->stub < other->stub)
                                    : (one->along > other->along) - (one->along < other->along);
}

/* Moves the plane into the middle of the widest gap between places, of which there are two at
 * least. */
static void move_plane(BranchStub *stub, const PlaneOffset *places, size_t n)
{
    size_t widest = 0;
    for (size_t i = 1; i + 1 < n; i++)
        if (places[i + 1].along - places[i].along > places[widest + 1].along - places[widest].along)
            widest = i;
    double by = 0.5 * (places[widest].along + places[widest + 1].along);
    stub->at = vec3_add_scaled(stub->at, stub->outward, by);
}

/* How far the plane of an stub may be moved, mm. */
static double room_of(const BranchStub *stub, double ratio)
{
    return fmin(0.25 * ratio, stub->is_close ? CLOSE_MOVE : PLANE_MOVE) * stub->radius_mm;
}

/* Moves each plane into the widest gap between points near it. */
static Status move_planes(const Cut *cut, double ratio, Err *err)
{
    PlaneCutter *cutter = cut->cutter;
    size_t n = 0;
    TRY(mem_reserve(&cutter->near, &cutter->near_capacity, cut->patch->n_points + 2 * cut->n_stubs,
                    sizeof *cutter->near, "points of a junction", err));
    for (size_t k = 0; k < cut->n_stubs; k++)
        for (int side = -1; side < 2; side += 2)
            cutter->near[n++] = (PlaneOffset){(uint16_t)k, side * room_of(&cut->stubs[k], ratio)};
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        double along = along_tube(cut, point);
        if (point->tube != NO_STUB && fabs(along) < room_of(&cut->stubs[point->tube], ratio))
            cutter->near[n++] = (PlaneOffset){point->tube, along};
    }
    qsort(cutter->near, n, sizeof *cutter->near, compare_places);
    for (size_t from = 0, to = 0; from < n; from = to) {
        while (to < n && cutter->near[to].stub == cutter->near[from].stub)
            to++;
        move_plane(&cut->stubs[cutter->near[from].stub], &cutter->near[from], to - from);
    }
    return STATUS_OK;
}

static void mark_behind(const Cut *cut)
{
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        cut->cutter->behind[i] = along_tube(cut, point) > 0 ? point->tube : NO_STUB;
    }
}

/* Moves a point of a rim that is no circle onto the wall, in the plane, towards the axis or away
 * from it: by Newton's steps. */
static void move_to_surface(const Cut *cut, const BranchStub *stub, Vec3 away, PatchPoint *point)
{
    const OctreeCell *cell = octree_leaf(cut->tree, point->x);
    if (!cell || cell->state != CELL_ACTIVE)
        return;
    for (int i = 0; i < WALL_STEPS; i++) {
        Vec3 gradient;
        FieldValue value =
            localfield_gradient(cut->field, &cut->tree->kept, &cell->part, point->x, &gradient);
        double slope = vec3_dot(gradient, away), most = 0.1 * stub->radius_mm;
        double by = (FIELD_LEVEL - value.phi) / slope;
        if (!(slope < 0) || !(fabs(by) < most))
            return;
        point->x = vec3_add_scaled(point->x, away, by);
        point->normal = vec3_scale(gradient, -1 / vec3_length(gradient));
    }
}

/* The point on the rim between one before the plane and one behind it. */
static Status rim_point(const Cut *cut, uint32_t before, uint32_t behind, uint32_t *number,
                        Err *err)
{
    uint32_t *place;
    bool is_new;
    TRY(keymap_put(&cut->cutter->crossings, key_of_pair(before, behind), &place, &is_new, err));
    if (is_new) {
        uint16_t stub_index = cut->cutter->behind[behind];
        const BranchStub *stub = &cut->stubs[stub_index];
        Vec3 a = cut->patch->points[before].x, b = cut->patch->points[behind].x;
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
                            .tube = stub_index,
                            .stub = stub_index};
        if (stub->is_close) {
            point.x = vec3_add(stub->at, across);
            move_to_surface(cut, stub, normal, &point);
        }
        TRY(patch_add_point(cut->patch, point, place, err));
    }
    *number = *place;
    return STATUS_OK;
}

/* The part of a triangle before the plane; its corner `lone` stands alone on its side. */
static Status add_part(const Cut *cut, Triangle triangle, int lone, bool lone_is_before, Err *err)
{
    uint32_t a = triangle.at[lone], b = triangle.at[(lone + 1) % 3],
             c = triangle.at[(lone + 2) % 3];
    uint32_t ab, ac;
    if (lone_is_before) {
        TRY(rim_point(cut, a, b, &ab, err));
        TRY(rim_point(cut, a, c, &ac, err));
        return patch_add_triangle(cut->patch, (Triangle){{a, ab, ac}}, err);
    }
    TRY(rim_point(cut, b, a, &ab, err));
    TRY(rim_point(cut, c, a, &ac, err));
    const PatchPoint *points = cut->patch->points;
    bool shorter =
        vec3_distance(points[b].x, points[ac].x) < vec3_distance(points[c].x, points[ab].x);
    TRY(patch_add_triangle(cut->patch, (Triangle){{b, c, shorter ? ac : ab}}, err));
    return patch_add_triangle(cut->patch,
                              shorter ? (Triangle){{b, ac, ab}} : (Triangle){{c, ac, ab}}, err);
}

/* Leaves out triangles behind a plane, and cuts those that it crosses. */
static Status cut_triangle(const Cut *cut, size_t i, bool *sound, Err *err)
{
    const Triangle triangle = cut->patch->triangles[i];
    int n_behind = 0, lone = 0;
    uint16_t stub = NO_STUB;
    for (int k = 0; k < 3; k++) {
        uint16_t behind = cut->cutter->behind[triangle.at[k]];
        n_behind += behind != NO_STUB;
        *sound = *sound && (behind == NO_STUB || stub == NO_STUB || behind == stub);
        stub = behind != NO_STUB ? behind : stub;
    }
    if (n_behind == 0)
        return STATUS_OK;
    cut->patch->triangles[i].at[0] = UINT32_MAX;
    if (n_behind == 3)
        return STATUS_OK;
    for (int k = 0; k < 3; k++)
        if ((cut->cutter->behind[triangle.at[k]] != NO_STUB) == (n_behind == 1))
            lone = k;
    return add_part(cut, triangle, lone, n_behind == 2, err);
}

Status planecut_apply(PlaneCutter *cutter, const JunctionPlan *plan, const Octree *tree,
                      double ratio, Patch *patch, bool *sound, Err *err)
{
    *sound = true;
    TRY(mem_reserve(&cutter->stubs, &cutter->stub_capacity, plan->n_stubs, sizeof *cutter->stubs,
                    "stubs", err));
    for (size_t k = 0; k < plan->n_stubs; k++)
        cutter->stubs[k] = plan->stubs[k];
    Cut cut = {cutter, tree, &plan->field, patch, cutter->stubs, plan->n_stubs, patch->n_triangles};
    TRY(keymap_begin(&cutter->crossings, 0, "points of a junction", err));
    TRY(mem_reserve(&cutter->behind, &cutter->behind_capacity, patch->n_points,
                    sizeof *cutter->behind, "points of a junction", err));
    TRY(move_planes(&cut, ratio, err));
    mark_behind(&cut);
    for (size_t i = 0; i < cut.n_whole; i++)
        TRY(cut_triangle(&cut, i, sound, err));
    TRY(mem_reserve(&cutter->renamed, &cutter->renamed_capacity, patch->n_points,
                    sizeof *cutter->renamed, "points of a junction", err));
    patch_compact(patch, cutter->renamed);
    return STATUS_OK;
}
