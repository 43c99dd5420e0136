/* Lattice, cut, collapse, split, and then the proof: every edge has two triangles, one each way, or
 * lies on a rim; the rims are one closed way for each stub, which goes about its axis once; the
 * piece is connected; and points - edges + triangles = 2 - stubs, that of a sphere with a
 * hole for each stub. */
#include "mesh/junctionmesh.h"

#include "mesh/patchcross.h"
#include "mesh/precision.h"
#include "mesh/zones/nearpairs.h"
#include <stdlib.h>

#define NONE UINT32_MAX

enum { MOST_REPEATS = 7, MOST_NEARER = 3 };
static const double finer = 0.85, least_part = 0.5;
/* Over the radius: triangles so far off are none of the wall, as where vessels overlap. */
static const double farthest_off = 0.5;
/* Over the radius of the thinner: gaps that cells may be too wide for. */
static const double narrow_gap = 0.3;
/* Over the usual cell: a hole that is no flaw of the lattice. Where vessels do not blend, cells are
 * a sixth of that. */
static const double wide_hole = 0.25;
/* Over the radius: a tunnel up to so wide is stopped up yet, where finer cells leave it that part
 * of its width: it is the wall's own, as where a twig blends with its trunk again. */
static const double most_stopped = 0.1, lasting = 0.9;

typedef struct Maker {
    JunctionWorkspace *worker;
    const VesselTree *tree;
    const JunctionPlan *plan;
    JunctionMesh *piece;
    PatchCrossing *crossing; /* of the last attempt */
    Err *err;
} Maker;

void junctionmesh_release(JunctionMesh *piece)
{
    free(piece->points);
    free(piece->triangles);
    free(piece->rims);
    free(piece->rim_points);
    *piece = (JunctionMesh){0};
}

void junctionworkspace_release(JunctionWorkspace *worker)
{
    octree_release(&worker->tree);
    lattice_release(&worker->lattice);
    repairer_release(&worker->repairer);
    planecutter_release(&worker->cutter);
    collapser_release(&worker->collapser);
    refiner_release(&worker->refiner);
    keymap_release(&worker->edges);
    patch_release(&worker->patch);
    free(worker->next);
    free(worker->order);
    *worker = (JunctionWorkspace){0};
}

/* Fills next[] with the next point along a rim, NONE off the rims. False when an edge has two
 * triangles on one side, or is open off the rims. */
static Status follow_edges(const Maker *maker, size_t *n_edges, bool *sound)
{
    JunctionWorkspace *worker = maker->worker;
    const Patch *patch = &worker->patch;
    TRY(mem_reserve(&worker->next, &worker->next_capacity, patch->n_points, sizeof *worker->next,
                    "points of a junction", maker->err));
    size_t corners = 3 * patch->n_triangles, open = 0;
    TRY(keymap_begin(&worker->edges, corners, "points of a junction", maker->err));
    *sound = true;
    for (size_t i = 0; i < corners; i++) {
        const uint32_t *at = patch->triangles[i / 3].at;
        uint32_t *place;
        bool is_new;
        uint64_t key = (uint64_t)at[i % 3] << 32 | at[(i + 1) % 3];
        TRY(keymap_put(&worker->edges, key, &place, &is_new, maker->err));
        *sound = *sound && is_new;
    }
    for (size_t i = 0; i < patch->n_points; i++)
        worker->next[i] = NONE;
    for (size_t i = 0; i < corners; i++) {
        const uint32_t *at = patch->triangles[i / 3].at;
        uint32_t a = at[i % 3], b = at[(i + 1) % 3];
        if (keymap_find(&worker->edges, (uint64_t)b << 32 | a))
            continue;
        open++;
        *sound = *sound && patch->points[a].stub != NO_STUB &&
                 patch->points[a].stub == patch->points[b].stub && worker->next[a] == NONE;
        worker->next[a] = b;
    }
    *n_edges = (corners + open) / 2;
    return STATUS_OK;
}

static double angle_of(const FieldSegment *segment, Vec3 x)
{
    Vec3 u, v, from = vec3_sub(x, segment->a);
    vec3_across(vec3_normalized(vec3_sub(segment->b, segment->a)), &u, &v);
    return elementary_atan2(vec3_dot(from, v), vec3_dot(from, u));
}

/* Puts the rim of an stub into the piece. The wall's own edges go about the axis one way at one end
 * of the segment, the other way at the other. False when the rim does not go about it once. */
static bool add_rim(const Maker *maker, size_t stub_index, uint32_t *n_points)
{
    const BranchStub *stub = &maker->plan->stubs[stub_index];
    const Patch *patch = &maker->worker->patch;
    const FieldSegment *segment = &maker->tree->segments[stub->segment];
    uint32_t start = NONE, total = 0, n = 0;
    double lowest = HUGE_VAL;
    for (uint32_t i = 0; i < patch->n_points; i++) {
        if (patch->points[i].stub != stub_index)
            continue;
        double angle = angle_of(segment, patch->points[i].x);
        total++;
        if (angle < lowest) {
            lowest = angle;
            start = i;
        }
    }
    uint32_t *rim = &maker->piece->rim_points[*n_points], at = start;
    for (; at != NONE && n < total; n++, at = maker->worker->next[at])
        rim[n == 0 || stub->end == 1 ? n : total - n] = at;
    for (uint32_t i = 1; i < n; i++)
        if (!(angle_of(segment, patch->points[rim[i]].x) >
              angle_of(segment, patch->points[rim[i - 1]].x)))
            return false;
    maker->piece->rims[stub_index] = (Rim){stub->segment, stub->end, *n_points, total};
    *n_points += total;
    return total >= 3 && n == total && at == start;
}

/* Proves the worker's patch, and finds the piece's rims. */
static Status prove(const Maker *maker, bool *sound)
{
    const Patch *patch = &maker->worker->patch;
    JunctionMesh *piece = maker->piece;
    size_t n_edges, n_stubs = maker->plan->n_stubs, n_on_rims = 0;
    uint32_t n_points = 0;
    TRY(follow_edges(maker, &n_edges, sound));
    long long euler =
        (long long)patch->n_points - (long long)n_edges + (long long)patch->n_triangles;
    *sound = *sound && patch->n_triangles > 0 && euler == 2 - (long long)n_stubs;
    if (!*sound)
        return STATUS_OK;
    for (size_t i = 0; i < patch->n_points; i++)
        n_on_rims += patch->points[i].stub != NO_STUB;
    TRY(mem_calloc(&piece->rims, n_stubs, sizeof *piece->rims, "rims", maker->err));
    TRY(mem_calloc(&piece->rim_points, n_on_rims + 1, sizeof *piece->rim_points, "rims",
                   maker->err));
    piece->n_rims = n_stubs;
    for (size_t k = 0; k < n_stubs && *sound; k++)
        *sound = add_rim(maker, k, &n_points);
    size_t parts;
    TRY(patch_count_parts(&maker->worker->patch, &parts, maker->err));
    *sound = *sound && parts == 1;
    return STATUS_OK;
}

/* Whether a point lies in an stub, which the field of the junction has only a part of. */
static bool is_in_stub(const Maker *maker, Vec3 x)
{
    for (size_t k = 0; k < maker->plan->n_stubs; k++) {
        const FieldSegment *stub = &maker->tree->segments[maker->plan->stubs[k].segment];
        if (segment_distance_to(stub, x) < stub->radius_mm)
            return true;
    }
    return false;
}

/* Whether the wall about a segment, where its own term is the largest, has a point at all; then
 * *at is one. */
static bool find_own_wall(const Maker *maker, const LocalField *all, uint32_t number, Vec3 *at)
{
    enum { PLACES = 5, ANGLES = 8 };
    const JunctionPlan *plan = maker->plan;
    const Octree *tree = &maker->worker->tree;
    const FieldSegment *segment = &maker->tree->segments[number];
    Vec3 u, v, axis = vec3_sub(segment->b, segment->a);
    vec3_across(vec3_normalized(axis), &u, &v);
    for (int i = 0; i < PLACES * ANGLES; i++) {
        double angle = FULL_TURN / ANGLES * (i % ANGLES);
        Vec3 from = vec3_add_scaled(segment->a, axis, (0.5 + i / ANGLES) / PLACES);
        Vec3 way = vec3_add(vec3_scale(u, elementary_cos(angle)),
                            vec3_scale(v, elementary_sin(angle))),
             gradient;
        double low = 0, high = 2.5 * segment->radius_mm;
        if (localfield_value(&plan->field, &tree->stack, all, from).phi < FIELD_LEVEL)
            continue;
        for (int k = 0; k < 40; k++) {
            double middle = 0.5 * (low + high);
            Vec3 x = vec3_add_scaled(from, way, middle);
            bool inside = localfield_value(&plan->field, &tree->stack, all, x).phi >= FIELD_LEVEL;
            *(inside ? &low : &high) = middle;
        }
        *at = vec3_add_scaled(from, way, low);
        FieldValue value = localfield_gradient(&plan->field, &tree->stack, all, *at, &gradient);
        if (plan->field.terms[value.largest_term].segment == number && !is_in_stub(maker, *at))
            return true;
    }
    return false;
}

/* The status of a segment that lies wholly in the junction and that no point of the patch is
 * nearest to. */
static Status look_for(const Maker *maker, uint32_t number, double ratio, uint8_t *status)
{
    const Patch *patch = &maker->worker->patch;
    const FieldSegment *segment = &maker->tree->segments[number];
    Octree *tree = &maker->worker->tree;
    LocalField all, near;
    FieldBounds bounds;
    Vec3 at, middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
    double reach = vec3_distance(segment->a, middle) + 3 * segment->radius_mm;
    TRY(localfield_all(&maker->plan->field, &tree->stack, &all, maker->err));
    TRY(localfield_narrow(&maker->plan->field, &tree->stack, &all, middle, reach, 0, &near, &bounds,
                          maker->err));
    *status = SEGMENT_ENCLOSED;
    if (near.n_terms <= MAX_LOCAL_TERMS && find_own_wall(maker, &near, number, &at)) {
        double nearest = HUGE_VAL;
        for (size_t i = 0; i < patch->n_points; i++)
            nearest = fmin(nearest, vec3_distance(patch->points[i].x, at));
        *status = nearest <= ratio * segment->radius_mm ? SEGMENT_PRESENT : SEGMENT_MISSING;
    }
    tree->stack.n_terms = tree->stack.n_groups = 0;
    return STATUS_OK;
}

static bool is_stub(const JunctionPlan *plan, uint32_t segment)
{
    for (size_t k = 0; k < plan->n_stubs; k++)
        if (plan->stubs[k].segment == segment)
            return true;
    return false;
}

/* Arms are present when their tubes are. */
static Status find_statuses(const Maker *maker, double ratio, uint8_t *segment_status)
{
    const Patch *patch = &maker->worker->patch;
    const JunctionField *field = &maker->plan->field;
    for (uint32_t i = 0; i < field->n_terms; i++)
        if (!is_stub(maker->plan, field->terms[i].segment))
            segment_status[field->terms[i].segment] = SEGMENT_MISSING;
    for (size_t i = 0; i < patch->n_points; i++)
        if (segment_status[patch->points[i].segment] == SEGMENT_MISSING &&
            !is_stub(maker->plan, patch->points[i].segment))
            segment_status[patch->points[i].segment] = SEGMENT_PRESENT;
    for (uint32_t i = 0; i < field->n_terms; i++) {
        uint32_t segment = field->terms[i].segment;
        if (!is_stub(maker->plan, segment) && segment_status[segment] == SEGMENT_MISSING)
            TRY(look_for(maker, segment, ratio, &segment_status[segment]));
    }
    return STATUS_OK;
}

/* Makes what the lattice has left into a piece. */
static Status finish(const Maker *maker, const MeshFineness *fineness, uint8_t *segment_status,
                     bool *sound)
{
    JunctionWorkspace *worker = maker->worker;
    TRY(planecut_apply(&worker->cutter, maker->plan, &worker->tree, fineness->cells.ratio,
                       &worker->patch, sound, maker->err));
    if (!*sound)
        return STATUS_OK;
    TRY(patch_keep_largest(&worker->patch, maker->err));
    TRY(find_statuses(maker, fineness->cells.ratio, segment_status));
    TRY(collapse_apply(&worker->collapser, &worker->patch, fineness->sagitta, maker->err));
    maker->piece->off = (MeshOff){0};
    size_t n_points = worker->patch.n_points;
    TRY(facerefine_apply(&worker->refiner, maker->plan, &worker->tree, fineness->split,
                         &worker->patch, &maker->piece->off, maker->err));
    TRY(prove(maker, sound));
    *maker->crossing = PATCHCROSS_NONE;
    if (*sound && worker->patch.n_points > n_points)
        TRY(patchcross_find(&worker->patch, n_points, fineness->grid_mm, maker->crossing,
                            maker->err));
    *sound = *sound && *maker->crossing == PATCHCROSS_NONE;
    return STATUS_OK;
}

/* One attempt; *hole is how wide a tunnel is that makes the wall unsound, over the local radius. */
static Status attempt(const Maker *maker, const MeshFineness *fineness, uint8_t *segment_status,
                      bool *sound, double *hole)
{
    JunctionWorkspace *worker = maker->worker;
    *hole = 0;
    TRY(octree_build(&worker->tree, maker->plan, &fineness->cells, maker->err));
    TRY(lattice_make(&worker->lattice, &worker->tree, maker->plan, &worker->patch, maker->err));
    TRY(finish(maker, fineness, segment_status, sound));
    if (*sound || *maker->crossing == PATCHCROSS_ROUNDING)
        return STATUS_OK;
    TRY(repair_apply(&worker->repairer, &worker->lattice, &worker->tree, maker->plan,
                     fineness->farthest, &worker->patch, hole, maker->err));
    return *hole <= fineness->farthest ? finish(maker, fineness, segment_status, sound) : STATUS_OK;
}

static bool is_member(const JunctionField *field, uint32_t group, uint32_t term)
{
    for (uint32_t i = field->first[group]; i < field->first[group + 1]; i++)
        if (field->members[i] == term)
            return true;
    return false;
}

/* The gap between the walls of the two segments of the junction that blend nowhere and are the
 * nearest to each other, over the radius of the thinner. */
static double find_gap(const Maker *maker, uint32_t pair[2])
{
    const JunctionField *field = &maker->plan->field;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < field->n_terms; i++)
        for (uint32_t k = i + 1; k < field->n_terms; k++) {
            const FieldSegment *one = &maker->tree->segments[field->terms[i].segment];
            const FieldSegment *other = &maker->tree->segments[field->terms[k].segment];
            double gap = segments_distance(one, other) - one->radius_mm - other->radius_mm;
            bool blend = false;
            gap /= fmin(one->radius_mm, other->radius_mm);
            for (uint32_t g = 0; g < field->n_groups && gap < least && !blend; g++)
                blend = is_member(field, g, i) && is_member(field, g, k);
            if (gap >= least || blend)
                continue;
            least = gap;
            pair[0] = field->terms[i].segment;
            pair[1] = field->terms[k].segment;
        }
    return least;
}

/* Two zero bits after each of the lowest ten. */
static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x30000ff;
    x = (x | x << 8) & 0x300f00f;
    x = (x | x << 4) & 0x30c30c3;
    return (x | x << 2) & 0x9249249;
}

static int compare_placed(const void *a, const void *b)
{
    const PlacedTriangle *one = a, *other = b;
    uint32_t x = one->code, y = other->code;
    return x != y ? (x > y) - (x < y)
                  : (one->number > other->number) - (one->number < other->number);
}

/* The triangles by the Morton codes of their first points, so that those next to each other in
 * memory are so in space. */
static Status order_triangles(JunctionWorkspace *worker, Err *err)
{
    const Patch *patch = &worker->patch;
    const Octree *tree = &worker->tree;
    TRY(mem_reserve(&worker->order, &worker->order_capacity, patch->n_triangles,
                    sizeof *worker->order, "triangles of a junction", err));
    for (uint32_t i = 0; i < patch->n_triangles; i++) {
        Vec3 from = vec3_sub(patch->points[patch->triangles[i].at[0]].x, tree->corner);
        uint32_t code = 0;
        for (int axis = 0; axis < 3; axis++) {
            double part = vec3_component(from, axis) / tree->side;
            code |= spread((uint32_t)(1023 * fmin(fmax(part, 0), 1))) << axis;
        }
        worker->order[i] = (PlacedTriangle){code, i};
    }
    qsort(worker->order, patch->n_triangles, sizeof *worker->order, compare_placed);
    return STATUS_OK;
}

static JunctionPoint rounded_point(const PatchPoint *point, double grid)
{
    JunctionPoint kept = {.segment = point->segment};
    for (int axis = 0; axis < 3; axis++) {
        kept.x[axis] = patch_rounded(vec3_component(point->x, axis), grid);
        kept.normal[axis] = (float)vec3_component(point->normal, axis);
    }
    return kept;
}

/* The worker's patch, in as little room as it takes. */
static Status keep_patch(JunctionWorkspace *worker, double grid, JunctionMesh *piece, Err *err)
{
    const Patch *patch = &worker->patch;
    TRY(order_triangles(worker, err));
    TRY(mem_calloc(&piece->points, patch->n_points, sizeof *piece->points, "points", err));
    TRY(mem_calloc(&piece->triangles, patch->n_triangles, sizeof *piece->triangles, "triangles",
                   err));
    for (size_t i = 0; i < patch->n_points; i++)
        piece->points[piece->n_points++] = rounded_point(&patch->points[i], grid);
    for (size_t i = 0; i < patch->n_triangles; i++)
        piece->triangles[piece->n_triangles++] = patch->triangles[worker->order[i].number];
    return STATUS_OK;
}

static Status refuse(const Maker *maker, double grid_mm, Err *err)
{
    const uint32_t *ids = maker->tree->ids;
    uint32_t pair[2], first = maker->plan->field.terms[0].segment;
    if (*maker->crossing == PATCHCROSS_ROUNDING)
        return reach_refuse(maker->tree, first, grid_mm, err);
    if (maker->worker->patch.n_triangles == 0)
        return err_set(err, STATUS_INFEASIBLE,
                       "segment %u, and what it meets, is so short for its radius that it has no "
                       "surface",
                       ids[maker->plan->field.terms[0].segment]);
    if (find_gap(maker, pair) < 0)
        return err_set(err, STATUS_INFEASIBLE,
                       "the vessels of segments %u and %u overlap, though they do not meet there, "
                       "so that their wall is no tube",
                       ids[pair[0]], ids[pair[1]]);
    return err_set(err, STATUS_INFEASIBLE,
                   "the vessels about segment %u run into each other: they make a loop, or cells "
                   "as fine as are tried do not show their wall to be without one",
                   ids[maker->plan->field.terms[0].segment]);
}

/* Whether a tunnel, as wide as it was with wider cells, is one of the wall itself, and may be
 * stopped up: not where vessels overlap that do not blend. */
static bool is_own_tunnel(const Maker *maker, double hole, double before)
{
    uint32_t pair[2];
    return hole > lasting * before && hole <= most_stopped && find_gap(maker, pair) >= 0;
}

static void make_finer(MeshFineness *fineness, double factor)
{
    fineness->cells.ratio *= factor;
    fineness->cells.bending *= factor * factor;
}

/* How many steps finer the cells of the next attempt are; 0: none would help. A wide hole is there
 * for good, unless it is closed by a gap that cells are too wide for. So is any hole that finer
 * cells have left as wide, where vessels overlap that do not blend, and crossings that only the
 * rounding of points makes: the smaller the triangles, the more of them. */
static int steps_finer(const Maker *maker, double hole, double before, double cell, int left)
{
    uint32_t pair[2];
    bool is_wide = hole > wide_hole * cell;
    if (*maker->crossing == PATCHCROSS_ROUNDING)
        return 0;
    if (left == 0 || (!is_wide && hole <= lasting * before))
        return left > 0;
    double gap = find_gap(maker, pair);
    if (!is_wide)
        return gap >= 0;
    return gap >= 0 && gap < narrow_gap ? left : 0;
}

/* Attempts with finer and finer cells until the wall is sound or none would help; *used are those
 * of the last one. */
static Status make_sound(const Maker *maker, MeshFineness *used, uint8_t *segment_status,
                         bool *sound)
{
    double hole, before = HUGE_VAL;
    for (int steps = 1; steps; maker->piece->repeats += steps) {
        int repeats = maker->piece->repeats;
        junctionmesh_release(maker->piece);
        maker->piece->repeats = repeats;
        TRY(attempt(maker, used, segment_status, sound, &hole));
        steps = *sound
                    ? 0
                    : steps_finer(maker, hole, before, used->cells.ratio, MOST_REPEATS - repeats);
        if (steps && is_own_tunnel(maker, hole, before))
            used->farthest = most_stopped;
        before = hole;
        make_finer(used, elementary_pow(finer, steps));
    }
    return STATUS_OK;
}

/* Where a triangle is too far off the wall, as over the bottom of a groove, which is too narrow to
 * be found by splitting, cells so much finer as it is too far are tried, and the nearest kept.
 * Triangles that are none of the wall, and that finer cells do not bring nearer, stay so. */
static Status come_near(const Maker *maker, MeshFineness *used, uint8_t *segment_status)
{
    MeshFineness tried = *used;
    bool sound = true, is_nearest = true;
    double hole, off = maker->piece->off.ratio;
    for (int i = 0; i < MOST_NEARER && off > used->worst; i++) {
        int repeats = maker->piece->repeats;
        make_finer(&tried, fmax(least_part, finer * used->worst / off));
        junctionmesh_release(maker->piece);
        TRY(attempt(maker, &tried, segment_status, &sound, &hole));
        maker->piece->repeats = repeats + 1;
        is_nearest = sound && maker->piece->off.ratio < off;
        if (is_nearest) {
            *used = tried;
            off = maker->piece->off.ratio;
        } else if (off > farthest_off) {
            break;
        }
    }
    if (is_nearest)
        return STATUS_OK;
    junctionmesh_release(maker->piece);
    return attempt(maker, used, segment_status, &sound, &hole);
}

Status junctionmesh_make(JunctionWorkspace *worker, const VesselTree *tree, JunctionPlan *plan,
                         const MeshFineness *fineness, JunctionMesh *piece, uint8_t *segment_status,
                         Err *err)
{
    JunctionMesh made = {0};
    PatchCrossing crossing = PATCHCROSS_NONE;
    const Maker maker = {worker, tree, plan, &made, &crossing, err};
    MeshFineness used = *fineness;
    bool sound = false;
    Status status;
    TRY_GOTO(make_sound(&maker, &used, segment_status, &sound));
    if (sound)
        TRY_GOTO(come_near(&maker, &used, segment_status));
    if (!sound || made.off.ratio > farthest_off)
        TRY_GOTO(refuse(&maker, fineness->grid_mm, err));
    TRY_GOTO(keep_patch(worker, fineness->grid_mm, &made, err));
    *piece = made;
    made = (JunctionMesh){0};
done:
    junctionmesh_release(&made);
    return status;
}
