/* From each end of a segment, those that it blends with on that side of it are felt up to the last
 * place where, on the circle of the wall, they add more than they may to the potential.
 * Nearer to the end the segment's own term ceases, and the others make up for it: of a straight
 * chain the sum is the cylinder's all along. So the wall is even where the sum of both is nearly
 * that of the segment alone, if it went on.
 *
 * Places are tried by steps from the far end on, and then halved in between. */
#include "mesh/zones/freeends.h"

#include "mesh/zones/junctionfield.h"
#include "mesh/zones/nearpairs.h"
#include <stdlib.h>

/* The wall moves by a quarter of these parts of the level, in radii: what others may add where it
 * is a cylinder, which the tolerance decides between bounds, and where it is nearly one. */
static const double least_part = 5e-3, most_part = 2e-2, uneven_part = 5e-2;
/* Of the radius: the step of the search, and how far it goes beyond the other end, as the arms of
 * zones do; how often a step is halved. */
static const double search_step = 0.15, run_on = 1;
enum { CIRCLE_POINTS = 12, HALVINGS = 3 };
/* Beyond so many of its radii from its axis a vessel adds less than a tenth of the least:
 * e^(-2 x^2) = 5e-4 e^-2. */
static const double field_reach = 2.2;

/* A vessel that blends at the end of another, and how far from there it may disturb that one. */
typedef struct Neighbor {
    double last_mm;
    uint32_t segment;
} Neighbor;

typedef struct FreeSearch {
    const VesselTree *tree;
    const NumberLists *incident, *blending;
    const TreeOrder *order;
    double disturbance; /* what others may add where the wall is a cylinder */
    FreeEnd (*ends)[2];
    Status *statuses; /* one a segment */
} FreeSearch;

/* A node where the segment blends, reached through another, `from`. */
typedef struct Step {
    uint32_t node, from;
    double way_mm;
} Step;

/* One end of a segment, and who may be felt there. */
typedef struct EndSearch {
    const VesselTree *tree;
    double disturbance;
    const FieldSegment *self;
    int end;
    double length_mm; /* that is searched */
    Vec3 axis;
    Neighbor *neighbors; /* those that reach farthest first */
    ZoneTerm *terms;     /* likewise */
    size_t n;
    Step *steps;
    uint32_t *others;
    size_t n_others, step_capacity, other_capacity;
} EndSearch;

/* Tells whether the sum of others on the wall, where the segment's own term lacks `ceased`, is
 * more than it may be. */
typedef bool TooMuch(const EndSearch *search, double others, double ceased);

static bool is_disturbed(const EndSearch *search, double others, double ceased)
{
    (void)ceased;
    return others > search->disturbance;
}

static bool is_uneven(const EndSearch *search, double others, double ceased)
{
    (void)search;
    return fabs(others - ceased) > uneven_part * FIELD_LEVEL;
}

static Vec3 place_at(const EndSearch *search, double mm)
{
    const FieldSegment *self = search->self;
    return search->end ? vec3_add_scaled(self->b, search->axis, -mm)
                       : vec3_add_scaled(self->a, search->axis, mm);
}

static double sum_at(const ZoneTerm *terms, size_t n, Vec3 x)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += zoneterm_value(&terms[i], x);
    return sum;
}

/* The point of the other vessel's axis that is nearest to x. */
static Vec3 nearest_of(const ZoneTerm *other, Vec3 x)
{
    double along = vec3_dot(vec3_sub(x, other->a), other->axis);
    return vec3_add_scaled(other->a, other->axis, fmin(fmax(along, 0), other->length_k / other->k));
}

/* Whether there is too much somewhere on the circle so far from the end, of the first `near`
 * others. Tries points all round the circle, and those that face each other vessel, which may be
 * thinner than the points are apart. */
static bool is_too_much(const EndSearch *search, size_t near, double mm, TooMuch *too_much)
{
    Vec3 u, v, center = place_at(search, mm);
    double radius = search->self->radius_mm;
    double ceased = search->tree->body == BODY_ROUND
                        ? 0
                        : 0.5 * FIELD_LEVEL * elementary_erfc(sqrt(2) * mm / radius);
    vec3_across(search->axis, &u, &v);
    for (size_t i = 0; i < CIRCLE_POINTS + near; i++) {
        double angle = FULL_TURN * (double)i / CIRCLE_POINTS;
        if (i >= CIRCLE_POINTS) {
            const ZoneTerm *other = &search->terms[i - CIRCLE_POINTS];
            Vec3 towards = vec3_sub(nearest_of(other, center), center);
            angle = elementary_atan2(vec3_dot(towards, v), vec3_dot(towards, u));
        }
        Vec3 x = vec3_add_scaled(center, u, radius * elementary_cos(angle));
        x = vec3_add_scaled(x, v, radius * elementary_sin(angle));
        if (too_much(search, sum_at(search->terms, near, x), ceased))
            return true;
    }
    return false;
}

static double distance_at(const EndSearch *search, double mm, const FieldSegment *other)
{
    return segment_distance_to(other, place_at(search, mm));
}

/* How far from the end of a segment the place is that is nearest to another. The distance is convex
 * along a line. */
static double nearest_place(const EndSearch *search, const FieldSegment *other)
{
    double low = 0, high = search->length_mm;
    for (int i = 0; i < 40; i++) {
        double one = low + (high - low) / 3, two = high - (high - low) / 3;
        if (distance_at(search, one, other) < distance_at(search, two, other))
            high = two;
        else
            low = one;
    }
    return low;
}

/* How far from the end of a segment another may disturb its wall: the last place whose distance
 * from the other's axis is within reach. */
static double last_near(const EndSearch *search, const FieldSegment *other)
{
    double radius = search->self->radius_mm, length = search->length_mm;
    double reach = radius + field_reach * other->radius_mm, low = 0, high = length;
    if (distance_at(search, 0, other) > reach)
        low = nearest_place(search, other);
    if (distance_at(search, low, other) > reach)
        return 0;
    if (distance_at(search, length, other) <= reach)
        return length;
    while (high - low > 1e-3 * radius) {
        double middle = 0.5 * (low + high);
        *(distance_at(search, middle, other) <= reach ? &low : &high) = middle;
    }
    return high;
}

static int compare_reach(const void *a, const void *b)
{
    const Neighbor *one = a, *other = b;
    if (one->last_mm != other->last_mm)
        return one->last_mm > other->last_mm ? -1 : 1;
    return (one->segment > other->segment) - (one->segment < other->segment);
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t one = *(const uint32_t *)a, other = *(const uint32_t *)b;
    return (one > other) - (one < other);
}

/* Lists the segments on this side that blend with the segment at one of the nodes where it blends,
 * each once or several times. */
static Status list_others(EndSearch *search, const FreeSearch *all, uint32_t segment)
{
    const VesselTree *tree = all->tree;
    const NumberLists *blending = all->blending, *incident = all->incident;
    double limit = BLEND_REACH * search->self->radius_mm;
    TRY(mem_reserve(&search->steps, &search->step_capacity, 1, sizeof *search->steps, "terms",
                    NULL));
    search->steps[0] = (Step){tree->nodes[segment][search->end], segment, 0};
    size_t n_steps = 1;
    for (size_t i = 0; i < n_steps; i++) {
        const Step step = search->steps[i];
        for (uint32_t k = blending->first[step.node]; k < blending->first[step.node + 1]; k++) {
            uint32_t other = blending->items[k];
            if (other == segment ||
                treeorder_end_towards(all->order, tree, segment, other) != search->end)
                continue;
            TRY(mem_reserve(&search->others, &search->other_capacity, search->n_others + 1,
                            sizeof *search->others, "terms", NULL));
            search->others[search->n_others++] = other;
        }
        for (uint32_t k = incident->first[step.node]; k < incident->first[step.node + 1]; k++) {
            uint32_t next = incident->items[k];
            const FieldSegment *way = &tree->segments[next];
            double way_mm = step.way_mm + vec3_distance(way->a, way->b);
            uint32_t beyond = tree->nodes[next][!segment_end_at(tree, next, step.node)];
            if (next == step.from || way_mm > limit)
                continue;
            TRY(mem_reserve(&search->steps, &search->step_capacity, n_steps + 1,
                            sizeof *search->steps, "terms", NULL));
            search->steps[n_steps++] = (Step){beyond, next, way_mm};
        }
    }
    return STATUS_OK;
}

/* Makes the neighbours of the others that may disturb the segment, and their terms. */
static Status find_neighbors(EndSearch *search)
{
    const VesselTree *tree = search->tree;
    const uint32_t *others = search->others;
    if (search->n_others == 0)
        return STATUS_OK;
    TRY(mem_calloc(&search->neighbors, search->n_others, sizeof *search->neighbors, "terms", NULL));
    TRY(mem_calloc(&search->terms, search->n_others, sizeof *search->terms, "terms", NULL));
    qsort(search->others, search->n_others, sizeof *search->others, compare_numbers);
    for (size_t i = 0; i < search->n_others; i++) {
        bool again = i > 0 && others[i] == others[i - 1];
        double last = again ? 0 : last_near(search, &tree->segments[others[i]]);
        if (last > 0)
            search->neighbors[search->n++] = (Neighbor){last, others[i]};
    }
    qsort(search->neighbors, search->n, sizeof *search->neighbors, compare_reach);
    for (size_t i = 0; i < search->n; i++) {
        uint32_t number = search->neighbors[i].segment;
        const FieldSegment *other = &tree->segments[number];
        search->terms[i] = zoneterm_of(other->a, other->b, other->radius_mm, number, tree->body);
    }
    return STATUS_OK;
}

/* How many of the others may be felt so far from the end. */
static size_t count_near(const EndSearch *search, double mm)
{
    size_t near = 0;
    while (near < search->n && search->neighbors[near].last_mm >= mm)
        near++;
    return near;
}

/* From where on there is nowhere too much, up to `most`: beyond the last place where there is, as a
 * thin vessel that leaves a thick one at a small angle comes out of its wall far from the node. */
static double last_place(const EndSearch *search, double most, TooMuch *too_much)
{
    double step = search_step * search->self->radius_mm;
    for (double steps = ceil(most / step); steps > 0; steps--) {
        double low = (steps - 1) * step, high = steps * step;
        if (!is_too_much(search, count_near(search, low), low, too_much))
            continue;
        for (int i = 0; i < HALVINGS; i++) {
            double middle = 0.5 * (low + high);
            bool is_low = is_too_much(search, count_near(search, middle), middle, too_much);
            *(is_low ? &low : &high) = middle;
        }
        return high;
    }
    return 0;
}

/* The farthest place, from the end on, beside which another vessel ends within the segment's own:
 * it may not be felt at the wall, and yet must not come out behind a plane. */
static double last_within(const EndSearch *search)
{
    double last = 0, sign = search->end ? -1 : 1;
    for (size_t i = 0; i < search->n; i++) {
        const FieldSegment *other = &search->tree->segments[search->neighbors[i].segment];
        for (int end = 0; end < 2; end++) {
            Vec3 from = vec3_sub(end ? other->b : other->a, place_at(search, 0));
            double along = sign * vec3_dot(from, search->axis);
            double across2 = vec3_dot(from, from) - along * along;
            if (across2 < search->self->radius_mm * search->self->radius_mm)
                last = fmax(last, along);
        }
    }
    return last;
}

static Status find_free(const FreeSearch *all, uint32_t segment, int end)
{
    const VesselTree *tree = all->tree;
    const FieldSegment *self = &tree->segments[segment];
    double length = vec3_distance(self->a, self->b), radius = self->radius_mm;
    EndSearch search = {.tree = tree,
                        .disturbance = all->disturbance,
                        .self = self,
                        .end = end,
                        .length_mm = length + run_on * radius,
                        .axis = vec3_normalized(vec3_sub(self->b, self->a))};
    Status status;
    TRY_GOTO(list_others(&search, all, segment));
    TRY_GOTO(find_neighbors(&search));
    if (search.n) {
        double clear = last_place(&search, search.neighbors[0].last_mm, is_disturbed), even = clear;
        if (tree->body != BODY_ROUND)
            even = last_place(&search, fmax(clear, radius), is_uneven);
        even = fmax(even, last_within(&search));
        all->ends[segment][end] = (FreeEnd){even, fmax(clear, even)};
    }
done:
    free(search.neighbors);
    free(search.terms);
    free(search.steps);
    free(search.others);
    return status;
}

static void find_both_free(size_t index, int worker, void *context)
{
    (void)worker;
    const FreeSearch *search = context;
    for (int end = 0; end < 2 && search->statuses[index] == STATUS_OK; end++)
        search->statuses[index] = find_free(search, (uint32_t)index, end);
}

double freeends_moved(const MeshParams *params)
{
    return 0.25 * fmin(fmax(params->tolerance, least_part), most_part);
}

Status freeends_find(const VesselTree *tree, const NumberLists *incident,
                     const NumberLists *blending, const TreeOrder *order, const MeshParams *params,
                     FreeEnd (*ends)[2], Err *err)
{
    size_t n = tree->n_segments;
    double disturbance = 4 * freeends_moved(params) * FIELD_LEVEL;
    FreeSearch search = {tree, incident, blending, order, disturbance, ends, NULL};
    TRY(mem_calloc(&search.statuses, n, sizeof *search.statuses, "segments", err));
    threads_for(n, params->threads, find_both_free, &search);
    Status status = STATUS_OK;
    for (size_t i = 0; i < n && status == STATUS_OK; i++)
        if (search.statuses[i] != STATUS_OK)
            status = mem_out_of("for", "the terms of a junction", err);
    free(search.statuses);
    return status;
}
