/* A plane is put into the widest gap between the points near it, so that no sliver is cut off. What
 * is on an arm's tube and beyond its plane is behind; each edge from before to behind gets
 * one point, found by the lattice's straight line and put on the circle. */
#include "surface/mesh/planecut.h"

#include <stdlib.h>

/* How far the wall of an arm may be from its axis, in radii. */
static const double tube_reach = 1.1;

typedef struct Cut {
    PlaneCutter *cutter;
    Patch *patch;
    Arm *arms;
    size_t n_arms;
    size_t n_whole; /* triangles before any is cut */
} Cut;

void planecutter_release(PlaneCutter *cutter)
{
    pairtable_release(&cutter->crossings);
    free(cutter->behind);
    free(cutter->renamed);
    free(cutter->near);
    *cutter = (PlaneCutter){0};
}

/* How far a point lies beyond the plane of its arm, mm; -HUGE_VAL when it is on no arm's tube. */
static double along_tube(const Cut *cut, const PatchPoint *point)
{
    if (point->tube == NO_ARM)
        return -HUGE_VAL;
    const Arm *arm = &cut->arms[point->tube];
    Vec3 from = vec3_sub(point->x, arm->at);
    double along = vec3_dot(from, arm->outward), reach = tube_reach * arm->radius_mm;
    double across2 = vec3_dot(from, from) - along * along;
    if (across2 > reach * reach || along > (ARM_TAIL + 1) * arm->radius_mm)
        return -HUGE_VAL;
    return along;
}

static int compare_places(const void *a, const void *b)
{
    const PlaneNear *one = a, *other = b;
    return one->arm != other->arm ? (one->arm > other->arm) - (one->arm < other->arm)
                                  : (one->along > other->along) - (one->along < other->along);
}

/* Moves the plane into the middle of the widest gap between places, of which there are two at
 * least. */
static void move_plane(Arm *arm, const PlaneNear *places, size_t n)
{
    size_t widest = 0;
    for (size_t i = 1; i + 1 < n; i++)
        if (places[i + 1].along - places[i].along > places[widest + 1].along - places[widest].along)
            widest = i;
    double by = 0.5 * (places[widest].along + places[widest + 1].along);
    arm->at = vec3_add_scaled(arm->at, arm->outward, by);
}

/* Moves each plane into the widest gap between points within `room` radii of it. */
static Status move_planes(const Cut *cut, double room, Err *err)
{
    PlaneCutter *cutter = cut->cutter;
    size_t n = 0;
    TRY(mem_reserve(&cutter->near, &cutter->near_capacity, cut->patch->n_points + 2 * cut->n_arms,
                    sizeof *cutter->near, "points of a junction", err));
    for (size_t k = 0; k < cut->n_arms; k++)
        for (int side = -1; side < 2; side += 2)
            cutter->near[n++] = (PlaneNear){(uint16_t)k, side * room * cut->arms[k].radius_mm};
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        double along = along_tube(cut, point);
        if (point->tube != NO_ARM && fabs(along) < room * cut->arms[point->tube].radius_mm)
            cutter->near[n++] = (PlaneNear){point->tube, along};
    }
    qsort(cutter->near, n, sizeof *cutter->near, compare_places);
    for (size_t from = 0, to = 0; from < n; from = to) {
        while (to < n && cutter->near[to].arm == cutter->near[from].arm)
            to++;
        move_plane(&cut->arms[cutter->near[from].arm], &cutter->near[from], to - from);
    }
    return STATUS_OK;
}

static void mark_behind(const Cut *cut)
{
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        cut->cutter->behind[i] = along_tube(cut, point) > 0 ? point->tube : NO_ARM;
    }
}

/* The point on the rim between one before the plane and one behind it. */
static Status rim_point(const Cut *cut, uint32_t before, uint32_t behind, uint32_t *number,
                        Err *err)
{
    uint32_t *place;
    bool is_new;
    TRY(pairtable_place(&cut->cutter->crossings, pair_key(before, behind), &place, &is_new, err));
    if (is_new) {
        uint16_t arm_number = cut->cutter->behind[behind];
        const Arm *arm = &cut->arms[arm_number];
        Vec3 a = cut->patch->points[before].x, b = cut->patch->points[behind].x;
        double from = vec3_dot(vec3_sub(a, arm->at), arm->outward);
        double to = vec3_dot(vec3_sub(b, arm->at), arm->outward);
        Vec3 x = vec3_add_scaled(a, vec3_sub(b, a), from / (from - to));
        Vec3 across = vec3_sub(x, arm->at);
        across = vec3_add_scaled(across, arm->outward, -vec3_dot(across, arm->outward));
        Vec3 normal = vec3_normalized(across);
        PatchPoint point = {.x = vec3_add_scaled(arm->at, normal, arm->radius_mm),
                            .normal = normal,
                            .radius_mm = arm->radius_mm,
                            .segment = arm->segment,
                            .tube = arm_number,
                            .arm = arm_number};
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
    uint16_t arm = NO_ARM;
    for (int k = 0; k < 3; k++) {
        uint16_t behind = cut->cutter->behind[triangle.at[k]];
        n_behind += behind != NO_ARM;
        *sound = *sound && (behind == NO_ARM || arm == NO_ARM || behind == arm);
        arm = behind != NO_ARM ? behind : arm;
    }
    if (n_behind == 0)
        return STATUS_OK;
    cut->patch->triangles[i].at[0] = UINT32_MAX;
    if (n_behind == 3)
        return STATUS_OK;
    for (int k = 0; k < 3; k++)
        if ((cut->cutter->behind[triangle.at[k]] != NO_ARM) == (n_behind == 1))
            lone = k;
    return add_part(cut, triangle, lone, n_behind == 2, err);
}

Status planecut_make(PlaneCutter *cutter, const ZonePlan *plan, double ratio, Patch *patch,
                     bool *sound, Err *err)
{
    Cut cut = {cutter, patch, plan->arms, plan->n_arms, patch->n_triangles};
    *sound = true;
    TRY(pairtable_begin(&cutter->crossings, 0, err));
    TRY(mem_reserve(&cutter->behind, &cutter->behind_capacity, patch->n_points,
                    sizeof *cutter->behind, "points of a junction", err));
    TRY(move_planes(&cut, 0.25 * ratio, err));
    mark_behind(&cut);
    for (size_t i = 0; i < cut.n_whole; i++)
        TRY(cut_triangle(&cut, i, sound, err));
    TRY(mem_reserve(&cutter->renamed, &cutter->renamed_capacity, patch->n_points,
                    sizeof *cutter->renamed, "points of a junction", err));
    patch_compact(patch, cutter->renamed);
    return STATUS_OK;
}
