/* Plans the mesh of one junction region: the terms of its implicit surface, the groups of these
 * terms, and the stubs where tubes begin.
 *
 * Each segment with an end in the region contributes a term. A segment that continues outside the
 * region as a tube contributes a stub: its term ends STUB_TAIL radii beyond the plane where the
 * tube begins, for any length of the segment. All other segments contribute their whole length. A
 * group holds the terms that blend with each other at one node. The terms are sorted by segment, so
 * that the members of a group are found in O(log terms). */
#include "mesh/regions/junctions.h"

#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

typedef struct JunctionPlanner {
    const VesselTree *tree;
    const Junctions *junctions;
    JunctionPlan plan;
    size_t stub_capacity, term_capacity, member_capacity, n_members;
} JunctionPlanner;

void junctionplan_release(JunctionPlan *plan)
{
    free(plan->field.terms);
    free(plan->field.first);
    free(plan->field.members);
    free(plan->stubs);
    *plan = (JunctionPlan){0};
}

/* Adds the term and the stub of a segment that leaves the region at `end`. The direction into the
 * segment is the direction out of the region. `plane` is the distance of the plane from the end,
 * mm. */
static Status add_stub(JunctionPlanner *planner, uint32_t segment, int end, Err *err)
{
    JunctionPlan *plan = &planner->plan;
    const FieldSegment *self = &planner->tree->segments[segment];
    Vec3 from = segment_end(self, end), outward = segment_inward(self, end);
    double plane = planner->junctions->plane[segment][end], radius = self->radius_mm;
    TRY(mem_reserve(&plan->stubs, &planner->stub_capacity, plan->n_stubs + 1, sizeof *plan->stubs,
                    "tubes", err));
    PotentialTerm *term = &plan->field.terms[plan->field.n_terms++];
    *term = potentialterm_make(from, vec3_add_scaled(from, outward, plane + STUB_TAIL * radius),
                               radius, segment, planner->tree->body);
    term->stub = (uint16_t)plan->n_stubs;
    plan->stubs[plan->n_stubs++] =
        (BranchStub){segment, end,    vec3_add_scaled(from, outward, plane),
                     outward, radius, planner->junctions->is_close[segment]};
    return STATUS_OK;
}

/* Adds the terms of the segments that end at a node. A segment that is entirely in the region is
 * added at its first end only, so that it is added once. */
static Status add_node(JunctionPlanner *planner, uint32_t node, Err *err)
{
    JunctionPlan *plan = &planner->plan;
    const uint32_t *first = planner->junctions->incident.first;
    TRY(mem_reserve(&plan->field.terms, &planner->term_capacity,
                    plan->field.n_terms + first[node + 1] - first[node], sizeof *plan->field.terms,
                    "terms", err));
    for (uint32_t i = first[node]; i < first[node + 1]; i++) {
        uint32_t segment = planner->junctions->incident.items[i];
        const FieldSegment *self = &planner->tree->segments[segment];
        int end = segment_end_at(planner->tree, segment, node);
        if (planner->junctions->is_tube[segment])
            TRY(add_stub(planner, segment, end, err));
        else if (end == 0)
            plan->field.terms[plan->field.n_terms++] =
                potentialterm_make(self->a, self->b, self->radius_mm, segment, planner->tree->body);
    }
    return STATUS_OK;
}

/* Orders terms by segment, and the two stubs of one segment by index. */
static int compare_terms(const void *a, const void *b)
{
    const PotentialTerm *one = a, *other = b;
    int order = compare_numbers(one->segment, other->segment);
    return order ? order : one->stub - other->stub;
}

/* Adds the group of a node: the terms of the segments that blend at this node. A segment has two
 * terms if both its stubs are in the region; hence the capacity of two members per segment. */
static Status add_group(JunctionPlanner *planner, uint32_t node, Err *err)
{
    JunctionField *field = &planner->plan.field;
    const uint32_t *first = planner->junctions->blending.first;
    TRY(mem_reserve(&field->members, &planner->member_capacity,
                    planner->n_members + 2 * (first[node + 1] - first[node]),
                    sizeof *field->members, "terms", err));
    for (uint32_t i = first[node]; i < first[node + 1]; i++) {
        uint32_t segment = planner->junctions->blending.items[i];
        for (size_t k =
                 sorted_find_row(field->terms, field->n_terms, sizeof *field->terms, segment);
             k < field->n_terms && field->terms[k].segment == segment; k++)
            field->members[planner->n_members++] = (uint32_t)k;
    }
    field->first[++field->n_groups] = (uint32_t)planner->n_members;
    return STATUS_OK;
}

/* Makes each term a group of its own, because BODY_ROUND terms do not blend. */
static Status add_lone_groups(JunctionPlanner *planner, Err *err)
{
    JunctionField *field = &planner->plan.field;
    TRY(mem_calloc(&field->first, field->n_terms + 1, sizeof *field->first, "terms", err));
    TRY(mem_calloc(&field->members, field->n_terms, sizeof *field->members, "terms", err));
    for (uint32_t i = 0; i < field->n_terms; i++) {
        field->members[i] = i;
        field->first[++field->n_groups] = i + 1;
    }
    return STATUS_OK;
}

static Status add_groups(JunctionPlanner *planner, const uint32_t *nodes, uint32_t n_nodes,
                         Err *err)
{
    JunctionField *field = &planner->plan.field;
    if (planner->tree->body == BODY_ROUND)
        return add_lone_groups(planner, err);
    TRY(mem_calloc(&field->first, n_nodes + 1, sizeof *field->first, "nodes", err));
    for (uint32_t i = 0; i < n_nodes; i++)
        TRY(add_group(planner, nodes[i], err));
    return STATUS_OK;
}

Status junctionplan_make(const VesselTree *tree, const Junctions *junctions, uint32_t index,
                         JunctionPlan *out, Err *err)
{
    JunctionPlanner planner = {.tree = tree, .junctions = junctions};
    JunctionPlan *plan = &planner.plan;
    const uint32_t *nodes = &junctions->nodes.items[junctions->nodes.first[index]];
    uint32_t n_nodes = indexlists_length(&junctions->nodes, index);
    Status status;
    for (uint32_t i = 0; i < n_nodes; i++)
        TRY_GOTO(add_node(&planner, nodes[i], err));
    qsort(plan->field.terms, plan->field.n_terms, sizeof *plan->field.terms, compare_terms);
    TRY_GOTO(add_groups(&planner, nodes, n_nodes, err));
    /* The segments that are entirely in the region connect its nodes, so their graph has segments -
     * nodes + 1 independent loops. */
    plan->n_loops = plan->field.n_terms - plan->n_stubs + 1 - n_nodes;
    *out = *plan;
    return STATUS_OK;
done:
    junctionplan_release(plan);
    return status;
}
