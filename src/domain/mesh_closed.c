/* A surface is closed and consistently oriented if every edge is used by as many triangles in one
 * direction as in the other. Sorting the corners by position gives equal corners the same number.
 * Sorting the edges by the numbers of their two ends brings equal edges together; their directions
 * are then counted. Sorting needs less memory than a hash table, and its result does not depend on
 * the order of the file. Union-find, which joins the triangles at each edge, gives the shells. */
#include "domain/mesh.h"

#include <stdlib.h>
#include <string.h>

typedef struct Corner {
    Vec3 position;
    uint32_t index; /* index in Soup.corners */
} Corner;

typedef struct SoupEdge {
    uint32_t low, high; /* numbers of the two ends */
    int direction;      /* 1: from low to high; -1: from high to low */
    uint32_t triangle;
} SoupEdge;

static int compare_positions(Vec3 a, Vec3 b)
{
    int by_x = number_order(a.x, b.x), by_y = number_order(a.y, b.y);
    return by_x ? by_x : by_y ? by_y : number_order(a.z, b.z);
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

static Status number_corners(const Soup *soup, uint32_t *numbers, Err *err)
{
    Corner *corners = NULL;
    TRY(mem_calloc(&corners, soup->n, sizeof *corners, "corners", err));
    for (size_t i = 0; i < soup->n; i++)
        corners[i] = (Corner){soup->corners[i], (uint32_t)i};
    qsort(corners, soup->n, sizeof *corners, compare_corners);
    uint32_t number = 0;
    for (size_t i = 0; i < soup->n; i++) {
        number += i > 0 && compare_corners(&corners[i - 1], &corners[i]) != 0;
        numbers[corners[i].index] = number;
    }
    free(corners);
    return STATUS_OK;
}

static size_t list_edges(const Soup *soup, const uint32_t *numbers, SoupEdge *edges)
{
    size_t n = 0;
    for (size_t i = 0; i < soup->n; i += 3) {
        for (size_t k = 0; k < 3; k++) {
            uint32_t from = numbers[i + k], to = numbers[i + (k + 1) % 3];
            if (from < to)
                edges[n++] = (SoupEdge){from, to, 1, (uint32_t)(i / 3)};
            else if (to < from)
                edges[n++] = (SoupEdge){to, from, -1, (uint32_t)(i / 3)};
        }
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    return n;
}

static Status check_edges(const SoupEdge *edges, size_t n, const char *path, Err *err)
{
    size_t open = 0, twisted = 0;
    for (size_t i = 0, next; i < n; i = next) {
        int balance = 0;
        for (next = i; next < n && compare_edges(&edges[i], &edges[next]) == 0; next++)
            balance += edges[next].direction;
        open += (next - i) % 2;
        twisted += balance != 0 && (next - i) % 2 == 0;
    }
    if (open > 0)
        return err_set(
            err, STATUS_INPUT,
            "%s: the mesh is not closed: %zu edge%s to an odd number of triangles; close its "
            "holes",
            path, open, open == 1 ? " belongs" : "s belong");
    if (twisted > 0)
        return err_set(
            err, STATUS_INPUT,
            "%s: neighbouring triangles face opposite sides at %zu edge%s of the mesh; the "
            "corners of all triangles must be counter-clockwise, seen from outside",
            path, twisted, twisted == 1 ? "" : "s");
    return STATUS_OK;
}

/* A triangle by the numbers of its corners, the lowest first. */
typedef struct Corners {
    uint32_t number[3];
    uint32_t triangle;
} Corners;

static Corners corners_of(const uint32_t *numbers, size_t triangle)
{
    const uint32_t *n = numbers + 3 * triangle;
    unsigned low = n[0] <= n[1] && n[0] <= n[2] ? 0 : n[1] <= n[2] ? 1 : 2;
    return (Corners){{n[low], n[(low + 1) % 3], n[(low + 2) % 3]}, (uint32_t)triangle};
}

static int compare_numbers(const Corners *a, const Corners *b)
{
    for (int i = 0; i < 3; i++)
        if (a->number[i] != b->number[i])
            return a->number[i] < b->number[i] ? -1 : 1;
    return 0;
}

static int compare_triangles(const void *a, const void *b)
{
    const Corners *c = a, *d = b;
    int by_number = compare_numbers(c, d);
    return by_number ? by_number : (c->triangle > d->triangle) - (c->triangle < d->triangle);
}

/* Removes triangles that repeat an earlier triangle, and keeps the order of the others. */
static Status drop_repeated(Soup *soup, uint32_t *numbers, Err *err)
{
    size_t n = soup->n / 3, kept = 0;
    Corners *sorted = NULL;
    bool *repeats = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&sorted, n, sizeof *sorted, "triangles", err));
    TRY_GOTO(mem_calloc(&repeats, n, sizeof *repeats, "triangles", err));
    for (size_t i = 0; i < n; i++)
        sorted[i] = corners_of(numbers, i);
    qsort(sorted, n, sizeof *sorted, compare_triangles);
    for (size_t i = 1; i < n; i++)
        repeats[sorted[i].triangle] = compare_numbers(&sorted[i - 1], &sorted[i]) == 0;
    for (size_t i = 0; i < n; i++) {
        if (repeats[i])
            continue;
        memmove(soup->corners + 3 * kept, soup->corners + 3 * i, 3 * sizeof *soup->corners);
        memmove(numbers + 3 * kept, numbers + 3 * i, 3 * sizeof *numbers);
        kept++;
    }
    soup->n = 3 * kept;
done:
    free(sorted);
    free(repeats);
    return status;
}

/* Sets the shell of every triangle. The representative of a set is its lowest triangle, so that one
 * rising loop replaces representatives by numbers from 0 on. Returns the number of shells. */
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

Status soup_find_shells(Soup *soup, const char *path, size_t *n_shells, Err *err)
{
    uint32_t *numbers = NULL;
    SoupEdge *edges = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&numbers, soup->n, sizeof *numbers, "corners", err));
    TRY_GOTO(mem_calloc(&edges, soup->n, sizeof *edges, "edges", err));
    TRY_GOTO(mem_calloc(&soup->shell, soup->n / 3, sizeof *soup->shell, "triangles", err));
    TRY_GOTO(number_corners(soup, numbers, err));
    TRY_GOTO(drop_repeated(soup, numbers, err));
    size_t n = list_edges(soup, numbers, edges);
    TRY_GOTO(check_edges(edges, n, path, err));
    *n_shells = find_shells(edges, n, soup->shell, soup->n / 3);
done:
    free(numbers);
    free(edges);
    return status;
}
