/* Proves at most points of a mesh that the triangles at the point do not cross, so that such pairs
 * need no test.
 *
 * The triangles at a point are a fan if two conditions hold. Each triangle shares an edge with the
 * next one, all the way round the point. And there is a direction from which all triangles face the
 * viewer and go round the point once. Then they do not overlap in this view, so they do not meet in
 * space. The sum of the normals is tried as the direction. A number counts as positive only if it
 * is far larger than the rounding errors. */
#include "mesh/proof/fans.h"

#include "geom/geom.h"
#include <stdlib.h>

/* MAX_FAN is the capacity of the arrays on the stack. A point with more triangles is not proved;
 * its triangles are tested pair by pair instead. Points of a regular mesh have 6. One thread takes
 * POINTS_PER_UNIT points at a time, which affects time only. */
enum { MAX_FAN = 24, POINTS_PER_UNIT = 4096 };
/* In units of the sum of the magnitudes of the products: a turn's sign counts as certain above
 * this. The rounding errors are below 2^-49 of the sum. */
static const double certain_ratio = 0x1p-40;

typedef struct FanSearch {
    const VesselMesh *mesh;
    IndexLists around; /* per point: its triangles */
    bool *is_fan;
} FanSearch;

/* Lists the points about one in the order of its triangles. Returns their number, or 0 if the
 * triangles do not lead round to the first. */
static int list_ring(const FanSearch *search, uint32_t point, uint32_t ring[MAX_FAN])
{
    uint32_t from[MAX_FAN], to[MAX_FAN];
    const uint32_t *around = &search->around.items[search->around.first[point]];
    int n = (int)indexlists_length(&search->around, point);
    if (n < 3 || n > MAX_FAN)
        return 0;
    for (int i = 0; i < n; i++) {
        const uint32_t *at = search->mesh->triangles[around[i]];
        int own = at[0] == point ? 0 : at[1] == point ? 1 : 2;
        from[i] = at[(own + 1) % 3];
        to[i] = at[(own + 2) % 3];
    }
    uint32_t next = from[0];
    for (int i = 0; i < n; i++) {
        int k = i;
        while (k < n && from[k] != next)
            k++;
        if (k == n)
            return 0;
        ring[i] = next;
        next = to[k];
        from[k] = from[i];
        to[k] = to[i];
    }
    return next == ring[0] ? n : 0;
}

static double magnitude(Vec3 a)
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

/* Returns the sign of the turn from a to b, seen against `view`; 0 if it is not certain. */
static int turn_of(Vec3 view, Vec3 a, Vec3 b)
{
    double turn = vec3_dot(view, vec3_cross(a, b));
    double doubt = certain_ratio * magnitude(view) * magnitude(a) * magnitude(b);
    return (turn > doubt) - (turn < -doubt);
}

/* Returns true if the triangles at a point are proved to be a fan. */
static bool is_fan(const FanSearch *search, uint32_t point)
{
    uint32_t ring[MAX_FAN];
    Vec3 spokes[MAX_FAN], view = vec3(0, 0, 0);
    int n = list_ring(search, point, ring);
    for (int i = 0; i < n; i++)
        spokes[i] = vec3_sub(mesh_point(search->mesh, ring[i]), mesh_point(search->mesh, point));
    for (int i = 0; i < n; i++)
        view = vec3_add(view, vec3_cross(spokes[i], spokes[(i + 1) % n]));
    /* Going round once, the turn from the first spoke is to the left, and then to the right. */
    int before = 1;
    for (int i = 0; i < n; i++) {
        int turn = i == 0 ? 1 : turn_of(view, spokes[0], spokes[i]);
        if (turn_of(view, spokes[i], spokes[(i + 1) % n]) <= 0 || turn == 0 || turn > before)
            return false;
        before = turn;
    }
    return n > 0;
}

static void find_some(size_t unit, int worker, void *context)
{
    (void)worker;
    FanSearch *search = context;
    size_t n = search->mesh->n_points, end = (unit + 1) * POINTS_PER_UNIT;
    for (size_t i = unit * POINTS_PER_UNIT; i < (end < n ? end : n); i++)
        search->is_fan[i] = is_fan(search, (uint32_t)i);
}

Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan_at, Err *err)
{
    FanSearch search = {.mesh = mesh, .is_fan = is_fan_at};
    const ItemKeys corners = {(const uint32_t *)mesh->triangles, mesh->n_triangles, 3};
    size_t units = (mesh->n_points + POINTS_PER_UNIT - 1) / POINTS_PER_UNIT;
    Status status = indexlists_sort(&search.around, mesh->n_points, corners, "points", err);
    if (status == STATUS_OK)
        threads_for(units, threads, find_some, &search);
    indexlists_release(&search.around);
    return status;
}
