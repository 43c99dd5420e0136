/* Built top-down by the surface area heuristic over the bins of the centres along each axis
 * [Wald 2007, On fast construction of SAH-based bounding volume hierarchies]: long vessels beside
 * short ones make median splits overlap. Past half the depth that the traversal's stack allows,
 * items are halved, which ends within 32 more levels. Nodes stand in depth-first order, the first
 * child next to its parent. */
#include "render/cast/bvh.h"

#include <stdlib.h>

enum { LEAF_SIZE = 2, MAX_DEPTH = 64, BINS = 16 };

typedef struct Node {
    Box box;
    uint32_t first;   /* leaf: its items; inner: the second child */
    uint32_t n_items; /* 0 for an inner node */
} Node;

typedef struct Item {
    Box box;
    Vec3 center;
    uint32_t primitive;
} Item;

/* What a primitive's rays are tested against; a sphere needs none. */
typedef union PrimitiveFrame {
    CylinderFrame cylinder;
    JointFrame joint;
} PrimitiveFrame;

struct Bvh {
    const Primitive *primitives;
    PrimitiveFrame *frames; /* one a primitive */
    Item *items;
    Node *nodes;
    size_t n_nodes;
};

static Box primitive_box(const Primitive *primitive)
{
    Box box = box_with_ball(box_empty(), primitive->a, primitive->radius_mm);
    bool joint = primitive->kind == PRIMITIVE_JOINT;
    box = box_with_ball(box, primitive->b, joint ? primitive->radius_b_mm : primitive->radius_mm);
    /* Rounding of a hit at the rim of the box must not lose it. */
    double slack = 1e-9 * (1 + vec3_length(box.low) + vec3_length(box.high));
    Vec3 pad = vec3(slack, slack, slack);
    return (Box){vec3_sub(box.low, pad), vec3_add(box.high, pad)};
}

/* Half the surface of a box: the chance that a ray meets it. */
static double box_area(Box box)
{
    Vec3 size = vec3_sub(box.high, box.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/* A split of items by the bins of their centres along one axis. */
typedef struct Split {
    int axis;
    int bin; /* the first one of the second child */
    double cost;
} Split;

static int bin_of(const Item *item, int axis, Box centers)
{
    double low = vec3_component(centers.low, axis), size = vec3_component(centers.high, axis) - low;
    int bin = size > 0 ? (int)((vec3_component(item->center, axis) - low) / size * BINS) : 0;
    return bin < BINS ? bin : BINS - 1;
}

/* The cheapest split along an axis by the surface area heuristic. */
static Split best_split(const Bvh *bvh, uint32_t first, uint32_t n, Box centers, int axis)
{
    Box box[BINS];
    uint32_t count[BINS] = {0};
    for (int i = 0; i < BINS; i++)
        box[i] = box_empty();
    for (uint32_t i = first; i < first + n; i++) {
        int bin = bin_of(&bvh->items[i], axis, centers);
        box[bin] = box_union(box[bin], bvh->items[i].box);
        count[bin]++;
    }
    double cost_above[BINS]; /* of bin i and those above it */
    Box sum = box_empty();
    uint32_t items = 0;
    for (int i = BINS - 1; i > 0; i--) {
        sum = box_union(sum, box[i]);
        items += count[i];
        cost_above[i] = items ? items * box_area(sum) : 0;
    }
    Split best = {axis, 0, INFINITY};
    sum = box_empty();
    items = 0;
    for (int i = 1; i < BINS; i++) {
        sum = box_union(sum, box[i - 1]);
        items += count[i - 1];
        double cost = items ? items * box_area(sum) + cost_above[i] : (double)INFINITY;
        if (items < n && cost < best.cost)
            best = (Split){axis, i, cost};
    }
    return best;
}

/* Moves the items of the first child to the front; how many they are. */
static uint32_t partition(Bvh *bvh, uint32_t first, uint32_t n, Box centers, Split split)
{
    uint32_t front = first;
    for (uint32_t i = first; i < first + n; i++) {
        if (bin_of(&bvh->items[i], split.axis, centers) >= split.bin)
            continue;
        Item item = bvh->items[i];
        bvh->items[i] = bvh->items[front];
        bvh->items[front++] = item;
    }
    return front - first;
}

static uint32_t build_node(Bvh *bvh, uint32_t first, uint32_t n, int depth)
{
    uint32_t index = (uint32_t)bvh->n_nodes++;
    Box box = box_empty(), centers = box_empty();
    for (uint32_t i = first; i < first + n; i++) {
        box = box_union(box, bvh->items[i].box);
        centers = box_with_ball(centers, bvh->items[i].center, 0);
    }
    bvh->nodes[index] = (Node){box, first, n};
    if (n <= LEAF_SIZE)
        return index;
    Split best = {0, 0, INFINITY};
    for (int axis = 0; axis < 3; axis++) {
        Split split = best_split(bvh, first, n, centers, axis);
        if (split.cost < best.cost)
            best = split;
    }
    /* Centres that coincide, or a tree that grows too deep, are halved as they stand. */
    bool halve = best.cost == (double)INFINITY || depth > MAX_DEPTH / 2;
    uint32_t half = halve ? n / 2 : partition(bvh, first, n, centers, best);
    build_node(bvh, first, half, depth + 1);
    uint32_t second = build_node(bvh, first + half, n - half, depth + 1);
    bvh->nodes[index].first = second;
    bvh->nodes[index].n_items = 0;
    return index;
}

Status bvh_build(const Primitive *primitives, size_t n, Bvh **out, Err *err)
{
    Bvh *bvh = NULL;
    Status status = mem_calloc(&bvh, 1, sizeof *bvh, "hierarchies", err);
    if (status != STATUS_OK)
        return status;
    bvh->primitives = primitives;
    TRY_GOTO(mem_calloc(&bvh->frames, n, sizeof *bvh->frames, "primitives", err));
    TRY_GOTO(mem_calloc(&bvh->items, n, sizeof *bvh->items, "primitives", err));
    TRY_GOTO(mem_calloc(&bvh->nodes, 2 * n, sizeof *bvh->nodes, "nodes", err));
    for (size_t i = 0; i < n; i++) {
        const Primitive *primitive = &primitives[i];
        if (primitive->kind == PRIMITIVE_CYLINDER)
            bvh->frames[i].cylinder =
                cylinder_frame(primitive->a, primitive->b, primitive->radius_mm);
        else if (primitive->kind == PRIMITIVE_JOINT)
            bvh->frames[i].joint = primitive_joint(primitive);
        bvh->items[i] = (Item){primitive_box(primitive),
                               vec3_scale(vec3_add(primitive->a, primitive->b), 0.5), (uint32_t)i};
    }
    build_node(bvh, 0, (uint32_t)n, 0);
    *out = bvh;
    return STATUS_OK;
done:
    bvh_free(bvh);
    return status;
}

void bvh_free(Bvh *bvh)
{
    if (!bvh)
        return;
    free(bvh->frames);
    free(bvh->items);
    free(bvh->nodes);
    free(bvh);
}

static int primitive_hits(const Bvh *bvh, uint32_t index, Ray ray, Hit hits[4])
{
    const Primitive *primitive = &bvh->primitives[index];
    switch (primitive->kind) {
    case PRIMITIVE_CYLINDER:
        return hit_cylinder(ray, &bvh->frames[index].cylinder, hits);
    case PRIMITIVE_SPHERE:
        return hit_sphere(ray, primitive->a, primitive->radius_mm, hits);
    case PRIMITIVE_JOINT:
        return hit_joint(ray, &bvh->frames[index].joint, hits);
    }
    return 0;
}

/* A ray on its way through the tree, the nodes still to be looked at on a stack. */
typedef struct Descent {
    const Bvh *bvh;
    Ray ray;
    Vec3 inverse;
    double t_min;
    bool near_first; /* the child whose centre is nearer comes before the other */
    uint32_t stack[MAX_DEPTH + 2];
    int top;
} Descent;

static void descent_start(Descent *descent, const Bvh *bvh, Ray ray, double t_min, bool near_first)
{
    descent->bvh = bvh;
    descent->ray = ray;
    descent->inverse = vec3_inverse(ray.direction);
    descent->t_min = t_min;
    descent->near_first = near_first;
    descent->stack[0] = 0;
    descent->top = 1;
}

/* The next leaf that the ray meets by t_max; NULL: no more. */
static const Node *descent_next(Descent *descent, double t_max)
{
    const Node *nodes = descent->bvh->nodes;
    while (descent->top > 0) {
        uint32_t index = descent->stack[--descent->top];
        const Node *node = &nodes[index];
        double t0 = descent->t_min, t1 = t_max;
        if (!hit_box(descent->ray.origin, descent->inverse, &node->box, &t0, &t1))
            continue;
        if (node->n_items > 0)
            return node;
        uint32_t near = index + 1, far = node->first;
        Vec3 apart = vec3_sub(box_center(nodes[far].box), box_center(nodes[near].box));
        bool swap = descent->near_first && vec3_dot(apart, descent->ray.direction) < 0;
        descent->stack[descent->top++] = swap ? near : far;
        descent->stack[descent->top++] = swap ? far : near;
    }
    return NULL;
}

bool bvh_first_hit(const Bvh *bvh, Ray ray, double t_min, Hit *hit, size_t *primitive)
{
    Descent descent;
    uint32_t best = UINT32_MAX;
    hit->t = INFINITY;
    descent_start(&descent, bvh, ray, t_min, true);
    for (const Node *leaf; (leaf = descent_next(&descent, hit->t));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            uint32_t candidate = bvh->items[i].primitive;
            Hit hits[4];
            int n = primitive_hits(bvh, candidate, ray, hits);
            for (int k = 0; k < n; k++) {
                bool nearer = hits[k].t < hit->t || (hits[k].t == hit->t && candidate < best);
                if (hits[k].t >= t_min && nearer) {
                    *hit = hits[k];
                    best = candidate;
                }
            }
        }
    *primitive = best;
    return best != UINT32_MAX;
}

bool bvh_any_hit(const Bvh *bvh, Ray ray, double t_min, double t_max)
{
    Descent descent;
    descent_start(&descent, bvh, ray, t_min, false);
    for (const Node *leaf; (leaf = descent_next(&descent, t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[4];
            int n = primitive_hits(bvh, bvh->items[i].primitive, ray, hits);
            for (int k = 0; k < n; k++)
                if (hits[k].t > t_min && hits[k].t < t_max)
                    return true;
        }
    return false;
}

size_t bvh_candidates(const Bvh *bvh, Ray ray, double t_min, double t_max, uint32_t *found)
{
    Descent descent;
    size_t n = 0;
    descent_start(&descent, bvh, ray, t_min, false);
    for (const Node *leaf; (leaf = descent_next(&descent, t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++)
            found[n++] = bvh->items[i].primitive;
    return n;
}
