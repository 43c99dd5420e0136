/* Checks that the triangles of a file form closed surfaces, and finds the shells (connected
 * components).
 *
 * A surface is closed and consistently oriented if every edge is used by as many triangles in one
 * direction as in the other. Sorting the corners by position gives equal corners the same vertex.
 * Sorting the edges by the vertices of their two ends brings equal edges together; their directions
 * are then counted. Sorting needs less memory than a hash table, and its result does not depend on
 * the order of the file. Union-find, which joins the triangles at each edge, gives the shells. */
#include "domain/mesh.h"

#include <stdlib.h>
#include <string.h>

/* A corner of a triangle. */
typedef struct Corner {
    Vec3 position;
    uint32_t index; /* index in Soup.corners */
} Corner;

/* An edge of a triangle. */
typedef struct SoupEdge {
    uint32_t low, high; /* vertices of the two ends */
    int direction;      /* 1: from low to high; -1: from high to low */
    uint32_t triangle;
} SoupEdge;

static int compare_positions(Vec3 a, Vec3 b)
{
    int by_x = compare_numbers(a.x, b.x), by_y = compare_numbers(a.y, b.y);
    return by_x ? by_x : by_y ? by_y : compare_numbers(a.z, b.z);
}

static int compare_corners(const void *a, const void *b)
{
    return compare_positions(((const Corner *)a)->position, ((const Corner *)b)->position);
}

static int compare_edges(const void *a, const void *b)
{
    const SoupEdge *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    return (e->high > f->high) - (e->high < f->high);
}

/* Sets vertices[i] to the vertex of corner i: corners with the same position have the same vertex.
 */
static Status find_vertices(const Soup *soup, uint32_t *vertices, Err *err)
{
    Corner *corners = NULL;
    TRY(mem_calloc(&corners, soup->n, sizeof *corners, "corners", err));
    for (size_t i = 0; i < soup->n; i++)
        corners[i] = (Corner){soup->corners[i], (uint32_t)i};
    qsort(corners, soup->n, sizeof *corners, compare_corners);
    uint32_t vertex = 0;
    for (size_t i = 0; i < soup->n; i++) {
        vertex += i > 0 && compare_corners(&corners[i - 1], &corners[i]) != 0;
        vertices[corners[i].index] = vertex;
    }
    free(corners);
    return STATUS_OK;
}

/* Lists the edges of all triangles, sorted, and returns their number. Edges between equal corners,
 * in degenerate triangles, are left out. */
static size_t list_edges(const Soup *soup, const uint32_t *vertices, SoupEdge *edges)
{
    size_t n = 0;
    for (size_t i = 0; i < soup->n; i += 3) {
        for (size_t k = 0; k < 3; k++) {
            uint32_t from = vertices[i + k], to = vertices[i + (k + 1) % 3];
            if (from < to)
                edges[n++] = (SoupEdge){from, to, 1, (uint32_t)(i / 3)};
            else if (to < from)
                edges[n++] = (SoupEdge){to, from, -1, (uint32_t)(i / 3)};
        }
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    return n;
}

/* Refuses a mesh with open or inconsistent edges. An edge of an odd number of triangles is open. An
 * edge of an even number of triangles, of which not half run in each direction, joins triangles of
 * opposite orientation. */
static Status check_edges(const SoupEdge *edges, size_t n, const char *path, Err *err)
{
    size_t open = 0, inconsistent = 0;
    for (size_t i = 0, next; i < n; i = next) {
        int balance = 0;
        for (next = i; next < n && compare_edges(&edges[i], &edges[next]) == 0; next++)
            balance += edges[next].direction;
        open += (next - i) % 2;
        inconsistent += balance != 0 && (next - i) % 2 == 0;
    }
    if (open > 0)
        return err_set(
            err, STATUS_INPUT,
            "%s: the mesh is not closed: %zu edge%s to an odd number of triangles; close its "
            "holes",
            path, open, open == 1 ? " belongs" : "s belong");
    if (inconsistent > 0)
        return err_set(
            err, STATUS_INPUT,
            "%s: neighboring triangles face opposite sides at %zu edge%s of the mesh; the corners "
            "of all triangles must be counter-clockwise, seen from outside",
            path, inconsistent, inconsistent == 1 ? "" : "s");
    return STATUS_OK;
}

/* A triangle by its vertices in their cyclic order, the lowest first. */
typedef struct TriangleKey {
    uint32_t vertex[3];
    uint32_t triangle;
} TriangleKey;

/* Returns the key of a triangle: its vertices, rotated so that the lowest is first. Triangles with
 * the same vertices in the same orientation have the same key. */
static TriangleKey key_of(const uint32_t *vertices, size_t triangle)
{
    const uint32_t *n = vertices + 3 * triangle;
    unsigned low = n[0] <= n[1] && n[0] <= n[2] ? 0 : n[1] <= n[2] ? 1 : 2;
    return (TriangleKey){{n[low], n[(low + 1) % 3], n[(low + 2) % 3]}, (uint32_t)triangle};
}

static int compare_keys(const TriangleKey *a, const TriangleKey *b)
{
    for (int i = 0; i < 3; i++)
        if (a->vertex[i] != b->vertex[i])
            return a->vertex[i] < b->vertex[i] ? -1 : 1;
    return 0;
}

static int compare_triangles(const void *a, const void *b)
{
    const TriangleKey *c = a, *d = b;
    int by_key = compare_keys(c, d);
    return by_key ? by_key : (c->triangle > d->triangle) - (c->triangle < d->triangle);
}

/* Removes triangles that repeat an earlier triangle, and keeps the order of the others. */
static Status drop_repeated(Soup *soup, uint32_t *vertices, Err *err)
{
    size_t n = soup->n / 3, kept = 0;
    TriangleKey *sorted = NULL;
    bool *repeats = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&sorted, n, sizeof *sorted, "triangles", err));
    TRY_GOTO(mem_calloc(&repeats, n, sizeof *repeats, "triangles", err));
    for (size_t i = 0; i < n; i++)
        sorted[i] = key_of(vertices, i);
    qsort(sorted, n, sizeof *sorted, compare_triangles);
    for (size_t i = 1; i < n; i++)
        repeats[sorted[i].triangle] = compare_keys(&sorted[i - 1], &sorted[i]) == 0;
    for (size_t i = 0; i < n; i++) {
        if (repeats[i])
            continue;
        memmove(soup->corners + 3 * kept, soup->corners + 3 * i, 3 * sizeof *soup->corners);
        memmove(vertices + 3 * kept, vertices + 3 * i, 3 * sizeof *vertices);
        kept++;
    }
    soup->n = 3 * kept;
done:
    free(sorted);
    free(repeats);
    return status;
}

/* Sets the shell of every triangle. The representative of a set is its lowest triangle, so one pass
 * in ascending order can replace representatives by consecutive indices of shells. Returns the
 * number of shells. */
static size_t find_shells(const SoupEdge *edges, size_t n_edges, uint32_t *shell, size_t n)
{
    sets_begin(shell, n);
    for (size_t i = 1; i < n_edges; i++)
        if (compare_edges(&edges[i - 1], &edges[i]) == 0)
            sets_join(shell, edges[i - 1].triangle, edges[i].triangle);
    for (size_t i = 0; i < n; i++)
        shell[i] = sets_find(shell, (uint32_t)i);
    uint32_t shells = 0;
    for (size_t i = 0; i < n; i++)
        shell[i] = shell[i] == i ? shells++ : shell[shell[i]];
    return shells;
}

/* The caller releases soup->shell, even after an error. */
Status soup_find_shells(Soup *soup, const char *path, size_t *n_shells, Err *err)
{
    uint32_t *vertices = NULL;
    SoupEdge *edges = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&vertices, soup->n, sizeof *vertices, "corners", err));
    TRY_GOTO(mem_calloc(&edges, soup->n, sizeof *edges, "edges", err));
    TRY_GOTO(mem_calloc(&soup->shell, soup->n / 3, sizeof *soup->shell, "triangles", err));
    TRY_GOTO(find_vertices(soup, vertices, err));
    TRY_GOTO(drop_repeated(soup, vertices, err));
    size_t n = list_edges(soup, vertices, edges);
    TRY_GOTO(check_edges(edges, n, path, err));
    *n_shells = find_shells(edges, n, soup->shell, soup->n / 3);
done:
    free(vertices);
    free(edges);
    return status;
}
