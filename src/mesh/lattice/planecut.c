/* A plane is put into the widest gap between the points near it, so that no sliver is cut off. What
 * is on an arm's tube and beyond its plane is behind; each edge from before to behind gets
 * one point, found by the lattice's straight line and put on the circle, or on the wall. */
#include "mesh/lattice/planecut.h"

#include <stdlib.h>

/* How far the wall of an arm may be from its axis, in radii. */
static const double tube_reach = 1.1;
/* Cosine: the wall of an arm faces away from where its plane meets its axis. That of a thin vessel
 * close to it may not, where the arm's term is the larger one. */
static const double least_outward = 0.25;

/* Newton's steps of a point from a triangle to the wall. */
enum { WALL_STEPS = 4 };

typedef struct Cut {
    PlaneCutter *cutter;
    const ZoneTree *tree;
    const ZoneField *field;
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
    free(cutter->arms);
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
    double from2 = vec3_dot(from, from), across2 = from2 - along * along;
    if (across2 > reach * reach || along > (ARM_TAIL + 1) * arm->radius_mm ||
        vec3_dot(from, point->normal) < least_outward * sqrt(from2))
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

/* How far the plane of an arm may be moved, mm. */
static double room_of(const Arm *arm, double ratio)
{
    return fmin(0.25 * ratio, arm->is_close ? CLOSE_MOVE : PLANE_MOVE) * arm->radius_mm;
}

/* Moves each plane into the widest gap between points near it. */
static Status move_planes(const Cut *cut, double ratio, Err *err)
{
    PlaneCutter *cutter = cut->cutter;
    size_t n = 0;
    TRY(mem_reserve(&cutter->near, &cutter->near_capacity, cut->patch->n_points + 2 * cut->n_arms,
                    sizeof *cutter->near, "points of a junction", err));
    for (size_t k = 0; k < cut->n_arms; k++)
        for (int side = -1; side < 2; side += 2)
            cutter->near[n++] = (PlaneNear){(uint16_t)k, side * room_of(&cut->arms[k], ratio)};
    for (size_t i = 0; i < cut->patch->n_points; i++) {
        const PatchPoint *point = &cut->patch->points[i];
        double along = along_tube(cut, point);
        if (point->tube != NO_ARM && fabs(along) < room_of(&cut->arms[point->tube], ratio))
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

/* Moves a point of a rim that is no circle onto the wall, in the plane, towards the axis or away
 * from it: by Newton's steps. */
static void reach_wall(const Cut *cut, const Arm *arm, Vec3 away, PatchPoint *point)
{
    const ZoneCell *cell = zonetree_leaf(cut->tree, point->x);
    if (!cell || cell->state != CELL_ACTIVE)
        return;
    for (int i = 0; i < WALL_STEPS; i++) {
        Vec3 gradient;
        FieldValue value =
            fieldpart_gradient(cut->field, &cut->tree->kept, &cell->part, point->x, &gradient);
        double slope = vec3_dot(gradient, away), most = 0.1 * arm->radius_mm;
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
        if (arm->is_close) {
            point.x = vec3_add(arm->at, across);
            reach_wall(cut, arm, normal, &point);
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

Status planecut_make(PlaneCutter *cutter, const ZonePlan *plan, const ZoneTree *tree, double ratio,
                     Patch *patch, bool *sound, Err *err)
{
    *sound = true;
    TRY(mem_reserve(&cutter->arms, &cutter->arm_capacity, plan->n_arms, sizeof *cutter->arms,
                    "arms", err));
    for (size_t k = 0; k < plan->n_arms; k++)
        cutter->arms[k] = plan->arms[k];
    Cut cut = {cutter, tree, &plan->field, patch, cutter->arms, plan->n_arms, patch->n_triangles};
    TRY(pairtable_begin(&cutter->crossings, 0, err));
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
