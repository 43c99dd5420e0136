/* A tree of boxes [boxtree.h] and what is behind them. The nearest hit so far bounds the walk; of
 * the two children of a node the nearer is looked at first, so that it is found early. */
#include "render/cast/bvh.h"

#include <stdlib.h>

struct Bvh {
    const Primitive *primitives;
    PrimitiveFrame *frames; /* one a primitive */
    BoxTree tree;           /* of the primitives' boxes */
};

static Box primitive_box(const Primitive *primitive)
{
    Box box = box_with_ball(box_empty(), primitive->a, primitive->radius_mm);
    box = box_with_ball(box, primitive->b, primitive_radius_b(primitive));
    /* Rounding of a hit at the rim of the box must not lose it. */
    return box_padded(box, 1e-9 * (1 + vec3_length(box.low) + vec3_length(box.high)));
}

Status bvh_build(const Primitive *primitives, size_t n, Bvh **out, Err *err)
{
    Bvh *bvh = NULL;
    Box *boxes = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&bvh, 1, sizeof *bvh, "hierarchies", err));
    TRY_GOTO(mem_calloc(&bvh->frames, n, sizeof *bvh->frames, "primitives", err));
    TRY_GOTO(mem_calloc(&boxes, n, sizeof *boxes, "boxes", err));
    bvh->primitives = primitives;
    for (size_t i = 0; i < n; i++) {
        bvh->frames[i] = primitive_frame(&primitives[i]);
        boxes[i] = primitive_box(&primitives[i]);
    }
    TRY_GOTO(boxtree_build(boxes, n, &bvh->tree, err));
    *out = bvh;
    bvh = NULL;
done:
    free(boxes);
    bvh_free(bvh);
    return status;
}

void bvh_free(Bvh *bvh)
{
    if (!bvh)
        return;
    free(bvh->frames);
    boxtree_release(&bvh->tree);
    free(bvh);
}

bool bvh_first_hit(const Bvh *bvh, Ray ray, double t_min, Hit *hit, size_t *primitive)
{
    BoxWalk walk;
    uint32_t best = UINT32_MAX;
    hit->t = INFINITY;
    boxwalk_start(&walk, &bvh->tree, ray.origin, ray.direction, t_min, true);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, hit->t));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            uint32_t candidate = bvh->tree.items[i];
            Hit hits[4];
            int n = primitive_hits(&bvh->primitives[candidate], &bvh->frames[candidate], ray, hits);
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
    BoxWalk walk;
    boxwalk_start(&walk, &bvh->tree, ray.origin, ray.direction, t_min, false);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[4];
            uint32_t candidate = bvh->tree.items[i];
            int n = primitive_hits(&bvh->primitives[candidate], &bvh->frames[candidate], ray, hits);
            for (int k = 0; k < n; k++)
                if (hits[k].t > t_min && hits[k].t < t_max)
                    return true;
        }
    return false;
}
