/* Two triangles cross when an edge of one meets the other. All is decided by the sign of the volume
 * of four points. Coordinates are whole multiples of a grid, so that their differences have 26 bits
 * and the volume fits into 128; in double precision its error is below 2^-49 of the sum of the
 * magnitudes of its products, and only closer to zero the whole numbers are asked. */
#include "surface/mesh/meshcheck.h"

#include "surface/mesh/boxpairs.h"
#include <math.h>

__extension__ typedef __int128 Wide;

enum { MAX_WORKERS = 256 };

typedef struct Search {
    const VesselMesh *mesh;
    double per_mm;              /* units of the grid */
    size_t counts[MAX_WORKERS]; /* of crossings, one a thread */
} Search;

static FloatBox box_of(uint32_t item, const void *context)
{
    const VesselMesh *mesh = ((const Search *)context)->mesh;
    const float *a = mesh->points[mesh->triangles[item][0]];
    const float *b = mesh->points[mesh->triangles[item][1]];
    const float *c = mesh->points[mesh->triangles[item][2]];
    FloatBox box;
    for (int axis = 0; axis < 3; axis++) {
        box.low[axis] = fminf(a[axis], fminf(b[axis], c[axis]));
        box.high[axis] = fmaxf(a[axis], fmaxf(b[axis], c[axis]));
    }
    return box;
}

static int exact_side(const Search *search, const float *const p[4])
{
    int64_t d[3][3];
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            d[i][axis] = (int64_t)((double)p[i][axis] * search->per_mm) -
                         (int64_t)((double)p[3][axis] * search->per_mm);
    Wide sum = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t *a = d[i], *b = d[(i + 1) % 3], *c = d[(i + 2) % 3];
        sum += (Wide)a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return (sum > 0) - (sum < 0);
}

/* On which side of the plane through a, b and c the point d lies: 0 on it. */
static int side_of(const Search *search, const float *a, const float *b, const float *c,
                   const float *d)
{
    const float *const p[4] = {a, b, c, d};
    double e[3][3];
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            e[i][axis] = (double)p[i][axis] - (double)d[axis];
    double sum = 0, magnitude = 0;
    for (int i = 0; i < 3; i++) {
        const double *u = e[i], *v = e[(i + 1) % 3], *w = e[(i + 2) % 3];
        double one = v[0] * w[1], other = v[1] * w[0];
        sum += u[2] * (one - other);
        magnitude += fabs(u[2]) * (fabs(one) + fabs(other));
    }
    if (fabs(sum) > 0x1p-49 * magnitude)
        return sum > 0 ? 1 : -1;
    return exact_side(search, p);
}

/* Whether the edge from p to q, whose ends lie on sides p_side and q_side of the triangle's plane,
 * meets the triangle. */
static bool edge_meets(const Search *search, const float *p, const float *q, int p_side, int q_side,
                       const float *const t[3])
{
    if (p_side * q_side > 0)
        return false;
    int one = side_of(search, p, q, t[0], t[1]), other = side_of(search, p, q, t[1], t[2]);
    int third = side_of(search, p, q, t[2], t[0]);
    return (one >= 0 && other >= 0 && third >= 0) || (one <= 0 && other <= 0 && third <= 0);
}

/* Whether an edge of `a` meets `b`; `shared` is their common corner, `a` first, or -1. */
static bool an_edge_meets(const Search *search, const float *const a[3], const float *const b[3],
                          int shared)
{
    int side[3];
    for (int i = 0; i < 3; i++)
        side[i] = i == shared ? 0 : side_of(search, b[0], b[1], b[2], a[i]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if (i == shared || j == shared)
            continue;
        if (edge_meets(search, a[i], a[j], side[i], side[j], b))
            return true;
    }
    return false;
}

/* Triangles with a common edge cross when they lie in one plane on the same side of it. */
static bool folds(const Search *search, const float *const a[3], const float *const b[3],
                  const int places[2][2])
{
    const float *one = a[3 - places[0][0] - places[1][0]],
                *other = b[3 - places[0][1] - places[1][1]];
    const float *p = a[places[0][0]], *q = a[places[1][0]];
    if (side_of(search, p, q, one, other) != 0)
        return false;
    double dot = 0;
    Vec3 u =
        vec3((double)q[0] - (double)p[0], (double)q[1] - (double)p[1], (double)q[2] - (double)p[2]);
    Vec3 v = vec3((double)one[0] - (double)p[0], (double)one[1] - (double)p[1],
                  (double)one[2] - (double)p[2]);
    Vec3 w = vec3((double)other[0] - (double)p[0], (double)other[1] - (double)p[1],
                  (double)other[2] - (double)p[2]);
    dot = vec3_dot(vec3_cross(u, v), vec3_cross(u, w));
    return dot >= 0;
}

static void test_pair(uint32_t first, uint32_t second, int worker, void *context)
{
    Search *search = context;
    const VesselMesh *mesh = search->mesh;
    const uint32_t *one = mesh->triangles[first], *other = mesh->triangles[second];
    const float *a[3], *b[3];
    int places[3][2], n_shared = 0;
    for (int i = 0; i < 3; i++) {
        a[i] = mesh->points[one[i]];
        b[i] = mesh->points[other[i]];
        for (int j = 0; j < 3; j++)
            if (one[i] == other[j] && n_shared < 3) {
                places[n_shared][0] = i;
                places[n_shared++][1] = j;
            }
    }
    bool cross;
    if (n_shared >= 2)
        cross = n_shared == 3 || folds(search, a, b, (const int(*)[2])places);
    else
        cross = an_edge_meets(search, a, b, n_shared ? places[0][0] : -1) ||
                an_edge_meets(search, b, a, n_shared ? places[0][1] : -1);
    search->counts[worker] += cross;
}

Status meshcheck_crossings(const VesselMesh *mesh, double grid_mm, int threads, size_t *crossings,
                           Err *err)
{
    Search search = {.mesh = mesh, .per_mm = 1 / grid_mm};
    const BoxPairs pairs = {(uint32_t)mesh->n_triangles, box_of, test_pair, &search, threads};
    TRY(boxpairs_find(&pairs, err));
    *crossings = 0;
    for (int i = 0; i < MAX_WORKERS; i++)
        *crossings += search.counts[i];
    return STATUS_OK;
}
