/* Divides the segments of a tree into pieces along smooth curves.
 *
 * The curve of a segment is a cubic Hermite curve. At a node it has the derivative of a
 * centripetal Catmull-Rom spline through the previous node, the node and the next node of the main
 * path. Its component along the segment is never negative and at most twice the segment's length,
 * and its component across the segment is at most the length. A curve therefore never turns back,
 * and its distance from the segment is at most a quarter of the length [docs/METHODS.md section 9].
 */
#include "stage/smooth.h"

#include "stage/coincidence.h"
#include "stage/cuts.h"
#include <stdlib.h>
#include <string.h>

/* Maximum distance of a piece from its curve, and half the step of the radius from piece to piece,
 * / the segment's radius. Steps of 0.02 radii show as rings on cylinders that are 50 pixels wide.
 * Implicit surfaces smooth the steps. */
static const double distance_tolerance = 0.01, step_tolerance = 0.01, finest_step = 0.0003;

/* This fraction of the diagonal of the tree's box is not visible: a tenth of a pixel in a picture
 * of 2,000 pixels. */
static const double invisible = 5e-5;

/* Part of the direction of a side branch that is the direction of its parent. */
static const double branch_share = 1.0 / 3;

/* Models with joints: the pieces at a node with three segments or more are as long as the cuts of
 * their ends need [stage/cuts.h], with a reserve of this factor and of this part of the radius,
 * and at most so many radii of the thickest segment. */
static const double cut_reserve = 1.35, radius_reserve = 0.3, most_joint_space = 2.5;

/* Maximum number of comparisons of ends for the cuts of one junction; takes some milliseconds. */
enum { MOST_CUT_STEPS = 100000 };

/* Models that are cut off flat at free ends: the shortest piece there / its radius. Shorter pieces
 * cannot be cut flat, and are lengthened until they can. */
static const double end_space = 4;

/* A tree whose segments are being divided. */
typedef struct Smoother {
    const Tree *tree;
    Coincidence found;
    /* Per node that represents a junction: the thickest segment that ends there, and the main
     * one of the segments that start there; -1: none. In a network with loops, the other segments
     * that end at the junction count as starting there. Owned. */
    int32_t *incoming, *main;
    /* Per end of a segment (2 i is the start of segment i, 2 i + 1 its end): points of the curve
     * nearer than this are left out, to make space for joints; 0: none. Owned. */
    double *space_mm;
    bool has_steps; /* the model shows the steps of the radius between pieces */
    double invisible_mm;
    double tolerance; /* factor of both tolerances; 1 unless there are too many pieces */
} Smoother;

/* A segment as a curve: at t in [0, 1] it is start + chord t + t (1 - t) ((1 - t) (out - chord)
 * - t (in - chord)). */
typedef struct SmoothCurve {
    Vec3 start, chord;
    Vec3 out, in;     /* derivatives at t = 0 and 1 */
    double radius[2]; /* at t = 0 and 1, mm */
} SmoothCurve;

static size_t start_of(const Smoother *smoother, size_t i)
{
    return (size_t)smoother->found.junction[smoother->tree->parent[i]];
}

/* Returns the junction at an end of a segment. */
static size_t junction_of(const Smoother *smoother, size_t end)
{
    return end % 2 ? (size_t)smoother->found.junction[end / 2] : start_of(smoother, end / 2);
}

static Vec3 chord_of(const Smoother *smoother, size_t i)
{
    const Tree *tree = smoother->tree;
    return vec3_sub(tree->position[i], tree->position[tree->parent[i]]);
}

/* ---- the main path --------------------------------------------------------------------------- */

/* Returns the vector from a junction along segment i, which starts there or ends there. */
static Vec3 chord_from(const Smoother *smoother, size_t i, size_t junction)
{
    Vec3 chord = chord_of(smoother, i);
    return start_of(smoother, i) == junction ? chord : vec3_scale(chord, -1);
}

/* Returns true if segment i replaces `best` as the main segment of a junction: the thickest one, of
 * equally thick ones the straightest, then that with the lowest id. */
static bool is_better(const Smoother *smoother, size_t i, size_t junction, int32_t best,
                      int32_t incoming)
{
    const Tree *tree = smoother->tree;
    if (best < 0 || tree->radius_mm[i] != tree->radius_mm[best])
        return best < 0 || tree->radius_mm[i] > tree->radius_mm[best];
    double turn[2] = {0};
    if (incoming >= 0) {
        Vec3 along = chord_of(smoother, (size_t)incoming);
        turn[0] = vec3_dot(along, vec3_normalized(chord_from(smoother, i, junction)));
        turn[1] = vec3_dot(along, vec3_normalized(chord_from(smoother, (size_t)best, junction)));
    }
    return turn[0] != turn[1] ? turn[0] > turn[1] : tree->id[i] < tree->id[best];
}

static Status find_main_paths(Smoother *smoother, Err *err)
{
    const Tree *tree = smoother->tree;
    TRY(mem_calloc(&smoother->incoming, tree->n, sizeof *smoother->incoming, "nodes", err));
    TRY(mem_calloc(&smoother->main, tree->n, sizeof *smoother->main, "nodes", err));
    memset(smoother->incoming, 0xff, tree->n * sizeof *smoother->incoming);
    memset(smoother->main, 0xff, tree->n * sizeof *smoother->main);
    for (size_t i = 0; i < tree->n; i++) {
        const size_t end = (size_t)smoother->found.junction[i];
        int32_t *best = &smoother->incoming[end];
        if (coincidence_draws(&smoother->found, i) && is_better(smoother, i, end, *best, -1))
            *best = (int32_t)i;
    }
    for (size_t end = 0; end < 2 * tree->n; end++) {
        const size_t i = end / 2;
        if (!coincidence_draws(&smoother->found, i))
            continue;
        size_t at = end % 2 ? (size_t)smoother->found.junction[i] : start_of(smoother, i);
        if ((end % 2 == 0 || smoother->incoming[at] != (int32_t)i) &&
            is_better(smoother, i, at, smoother->main[at], smoother->incoming[at]))
            smoother->main[at] = (int32_t)i;
    }
    return STATUS_OK;
}

/* ---- curves ---------------------------------------------------------------------------------- */

/* Returns the derivative of a centripetal Catmull-Rom spline at the node between two chords, for
 * the segment `own`: (a / |a| + b / |b|) |own| sqrt |other| / (sqrt |own| + sqrt |other|). */
static Vec3 centripetal(Vec3 own, Vec3 other)
{
    double length = vec3_length(own), root = sqrt(length), other_root = sqrt(vec3_length(other));
    return vec3_scale(vec3_add(vec3_normalized(own), vec3_normalized(other)),
                      length * other_root / (root + other_root));
}

/* Returns the derivative at an end at which the curve has no curvature, from the derivative at the
 * other end. */
static Vec3 natural(Vec3 chord, Vec3 other_end)
{
    return vec3_scale(vec3_sub(vec3_scale(chord, 3), other_end), 0.5);
}

/* Sets the curve's derivative and radius at the segment's end 0 or 1. Returns false if the curve is
 * free there, and leaves both as they were. */
static bool set_end(const Smoother *smoother, size_t i, int end, SmoothCurve *curve)
{
    const Tree *tree = smoother->tree;
    const size_t at = end ? (size_t)smoother->found.junction[i] : start_of(smoother, i);
    const int32_t incoming = smoother->incoming[at], main = smoother->main[at];
    const int32_t other = end && incoming == (int32_t)i ? main : incoming;
    Vec3 *derivative = end ? &curve->in : &curve->out;
    if (other < 0)
        return false;
    Vec3 along = vec3_scale(chord_from(smoother, (size_t)other, at), end ? 1 : -1);
    if (main == (int32_t)i || other == main) {
        *derivative = centripetal(curve->chord, along);
        curve->radius[end] = (tree->radius_mm[i] + tree->radius_mm[other]) / 2;
    } else {
        *derivative =
            vec3_add_scaled(vec3_scale(curve->chord, 1 - branch_share), vec3_normalized(along),
                            branch_share * vec3_length(curve->chord));
    }
    return true;
}

/* Returns the curve of segment i, which must be drawn. */
static SmoothCurve curve_of(const Smoother *smoother, size_t i)
{
    const Tree *tree = smoother->tree;
    const double radius = tree->radius_mm[i];
    const Vec3 chord = chord_of(smoother, i);
    SmoothCurve curve = {tree->position[tree->parent[i]], chord, chord, chord, {radius, radius}};
    const bool is_set[2] = {set_end(smoother, i, 0, &curve), set_end(smoother, i, 1, &curve)};
    if (!is_set[0])
        curve.out = natural(chord, curve.in);
    if (!is_set[1])
        curve.in = natural(chord, curve.out);
    return curve;
}

/* Returns the curve's offset from the point start + chord t. */
static Vec3 curve_offset(const SmoothCurve *curve, double t)
{
    Vec3 out = vec3_sub(curve->out, curve->chord), in = vec3_sub(curve->in, curve->chord);
    return vec3_scale(vec3_add_scaled(vec3_scale(out, 1 - t), in, -t), t * (1 - t));
}

/* Returns the maximum of the lengths of two derivatives across a chord. */
static double largest_across(const SmoothCurve *curve)
{
    Vec3 along = vec3_normalized(curve->chord);
    return fmax(vec3_length(vec3_cross(curve->out, along)),
                vec3_length(vec3_cross(curve->in, along)));
}

/* Returns the number of pieces that a curve needs to be within `tolerance_mm` of them. A piece of
 * the parameter range h is at most h^2 / 8 times the largest second derivative away from the curve,
 * and the second derivative of a cubic is largest at an end. A curve within the tolerance of its
 * chord needs one piece. */
static double needed_for_bend(const SmoothCurve *curve, double tolerance_mm)
{
    Vec3 out = vec3_sub(curve->out, curve->chord), in = vec3_sub(curve->in, curve->chord);
    double bend = 2 * fmax(vec3_length(vec3_add_scaled(in, out, 2)),
                           vec3_length(vec3_add_scaled(out, in, 2)));
    return largest_across(curve) / 4 <= tolerance_mm ? 1 : sqrt(bend / (8 * tolerance_mm));
}

/* How a segment is divided: the curve at t = k / steps for rising integers k. */
typedef struct Division {
    size_t steps;
    size_t skipped; /* the first piece ends at k = skipped + 1; all others are one step long, except
                     * that the last piece ends at t = 1 */
    size_t pieces;
} Division;

static Vec3 curve_point(const SmoothCurve *curve, double t)
{
    return vec3_add(vec3_add_scaled(curve->start, curve->chord, t), curve_offset(curve, t));
}

/* Returns the number of steps of segment i, which must be drawn. No step is shorter than
 * SHORTEST_MM after rounding: the speed along the chord may be 0 at an end, where the shortest step
 * has the length chord / steps^2. */
static size_t count_steps(const Smoother *smoother, const SmoothCurve *curve, size_t i)
{
    const double radius = smoother->tree->radius_mm[i];
    const double far_mm = vec3_length(curve->start) + vec3_length(curve->chord);
    double bend_mm =
        fmax(smoother->tolerance * distance_tolerance * radius, smoother->invisible_mm);
    double step_mm = step_tolerance * radius;
    if (smoother->has_steps)
        step_mm = fmax(fmin(step_mm, smoother->invisible_mm / 10), finest_step * radius);
    double needed =
        fmax(needed_for_bend(curve, bend_mm),
             fabs(curve->radius[1] - curve->radius[0]) / (2 * step_mm * smoother->tolerance));
    double most = sqrt(vec3_length(curve->chord) / (2 * SHORTEST_MM + 1e-15 * far_mm));
    most = fmin(floor(most), SMOOTH_SEGMENT_PIECES);
    return (size_t)ceil(fmax(fmin(needed, most), 1));
}

/* Divides the curve of segment i. Points nearer than `space_mm` to its ends are left out. */
static Division division_of(const Smoother *smoother, const SmoothCurve *curve, size_t i)
{
    const size_t steps = count_steps(smoother, curve, i);
    const double from_start = smoother->space_mm[2 * i];
    const double from_end = smoother->space_mm[2 * i + 1];
    size_t low = 1, high = steps;
    while (low < high && vec3_distance(curve_point(curve, (double)low / (double)steps),
                                       curve->start) < from_start)
        low++;
    while (low < high && vec3_distance(curve_point(curve, (double)(high - 1) / (double)steps),
                                       smoother->tree->position[i]) < from_end)
        high--;
    return (Division){.steps = steps, .skipped = low - 1, .pieces = high - low + 1};
}

/* ---- pieces ---------------------------------------------------------------------------------- */

/* Makes the nodes of segment i, from `first` on. The last one is the segment's end. */
static void put_pieces(const Smoother *smoother, size_t i, size_t first, SmoothTree *out)
{
    const SmoothCurve curve = curve_of(smoother, i);
    const Division division = division_of(smoother, &curve, i);
    const double radius = smoother->tree->radius_mm[i];
    SmoothReport *report = &out->report;
    double before = 0;
    for (size_t k = 0; k < division.pieces; k++) {
        const size_t node = first + k;
        const bool is_last = k + 1 == division.pieces;
        const double t = is_last ? 1 : (double)(division.skipped + k + 1) / (double)division.steps;
        const double share = (before + t) / 2;
        out->tree.radius_mm[node] = curve.radius[0] + (curve.radius[1] - curve.radius[0]) * share;
        if (k > 0)
            out->tree.parent[node] = (int32_t)node - 1;
        if (!is_last)
            out->tree.position[node] = curve_point(&curve, t);
        double distance = sqrt(
            vec3_distance2_along(vec3_sub(out->tree.position[node], curve.start), curve.chord));
        report->distance_mm = fmax(report->distance_mm, distance);
        report->distance_radii = fmax(report->distance_radii, distance / radius);
        report->radius_change =
            fmax(report->radius_change, fabs(out->tree.radius_mm[node] / radius - 1));
        before = t;
    }
    report->segments++;
    report->pieces += division.pieces;
}

static size_t count_pieces(const Smoother *smoother, size_t i)
{
    if (!coincidence_draws(&smoother->found, i))
        return 1;
    const SmoothCurve curve = curve_of(smoother, i);
    return division_of(smoother, &curve, i).pieces;
}

/* Sets first[i] to the first node of the pieces of segment i, and first[n] to their number. Relaxes
 * the tolerance until there are at most SMOOTH_TREE_PIECES pieces, or one per segment. */
static void count_all_pieces(Smoother *smoother, size_t *first)
{
    const size_t n = smoother->tree->n;
    for (smoother->tolerance = 1;; smoother->tolerance *= 2) {
        for (size_t i = 0; i < n; i++)
            first[i + 1] = first[i] + count_pieces(smoother, i);
        if (first[n] <= SMOOTH_TREE_PIECES || first[n] == n)
            return;
    }
}

/* ---- space at nodes -------------------------------------------------------------------------- */

/* Returns the direction of the piece at an end of a segment, from the node into the segment, and
 * its radius. */
static VesselEnd vessel_end(const Smoother *smoother, size_t end)
{
    const size_t i = end / 2;
    const bool at_end = end % 2;
    const SmoothCurve curve = curve_of(smoother, i);
    const Division division = division_of(smoother, &curve, i);
    const Vec3 last = smoother->tree->position[i];
    const Vec3 node = at_end ? last : curve.start;
    Vec3 next = at_end ? curve.start : last;
    if (division.pieces > 1) {
        const size_t step = division.skipped + (at_end ? division.pieces - 1 : 1);
        next = curve_point(&curve, (double)step / (double)division.steps);
    }
    return (VesselEnd){vec3_normalized(vec3_sub(next, node)), curve.radius[at_end]};
}

/* Lists the ends of drawn segments by the node that represents their junction. */
static Status list_ends(const Smoother *smoother, IndexLists *meeting, Err *err)
{
    const size_t n = smoother->tree->n;
    TRY(indexlists_begin(meeting, n, "vessel ends", err));
    for (size_t end = 0; end < 2 * n; end++)
        if (coincidence_draws(&smoother->found, end / 2))
            indexlists_count(meeting, junction_of(smoother, end));
    TRY(indexlists_allot(meeting, "vessel ends", err));
    for (uint32_t end = 0; end < 2 * n; end++)
        if (coincidence_draws(&smoother->found, end / 2))
            indexlists_put(meeting, junction_of(smoother, end), end);
    return STATUS_OK;
}

/* Sets the space at the ends that meet at a node, three or more, for the cuts of their pieces. The
 * cuts depend on the directions of the pieces, and these on the space: a second round is close
 * enough to the solution. `ends` and `cut` are workspaces for n ends. */
static Status make_joint_space(Smoother *smoother, const uint32_t *meeting, size_t n,
                               VesselEnd *ends, double *cut, Err *err)
{
    enum { ROUNDS = 2 };
    for (int round = 0; round < ROUNDS; round++) {
        uint64_t steps = MOST_CUT_STEPS;
        double largest = 0;
        for (size_t k = 0; k < n; k++) {
            ends[k] = vessel_end(smoother, meeting[k]);
            largest = fmax(largest, ends[k].radius);
        }
        TRY(cuts_compute(ends, n, cut, &steps, err));
        for (size_t k = 0; k < n; k++) {
            double needed = cut_reserve * cut[k] + radius_reserve * ends[k].radius;
            double most = most_joint_space * largest;
            smoother->space_mm[meeting[k]] = steps > 0 && needed < most ? needed : most;
        }
    }
    return STATUS_OK;
}

/* Sets space_mm where three or more segments meet, or where one ends freely, if the model needs
 * it. */
static Status find_spaces(Smoother *smoother, SceneModel model, Err *err)
{
    const size_t n = smoother->tree->n;
    const bool has_joints = model_has(model, MODEL_JOINTS);
    IndexLists meeting = {0};
    VesselEnd *ends = NULL;
    double *cut = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&smoother->space_mm, 2 * n, sizeof *smoother->space_mm, "nodes", err));
    TRY_GOTO(list_ends(smoother, &meeting, err));
    TRY_GOTO(mem_calloc(&ends, 2 * n, sizeof *ends, "vessel ends", err));
    TRY_GOTO(mem_calloc(&cut, 2 * n, sizeof *cut, "vessel ends", err));
    for (size_t node = 0; node < n; node++) {
        const size_t count = indexlists_length(&meeting, node);
        const uint32_t *items = meeting.items + meeting.first[node];
        if (count == 1 && model_has(model, MODEL_TRIANGLES))
            smoother->space_mm[items[0]] = end_space * smoother->tree->radius_mm[items[0] / 2];
        if (count >= 3 && has_joints)
            TRY_GOTO(make_joint_space(smoother, items, count, ends, cut, err));
    }
done:
    indexlists_release(&meeting);
    free(ends);
    free(cut);
    return status;
}

/* Makes the node of a root or of a segment that is not divided, and the last node of any other. */
static void put_node(const Smoother *smoother, size_t i, const size_t *first, SmoothTree *out)
{
    const Tree *tree = smoother->tree;
    const int32_t parent = tree->parent[i], rep = smoother->found.junction[i];
    const size_t last = first[i + 1] - 1;
    for (size_t node = first[i]; node <= last; node++) {
        out->segment[node] = (uint32_t)i;
        out->twin[node] = smoother->found.twin[i];
        out->junction[node] = (int32_t)node;
        out->tree.id[node] = tree->id[i];
        out->tree.type[node] = tree->type[i];
    }
    out->junction[last] = (int32_t)(first[rep + 1] - 1);
    if (tree->link)
        out->tree.link[last] =
            tree_has_link(tree, i) ? (int32_t)(first[tree->link[i] + 1] - 1) : -1;
    out->tree.position[last] = tree->position[i];
    out->tree.radius_mm[last] = tree->radius_mm[i];
    out->tree.parent[first[i]] =
        parent == TREE_NO_PARENT ? TREE_NO_PARENT : (int32_t)(first[parent + 1] - 1);
}

static Status reserve_nodes(size_t n, SmoothTree *out, Err *err)
{
    TRY(mem_calloc(&out->segment, n, sizeof *out->segment, "pieces", err));
    TRY(mem_calloc(&out->twin, n, sizeof *out->twin, "pieces", err));
    return mem_calloc(&out->junction, n, sizeof *out->junction, "pieces", err);
}

static Status divide(Smoother *smoother, size_t *first, SmoothTree *out, Err *err)
{
    const Tree *tree = smoother->tree;
    count_all_pieces(smoother, first);
    TRY(tree_init(&out->tree, first[tree->n], err));
    TRY(reserve_nodes(first[tree->n], out, err));
    if (tree->link)
        TRY(tree_add_links(&out->tree, err));
    out->report.tolerance = smoother->tolerance * distance_tolerance;
    for (size_t i = 0; i < tree->n; i++) {
        put_node(smoother, i, first, out);
        if (coincidence_draws(&smoother->found, i))
            put_pieces(smoother, i, first[i], out);
    }
    return STATUS_OK;
}

Status stage_smooth(const Tree *tree, SceneModel model, SmoothTree *out, Err *err)
{
    const Box box = tree_bounds(tree);
    Smoother smoother = {.tree = tree,
                         .has_steps =
                             model_has(model, MODEL_ROUND_ENDS) || model_has(model, MODEL_JOINTS),
                         .invisible_mm = invisible * vec3_distance(box.low, box.high),
                         .tolerance = 1};
    SmoothTree made = {0};
    size_t *first = NULL;
    Status status;
    TRY_GOTO(coincidence_find(tree, &smoother.found, err));
    TRY_GOTO(find_main_paths(&smoother, err));
    TRY_GOTO(find_spaces(&smoother, model, err));
    TRY_GOTO(mem_calloc(&first, tree->n + 1, sizeof *first, "nodes", err));
    TRY_GOTO(divide(&smoother, first, &made, err));
    *out = made;
    made = (SmoothTree){0};
done:
    coincidence_release(&smoother.found);
    free(smoother.incoming);
    free(smoother.main);
    free(smoother.space_mm);
    free(first);
    smoothtree_release(&made);
    return status;
}

Status smoothtree_part(const SmoothTree *whole, double part, SmoothTree *out, Err *err)
{
    SmoothTree made = {.report = whole->report};
    Coincidence found = {0};
    Status status;
    TRY_GOTO(tree_proximal_part(&whole->tree, part, &made.tree, err));
    TRY_GOTO(reserve_nodes(made.tree.n, &made, err));
    TRY_GOTO(coincidence_find(&made.tree, &found, err));
    for (size_t i = 0, k = 0; i < made.tree.n; i++) {
        while (whole->tree.id[k] != made.tree.id[i])
            k++;
        made.segment[i] = whole->segment[k];
        made.twin[i] = whole->twin[k] == NO_TWIN ? found.twin[i] : CANNOT_DRAW;
        made.junction[i] = found.junction[i];
    }
    *out = made;
    made = (SmoothTree){0};
done:
    coincidence_release(&found);
    smoothtree_release(&made);
    return status;
}

void smoothtree_release(SmoothTree *smooth)
{
    tree_release(&smooth->tree);
    free(smooth->segment);
    free(smooth->twin);
    free(smooth->junction);
    *smooth = (SmoothTree){0};
}
