/* A triangle of a cap says which segment it closes, and the side to which it faces says at which
 * end of it. Areas are added up place by place; the places that have one are sorted and numbered,
 * and the triangles are given the numbers of their places. */
#include "scene/meshends.h"

#include <stdio.h>
#include <stdlib.h>

/* Either end of a segment: place 2 i is where segment i begins, 2 i + 1 where it ends. */
typedef struct Place {
    double area_mm2; /* 0: nothing closes it */
    uint32_t part;
} Place;

void meshends_release(MeshEnds *ends)
{
    free(ends->ends);
    free(ends->parts);
    *ends = (MeshEnds){0};
}

static Vec3 axis_of(const FieldSegment *segment)
{
    return vec3_normalized(vec3_sub(segment->b, segment->a));
}

/* The place that a triangle of a cap closes. */
static uint32_t place_of(const VesselMesh *mesh, const VesselTree *tree, size_t triangle)
{
    float normal[3];
    uint32_t segment = mesh_segment(mesh, triangle);
    mesh_flat_normal(mesh, triangle, normal);
    Vec3 out = vec3((double)normal[0], (double)normal[1], (double)normal[2]);
    return 2 * segment + (vec3_dot(out, axis_of(&tree->segments[segment])) > 0);
}

static double triangle_area(const VesselMesh *mesh, size_t triangle)
{
    const uint32_t *at = mesh->triangles[triangle];
    Vec3 a = mesh_point(mesh, at[0]);
    return 0.5 * vec3_length(vec3_cross(vec3_sub(mesh_point(mesh, at[1]), a),
                                        vec3_sub(mesh_point(mesh, at[2]), a)));
}

static MeshEnd make_end(const VesselTree *tree, uint32_t place, double area_mm2)
{
    const FieldSegment *segment = &tree->segments[place / 2];
    bool is_inlet = place % 2 == 0;
    return (MeshEnd){.segment = place / 2,
                     .is_inlet = is_inlet,
                     .center = is_inlet ? segment->a : segment->b,
                     .normal = vec3_scale(axis_of(segment), is_inlet ? -1 : 1),
                     .radius_mm = segment->radius_mm,
                     .area_mm2 = area_mm2};
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t *one = a, *other = b;
    return (*one > *other) - (*one < *other);
}

/* Ends are sorted by whether blood leaves there, id, and place. */
static uint64_t sorting_key(const VesselTree *tree, uint32_t place)
{
    return (uint64_t)(place % 2) << 63 | (uint64_t)tree->ids[place / 2] << 32 | place / 2;
}

static void name_ends(const VesselTree *tree, MeshEnds *ends)
{
    size_t inlets = 0;
    int digits = 3;
    for (size_t i = 0; i < ends->n; i++) {
        inlets += ends->ends[i].is_inlet;
        int own = snprintf(NULL, 0, "%u", tree->ids[ends->ends[i].segment]);
        digits = own > digits ? own : digits;
    }
    for (size_t i = 0; i < ends->n; i++) {
        MeshEnd *end = &ends->ends[i];
        if (end->is_inlet && inlets == 1)
            snprintf(end->name, sizeof end->name, "inlet");
        else
            snprintf(end->name, sizeof end->name, "%s_%0*u", end->is_inlet ? "inlet" : "outlet",
                     digits, tree->ids[end->segment]);
    }
}

/* Lists the places that have an area, in their order, and counts them. */
static Status sort_places(const VesselTree *tree, const Place *places, uint64_t **keys, size_t *n,
                          Err *err)
{
    size_t count = 0;
    for (size_t place = 0; place < 2 * tree->n_segments; place++)
        count += places[place].area_mm2 > 0;
    TRY(mem_calloc(keys, count, sizeof **keys, "ends", err));
    for (uint32_t place = 0, at = 0; at < count; place++)
        if (places[place].area_mm2 > 0)
            (*keys)[at++] = sorting_key(tree, place);
    qsort(*keys, count, sizeof **keys, compare_keys);
    *n = count;
    return STATUS_OK;
}

static Status list_ends(const VesselTree *tree, Place *places, MeshEnds *ends, Err *err)
{
    uint64_t *keys = NULL;
    Status status;
    TRY_GOTO(sort_places(tree, places, &keys, &ends->n, err));
    TRY_GOTO(mem_calloc(&ends->ends, ends->n, sizeof *ends->ends, "ends", err));
    for (uint32_t i = 0; i < ends->n; i++) {
        uint32_t place = (uint32_t)(2 * (keys[i] & UINT32_MAX) + (keys[i] >> 63));
        ends->ends[i] = make_end(tree, place, places[place].area_mm2);
        places[place].part = i + 1;
    }
    name_ends(tree, ends);
done:
    free(keys);
    return status;
}

Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out, Err *err)
{
    MeshEnds made = {0};
    Place *places = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&places, 2 * tree->n_segments, sizeof *places, "ends", err));
    TRY_GOTO(mem_calloc(&made.parts, mesh->n_triangles, sizeof *made.parts, "triangles", err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        if (mesh_is_cap(mesh, i))
            places[place_of(mesh, tree, i)].area_mm2 += triangle_area(mesh, i);
    TRY_GOTO(list_ends(tree, places, &made, err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        if (mesh_is_cap(mesh, i))
            made.parts[i] = places[place_of(mesh, tree, i)].part;
    *out = made;
    made = (MeshEnds){0};
done:
    meshends_release(&made);
    free(places);
    return status;
}
