/* Builds a bounding volume hierarchy (BVH) of boxes, and walks it.
 *
 * The tree is built top-down. The surface area heuristic (SAH) chooses the splits: along each axis,
 * the boxes' centres are counted in bins, and the cheapest boundary between two bins is used [Wald
 * 2007, On fast construction of SAH-based bounding volume hierarchies]. Median splits would overlap
 * where long boxes are beside short ones. Below half the maximum depth of a walk's stack, the items
 * of a node are halved by number instead, which ends within 32 more levels. */
#include "geom/boxtree.h"

#include <stdlib.h>

/* Maximum number of items of a leaf: a test of an item costs about as much as a test of its box. */
enum { LEAF_SIZE = 2 };
/* Number of bins per axis: with 16, trees are nearly as good as with all possible splits [Wald
 * 2007], and the work per item is constant. */
enum { BINS = 16 };

/* An item while the tree is built. `number` is its index in the caller's array. */
typedef struct BoxTreeItem {
    Box box;
    Vec3 center;
    uint32_t number;
} BoxTreeItem;

/* The state of building: items are reordered so that those of a node are consecutive. */
typedef struct BoxTreeBuilder {
    BoxTreeItem *items;
    BoxNode *nodes;
    uint32_t n_nodes;
} BoxTreeBuilder;

/* Returns half the surface of a box, which is proportional to the probability that a ray
 * meets it. */
static double box_area(Box box)
{
    Vec3 size = vec3_sub(box.high, box.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/* A split of items by the bins of their centres along one axis. */
typedef struct Split {
    int axis;
    int bin; /* first bin of the second child */
    double cost;
} Split;

/* The map from centres to bins along an axis: bin = (centre - low) * per_bin. */
typedef struct Scale {
    int bins;
    double low, per_bin;
} Scale;

/* Returns the map for n items. It has no more bins than items, because most nodes are small. */
static Scale scale_of(Box centers, int axis, uint32_t n)
{
    double low = vec3_component(centers.low, axis), size = vec3_component(centers.high, axis) - low;
    int bins = n < BINS ? (int)n : BINS;
    return (Scale){bins, low, size > 0 ? bins / size : 0};
}

static int bin_of(const BoxTreeItem *item, int axis, Scale scale)
{
    int bin = (int)((vec3_component(item->center, axis) - scale.low) * scale.per_bin);
    return bin < scale.bins ? bin : scale.bins - 1;
}

/* Returns the cheapest split along an axis by the surface area heuristic; the cost is INFINITY if
 * there is none. */
static Split best_split(const BoxTreeItem *items, uint32_t n, Box centers, int axis)
{
    Box box[BINS];
    uint32_t count[BINS] = {0};
    Scale scale = scale_of(centers, axis, n);
    for (int i = 0; i < scale.bins; i++)
        box[i] = box_empty();
    for (uint32_t i = 0; i < n; i++) {
        int bin = bin_of(&items[i], axis, scale);
        box[bin] = box_union(box[bin], items[i].box);
        count[bin]++;
    }
    double cost_above[BINS]; /* cost_above[i]: cost of a child with the bins i and above */
    Box sum = box_empty();
    uint32_t above = 0;
    for (int i = scale.bins - 1; i > 0; i--) {
        sum = box_union(sum, box[i]);
        above += count[i];
        cost_above[i] = above ? above * box_area(sum) : 0;
    }
    Split best = {axis, 0, INFINITY};
    sum = box_empty();
    uint32_t below = 0;
    for (int i = 1; i < scale.bins; i++) {
        sum = box_union(sum, box[i - 1]);
        below += count[i - 1];
        double cost = below ? below * box_area(sum) + cost_above[i] : (double)INFINITY;
        if (below < n && cost < best.cost)
            best = (Split){axis, i, cost};
    }
    return best;
}

/* Moves the items of the first child to the front. Returns their number. */
static uint32_t partition(BoxTreeItem *items, uint32_t n, Box centers, Split split)
{
    uint32_t front = 0;
    Scale scale = scale_of(centers, split.axis, n);
    for (uint32_t i = 0; i < n; i++) {
        if (bin_of(&items[i], split.axis, scale) >= split.bin)
            continue;
        BoxTreeItem item = items[i];
        items[i] = items[front];
        items[front++] = item;
    }
    return front;
}

/* Builds the node of the items [first, first + n) and all nodes below it. Returns its index. The
 * first child of a node follows it; BoxNode.first is the second child. */
static uint32_t build_node(BoxTreeBuilder *builder, uint32_t first, uint32_t n, int depth)
{
    uint32_t index = builder->n_nodes++;
    BoxTreeItem *items = builder->items + first;
    Box box = box_empty(), centers = box_empty();
    for (uint32_t i = 0; i < n; i++) {
        box = box_union(box, items[i].box);
        centers = box_with_ball(centers, items[i].center, 0);
    }
    builder->nodes[index] = (BoxNode){box, first, n};
    if (n <= LEAF_SIZE)
        return index;
    Split best = {0, 0, INFINITY};
    for (int axis = 0; axis < 3; axis++) {
        Split split = best_split(items, n, centers, axis);
        if (split.cost < best.cost)
            best = split;
    }
    /* If all centres coincide, or the tree gets too deep, the items are halved in their
     * present order. */
    bool halve = best.cost == (double)INFINITY || depth > BOXTREE_DEPTH / 2;
    uint32_t half = halve ? n / 2 : partition(items, n, centers, best);
    build_node(builder, first, half, depth + 1);
    uint32_t second = build_node(builder, first + half, n - half, depth + 1);
    builder->nodes[index].first = second;
    builder->nodes[index].n_items = 0;
    return index;
}

Status boxtree_build(const Box *boxes, size_t n, BoxTree *out, Err *err)
{
    BoxTreeBuilder builder = {0};
    BoxTree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&builder.items, n, sizeof *builder.items, "boxes", err));
    TRY_GOTO(mem_calloc(&made.nodes, 2 * n, sizeof *made.nodes, "nodes", err));
    TRY_GOTO(mem_calloc(&made.items, n, sizeof *made.items, "boxes", err));
    builder.nodes = made.nodes;
    for (size_t i = 0; i < n; i++) {
        /* A margin for the rounding of a ray's intersections with the box. */
        double slack = 1e-12 * (vec3_length(boxes[i].low) + vec3_length(boxes[i].high));
        builder.items[i] =
            (BoxTreeItem){box_padded(boxes[i], slack), box_center(boxes[i]), (uint32_t)i};
    }
    build_node(&builder, 0, (uint32_t)n, 0);
    for (size_t i = 0; i < n; i++)
        made.items[i] = builder.items[i].number;
    *out = made;
    made = (BoxTree){0};
done:
    free(builder.items);
    boxtree_release(&made);
    return status;
}

void boxtree_release(BoxTree *tree)
{
    free(tree->nodes);
    free(tree->items);
    *tree = (BoxTree){0};
}

BoxWalk boxwalk_box(const BoxTree *tree, Box box)
{
    BoxWalk walk;
    walk.tree = tree;
    walk.is_box = true;
    walk.around = box;
    walk.item = walk.end = 0;
    walk.stack[0] = 0;
    walk.top = 1;
    return walk;
}

BoxWalk boxwalk_segment(const BoxTree *tree, Vec3 a, Vec3 b)
{
    BoxWalk walk;
    boxwalk_start(&walk, tree, a, vec3_sub(b, a), 0, false);
    return walk;
}

/* Returns the next leaf that meets the box `around`; NULL if there is none. */
static const BoxNode *leaf_in_box(BoxWalk *walk)
{
    while (walk->top > 0) {
        uint32_t index = walk->stack[--walk->top];
        const BoxNode *node = &walk->tree->nodes[index];
        if (!box_overlaps(walk->around, node->box))
            continue;
        if (node->n_items > 0)
            return node;
        walk->stack[walk->top++] = node->first;
        walk->stack[walk->top++] = index + 1;
    }
    return NULL;
}

bool boxwalk_next(BoxWalk *walk, uint32_t *item)
{
    if (walk->item == walk->end) {
        const BoxNode *leaf = walk->is_box ? leaf_in_box(walk) : boxwalk_leaf(walk, 1);
        if (!leaf)
            return false;
        walk->item = leaf->first;
        walk->end = leaf->first + leaf->n_items;
    }
    *item = walk->tree->items[walk->item++];
    return true;
}
