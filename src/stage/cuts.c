/* The cuts are the fixed point of t_i = max(0, max_j (t_j cos_ij + r_j sin_ij)), which is unique: the
 * right-hand side brings two guesses closer by the largest |cos_ij|. Applied again and again it gets
 * there, but slowly when vessels leave at a small angle. So each round asks which other end pushes each
 * end furthest, solves the linear system in which only that one does, and starts again from there
 * [policy iteration, Howard 1960]; a few rounds do where thousands of plain ones would not. Where rounds
 * do not settle, plain ones finish. */
#include "stage/cuts.h"

#include <stdlib.h>
#include <string.h>

enum { SOLVED_ROUNDS = 50, PLAIN_ROUNDS = 500 };

static const double parallel = 1e-6; /* sine */
static const double tolerance =
    1e-13; /* of the largest radius or, where that is longer, of the cut */

/* What pushes an end: t = slope * t[mover] + offset; without a mover t = 0. */
typedef struct Push {
    ptrdiff_t mover; /* -1: none */
    double slope, offset;
} Push;

typedef struct Work {
    Push *pushes;
    double *next;  /* the right-hand side */
    size_t *path;  /* ends on the way to one that is solved */
    bool *visited; /* they, and those solved */
} Work;

static Push strongest_push(const VesselEnd *ends, size_t n, size_t i, const double *cut,
                           double *furthest)
{
    Push best = {-1, 0, 0};
    *furthest = 0;
    for (size_t j = 0; j < n; j++) {
        double sine = vec3_length(vec3_cross(ends[i].axis, ends[j].axis));
        if (j == i || sine < parallel)
            continue;
        Push push = {(ptrdiff_t)j, vec3_dot(ends[i].axis, ends[j].axis), ends[j].radius * sine};
        double pushed = push.slope * cut[j] + push.offset;
        if (pushed > *furthest) {
            *furthest = pushed;
            best = push;
        }
    }
    return best;
}

/* Finds all pushes and right-hand sides; whether the cuts are the fixed point. */
static bool find_pushes(const VesselEnd *ends, size_t n, const double *cut, Work *work)
{
    double largest = 0;
    bool settled = true;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, ends[i].radius);
    for (size_t i = 0; i < n; i++) {
        work->pushes[i] = strongest_push(ends, n, i, cut, &work->next[i]);
        double change = fabs(work->next[i] - cut[i]);
        settled = settled && change <= tolerance * fmax(largest, work->next[i]);
    }
    return settled;
}

/* Follows the movers from `first` around their circle back to it: t = slope t + offset. */
static double solve_circle(const Push *pushes, size_t first)
{
    double slope = 1, offset = 0;
    size_t i = first;
    do {
        offset += slope * pushes[i].offset;
        slope *= pushes[i].slope;
        i = (size_t)pushes[i].mover;
    } while (i != first);
    return offset / (1 - slope);
}

/* Solves t_i = slope_i t[mover_i] + offset_i for all ends. Movers lead to an end that nothing pushes, to
 * one solved before, or around a circle. */
static void solve_pushes(size_t n, double *cut, Work *work)
{
    const Push *pushes = work->pushes;
    memset(work->visited, 0, n * sizeof *work->visited);
    for (size_t start = 0; start < n; start++) {
        size_t length = 0, end = start;
        for (; !work->visited[end] && pushes[end].mover >= 0; end = (size_t)pushes[end].mover) {
            work->visited[end] = true;
            work->path[length++] = end;
        }
        bool circle = false;
        for (size_t k = 0; k < length && !circle; k++)
            circle = work->path[k] == end;
        if (circle)
            cut[end] = solve_circle(pushes, end);
        else if (!work->visited[end])
            cut[end] = 0;
        work->visited[end] = true;
        while (length > 0) {
            size_t i = work->path[--length];
            if (i != end)
                cut[i] = pushes[i].slope * cut[pushes[i].mover] + pushes[i].offset;
        }
    }
}

Status cuts_compute(const VesselEnd *ends, size_t n, double *cut, Err *err)
{
    Work work = {0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&work.pushes, n, sizeof *work.pushes, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.next, n, sizeof *work.next, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.path, n, sizeof *work.path, "vessel ends", err));
    TRY_GOTO(mem_calloc(&work.visited, n, sizeof *work.visited, "vessel ends", err));
    memset(cut, 0, n * sizeof *cut);
    for (int round = 0; round < SOLVED_ROUNDS + PLAIN_ROUNDS; round++) {
        bool settled = find_pushes(ends, n, cut, &work);
        if (settled || round >= SOLVED_ROUNDS)
            memcpy(cut, work.next, n * sizeof *cut);
        else
            solve_pushes(n, cut, &work);
        if (settled)
            break;
    }
done:
    free(work.pushes);
    free(work.next);
    free(work.path);
    free(work.visited);
    return status;
}
