/* Builds the surface of one junction region in one or more attempts.
 *
 * An attempt extracts the surface from the lattice, cuts it at the end planes of the stubs,
 * collapses edges, and splits triangles that are too far from the surface. Then the result is
 * proved to be a sphere with one hole per stub, and with one handle per loop of the region's whole
 * segments. The proof consists of four facts:
 *
 * - Each edge has two triangles, one on each side, or is on a rim.
 * - Each stub has one rim, a closed loop that goes about the stub's axis once.
 * - The mesh is connected.
 * - points - edges + triangles = 2 - stubs - 2 loops.
 *
 * If the proof fails, narrow tunnels are closed [latticerepair.h]. If the proof fails again, the
 * next attempt has smaller cells. */
#include "mesh/junctionmesh.h"

#include "mesh/patchcross.h"
#include "mesh/precision.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

#define NONE UINT32_MAX

/* Limits on repetition: steps of smaller cells until the mesh is valid, and further attempts to
 * bring a valid mesh closer to the surface. After 7 steps of 0.85, cells have 0.32 times their
 * first side, and the surface has 10 times as many. More steps would need more memory and time than
 * the rare regions that they could still help are worth. */
enum { MAX_REFINEMENTS = 7, MAX_ACCURACY_RETRIES = 3 };
/* Factors on the cell size: of one refinement step, and the smallest of one accuracy retry. A
 * factor nearer to 1 finds a coarser valid mesh after more attempts; a smaller one makes more
 * triangles than needed. */
static const double refinement_factor = 0.85, min_retry_factor = 0.5;
/* In units of the local radius: a triangle farther from the surface than this closes a wrong hole,
 * as happens where vessels overlap. A region that still has such a triangle is refused. Triangles
 * of a correct surface are a few tolerances from it, and the tolerance is at most 0.2. */
static const double max_error = 0.5;
/* In units of the thinner vessel's radius: a gap between two vessels that do not blend may be too
 * narrow for the cells if it is below this: the cells there are about 0.1 radii wide, and a gap
 * needs several. If a wide hole occurs at such a gap, all remaining refinement steps are taken at
 * once. */
static const double max_unresolved_gap = 0.3;
/* In units of the usual cell size: a wider hole is not an artefact of the lattice. Cells where
 * unblended vessels pass are a sixth of the usual size, so holes of the lattice are narrower. */
static const double min_real_hole = 0.25;
/* Some tunnels are real features of the surface, for example where a twig blends with its trunk a
 * second time. Such a tunnel persists: finer cells leave it more than persistent_ratio of its
 * width. Up to max_closed_tunnel local radii wide, it is closed all the same. */
static const double max_closed_tunnel = 0.1, persistent_ratio = 0.9;

/* The state of junctionmesh_make. All pointers are borrowed. */
typedef struct JunctionBuild {
    JunctionWorkspace *workspace;
    const VesselTree *tree;
    const JunctionPlan *plan;
    JunctionSurface surface;
    JunctionMesh *mesh;
    PatchCrossing *crossing; /* of the last attempt */
    uint8_t *statuses;
    Err *err;
} JunctionBuild;

void junctionmesh_release(JunctionMesh *mesh)
{
    free(mesh->points);
    free(mesh->triangles);
    free(mesh->rims);
    free(mesh->rim_points);
    *mesh = (JunctionMesh){0};
}

void junctionworkspace_release(JunctionWorkspace *workspace)
{
    octree_release(&workspace->tree);
    lattice_release(&workspace->lattice);
    patch_release(&workspace->patch);
}

/* Fills next[], per point of the patch, with the next point along a rim, or NONE for a point that
 * is not on a rim. *sound receives false if an edge has two triangles on one side, or is open and
 * not on a rim. */
static Status follow_edges(const JunctionBuild *build, uint32_t *next, size_t *n_edges, bool *sound)
{
    const Patch *patch = &build->workspace->patch;
    size_t corners = 3 * patch->n_triangles, open = 0;
    KeyMap edges = {0};
    Status status;
    TRY_GOTO(keymap_begin(&edges, corners, patch_items, build->err));
    *sound = true;
    for (size_t i = 0; i < corners; i++) {
        const uint32_t *at = patch->triangles[i / 3].at;
        uint32_t *value;
        bool is_new;
        uint64_t key = (uint64_t)at[i % 3] << 32 | at[(i + 1) % 3];
        TRY_GOTO(keymap_put(&edges, key, &value, &is_new, build->err));
        *sound = *sound && is_new;
    }
    for (size_t i = 0; i < patch->n_points; i++)
        next[i] = NONE;
    for (size_t i = 0; i < corners; i++) {
        const uint32_t *at = patch->triangles[i / 3].at;
        uint32_t a = at[i % 3], b = at[(i + 1) % 3];
        if (keymap_find(&edges, (uint64_t)b << 32 | a))
            continue;
        open++;
        *sound = *sound && patch->points[a].rim_stub != NO_STUB &&
                 patch->points[a].rim_stub == patch->points[b].rim_stub && next[a] == NONE;
        next[a] = b;
    }
    *n_edges = (corners + open) / 2;
done:
    keymap_release(&edges);
    return status;
}

/* Adds the rim of a stub to the mesh, by rising angle. Along `next`, the angle falls at the
 * segment's first end, and rises at its second. Returns false if the rim does not go about the axis
 * once. */
static bool add_rim(const JunctionBuild *build, const uint32_t *next, size_t stub_index,
                    uint32_t *n_points)
{
    const BranchStub *stub = &build->plan->stubs[stub_index];
    const Patch *patch = &build->workspace->patch;
    const FieldSegment *segment = &build->tree->segments[stub->segment];
    uint32_t start = NONE, total = 0, n = 0;
    double lowest = HUGE_VAL;
    for (uint32_t i = 0; i < patch->n_points; i++) {
        if (patch->points[i].rim_stub != stub_index)
            continue;
        double angle = segment_angle(segment, patch->points[i].x);
        total++;
        if (angle < lowest) {
            lowest = angle;
            start = i;
        }
    }
    uint32_t *rim = &build->mesh->rim_points[*n_points], at = start;
    for (; at != NONE && n < total; n++, at = next[at])
        rim[n == 0 || stub->end == 1 ? n : total - n] = at;
    for (uint32_t i = 1; i < n; i++)
        if (!(segment_angle(segment, patch->points[rim[i]].x) >
              segment_angle(segment, patch->points[rim[i - 1]].x)))
            return false;
    build->mesh->rims[stub_index] = (Rim){stub->segment, stub->end, *n_points, total};
    *n_points += total;
    return total >= 3 && n == total && at == start;
}

/* Finds the rims of the mesh. *sound receives false if a rim does not go about its axis once. */
static Status find_rims(const JunctionBuild *build, const uint32_t *next, bool *sound)
{
    const Patch *patch = &build->workspace->patch;
    JunctionMesh *mesh = build->mesh;
    size_t n_stubs = build->plan->n_stubs, n_on_rims = 0;
    uint32_t n_points = 0;
    for (size_t i = 0; i < patch->n_points; i++)
        n_on_rims += patch->points[i].rim_stub != NO_STUB;
    TRY(mem_calloc(&mesh->rims, n_stubs, sizeof *mesh->rims, "rims", build->err));
    TRY(mem_calloc(&mesh->rim_points, n_on_rims + 1, sizeof *mesh->rim_points, "rims", build->err));
    mesh->n_rims = n_stubs;
    for (size_t k = 0; k < n_stubs && *sound; k++)
        *sound = add_rim(build, next, k, &n_points);
    return STATUS_OK;
}

/* Proves the four facts about the patch, and finds the rims of the mesh. */
static Status prove(const JunctionBuild *build, bool *sound)
{
    Patch *patch = &build->workspace->patch;
    long long expected = 2 - (long long)build->plan->n_stubs - 2 * (long long)build->plan->n_loops;
    size_t n_edges, parts;
    uint32_t *next = NULL;
    Status status;
    TRY_GOTO(mem_alloc(&next, patch->n_points, sizeof *next, patch_items, build->err));
    TRY_GOTO(follow_edges(build, next, &n_edges, sound));
    long long euler =
        (long long)patch->n_points - (long long)n_edges + (long long)patch->n_triangles;
    build->mesh->has_lost_handles = *sound && euler > expected;
    TRY_GOTO(patch_count_parts(patch, &parts, build->err));
    *sound = *sound && parts == 1 && euler == expected;
    if (*sound)
        TRY_GOTO(find_rims(build, next, sound));
done:
    free(next);
    return status;
}

/* Returns true if x is inside the vessel of a stub. The region's field has only a part of this
 * vessel. */
static bool is_in_stub(const JunctionBuild *build, Vec3 x)
{
    for (size_t k = 0; k < build->plan->n_stubs; k++) {
        const FieldSegment *stub = &build->tree->segments[build->plan->stubs[k].segment];
        if (segment_distance_to(stub, x) < stub->radius_mm)
            return true;
    }
    return false;
}

/* Looks for a point of the surface about a segment where the segment's own term is the largest.
 * Follows 8 rays away from each of 5 points of the axis, and finds the surface along a ray by 40
 * bisections, to 2e-12 radii. Returns false if there is no such point on any ray. More rays would
 * find narrower pieces of surface; a piece that all 40 rays miss counts as enclosed. */
static bool find_own_surface(const JunctionBuild *build, const LocalField *all, uint32_t segment,
                             Vec3 *at)
{
    enum { AXIS_POINTS = 5, ANGLES = 8, HALVINGS = 40 };
    const JunctionPlan *plan = build->plan;
    const Octree *tree = &build->workspace->tree;
    const FieldSegment *self = &build->tree->segments[segment];
    Vec3 u, v, axis = vec3_sub(self->b, self->a);
    vec3_perpendiculars(vec3_normalized(axis), &u, &v);
    for (int i = 0; i < AXIS_POINTS * ANGLES; i++) {
        double angle = FULL_TURN / ANGLES * (i % ANGLES);
        Vec3 from = vec3_add_scaled(self->a, axis, (0.5 + i / ANGLES) / AXIS_POINTS);
        Vec3 outward = direction_at(u, v, angle), gradient;
        double low = 0, high = 2.5 * self->radius_mm;
        if (localfield_value(&plan->field, &tree->stack, all, from).phi < FIELD_LEVEL)
            continue;
        for (int k = 0; k < HALVINGS; k++) {
            double middle = 0.5 * (low + high);
            Vec3 x = vec3_add_scaled(from, outward, middle);
            bool inside = localfield_value(&plan->field, &tree->stack, all, x).phi >= FIELD_LEVEL;
            *(inside ? &low : &high) = middle;
        }
        *at = vec3_add_scaled(from, outward, low);
        FieldValue value = localfield_gradient(&plan->field, &tree->stack, all, *at, &gradient);
        if (plan->field.terms[value.largest_term].segment == segment && !is_in_stub(build, *at))
            return true;
    }
    return false;
}

/* Finds the status of a segment that is wholly in the region, and that no point of the patch
 * belongs to. */
static Status find_status(const JunctionBuild *build, uint32_t segment, double ratio,
                          uint8_t *status)
{
    const Patch *patch = &build->workspace->patch;
    const FieldSegment *self = &build->tree->segments[segment];
    Octree *tree = &build->workspace->tree;
    LocalField all;
    NarrowField near;
    Vec3 at, middle = vec3_scale(vec3_add(self->a, self->b), 0.5);
    double reach = vec3_distance(self->a, middle) + 3 * self->radius_mm;
    TRY(localfield_from_field(&build->plan->field, &tree->stack, &all, build->err));
    const FieldBalls balls = {middle, reach, 0};
    TRY(localfield_narrow(&build->plan->field, &tree->stack, &all, &balls, &near, build->err));
    *status = SEGMENT_ENCLOSED;
    if (near.local.n_terms <= MAX_LOCAL_TERMS &&
        find_own_surface(build, &near.local, segment, &at)) {
        double nearest = HUGE_VAL;
        for (size_t i = 0; i < patch->n_points; i++)
            nearest = fmin(nearest, vec3_distance(patch->points[i].x, at));
        *status = nearest <= ratio * self->radius_mm ? SEGMENT_PRESENT : SEGMENT_MISSING;
    }
    tree->stack.n_terms = tree->stack.n_groups = 0;
    return STATUS_OK;
}

/* Finds the statuses of the region's whole segments. The segment of a stub is present because it
 * has a tube. */
static Status find_statuses(const JunctionBuild *build, double ratio)
{
    const Patch *patch = &build->workspace->patch;
    const JunctionField *field = &build->plan->field;
    for (uint32_t i = 0; i < field->n_terms; i++)
        if (field->terms[i].stub == NO_STUB)
            build->statuses[field->terms[i].segment] = SEGMENT_MISSING;
    for (size_t i = 0; i < patch->n_points; i++)
        if (patch->points[i].vessel_stub == NO_STUB)
            build->statuses[patch->points[i].segment] = SEGMENT_PRESENT;
    for (uint32_t i = 0; i < field->n_terms; i++) {
        uint32_t segment = field->terms[i].segment;
        if (field->terms[i].stub == NO_STUB && build->statuses[segment] == SEGMENT_MISSING)
            TRY(find_status(build, segment, ratio, &build->statuses[segment]));
    }
    return STATUS_OK;
}

/* Turns the surface that the lattice left into a finished one, and proves it. */
static Status finish(const JunctionBuild *build, const MeshFineness *fineness, bool *sound)
{
    Patch *patch = &build->workspace->patch;
    TRY(planecut_apply(&build->surface, fineness->cells.ratio, sound, build->err));
    if (!*sound)
        return STATUS_OK;
    /* The other parts are ends of stubs that the cut did not reach, because another vessel encloses
     * them. If a segment is lost with them, its status is SEGMENT_MISSING. */
    TRY(patch_keep_largest(patch, build->err));
    TRY(find_statuses(build, fineness->cells.ratio));
    TRY(collapse_apply(patch, fineness->sagitta, build->err));
    build->mesh->deviation = (MeshDeviation){0};
    size_t n_points = patch->n_points;
    TRY(facerefine_apply(&build->surface, fineness->split_distance, &build->mesh->deviation,
                         build->err));
    TRY(prove(build, sound));
    *build->crossing = PATCHCROSS_NONE;
    if (*sound && patch->n_points > n_points)
        TRY(patchcross_find(patch, n_points, fineness->grid_mm, build->crossing, build->err));
    *sound = *sound && *build->crossing == PATCHCROSS_NONE;
    return STATUS_OK;
}

/* Makes one attempt. *hole receives the width of the widest tunnel that makes the surface unsound,
 * in local radii; 0 if the surface is sound without a repair. */
static Status attempt(const JunctionBuild *build, const MeshFineness *fineness, bool *sound,
                      double *hole)
{
    JunctionWorkspace *workspace = build->workspace;
    *hole = 0;
    TRY(octree_build(&workspace->tree, build->plan, &fineness->cells, build->err));
    TRY(lattice_make(&workspace->lattice, &build->surface, build->err));
    TRY(finish(build, fineness, sound));
    if (*sound || *build->crossing == PATCHCROSS_ROUNDING)
        return STATUS_OK;
    TRY(lattice_repair(&workspace->lattice, &build->surface, fineness->max_repair, hole,
                       build->err));
    return *hole <= fineness->max_repair ? finish(build, fineness, sound) : STATUS_OK;
}

static bool is_member(const JunctionField *field, uint32_t group, uint32_t term)
{
    for (uint32_t i = field->first[group]; i < field->first[group + 1]; i++)
        if (field->members[i] == term)
            return true;
    return false;
}

/* Finds the two segments of the region that blend nowhere and whose surfaces are nearest to each
 * other. Returns their gap in units of the smaller radius, or HUGE_VAL if there are no such
 * segments. */
static double find_gap(const JunctionBuild *build, uint32_t pair[2])
{
    const JunctionField *field = &build->plan->field;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < field->n_terms; i++)
        for (uint32_t k = i + 1; k < field->n_terms; k++) {
            const FieldSegment *one = &build->tree->segments[field->terms[i].segment];
            const FieldSegment *other = &build->tree->segments[field->terms[k].segment];
            double gap = segments_gap(one, other);
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

static int compare_keys(const void *a, const void *b)
{
    uint64_t one = *(const uint64_t *)a, other = *(const uint64_t *)b;
    return (one > other) - (one < other);
}

/* Orders the triangles by the Morton codes of their first points, so that neighbours in memory are
 * near in space. Fills keys[]: the upper half of a key is the code, the lower half the index of the
 * triangle. */
static void order_triangles(const JunctionWorkspace *workspace, uint64_t *keys)
{
    const Patch *patch = &workspace->patch;
    const Octree *tree = &workspace->tree;
    for (uint32_t i = 0; i < patch->n_triangles; i++) {
        Vec3 from = vec3_sub(patch->points[patch->triangles[i].at[0]].x, tree->corner);
        uint64_t code = 0;
        for (int axis = 0; axis < 3; axis++) {
            double part = vec3_component(from, axis) / tree->side;
            code |= morton_spread((uint64_t)(1023 * fmin(fmax(part, 0), 1))) << axis;
        }
        keys[i] = code << 32 | i;
    }
    qsort(keys, patch->n_triangles, sizeof *keys, compare_keys);
}

static JunctionPoint rounded_point(const PatchPoint *point, double grid)
{
    JunctionPoint kept = {.segment = point->segment};
    for (int axis = 0; axis < 3; axis++) {
        kept.x[axis] = mesh_round_to_grid(vec3_component(point->x, axis), grid);
        kept.normal[axis] = (float)vec3_component(point->normal, axis);
    }
    return kept;
}

/* Copies the patch into as little memory as possible. */
static Status keep_patch(const JunctionWorkspace *workspace, double grid, JunctionMesh *mesh,
                         Err *err)
{
    const Patch *patch = &workspace->patch;
    uint64_t *keys;
    TRY(mem_calloc(&mesh->points, patch->n_points, sizeof *mesh->points, "points", err));
    TRY(mem_calloc(&mesh->triangles, patch->n_triangles, sizeof *mesh->triangles, "triangles",
                   err));
    TRY(mem_alloc(&keys, patch->n_triangles, sizeof *keys, patch_items, err));
    order_triangles(workspace, keys);
    for (size_t i = 0; i < patch->n_points; i++)
        mesh->points[mesh->n_points++] = rounded_point(&patch->points[i], grid);
    for (size_t i = 0; i < patch->n_triangles; i++)
        mesh->triangles[mesh->n_triangles++] = patch->triangles[(uint32_t)keys[i]];
    free(keys);
    return STATUS_OK;
}

/* Returns true if one of the region's whole segments in `kept` meets no other one at this end. */
static bool is_dead_end(const JunctionBuild *build, const bool *kept, uint32_t term, int end)
{
    const JunctionField *field = &build->plan->field;
    const uint32_t node = build->tree->nodes[field->terms[term].segment][end];
    for (uint32_t i = 0; i < field->n_terms; i++) {
        const uint32_t *its = build->tree->nodes[field->terms[i].segment];
        if (i != term && kept[i] && (its[0] == node || its[1] == node))
            return false;
    }
    return true;
}

/* Names the region's whole segments that are part of a loop: those that remain when segments with a
 * dead end are removed again and again. */
static Status refuse_loop(const JunctionBuild *build, Err *err)
{
    enum { MOST_NAMED = 12 }; /* so that the message stays one line or two */
    const JunctionField *field = &build->plan->field;
    bool *kept, again = true;
    char names[16 * MOST_NAMED] = "";
    size_t n = 0, length = 0;
    TRY(mem_calloc(&kept, field->n_terms, sizeof *kept, "terms", err));
    for (uint32_t i = 0; i < field->n_terms; i++)
        kept[i] = field->terms[i].stub == NO_STUB;
    while (again) {
        again = false;
        for (uint32_t i = 0; i < field->n_terms; i++)
            if (kept[i] && (is_dead_end(build, kept, i, 0) || is_dead_end(build, kept, i, 1))) {
                kept[i] = false;
                again = true;
            }
    }
    for (uint32_t i = 0; i < field->n_terms; i++)
        if (kept[i] && n++ < MOST_NAMED)
            length +=
                (size_t)snprintf(names + length, sizeof names - length, "%s%u", n > 1 ? ", " : "",
                                 build->tree->ids[field->terms[i].segment]);
    free(kept);
    return err_set(
        err, STATUS_INFEASIBLE,
        "%s of segments %s%s is narrower than its vessels, so the surface has no hole there; use "
        "thinner vessels, or cut loops with `break_loops`",
        build->plan->n_loops > 1 ? "a loop" : "the loop", names,
        n > MOST_NAMED ? " and others" : "");
}

/* Sets the error that explains why the region has no valid mesh. */
static Status refuse(const JunctionBuild *build, double grid_mm, Err *err)
{
    const uint32_t *ids = build->tree->ids;
    uint32_t pair[2], first = build->plan->field.terms[0].segment;
    if (*build->crossing == PATCHCROSS_ROUNDING)
        return precision_refuse(build->tree, first, grid_mm, err);
    if (build->workspace->patch.n_triangles == 0)
        return err_set(
            err, STATUS_INFEASIBLE,
            "segment %u and its neighbors are too short for their radii: they have no surface",
            ids[first]);
    if (build->mesh->has_lost_handles)
        return refuse_loop(build, err);
    if (find_gap(build, pair) < 0)
        return err_set(err, STATUS_INFEASIBLE,
                       "the vessels of segments %u and %u overlap where they are unconnected, so "
                       "their common surface is not a tube",
                       ids[pair[0]], ids[pair[1]]);
    return err_set(err, STATUS_INFEASIBLE,
                   "the vessels near segment %u touch each other: their surface has a loop, or a "
                   "gap too narrow for the finest cells",
                   ids[first]);
}

/* Returns true if a tunnel persists with finer cells and may be closed. Where vessels that do not
 * blend overlap, it may not. */
static bool is_own_tunnel(const JunctionBuild *build, double hole, double before)
{
    uint32_t pair[2];
    return hole > persistent_ratio * before && hole <= max_closed_tunnel &&
           find_gap(build, pair) >= 0;
}

/* Makes cells smaller by a factor. The bend permitted across a cell falls with its square, as the
 * distance of a chord from its arc does. */
static void make_finer(MeshFineness *fineness, double factor)
{
    fineness->cells.ratio *= factor;
    fineness->cells.bending *= factor * factor;
}

/* Returns by how many steps the cells of the next attempt are finer; 0 if no attempt would help.
 *
 * A wide hole persists with finer cells, unless a gap between vessels causes it that the present
 * cells cannot resolve. A hole that the last finer cells did not make narrower persists if vessels
 * overlap that do not blend. Crossings that come from rounding alone persist, too, because smaller
 * triangles have more of them.
 *
 * cell  side of the cells, in local radii.
 * left  number of steps that remain. */
static int steps_finer(const JunctionBuild *build, double hole, double before, double cell,
                       int left)
{
    uint32_t pair[2];
    bool is_wide = hole > min_real_hole * cell;
    if (*build->crossing == PATCHCROSS_ROUNDING)
        return 0;
    if (left == 0 || (!is_wide && hole <= persistent_ratio * before))
        return left > 0;
    double gap = find_gap(build, pair);
    if (!is_wide)
        return gap >= 0;
    return gap >= 0 && gap < max_unresolved_gap ? left : 0;
}

/* Makes attempts with finer and finer cells until the surface is sound, or no attempt would help.
 * *used is the fineness of the first attempt on entry, and receives the fineness of the last one.
 */
static Status make_sound(const JunctionBuild *build, MeshFineness *used, bool *sound)
{
    double hole, before = HUGE_VAL;
    for (int steps = 1; steps; build->mesh->retries += steps) {
        int retries = build->mesh->retries;
        junctionmesh_release(build->mesh);
        build->mesh->retries = retries;
        TRY(attempt(build, used, sound, &hole));
        steps =
            *sound ? 0
                   : steps_finer(build, hole, before, used->cells.ratio, MAX_REFINEMENTS - retries);
        if (steps && is_own_tunnel(build, hole, before))
            used->max_repair = max_closed_tunnel;
        before = hole;
        make_finer(used, elementary_pow(refinement_factor, steps));
    }
    return STATUS_OK;
}

/* Tries finer cells if a triangle is too far from the surface, and keeps the attempt whose
 * triangles are nearest. A triangle is too far over the bottom of a groove that is so narrow that
 * splits do not find it. The attempts end early if a triangle does not belong to the surface and
 * finer cells do not bring it nearer. */
static Status come_near(const JunctionBuild *build, MeshFineness *used)
{
    MeshFineness tried = *used;
    bool sound = true, is_nearest = true;
    double hole, off = build->mesh->deviation.ratio;
    for (int i = 0; i < MAX_ACCURACY_RETRIES && off > used->rebuild_distance; i++) {
        int retries = build->mesh->retries;
        make_finer(&tried,
                   fmax(min_retry_factor, refinement_factor * used->rebuild_distance / off));
        junctionmesh_release(build->mesh);
        TRY(attempt(build, &tried, &sound, &hole));
        build->mesh->retries = retries + 1;
        is_nearest = sound && build->mesh->deviation.ratio < off;
        if (is_nearest) {
            *used = tried;
            off = build->mesh->deviation.ratio;
        } else if (off > max_error) {
            break;
        }
    }
    if (is_nearest)
        return STATUS_OK;
    junctionmesh_release(build->mesh);
    return attempt(build, used, &sound, &hole);
}

Status junctionmesh_make(JunctionWorkspace *workspace, const JunctionInput *input,
                         JunctionMesh *mesh, uint8_t *statuses, Err *err)
{
    JunctionMesh made = {0};
    PatchCrossing crossing = PATCHCROSS_NONE;
    const JunctionBuild build = {.workspace = workspace,
                                 .tree = input->tree,
                                 .plan = input->plan,
                                 .surface = {input->plan, &workspace->tree, &workspace->patch},
                                 .mesh = &made,
                                 .crossing = &crossing,
                                 .statuses = statuses,
                                 .err = err};
    MeshFineness used = *input->fineness;
    bool sound = false;
    Status status;
    TRY_GOTO(make_sound(&build, &used, &sound));
    if (sound)
        TRY_GOTO(come_near(&build, &used));
    if (!sound || made.deviation.ratio > max_error)
        TRY_GOTO(refuse(&build, used.grid_mm, err));
    TRY_GOTO(keep_patch(workspace, used.grid_mm, &made, err));
    *mesh = made;
    made = (JunctionMesh){0};
done:
    junctionmesh_release(&made);
    return status;
}
