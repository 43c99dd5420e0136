/* Finds the flat ends of a mesh of vessels, the inlets and outlets of a flow simulation, and
 * divides the triangles into named parts: the walls, and one part per end. An end is a disc; of a
 * hollow wall it is a disc (the lumen) and a ring (the wall).
 *
 * The label of a flat triangle identifies its segment. The side to which the triangle faces
 * identifies the segment's end. For a hollow wall, the lumen flag distinguishes discs from rings.
 * Areas are summed per disc or ring. Those with an area are sorted and numbered, and their
 * triangles get the numbers. */
#include "scene/meshends.h"

#include <stdio.h>
#include <stdlib.h>

/* Indices of the discs and rings of segment i: 4 i and 4 i + 1 are the discs at its start and end,
 * 4 i + 2 and 4 i + 3 the rings. */
enum { PLACES = 4, AT_END = 1, IS_RING = 2 };

/* A possible disc or ring. */
typedef struct EndPlace {
    double area_mm2; /* 0: the mesh does not have it */
    uint32_t part;   /* number of its part */
} EndPlace;

/* The parts that are not ends: the wall, its inner side, and the frame around a print. */
enum { WALL, LUMEN, FRAME, WALLS };

typedef struct MeshEndSearch {
    const VesselMesh *mesh;
    const VesselTree *tree;
    bool is_hollow;
    uint32_t walls[WALLS]; /* numbers of their parts */
    EndPlace *places;      /* PLACES per segment; owned */
} MeshEndSearch;

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

/* Returns the kind of wall that a triangle belongs to. */
static int wall_of(const VesselMesh *mesh, size_t triangle)
{
    uint32_t label = mesh->labels[triangle];
    return label & MESH_FRAME ? FRAME : label & MESH_LUMEN ? LUMEN : WALL;
}

static bool is_end(const VesselMesh *mesh, size_t triangle)
{
    return mesh_is_cap(mesh, triangle) && wall_of(mesh, triangle) != FRAME;
}

/* Returns the index of the disc or ring of a flat triangle. */
static uint32_t place_of(const MeshEndSearch *search, size_t triangle)
{
    float normal[3];
    uint32_t segment = mesh_segment(search->mesh, triangle);
    mesh_flat_normal(search->mesh, triangle, normal);
    Vec3 out = vec3((double)normal[0], (double)normal[1], (double)normal[2]);
    bool at_end = vec3_dot(out, axis_of(&search->tree->segments[segment])) > 0;
    bool is_ring = search->is_hollow && wall_of(search->mesh, triangle) != LUMEN;
    return PLACES * segment + (at_end ? AT_END : 0) + (is_ring ? IS_RING : 0);
}

static double triangle_area(const VesselMesh *mesh, size_t triangle)
{
    const uint32_t *at = mesh->triangles[triangle];
    Vec3 a = mesh_point(mesh, at[0]);
    return 0.5 * vec3_length(vec3_cross(vec3_sub(mesh_point(mesh, at[1]), a),
                                        vec3_sub(mesh_point(mesh, at[2]), a)));
}

/* Finds which walls the mesh has, and names them. */
static void find_walls(MeshEndSearch *search, MeshEnds *ends)
{
    bool found[WALLS] = {false};
    for (size_t i = 0; i < search->mesh->n_triangles; i++)
        found[wall_of(search->mesh, i)] = true;
    search->is_hollow = found[LUMEN];
    const char *const names[WALLS] = {found[LUMEN] ? "outer" : "wall", "lumen", "frame"};
    for (int wall = 0; wall < WALLS; wall++)
        if (found[wall]) {
            search->walls[wall] = (uint32_t)ends->n_walls;
            ends->walls[ends->n_walls++] = names[wall];
        }
}

static MeshEnd make_end(const MeshEndSearch *search, uint32_t place)
{
    const FieldSegment *segment = &search->tree->segments[place / PLACES];
    bool is_inlet = !(place & AT_END);
    return (MeshEnd){.segment = place / PLACES,
                     .is_inlet = is_inlet,
                     .is_ring = place & IS_RING,
                     .center = is_inlet ? segment->a : segment->b,
                     .normal = vec3_scale(axis_of(segment), is_inlet ? -1 : 1),
                     .radius_mm = segment->radius_mm,
                     .area_mm2 = search->places[place].area_mm2};
}

/* Compares keys for qsort. */
static int compare_keys(const void *a, const void *b)
{
    const uint64_t *one = a, *other = b;
    return (*one > *other) - (*one < *other);
}

/* Returns the sorting key of an end: discs before rings, inlets before outlets, then id, then
 * segment. */
static uint64_t sorting_key(const VesselTree *tree, uint32_t place)
{
    uint32_t segment = place / PLACES;
    return (uint64_t)(place % PLACES) << 62 | (uint64_t)tree->ids[segment] << 32 | segment;
}

/* Names the ends "inlet", or "inlet_007" if there are several inlets, and "outlet_012": the numbers
 * are ids of segments, with zeros so that the names sort as the numbers do. Rings get "_ring". */
static void name_ends(const VesselTree *tree, MeshEnds *ends)
{
    size_t inlets = 0;
    int digits = 3;
    for (size_t i = 0; i < ends->n; i++) {
        const MeshEnd *end = &ends->ends[i];
        inlets += end->is_inlet && end->is_ring == ends->ends[0].is_ring;
        int own = snprintf(NULL, 0, "%u", tree->ids[end->segment]);
        digits = own > digits ? own : digits;
    }
    for (size_t i = 0; i < ends->n; i++) {
        MeshEnd *end = &ends->ends[i];
        const char *ring = end->is_ring ? "_ring" : "";
        if (end->is_inlet && inlets == 1)
            snprintf(end->name, sizeof end->name, "inlet%s", ring);
        else
            snprintf(end->name, sizeof end->name, "%s_%0*u%s", end->is_inlet ? "inlet" : "outlet",
                     digits, tree->ids[end->segment], ring);
    }
}

/* Lists the sorting keys of the discs and rings that have an area, sorted, and counts them. */
static Status sort_places(const MeshEndSearch *search, uint64_t **keys, size_t *n, Err *err)
{
    size_t count = 0;
    for (size_t place = 0; place < PLACES * search->tree->n_segments; place++)
        count += search->places[place].area_mm2 > 0;
    TRY(mem_calloc(keys, count, sizeof **keys, "ends", err));
    for (uint32_t place = 0, at = 0; at < count; place++)
        if (search->places[place].area_mm2 > 0)
            (*keys)[at++] = sorting_key(search->tree, place);
    qsort(*keys, count, sizeof **keys, compare_keys);
    *n = count;
    return STATUS_OK;
}

static Status list_ends(MeshEndSearch *search, MeshEnds *ends, Err *err)
{
    uint64_t *keys = NULL;
    Status status;
    TRY_GOTO(sort_places(search, &keys, &ends->n, err));
    TRY_GOTO(mem_calloc(&ends->ends, ends->n, sizeof *ends->ends, "ends", err));
    for (uint32_t i = 0; i < ends->n; i++) {
        uint32_t place = PLACES * (uint32_t)keys[i] + (uint32_t)(keys[i] >> 62);
        ends->ends[i] = make_end(search, place);
        search->places[place].part = (uint32_t)ends->n_walls + i;
    }
    name_ends(search->tree, ends);
done:
    free(keys);
    return status;
}

Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out, Err *err)
{
    MeshEnds made = {0};
    MeshEndSearch search = {.mesh = mesh, .tree = tree};
    Status status;
    TRY_GOTO(
        mem_calloc(&search.places, PLACES * tree->n_segments, sizeof *search.places, "ends", err));
    TRY_GOTO(mem_calloc(&made.parts, mesh->n_triangles, sizeof *made.parts, "triangles", err));
    find_walls(&search, &made);
    for (size_t i = 0; i < mesh->n_triangles; i++)
        if (is_end(mesh, i))
            search.places[place_of(&search, i)].area_mm2 += triangle_area(mesh, i);
    TRY_GOTO(list_ends(&search, &made, err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        made.parts[i] = is_end(mesh, i) ? search.places[place_of(&search, i)].part
                                        : search.walls[wall_of(mesh, i)];
    *out = made;
    made = (MeshEnds){0};
done:
    meshends_release(&made);
    free(search.places);
    return status;
}
