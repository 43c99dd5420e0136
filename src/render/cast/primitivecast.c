/* primitive_search: finds the hits of a ray with cylinders, balls and joints, by a bounding volume
 * hierarchy. Data that depend on the primitive alone, such as its axis, are computed once
 * [primitive_frame]. */
#include "render/cast/boxcast.h"

static Box primitive_box(const RayIndex *index, size_t i)
{
    const Primitive *primitive = &index->geometry->primitives[i];
    Box box = box_with_ball(box_empty(), primitive->a, primitive->radius_mm);
    box = box_with_ball(box, primitive->b, primitive_radius_b(primitive));
    /* Rounding of a hit at the rim of the box must not lose it. */
    return box_padded(box, 1e-9 * (1 + vec3_length(box.low) + vec3_length(box.high)));
}

static Status build(RayIndex *index, const CellParams *cells, Err *err)
{
    (void)cells;
    const size_t n = index->geometry->n_primitives;
    TRY(mem_calloc(&index->frames, n, sizeof *index->frames, "primitives", err));
    for (size_t i = 0; i < n; i++)
        index->frames[i] = primitive_frame(&index->geometry->primitives[i]);
    return rayindex_build_boxes(index, n, primitive_box, err);
}

/* Callback of type ItemCrossings. */
static inline int primitive_crossings(const void *items, uint32_t i, Ray ray,
                                      Hit hits[ITEM_CROSSINGS], double *rank)
{
    (void)rank;
    const RayIndex *index = items;
    return primitive_hits(&index->geometry->primitives[i], &index->frames[i], ray, hits);
}

static bool first_primitive(const RayIndex *index, void *workspace, const RayPart *part,
                            RayHit *hit)
{
    (void)workspace;
    Hit nearest;
    if (!boxcast_first(&index->boxes, part, part->t_min, primitive_crossings, index, &nearest,
                       &hit->index))
        return false;
    hit->t = nearest.t;
    hit->normal = nearest.normal;
    return true;
}

static bool any_primitive(const RayIndex *index, void *workspace, const RayPart *part)
{
    (void)workspace;
    return boxcast_any(&index->boxes, part, part->t_min, primitive_crossings, index);
}

const RaySearch primitive_search = {.nearest_mm = NEAREST_VISIBLE_MM,
                                    .build = build,
                                    .first = first_primitive,
                                    .any = any_primitive};
