/* Finds where along a segment other vessels no longer change its surface.
 *
 * The vessels that blend with a segment at one end add to the potential on its surface. The surface
 * is a cylinder from the last circle on where they add more than is allowed. Nearer to the end, the
 * segment's own term falls off, and the other vessels make up for the loss: along a straight chain
 * of segments, the sum is that of a cylinder everywhere. So the surface is nearly a cylinder where
 * the sum nearly equals the term that the segment would have if it continued.
 *
 * Circles are tested in steps from the far end on. The step that holds the last circle is halved a
 * few times. */
#include "mesh/regions/freeends.h"

#include "mesh/regions/junctionfield.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

/* In units of FIELD_LEVEL: the potential that other vessels may add. An addition of p moves the
 * surface by p / 4 radii. Where the surface must be a cylinder, the limit is the tolerance of the
 * mesh, but at least min_disturbance and at most max_disturbance: 0.00125 to 0.005 radii. Below the
 * minimum, long tubes would become parts of regions; above the maximum, a coarse mesh would show a
 * step at the plane. Where the surface must be nearly a cylinder, the limit is
 * near_cylinder_tolerance, 0.0125 radii. There, the points of a rim are moved to the true surface,
 * so the limit may be wider. */
static const double min_disturbance = 5e-3, max_disturbance = 2e-2, near_cylinder_tolerance = 5e-2;
/* In units of the radius: the step of the search, and the length by which the search goes on beyond
 * the other end. The search goes on because the stubs of regions continue beyond their planes. A
 * smaller step costs more tests; a larger one may miss a thin vessel that pierces the surface
 * between two circles. */
static const double search_step = 0.15, search_beyond = 1;
/* Number of points on a tested circle: one every 30 degrees, besides those that face other vessels.
 * Number of times that the last step is halved: 3 times give the plane to 0.02 radii, because a
 * plane that is farther away only makes the region larger. */
enum { CIRCLE_POINTS = 12, HALVINGS = 3 };
/* In units of a vessel's radius: beyond this distance from its axis, its term is below a tenth of
 * min_disturbance: exp(-2 * 2.2^2) = 6.2e-5 is less than 5e-4 FIELD_LEVEL = 6.8e-5. */
static const double field_reach = 2.2;

/* A vessel that blends with the segment, and the distance from the end up to which it may change
 * the segment's surface. */
typedef struct Disturber {
    double last_mm;
    uint32_t segment;
} Disturber;

typedef struct FreeSearch {
    const FreeEndInput *input;
    double disturbance; /* potential that others may add where the surface is a cylinder */
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

/* How strictly a circle is tested. */
typedef enum CircleTest {
    TEST_CYLINDER,     /* other vessels add at most EndSearch.disturbance */
    TEST_NEAR_CYLINDER /* other vessels make up for what the segment's own term lacks */
} CircleTest;

/* Returns the point of the axis at a distance from the end. */
static Vec3 axis_point(const EndSearch *search, double mm)
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

/* Returns true if the circle at a distance from the end circle_fails a test against the first
 * `near` disturbers. Tests points all round the circle, and the point that faces each disturber,
 * because a vessel may be thinner than the distance between the points. */
static bool circle_fails(const EndSearch *search, size_t near, double mm, CircleTest test)
{
    Vec3 u, v, center = axis_point(search, mm);
    double radius = search->self->radius_mm;
    /* the part of its value far from the end that the segment's own term lacks here */
    double lack = 0.5 * FIELD_LEVEL * elementary_erfc(sqrt(2) * mm / radius);
    vec3_perpendiculars(search->axis, &u, &v);
    for (size_t i = 0; i < CIRCLE_POINTS + near; i++) {
        double angle = FULL_TURN * (double)i / CIRCLE_POINTS;
        if (i >= CIRCLE_POINTS) {
            const PotentialTerm *other = &search->terms[i - CIRCLE_POINTS];
            Vec3 towards = vec3_sub(nearest_of(other, center), center);
            angle = elementary_atan2(vec3_dot(towards, v), vec3_dot(towards, u));
        }
        Vec3 x = vec3_add_scaled(center, u, radius * elementary_cos(angle));
        x = vec3_add_scaled(x, v, radius * elementary_sin(angle));
        double sum = sum_at(search->terms, near, x);
        if (test == TEST_CYLINDER ? sum > search->disturbance
                                  : fabs(sum - lack) > near_cylinder_tolerance * FIELD_LEVEL)
            return true;
    }
    return false;
}

static double distance_at(const EndSearch *search, double mm, const FieldSegment *other)
{
    return segment_distance_to(other, axis_point(search, mm));
}

/* Returns the distance from the end to the point of the axis that is nearest to another segment. A
 * ternary search finds it, because the distance from a segment is a convex function along a line.
 * 40 steps reduce the interval to 1e-7 of its length. */
static double nearest_axis_position(const EndSearch *search, const FieldSegment *other)
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

/* Returns the distance from the end up to which another vessel may change the surface: that of the
 * last point of the axis within reach of the other vessel's axis. */
static double last_within_reach(const EndSearch *search, const FieldSegment *other)
{
    double radius = search->self->radius_mm, length = search->length_mm;
    double reach = radius + field_reach * other->radius_mm, low = 0, high = length;
    if (distance_at(search, 0, other) > reach)
        low = nearest_axis_position(search, other);
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
    int order = compare_numbers(other->last_mm, one->last_mm);
    return order ? order : compare_numbers(one->segment, other->segment);
}

static int compare_segments(const void *a, const void *b)
{
    return compare_numbers(*(const uint32_t *)a, *(const uint32_t *)b);
}

/* Lists a node that the search reached, unless a path that is not longer is known. Few nodes are
 * within the reach, so the list itself is searched. */
static Status add_step(EndSearch *search, BlendStep step, Err *err)
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
    TRY(add_step(search, (BlendStep){tree->nodes[segment][search->end], segment, 0}, err));
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
                TRY(add_step(search, (BlendStep){beyond, next, path_mm}, err));
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
    qsort(search->others.items, n, sizeof *search->others.items, compare_segments);
    for (size_t i = 0; i < n; i++) {
        bool again = i > 0 && others[i] == others[i - 1];
        double last = again ? 0 : last_within_reach(search, &tree->segments[others[i]]);
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

/* Returns the distance, at most about `most`, of the last circle that circle_fails the test. The
 * last one that circle_fails counts, not the first one that passes: a thin vessel that leaves a
 * thick one at a small angle comes out of the thick vessel's surface far from the node. */
static double last_failure(const EndSearch *search, double most, CircleTest test)
{
    double step = search_step * search->self->radius_mm;
    for (double steps = ceil(most / step); steps > 0; steps--) {
        double low = (steps - 1) * step, high = steps * step;
        if (!circle_fails(search, count_near(search, low), low, test))
            continue;
        for (int i = 0; i < HALVINGS; i++) {
            double middle = 0.5 * (low + high);
            bool is_low = circle_fails(search, count_near(search, middle), middle, test);
            *(is_low ? &low : &high) = middle;
        }
        return high;
    }
    return 0;
}

/* Returns the distance along the axis of the farthest end of another vessel that is inside this
 * vessel; 0 if there is none. Such a vessel may leave the surface as it is, but it must not come
 * out of the surface beyond a plane. */
static double last_enclosed_end(const EndSearch *search)
{
    double last = 0, sign = search->end ? -1 : 1;
    for (size_t i = 0; i < search->n; i++) {
        const FieldSegment *other = &search->tree->segments[search->disturbers[i].segment];
        for (int end = 0; end < 2; end++) {
            Vec3 from = vec3_sub(segment_end(other, end), axis_point(search, 0));
            double along = sign * vec3_dot(from, search->axis);
            double across2 = vec3_dot(from, from) - along * along;
            if (across2 < search->self->radius_mm * search->self->radius_mm)
                last = fmax(last, along);
        }
    }
    return last;
}

/* Finds the free part at one end of a segment. The ends stay 0 if no other vessel disturbs the
 * segment. */
static Status find_free_end(const FreeSearch *all, uint32_t segment, int end, Err *err)
{
    const VesselTree *tree = all->input->tree;
    const FieldSegment *self = &tree->segments[segment];
    double radius = self->radius_mm;
    EndSearch search = {.tree = tree,
                        .disturbance = all->disturbance,
                        .self = self,
                        .end = end,
                        .length_mm = segment_length(self) + search_beyond * radius,
                        .axis = segment_axis(self)};
    Status status;
    TRY_GOTO(list_others(&search, all->input, segment, err));
    TRY_GOTO(find_disturbers(&search, err));
    if (search.n) {
        double clear = last_failure(&search, search.disturbers[0].last_mm, TEST_CYLINDER);
        double even = tree->body == BODY_ROUND
                          ? clear
                          : last_failure(&search, fmax(clear, radius), TEST_NEAR_CYLINDER);
        even = fmax(even, last_enclosed_end(&search));
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
    TRY(find_free_end(context, (uint32_t)index, 0, err));
    return find_free_end(context, (uint32_t)index, 1, err);
}

double freeends_max_shift(const MeshParams *params)
{
    return 0.25 * fmin(fmax(params->tolerance, min_disturbance), max_disturbance);
}

Status freeends_find(const FreeEndInput *input, FreeEnd (*ends)[2], Err *err)
{
    FreeSearch search = {input, 4 * freeends_max_shift(input->params) * FIELD_LEVEL, ends};
    return threads_try(input->tree->n_segments, input->params->threads, find_both_free, &search,
                       err);
}
