/* Builds the cylinders and joints of a tree.
 *
 * At each junction, the end of the parent (the trunk) meets the ends of the daughters. If a tree
 * starts with several vessels, or if several vessels of a network end at a junction, the thickest
 * one of these is the trunk. All ends are cut back [cuts.c], and a ruled surface leads from the
 * rim of the trunk to the rim of each daughter. Cylinders remain closed, so every joint is a solid
 * between two discs. Its surface neither folds nor has holes as long as each disc lies on one side
 * of the other disc's plane, which the cuts ensure.
 *
 * The construction fails at a junction whose cuts do not fit into its vessels. It also fails where
 * a daughter leaves at less than 60 degrees from the trunk's own direction: the joint would be
 * pinched to less than half its width. JOINTS_ROBUST draws such a junction as `rounded` does: with
 * uncut cylinders and one sphere. The cuts at both ends of a vessel share its length. Junctions are
 * decided in ascending order of the largest fraction of a vessel that they need, so that few of
 * them fail. */
#include "stage/joints.h"

#include "stage/cuts.h"
#include <stdlib.h>

static const double sharp_cosine = 0.5;   /* cosine of the angle between trunk and daughter: 60
                                           * degrees */
static const double usable_part = 0.999;  /* fraction of a vessel's length that the cuts at its two
                                           * ends may use */
static const double straight_part = 1e-6; /* a cut below this fraction of the radius counts as no
                                           * cut */

/* Maximum number of comparisons of vessel ends for the cuts of all junctions; takes some
 * seconds. */
static const uint64_t most_steps = 100000000;

typedef enum JunctionKind {
    JUNCTION_OPEN,
    JUNCTION_JOINED,
    JUNCTION_SHORT,
    JUNCTION_SHARP,
    JUNCTION_CROWDED
} JunctionKind;

/* The ends of vessels: end 2 i is the start of segment i, end 2 i + 1 is its end. */
typedef struct JointBuilder {
    const Tree *tree;
    const Coincidence *coincidence;
    IndexLists ends;     /* by place, rising */
    double *cut;         /* one an end, mm */
    JunctionKind *kinds; /* per node; set for nodes that represent a junction */
    uint64_t steps;      /* left of most_steps */
} JointBuilder;

typedef struct CutDemand {
    double part; /* largest fraction of a vessel that a cut at the junction takes */
    size_t junction;
} CutDemand;

static size_t junction_of(const JointBuilder *builder, size_t end)
{
    size_t node = end / 2;
    return (size_t)
        builder->coincidence->junction[end % 2 ? node : (size_t)builder->tree->parent[node]];
}

/* Returns the unit axis from an end along the vessel, and sets *at to the point at the end before
 * it is cut. */
static Vec3 end_axis(const JointBuilder *builder, size_t end, Vec3 *at)
{
    const Tree *tree = builder->tree;
    Vec3 distal = tree->position[end / 2], proximal = tree->position[tree->parent[end / 2]];
    *at = end % 2 ? distal : proximal;
    return vec3_normalized(end % 2 ? vec3_sub(proximal, distal) : vec3_sub(distal, proximal));
}

/* The centre of the disc at an end. */
static Vec3 end_center(const JointBuilder *builder, size_t end)
{
    Vec3 at, axis = end_axis(builder, end, &at);
    return vec3_add_scaled(at, axis, builder->cut[end]);
}

static Status collect_ends(JointBuilder *builder, Err *err)
{
    const size_t n = builder->tree->n;
    TRY(mem_calloc(&builder->cut, 2 * n, sizeof *builder->cut, "vessel ends", err));
    TRY(mem_calloc(&builder->kinds, n, sizeof *builder->kinds, "coincidence", err));
    TRY(indexlists_begin(&builder->ends, n, "vessel ends", err));
    for (size_t end = 0; end < 2 * n; end++)
        if (coincidence_draws(builder->coincidence, end / 2))
            indexlists_count(&builder->ends, junction_of(builder, end));
    TRY(indexlists_allot(&builder->ends, "vessel ends", err));
    for (uint32_t end = 0; end < 2 * n; end++)
        if (coincidence_draws(builder->coincidence, end / 2))
            indexlists_put(&builder->ends, junction_of(builder, end), end);
    return STATUS_OK;
}

/* Returns the end at which all joints of a junction start. Ends of vessels come before starts. */
static size_t trunk_of(const JointBuilder *builder, size_t junction)
{
    const double *radius = builder->tree->radius_mm;
    size_t trunk = builder->ends.items[builder->ends.first[junction]];
    for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
        size_t end = builder->ends.items[k];
        if (end % 2 != trunk % 2 ? end % 2 == 1 : radius[end / 2] > radius[trunk / 2])
            trunk = end;
    }
    return trunk;
}

/* Computes the cuts of the ends at a junction and sets the junction's kind. Sets *part to the
 * largest fraction of a vessel that a cut takes. `ends` and `cut` are workspaces for the ends of
 * any junction. */
static Status cut_junction(JointBuilder *builder, size_t junction, VesselEnd *ends, double *cut,
                           double *demand, Err *err)
{
    size_t first = builder->ends.first[junction], n = indexlists_length(&builder->ends, junction);
    size_t trunk = trunk_of(builder, junction);
    Vec3 at, trunk_axis = end_axis(builder, trunk, &at);
    double largest_radius = 0, largest_cut = 0;
    JunctionKind kind = JUNCTION_JOINED;
    for (size_t k = 0; k < n; k++) {
        size_t end = builder->ends.items[first + k];
        ends[k] = (VesselEnd){end_axis(builder, end, &at), builder->tree->radius_mm[end / 2]};
        largest_radius = fmax(largest_radius, ends[k].radius);
        if (end != trunk && vec3_dot(ends[k].axis, trunk_axis) > sharp_cosine)
            kind = JUNCTION_SHARP;
    }
    *demand = 0;
    if (builder->steps > 0)
        TRY(cuts_compute(ends, n, cut, &builder->steps, err));
    if (builder->steps == 0) {
        builder->kinds[junction] = JUNCTION_CROWDED;
        return STATUS_OK;
    }
    for (size_t k = 0; k < n; k++) {
        size_t end = builder->ends.items[first + k];
        builder->cut[end] = cut[k];
        largest_cut = fmax(largest_cut, cut[k]);
        *demand = fmax(*demand, cut[k] / tree_segment_length(builder->tree, end / 2));
    }
    bool straight = kind == JUNCTION_JOINED && largest_cut <= straight_part * largest_radius;
    builder->kinds[junction] = straight ? JUNCTION_OPEN : kind;
    return STATUS_OK;
}

static int by_demand(const void *a, const void *b)
{
    const CutDemand *first = a, *second = b;
    if (first->part != second->part)
        return first->part < second->part ? -1 : 1;
    return first->junction < second->junction ? -1 : 1;
}

/* Returns true if the cuts of a junction fit beside the cuts already made at the other ends of its
 * vessels. */
static bool cuts_fit(const JointBuilder *builder, size_t junction, const bool *made)
{
    for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
        size_t end = builder->ends.items[k], other = end ^ 1;
        double taken = builder->cut[end] + (made[other] ? builder->cut[other] : 0);
        if (taken > usable_part * tree_segment_length(builder->tree, end / 2))
            return false;
    }
    return true;
}

/* Decides the junctions whose cuts are known, in ascending order of the fraction of a vessel that
 * they need. */
static Status settle_places(JointBuilder *builder, CutDemand *demands, size_t n, Err *err)
{
    bool *made = NULL; /* one an end */
    TRY(mem_calloc(&made, 2 * builder->tree->n, sizeof *made, "vessel ends", err));
    qsort(demands, n, sizeof *demands, by_demand);
    for (size_t d = 0; d < n; d++) {
        size_t junction = demands[d].junction;
        JunctionKind *kind = &builder->kinds[junction];
        if (*kind != JUNCTION_OPEN && *kind != JUNCTION_CROWDED &&
            !cuts_fit(builder, junction, made))
            *kind = JUNCTION_SHORT;
        for (size_t k = builder->ends.first[junction];
             *kind == JUNCTION_JOINED && k < builder->ends.first[junction + 1]; k++)
            made[builder->ends.items[k]] = true;
    }
    free(made);
    return STATUS_OK;
}

static Status cut_places(JointBuilder *builder, Err *err)
{
    size_t n = builder->tree->n, n_demands = 0, most = 0;
    VesselEnd *ends = NULL;
    double *cut = NULL;
    CutDemand *demands = NULL;
    Status status = STATUS_OK;
    for (size_t junction = 0; junction < n; junction++) {
        size_t count = indexlists_length(&builder->ends, junction);
        most = count > most ? count : most;
    }
    TRY_GOTO(mem_calloc(&ends, most, sizeof *ends, "vessel ends", err));
    TRY_GOTO(mem_calloc(&cut, most, sizeof *cut, "vessel ends", err));
    TRY_GOTO(mem_calloc(&demands, n, sizeof *demands, "coincidence", err));
    for (size_t junction = 0; junction < n; junction++) {
        if (indexlists_length(&builder->ends, junction) < 2)
            continue;
        CutDemand *demand = &demands[n_demands++];
        demand->junction = junction;
        TRY_GOTO(cut_junction(builder, junction, ends, cut, &demand->part, err));
    }
    status = settle_places(builder, demands, n_demands, err);
done:
    free(ends);
    free(cut);
    free(demands);
    return status;
}

static bool is_joined(JunctionKind kind, JointForm form)
{
    return kind == JUNCTION_JOINED ||
           (form == JOINTS_PAPER && (kind == JUNCTION_SHORT || kind == JUNCTION_SHARP));
}

/* Makes the cuts final: none where there is no joint, and never more than the vessel. */
static void trim_cuts(JointBuilder *builder, JointForm form)
{
    for (size_t junction = 0; junction < builder->tree->n; junction++) {
        JunctionKind kind = builder->kinds[junction];
        bool joined = is_joined(kind, form);
        for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
            size_t end = builder->ends.items[k];
            double length = tree_segment_length(builder->tree, end / 2);
            builder->cut[end] = joined ? fmin(builder->cut[end], length) : 0;
        }
    }
}

/* Returns true if no other vessel ends where this one does. */
static bool end_is_free(const JointBuilder *builder, size_t end)
{
    size_t junction = junction_of(builder, end);
    return indexlists_length(&builder->ends, junction) == 1;
}

static void add_cylinder(const JointBuilder *builder, size_t i, Geometry *geometry)
{
    double left = tree_segment_length(builder->tree, i);
    left -= builder->cut[2 * i] + builder->cut[2 * i + 1];
    if (left <= (1 - usable_part) / 2 * tree_segment_length(builder->tree, i))
        return;
    geometry->primitives[geometry->n_primitives++] =
        (Primitive){.kind = PRIMITIVE_CYLINDER,
                    .a = end_center(builder, 2 * i),
                    .b = end_center(builder, 2 * i + 1),
                    .free_a = end_is_free(builder, 2 * i),
                    .free_b = end_is_free(builder, 2 * i + 1),
                    .radius_mm = builder->tree->radius_mm[i],
                    .segment = (uint32_t)i};
}

static void add_joint(const JointBuilder *builder, size_t trunk, size_t end, Vec3 axes[2],
                      Geometry *geometry)
{
    const Tree *tree = builder->tree;
    Vec3 at;
    axes[0] = vec3_scale(end_axis(builder, trunk, &at), -1);
    axes[1] = end_axis(builder, end, &at);
    geometry->primitives[geometry->n_primitives++] =
        (Primitive){.kind = PRIMITIVE_JOINT,
                    .a = end_center(builder, trunk),
                    .b = end_center(builder, end),
                    .radius_mm = tree->radius_mm[trunk / 2],
                    .radius_b_mm = tree->radius_mm[end / 2],
                    .axes = axes,
                    .segment = (uint32_t)(end / 2)};
}

/* Adds the sphere of a junction that cannot be joined. Among equally thick vessels, the trunk
 * determines size and color. */
static void add_sphere(const JointBuilder *builder, size_t junction, Geometry *geometry)
{
    const Tree *tree = builder->tree;
    size_t thickest = trunk_of(builder, junction) / 2;
    for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
        size_t segment = builder->ends.items[k] / 2;
        if (tree->radius_mm[segment] > tree->radius_mm[thickest])
            thickest = segment;
    }
    geometry->primitives[geometry->n_primitives++] =
        (Primitive){.kind = PRIMITIVE_SPHERE,
                    .a = tree->position[junction],
                    .b = tree->position[junction],
                    .radius_mm = tree->radius_mm[thickest],
                    .segment = (uint32_t)thickest};
}

static void add_junction(const JointBuilder *builder, size_t junction, JointForm form,
                         Geometry *geometry, StageReport *report)
{
    JunctionKind kind = builder->kinds[junction];
    report->junctions_short += kind == JUNCTION_SHORT;
    report->junctions_sharp += kind == JUNCTION_SHARP;
    report->junctions_crowded += kind == JUNCTION_CROWDED;
    if (kind == JUNCTION_OPEN)
        return;
    if (!is_joined(kind, form)) {
        add_sphere(builder, junction, geometry);
        return;
    }
    size_t trunk = trunk_of(builder, junction);
    for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
        if (builder->ends.items[k] == trunk)
            continue;
        add_joint(builder, trunk, builder->ends.items[k], geometry->axes + 2 * report->joints++,
                  geometry);
    }
}

/* Allocates the axes of all joints. */
static Status reserve_axes(const JointBuilder *builder, JointForm form, Geometry *geometry,
                           Err *err)
{
    size_t joints = 0;
    for (size_t junction = 0; junction < builder->tree->n; junction++)
        if (is_joined(builder->kinds[junction], form))
            joints += indexlists_length(&builder->ends, junction) - 1;
    return mem_calloc(&geometry->axes, joints, 2 * sizeof *geometry->axes, "joints", err);
}

Status joints_add(const Tree *tree, const Coincidence *coincidence, JointForm form,
                  Geometry *geometry, StageReport *report, Err *err)
{
    JointBuilder builder = {.tree = tree, .coincidence = coincidence, .steps = most_steps};
    Status status;
    TRY_GOTO(collect_ends(&builder, err));
    TRY_GOTO(cut_places(&builder, err));
    TRY_GOTO(reserve_axes(&builder, form, geometry, err));
    trim_cuts(&builder, form);
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence_draws(coincidence, i))
            add_cylinder(&builder, i, geometry);
    for (size_t junction = 0; junction < tree->n; junction++)
        add_junction(&builder, junction, form, geometry, report);
done:
    indexlists_release(&builder.ends);
    free(builder.cut);
    free(builder.kinds);
    return status;
}
