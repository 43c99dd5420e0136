/* Built top-down by splitting the longest side of the box of the centres at its median, four boxes
 * a leaf, so that the depth is at most log2 n. The median is found by partial sorting (Hoare's
 * FIND, CACM 4 (1961), 321), which makes the building O(n log n). Nodes stand in depth-first order,
 * the first child next to its parent. */
#include "domain/boxtree.h"

#include <stdlib.h>

enum { LEAF_SIZE = 4 };

typedef struct Node {
    Box box;
    uint32_t first;   /* leaf: its items; inner: the second child */
    uint32_t n_items; /* 0 for an inner node */
} Node;

typedef struct Item {
    Vec3 center;
    uint32_t box;
} Item;

struct BoxTree {
    Item *items;
    Node *nodes;
    uint32_t n_nodes;
};

static Box widened(Box box)
{
    double slack = 1e-12 * (vec3_length(box.low) + vec3_length(box.high));
    Vec3 pad = vec3(slack, slack, slack);
    return (Box){vec3_sub(box.low, pad), vec3_add(box.high, pad)};
}

/* Reorders the items so that none before the one at `middle` is above it and none after it
 * below. */
static void split_at(Item *items, int64_t n, int64_t middle, int axis)
{
    int64_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = vec3_component(items[middle].center, axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (vec3_component(items[i].center, axis) < pivot)
                i++;
            while (vec3_component(items[j].center, axis) > pivot)
                j--;
            if (i > j)
                break;
            Item swap = items[i];
            items[i++] = items[j];
            items[j--] = swap;
        }
        if (j < middle)
            low = i;
        if (middle < i)
            high = j;
    }
}

static uint32_t build_node(BoxTree *tree, const Box *boxes, uint32_t first, uint32_t n)
{
    uint32_t index = tree->n_nodes++;
    Box box = box_empty(), centers = box_empty();
    for (uint32_t i = first; i < first + n; i++) {
        box = box_union(box, widened(boxes[tree->items[i].box]));
        centers = box_with_ball(centers, tree->items[i].center, 0);
    }
    tree->nodes[index] = (Node){box, first, n};
    if (n <= LEAF_SIZE)
        return index;
    split_at(tree->items + first, n, n / 2, box_longest_axis(centers));
    build_node(tree, boxes, first, n / 2);
    uint32_t second = build_node(tree, boxes, first + n / 2, n - n / 2);
    tree->nodes[index].first = second;
    tree->nodes[index].n_items = 0;
    return index;
}

Status boxtree_build(const Box *boxes, size_t n, BoxTree **out, Err *err)
{
    BoxTree *tree = NULL;
    Status status = mem_calloc(&tree, 1, sizeof *tree, "trees of boxes", err);
    if (status != STATUS_OK)
        return status;
    TRY_GOTO(mem_calloc(&tree->items, n, sizeof *tree->items, "boxes", err));
    TRY_GOTO(mem_calloc(&tree->nodes, 2 * n, sizeof *tree->nodes, "nodes", err));
    for (size_t i = 0; i < n; i++)
        tree->items[i] = (Item){box_center(boxes[i]), (uint32_t)i};
    build_node(tree, boxes, 0, (uint32_t)n);
    *out = tree;
    return STATUS_OK;
done:
    boxtree_free(tree);
    return status;
}

void boxtree_free(BoxTree *tree)
{
    if (!tree)
        return;
    free(tree->items);
    free(tree->nodes);
    free(tree);
}

static void start(BoxWalk *walk, const BoxTree *tree, Box around)
{
    walk->tree = tree;
    walk->around = around;
    walk->depth = 0;
    walk->item = walk->end = 0;
    walk->stack[walk->depth++] = 0;
}

BoxWalk boxwalk_box(const BoxTree *tree, Box box)
{
    BoxWalk walk;
    start(&walk, tree, box);
    walk.is_segment = false;
    return walk;
}

BoxWalk boxwalk_segment(const BoxTree *tree, Vec3 a, Vec3 b)
{
    BoxWalk walk;
    start(&walk, tree, box_with_ball(box_with_ball(box_empty(), a, 0), b, 0));
    walk.is_segment = true;
    walk.origin = a;
    walk.inverse = vec3_inverse(vec3_sub(b, a));
    return walk;
}

static bool meets(const BoxWalk *walk, const Box *box)
{
    if (!box_meets(walk->around, *box))
        return false;
    double t0 = 0, t1 = 1;
    return !walk->is_segment || hit_box(walk->origin, walk->inverse, box, &t0, &t1);
}

bool boxwalk_next(BoxWalk *walk, uint32_t *box)
{
    while (walk->item == walk->end) {
        if (walk->depth == 0)
            return false;
        uint32_t index = walk->stack[--walk->depth];
        const Node *node = &walk->tree->nodes[index];
        if (!meets(walk, &node->box))
            continue;
        if (node->n_items > 0) {
            walk->item = node->first;
            walk->end = node->first + node->n_items;
        } else {
            walk->stack[walk->depth++] = node->first;
            walk->stack[walk->depth++] = index + 1;
        }
    }
    *box = walk->tree->items[walk->item++].box;
    return true;
}
