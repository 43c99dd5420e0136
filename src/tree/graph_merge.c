/* Merges the points of a network that are one point: points that the file joins, and points at one
 * position.
 *
 * Joined points are merged by union-find; the first member of a set represents the set. Then each
 * other point, in the order of the file, merges with the nearest kept point within the tolerance,
 * or is kept itself. The kept points therefore depend only on the order of the file, and a row of
 * close points does not collapse into one point.
 *
 * Kept points are in a hash table of cubes whose side is the tolerance. All points within reach of
 * a point are in the 27 cubes around it, and few kept points fit into one cube. Without a
 * tolerance, a cube is a single position. */
#include "tree/graph_parts.h"
#include "tree/tree.h"

#include <stdlib.h>

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

/* The kept points, by the cube that each is in. */
typedef struct Cubes {
    const GraphPoint *point;
    double side;    /* of a cube, mm; 0: a cube is a single position */
    KeyMap last;    /* the last point + 1 of each cube, by the cube's key */
    uint32_t *next; /* per point: the next point + 1 with the same key; owned */
} Cubes;

static Vec3 cube_of(const Cubes *cubes, Vec3 at)
{
    Vec3 cube = cubes->side == 0 ? at
                                 : vec3(floor(at.x / cubes->side), floor(at.y / cubes->side),
                                        floor(at.z / cubes->side));
    return vec3(cube.x + 0.0, cube.y + 0.0, cube.z + 0.0); /* no -0 */
}

static uint64_t key_of(Vec3 cube)
{
    return key_of_numbers((const double[]){cube.x, cube.y, cube.z}, 3);
}

/* Returns the last point + 1 that was kept in a cube, or 0. */
static uint32_t last_in(const Cubes *cubes, Vec3 cube)
{
    const uint32_t *last = keymap_find(&cubes->last, key_of(cube));
    return last ? *last : 0;
}

/* Finds the kept point of a cube that is nearest to the position `at`, if its distance is below
 * *nearest, and sets *nearest to its distance. If there is none, returns `found`. On a tie, returns
 * the point that comes first in the file. */
static uint32_t nearest_in(const Cubes *cubes, Vec3 cube, Vec3 at, uint32_t found, double *nearest)
{
    for (uint32_t i = last_in(cubes, cube); i; i = cubes->next[i - 1]) {
        double distance = vec3_distance(cubes->point[i - 1].position, at);
        if (distance < *nearest || (distance == *nearest && i - 1 < found)) {
            *nearest = distance;
            found = i - 1;
        }
    }
    return found;
}

/* Returns the kept point that point `i` merges with; `i` if no kept point is within reach. */
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

static Status keep(Cubes *cubes, uint32_t i, Err *err)
{
    uint32_t *last;
    bool is_new;
    uint64_t key = key_of(cube_of(cubes, cubes->point[i].position));
    TRY(keymap_put(&cubes->last, key, &last, &is_new, err));
    cubes->next[i] = *last;
    *last = i + 1;
    return STATUS_OK;
}

static void release_cubes(Cubes *cubes)
{
    keymap_release(&cubes->last);
    free(cubes->next);
}

/* Begins with empty cubes. The caller releases them, also after an error. */
static Status begin_cubes(Cubes *cubes, const Graph *graph, double side, Err *err)
{
    *cubes = (Cubes){.point = graph->point, .side = side};
    TRY(mem_calloc(&cubes->next, graph->n_points, sizeof *cubes->next, "cubes of points", err));
    return keymap_begin(&cubes->last, graph->n_points, "cubes of points", err);
}

/* Merges points within the tolerance. */
static Status merge_positions(const Graph *graph, double tolerance, uint32_t *representative,
                              Err *err)
{
    Cubes cubes;
    Status status = STATUS_OK;
    TRY_GOTO(begin_cubes(&cubes, graph, tolerance, err));
    for (uint32_t i = 0; i < graph->n_points; i++) {
        representative[i] =
            representative[i] == i ? find_kept(&cubes, i) : representative[representative[i]];
        if (representative[i] == i)
            TRY_GOTO(keep(&cubes, i, err));
    }
done:
    release_cubes(&cubes);
    return status;
}

/* Returns the distance of point `i` to the nearest point of another component that is nearer than
 * `reach`, or `reach`. Counts comparisons down in *left. */
static double gap_of(const Cubes *cubes, const uint32_t *component, uint32_t i, double reach,
                     int64_t *left)
{
    Vec3 at = cubes->point[i].position, cube = cube_of(cubes, at);
    double nearest = reach;
    for (int k = 0; k < 27; k++) {
        Vec3 near = {cube.x + k % 3 - 1, cube.y + k / 3 % 3 - 1, cube.z + k / 9 - 1};
        for (uint32_t j = last_in(cubes, near); j && *left > 0; j = cubes->next[j - 1], --*left)
            if (component[j - 1] != component[i])
                nearest = fmin(nearest, vec3_distance(cubes->point[j - 1].position, at));
    }
    return nearest;
}

Status graph_near_ends(const Graph *graph, const uint32_t *component, const double *reach,
                       double max_reach, TreeReading *reading, Err *err)
{
    Cubes cubes;
    /* Maximum number of comparisons, so that many points in one cube do not take quadratic time.
     * The count of near ends, which is only a hint to the user, is then too low. */
    int64_t left = 100 * (int64_t)graph->n_points;
    Status status = STATUS_OK;
    TRY_GOTO(begin_cubes(&cubes, graph, max_reach, err));
    for (uint32_t i = 0; i < graph->n_points; i++)
        if (component[i])
            TRY_GOTO(keep(&cubes, i, err));
    for (uint32_t i = 0; i < graph->n_points && left > 0; i++) {
        double gap = reach[i] > 0 ? gap_of(&cubes, component, i, reach[i], &left) : reach[i];
        if (gap < reach[i]) {
            reading->network.near_ends++;
            reading->network.near_mm = fmax(reading->network.near_mm, gap);
        }
    }
done:
    release_cubes(&cubes);
    return status;
}

/* Merges the points that the file joins. */
static Status join_points(const Graph *graph, uint32_t *representative, Err *err)
{
    for (size_t k = 0; k < graph->n_joins; k++) {
        GraphJoin join = graph->join[k];
        if (join.a >= graph->n_points || join.b >= graph->n_points)
            return err_set(err, STATUS_INPUT, "%s: a joint refers to a point that does not exist",
                           graph->name);
        sets_join(representative, (uint32_t)join.a, (uint32_t)join.b);
    }
    return STATUS_OK;
}

Status graph_merge(const Graph *graph, bool by_position, uint32_t **representative, Err *err)
{
    uint32_t *made = NULL;
    Status status = STATUS_OK;
    TRY(mem_calloc(&made, graph->n_points, sizeof *made, "merged points", err));
    sets_begin(made, graph->n_points);
    TRY_GOTO(join_points(graph, made, err));
    for (uint32_t i = 0; i < graph->n_points; i++)
        made[i] = made[made[i]]; /* lower numbers already have their final representative */
    if (by_position)
        TRY_GOTO(merge_positions(graph, graph->options ? graph->options->merge_tolerance_mm : 0,
                                 made, err));
    *representative = made;
done:
    if (status != STATUS_OK)
        free(made);
    return status;
}

Status graph_count_merged(const Tree *tree, size_t *n, Err *err)
{
    Graph graph = {.n_points = tree->n};
    uint32_t *representative = NULL;
    Status status;
    TRY(mem_calloc(&graph.point, tree->n, sizeof *graph.point, "points", err));
    for (size_t i = 0; i < tree->n; i++)
        graph.point[i].position = tree->position[i];
    TRY_GOTO(graph_merge(&graph, true, &representative, err));
    *n = 0;
    for (size_t i = 0; i < tree->n; i++)
        *n += representative[i] != i;
    *n -= tree_link_count(tree);
done:
    free(representative);
    free(graph.point);
    return status;
}
