/* Triangulates a flat face of a casing, with holes, by ear clipping [Eberly, Triangulation by Ear
 * Clipping].
 *
 * First, a bridge joins each hole to the outer loop. The loop then follows the bridge to the hole,
 * goes around the hole, and follows the bridge back. The bridge leads from the hole's point that is
 * farthest along the first axis to the nearest corner that is visible from this point. Holes that
 * are farther along the first axis come first, so that such a corner always exists.
 *
 * Then ears are cut off the loop: convex corners whose triangle contains no other corner.
 * Coordinates are integer multiples of a grid, and their differences have 26 bits, so the sign of
 * every turn is exact. */
#include "print/casing.h"

#include <stdlib.h>

typedef struct FaceCorner {
    uint32_t point;        /* index of the point in the solid */
    uint32_t next, before; /* indices of the neighbours in the loop */
} FaceCorner;

typedef struct FaceWork {
    const VesselMesh *mesh;
    int u, v; /* axes */
    FaceCorner *corners;
    uint32_t n;
    FaceLoop *holes; /* farthest first */
    size_t n_holes;
} FaceWork;

/* Returns the coordinate of a point along the first (0) or second (1) axis of the face. */
static double across(const FaceWork *work, uint32_t point, int axis)
{
    return (double)work->mesh->points[point][axis ? work->v : work->u];
}

/* Returns a number above 0 if the path from a over b to c turns left. */
static double turn(const FaceWork *work, uint32_t a, uint32_t b, uint32_t c)
{
    double x = across(work, b, 0) - across(work, a, 0), y = across(work, b, 1) - across(work, a, 1);
    return x * (across(work, c, 1) - across(work, a, 1)) -
           y * (across(work, c, 0) - across(work, a, 0));
}

/* Returns true if the point p, which is on the line through a and b, is between a and b. */
static bool is_between(const FaceWork *work, uint32_t a, uint32_t b, uint32_t p)
{
    double along = 0, whole = 0;
    for (int axis = 0; axis < 2; axis++) {
        double d = across(work, b, axis) - across(work, a, axis);
        along += d * (across(work, p, axis) - across(work, a, axis));
        whole += d * d;
    }
    return along >= 0 && along <= whole;
}

/* Returns true if the point p is on the edge from a to b, but is none of its ends. */
static bool lies_on(const FaceWork *work, uint32_t a, uint32_t b, uint32_t p)
{
    return p != a && p != b && turn(work, a, b, p) == 0 && is_between(work, a, b, p);
}

/* Returns true if the edge from a to b prevents the bridge between the points `from` and `to`: the
 * edge meets the bridge elsewhere than in a common end point. */
static bool blocks(const FaceWork *work, uint32_t a, uint32_t b, uint32_t from, uint32_t to)
{
    if (lies_on(work, from, to, a) || lies_on(work, from, to, b) || lies_on(work, a, b, from) ||
        lies_on(work, a, b, to))
        return true;
    if (a == from || a == to || b == from || b == to)
        return false;
    return turn(work, a, b, from) * turn(work, a, b, to) < 0 &&
           turn(work, from, to, a) * turn(work, from, to, b) < 0;
}

/* Returns true if the direction from the corner to the point is within the interior angle of the
 * corner. */
static bool opens_to(const FaceWork *work, const FaceCorner *corner, uint32_t point)
{
    uint32_t before = work->corners[corner->before].point, next = work->corners[corner->next].point;
    bool one = turn(work, before, corner->point, point) > 0;
    bool other = turn(work, corner->point, next, point) > 0;
    return turn(work, before, corner->point, next) > 0 ? one && other : one || other;
}

/* Returns true if no edge of the loop, and none of the holes that are not joined yet, blocks the
 * bridge from the corner to the point. */
static bool is_visible(const FaceWork *work, size_t first_hole, const FaceCorner *corner,
                       uint32_t point)
{
    if (!opens_to(work, corner, point))
        return false;
    for (uint32_t i = 0; i < work->n; i++)
        if (blocks(work, work->corners[i].point, work->corners[work->corners[i].next].point, point,
                   corner->point))
            return false;
    for (size_t h = first_hole; h < work->n_holes; h++)
        for (uint32_t i = 0; i < work->holes[h].n; i++) {
            const FaceLoop *hole = &work->holes[h];
            if (blocks(work, hole->points[i], hole->points[(i + 1) % hole->n], point,
                       corner->point))
                return false;
        }
    return true;
}

/* Returns the nearest corner that is visible from a point of a hole; on a tie, the one with the
 * lowest index. Returns work->n if there is none. */
static uint32_t nearest_visible(const FaceWork *work, size_t hole, uint32_t point)
{
    uint32_t best = work->n;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < work->n; i++) {
        const FaceCorner *corner = &work->corners[i];
        double x = across(work, corner->point, 0) - across(work, point, 0);
        double y = across(work, corner->point, 1) - across(work, point, 1);
        if (x * x + y * y < least && is_visible(work, hole, corner, point)) {
            least = x * x + y * y;
            best = i;
        }
    }
    return best;
}

static uint32_t add_corner(FaceWork *work, uint32_t point, uint32_t before)
{
    uint32_t own = work->n++;
    work->corners[own] = (FaceCorner){.point = point, .before = before};
    if (own != before)
        work->corners[before].next = own;
    return own;
}

/* Returns the position in the loop of the point that is farthest along the first axis. */
static uint32_t farthest_of(const FaceWork *work, const FaceLoop *loop)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i < loop->n; i++)
        if (across(work, loop->points[i], 0) > across(work, loop->points[best], 0))
            best = i;
    return best;
}

/* Joins a hole to the loop. Returns false if no corner is visible from it. */
static bool bridge(FaceWork *work, size_t index)
{
    const FaceLoop *hole = &work->holes[index];
    uint32_t first = farthest_of(work, hole);
    uint32_t corner = nearest_visible(work, index, hole->points[first]), last = corner;
    if (corner == work->n)
        return false;
    uint32_t next = work->corners[corner].next;
    for (uint32_t k = 0; k <= hole->n; k++)
        last = add_corner(work, hole->points[(first + k) % hole->n], last);
    last = add_corner(work, work->corners[corner].point, last);
    work->corners[last].next = next;
    work->corners[next].before = last;
    return true;
}

/* Returns true if a corner of the loop is in the triangle of an ear, other than at its corners. */
static bool has_corner_in(const FaceWork *work, const FaceCorner *ear)
{
    const FaceCorner *corners = work->corners;
    uint32_t a = corners[ear->before].point, b = ear->point, c = corners[ear->next].point;
    for (uint32_t i = corners[ear->next].next; i != ear->before; i = corners[i].next) {
        uint32_t p = corners[i].point;
        if (p != a && p != b && p != c && turn(work, a, b, p) >= 0 && turn(work, b, c, p) >= 0 &&
            turn(work, c, a, p) >= 0)
            return true;
    }
    return false;
}

/* Returns true if a corner can be cut off. */
static bool is_ear(const FaceWork *work, const FaceCorner *corner)
{
    return turn(work, work->corners[corner->before].point, corner->point,
                work->corners[corner->next].point) > 0 &&
           !has_corner_in(work, corner);
}

/* Cuts ears off until two corners are left. Fails if no corner of the loop is an ear, which happens
 * only if openings touch. */
static Status cut_ears(FaceWork *work, Solid *solid, uint32_t label, Err *err)
{
    uint32_t at = 0, tried = 0, left = work->n;
    while (left > 2 && tried < left) {
        FaceCorner *corner = &work->corners[at];
        if (!is_ear(work, corner)) {
            at = corner->next;
            tried++;
            continue;
        }
        TRY(solid_triangle(solid, work->corners[corner->before].point, corner->point,
                           work->corners[corner->next].point, label, err));
        work->corners[corner->before].next = corner->next;
        work->corners[corner->next].before = corner->before;
        at = work->corners[corner->next].next;
        tried = 0;
        left--;
    }
    return left == 2 ? STATUS_OK
                     : err_set(err, STATUS_INFEASIBLE,
                               "two openings in a face of the block or the base touch each other");
}

/* Copies the holes, the farthest along the first axis first, by insertion, because a face has few
 * holes. */
static void order_holes(FaceWork *work, const FaceLoop *holes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        double far = across(work, holes[i].points[farthest_of(work, &holes[i])], 0);
        size_t at = work->n_holes++;
        for (; at > 0; at--) {
            const FaceLoop *before = &work->holes[at - 1];
            if (across(work, before->points[farthest_of(work, before)], 0) >= far)
                break;
            work->holes[at] = *before;
        }
        work->holes[at] = holes[i];
    }
}

/* loops[0] is the outer loop, counterclockwise seen from outside; the other loops are holes,
 * clockwise. The axes are exchanged on a low face, so that the outer loop turns left in both
 * cases. */
Status face_fill(Solid *solid, int face, const FaceLoop *loops, size_t n_loops, uint32_t label,
                 Err *err)
{
    int next = (face_axis(face) + 1) % 3, other = (face_axis(face) + 2) % 3;
    bool is_low = face_is_low(face);
    FaceWork work = {.mesh = &solid->mesh, is_low ? other : next, is_low ? next : other};
    size_t most = 0;
    Status status;
    for (size_t i = 0; i < n_loops; i++)
        most += loops[i].n + 2;
    TRY_GOTO(mem_calloc(&work.corners, most, sizeof *work.corners, "a face", err));
    TRY_GOTO(mem_calloc(&work.holes, n_loops, sizeof *work.holes, "a face", err));
    for (uint32_t i = 0; i < loops[0].n; i++)
        add_corner(&work, loops[0].points[i], i ? i - 1 : 0);
    work.corners[loops[0].n - 1].next = 0;
    work.corners[0].before = loops[0].n - 1;
    order_holes(&work, &loops[1], n_loops - 1);
    for (size_t h = 0; h < work.n_holes; h++)
        if (!bridge(&work, h))
            TRY_GOTO(err_set(err, STATUS_INFEASIBLE,
                             "two openings in a face of the block or the base touch each other"));
    TRY_GOTO(cut_ears(&work, solid, label, err));
done:
    free(work.corners);
    free(work.holes);
    return status;
}
