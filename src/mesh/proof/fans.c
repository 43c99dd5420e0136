/* The triangles at a point are a fan if they follow each other round it, each sharing an edge with
 * the next, and if, seen along some direction, all face the viewer and go round the point once:
 * then they lie side by side in that view, and so they do in space. The direction is the sum of
 * their normals. What is to be above zero must be so by far more than rounding. */
#include "mesh/proof/fans.h"

#include "geom/geom.h"
#include <stdlib.h>

enum { MOST_TRIANGLES = 24, POINTS_A_UNIT = 4096 };
/* Rounding is below 2^-49 of the sum of the magnitudes of the products. */
static const double surely = 0x1p-40;

typedef struct FanSearch {
    const VesselMesh *mesh;
    uint32_t *first, *around; /* of each point: its triangles, around[first[i] .. first[i + 1]) */
    bool *is_fan;
} FanSearch;

static Status list_triangles(FanSearch *search, Err *err)
{
    const VesselMesh *mesh = search->mesh;
    size_t n_corners = 3 * mesh->n_triangles;
    TRY(mem_calloc(&search->first, mesh->n_points + 2, sizeof *search->first, "points", err));
    TRY(mem_calloc(&search->around, n_corners, sizeof *search->around, "points", err));
    for (size_t i = 0; i < n_corners; i++)
        search->first[mesh->triangles[i / 3][i % 3] + 2]++;
    for (size_t i = 2; i < mesh->n_points + 2; i++)
        search->first[i] += search->first[i - 1];
    for (size_t i = 0; i < n_corners; i++)
        search->around[search->first[mesh->triangles[i / 3][i % 3] + 1]++] = (uint32_t)(i / 3);
    return STATUS_OK;
}

/* Lists the points about one in the order in which its triangles follow each other; 0 when they do
 * not come back to the first. */
static int list_ring(const FanSearch *search, uint32_t point, uint32_t ring[MOST_TRIANGLES])
{
    uint32_t from[MOST_TRIANGLES], to[MOST_TRIANGLES];
    int n = (int)(search->first[point + 1] - search->first[point]);
    if (n < 3 || n > MOST_TRIANGLES)
        return 0;
    for (int i = 0; i < n; i++) {
        const uint32_t *at = search->mesh->triangles[search->around[search->first[point] + i]];
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

/* The sign of the turn from a to b, seen from where `view` points: 0 when it is not sure. */
static int turn_of(Vec3 view, Vec3 a, Vec3 b)
{
    double turn = vec3_dot(view, vec3_cross(a, b));
    double doubt = surely * magnitude(view) * magnitude(a) * magnitude(b);
    return (turn > doubt) - (turn < -doubt);
}

static bool is_fan(const FanSearch *search, uint32_t point)
{
    uint32_t ring[MOST_TRIANGLES];
    Vec3 spokes[MOST_TRIANGLES], view = vec3(0, 0, 0);
    int n = list_ring(search, point, ring);
    const float *center = search->mesh->points[point];
    for (int i = 0; i < n; i++) {
        const float *x = search->mesh->points[ring[i]];
        spokes[i] = vec3((double)x[0] - (double)center[0], (double)x[1] - (double)center[1],
                         (double)x[2] - (double)center[2]);
    }
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
    size_t n = search->mesh->n_points, end = (unit + 1) * POINTS_A_UNIT;
    for (size_t i = unit * POINTS_A_UNIT; i < (end < n ? end : n); i++)
        search->is_fan[i] = is_fan(search, (uint32_t)i);
}

Status fans_find(const VesselMesh *mesh, int threads, bool *is_fan_at, Err *err)
{
    FanSearch search = {.mesh = mesh, .is_fan = is_fan_at};
    Status status;
    TRY_GOTO(list_triangles(&search, err));
    threads_for((mesh->n_points + POINTS_A_UNIT - 1) / POINTS_A_UNIT, threads, find_some, &search);
done:
    free(search.first);
    free(search.around);
    return status;
}
