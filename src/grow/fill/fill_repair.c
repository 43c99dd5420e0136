/* Repairs the segments of a filling that are broken: that overlap others, or are shorter than wide.
 * The two ends of a broken segment move to the best of some positions around them, nearest first,
 * as in the repair of grown trees [repair.c]. A node of a grown segment never moves. */
#include "grow/fill/fill_place.h"

#include <math.h>
#include <stdlib.h>

/* Maximum number of rounds, each of which tries to move the ends of all broken segments. What is
 * still broken then has no space. */
enum { ROUNDS = 4 };
/* Distances by which a node is moved, in radii of the segment that ends there. Drawn segments
 * overlap more deeply than those of growth, so the steps are larger than in repair.c. */
static const double steps[] = {0.1, 0.3, 1, 2};
/* Segments that a repair moves keep this fraction of their width in addition. */
static const double spare = 1e-3;

/* The state of a repair. */
typedef struct Mending {
    Places *places;
    IndexLists children; /* per node: its children */
} Mending;

/* Returns the children of node i, and sets *end to the end of the array. */
static const uint32_t *children_of(const Mending *mending, int32_t i, const uint32_t **end)
{
    const IndexLists *children = &mending->children;
    *end = children->items + children->first[i + 1];
    return children->items + children->first[i];
}

static bool are_joined(const FillNode *node, int32_t i, int32_t j)
{
    return i == j || node[i].parent == node[j].parent || node[i].parent == j || node[j].parent == i;
}

/* Sets *fault to the length, mm, by which segment i is too short, or too near to another segment:
 * the larger of the two, and 0 for a grown segment. Of drawn segments, looks only at those with an
 * index below `below`. */
static Status fault_of(Places *places, int32_t i, int32_t below, double *fault, Err *err)
{
    const FillNode *node = places->node, *own = &node[i];
    *fault = 0;
    if (own->grown)
        return STATUS_OK;
    Vec3 a = node[own->parent].at, b = own->at;
    *fault = fmax(0, 2 * own->radius - vec3_distance(a, b));
    TRY(places_search(places, a, b, (1 + spare) * own->radius, err));
    for (size_t k = 0; k < places->n_near; k++) {
        int32_t j = places->near[k].segment;
        if ((!node[j].grown && j >= below) || are_joined(node, i, j))
            continue;
        double apart2 = segment_distance2(a, b, node[node[j].parent].at, node[j].at);
        *fault = fmax(*fault, own->radius + node[j].radius - sqrt(apart2));
    }
    return STATUS_OK;
}

/* Sets *sum to the sum of the faults of the segments that meet at node i, mm. Stops adding once the
 * sum is at least `enough`. */
static Status fault_at(Mending *mending, int32_t i, double enough, double *sum, Err *err)
{
    double fault;
    const uint32_t *end, *child = children_of(mending, i, &end);
    TRY(fault_of(mending->places, i, INT32_MAX, sum, err));
    for (; child < end && *sum < enough; child++) {
        TRY(fault_of(mending->places, (int32_t)*child, INT32_MAX, &fault, err));
        *sum += fault;
    }
    return STATUS_OK;
}

/* Returns true if the segments that meet at node i are in the domain. */
static bool is_inside(const Mending *mending, int32_t i)
{
    const Places *places = mending->places;
    const FillNode *node = places->node;
    bool inside = domain_holds_segment(places->domain, node[node[i].parent].at, node[i].at);
    const uint32_t *end, *child = children_of(mending, i, &end);
    for (; child < end && inside; child++)
        inside = domain_holds_segment(places->domain, node[i].at, node[*child].at);
    return inside;
}

/* Moves a node to the best position found around it. */
static Status move(Mending *mending, int32_t i, Err *err)
{
    Places *places = mending->places;
    FillNode *node = &places->node[i];
    const Vec3 from = node->at;
    Vec3 best = from;
    double least, fault;
    if (node->grown)
        return STATUS_OK;
    TRY(fault_at(mending, i, INFINITY, &least, err));
    /* 26 directions along the axes and diagonals, for each of the steps. */
    for (int k = 0; k < 27 * (int)(sizeof steps / sizeof *steps) && least > 0; k++) {
        Vec3 direction = vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 % 3 - 1);
        if (vec3_dot(direction, direction) == 0)
            continue;
        node->at = vec3_add_scaled(from, vec3_normalized(direction), steps[k / 27] * node->radius);
        TRY(fault_at(mending, i, least, &fault, err));
        if (fault < least && is_inside(mending, i)) {
            least = fault;
            best = node->at;
        }
    }
    node->at = best;
    TRY(places_enter(places, i, err));
    const uint32_t *end, *child = children_of(mending, i, &end);
    for (; child < end; child++)
        TRY(places_enter(places, (int32_t)*child, err));
    return STATUS_OK;
}

/* Lists the children of each node. */
static Status list_children(const Places *places, IndexLists *children, Err *err)
{
    TRY(indexlists_begin(children, places->n, "nodes", err));
    for (size_t i = 0; i < places->n; i++)
        if (places->node[i].parent != NO_NODE)
            indexlists_count(children, (size_t)places->node[i].parent);
    TRY(indexlists_allot(children, "nodes", err));
    for (size_t i = 0; i < places->n; i++)
        if (places->node[i].parent != NO_NODE)
            indexlists_put(children, (size_t)places->node[i].parent, (uint32_t)i);
    return STATUS_OK;
}

/* Lists the broken segments; of two that are too near to each other, the later one. */
static Status find_broken(Places *places, int32_t *broken, size_t *count, Err *err)
{
    double fault;
    *count = 0;
    for (size_t i = 0; i < places->n; i++) {
        TRY(fault_of(places, (int32_t)i, (int32_t)i, &fault, err));
        if (fault > 0)
            broken[(*count)++] = (int32_t)i;
    }
    return STATUS_OK;
}

Status places_repair(Places *places, size_t *left, Err *err)
{
    Mending mending = {.places = places};
    int32_t *broken = NULL;
    Status status;
    TRY_GOTO(list_children(places, &mending.children, err));
    TRY_GOTO(mem_calloc(&broken, places->n, sizeof *broken, "segments", err));
    for (int round = 0;; round++) {
        TRY_GOTO(find_broken(places, broken, left, err));
        if (*left == 0 || round == ROUNDS)
            break;
        for (size_t k = 0; k < *left; k++) {
            TRY_GOTO(move(&mending, broken[k], err));
            TRY_GOTO(move(&mending, places->node[broken[k]].parent, err));
        }
    }
done:
    free(broken);
    indexlists_release(&mending.children);
    return status;
}
