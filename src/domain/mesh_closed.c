/* A surface is closed, and its sides agree, if every edge is run along by as many triangles in one
 * direction as in the other. Sorting the corners by place gives equal ones the same number; sorting
 * the edges by the numbers of their two ends brings equal edges together, and then as many must run
 * up as down. Sorting needs less memory than a hash table, and no care for its order. */
#include "domain/mesh.h"

#include <stdlib.h>

typedef struct Corner {
    Vec3 place;
    uint32_t index; /* in the soup */
} Corner;

typedef struct SoupEdge {
    uint32_t low, high; /* numbers of the ends */
    int way;            /* 1: from low to high; -1: from high to low */
} SoupEdge;

static int compare_places(Vec3 a, Vec3 b)
{
    int by_x = number_order(a.x, b.x), by_y = number_order(a.y, b.y);
    return by_x ? by_x : by_y ? by_y : number_order(a.z, b.z);
}

static int compare_corners(const void *a, const void *b)
{
    return compare_places(((const Corner *)a)->place, ((const Corner *)b)->place);
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
                edges[n++] = (SoupEdge){from, to, 1};
            else if (to < from)
                edges[n++] = (SoupEdge){to, from, -1};
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
            balance += edges[next].way;
        open += (next - i) % 2;
        twisted += balance != 0 && (next - i) % 2 == 0;
    }
    if (open > 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the mesh is open: %zu edge%s a triangle on one side only; close its "
                       "holes",
                       path, open, open == 1 ? " has" : "s have");
    if (twisted > 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the sides of the mesh do not agree: at %zu edge%s the triangles run "
                       "the same way; turn them so that all are counter-clockwise seen from "
                       "outside",
                       path, twisted, twisted == 1 ? "" : "s");
    return STATUS_OK;
}

Status soup_check_closed(const Soup *soup, const char *path, Err *err)
{
    uint32_t *numbers = NULL;
    SoupEdge *edges = NULL;
    Status status = mem_calloc(&numbers, soup->n, sizeof *numbers, "corners", err);
    if (status != STATUS_OK)
        return status;
    TRY_GOTO(mem_calloc(&edges, soup->n, sizeof *edges, "edges", err));
    TRY_GOTO(number_corners(soup, numbers, err));
    size_t n = list_edges(soup, numbers, edges);
    TRY_GOTO(check_edges(edges, n, path, err));
done:
    free(numbers);
    free(edges);
    return status;
}
