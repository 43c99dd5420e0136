/* Measured trees contain several segments between the same two points. The thinner ones lie inside
 * the thickest one and are left out. Such a pair consists either of two sisters, which start at the
 * same junction and end at the same junction, or of a segment and a daughter that leads from the
 * segment's distal end back to its proximal junction. In a network with loops, both segments of a
 * pair may end at links. Such a pair is found by its junctions. */
#include "stage/coincidence.h"

#include <stdlib.h>
#include <string.h>

static bool has_length(const Tree *tree, size_t i)
{
    return tree_segment_length(tree, i) > SHORTEST_MM;
}

bool segment_can_be_drawn(const Tree *tree, size_t i)
{
    return tree_is_segment(tree, i) && tree->radius_mm[i] > 0 && has_length(tree, i);
}

/* Segments without a twin so far, in lists, the latest segment first. There is one list per
 * junction for the segments that start there. If more than FEW segments start at a junction, their
 * lists are also separated by the cell of space in which a segment ends, so that a junction with
 * many daughters is not slow. All arrays are owned. */
typedef struct SisterBins {
    int32_t *start;     /* per segment: the first node of the junction at which the segment
                         * starts */
    int32_t *daughters; /* per first node: number of segments that start there, drawn or not */
    int32_t *first;     /* heads of the lists: one per node, then one per bin of cells; negative:
                         * empty list */
    int32_t *next;      /* one a node */
    size_t n;           /* nodes */
    size_t mask;        /* number of bins of cells, a power of 2, minus 1 */
} SisterBins;

enum { FEW = 8 };

/* Side of a cell, mm: so long that most nodes are farther than SHORTEST_MM from the cell's faces,
 * and so short that a cell holds few nodes. */
static const double cell_mm = 16e-9;

static size_t bin_of(const SisterBins *bins, int32_t start, const double cell[3])
{
    uint64_t hash = (uint64_t)start;
    for (int axis = 0; axis < 3; axis++) {
        uint64_t bits;
        memcpy(&bits, &cell[axis], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    }
    return bins->n + ((size_t)hash & bins->mask);
}

/* Returns the cell of a point that is moved by `by` mm along all axes. Adding 0.0 gives all zeros
 * the same sign. */
static void find_cell(Vec3 point, double by, double cell[3])
{
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = floor((vec3_component(point, axis) + by) / cell_mm) + 0.0;
}

/* Returns the link to the latest sister in the list of a bin that ends where segment i ends, if
 * this sister is later than the sister to which `found` links; otherwise returns `found`. NULL:
 * there is no sister. */
static int32_t *find_in(const Tree *tree, const SisterBins *bins, size_t bin, size_t i,
                        int32_t *found)
{
    for (int32_t *link = &bins->first[bin]; *link >= 0; link = &bins->next[*link])
        if (bins->start[*link] == bins->start[i] && (!found || *link > *found) &&
            vec3_distance(tree->position[i], tree->position[*link]) <= SHORTEST_MM)
            found = link;
    return found;
}

static bool has_few_sisters(const SisterBins *bins, size_t i)
{
    return bins->daughters[bins->start[i]] <= FEW;
}

/* Returns the link to the latest sister that ends where segment i ends; NULL: there is none. */
static int32_t *find_sister(const Tree *tree, const SisterBins *bins, size_t i)
{
    if (has_few_sisters(bins, i))
        return find_in(tree, bins, (size_t)bins->start[i], i, NULL);
    double ends[2][3], cell[3];
    int32_t *found = NULL;
    for (int end = 0; end < 2; end++)
        find_cell(tree->position[i], end ? 2 * SHORTEST_MM : -2 * SHORTEST_MM, ends[end]);
    for (int corner = 0; corner < 8; corner++) {
        bool again = false;
        for (int axis = 0; axis < 3; axis++) {
            int end = corner >> axis & 1;
            cell[axis] = ends[end][axis];
            again = again || (end && ends[0][axis] == ends[1][axis]);
        }
        if (!again)
            found = find_in(tree, bins, bin_of(bins, bins->start[i], cell), i, found);
    }
    return found;
}

/* Inserts segment i into its list. */
static void put(const Tree *tree, SisterBins *bins, size_t i)
{
    size_t bin = (size_t)bins->start[i];
    if (!has_few_sisters(bins, i)) {
        double cell[3];
        find_cell(tree->position[i], 0, cell);
        bin = bin_of(bins, bins->start[i], cell);
    }
    bins->next[i] = bins->first[bin];
    bins->first[bin] = (int32_t)i;
}

/* Compares each segment with its elder sisters. */
static void find_twins(const Tree *tree, SisterBins *bins, int32_t *twin)
{
    for (size_t i = 0; i < tree->n; i++) {
        twin[i] = segment_can_be_drawn(tree, i) ? NO_TWIN : CANNOT_DRAW;
        if (twin[i] == CANNOT_DRAW)
            continue;
        int32_t self = (int32_t)i, *sister = find_sister(tree, bins, i);
        if (sister && !(tree->radius_mm[i] > tree->radius_mm[*sister])) {
            twin[self] = *sister;
            continue;
        }
        if (sister) {
            twin[*sister] = self;
            *sister = bins->next[*sister];
        }
        put(tree, bins, i);
    }
}

/* Returns true if segment i leads from the end of its parent's segment back to where that one
 * begins. */
static bool returns(const Tree *tree, const int32_t *twin, size_t i)
{
    const int32_t parent = tree->parent[i];
    return twin[i] != CANNOT_DRAW && twin[parent] != CANNOT_DRAW &&
           vec3_distance(tree->position[i], tree->position[tree->parent[parent]]) <= SHORTEST_MM;
}

/* Returns the last segment of the chain of twins from `self` on. Shortens the chain for later
 * calls. */
static int32_t outermost(int32_t *twin, int32_t self)
{
    for (; twin[self] >= 0; self = twin[self])
        if (twin[twin[self]] >= 0)
            twin[self] = twin[twin[self]];
    return self;
}

/* Compares each segment that returns with the thickest segment that it returns along. */
static void find_backward_twins(const Tree *tree, int32_t *twin)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (!returns(tree, twin, i) || twin[i] != NO_TWIN)
            continue;
        int32_t along = outermost(twin, tree->parent[i]);
        bool is_thicker = tree->radius_mm[i] > tree->radius_mm[along];
        twin[is_thicker ? along : (int32_t)i] = UNSTORED_TWIN;
    }
}

/* Returns the junction of node i. The junctions of earlier nodes must be known. */
static int32_t junction_of(const Tree *tree, const Coincidence *found, size_t i)
{
    const int32_t parent = tree->parent[i];
    if (tree_is_segment(tree, i) && !has_length(tree, i) && !coincidence_can_draw(found, i))
        return found->junction[parent];
    if (returns(tree, found->twin, i))
        return found->junction[tree->parent[parent]];
    return outermost(found->twin, (int32_t)i);
}

/* Finds the first node of each segment's start, and counts the segments per first node. */
static void find_starts(const Tree *tree, SisterBins *bins)
{
    for (size_t i = 0; i < tree->n; i++) {
        const int32_t parent = tree->parent[i];
        bins->start[i] = (int32_t)i;
        if (!tree_is_segment(tree, i))
            continue;
        const bool joined =
            tree_is_segment(tree, (size_t)parent) && !has_length(tree, (size_t)parent);
        bins->start[i] = joined ? bins->start[parent] : parent;
        bins->daughters[bins->start[i]]++;
    }
}

static Status init_bins(const Tree *tree, SisterBins *bins, Err *err)
{
    size_t many = 0, count = 1;
    TRY(mem_calloc(&bins->start, tree->n, sizeof *bins->start, "nodes", err));
    TRY(mem_calloc(&bins->daughters, tree->n, sizeof *bins->daughters, "nodes", err));
    find_starts(tree, bins);
    for (size_t i = 0; i < tree->n; i++)
        many += bins->daughters[i] > FEW ? (size_t)bins->daughters[i] : 0;
    while (count < many)
        count *= 2;
    bins->n = tree->n;
    bins->mask = count - 1;
    TRY(mem_calloc(&bins->first, bins->n + count, sizeof *bins->first, "nodes", err));
    memset(bins->first, 0xff, (bins->n + count) * sizeof *bins->first);
    return mem_calloc(&bins->next, bins->n, sizeof *bins->next, "nodes", err);
}

/* Compares a drawn segment with the one that connects the same junctions, if there is one. */
static Status compare_pair(const Tree *tree, Coincidence *found, KeyMap *drawn, size_t i, Err *err)
{
    const uint32_t start = (uint32_t)found->junction[tree->parent[i]];
    uint32_t *thickest;
    bool is_first;
    TRY(keymap_put(drawn, key_of_pair(start, (uint32_t)found->junction[i]), &thickest, &is_first,
                   err));
    if (is_first) {
        *thickest = (uint32_t)i;
        return STATUS_OK;
    }
    const bool is_thicker = tree->radius_mm[i] > tree->radius_mm[*thickest];
    found->twin[is_thicker ? *thickest : (uint32_t)i] = UNSTORED_TWIN;
    *thickest = is_thicker ? (uint32_t)i : *thickest;
    return STATUS_OK;
}

/* Makes one junction of the two nodes of each link. */
static Status join_links(const Tree *tree, Coincidence *found, Err *err)
{
    uint32_t *root = NULL;
    KeyMap drawn = {0};
    Status status;
    TRY_GOTO(mem_calloc(&root, tree->n, sizeof *root, "nodes", err));
    sets_begin(root, tree->n);
    for (size_t i = 0; i < tree->n; i++) {
        sets_join(root, (uint32_t)i, (uint32_t)found->junction[i]);
        sets_join(root, (uint32_t)i, (uint32_t)tree_linked_node(tree, i));
    }
    for (size_t i = 0; i < tree->n; i++)
        found->junction[i] = (int32_t)sets_find(root, (uint32_t)i);
    TRY_GOTO(keymap_begin(&drawn, tree->n, "segments", err));
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence_draws(found, i))
            TRY_GOTO(compare_pair(tree, found, &drawn, i, err));
done:
    keymap_release(&drawn);
    free(root);
    return status;
}

Status coincidence_find(const Tree *tree, Coincidence *coincidence, Err *err)
{
    SisterBins bins = {0};
    Coincidence found = {0};
    Status status = STATUS_OK;
    TRY_GOTO(init_bins(tree, &bins, err));
    TRY_GOTO(mem_calloc(&found.twin, tree->n, sizeof *found.twin, "nodes", err));
    TRY_GOTO(mem_calloc(&found.junction, tree->n, sizeof *found.junction, "nodes", err));
    find_twins(tree, &bins, found.twin);
    find_backward_twins(tree, found.twin);
    for (size_t i = 0; i < tree->n; i++)
        found.junction[i] = junction_of(tree, &found, i);
    if (tree->link)
        TRY_GOTO(join_links(tree, &found, err));
    *coincidence = found;
    found = (Coincidence){0};
done:
    free(bins.start);
    free(bins.daughters);
    free(bins.first);
    free(bins.next);
    coincidence_release(&found);
    return status;
}

StageReport coincidence_count(const Tree *tree, const Coincidence *coincidence)
{
    StageReport report = {0};
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        report.drawn += coincidence_can_draw(coincidence, i);
        report.dropped += !coincidence_can_draw(coincidence, i);
        report.covered +=
            coincidence_can_draw(coincidence, i) && !coincidence_draws(coincidence, i);
    }
    return report;
}

void coincidence_release(Coincidence *coincidence)
{
    free(coincidence->twin);
    free(coincidence->junction);
    *coincidence = (Coincidence){0};
}
