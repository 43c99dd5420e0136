/* The vessels that blend with a segment on one side change its surface up to the last place where,
 * on the circle of its surface, they add more to the potential than is allowed. Nearer to the end,
 * the segment's own term falls off, and the other vessels make up for it: along a straight chain of
 * segments the sum is that of a cylinder everywhere. So the surface is even where the sum of both
 * is nearly that of the segment alone, if it continued.
 *
 * Places are tried in steps from the far end on. The interval that the last one is in is halved. */
#include "mesh/regions/freeends.h"

#include "mesh/regions/junctionfield.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

/* In units of the level: what other vessels may add. Adding a part p moves the surface by p / 4
 * radii. least_part and most_part bound the tolerance where the surface must be a cylinder;
 * uneven_part is for where it must nearly be one. */
static const double least_part = 5e-3, most_part = 2e-2, uneven_part = 5e-2;
/* In units of the radius: the step of the search, and how far the search goes beyond the other end,
 * as the stubs of regions do. */
static const double search_step = 0.15, run_on = 1;
/* Points on the circle of a place; how often the last step is halved. */
enum { CIRCLE_POINTS = 12, HALVINGS = 3 };
/* In units of a vessel's radius: beyond this distance from its axis, its term is below a tenth of
 * least_part, e^(-2 x^2) = 5e-4 e^-2. */
static const double field_reach = 2.2;

/* A vessel that blends with the segment, and the distance up to which it may disturb it. */
typedef struct Disturber {
    double last_mm;
    uint32_t segment;
} Disturber;

typedef struct FreeSearch {
    const FreeEndInput *input;
    double disturbance; /* what others may add where the surface is a cylinder */
    FreeEnd (*ends)[2];
} FreeSearch;

/* A node within BLEND_REACH, reached along the segment `from`. */
typedef struct BlendStep {
    uint32_t node, from;
    double path_mm;
} BlendStep;

/* The search at one end of a segment. */
typedef struct EndSearch {
    const VesselTree *tree;
    double disturbance;
    const FieldSegment *self;
    int end;
    double length_mm; /* of the part that is searched */
    Vec3 axis;
    Disturber *disturbers; /* by falling last_mm */
    PotentialTerm *terms;  /* of the disturbers */
    size_t n;
    ARRAY(BlendStep) steps;
    ARRAY(uint32_t) others; /* segments that blend with this one; may repeat */
} EndSearch;

/* A test of one place on the segment's surface. Returns true if `others`, the sum of the terms of
 * other vessels, is too large. `ceased` is what the segment's own term lacks there. */
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

static double sum_at(const PotentialTerm *terms, size_t n, Vec3 x)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += potentialterm_value(&terms[i], x);
    return sum;
}

/* Returns the point of the other vessel's axis that is nearest to x. */
static Vec3 nearest_of(const PotentialTerm *other, Vec3 x)
{
    double along = vec3_dot(vec3_sub(x, other->a), other->axis);
    return vec3_add_scaled(other->a, other->axis, fmin(fmax(along, 0), other->length_k / other->k));
}

/* Tests the circle at a distance from the end against the first `near` disturbers. Tries points all
 * round the circle, and the point that faces each disturber, because a vessel may be thinner than
 * the distance between the points. */
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
            const PotentialTerm *other = &search->terms[i - CIRCLE_POINTS];
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

/* Returns the distance from the end to the place that is nearest to another segment. The distance
 * of a segment is convex along a line. */
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

/* Returns the distance from the end up to which another vessel may disturb the surface: that of the
 * last place within reach of the other vessel's axis. */
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
    const Disturber *one = a, *other = b;
    if (one->last_mm != other->last_mm)
        return one->last_mm > other->last_mm ? -1 : 1;
    return (one->segment > other->segment) - (one->segment < other->segment);
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t one = *(const uint32_t *)a, other = *(const uint32_t *)b;
    return (one > other) - (one < other);
}

/* Lists a node that the search reached, unless a path that is not longer is known. Few nodes are
 * within the reach, so the list itself is searched. */
static Status reach(EndSearch *search, BlendStep step, Err *err)
{
    for (size_t i = 0; i < search->steps.n; i++)
        if (search->steps.items[i].node == step.node &&
            search->steps.items[i].path_mm <= step.path_mm)
            return STATUS_OK;
    return ARRAY_PUSH(&search->steps, "terms", err, step);
}

/* Lists the segments on this side that blend with the segment at one of the nodes where it blends.
 * A segment may be listed several times. */
static Status list_others(EndSearch *search, const FreeEndInput *input, uint32_t segment, Err *err)
{
    const VesselTree *tree = input->tree;
    const IndexLists *blending = input->blending, *incident = input->incident;
    double limit = BLEND_REACH * search->self->radius_mm;
    TRY(reach(search, (BlendStep){tree->nodes[segment][search->end], segment, 0}, err));
    for (size_t i = 0; i < search->steps.n; i++) {
        const BlendStep step = search->steps.items[i];
        for (uint32_t k = blending->first[step.node]; k < blending->first[step.node + 1]; k++) {
            uint32_t other = blending->items[k];
            if (other != segment &&
                treeorder_end_towards(input->order, tree, segment, other) == search->end)
                TRY(ARRAY_PUSH(&search->others, "terms", err, other));
        }
        for (uint32_t k = incident->first[step.node]; k < incident->first[step.node + 1]; k++) {
            uint32_t next = incident->items[k];
            double path_mm = step.path_mm + segment_length(&tree->segments[next]);
            uint32_t beyond = tree->nodes[next][!segment_end_at(tree, next, step.node)];
            if (next != step.from && path_mm <= limit)
                TRY(reach(search, (BlendStep){beyond, next, path_mm}, err));
        }
    }
    return STATUS_OK;
}

/* Finds which of the others may disturb the segment, and makes their terms. */
static Status find_disturbers(EndSearch *search, Err *err)
{
    const VesselTree *tree = search->tree;
    const uint32_t *others = search->others.items;
    size_t n = search->others.n;
    if (n == 0)
        return STATUS_OK;
    TRY(mem_calloc(&search->disturbers, n, sizeof *search->disturbers, "terms", err));
    TRY(mem_calloc(&search->terms, n, sizeof *search->terms, "terms", err));
    qsort(search->others.items, n, sizeof *search->others.items, compare_numbers);
    for (size_t i = 0; i < n; i++) {
        bool again = i > 0 && others[i] == others[i - 1];
        double last = again ? 0 : last_near(search, &tree->segments[others[i]]);
        if (last > 0)
            search->disturbers[search->n++] = (Disturber){last, others[i]};
    }
    qsort(search->disturbers, search->n, sizeof *search->disturbers, compare_reach);
    for (size_t i = 0; i < search->n; i++) {
        uint32_t index = search->disturbers[i].segment;
        const FieldSegment *other = &tree->segments[index];
        search->terms[i] =
            potentialterm_make(other->a, other->b, other->radius_mm, index, tree->body);
    }
    return STATUS_OK;
}

/* Returns the number of disturbers that reach this far from the end. */
static size_t count_near(const EndSearch *search, double mm)
{
    size_t near = 0;
    while (near < search->n && search->disturbers[near].last_mm >= mm)
        near++;
    return near;
}

/* Returns the distance, at most `most`, beyond the last place that fails the test. The last place
 * counts, not the first that passes: a thin vessel that leaves a thick one at a small angle comes
 * out of its surface far from the node. */
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

/* Returns the distance of the farthest place beside which another vessel ends inside the segment's
 * own. Such a vessel may not change the surface, but it must not come out of it behind a plane. */
static double last_within(const EndSearch *search)
{
    double last = 0, sign = search->end ? -1 : 1;
    for (size_t i = 0; i < search->n; i++) {
        const FieldSegment *other = &search->tree->segments[search->disturbers[i].segment];
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

static Status find_free(const FreeSearch *all, uint32_t segment, int end, Err *err)
{
    const VesselTree *tree = all->input->tree;
    const FieldSegment *self = &tree->segments[segment];
    double radius = self->radius_mm;
    EndSearch search = {.tree = tree,
                        .disturbance = all->disturbance,
                        .self = self,
                        .end = end,
                        .length_mm = segment_length(self) + run_on * radius,
                        .axis = segment_axis(self)};
    Status status;
    TRY_GOTO(list_others(&search, all->input, segment, err));
    TRY_GOTO(find_disturbers(&search, err));
    if (search.n) {
        double clear = last_place(&search, search.disturbers[0].last_mm, is_disturbed),
               even = clear;
        if (tree->body != BODY_ROUND)
            even = last_place(&search, fmax(clear, radius), is_uneven);
        even = fmax(even, last_within(&search));
        all->ends[segment][end] = (FreeEnd){even, fmax(clear, even)};
    }
done:
    free(search.disturbers);
    free(search.terms);
    ARRAY_RELEASE(&search.steps);
    ARRAY_RELEASE(&search.others);
    return status;
}

static Status find_both_free(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    TRY(find_free(context, (uint32_t)index, 0, err));
    return find_free(context, (uint32_t)index, 1, err);
}

double freeends_max_shift(const MeshParams *params)
{
    return 0.25 * fmin(fmax(params->tolerance, least_part), most_part);
}

Status freeends_find(const FreeEndInput *input, FreeEnd (*ends)[2], Err *err)
{
    FreeSearch search = {input, 4 * freeends_max_shift(input->params) * FIELD_LEVEL, ends};
    return threads_try(input->tree->n_segments, input->params->threads, find_both_free, &search,
                       err);
}
