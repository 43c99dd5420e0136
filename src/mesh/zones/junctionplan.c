/* The field of a zone holds the segments with an end in it. Those that leave it are cut off, or
 * prolonged, to end a little behind the plane where their tube begins: so far that the end is not
 * felt at the plane, and not so far that it could meet something else. */
#include "mesh/zones/junctions.h"

#include <stdlib.h>

typedef struct Planner {
    const VesselTree *tree;
    const NumberLists *incident, *blending;
    const Zones *zones;
    uint32_t zone;
    ZonePlan plan;
    size_t arm_capacity, term_capacity, member_capacity, n_members;
} Planner;

void zoneplan_release(ZonePlan *plan)
{
    free(plan->field.terms);
    free(plan->field.first);
    free(plan->field.members);
    free(plan->arms);
    *plan = (ZonePlan){0};
}

static Status add_arm(Planner *planner, uint32_t segment, int end, Err *err)
{
    ZonePlan *plan = &planner->plan;
    const FieldSegment *self = &planner->tree->segments[segment];
    Vec3 from = end ? self->b : self->a, to = end ? self->a : self->b;
    Vec3 outward = vec3_normalized(vec3_sub(to, from));
    double plane = planner->zones->plane[segment][end], radius = self->radius_mm;
    TRY(mem_reserve(&plan->arms, &planner->arm_capacity, plan->n_arms + 1, sizeof *plan->arms,
                    "tubes", err));
    ZoneTerm *term = &plan->field.terms[plan->field.n_terms++];
    *term = zoneterm_of(from, vec3_add_scaled(from, outward, plane + ARM_TAIL * radius), radius,
                        segment, planner->tree->body);
    term->arm = (uint16_t)plan->n_arms;
    plan->arms[plan->n_arms++] = (Arm){segment, end,    vec3_add_scaled(from, outward, plane),
                                       outward, radius, planner->zones->is_close[segment]};
    return STATUS_OK;
}

/* The segments at one node: whole ones once, at their first end. */
static Status add_node(Planner *planner, uint32_t node, Err *err)
{
    ZonePlan *plan = &planner->plan;
    const uint32_t *first = planner->incident->first;
    TRY(mem_reserve(&plan->field.terms, &planner->term_capacity,
                    plan->field.n_terms + first[node + 1] - first[node], sizeof *plan->field.terms,
                    "terms", err));
    for (uint32_t i = first[node]; i < first[node + 1]; i++) {
        uint32_t segment = planner->incident->items[i];
        const FieldSegment *self = &planner->tree->segments[segment];
        int end = segment_end_at(planner->tree, segment, node);
        if (planner->zones->is_tube[segment])
            TRY(add_arm(planner, segment, end, err));
        else if (end == 0)
            plan->field.terms[plan->field.n_terms++] =
                zoneterm_of(self->a, self->b, self->radius_mm, segment, planner->tree->body);
    }
    return STATUS_OK;
}

static int compare_terms(const void *a, const void *b)
{
    const ZoneTerm *one = a, *other = b;
    return (one->segment > other->segment) - (one->segment < other->segment);
}

/* The number of a segment among the terms in order, or n_terms. */
static uint32_t term_number(const ZoneField *field, uint32_t segment)
{
    const ZoneTerm key = {.segment = segment};
    const ZoneTerm *found = bsearch(&key, field->terms, field->n_terms, sizeof key, compare_terms);
    return found ? (uint32_t)(found - field->terms) : field->n_terms;
}

static Status add_group(Planner *planner, uint32_t node, Err *err)
{
    ZoneField *field = &planner->plan.field;
    const uint32_t *first = planner->blending->first;
    TRY(mem_reserve(&field->members, &planner->member_capacity,
                    planner->n_members + first[node + 1] - first[node], sizeof *field->members,
                    "terms", err));
    for (uint32_t i = first[node]; i < first[node + 1]; i++) {
        uint32_t number = term_number(field, planner->blending->items[i]);
        if (number < field->n_terms)
            field->members[planner->n_members++] = number;
    }
    field->first[++field->n_groups] = (uint32_t)planner->n_members;
    return STATUS_OK;
}

/* Each term a group. */
static Status add_lone_groups(Planner *planner, Err *err)
{
    ZoneField *field = &planner->plan.field;
    TRY(mem_calloc(&field->first, field->n_terms + 1, sizeof *field->first, "terms", err));
    TRY(mem_calloc(&field->members, field->n_terms, sizeof *field->members, "terms", err));
    for (uint32_t i = 0; i < field->n_terms; i++) {
        field->members[i] = i;
        field->first[++field->n_groups] = i + 1;
    }
    return STATUS_OK;
}

static Status add_groups(Planner *planner, const uint32_t *nodes, uint32_t n_nodes, Err *err)
{
    ZoneField *field = &planner->plan.field;
    if (planner->tree->body == BODY_ROUND)
        return add_lone_groups(planner, err);
    TRY(mem_calloc(&field->first, n_nodes + 1, sizeof *field->first, "nodes", err));
    for (uint32_t i = 0; i < n_nodes; i++)
        TRY(add_group(planner, nodes[i], err));
    return STATUS_OK;
}

Status zoneplan_make(const VesselTree *tree, const NumberLists *incident,
                     const NumberLists *blending, const Zones *zones, uint32_t zone, ZonePlan *out,
                     Err *err)
{
    Planner planner = {tree, incident, blending, zones, .zone = zone};
    ZonePlan *plan = &planner.plan;
    const uint32_t *nodes = &zones->nodes.items[zones->nodes.first[zone]];
    uint32_t n_nodes = zones->nodes.first[zone + 1] - zones->nodes.first[zone];
    Status status;
    for (uint32_t i = 0; i < n_nodes; i++)
        TRY_GOTO(add_node(&planner, nodes[i], err));
    qsort(plan->field.terms, plan->field.n_terms, sizeof *plan->field.terms, compare_terms);
    TRY_GOTO(add_groups(&planner, nodes, n_nodes, err));
    *out = *plan;
    return STATUS_OK;
done:
    zoneplan_release(plan);
    return status;
}
