/* Where two vessels that do not blend leave each other at a small angle, the groove between their
 * walls is narrower at its bottom than any cell, and the points of the lattice that happen to lie
 * in it make tunnels and hollows, the more the smaller the cells. A finer lattice is no cure; a
 * wall of the right topology is.
 *
 * The outside is grown anew, from the faces of the octree's root inwards, by the points whose field
 * is below the level, the lowest first. A point is given to it only if that changes nothing of its
 * topology: if of the points about it, which with their triangles are a sphere, those outside are
 * connected and those inside are, too [G. Bertrand: Simple points, topological numbers and geodesic
 * neighborhoods in cubic grids, 1994, for tetrahedra]. The outside of a sphere is a ball, and stays
 * one; so the inside is one, too. A tunnel is entered from both its ends and stopped up where its
 * points are nearest to the wall. */
#include "mesh/lattice/repair.h"

#include <stdlib.h>

enum { MOST_LINK_POINTS = 256 };

/* Points outside by their field that wait in the heap are pending. */
typedef enum PointState { POINT_INSIDE, POINT_PENDING, POINT_OUTSIDE } PointState;

/* The points about one, with their union-find. */
typedef struct Link {
    uint32_t points[MOST_LINK_POINTS], root[MOST_LINK_POINTS];
    uint32_t n;
} Link;

void mender_release(Mender *mender)
{
    free(mender->all.items);
    free(mender->first);
    free(mender->around);
    free(mender->states);
    free(mender->slots);
    free(mender->heap);
    *mender = (Mender){0};
}

/* Fills first[] and around[]. */
static Status list_tetrahedra(Mender *mender, size_t n_points, Err *err)
{
    const TetrahedronList *all = &mender->all;
    TRY(mem_reserve(&mender->first, &mender->first_capacity, n_points + 2, sizeof *mender->first,
                    "points of a junction", err));
    TRY(mem_reserve(&mender->around, &mender->around_capacity, 4 * all->n, sizeof *mender->around,
                    "points of a junction", err));
    for (size_t i = 0; i < n_points + 2; i++)
        mender->first[i] = 0;
    for (size_t i = 0; i < 4 * all->n; i++)
        mender->first[all->items[i / 4].at[i % 4] + 2]++;
    for (size_t i = 2; i < n_points + 2; i++)
        mender->first[i] += mender->first[i - 1];
    for (size_t i = 0; i < 4 * all->n; i++)
        mender->around[mender->first[all->items[i / 4].at[i % 4] + 1]++] = (uint32_t)(i / 4);
    return STATUS_OK;
}

static bool is_lower(const MendItem *a, const MendItem *b)
{
    return a->height != b->height ? a->height > b->height : a->point < b->point;
}

static Status push(Mender *mender, MendItem item, Err *err)
{
    TRY(mem_reserve(&mender->heap, &mender->heap_capacity, mender->n_heap + 1, sizeof *mender->heap,
                    "points of a junction", err));
    size_t at = mender->n_heap++;
    for (; at > 0 && is_lower(&item, &mender->heap[(at - 1) / 2]); at = (at - 1) / 2)
        mender->heap[at] = mender->heap[(at - 1) / 2];
    mender->heap[at] = item;
    return STATUS_OK;
}

static MendItem pop(Mender *mender)
{
    MendItem *heap = mender->heap, best = heap[0], last = heap[--mender->n_heap];
    size_t at = 0, n = mender->n_heap;
    for (size_t child = 1; child < n; child = 2 * at + 1) {
        child += child + 1 < n && is_lower(&heap[child + 1], &heap[child]);
        if (!is_lower(&heap[child], &last))
            break;
        heap[at] = heap[child];
        at = child;
    }
    heap[at] = last;
    return best;
}

/* The place of a point in the link, where it is put unless it is there; MOST_LINK_POINTS when there
 * is no room. */
static uint32_t place_in_link(const Mender *mender, Link *link, uint32_t point)
{
    uint32_t slot = mender->slots[point];
    if (slot < link->n && link->points[slot] == point)
        return slot;
    if (link->n == MOST_LINK_POINTS)
        return MOST_LINK_POINTS;
    mender->slots[point] = link->n;
    link->points[link->n] = point;
    link->root[link->n] = link->n;
    return link->n++;
}

static uint32_t root_of(uint32_t *root, uint32_t i)
{
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

/* Joins the points of a tetrahedron, but for `self`, that are on one side. False when there are too
 * many points. */
static bool join_triangle(const Mender *mender, Link *link, const uint32_t at[4], uint32_t self)
{
    uint32_t places[3], n = 0;
    for (int i = 0; i < 4; i++)
        if (at[i] != self && (places[n++] = place_in_link(mender, link, at[i])) == MOST_LINK_POINTS)
            return false;
    for (int i = 0; i < 3; i++) {
        uint32_t a = places[i], b = places[(i + 1) % 3];
        bool one = mender->states[link->points[a]] == POINT_OUTSIDE;
        bool other = mender->states[link->points[b]] == POINT_OUTSIDE;
        if (one == other)
            link->root[root_of(link->root, a)] = root_of(link->root, b);
    }
    return true;
}

/* Fills the link of a point, and tells whether those outside are connected and those inside are. */
static bool is_simple(const Mender *mender, uint32_t point, Link *link)
{
    int parts[2] = {0};
    link->n = 0;
    for (uint32_t i = mender->first[point]; i < mender->first[point + 1]; i++)
        if (!join_triangle(mender, link, mender->all.items[mender->around[i]].at, point))
            return false;
    for (uint32_t i = 0; i < link->n; i++)
        if (link->root[i] == i)
            parts[mender->states[link->points[i]] == POINT_OUTSIDE]++;
    return parts[0] == 1 && parts[1] == 1;
}

static Status push_neighbors(Mender *mender, const Lattice *lattice, uint32_t point, Err *err)
{
    for (uint32_t i = mender->first[point]; i < mender->first[point + 1]; i++)
        for (int k = 0; k < 4; k++) {
            uint32_t other = mender->all.items[mender->around[i]].at[k];
            double height = lattice->points[other].height;
            if (mender->states[other] != POINT_INSIDE || height < 0)
                continue;
            mender->states[other] = POINT_PENDING;
            TRY(push(mender, (MendItem){height, other}, err));
        }
    return STATUS_OK;
}

/* The points on the faces of the root, and the centres of the cells there, are the first ones
 * outside. False when one of them is inside. */
static bool seed(Mender *mender, const Lattice *lattice, const ZoneTree *tree)
{
    bool outside = true;
    for (size_t i = 0; i < tree->n_cells; i++) {
        const ZoneCell *cell = &tree->cells[i];
        int32_t last = (int32_t)(1 << cell->level) - 1;
        bool at_face = false;
        for (int axis = 0; axis < 3; axis++)
            at_face = at_face || cell->at[axis] == 0 || cell->at[axis] == last;
        if (at_face && lattice->centers[i])
            mender->states[lattice->centers[i]] = POINT_OUTSIDE;
    }
    for (size_t i = 1; i < lattice->n_points; i++) {
        Vec3 from = vec3_sub(lattice->points[i].x, tree->corner);
        for (int axis = 0; axis < 3; axis++) {
            double along = vec3_component(from, axis) / tree->side;
            if (along < 1e-9 || along > 1 - 1e-9)
                mender->states[i] = POINT_OUTSIDE;
        }
        outside = outside && (mender->states[i] == POINT_INSIDE || lattice->points[i].height >= 0);
    }
    return outside;
}

static Status grow(Mender *mender, const Lattice *lattice, Err *err)
{
    Link link;
    mender->n_heap = 0;
    for (uint32_t i = 0; i < lattice->n_points; i++)
        if (mender->states[i] == POINT_OUTSIDE)
            TRY(push_neighbors(mender, lattice, i, err));
    while (mender->n_heap) {
        uint32_t point = pop(mender).point;
        mender->states[point] = POINT_INSIDE;
        if (!is_simple(mender, point, &link))
            continue;
        mender->states[point] = POINT_OUTSIDE;
        TRY(push_neighbors(mender, lattice, point, err));
    }
    return STATUS_OK;
}

static bool is_stopped_up(const Mender *mender, const Lattice *lattice, size_t point)
{
    return lattice->points[point].height >= 0 && mender->states[point] != POINT_OUTSIDE;
}

/* How far the points that the outside has not reached are from the wall at most, over the local
 * radius; heights are in halves of that. */
static double find_width(const Mender *mender, const Lattice *lattice)
{
    double width = 0;
    for (size_t i = 1; i < lattice->n_points; i++)
        if (is_stopped_up(mender, lattice, i))
            width = fmax(width, lattice->points[i].height / 2);
    return width;
}

static void take_in(const Mender *mender, Lattice *lattice)
{
    for (size_t i = 1; i < lattice->n_points; i++) {
        LatticePoint *point = &lattice->points[i];
        if (!is_stopped_up(mender, lattice, i))
            continue;
        point->height = -point->height - 1e-300; /* below 0 also where it is 0 */
        point->is_mended = true;
    }
}

Status mend_make(Mender *mender, Lattice *lattice, ZoneTree *tree, const ZonePlan *plan,
                 double farthest, Patch *patch, double *width, Err *err)
{
    mender->all.n = 0;
    TRY(lattice_list(lattice, tree, plan, &mender->all, err));
    TRY(list_tetrahedra(mender, lattice->n_points, err));
    TRY(mem_reserve(&mender->states, &mender->state_capacity, lattice->n_points,
                    sizeof *mender->states, "points of a junction", err));
    TRY(mem_reserve(&mender->slots, &mender->slot_capacity, lattice->n_points,
                    sizeof *mender->slots, "points of a junction", err));
    for (size_t i = 0; i < lattice->n_points; i++) {
        mender->states[i] = POINT_INSIDE;
        mender->slots[i] = 0;
    }
    *width = HUGE_VAL;
    if (!seed(mender, lattice, tree))
        return STATUS_OK;
    TRY(grow(mender, lattice, err));
    *width = find_width(mender, lattice);
    if (*width > farthest)
        return STATUS_OK;
    take_in(mender, lattice);
    return lattice_cut(lattice, tree, plan, patch, err);
}
