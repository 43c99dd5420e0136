/* The cuts are the fixed point of t_i = max(0, max_j (t_j cos_ij + r_j sin_ij)). The fixed point is
 * unique, because the right-hand side brings two guesses closer by the factor max |cos_ij|. Plain
 * iteration converges, but slowly if vessels leave at a small angle. Policy iteration [Howard 1960]
 * is used instead: each round finds, for each end, the other end that pushes it furthest, solves
 * the linear system of these pushes alone, and starts again from the solution. A few rounds replace
 * thousands of plain iterations. If the rounds do not converge, plain iteration finishes.
 *
 * If many vessels meet, their ends are sorted into a binary tree of cones around their axes. A cone
 * is skipped if none of its ends can push as far as an end that is known already. The first known
 * end is the one that pushed furthest in the previous round. */
#include "stage/cuts.h"

#include <stdlib.h>
#include <string.h>

enum { SOLVED_ROUNDS = 50, PLAIN_ROUNDS = 500 };

static const double parallel = 1e-6; /* sine */
static const double tolerance =
    1e-13; /* relative to the largest radius or, if that is longer, to the cut */

/* The push on an end: t = slope * t[mover] + offset; t = 0 if there is no mover. */
typedef struct CutPush {
    ptrdiff_t mover; /* -1: none */
    double slope, offset;
    double pushed; /* the t that it asks for */
} CutPush;

enum { LEAF_SIZE = 8 };

/* A node of the tree: ends with similar axes. The first child of an inner node is the next node. */
typedef struct CutNode {
    size_t first, n;     /* of the places in `order` */
    size_t second;       /* child; 0 for a leaf */
    Vec3 axis;           /* of one of them */
    double cosine, sine; /* the least and the greatest of the angles that the others make with it */
    double least_cut, largest_cut, radius; /* the largest */
} CutNode;

typedef struct CutItem {
    double key; /* to sort by */
    size_t end;
} CutItem;

typedef struct CutWork {
    const VesselEnd *ends;
    double *cut;
    CutPush *pushes;
    double *next;  /* the right-hand side */
    size_t *path;  /* ends on the way to one that is solved */
    bool *visited; /* they, and those solved */
    CutItem *order;
    CutNode *nodes;
    size_t n_nodes;
    uint64_t steps; /* that are left */
} CutWork;

static double sine_of(Vec3 a, Vec3 b)
{
    return vec3_length(vec3_cross(a, b));
}

static int by_key(const void *a, const void *b)
{
    double one = ((const CutItem *)a)->key, other = ((const CutItem *)b)->key;
    return (one > other) - (one < other);
}

/* Builds the node of the ends `first` to first + n - 1 in `order`, and the nodes below it. */
static size_t build_node(CutWork *work, size_t first, size_t n)
{
    size_t index = work->n_nodes++;
    CutNode *node = &work->nodes[index];
    *node = (CutNode){.first = first,
                      .n = n,
                      .axis = work->ends[work->order[first + n / 2].end].axis,
                      .cosine = 1};
    Box axes = box_empty();
    for (size_t k = first; k < first + n; k++) {
        Vec3 axis = work->ends[work->order[k].end].axis;
        axes = box_with_ball(axes, axis, 0);
        node->sine = fmax(node->sine, sine_of(node->axis, axis));
        node->cosine = fmin(node->cosine, vec3_dot(node->axis, axis));
    }
    if (n <= LEAF_SIZE)
        return index;
    int longest = box_longest_axis(axes);
    for (size_t k = first; k < first + n; k++)
        work->order[k].key = vec3_component(work->ends[work->order[k].end].axis, longest);
    qsort(work->order + first, n, sizeof *work->order, by_key);
    build_node(work, first, n / 2);
    size_t second = build_node(work, first + n / 2, n - n / 2);
    node->second = second;
    return index;
}

/* Updates the nodes for new cuts. A tree of one node does not need it. */
static void fit_nodes(CutWork *work)
{
    for (size_t index = work->n_nodes; index-- > 1;) {
        CutNode *node = &work->nodes[index];
        if (node->second) {
            const CutNode *a = node + 1, *b = &work->nodes[node->second];
            node->least_cut = fmin(a->least_cut, b->least_cut);
            node->largest_cut = fmax(a->largest_cut, b->largest_cut);
            node->radius = fmax(a->radius, b->radius);
            continue;
        }
        node->least_cut = HUGE_VAL;
        node->largest_cut = node->radius = 0;
        for (size_t k = node->first; k < node->first + node->n; k++) {
            size_t end = work->order[k].end;
            node->least_cut = fmin(node->least_cut, work->cut[end]);
            node->largest_cut = fmax(node->largest_cut, work->cut[end]);
            node->radius = fmax(node->radius, work->ends[end].radius);
        }
    }
}

/* Returns an upper bound of the push of a node's ends on an end along an axis; negative if all of
 * them are parallel to the axis. */
static double furthest_push(const CutNode *node, Vec3 axis)
{
    double cosine = vec3_dot(axis, node->axis), sine = sine_of(axis, node->axis);
    double c = node->cosine, s = node->sine;
    double rounding = 1e-12 * (node->largest_cut + node->radius);
    if (sine + s < 0.9 * parallel)
        return -1;
    if (c <= 0)
        return node->largest_cut + node->radius + rounding;
    /* The ends' angles with the axis are between these. */
    bool from_0 = cosine >= c, to_180 = cosine <= -c;
    double cosine_from = from_0 ? 1 : cosine * c + sine * s;
    double sine_from = from_0 ? 0 : sine * c - cosine * s;
    double cosine_to = to_180 ? -1 : cosine * c - sine * s;
    double sine_to = to_180 ? 0 : sine * c + cosine * s;
    bool has_90 = cosine_from >= 0 && cosine_to <= 0;
    return cosine_from * (cosine_from > 0 ? node->largest_cut : node->least_cut) +
           node->radius * (has_90 ? 1 : fmax(sine_from, sine_to)) + rounding;
}

/* Sets *best to the push of end j on end i if this push is stronger, or as strong and j comes
 * first. */
static void try_push(CutWork *work, size_t i, size_t j, CutPush *best)
{
    const VesselEnd *ends = work->ends;
    work->steps -= work->steps > 0;
    double sine = sine_of(ends[i].axis, ends[j].axis);
    if (j == i || sine < parallel)
        return;
    CutPush push = {(ptrdiff_t)j, vec3_dot(ends[i].axis, ends[j].axis), ends[j].radius * sine, 0};
    push.pushed = push.slope * work->cut[j] + push.offset;
    if (push.pushed > best->pushed || (push.pushed == best->pushed && push.mover < best->mover))
        *best = push;
}

/* Tries the ends of a node that may push end i further than *best. */
static void try_node(CutWork *work, size_t index, size_t i, CutPush *best)
{
    const CutNode *node = &work->nodes[index];
    if (!node->second) {
        for (size_t k = node->first; k < node->first + node->n; k++)
            try_push(work, i, work->order[k].end, best);
        return;
    }
    size_t child[2] = {index + 1, node->second};
    double furthest[2];
    work->steps -= work->steps > 0;
    for (int k = 0; k < 2; k++)
        furthest[k] = furthest_push(&work->nodes[child[k]], work->ends[i].axis);
    bool second_first = furthest[1] > furthest[0];
    for (int turn = 0; turn < 2; turn++) {
        int k = turn ^ second_first;
        if (furthest[k] >= best->pushed)
            try_node(work, child[k], i, best);
    }
}

static CutPush strongest_push(CutWork *work, size_t i)
{
    CutPush best = {.mover = -1};
    if (work->pushes[i].mover >= 0)
        try_push(work, i, (size_t)work->pushes[i].mover, &best);
    try_node(work, 0, i, &best);
    return best;
}

/* Finds all pushes and right-hand sides. Returns true if the cuts are the fixed point. */
static bool find_pushes(size_t n, CutWork *work)
{
    double largest = 0;
    bool settled = true;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, work->ends[i].radius);
    fit_nodes(work);
    for (size_t i = 0; i < n && work->steps > 0; i++) {
        work->pushes[i] = strongest_push(work, i);
        work->next[i] = work->pushes[i].pushed;
        double change = fabs(work->next[i] - work->cut[i]);
        settled = settled && change <= tolerance * fmax(largest, work->next[i]);
    }
    return settled;
}

/* Follows the movers from `first` around their cycle back to `first`, and returns the solution of t
 * = slope t + offset. */
static double solve_circle(const CutPush *pushes, size_t first)
{
    double slope = 1, offset = 0;
    size_t i = first;
    do {
        offset += slope * pushes[i].offset;
        slope *= pushes[i].slope;
        i = (size_t)pushes[i].mover;
    } while (i != first);
    return offset / (1 - slope);
}

/* Solves t_i = slope_i t[mover_i] + offset_i for all ends. Movers lead to an end without a mover,
 * to an end that is solved already, or around a cycle. */
static void solve_pushes(size_t n, CutWork *work)
{
    double *cut = work->cut;
    const CutPush *pushes = work->pushes;
    memset(work->visited, 0, n * sizeof *work->visited);
    for (size_t start = 0; start < n; start++) {
        size_t length = 0, end = start;
        for (; !work->visited[end] && pushes[end].mover >= 0; end = (size_t)pushes[end].mover) {
            work->visited[end] = true;
            work->path[length++] = end;
        }
        bool circle = false;
        for (size_t k = 0; k < length && !circle; k++)
            circle = work->path[k] == end;
        if (circle)
            cut[end] = solve_circle(pushes, end);
        else if (!work->visited[end])
            cut[end] = 0;
        work->visited[end] = true;
        while (length > 0) {
            size_t i = work->path[--length];
            if (i != end)
                cut[i] = pushes[i].slope * cut[pushes[i].mover] + pushes[i].offset;
        }
    }
}

Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, uint64_t *steps, Err *err)
{
    CutWork work = {.ends = ends, .cut = cut, .steps = *steps};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&work.pushes, n, sizeof *work.pushes, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.next, n, sizeof *work.next, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.path, n, sizeof *work.path, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.visited, n, sizeof *work.visited, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.order, n, sizeof *work.order, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.nodes, n / 2 + 1, sizeof *work.nodes, "vessel ends", err));
    memset(cut, 0, n * sizeof *cut);
    for (size_t i = 0; i < n; i++) {
        work.order[i].end = i;
        work.pushes[i].mover = -1;
    }
    build_node(&work, 0, n);
    for (int round = 0; round < SOLVED_ROUNDS + PLAIN_ROUNDS; round++) {
        bool settled = find_pushes(n, &work);
        if (work.steps == 0)
            break;
        if (settled || round >= SOLVED_ROUNDS)
            memcpy(cut, work.next, n * sizeof *cut);
        else
            solve_pushes(n, &work);
        if (settled)
            break;
    }
    *steps = work.steps;
done:
    free(work.pushes);
    free(work.next);
    free(work.path);
    free(work.visited);
    free(work.order);
    free(work.nodes);
    return status;
}
