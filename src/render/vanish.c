/* A term is largest half way along its segment, erf(k l / 2). Only segments for which that is below
 * the level, those shorter than 0.17 of their radius, can vanish, and do unless their neighbours
 * make up for it; a hierarchy finds those neighbours, and is built only when there is such a
 * segment. */
#include "render/cast/fieldindex.h"
#include "render/render.h"
#include "surface/surface.h"

static bool holds(const FieldNode *node, const double x[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (!(x[axis] >= node->bounds[0][axis] && x[axis] <= node->bounds[1][axis]))
            return false;
    return true;
}

static double potential_at(const FieldIndex *index, Vec3 point)
{
    const double x[3] = {point.x, point.y, point.z};
    uint32_t stack[FIELD_STACK_SIZE];
    int top = 0;
    double sum = 0;
    if (index->n_nodes)
        stack[top++] = 0;
    while (top > 0) {
        uint32_t number = stack[--top];
        const FieldNode *node = &index->nodes[number];
        if (!holds(node, x))
            continue;
        if (node->n_tubes == 0) {
            stack[top++] = node->first;
            stack[top++] = number + 1;
        }
        for (uint32_t i = node->first; i < node->first + node->n_tubes; i++)
            sum += potential_term(&index->scene->segments[index->tubes[i].segment], point);
    }
    return sum;
}

Status render_count_vanished(const Scene *scene, size_t *count, Err *err)
{
    FieldIndex *index = NULL;
    size_t found = 0;
    for (size_t i = 0; i < scene->n_segments; i++) {
        const FieldSegment *segment = &scene->segments[i];
        if (potential_term_peak(segment) >= FIELD_LEVEL)
            continue;
        if (!index)
            TRY(fieldindex_build(scene, &index, err));
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        found += potential_at(index, middle) < FIELD_LEVEL;
    }
    fieldindex_free(index);
    *count = found;
    return STATUS_OK;
}
