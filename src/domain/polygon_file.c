/* Reads a polygon from a text file, and checks it.
 *
 * A ring is a sequence of points between blank lines. In a valid polygon two edges have no point in
 * common, except that neighbours share a corner. By the even-odd rule, rings inside rings are then
 * holes, rings inside holes are islands, and so on. The bounding volume hierarchy of the edges
 * finds the few pairs that must be tested. */
#include "domain/polygon.h"

#include "domain/kinds.h"
#include <stdlib.h>
#include <string.h>

enum { SHOWN = 40 /* characters of a bad line */ };

/* The state of reading a file. */
typedef struct PolygonReader {
    Polygon *polygon;
    const char *path;
    double mm;
    size_t line;  /* counted from 1 */
    size_t first; /* edge of the ring being read */
} PolygonReader;

/* Returns true if the points are equal. */
static bool same(Vec3 a, Vec3 b)
{
    return a.x == b.x && a.y == b.y;
}

/* Adds a point to the ring. Its edge gets its second end with the next point. */
static Status add_point(PolygonReader *reader, Vec3 point, Err *err)
{
    Polygon *polygon = reader->polygon;
    if (polygon->n > reader->first) {
        Edge *last = &polygon->edges[polygon->n - 1];
        if (same(last->a, point))
            return STATUS_OK;
        last->b = point;
        last->next = polygon->n;
    }
    TRY(mem_reserve(&polygon->edges, &polygon->capacity, polygon->n + 1, sizeof *polygon->edges,
                    "points", err));
    polygon->edges[polygon->n] = (Edge){point, point, polygon->n, reader->line};
    polygon->n++;
    return STATUS_OK;
}

/* Closes the ring being read, if it has points. A last point equal to the first one is removed. */
static Status end_ring(PolygonReader *reader, Err *err)
{
    Polygon *polygon = reader->polygon;
    if (polygon->n == reader->first)
        return STATUS_OK;
    Edge *first = polygon->edges + reader->first, *last = polygon->edges + polygon->n - 1;
    if (last > first && same(last->a, first->a)) {
        polygon->n--;
        last--;
    }
    last->b = first->a;
    last->next = reader->first;
    size_t n = polygon->n - reader->first;
    if (n < 3)
        return err_set(err, STATUS_INPUT,
                       "%s:%zu: the ring that begins here has %zu point%s; it must have at least "
                       "3 different ones",
                       reader->path, first->line, n, n == 1 ? "" : "s");
    reader->first = polygon->n;
    return STATUS_OK;
}

/* Reads a line: a point of the current ring, or nothing, which ends the ring. `#` begins a comment.
 * */
static Status read_line(PolygonReader *reader, char *line, Err *err)
{
    line += strspn(line, TEXT_BLANKS);
    if (*line == '\0')
        return end_ring(reader, err);
    line[strcspn(line, "#")] = '\0';
    if (*line == '\0')
        return STATUS_OK;
    double value[2];
    if (!numbers_parse(line, 2, value))
        return err_set(err, STATUS_INPUT,
                       "%s:%zu: '%.*s' is not a point; a line holds two numbers, x y, or nothing, "
                       "which ends a ring",
                       reader->path, reader->line, SHOWN, line);
    Vec3 point = vec3(value[0] * reader->mm, value[1] * reader->mm, 0);
    TRY(domain_check_point(reader->path, reader->line, point, err));
    return add_point(reader, point, err);
}

static Status read_lines(PolygonReader *reader, char *bytes, Err *err)
{
    for (char *line; (line = text_line(&bytes));) {
        reader->line++;
        TRY(read_line(reader, line, err));
    }
    TRY(end_ring(reader, err));
    if (reader->polygon->n == 0)
        return err_set(err, STATUS_INPUT, "%s: the file has no points; a polygon has at least 3",
                       reader->path);
    return STATUS_OK;
}

Status polygon_read(Polygon *polygon, const char *path, double mm, Err *err)
{
    static const FileForm form = {.name = "a polygon", .most_bytes = 1e9, .is_text = true};
    char *bytes = NULL;
    size_t size = 0;
    TRY(file_read(path, &form, &bytes, &size, err));
    PolygonReader reader = {.polygon = polygon, .path = path, .mm = mm};
    Status status = read_lines(&reader, bytes, err);
    free(bytes);
    return status;
}

double polygon_twice_area(Vec3 a, Vec3 b, Vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Returns true if `point`, on the line through the edge, is between its ends. */
static bool between(const Edge *edge, Vec3 point)
{
    return fmin(edge->a.x, edge->b.x) <= point.x && point.x <= fmax(edge->a.x, edge->b.x) &&
           fmin(edge->a.y, edge->b.y) <= point.y && point.y <= fmax(edge->a.y, edge->b.y);
}

/* Returns true if the numbers have opposite signs and neither is 0. */
static bool opposite(double a, double b)
{
    return (a < 0 && b > 0) || (a > 0 && b < 0);
}

/* Returns true if the edges have a common point: each edge's ends are on opposite sides of the
 * other, or an end of one is on the other. */
static bool have_common_point(const Edge *e, const Edge *f)
{
    double fa = polygon_twice_area(e->a, e->b, f->a), fb = polygon_twice_area(e->a, e->b, f->b);
    double ea = polygon_twice_area(f->a, f->b, e->a), eb = polygon_twice_area(f->a, f->b, e->b);
    if (opposite(fa, fb) && opposite(ea, eb))
        return true;
    return (fa == 0 && between(e, f->a)) || (fb == 0 && between(e, f->b)) ||
           (ea == 0 && between(f, e->a)) || (eb == 0 && between(f, e->b));
}

/* Returns true if `next`, which begins where `edge` ends, leads back along it. */
static bool folds_back(const Edge *edge, const Edge *next)
{
    return polygon_twice_area(edge->a, edge->b, next->b) == 0 &&
           vec3_dot(vec3_sub(edge->b, edge->a), vec3_sub(next->b, next->a)) < 0;
}

Status polygon_check_crossings(const Polygon *polygon, const char *path, Err *err)
{
    for (size_t i = 0; i < polygon->n; i++) {
        const Edge *e = &polygon->edges[i];
        uint32_t j;
        for (BoxWalk walk = boxwalk_segment(&polygon->tree, e->a, e->b); boxwalk_next(&walk, &j);) {
            const Edge *f = &polygon->edges[j];
            if (j <= i)
                continue;
            bool bad = e->next == j   ? folds_back(e, f)
                       : f->next == i ? folds_back(f, e)
                                      : have_common_point(e, f);
            if (bad)
                return err_set(err, STATUS_INPUT,
                               "%s:%zu: the edge that begins here crosses or touches the one that "
                               "begins on line %zu; the edges of a polygon may meet at the "
                               "corners of their ring only",
                               path, f->line, e->line);
        }
    }
    return STATUS_OK;
}
