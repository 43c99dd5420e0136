/* Finds the triangles of a mesh that cross each other, exactly.
 *
 * Two triangles cross if an edge of one meets the other. Every decision is the sign of the volume
 * of a tetrahedron of four points. Coordinates are at most 2^25 grid steps, so their differences
 * have 26 bits, and the volume has about 81. In double precision the error of the volume is below
 * 2^-49 of the sum of the magnitudes of its products: differences and products of two
 * are exact, and the fewer than 16 other operations round by 2^-53 each. Only volumes below this
 * bound are computed again, in integers of 128 bits.
 *
 * Most pairs are decided early, because one triangle does not reach through the plane of the other.
 * Nearly all pairs that share a corner are skipped, because the triangles at the corner are proved
 * to form a fan [fans.h]. */
#include "mesh/proof/meshcheck.h"

#include "mesh/proof/boxpairs.h"
#include "mesh/proof/fans.h"
#include <math.h>
#include <stdlib.h>

__extension__ typedef __int128 Wide;

typedef struct CrossSearch {
    const VesselMesh *mesh;
    double per_mm;        /* grid steps per mm */
    bool *is_fan;         /* per point [fans_find] */
    atomic_bool *crossed; /* per triangle; or NULL */
    atomic_size_t n_crossings;
} CrossSearch;

/* Returns the bounding box of a triangle. */
static FloatBox box_of(uint32_t item, const void *context)
{
    const VesselMesh *mesh = ((const CrossSearch *)context)->mesh;
    const float *a = mesh->points[mesh->triangles[item][0]];
    const float *b = mesh->points[mesh->triangles[item][1]];
    const float *c = mesh->points[mesh->triangles[item][2]];
    FloatBox box;
    for (int axis = 0; axis < 3; axis++) {
        float low = a[axis] < b[axis] ? a[axis] : b[axis];
        float high = a[axis] < b[axis] ? b[axis] : a[axis];
        box.low[axis] = low < c[axis] ? low : c[axis];
        box.high[axis] = high > c[axis] ? high : c[axis];
    }
    return box;
}

/* Returns the result of side_of, computed in integers. */
static int exact_side(const CrossSearch *search, const float *const p[4])
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

/* Returns the side of the plane through a, b and c that the point d is on: 0 on the plane, 1 on the
 * side from which a, b and c are clockwise, else -1. */
static int side_of(const CrossSearch *search, const float *a, const float *b, const float *c,
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

/* A triangle, and the plane through it in double precision. */
typedef struct CrossFace {
    const float *at[3];
    double normal[3]; /* not unit */
    double size;      /* bound of the magnitude of the products in `normal` */
} CrossFace;

/* Returns a triangle with its plane. */
static CrossFace face_of(const VesselMesh *mesh, uint32_t triangle)
{
    CrossFace face;
    double e[2][3], sum[2] = {0};
    for (int i = 0; i < 3; i++)
        face.at[i] = mesh->points[mesh->triangles[triangle][i]];
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < 3; axis++) {
            e[i][axis] = (double)face.at[i + 1][axis] - (double)face.at[0][axis];
            sum[i] += fabs(e[i][axis]);
        }
    for (int axis = 0; axis < 3; axis++) {
        int u = (axis + 1) % 3, v = (axis + 2) % 3;
        face.normal[axis] = e[0][u] * e[1][v] - e[0][v] * e[1][u];
    }
    face.size = sum[0] * sum[1];
    return face;
}

/* Returns the side of the face's plane that a point is on: 1 where the normal points, 0 on the
 * plane. */
static int side_of_face(const CrossSearch *search, const CrossFace *face, const float *p)
{
    double height = 0, far = 0;
    for (int axis = 0; axis < 3; axis++) {
        double off = (double)p[axis] - (double)face->at[0][axis];
        height += face->normal[axis] * off;
        far += fabs(off);
    }
    if (fabs(height) > 0x1p-49 * face->size * far)
        return height > 0 ? 1 : -1;
    return -side_of(search, face->at[0], face->at[1], face->at[2], p);
}

/* Returns true if the edge from p to q meets the face. p and q must not lie strictly on one side of
 * the face's plane. */
static bool edge_meets(const CrossSearch *search, const float *p, const float *q,
                       const CrossFace *face)
{
    int one = side_of(search, p, q, face->at[0], face->at[1]);
    int other = side_of(search, p, q, face->at[1], face->at[2]);
    int third = side_of(search, p, q, face->at[2], face->at[0]);
    return (one >= 0 && other >= 0 && third >= 0) || (one <= 0 && other <= 0 && third <= 0);
}

/* Returns the sign of the turn from p via q to r, in the projection along `axis`. The sign is
 * exact: products of differences of 26 bits have 52 bits, and doubles have 53. */
static int turn_of(const float *p, const float *q, const float *r, int axis)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double turn = ((double)q[u] - (double)p[u]) * ((double)r[v] - (double)p[v]) -
                  ((double)q[v] - (double)p[v]) * ((double)r[u] - (double)p[u]);
    return (turn > 0) - (turn < 0);
}

/* Returns true if an edge in the face's plane meets the face: the edge is not all beyond one side
 * of the face, and the face is not all on one side of the edge. */
static bool flat_edge_meets(const float *p, const float *q, const CrossFace *face)
{
    int axis = 0, beside = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(face->normal[i]) > fabs(face->normal[axis]))
            axis = i;
    int around = turn_of(face->at[0], face->at[1], face->at[2], axis);
    for (int i = 0; i < 3; i++) {
        const float *from = face->at[i], *to = face->at[(i + 1) % 3];
        if (turn_of(from, to, p, axis) * around < 0 && turn_of(from, to, q, axis) * around < 0)
            return false;
        beside += turn_of(p, q, from, axis);
    }
    return abs(beside) < 3;
}

/* Finds the sides of a face's plane that the corners of another triangle are on. `shared` is the
 * corner that both have, or -1. Returns false if all other corners are on one side: then the
 * triangles do not meet. */
static bool find_sides(const CrossSearch *search, const float *const corners[3],
                       const CrossFace *face, int shared, int sides[3])
{
    int sum = 0;
    for (int i = 0; i < 3; i++) {
        sides[i] = i == shared ? 0 : side_of_face(search, face, corners[i]);
        sum += sides[i];
    }
    return abs(sum) < (shared < 0 ? 3 : 2);
}

/* Returns true if an edge of `a` meets `b`. side[] has the sides of the corners of `a`; `shared` is
 * the corner that both have, or -1. */
static bool an_edge_meets(const CrossSearch *search, const CrossFace *a, const CrossFace *b,
                          const int side[3], int shared)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if (i == shared || j == shared || side[i] * side[j] > 0)
            continue;
        if (side[i] == 0 && side[j] == 0 ? flat_edge_meets(a->at[i], a->at[j], b)
                                         : edge_meets(search, a->at[i], a->at[j], b))
            return true;
    }
    return false;
}

/* Returns true if two triangles with a common edge cross. They do only if one is folded flat onto
 * the other: they are in one plane and on the same side of the edge, so their normals are opposite.
 * `lone` is the corner of `b` that is not on the edge. */
static bool is_folded_flat(const CrossSearch *search, const CrossFace *a, const CrossFace *b,
                           int lone)
{
    double dot = 0;
    for (int axis = 0; axis < 3; axis++)
        dot += a->normal[axis] * b->normal[axis];
    return dot <= 0 && side_of_face(search, a, b->at[lone]) == 0;
}

/* Returns true if two triangles that share at most one corner meet elsewhere. shared[] is that
 * corner in each of them, or -1. */
static bool faces_meet(const CrossSearch *search, uint32_t first, uint32_t second,
                       const int shared[2])
{
    int of_a[3], of_b[3];
    CrossFace b = face_of(search->mesh, second);
    const float *a_at[3];
    for (int i = 0; i < 3; i++)
        a_at[i] = search->mesh->points[search->mesh->triangles[first][i]];
    if (!find_sides(search, a_at, &b, shared[0], of_a))
        return false;
    CrossFace a = face_of(search->mesh, first);
    return find_sides(search, b.at, &a, shared[1], of_b) &&
           (an_edge_meets(search, &a, &b, of_a, shared[0]) ||
            an_edge_meets(search, &b, &a, of_b, shared[1]));
}

/* Tests two triangles whose boxes meet. Counts and marks them if they cross. */
static void test_pair(uint32_t first, uint32_t second, int worker, void *context)
{
    (void)worker;
    CrossSearch *search = context;
    const uint32_t *one = search->mesh->triangles[first], *other = search->mesh->triangles[second];
    int shared[2] = {-1, -1}, n_shared = 0, lone = 3;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (one[i] == other[j]) {
                if (search->is_fan[one[i]])
                    return;
                shared[0] = i;
                shared[1] = j;
                lone -= j; /* the indices sum to 3: what remains is the corner that is not shared */
                n_shared++;
            }
    bool cross = n_shared == 3;
    if (n_shared < 2)
        cross = faces_meet(search, first, second, shared);
    else if (n_shared == 2) {
        CrossFace a = face_of(search->mesh, first), b = face_of(search->mesh, second);
        cross = is_folded_flat(search, &a, &b, lone);
    }
    if (!cross)
        return;
    atomic_fetch_add_explicit(&search->n_crossings, 1, memory_order_relaxed);
    if (search->crossed) {
        atomic_store_explicit(&search->crossed[first], true, memory_order_relaxed);
        atomic_store_explicit(&search->crossed[second], true, memory_order_relaxed);
    }
}

Status meshcheck_crossings(const VesselMesh *mesh, double grid_mm, int threads,
                           atomic_bool *crossed, size_t *crossings, Err *err)
{
    CrossSearch search = {.mesh = mesh, .per_mm = 1 / grid_mm, .crossed = crossed};
    const BoxPairs pairs = {(uint32_t)mesh->n_triangles, box_of, test_pair, &search, threads};
    Status status;
    *crossings = 0;
    TRY_GOTO(mem_calloc(&search.is_fan, mesh->n_points, sizeof *search.is_fan, "points", err));
    TRY_GOTO(fans_find(mesh, threads, search.is_fan, err));
    TRY_GOTO(boxpairs_find(&pairs, err));
    *crossings = search.n_crossings;
done:
    free(search.is_fan);
    return status;
}
