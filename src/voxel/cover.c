/* Computes which part of a cell the union of several bodies fills.
 *
 * A cell inside one body is full. A cell that only one body meets has an exact fraction (body.c).
 *
 * A cell that several bodies meet is split in eight until it is no wider than the thinnest of them.
 * Then it is crossed by lines along the coordinate axis that is most nearly perpendicular to all of
 * the bodies. The length of a line in the union of the bodies is exact. The lines pass the points
 * of a Fibonacci lattice [Sloan, Joe: Lattice Methods for Multiple Integration, 1994], which
 * prefers no direction. So thin vessels are found wherever they pass, and the work grows with the
 * logarithm of the ratio of cell to vessel. */
#include "voxel/cover.h"

#include <stdlib.h>

/* Number of lines, and the step of the lattice: two consecutive Fibonacci numbers. More lines lower
 * the error [cover.h] and take more time. A cell is split in eight at most MAX_DEPTH times, until
 * its side is a 128th. A vessel that is thinner than 1 / 256 of the cell's side is sampled by lines
 * that may miss it. */
enum { LINES = 89, LATTICE_STEP = 55, MAX_DEPTH = 7 };

Status cover_reserve(CoverWorkspace *workspace, size_t n_bodies, Err *err)
{
    TRY(mem_reserve(&workspace->lists, &workspace->n_lists, (MAX_DEPTH + 1) * n_bodies,
                    sizeof *workspace->lists, "vessels in a voxel", err));
    return mem_reserve(&workspace->chords, &workspace->n_chords, n_bodies,
                       sizeof *workspace->chords, "vessels in a voxel", err);
}

void cover_release(CoverWorkspace *workspace)
{
    free(workspace->lists);
    free(workspace->chords);
    *workspace = (CoverWorkspace){0};
}

/* Inserts a chord into the list, which is ordered by the chords' starts. Returns the new number. */
static size_t insert_chord(double (*chords)[2], size_t n, double low, double high)
{
    size_t at = n;
    for (; at > 0 && chords[at - 1][0] > low; at--) {
        chords[at][0] = chords[at - 1][0];
        chords[at][1] = chords[at - 1][1];
    }
    chords[at][0] = low;
    chords[at][1] = high;
    return n + 1;
}

/* Returns the length of the union of the chords. */
static double union_length(double (*chords)[2], size_t n)
{
    double length = 0, end = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        double from = chords[i][0] > end ? chords[i][0] : end;
        if (chords[i][1] > from) {
            length += chords[i][1] - from;
            end = chords[i][1];
        }
    }
    return length;
}

/* The bodies that may meet a cell. */
typedef struct NearBodies {
    const Body *bodies;
    const uint32_t *list; /* their indices in `bodies` */
    size_t n;             /* number of indices */
} NearBodies;

/* Returns the length of the line through `middle` in the union, between -half and half. */
static double line_in_union(const NearBodies *near, Vec3 middle, int axis, double half,
                            CoverWorkspace *workspace)
{
    size_t n_chords = 0;
    for (size_t i = 0; i < near->n; i++) {
        double low, high;
        if (!body_chord(&near->bodies[near->list[i]], middle, axis, 0, 0, &low, &high))
            continue;
        low = low > -half ? low : -half;
        high = high < half ? high : half;
        if (low < high)
            n_chords = insert_chord(workspace->chords, n_chords, low, high);
    }
    return union_length(workspace->chords, n_chords);
}

/* Returns the coordinate axis for which the largest cosine with any body's axis is smallest. */
static int axis_across(const NearBodies *near)
{
    Vec3 along = {0};
    for (size_t i = 0; i < near->n; i++) {
        Vec3 axis = near->bodies[near->list[i]].axis;
        along = vec3(fmax(along.x, fabs(axis.x)), fmax(along.y, fabs(axis.y)),
                     fmax(along.z, fabs(axis.z)));
    }
    return along.z <= along.x && along.z <= along.y ? 2 : along.y <= along.x ? 1 : 0;
}

static Vec3 along_axis(int axis, double x)
{
    return vec3(axis == 0 ? x : 0, axis == 1 ? x : 0, axis == 2 ? x : 0);
}

/* Returns the covered fraction of a cell, sampled by lines. */
static double fraction_by_lines(const NearBodies *near, const VoxelCell *cell,
                                CoverWorkspace *workspace)
{
    int axis = axis_across(near), first = (axis + 1) % 3, second = (axis + 2) % 3;
    double half = vec3_component(cell->half, axis), length = 0;
    for (int i = 0; i < LINES; i++) {
        double s = (2 * i + 1.0) / LINES - 1;
        double t = (2 * (i * LATTICE_STEP % LINES) + 1.0) / LINES - 1;
        Vec3 at = vec3_add(cell->center, along_axis(first, s * vec3_component(cell->half, first)));
        at = vec3_add(at, along_axis(second, t * vec3_component(cell->half, second)));
        length += line_in_union(near, at, axis, half, workspace);
    }
    return length / (LINES * 2 * half);
}

static double covered_fraction(const NearBodies *near, const VoxelCell *cell, int depth,
                               uint32_t *lists, CoverWorkspace *workspace);

/* Returns the covered fraction of a cell, the mean of its eight parts. */
static double fraction_of_eighths(const NearBodies *near, const VoxelCell *cell, int depth,
                                  uint32_t *lists, CoverWorkspace *workspace)
{
    Vec3 half = vec3_scale(cell->half, 0.5);
    double part = 0;
    for (int i = 0; i < 8; i++) {
        Vec3 move = {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        VoxelCell eighth = {vec3_add(cell->center, move), half};
        part += covered_fraction(near, &eighth, depth + 1, lists, workspace);
    }
    return part / 8;
}

/* Returns the covered fraction of a cell. `lists` is scratch: it has room for near->n bodies at
 * this depth and at each deeper one. */
static double covered_fraction(const NearBodies *near, const VoxelCell *cell, int depth,
                               uint32_t *lists, CoverWorkspace *workspace)
{
    double thinnest = INFINITY;
    size_t met = 0;
    for (size_t i = 0; i < near->n; i++) {
        const Body *body = &near->bodies[near->list[i]];
        if (!body_meets(body, cell))
            continue;
        if (body_holds(body, cell))
            return 1;
        lists[met++] = near->list[i];
        thinnest = fmin(thinnest, body->radius);
    }
    if (met <= 1)
        return met ? body_fraction(&near->bodies[lists[0]], cell) : 0;
    const NearBodies meeting = {near->bodies, lists, met};
    double widest = fmax(cell->half.x, fmax(cell->half.y, cell->half.z));
    if (widest > thinnest && depth < MAX_DEPTH)
        return fraction_of_eighths(&meeting, cell, depth, lists + met, workspace);
    return fraction_by_lines(&meeting, cell, workspace);
}

double cover_fraction(const Body *bodies, const uint32_t *list, size_t n, const VoxelCell *cell,
                      CoverWorkspace *workspace)
{
    const NearBodies near = {bodies, list, n};
    return covered_fraction(&near, cell, 0, workspace->lists, workspace);
}
