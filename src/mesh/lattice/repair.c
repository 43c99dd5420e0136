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

void repairer_release(Repairer *repairer)
{
    free(repairer->all.items);
    free(repairer->first);
    free(repairer->around);
    free(repairer->states);
    free(repairer->slots);
    free(repairer->heap);
    *repairer = (Repairer){0};
}

/* Fills first[] and around[]. */
static Status list_tetrahedra(Repairer *repairer, size_t n_points, Err *err)
{
    const TetrahedronList *all = &repairer->all;
    TRY(mem_reserve(&repairer->first, &repairer->first_capacity, n_points + 2,
                    sizeof *repairer->first, "points of a junction", err));
    TRY(mem_reserve(&repairer->around, &repairer->around_capacity, 4 * all->n,
                    sizeof *repairer->around, "points of a junction", err));
    for (size_t i = 0; i < n_points + 2; i++)
        repairer->first[i] = 0;
    for (size_t i = 0; i < 4 * all->n; i++)
        repairer->first[all->items[i / 4].at[i % 4] + 2]++;
    for (size_t i = 2; i < n_points + 2; i++)
        repairer->first[i] += repairer->first[i - 1];
    for (size_t i = 0; i < 4 * all->n; i++)
        repairer->around[repairer->first[all->items[i / 4].at[i % 4] + 1]++] = (uint32_t)(i / 4);
    return STATUS_OK;
}

static bool is_lower(const MendItem *a, const MendItem *b)
{
    return a->height != b->height ? a->height > b->height : a->point < b->point;
}

static Status push(Repairer *repairer, MendItem item, Err *err)
{
    TRY(mem_reserve(&repairer->heap, &repairer->heap_capacity, repairer->n_heap + 1,
                    sizeof *repairer->heap, "points of a junction", err));
    size_t at = repairer->n_heap++;
    for (; at > 0 && is_lower(&item, &repairer->heap[(at - 1) / 2]); at = (at - 1) / 2)
        repairer->heap[at] = repairer->heap[(at - 1) / 2];
    repairer->heap[at] = item;
    return STATUS_OK;
}

static MendItem pop(Repairer *repairer)
{
    MendItem *heap = repairer->heap, best = heap[0], last = heap[--repairer->n_heap];
    size_t at = 0, n = repairer->n_heap;
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
static uint32_t place_in_link(const Repairer *repairer, Link *link, uint32_t point)
{
    uint32_t slot = repairer->slots[point];
    if (slot < link->n && link->points[slot] == point)
        return slot;
    if (link->n == MOST_LINK_POINTS)
        return MOST_LINK_POINTS;
    repairer->slots[point] = link->n;
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
static bool join_triangle(const Repairer *repairer, Link *link, const uint32_t at[4], uint32_t self)
{
    uint32_t places[3], n = 0;
    for (int i = 0; i < 4; i++)
        if (at[i] != self &&
            (places[n++] = place_in_link(repairer, link, at[i])) == MOST_LINK_POINTS)
            return false;
    for (int i = 0; i < 3; i++) {
        uint32_t a = places[i], b = places[(i + 1) % 3];
        bool one = repairer->states[link->points[a]] == POINT_OUTSIDE;
        bool other = repairer->states[link->points[b]] == POINT_OUTSIDE;
        if (one == other)
            link->root[root_of(link->root, a)] = root_of(link->root, b);
    }
    return true;
}

/* Fills the link of a point, and tells whether those outside are connected and those inside are. */
static bool is_simple(const Repairer *repairer, uint32_t point, Link *link)
{
    int parts[2] = {0};
    link->n = 0;
    for (uint32_t i = repairer->first[point]; i < repairer->first[point + 1]; i++)
        if (!join_triangle(repairer, link, repairer->all.items[repairer->around[i]].at, point))
            return false;
    for (uint32_t i = 0; i < link->n; i++)
        if (link->root[i] == i)
            parts[repairer->states[link->points[i]] == POINT_OUTSIDE]++;
    return parts[0] == 1 && parts[1] == 1;
}

static Status push_neighbors(Repairer *repairer, const Lattice *lattice, uint32_t point, Err *err)
{
    for (uint32_t i = repairer->first[point]; i < repairer->first[point + 1]; i++)
        for (int k = 0; k < 4; k++) {
            uint32_t other = repairer->all.items[repairer->around[i]].at[k];
            double height = lattice->points[other].height;
            if (repairer->states[other] != POINT_INSIDE || height < 0)
                continue;
            repairer->states[other] = POINT_PENDING;
            TRY(push(repairer, (MendItem){height, other}, err));
        }
    return STATUS_OK;
}

/* The points on the faces of the root, and the centres of the cells there, are the first ones
 * outside. False when one of them is inside. */
static bool seed(Repairer *repairer, const Lattice *lattice, const Octree *tree)
{
    bool outside = true;
    for (size_t i = 0; i < tree->n_cells; i++) {
        const OctreeCell *cell = &tree->cells[i];
        int32_t last = (int32_t)(1 << cell->level) - 1;
        bool at_face = false;
        for (int axis = 0; axis < 3; axis++)
            at_face = at_face || cell->at[axis] == 0 || cell->at[axis] == last;
        if (at_face && lattice->centers[i])
            repairer->states[lattice->centers[i]] = POINT_OUTSIDE;
    }
    for (size_t i = 1; i < lattice->n_points; i++) {
        Vec3 from = vec3_sub(lattice->points[i].x, tree->corner);
        for (int axis = 0; axis < 3; axis++) {
            double along = vec3_component(from, axis) / tree->side;
            if (along < 1e-9 || along > 1 - 1e-9)
                repairer->states[i] = POINT_OUTSIDE;
        }
        outside =
            outside && (repairer->states[i] == POINT_INSIDE || lattice->points[i].height >= 0);
    }
    return outside;
}

static Status grow(Repairer *repairer, const Lattice *lattice, Err *err)
{
    Link link;
    repairer->n_heap = 0;
    for (uint32_t i = 0; i < lattice->n_points; i++)
        if (repairer->states[i] == POINT_OUTSIDE)
            TRY(push_neighbors(repairer, lattice, i, err));
    while (repairer->n_heap) {
        uint32_t point = pop(repairer).point;
        repairer->states[point] = POINT_INSIDE;
        if (!is_simple(repairer, point, &link))
            continue;
        repairer->states[point] = POINT_OUTSIDE;
        TRY(push_neighbors(repairer, lattice, point, err));
    }
    return STATUS_OK;
}

static bool is_stopped_up(const Repairer *repairer, const Lattice *lattice, size_t point)
{
    return lattice->points[point].height >= 0 && repairer->states[point] != POINT_OUTSIDE;
}

/* How far the points that the outside has not reached are from the wall at most, over the local
 * radius; heights are in halves of that. */
static double find_width(const Repairer *repairer, const Lattice *lattice)
{
    double width = 0;
    for (size_t i = 1; i < lattice->n_points; i++)
        if (is_stopped_up(repairer, lattice, i))
            width = fmax(width, lattice->points[i].height / 2);
    return width;
}

static void take_in(const Repairer *repairer, Lattice *lattice)
{
    for (size_t i = 1; i < lattice->n_points; i++) {
        LatticePoint *point = &lattice->points[i];
        if (!is_stopped_up(repairer, lattice, i))
            continue;
        point->height = -point->height - 1e-300; /* below 0 also where it is 0 */
        point->is_repaired = true;
    }
}

Status repair_apply(Repairer *repairer, Lattice *lattice, Octree *tree, const JunctionPlan *plan,
                    double farthest, Patch *patch, double *width, Err *err)
{
    repairer->all.n = 0;
    TRY(lattice_list(lattice, tree, plan, &repairer->all, err));
    TRY(list_tetrahedra(repairer, lattice->n_points, err));
    TRY(mem_reserve(&repairer->states, &repairer->state_capacity, lattice->n_points,
                    sizeof *repairer->states, "points of a junction", err));
    TRY(mem_reserve(&repairer->slots, &repairer->slot_capacity, lattice->n_points,
                    sizeof *repairer->slots, "points of a junction", err));
    for (size_t i = 0; i < lattice->n_points; i++) {
        repairer->states[i] = POINT_INSIDE;
        repairer->slots[i] = 0;
    }
    *width = HUGE_VAL;
    if (!seed(repairer, lattice, tree))
        return STATUS_OK;
    TRY(grow(repairer, lattice, err));
    *width = find_width(repairer, lattice);
    if (*width > farthest)
        return STATUS_OK;
    take_in(repairer, lattice);
    return lattice_cut(lattice, tree, plan, patch, err);
}
