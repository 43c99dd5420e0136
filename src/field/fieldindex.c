/* Builds and searches a hierarchy of boxes over the tubes of a field, to evaluate the potential at
 * a point.
 *
 * The hierarchy is built from the top down. The tubes of a node are split at the median of their
 * midpoints, along the longest side of the midpoints' box. So the depth is at most log2 n + 1, and
 * a short stack of fixed size is enough for traversal. The tubes end up in the order of the leaves.
 */
#include "field/field.h"

#include <stdlib.h>

FieldTube fieldtube_of(const FieldSegment *segment, uint32_t index)
{
    Vec3 span = vec3_sub(segment->b, segment->a);
    FieldTube tube = {.a = segment->a, .length = vec3_length(span), .segment = index};
    tube.axis = vec3_scale(span, 1 / tube.length);
    tube.k = potential_k(segment->radius_mm);
    tube.length_k = tube.k * tube.length;
    tube.peak = potential_term_peak(segment);
    tube.log_peak = elementary_log(tube.peak);
    tube.reach2 = tube.log_peak - elementary_log(RAY_TERM_CUTOFF);
    return tube;
}

static Vec3 middle(const FieldTube *tube)
{
    return vec3_add_scaled(tube->a, tube->axis, tube->length / 2);
}

static Box tube_box(const FieldTube *tube)
{
    double reach = sqrt(tube->reach2) / tube->k;
    Box box = box_with_ball(box_empty(), tube->a, reach);
    return box_with_ball(box, vec3_add_scaled(tube->a, tube->axis, tube->length), reach);
}

/* Orders tubes by their midpoints along *axis, an int, and then by segment. */
static int compare_tubes(const void *a, const void *b, void *axis)
{
    const FieldTube *one = a, *other = b;
    const int along = *(const int *)axis;
    int order =
        compare_numbers(vec3_component(middle(one), along), vec3_component(middle(other), along));
    return order ? order : compare_numbers(one->segment, other->segment);
}

/* Adds a node for n tubes from `first` on, and the nodes below it. Returns its index. */
static uint32_t build_node(FieldIndex *index, uint32_t first, uint32_t n)
{
    Box box = box_empty(), middles = box_empty();
    for (uint32_t i = first; i < first + n; i++) {
        box = box_union(box, tube_box(&index->tubes[i]));
        middles = box_with_ball(middles, middle(&index->tubes[i]), 0);
    }
    uint32_t node = (uint32_t)index->n_nodes++;
    index->nodes[node] = (FieldNode){
        {{box.low.x, box.low.y, box.low.z}, {box.high.x, box.high.y, box.high.z}}, first, n};
    if (n <= FIELD_LEAF_SIZE)
        return node;
    int axis = box_longest_axis(middles);
    qsort_r(index->tubes + first, n, sizeof *index->tubes, compare_tubes, &axis);
    build_node(index, first, n / 2);
    uint32_t second = build_node(index, first + n / 2, n - n / 2);
    index->nodes[node].first = second;
    index->nodes[node].n_tubes = 0;
    return node;
}

Status fieldindex_build(const Geometry *geometry, FieldIndex **out, Err *err)
{
    Status status;
    FieldIndex *index = NULL;
    size_t n = geometry->n_segments;
    TRY_GOTO(mem_calloc(&index, 1, sizeof *index, "field indices", err));
    TRY_GOTO(mem_calloc(&index->tubes, n, sizeof *index->tubes, "tubes", err));
    TRY_GOTO(mem_calloc(&index->nodes, 2 * n, sizeof *index->nodes, "nodes", err));
    index->geometry = geometry;
    for (size_t i = 0; i < n; i++) {
        FieldTube tube = fieldtube_of(&geometry->segments[i], (uint32_t)i);
        if (tube.reach2 > 0)
            index->tubes[index->n_tubes++] = tube;
    }
    if (index->n_tubes)
        build_node(index, 0, (uint32_t)index->n_tubes);
    *out = index;
    return STATUS_OK;
done:
    fieldindex_free(index);
    return status;
}

static bool holds(const FieldNode *node, const double x[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (!(x[axis] >= node->bounds[0][axis] && x[axis] <= node->bounds[1][axis]))
            return false;
    return true;
}

double fieldindex_potential(const FieldIndex *index, Vec3 point)
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
            sum += potential_term(&index->geometry->segments[index->tubes[i].segment], point);
    }
    return sum;
}

void fieldindex_free(FieldIndex *index)
{
    if (!index)
        return;
    free(index->tubes);
    free(index->nodes);
    free(index);
}
