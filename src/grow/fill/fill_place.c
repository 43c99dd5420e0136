/* Places the drawn elements of a filling [fill_draw.c] in space. An element is a chain of straight
 * segments, a vessel of one order.
 *
 * Elements are placed order by order, from the highest to the lowest, so that large vessels find
 * space. Each segment takes one of DIRECTIONS directions on two cones (FillCourse.cone) around the
 * direction of the vessel that it continues or leaves: the one with the largest gap to other
 * vessels that stays in the domain. If a vessel is in the way in all of these directions, wider
 * cones are tried. If no straight segment stays in the domain, two of half the length take its
 * place [docs/METHODS.md 1.2, filling]. */
#include "grow/fill/fill_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Number of directions per ring (pair of cones): six on each cone, 60 degrees apart. More
 * directions find larger gaps and take more time. */
enum { DIRECTIONS = 12 };
/* Number of rings; the last one leads backwards. */
enum { RINGS = 3 };
/* Number of times that a segment may be halved where no straight segment stays in the domain: its
 * parts have at least 1/32 of its length. */
enum { MOST_BENDS = 5 };
/* Maximum number of points on a grown element that are tried for a daughter. The best of them is
 * used if none has space, so more only help in crowded places. */
enum { ATTEMPTS = 32 };
/* Gaps above enough_gap times the segment's length plus enough_radii times its radius count as
 * equal, and the random order decides. If only the largest gap counted, all vessels would lead away
 * from each other; larger values also search farther. */
static const double enough_gap = 0.4, enough_radii = 2;
/* Number of grid cells per segment. With fewer cells, a query finds more segments out of reach;
 * with more, a segment is entered in more cells. Results do not depend on it. */
static const double cells_per_segment = 4;
/* Number of nodes that bends may add, relative to all nodes. Without a limit, elements along the
 * boundary of the domain would consist of ever smaller parts. */
static const double spare_nodes = 0.25;
/* Angles, in degrees, between a daughter and its parent: wide_angle if the daughter is as wide as
 * its parent, thin_angle if it is thin, as daughters of Murray's law branch off at a larger angle
 * the thinner they are. The two cones of the first ring differ from this angle by `spread`. The
 * other rings have the angles in `wider`, which leave hardly any direction out. Source of the
 * values not recorded; other angles give trees of another shape. */
static const double wide_angle = 40, thin_angle = 75, spread = 12;
static const double wider[RINGS][2] = {{-1, 1}, {90, 115}, {140, 165}};
/* The same for a segment that continues a segment of the same element: nearly straight if there is
 * space. */
static const double onward[RINGS][2] = {{8, 22}, {45, 75}, {110, 150}};
/* Elements from one report of progress to the next. */
enum { ELEMENTS_PER_REPORT = 1024 };

void places_release(Places *places)
{
    free(places->node);
    free(places->end_node);
    free(places->start_node);
    free(places->stamp);
    free(places->near);
    grid_release(&places->grid);
    *places = (Places){0};
}

Status places_init(Places *places, const Tree *tree, Err *err)
{
    const size_t elements = places->filling->n;
    TRY(mem_reserve(&places->node, &places->capacity, tree->n, sizeof *places->node, "nodes", err));
    TRY(mem_calloc(&places->end_node, elements, sizeof *places->end_node, "elements", err));
    TRY(mem_calloc(&places->start_node, elements, sizeof *places->start_node, "elements", err));
    for (size_t k = 0; k < elements; k++)
        places->end_node[k] = places->start_node[k] = NO_NODE;
    for (size_t i = 0; i < tree->n; i++)
        places->node[i] =
            (FillNode){tree->position[i], tree->radius_mm[i], tree->parent[i], (int32_t)i, true};
    places->n = tree->n;
    places->last_id = tree_max_id(tree);
    return STATUS_OK;
}

static Vec3 proximal(const Places *places, int32_t i)
{
    return places->node[places->node[i].parent].at;
}

static double length_of(const Places *places, int32_t i)
{
    return vec3_distance(proximal(places, i), places->node[i].at);
}

/* ---- the grid -------------------------------------------------------------------------------- */

Status places_enter(Places *places, int32_t i, Err *err)
{
    const FillNode *node = &places->node[i];
    if (node->parent == NO_NODE || !(length_of(places, i) > 0))
        return STATUS_OK;
    if (places->grid.item[i].reach > 0)
        grid_remove(&places->grid, i);
    const Capsule capsule = {proximal(places, i), node->at, node->radius};
    return grid_add(&places->grid, 0, i, false, grid_item(&places->grid, capsule, node->radius),
                    err);
}

static FillNear ball_of(const Places *places, int32_t i)
{
    return (FillNear){.center = vec3_scale(vec3_add(proximal(places, i), places->node[i].at), 0.5),
                      .radius = length_of(places, i) / 2 + places->node[i].radius,
                      .segment = i};
}

Status places_search(Places *places, Vec3 a, Vec3 b, double reach, Err *err)
{
    GridItem item = grid_item(&places->grid, (Capsule){a, b, reach}, 0);
    GridBoxQuery query = grid_box_query(&item, reach, 1);
    int32_t other;
    places->n_near = 0;
    places->searches++;
    for (GridVisit visit = grid_visit(&places->grid, &item);
         grid_visit_near(&visit, &query, &other);) {
        if (places->stamp[other] == places->searches)
            continue;
        places->stamp[other] = places->searches;
        TRY(mem_reserve(&places->near, &places->near_capacity, places->n_near + 1,
                        sizeof *places->near, "segments", err));
        places->near[places->n_near++] = ball_of(places, other);
    }
    return STATUS_OK;
}

/* ---- one segment ----------------------------------------------------------------------------- */

/* A segment that is to be placed. */
typedef struct FillCourse {
    int32_t start;         /* node at which it begins */
    Vec3 along;            /* unit vector of the segment before */
    double length, radius; /* mm */
    double cone[RINGS][2]; /* angles to `along`, radians */
} FillCourse;

/* A possible position of the segment. */
typedef struct Candidate {
    Vec3 end;
    double gap; /* mm, between the walls of the segment and of others */
} Candidate;

static double distance2_to(Vec3 point, Vec3 a, Vec3 b)
{
    return vec3_distance2_along(vec3_sub(point, a), vec3_sub(b, a));
}

/* Returns the gap between the walls of the segment that ends at `end` and of another segment, mm.
 * If the two share a node, only the distances of their other ends are measured. */
static double gap_beside(const Places *places, const FillCourse *course, Vec3 end, int32_t other)
{
    const FillNode *node = &places->node[other];
    Vec3 start = places->node[course->start].at, a = proximal(places, other);
    double apart2;
    if (other == course->start)
        apart2 = distance2_to(end, a, node->at);
    else if (node->parent == course->start)
        apart2 = fmin(distance2_to(end, a, node->at), distance2_to(node->at, start, end));
    else
        apart2 = segment_distance2(start, end, a, node->at);
    return sqrt(apart2) - node->radius - course->radius;
}

/* Returns the smallest gap to all segments found by places_search, at most `enough`. The balls
 * around both segments exclude most of them. */
static double gap_of(const Places *places, const FillCourse *course, Vec3 end, double enough)
{
    Vec3 middle = vec3_scale(vec3_add(places->node[course->start].at, end), 0.5);
    double gap = enough, half = course->length / 2 + course->radius;
    for (size_t k = 0; k < places->n_near; k++) {
        const FillNear *near = &places->near[k];
        Vec3 apart = vec3_sub(near->center, middle);
        double sum = fmax(0, half + near->radius + gap);
        if (vec3_dot(apart, apart) < sum * sum)
            gap = fmin(gap, gap_beside(places, course, end, near->segment));
    }
    return gap;
}

static bool stays_inside(const Domain *domain, Vec3 a, Vec3 b)
{
    return domain_is_convex(domain) ? domain_inside(domain, b, 0)
                                    : domain_holds_segment(domain, a, b);
}

/* Moves the candidate with the largest gap (the first of several) to the end of the list, and
 * returns it. */
static Candidate *take_widest(Candidate *candidate, int n)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (candidate[i].gap > candidate[best].gap)
            best = i;
    Candidate widest = candidate[best];
    candidate[best] = candidate[n - 1];
    candidate[n - 1] = widest;
    return &candidate[n - 1];
}

/* Tries the directions of one ring. Replaces *best by a candidate in the domain with a larger gap.
 */
static void try_ring(Places *places, const FillCourse *course, const double cone[2], double enough,
                     Candidate *best)
{
    Candidate candidate[DIRECTIONS];
    Vec3 u, v, start = places->node[course->start].at;
    vec3_perpendiculars(course->along, &u, &v);
    double first = random_uniform(&places->filling->random);
    for (int i = 0; i < DIRECTIONS; i++) {
        double turn = FULL_TURN * (first + i) / DIRECTIONS, across = elementary_sin(cone[i % 2]);
        Vec3 direction = vec3_scale(course->along, elementary_cos(cone[i % 2]));
        direction = vec3_add_scaled(direction, u, across * elementary_cos(turn));
        direction = vec3_add_scaled(direction, v, across * elementary_sin(turn));
        candidate[i].end = vec3_add_scaled(start, direction, course->length);
        candidate[i].gap = gap_of(places, course, candidate[i].end, enough);
    }
    for (int n = DIRECTIONS; n > 0; n--) {
        const Candidate *widest = take_widest(candidate, n);
        if (widest->gap <= best->gap)
            return;
        if (stays_inside(places->domain, start, widest->end)) {
            *best = *widest;
            return;
        }
    }
}

static Status add_node(Places *places, FillNode node, int32_t *index, Err *err)
{
    *index = (int32_t)places->n;
    places->node[places->n++] = node;
    return places_enter(places, *index, err);
}

/* Places a segment: straight, or as two halves, which may be halved again up to `bends` times. *end
 * receives the distal node; NO_NODE if there is no place in the domain. */
static Status place_segment(Places *places, FillCourse course, int bends, int32_t *end, Err *err)
{
    double enough = enough_gap * course.length + enough_radii * course.radius;
    Candidate best = {.gap = -HUGE_VAL};
    *end = NO_NODE;
    if (places->n >= places->capacity)
        return STATUS_OK;
    Vec3 start = places->node[course.start].at;
    TRY(places_search(places, start, start, course.length + course.radius + enough, err));
    for (int ring = 0; ring < RINGS && best.gap < 0; ring++)
        try_ring(places, &course, course.cone[ring], enough, &best);
    if (best.gap > -HUGE_VAL)
        return add_node(places, (FillNode){best.end, course.radius, course.start, NO_NODE, false},
                        end, err);
    if (bends == 0)
        return STATUS_OK;
    course.length /= 2;
    TRY(place_segment(places, course, bends - 1, end, err));
    if (*end == NO_NODE)
        return STATUS_OK;
    course.start = *end;
    course.along = vec3_normalized(vec3_sub(places->node[*end].at, proximal(places, *end)));
    return place_segment(places, course, bends - 1, end, err);
}

/* Sets the cones of a course: those of the first ring are `angle` plus `width` times the numbers of
 * ring[0], in degrees; the others are the numbers of `ring`. */
static void set_cones(FillCourse *course, const double ring[RINGS][2], double angle, double width)
{
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < 2; k++)
            course->cone[i][k] = DEGREE * (i == 0 ? angle + width * ring[i][k] : ring[i][k]);
}

/* Returns the course of a segment that branches off at the end of segment `start`, or continues it.
 */
static FillCourse course_from(const Places *places, int32_t start, double radius, bool branches)
{
    const FillNode *node = &places->node[start];
    Vec3 along = vec3_sub(node->at, proximal(places, start));
    FillCourse course = {.start = start, .radius = radius};
    course.along = vec3_length(along) > 0 ? vec3_normalized(along) : vec3(0, 0, 1);
    double ratio = fmin(1, radius / node->radius);
    if (branches)
        set_cones(&course, wider, thin_angle - (thin_angle - wide_angle) * ratio, spread);
    else
        set_cones(&course, onward, 0, 1);
    return course;
}

/* ---- elements -------------------------------------------------------------------------------- */

/* Places the segments of an element from `start` on, and starts the daughters from `daughter` on at
 * their ends, the last two at the last end. */
static Status place_chain(Places *places, int32_t e, int32_t start, int32_t daughter, Err *err)
{
    const FillElement *element = &places->filling->element[e];
    double *length = NULL;
    int32_t node = start;
    Status status = STATUS_OK;
    TRY(mem_calloc(&length, (size_t)element->segments, sizeof *length, "segments", err));
    filling_cut(places->filling, element, length);
    for (int i = 0; i < element->segments && node != NO_NODE && status == STATUS_OK; i++) {
        FillCourse course =
            course_from(places, node, element->radius_mm, i == 0 && !element->grown);
        course.length = length[i];
        status = place_segment(places, course, MOST_BENDS, &node, err);
        if (node == NO_NODE)
            break;
        places->end_node[e] = node;
        for (; daughter != NO_ELEMENT; daughter = places->filling->element[daughter].sister) {
            places->start_node[daughter] = node;
            if (i + 1 < element->segments) {
                daughter = places->filling->element[daughter].sister;
                break;
            }
        }
    }
    free(length);
    return status;
}

/* Places a drawn element, if its parent has been placed. Counts it as left out if no segment of it
 * could be placed. */
static Status place_drawn(Places *places, int32_t e, Err *err)
{
    if (places->start_node[e] != NO_NODE)
        TRY(place_chain(places, e, places->start_node[e], places->filling->element[e].daughter,
                        err));
    places->left_out += places->end_node[e] == NO_NODE;
    return STATUS_OK;
}

/* A point at which a grown segment may be split. */
typedef struct FillSplit {
    int32_t segment; /* NO_NODE: none */
    Vec3 at;
    double room; /* mm; below 0 if the point is in another vessel, or nearer to a node than a
                    diameter */
} FillSplit;

/* Replaces *best by the point `from_end` mm from the distal end of a grown element, if the point
 * has more space and is in the domain. `last` is the last segment of the element. */
static Status test_split(Places *places, int32_t last, double from_end, FillSplit *best, Err *err)
{
    int32_t i = last;
    double length = length_of(places, i);
    for (; from_end > length && places->node[places->node[i].parent].parent != NO_NODE;
         length = length_of(places, i)) {
        from_end -= length;
        i = places->node[i].parent;
    }
    const FillNode *node = &places->node[i];
    if (!(length > 0) || from_end > length)
        return STATUS_OK;
    Vec3 at = vec3_add_scaled(node->at, vec3_sub(proximal(places, i), node->at), from_end / length);
    double room = fmin(from_end, length - from_end) - 2 * node->radius;
    TRY(places_search(places, at, at, node->radius, err));
    for (size_t k = 0; k < places->n_near; k++) {
        int32_t j = places->near[k].segment;
        double apart = sqrt(distance2_to(at, proximal(places, j), places->node[j].at));
        room = j == i ? room : fmin(room, apart - places->node[j].radius);
    }
    if ((best->segment == NO_NODE || room > best->room) && domain_inside(places->domain, at, 0))
        *best = (FillSplit){i, at, room};
    return STATUS_OK;
}

/* Starts a daughter at a random point of a grown element: the first point that has room, or else
 * the one with the most room. */
static Status start_daughter(Places *places, int32_t e, int32_t daughter, Err *err)
{
    const FillElement *element = &places->filling->element[e];
    FillSplit best = {.segment = NO_NODE};
    for (int i = 0; i < ATTEMPTS && (best.segment == NO_NODE || best.room < 0); i++) {
        double at = random_uniform(&places->filling->random) * element->grown_mm;
        TRY(test_split(places, places->end_node[e], at, &best, err));
    }
    if (best.segment == NO_NODE)
        return STATUS_OK;
    FillNode split = places->node[best.segment];
    split.at = best.at;
    split.origin = NO_NODE;
    places->node[best.segment].parent = places->start_node[daughter] = (int32_t)places->n;
    places->node[places->n++] = split;
    TRY(places_enter(places, places->start_node[daughter], err));
    return places_enter(places, best.segment, err);
}

/* Starts the daughters of a grown element. A daughter belongs to the grown part or to the
 * extension, with probabilities in proportion to their lengths. Removes the daughters of the grown
 * part from the list of daughters. Sets element->segments to the number of segments of the
 * extension. */
static Status split_grown(Places *places, int32_t e, Err *err)
{
    FillElement *all = places->filling->element, *element = &all[e];
    int32_t along = 0, *link = &element->daughter;
    double total = element->grown_mm + element->length_mm;
    for (int32_t d = element->daughter; d != NO_ELEMENT; d = all[d].sister)
        along++;
    along -= element->is_open && element->order > places->filling->rules.to ? 2 : 0;
    element->segments = 1;
    for (; along > 0; along--) {
        bool is_full = element->length_mm < 2 * element->radius_mm * (element->segments + 1);
        if (is_full || random_uniform(&places->filling->random) * total < element->grown_mm) {
            TRY(start_daughter(places, e, *link, err));
            *link = all[*link].sister;
        } else {
            element->segments++;
            link = &all[*link].sister;
        }
    }
    return STATUS_OK;
}

/* Places the extension of a grown element. If it has none, its daughters start at its end. */
static Status place_grown(Places *places, int32_t e, Err *err)
{
    const FillElement *element = &places->filling->element[e];
    if (element->length_mm > 0)
        return place_chain(places, e, places->end_node[e], element->daughter, err);
    for (int32_t d = element->daughter; d != NO_ELEMENT; d = places->filling->element[d].sister)
        places->start_node[d] = places->end_node[e];
    return STATUS_OK;
}

/* Allocates the nodes and a grid around the grown tree. */
static Status make_grid(Places *places, Err *err)
{
    const Filling *filling = places->filling;
    double segments = (double)places->n;
    Box box = box_empty();
    for (size_t i = 0; i < places->n; i++)
        box = box_with_ball(box, places->node[i].at, places->node[i].radius);
    for (size_t k = 0; k < filling->n; k++)
        segments += filling->element[k].segments + 2 * filling->element[k].grown;
    TRY(mem_reserve(&places->node, &places->capacity, (size_t)((1 + spare_nodes) * segments) + 1,
                    sizeof *places->node, "nodes", err));
    TRY(mem_calloc(&places->stamp, places->capacity, sizeof *places->stamp, "segments", err));
    TRY(grid_reset(&places->grid, box, cells_per_segment * segments, places->capacity, 1, err));
    return STATUS_OK;
}

Status places_fill(Places *places, const GrowParams *params, Err *err)
{
    const Filling *filling = places->filling;
    size_t done = 0;
    TRY(make_grid(places, err));
    for (size_t i = 0; i < places->n; i++)
        TRY(places_enter(places, (int32_t)i, err));
    for (size_t e = 0; e < filling->n && filling->element[e].grown; e++)
        TRY(split_grown(places, (int32_t)e, err));
    for (int order = (int)filling->rules.table->n; order >= filling->rules.to; order--)
        for (int32_t e = filling->first[order]; e != NO_ELEMENT; e = filling->element[e].peer) {
            TRY(filling->element[e].grown ? place_grown(places, e, err)
                                          : place_drawn(places, e, err));
            if (++done % ELEMENTS_PER_REPORT == 0 && params->progress &&
                !params->progress((double)done / (double)filling->n, params->progress_context))
                return err_cancelled(err);
        }
    return STATUS_OK;
}
