/* Nodes joined by segments of no length are one place. A segment that shares both ends with a
 * sister at least as thick lies inside her and is left out; measured trees hold such pairs. Their
 * distal nodes are one place, too. */
#include "stage/places.h"

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

/* Uncovered segments in lists, each the latest first: those that begin at one node together, or
 * where they are more than FEW also by the cell of space they end in, so that a node may have any
 * number of daughters. */
typedef struct Bins {
    int32_t *daughters; /* of each node, drawn or not; owned, as the next */
    int32_t *first;     /* one a node, and then one a bin of cells; below 0: none */
    int32_t *next;      /* one a node */
    size_t n;           /* nodes */
    size_t mask;        /* the number of bins of cells, a power of 2, less 1 */
} Bins;

enum { FEW = 8 };

/* Of a cell: so long that most places are clear of its faces, and so short that few fit into
 * one. */
static const double cell_mm = 16e-9;

static size_t bin_of(const Bins *bins, int32_t parent, const double cell[3])
{
    uint64_t hash = (uint64_t)parent;
    for (int axis = 0; axis < 3; axis++) {
        uint64_t bits;
        memcpy(&bits, &cell[axis], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    }
    return bins->n + ((size_t)hash & bins->mask);
}

/* The cell of the point moved by `by` along all axes; zeros have one sign. */
static void find_cell(Vec3 point, double by, double cell[3])
{
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = floor((vec3_component(point, axis) + by) / cell_mm) + 0.0;
}

/* What leads to the latest of the sisters in the list of a bin that end where segment i does, if
 * that is later than what `found` leads to; else `found`. NULL: none. */
static int32_t *find_in(const Tree *tree, const Bins *bins, size_t bin, size_t i, int32_t *found)
{
    for (int32_t *link = &bins->first[bin]; *link >= 0; link = &bins->next[*link])
        if (tree->parent[*link] == tree->parent[i] && (!found || *link > *found) &&
            vec3_distance(tree->position[i], tree->position[*link]) <= SHORTEST_MM)
            found = link;
    return found;
}

static bool has_few_sisters(const Tree *tree, const Bins *bins, size_t i)
{
    return bins->daughters[tree->parent[i]] <= FEW;
}

/* What leads to the latest of the sisters in the lists that end where segment i does; NULL:
 * none. */
static int32_t *find_sister(const Tree *tree, const Bins *bins, size_t i)
{
    if (has_few_sisters(tree, bins, i))
        return find_in(tree, bins, (size_t)tree->parent[i], i, NULL);
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
            found = find_in(tree, bins, bin_of(bins, tree->parent[i], cell), i, found);
    }
    return found;
}

/* Puts segment i into its list. */
static void put(const Tree *tree, Bins *bins, size_t i)
{
    size_t bin = (size_t)tree->parent[i];
    if (!has_few_sisters(tree, bins, i)) {
        double cell[3];
        find_cell(tree->position[i], 0, cell);
        bin = bin_of(bins, tree->parent[i], cell);
    }
    bins->next[i] = bins->first[bin];
    bins->first[bin] = (int32_t)i;
}

/* Compares each segment with its elder sisters. */
static void find_covers(const Tree *tree, Bins *bins, int32_t *cover)
{
    for (size_t i = 0; i < tree->n; i++) {
        cover[i] = segment_can_be_drawn(tree, i) ? PLACES_UNCOVERED : PLACES_CANNOT_DRAW;
        if (cover[i] == PLACES_CANNOT_DRAW)
            continue;
        int32_t self = (int32_t)i, *sister = find_sister(tree, bins, i);
        if (sister && !(tree->radius_mm[i] > tree->radius_mm[*sister])) {
            cover[self] = *sister;
            continue;
        }
        if (sister) {
            cover[*sister] = self;
            *sister = bins->next[*sister];
        }
        put(tree, bins, i);
    }
}

/* The last of the sisters that cover each other from `self` on; shortens the way there. */
static int32_t outermost(int32_t *cover, int32_t self)
{
    for (; cover[self] >= 0; self = cover[self])
        if (cover[cover[self]] >= 0)
            cover[self] = cover[cover[self]];
    return self;
}

static Status init_bins(const Tree *tree, Bins *bins, Err *err)
{
    size_t many = 0, count = 1;
    TRY(tree_child_counts(tree, &bins->daughters, err));
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

Status places_find(const Tree *tree, Places *places, Err *err)
{
    Bins bins = {0};
    Places found = {0};
    Status status = STATUS_OK;
    TRY_GOTO(init_bins(tree, &bins, err));
    TRY_GOTO(mem_calloc(&found.cover, tree->n, sizeof *found.cover, "nodes", err));
    TRY_GOTO(mem_calloc(&found.place, tree->n, sizeof *found.place, "nodes", err));
    find_covers(tree, &bins, found.cover);
    for (size_t i = 0; i < tree->n; i++) {
        bool joined =
            !places_can_draw(&found, i) && tree_is_segment(tree, i) && !has_length(tree, i);
        found.place[i] = joined ? found.place[tree->parent[i]] : outermost(found.cover, (int32_t)i);
    }
done:
    free(bins.daughters);
    free(bins.first);
    free(bins.next);
    if (status == STATUS_OK)
        *places = found;
    else
        places_release(&found);
    return status;
}

void places_release(Places *places)
{
    free(places->cover);
    free(places->place);
    *places = (Places){0};
}
