/* Collects pieces of lines, clips them to the paper, and joins them end to end to long strokes.
 *
 * To find ends that meet, ends are sorted into the squares of a grid. Two ends of equal line width
 * in one square are joined. Ends that meet on a line of the grid may fall into two squares and stay
 * apart; the stroke is then drawn as two, which looks the same. */
#include "render/ink/inkpieces.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Side of a square, mm of paper: how close ends must be to be joined. Ends that meet differ by the
 * bisection in ink.c, a hundredth of a line width, which is much less; and a jump of 0.02 mm in a
 * stroke is too small to see. */
#define GRID_MM 0.02

Status inkpieces_begin(InkPieces *pieces, double width_mm, Err *err)
{
    Strokes *list = &pieces->list;
    TRY(mem_reserve(&list->strokes, &pieces->strokes_capacity, list->n + 1, sizeof *list->strokes,
                    "strokes", err));
    list->strokes[list->n++] = (Stroke){list->n_points, 0, width_mm};
    return STATUS_OK;
}

Status inkpieces_add(InkPieces *pieces, const double point[2], Err *err)
{
    Strokes *list = &pieces->list;
    TRY(mem_reserve(&list->points, &pieces->points_capacity, list->n_points + 1,
                    sizeof *list->points, "strokes", err));
    memcpy(list->points[list->n_points++], point, sizeof *list->points);
    list->strokes[list->n - 1].n++;
    return STATUS_OK;
}

/* Appends the points of a piece to the last stroke, without its first `skip` points in the
 * direction of travel. */
static Status add_points(InkPieces *pieces, const Strokes *from, size_t piece, bool backwards,
                         size_t skip, Err *err)
{
    const Stroke *stroke = &from->strokes[piece];
    for (size_t k = skip; k < stroke->n; k++)
        TRY(inkpieces_add(pieces, from->points[stroke->first + (backwards ? stroke->n - 1 - k : k)],
                          err));
    return STATUS_OK;
}

/* Clips a line from `a` to `b` to the paper: sets the fractions of the line at which it enters and
 * leaves. Returns false if the line misses the paper [Liang, Barsky, ACM Trans. Graph. 3 (1984)
 * 1-22]. */
static bool crosses_paper(const double a[2], const double b[2], const double paper[2],
                          double part[2])
{
    part[0] = 0;
    part[1] = 1;
    for (int k = 0; k < 2; k++) {
        double run = b[k] - a[k], from = -a[k] / run, to = (paper[k] - a[k]) / run;
        if (run == 0 && (a[k] < 0 || a[k] > paper[k]))
            return false;
        if (run == 0)
            continue;
        part[0] = fmax(part[0], fmin(from, to));
        part[1] = fmin(part[1], fmax(from, to));
    }
    return part[0] < part[1];
}

/* Appends the point at the fraction `part` of the line from `a` to `b`. */
static Status add_between(InkPieces *pieces, const double a[2], const double b[2], double part,
                          Err *err)
{
    const double point[2] = {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
    return inkpieces_add(pieces, part == 0 ? a : part == 1 ? b : point, err);
}

Status inkpieces_append(InkPieces *pieces, const InkPieces *more, const double paper[2], Err *err)
{
    for (size_t i = 0; i < more->list.n; i++) {
        const Stroke *stroke = &more->list.strokes[i];
        bool begun = false;
        for (size_t k = 1; k < stroke->n; k++) {
            const double *a = more->list.points[stroke->first + k - 1], *b = a + 2;
            double part[2];
            if (!crosses_paper(a, b, paper, part)) {
                begun = false;
                continue;
            }
            if (!begun) {
                TRY(inkpieces_begin(pieces, stroke->width_mm, err));
                TRY(add_between(pieces, a, b, part[0], err));
            }
            TRY(add_between(pieces, a, b, part[1], err));
            begun = part[1] == 1;
        }
    }
    return STATUS_OK;
}

void inkpieces_release(InkPieces *pieces)
{
    strokes_release(&pieces->list);
    *pieces = (InkPieces){0};
}

/* ---- joining --------------------------------------------------------------------------------- */

/* An end of a piece: number 2 i of the first point of piece i, 2 i + 1 of the last one. */
typedef struct End {
    double x, y, width; /* in squares */
    size_t number;
} End;

static int end_order(const void *a, const void *b)
{
    const End *p = a, *q = b;
    int order = compare_numbers(p->x, q->x);
    order = order ? order : compare_numbers(p->y, q->y);
    order = order ? order : compare_numbers(p->width, q->width);
    return order ? order : (p->number > q->number) - (p->number < q->number);
}

static End end_of(const Strokes *list, size_t number)
{
    const Stroke *stroke = &list->strokes[number / 2];
    const double *point = list->points[stroke->first + (number % 2 ? stroke->n - 1 : 0)];
    return (End){round(point[0] / GRID_MM), round(point[1] / GRID_MM), stroke->width_mm, number};
}

/* Returns true if two ends of different pieces are in the same square and have the same width. */
static bool fits(const End *a, const End *b)
{
    return a->x == b->x && a->y == b->y && a->width == b->width && a->number / 2 != b->number / 2;
}

/* Sets mates[e] to the end that end e is joined to, or to SIZE_MAX. */
static Status find_mates(const Strokes *list, size_t *mates, Err *err)
{
    End *ends;
    size_t n = 2 * list->n;
    TRY(mem_calloc(&ends, n, sizeof *ends, "strokes", err));
    for (size_t i = 0; i < n; i++) {
        ends[i] = end_of(list, i);
        mates[i] = SIZE_MAX;
    }
    qsort(ends, n, sizeof *ends, end_order);
    for (size_t i = 0; i + 1 < n; i++) {
        if (!fits(&ends[i], &ends[i + 1]))
            continue;
        mates[ends[i].number] = ends[i + 1].number;
        mates[ends[i + 1].number] = ends[i].number;
        i++;
    }
    free(ends);
    return STATUS_OK;
}

/* Returns the end at which the stroke of a piece begins: walks from the first point of the piece
 * from mate to mate. A closed stroke begins at the first point of the piece. */
static size_t beginning(const size_t *mates, size_t piece)
{
    size_t end = 2 * piece;
    while (mates[end] != SIZE_MAX) {
        end = mates[end] ^ 1;
        if (end == 2 * piece)
            break;
    }
    return end;
}

/* Appends the stroke that a piece belongs to: walks from its beginning from mate to mate, and marks
 * its pieces in `used`. */
static Status put_stroke(const Strokes *list, const size_t *mates, size_t piece, bool *used,
                         InkPieces *out, Err *err)
{
    size_t end = beginning(mates, piece), skip = 0;
    TRY(inkpieces_begin(out, list->strokes[piece].width_mm, err));
    while (end != SIZE_MAX && !used[end / 2]) {
        used[end / 2] = true;
        TRY(add_points(out, list, end / 2, end % 2, skip, err));
        skip = 1;
        end = mates[end ^ 1];
    }
    return STATUS_OK;
}

Status inkpieces_join(const InkPieces *pieces, Strokes *strokes, Err *err)
{
    const Strokes *list = &pieces->list;
    InkPieces joined = {0};
    size_t *mates = NULL;
    bool *used = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&mates, 2 * list->n, sizeof *mates, "strokes", err));
    TRY_GOTO(mem_calloc(&used, list->n, sizeof *used, "strokes", err));
    TRY_GOTO(find_mates(list, mates, err));
    for (size_t i = 0; i < list->n; i++)
        if (!used[i])
            TRY_GOTO(put_stroke(list, mates, i, used, &joined, err));
    *strokes = joined.list;
    joined = (InkPieces){0};
done:
    inkpieces_release(&joined);
    free(mates);
    free(used);
    return status;
}
