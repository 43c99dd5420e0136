/* Points that are joined are one, by union-find whose first member stands for all. Of the rest, in
 * the order of the file, each becomes the nearest point kept before it within the tolerance, or is
 * kept itself; so what is kept does not depend on chance, and a row of close points does not melt
 * into one. Kept points are found in a hash table of cubes whose side is the tolerance: those in
 * reach are in 27 of them, and few fit into one. Without a tolerance a cube is a place. */
#include "tree/graph_parts.h"
#include "tree/tree.h"

#include <stdlib.h>
#include <string.h>

void graph_scale(Graph *graph)
{
    const LengthScale scale = length_scale(graph->options, graph->unit);
    for (size_t i = 0; i < graph->n_points; i++) {
        graph->point[i].position = length_scaled(&scale, graph->point[i].position);
        graph->point[i].radius *= scale.radius;
    }
    for (size_t i = 0; i < graph->n_lines; i++)
        graph->line[i].radius *= scale.radius;
}

uint32_t graph_first(uint32_t *place, uint32_t i)
{
    while (place[i] != i) {
        place[i] = place[place[i]];
        i = place[i];
    }
    return i;
}

/* Kept points by the cube they are in. */
typedef struct Cubes {
    const GraphPoint *point;
    double side;    /* of a cube; 0: a cube is a place */
    uint32_t *head; /* point + 1 of each slot */
    uint32_t *next; /* of each point, the next + 1 of its slot */
    size_t slots;   /* a power of two */
} Cubes;

static Vec3 cube_of(const Cubes *cubes, Vec3 at)
{
    if (cubes->side == 0)
        return (Vec3){at.x + 0.0, at.y + 0.0, at.z + 0.0}; /* no -0 */
    return (Vec3){floor(at.x / cubes->side), floor(at.y / cubes->side), floor(at.z / cubes->side)};
}

static size_t slot_of(const Cubes *cubes, Vec3 cube)
{
    uint64_t bits[3], hash = 0;
    memcpy(bits, &cube, sizeof bits);
    for (int k = 0; k < 3; k++) {
        hash = (hash ^ bits[k]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash & (cubes->slots - 1);
}

/* The nearest kept point of a cube that is nearer than *nearest, which becomes its distance, or
 * *found. Of equally near ones the first of the file. */
static uint32_t nearest_in(const Cubes *cubes, Vec3 cube, Vec3 at, uint32_t found, double *nearest)
{
    for (uint32_t i = cubes->head[slot_of(cubes, cube)]; i; i = cubes->next[i - 1]) {
        double distance = vec3_distance(cubes->point[i - 1].position, at);
        if (distance < *nearest || (distance == *nearest && i - 1 < found)) {
            *nearest = distance;
            found = i - 1;
        }
    }
    return found;
}

/* The kept point that `i` becomes: another within reach, or itself. */
static uint32_t find_kept(const Cubes *cubes, uint32_t i)
{
    Vec3 at = cubes->point[i].position, cube = cube_of(cubes, at);
    double nearest = cubes->side;
    if (cubes->side == 0)
        return nearest_in(cubes, cube, at, i, &nearest);
    uint32_t found = i;
    for (int k = 0; k < 27; k++) {
        Vec3 near = {cube.x + k % 3 - 1, cube.y + k / 3 % 3 - 1, cube.z + k / 9 - 1};
        found = nearest_in(cubes, near, at, found, &nearest);
    }
    return found;
}

static void keep(Cubes *cubes, uint32_t i)
{
    size_t slot = slot_of(cubes, cube_of(cubes, cubes->point[i].position));
    cubes->next[i] = cubes->head[slot];
    cubes->head[slot] = i + 1;
}

static void release_cubes(Cubes *cubes)
{
    free(cubes->head);
    free(cubes->next);
    *cubes = (Cubes){0};
}

/* Begins with empty cubes; release with release_cubes. */
static Status begin_cubes(Cubes *cubes, const Graph *graph, double side, Err *err)
{
    Cubes made = {.point = graph->point, .side = side, .slots = 64};
    while (made.slots < graph->n_points)
        made.slots *= 2;
    TRY(mem_calloc(&made.head, made.slots, sizeof *made.head, "cubes of points", err));
    Status status =
        mem_calloc(&made.next, graph->n_points, sizeof *made.next, "cubes of points", err);
    if (status == STATUS_OK)
        *cubes = made;
    else
        release_cubes(&made);
    return status;
}

static Status merge_places(const Graph *graph, double tolerance, uint32_t *place, Err *err)
{
    Cubes cubes;
    TRY(begin_cubes(&cubes, graph, tolerance, err));
    for (uint32_t i = 0; i < graph->n_points; i++) {
        if (place[i] != i) {
            place[i] = place[place[i]];
            continue;
        }
        place[i] = find_kept(&cubes, i);
        if (place[i] == i)
            keep(&cubes, i);
    }
    release_cubes(&cubes);
    return STATUS_OK;
}

/* Returns the distance of point `i` to the nearest point of another component that is nearer than
 * `reach`, or `reach`. Counts comparisons down in *left. */
static double gap_of(const Cubes *cubes, const uint32_t *part, uint32_t i, double reach,
                     int64_t *left)
{
    Vec3 at = cubes->point[i].position, cube = cube_of(cubes, at);
    double nearest = reach;
    for (int k = 0; k < 27; k++) {
        Vec3 near = {cube.x + k % 3 - 1, cube.y + k / 3 % 3 - 1, cube.z + k / 9 - 1};
        for (uint32_t j = cubes->head[slot_of(cubes, near)]; j && *left > 0;
             j = cubes->next[j - 1], --*left)
            if (part[j - 1] != part[i])
                nearest = fmin(nearest, vec3_distance(cubes->point[j - 1].position, at));
    }
    return nearest;
}

Status graph_near_ends(const Graph *graph, const uint32_t *part, const double *reach, double most,
                       TreeReading *reading, Err *err)
{
    Cubes cubes;
    int64_t left = 100 * (int64_t)graph->n_points;
    TRY(begin_cubes(&cubes, graph, most, err));
    for (uint32_t i = 0; i < graph->n_points; i++)
        if (part[i])
            keep(&cubes, i);
    for (uint32_t i = 0; i < graph->n_points && left > 0; i++) {
        double gap = reach[i] > 0 ? gap_of(&cubes, part, i, reach[i], &left) : reach[i];
        if (gap < reach[i]) {
            reading->near_ends++;
            reading->near_mm = fmax(reading->near_mm, gap);
        }
    }
    release_cubes(&cubes);
    return STATUS_OK;
}

static Status join_points(const Graph *graph, uint32_t *place, Err *err)
{
    for (size_t k = 0; k < graph->n_joins; k++) {
        GraphJoin join = graph->join[k];
        if (join.a >= graph->n_points || join.b >= graph->n_points)
            return err_set(err, STATUS_INPUT, "%s: a joint names a point that there is not",
                           graph->name);
        uint32_t a = graph_first(place, (uint32_t)join.a), b = graph_first(place, (uint32_t)join.b);
        place[a < b ? b : a] = a < b ? a : b;
    }
    return STATUS_OK;
}

Status graph_merge(const Graph *graph, bool by_place, uint32_t **place, Err *err)
{
    uint32_t *made = NULL;
    Status status = STATUS_OK;
    TRY(mem_calloc(&made, graph->n_points, sizeof *made, "places of points", err));
    for (uint32_t i = 0; i < graph->n_points; i++)
        made[i] = i;
    TRY_GOTO(join_points(graph, made, err));
    for (uint32_t i = 0; i < graph->n_points; i++)
        made[i] = made[made[i]]; /* a chain leads to lower numbers, which are settled */
    if (by_place)
        TRY_GOTO(merge_places(graph, graph->options ? graph->options->merge_tolerance_mm : 0, made,
                              err));
    *place = made;
done:
    if (status != STATUS_OK)
        free(made);
    return status;
}

Status graph_count_merged(const Tree *tree, size_t *n, Err *err)
{
    Graph graph = {.n_points = tree->n};
    uint32_t *place = NULL;
    Status status;
    TRY(mem_calloc(&graph.point, tree->n, sizeof *graph.point, "points", err));
    for (size_t i = 0; i < tree->n; i++)
        graph.point[i].position = tree->position[i];
    TRY_GOTO(graph_merge(&graph, true, &place, err));
    *n = 0;
    for (size_t i = 0; i < tree->n; i++)
        *n += place[i] != i;
done:
    free(place);
    free(graph.point);
    return status;
}
