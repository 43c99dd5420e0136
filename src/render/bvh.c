/* Built top-down by splitting the longest side of the box of the centres at its median, four
 * primitives a leaf: the depth is at most log2 n + 1, so traversal needs a short fixed stack. Nodes
 * stand in depth-first order, the first child next to its parent. */
#include "render/bvh.h"

#include <stdlib.h>

enum { LEAF_SIZE = 4, MAX_DEPTH = 64 };

typedef struct Node {
    Box box;
    uint32_t first;   /* leaf: its items; inner: the second child */
    uint32_t n_items; /* 0 for an inner node */
} Node;

typedef struct Item {
    Vec3 center;
    uint32_t primitive;
} Item;

struct Bvh {
    const Primitive *primitives;
    CylinderFrame *frames; /* one a primitive; unused for spheres */
    Item *items;
    Node *nodes;
    size_t n_nodes;
};

static Box primitive_box(const Primitive *primitive)
{
    Box box = box_with_ball(box_empty(), primitive->a, primitive->radius_mm);
    box = box_with_ball(box, primitive->b, primitive->radius_mm);
    /* Rounding of a hit at the rim of the box must not lose it. */
    double slack = 1e-9 * (1 + vec3_length(box.low) + vec3_length(box.high));
    Vec3 pad = vec3(slack, slack, slack);
    return (Box){vec3_sub(box.low, pad), vec3_add(box.high, pad)};
}

static double along(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static int compare_along(const void *a, const void *b, int axis)
{
    const Item *left = a, *right = b;
    double x = along(left->center, axis), y = along(right->center, axis);
    if (x != y)
        return x < y ? -1 : 1;
    return left->primitive < right->primitive ? -1 : 1;
}

static int compare_x(const void *a, const void *b)
{
    return compare_along(a, b, 0);
}

static int compare_y(const void *a, const void *b)
{
    return compare_along(a, b, 1);
}

static int compare_z(const void *a, const void *b)
{
    return compare_along(a, b, 2);
}

static uint32_t build_node(Bvh *bvh, uint32_t first, uint32_t n)
{
    uint32_t index = (uint32_t)bvh->n_nodes++;
    Box box = box_empty(), centers = box_empty();
    for (uint32_t i = first; i < first + n; i++) {
        box = box_union(box, primitive_box(&bvh->primitives[bvh->items[i].primitive]));
        centers = box_with_ball(centers, bvh->items[i].center, 0);
    }
    bvh->nodes[index] = (Node){box, first, n};
    if (n <= LEAF_SIZE)
        return index;
    Vec3 size = vec3_sub(centers.high, centers.low);
    int (*compare)(const void *, const void *) = size.x >= size.y && size.x >= size.z ? compare_x
                                                 : size.y >= size.z                   ? compare_y
                                                                                      : compare_z;
    qsort(bvh->items + first, n, sizeof *bvh->items, compare);
    build_node(bvh, first, n / 2);
    uint32_t second = build_node(bvh, first + n / 2, n - n / 2);
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
    TRY_GOTO(mem_calloc(&bvh->frames, n, sizeof *bvh->frames, "cylinder frames", err));
    TRY_GOTO(mem_calloc(&bvh->items, n, sizeof *bvh->items, "primitives", err));
    TRY_GOTO(mem_calloc(&bvh->nodes, 2 * n, sizeof *bvh->nodes, "nodes", err));
    for (size_t i = 0; i < n; i++) {
        const Primitive *primitive = &primitives[i];
        if (primitive->kind == PRIMITIVE_CYLINDER)
            bvh->frames[i] = cylinder_frame(primitive->a, primitive->b, primitive->radius_mm);
        bvh->items[i] = (Item){vec3_scale(vec3_add(primitive->a, primitive->b), 0.5), (uint32_t)i};
    }
    build_node(bvh, 0, (uint32_t)n);
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
    if (primitive->kind == PRIMITIVE_SPHERE)
        return hit_sphere(ray, primitive->a, primitive->radius_mm, hits);
    return hit_cylinder(ray, &bvh->frames[index], hits);
}

bool bvh_first_hit(const Bvh *bvh, Ray ray, double t_min, Hit *hit, size_t *primitive)
{
    Vec3 inverse = vec3(1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z);
    uint32_t stack[MAX_DEPTH];
    int top = 0;
    uint32_t best = UINT32_MAX;
    hit->t = INFINITY;
    stack[top++] = 0;
    while (top > 0) {
        uint32_t index = stack[--top];
        const Node *node = &bvh->nodes[index];
        double t0 = t_min, t1 = hit->t;
        if (!hit_box(ray.origin, inverse, &node->box, &t0, &t1))
            continue;
        if (node->n_items == 0) {
            /* The child whose centre is nearer goes on top. */
            uint32_t near = index + 1, far = node->first;
            Vec3 apart =
                vec3_sub(box_center(bvh->nodes[far].box), box_center(bvh->nodes[near].box));
            bool swap = vec3_dot(apart, ray.direction) < 0;
            stack[top++] = swap ? near : far;
            stack[top++] = swap ? far : near;
            continue;
        }
        for (uint32_t i = node->first; i < node->first + node->n_items; i++) {
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
    }
    *primitive = best;
    return best != UINT32_MAX;
}

bool bvh_any_hit(const Bvh *bvh, Ray ray, double t_min, double t_max)
{
    Vec3 inverse = vec3(1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z);
    uint32_t stack[MAX_DEPTH];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        uint32_t index = stack[--top];
        const Node *node = &bvh->nodes[index];
        double t0 = t_min, t1 = t_max;
        if (!hit_box(ray.origin, inverse, &node->box, &t0, &t1))
            continue;
        if (node->n_items == 0) {
            stack[top++] = node->first;
            stack[top++] = index + 1;
            continue;
        }
        for (uint32_t i = node->first; i < node->first + node->n_items; i++) {
            Hit hits[4];
            int n = primitive_hits(bvh, bvh->items[i].primitive, ray, hits);
            for (int k = 0; k < n; k++)
                if (hits[k].t > t_min && hits[k].t < t_max)
                    return true;
        }
    }
    return false;
}
