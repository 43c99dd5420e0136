/* A tree of boxes [boxtree.h] and what is behind them. The nearest hit so far bounds the walk; of
 * the two children of a node the nearer is looked at first, so that it is found early. */
#include "render/cast/bvh.h"

#include <stdlib.h>

/* What a primitive's rays are tested against; a sphere needs none. */
typedef union PrimitiveFrame {
    CylinderFrame cylinder;
    JointFrame joint;
} PrimitiveFrame;

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

/* What the rays of a primitive are tested against. */
static PrimitiveFrame frame_of(const Primitive *primitive)
{
    PrimitiveFrame frame = {0};
    if (primitive->kind == PRIMITIVE_CYLINDER)
        frame.cylinder = cylinder_frame(primitive->a, primitive->b, primitive->radius_mm);
    else if (primitive->kind == PRIMITIVE_JOINT)
        frame.joint = primitive_joint(primitive);
    return frame;
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
        bvh->frames[i] = frame_of(&primitives[i]);
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
    BoxWalk walk;
    boxwalk_start(&walk, &bvh->tree, ray.origin, ray.direction, t_min, false);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[4];
            int n = primitive_hits(bvh, bvh->tree.items[i], ray, hits);
            for (int k = 0; k < n; k++)
                if (hits[k].t > t_min && hits[k].t < t_max)
                    return true;
        }
    return false;
}
