/* Builds layers of prisms along the inside of a vessel wall.
 *
 * Each point of the wall moves inwards along one straight line. The direction of this line makes
 * the largest angle to the normals of the point's triangles as small as possible. If this angle is
 * below 90 degrees at the three corners of a triangle, the triangle's prism is sound as soon as it
 * is thin enough. So one remedy suffices: bad layers become thinner, in rounds, until none is bad.
 *
 * No test of pairs of prisms is needed to prove that prisms do not overlap. The layers map wall x
 * [0, 1] into space. If all Jacobians are positive, the number of times that a point of space is
 * covered is the winding number of the outer surface about the point minus that of the inner one.
 * Both surfaces are free of crossings, so each winding number is 0 or 1. Hence no point is covered
 * twice. */
#include "mesh/sweep.h"

#include "mesh/precision.h"
#include "mesh/proof/meshcheck.h"
#include <stdlib.h>

/* Maximum slope of the inner surface against the wall: the thickness of the layers grows by at most
 * this fraction of the distance along the wall. With 0.5 (27 degrees), prisms stay well shaped. A
 * larger slope keeps more layers at full thickness, but inverts more prisms. */
#define MAX_SLOPE 0.5
/* Minimum area of the inner face of a sound prism, or of a stack of prisms, divided by the area of
 * its outer face. Prisms that narrow more are valid elements but useless for solvers. */
#define MIN_FACE_RATIO 0.1
/* Maximum number of rounds, in each of which bad layers become half as thick. After 12 rounds they
 * are 4000 times thinner than requested. A layer that is still bad then has no sound direction. */
enum { MAX_ROUNDS = 12 };
/* Steps of the search for a direction. Its error falls as 1 / steps, so it is about 1 %; a
 * direction need not be exact. */
enum { DIRECTION_STEPS = 100 };

typedef struct Sweep {
    const VesselMesh *mesh;
    const VesselTree *tree;
    double grid_mm;
    double part[LAYERS_MAX + 1]; /* per surface: its depth, in parts of the last one's depth */
    IndexLists fans;             /* per point: the triangles of the wall at it */
    Vec3 *normals;               /* per triangle: unit, outwards */
    /* The next four are per point of the mesh. Points that are not on the wall have no values. */
    Vec3 *inwards;     /* unit */
    double *requested; /* thickness of all layers that params->thickness requests, mm */
    double *depth;     /* thickness of all layers, mm */
    bool *is_bad;      /* the layers must be thinner here */
    VesselMesh inner;  /* the last surface; borrows triangles and labels */
    atomic_bool *crossed;
    PrismLayers layers;
} Sweep;

void prismlayers_release(PrismLayers *layers)
{
    free(layers->points);
    free(layers->wall_index);
    free(layers->tree_of_segment);
    *layers = (PrismLayers){0};
}

static void sweep_release(Sweep *sweep)
{
    indexlists_release(&sweep->fans);
    free(sweep->normals);
    free(sweep->inwards);
    free(sweep->requested);
    free(sweep->depth);
    free(sweep->is_bad);
    free(sweep->crossed);
    free(sweep->inner.points);
    prismlayers_release(&sweep->layers);
}

/* ---- directions ------------------------------------------------------------------------------ */

/* Lists, per point, the triangles of the wall at it. */
static Status list_fans(Sweep *sweep, Err *err)
{
    const VesselMesh *mesh = sweep->mesh;
    TRY(indexlists_begin(&sweep->fans, mesh->n_points, "points", err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int k = 0; k < 3 && !mesh_is_cap(mesh, i); k++)
            indexlists_count(&sweep->fans, mesh->triangles[i][k]);
    TRY(indexlists_allot(&sweep->fans, "points", err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int k = 0; k < 3 && !mesh_is_cap(mesh, i); k++)
            indexlists_put(&sweep->fans, mesh->triangles[i][k], (uint32_t)i);
    return STATUS_OK;
}

/* Returns the direction whose largest angle to the normals of a point's triangles is smallest,
 * reversed: the centre of the smallest ball about the normals [Badoiu, Clarkson, Optimal core-sets
 * for balls, 2008]. */
static Vec3 find_direction(const Sweep *sweep, uint32_t point)
{
    const uint32_t first = sweep->fans.first[point], last = sweep->fans.first[point + 1];
    Vec3 center = sweep->normals[sweep->fans.items[first]];
    for (int step = 2; step < DIRECTION_STEPS; step++) {
        Vec3 farthest = center;
        double most = -1;
        for (uint32_t i = first; i < last; i++) {
            Vec3 normal = sweep->normals[sweep->fans.items[i]];
            double distance = vec3_distance(normal, center);
            if (distance > most) {
                most = distance;
                farthest = normal;
            }
        }
        center = vec3_add_scaled(center, vec3_sub(farthest, center), 1.0 / step);
    }
    return vec3_scale(vec3_normalized(center), -1);
}

/* Turns the directions of a flat end's rim into the plane of the end. */
static void flatten_rim(Sweep *sweep, size_t cap)
{
    const FieldSegment *segment = &sweep->tree->segments[mesh_segment(sweep->mesh, cap)];
    const Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    for (int k = 0; k < 3; k++) {
        Vec3 *inwards = &sweep->inwards[sweep->mesh->triangles[cap][k]];
        *inwards = vec3_normalized(vec3_add_scaled(*inwards, axis, -vec3_dot(*inwards, axis)));
    }
}

/* Computes the normals of the triangles, and the direction in which each point of the wall moves.
 */
static void find_directions(Sweep *sweep)
{
    const VesselMesh *mesh = sweep->mesh;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *corners = mesh->triangles[i];
        Vec3 a = mesh_point(mesh, corners[0]);
        sweep->normals[i] = vec3_normalized(vec3_cross(vec3_sub(mesh_point(mesh, corners[1]), a),
                                                       vec3_sub(mesh_point(mesh, corners[2]), a)));
    }
    for (uint32_t i = 0; i < mesh->n_points; i++)
        if (sweep->layers.wall_index[i] != NOT_ON_WALL)
            sweep->inwards[i] = find_direction(sweep, i);
    for (size_t i = 0; i < mesh->n_triangles; i++)
        if (mesh_is_cap(mesh, i))
            flatten_rim(sweep, i);
}

/* ---- thickness ------------------------------------------------------------------------------- */

/* Makes layers thinner that would grow faster than MAX_SLOPE. */
static void limit_growth(Sweep *sweep)
{
    const VesselMesh *mesh = sweep->mesh;
    double *depth = sweep->depth;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < mesh->n_triangles; i++)
            for (int k = 0; k < 6 && !mesh_is_cap(mesh, i); k++) {
                uint32_t from = mesh->triangles[i][k % 3];
                uint32_t to = mesh->triangles[i][(k + 1 + k / 3) % 3];
                if (depth[to] <= depth[from])
                    continue;
                double most = depth[from] + MAX_SLOPE * vec3_distance(mesh_point(mesh, from),
                                                                      mesh_point(mesh, to));
                changed = changed || depth[to] > most;
                depth[to] = fmin(depth[to], most);
            }
    }
}

/* Sets the requested thickness. A point between segments gets the thickness of the thinnest one. */
static void set_requested_depths(Sweep *sweep, double thickness)
{
    const VesselMesh *mesh = sweep->mesh;
    for (size_t i = 0; i < mesh->n_points; i++)
        sweep->requested[i] = INFINITY;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int k = 0; k < 3 && !mesh_is_cap(mesh, i); k++) {
            double *requested = &sweep->requested[mesh->triangles[i][k]];
            *requested = fmin(*requested,
                              thickness * sweep->tree->segments[mesh_segment(mesh, i)].radius_mm);
        }
    for (size_t i = 0; i < mesh->n_points; i++)
        sweep->depth[i] = sweep->requested[i];
    limit_growth(sweep);
}

/* Halves the thickness at bad points. */
static void thin_bad_layers(Sweep *sweep)
{
    for (size_t i = 0; i < sweep->mesh->n_points; i++) {
        sweep->depth[i] *= sweep->is_bad[i] ? 0.5 : 1;
        sweep->is_bad[i] = false;
    }
    limit_growth(sweep);
}

/* ---- prisms ---------------------------------------------------------------------------------- */

/* Sets the points of all surfaces, rounded to the grid of the written mesh. */
static void place_points(Sweep *sweep)
{
    PrismLayers *layers = &sweep->layers;
    for (uint32_t i = 0; i < layers->n_mesh_points; i++)
        for (size_t surface = 0; surface <= layers->n_layers; surface++) {
            Vec3 from = mesh_point(sweep->mesh, i);
            float *to = layers->points[prismlayers_point(layers, i, surface)];
            if (surface > 0 && layers->wall_index[i] != NOT_ON_WALL)
                from = vec3_add_scaled(from, sweep->inwards[i],
                                       sweep->depth[i] * sweep->part[surface]);
            for (int axis = 0; axis < 3; axis++)
                sweep->inner.points[i][axis] = to[axis] =
                    mesh_round_to_grid(vec3_component(from, axis), sweep->grid_mm);
        }
}

/* Returns true if the Jacobian of the prism between two surfaces is positive everywhere, by more
 * than the rounding of this function. It is a mean of its values at the three edges from surface to
 * surface, weighted by the position along the triangle; along such an edge it is a quadratic
 * Bernstein polynomial with the coefficients at_outer, between and at_inner. */
static bool is_sound(const Sweep *sweep, size_t triangle, size_t outer, size_t inner)
{
    const PrismLayers *layers = &sweep->layers;
    Vec3 p[2][3], rise[3];
    for (int k = 0; k < 3; k++) {
        for (int side = 0; side < 2; side++) {
            const float *x = layers->points[prismlayers_point(
                layers, sweep->mesh->triangles[triangle][k], side ? inner : outer)];
            p[side][k] = vec3((double)x[0], (double)x[1], (double)x[2]);
        }
        rise[k] = vec3_sub(p[0][k], p[1][k]);
    }
    Vec3 a1 = vec3_sub(p[0][1], p[0][0]), a2 = vec3_sub(p[0][2], p[0][0]);
    Vec3 b1 = vec3_sub(p[1][1], p[1][0]), b2 = vec3_sub(p[1][2], p[1][0]);
    Vec3 twice_between = vec3_add(vec3_cross(a1, b2), vec3_cross(b1, a2));
    for (int k = 0; k < 3; k++) {
        double at_outer = vec3_dot(rise[k], vec3_cross(a1, a2));
        double at_inner = vec3_dot(rise[k], vec3_cross(b1, b2));
        double noise = 1e-14 * vec3_length(rise[k]) * vec3_length(a1) * vec3_length(a2);
        if (!(at_outer > noise && at_inner >= MIN_FACE_RATIO * at_outer &&
              vec3_dot(rise[k], twice_between) >= 0))
            return false;
    }
    return true;
}

static void mark_bad(Sweep *sweep, size_t triangle)
{
    for (int k = 0; k < 3; k++)
        sweep->is_bad[sweep->mesh->triangles[triangle][k]] = true;
}

/* Marks the points of stacks of prisms that are not sound. Returns their number; `found` receives
 * the triangle of one. */
static size_t find_bad_prisms(Sweep *sweep, size_t *found)
{
    const size_t n = sweep->layers.n_layers;
    size_t bad = 0;
    for (size_t i = 0; i < sweep->mesh->n_triangles; i++) {
        if (mesh_is_cap(sweep->mesh, i))
            continue;
        bool sound = is_sound(sweep, i, 0, n);
        for (size_t layer = 0; layer < n && sound; layer++)
            sound = is_sound(sweep, i, layer, layer + 1);
        if (sound)
            continue;
        mark_bad(sweep, i);
        *found = i;
        bad++;
    }
    return bad;
}

/* Marks the points at which the inner surface crosses itself. */
static Status find_crossings(Sweep *sweep, int threads, size_t *crossings, size_t *found, Err *err)
{
    const size_t n = sweep->mesh->n_triangles;
    for (size_t i = 0; i < n; i++)
        sweep->crossed[i] = false;
    TRY(meshcheck_crossings(&sweep->inner, sweep->grid_mm, threads, sweep->crossed, crossings,
                            err));
    for (size_t i = 0; i < n; i++)
        if (sweep->crossed[i]) {
            mark_bad(sweep, i);
            *found = i;
        }
    return STATUS_OK;
}

/* Makes bad layers thinner until none is bad, or until the last round. */
static Status make_sound(Sweep *sweep, int threads, Err *err)
{
    for (int attempt = 0;; attempt++) {
        size_t crossings = 0, found = 0;
        place_points(sweep);
        size_t bad = find_bad_prisms(sweep, &found);
        if (bad == 0)
            TRY(find_crossings(sweep, threads, &crossings, &found, err));
        if (bad + crossings == 0)
            return STATUS_OK;
        if (attempt == MAX_ROUNDS)
            return err_set(err, STATUS_INFEASIBLE,
                           "the layers have %zu inverted prisms and %zu crossings, for example at "
                           "segment %u; no file was written (a smaller `tolerance` or a thinner "
                           "`thickness` may help)",
                           bad, crossings, sweep->tree->ids[mesh_segment(sweep->mesh, found)]);
        thin_bad_layers(sweep);
    }
}

/* ---- together -------------------------------------------------------------------------------- */

/* Numbers the trees and the points of the wall, and allocates all arrays. */
static Status prepare(Sweep *sweep, Err *err)
{
    const VesselMesh *mesh = sweep->mesh;
    const size_t n = mesh->n_points;
    PrismLayers *layers = &sweep->layers;
    TRY(list_fans(sweep, err));
    TRY(meshcheck_trees(sweep->tree, &layers->tree_of_segment, &layers->n_trees, err));
    TRY(mem_alloc(&layers->wall_index, n, sizeof *layers->wall_index, "points", err));
    for (size_t i = 0; i < n; i++)
        layers->wall_index[i] = indexlists_length(&sweep->fans, i) > 0
                                    ? (uint32_t)layers->n_wall_points++
                                    : NOT_ON_WALL;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        layers->n_prisms += mesh_is_cap(mesh, i) ? 0 : layers->n_layers;
    layers->n_mesh_points = n;
    layers->n_points = n + layers->n_layers * layers->n_wall_points;
    if (mesh->n_triangles * (layers->n_layers + 2) > INT32_MAX / 6)
        return err_set(err, STATUS_INFEASIBLE,
                       "%zu prisms are too many for the file's numbers of 31 bits; raise "
                       "`tolerance`",
                       layers->n_prisms);
    TRY(mem_alloc(&layers->points, layers->n_points, sizeof *layers->points, "points", err));
    TRY(mem_alloc(&sweep->inner.points, n, sizeof *sweep->inner.points, "points", err));
    TRY(mem_alloc(&sweep->normals, mesh->n_triangles, sizeof *sweep->normals, "triangles", err));
    TRY(mem_alloc(&sweep->crossed, mesh->n_triangles, sizeof *sweep->crossed, "triangles", err));
    TRY(mem_calloc(&sweep->inwards, n, sizeof *sweep->inwards, "points", err));
    TRY(mem_alloc(&sweep->requested, n, sizeof *sweep->requested, "points", err));
    TRY(mem_alloc(&sweep->depth, n, sizeof *sweep->depth, "points", err));
    return mem_calloc(&sweep->is_bad, n, sizeof *sweep->is_bad, "points", err);
}

/* Sets the depths of the surfaces as fractions of the depth of the innermost one. Each layer is
 * `growth` times as thick as the layer outside it. */
static void divide_depth(Sweep *sweep, double growth)
{
    const size_t n = sweep->layers.n_layers;
    double layer = 1;
    for (size_t i = 1; i <= n; i++, layer *= growth)
        sweep->part[i] = sweep->part[i - 1] + layer;
    for (size_t i = 1; i < n; i++)
        sweep->part[i] /= sweep->part[n];
    sweep->part[n] = 1;
}

/* Fills the facts about the layers. */
static void measure_layers(Sweep *sweep)
{
    PrismLayers *layers = &sweep->layers;
    double sum = 0;
    layers->min_ratio = 1;
    for (size_t i = 0; i < layers->n_mesh_points; i++) {
        if (layers->wall_index[i] == NOT_ON_WALL)
            continue;
        double part = sweep->depth[i] / sweep->requested[i];
        layers->n_thinner += part < 1;
        layers->min_ratio = fmin(layers->min_ratio, part);
        sum += part;
    }
    layers->mean_ratio = sum / (double)layers->n_wall_points;
    layers->core_volume_mm3 = vesselmesh_volume(&sweep->inner);
    layers->volume_mm3 = vesselmesh_volume(sweep->mesh) - layers->core_volume_mm3;
}

Status prismlayers_sweep(const VesselMesh *mesh, const VesselTree *tree, const LayerParams *params,
                         int threads, PrismLayers *out, Err *err)
{
    Sweep sweep = {.mesh = mesh,
                   .tree = tree,
                   .grid_mm = mesh_grid(mesh_max_coordinate(tree)),
                   .inner = *mesh,
                   .layers.n_layers = (size_t)params->n_layers};
    Status status;
    sweep.inner.points = NULL;
    TRY_GOTO(prepare(&sweep, err));
    divide_depth(&sweep, params->growth);
    find_directions(&sweep);
    set_requested_depths(&sweep, params->thickness);
    TRY_GOTO(make_sound(&sweep, threads, err));
    measure_layers(&sweep);
    *out = sweep.layers;
    sweep.layers = (PrismLayers){0};
done:
    sweep_release(&sweep);
    return status;
}
