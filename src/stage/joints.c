/* At each place the ends of vessels meet: that of the parent, the trunk, and those of the
 * daughters; where a tree begins with several vessels, the thickest is the trunk. All are cut back
 * (cuts.c), and a ruled surface leads from the rim of the trunk to that of each daughter. Cylinders
 * stay closed, so every joint is a solid between two discs, whose wall neither folds nor has holes
 * as long as each disc lies on one side of the other's plane, which the cuts see to.
 *
 * The construction breaks down at a place whose cuts do not fit into its vessels, or where a
 * daughter leaves at less than 60 degrees from the trunk's own direction, so that the joint would
 * be pinched to less than half its width. A robust model draws such a place as `rounded` does:
 * cylinders that are not cut, and one sphere. Both ends of a vessel need room on it; places take
 * their turns, those that need the smallest part of a vessel first, so that few are lost. */
#include "stage/joints.h"

#include "stage/cuts.h"
#include <stdlib.h>

static const double sharp_cosine = 0.5;   /* of the angle between trunk and daughter */
static const double usable_part = 0.999;  /* of a vessel, for the cuts at its ends */
static const double straight_part = 1e-6; /* cuts below this part of the radius are none */

/* Comparisons of vessel ends for the cuts of all places: some seconds. */
static const uint64_t most_steps = 100000000;

typedef enum JunctionKind {
    JUNCTION_OPEN,
    JUNCTION_JOINED,
    JUNCTION_SHORT,
    JUNCTION_SHARP,
    JUNCTION_CROWDED
} JunctionKind;

/* End 2 i is where segment i begins, 2 i + 1 where it ends. */
typedef struct JointBuilder {
    const Tree *tree;
    const Coincidence *coincidence;
    IndexLists ends;     /* by place, rising */
    double *cut;         /* one an end, mm */
    JunctionKind *kinds; /* one a node; of those that stand for a place */
    uint64_t steps;      /* left of most_steps */
} JointBuilder;

typedef struct CutDemand {
    double part; /* the largest part of a vessel that a cut at the place takes */
    size_t junction;
} CutDemand;

static size_t junction_of(const JointBuilder *builder, size_t end)
{
    size_t node = end / 2;
    return (size_t)
        builder->coincidence->junction[end % 2 ? node : (size_t)builder->tree->parent[node]];
}

/* The point at an end before it is cut, and the unit axis from there along the vessel. */
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

/* The end that all joints of a place begin at. */
static size_t trunk_of(const JointBuilder *builder, size_t junction)
{
    size_t trunk = builder->ends.items[builder->ends.first[junction]];
    for (size_t k = builder->ends.first[junction]; k < builder->ends.first[junction + 1]; k++) {
        size_t end = builder->ends.items[k];
        if (end % 2)
            return end;
        if (builder->tree->radius_mm[end / 2] > builder->tree->radius_mm[trunk / 2])
            trunk = end;
    }
    return trunk;
}

/* Cuts the ends of a place as its joints ask for, and tells what kind of place that makes it and
 * which part of a vessel it takes. `ends` and `cut` have room for those of any place. */
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

/* Returns true if the cuts of a place fit beside those already made at the other ends of its
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

/* Decides the places whose cuts are known, in the order of their demands. */
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

/* The sphere of a place that cannot be joined; of equals, the trunk gives it its size and
 * color. */
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
    report->places_short += kind == JUNCTION_SHORT;
    report->places_sharp += kind == JUNCTION_SHARP;
    report->places_crowded += kind == JUNCTION_CROWDED;
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

/* Makes room for the axes of all joints. */
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
