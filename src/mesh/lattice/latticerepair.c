/* Where two vessels that do not blend part at a small angle, the groove between their surfaces is
 * narrower at its bottom than any cell. The lattice points that happen to be in the groove make
 * tunnels and hollows, and there are more of them the smaller the cells are. So the remedy is not a
 * finer lattice, but a surface of the right topology.
 *
 * The outside is grown anew, from the faces of the octree's root inwards, over the points whose
 * field is below the level. The point with the lowest field comes first. A point is added to the
 * outside only if that does not change the topology. The points about it, with their triangles,
 * form a sphere. Those of them that are outside must be connected, and those that are inside must
 * be, too [G. Bertrand: Simple points, topological numbers and geodesic neighborhoods in cubic
 * grids, 1994, for tetrahedra]. The outside of a sphere is a ball and stays one, so the inside is
 * one, too. A tunnel is entered from both its ends, and is closed where its points are nearest to
 * the surface. If the vessels of the region form loops, as many tunnels are wanted. The widest ones
 * are opened then: at a point whose neighbours outside have two parts, and those inside one. */
#include "mesh/lattice/latticerepair.h"

#include <stdlib.h>

/* A point with more points about it stays inside. */
enum { MAX_LINK = 256 };
static const char what[] = "points of a junction";

/* Points that are outside by their field, and that wait in the heap, are pending. */
typedef enum PointState { POINT_INSIDE, POINT_PENDING, POINT_OUTSIDE } PointState;

/* The points about one, and their sets [base/sets.h]. */
typedef struct PointLink {
    uint32_t points[MAX_LINK], root[MAX_LINK];
    uint32_t n;
} PointLink;

void repairer_release(Repairer *repairer)
{
    ARRAY_RELEASE(&repairer->all);
    indexlists_release(&repairer->around);
    ARRAY_RELEASE(&repairer->states);
    ARRAY_RELEASE(&repairer->slots);
    ARRAY_RELEASE(&repairer->heap);
}

/* Returns the position of a point in the link, after adding it if it is not there; MAX_LINK if
 * there is no room. */
static uint32_t place_in_link(const Repairer *repairer, PointLink *link, uint32_t point)
{
    uint32_t slot = repairer->slots.items[point];
    if (slot < link->n && link->points[slot] == point)
        return slot;
    if (link->n == MAX_LINK)
        return MAX_LINK;
    repairer->slots.items[point] = link->n;
    link->points[link->n] = point;
    link->root[link->n] = link->n;
    return link->n++;
}

/* Joins the points of a tetrahedron, except `self`, that are on one side. Returns false if there
 * are too many points. */
static bool join_triangle(const Repairer *repairer, PointLink *link, const uint32_t at[4],
                          uint32_t self)
{
    uint32_t places[3], n = 0;
    for (int i = 0; i < 4; i++)
        if (at[i] != self && (places[n++] = place_in_link(repairer, link, at[i])) == MAX_LINK)
            return false;
    for (int i = 0; i < 3; i++) {
        uint32_t a = places[i], b = places[(i + 1) % 3];
        bool one = repairer->states.items[link->points[a]] == POINT_OUTSIDE;
        bool other = repairer->states.items[link->points[b]] == POINT_OUTSIDE;
        if (one == other)
            sets_join(link->root, a, b);
    }
    return true;
}

/* Fills the link of a point. Returns true if its points inside are connected, and its points
 * outside have this number of parts. */
static bool has_parts(const Repairer *repairer, uint32_t point, int outside, PointLink *link)
{
    const IndexLists *around = &repairer->around;
    int parts[2] = {0};
    link->n = 0;
    for (uint32_t i = around->first[point]; i < around->first[point + 1]; i++)
        if (!join_triangle(repairer, link, repairer->all.items[around->items[i]].at, point))
            return false;
    for (uint32_t i = 0; i < link->n; i++)
        if (link->root[i] == i)
            parts[repairer->states.items[link->points[i]] == POINT_OUTSIDE]++;
    return parts[0] == 1 && parts[1] == outside;
}

static Status push_neighbors(Repairer *repairer, const Lattice *lattice, uint32_t point, Err *err)
{
    const IndexLists *around = &repairer->around;
    for (uint32_t i = around->first[point]; i < around->first[point + 1]; i++)
        for (int k = 0; k < 4; k++) {
            uint32_t other = repairer->all.items[around->items[i]].at[k];
            double height = lattice->points[other].height;
            if (repairer->states.items[other] != POINT_INSIDE || height < 0)
                continue;
            repairer->states.items[other] = POINT_PENDING;
            TRY(heap_push(&repairer->heap, (HeapItem){-height, other, other}, what, err));
        }
    return STATUS_OK;
}

/* Makes the points on the faces of the root, and the centres of the cells there, the first points
 * outside. Returns false if one of them is inside. */
static bool seed(Repairer *repairer, const Lattice *lattice, const Octree *tree)
{
    bool outside = true;
    for (size_t i = 0; i < tree->n_cells; i++) {
        const OctreeCell *cell = &tree->cells[i];
        int32_t last = (int32_t)(1 << cell->level) - 1;
        bool at_face = false;
        for (int axis = 0; axis < 3; axis++)
            at_face = at_face || cell->at[axis] == 0 || cell->at[axis] == last;
        if (at_face && lattice->centers.items[i])
            repairer->states.items[lattice->centers.items[i]] = POINT_OUTSIDE;
    }
    for (size_t i = 1; i < lattice->n_points; i++) {
        Vec3 from = vec3_sub(lattice->points[i].x, tree->corner);
        for (int axis = 0; axis < 3; axis++) {
            double along = vec3_component(from, axis) / tree->side;
            if (along < 1e-9 || along > 1 - 1e-9)
                repairer->states.items[i] = POINT_OUTSIDE;
        }
        outside = outside &&
                  (repairer->states.items[i] == POINT_INSIDE || lattice->points[i].height >= 0);
    }
    return outside;
}

static Status add_outside(Repairer *repairer, const Lattice *lattice, uint32_t point, Err *err)
{
    repairer->states.items[point] = POINT_OUTSIDE;
    return push_neighbors(repairer, lattice, point, err);
}

static Status grow(Repairer *repairer, const Lattice *lattice, Err *err)
{
    PointLink link;
    while (repairer->heap.n) {
        uint32_t point = heap_pop(&repairer->heap).value;
        repairer->states.items[point] = POINT_INSIDE;
        if (has_parts(repairer, point, 1, &link))
            TRY(add_outside(repairer, lattice, point, err));
    }
    return STATUS_OK;
}

static bool is_closed_up(const Repairer *repairer, const Lattice *lattice, size_t point)
{
    return lattice->points[point].height >= 0 && repairer->states.items[point] != POINT_OUTSIDE;
}

/* Opens the widest tunnel that the outside was kept from, if there is one: adds the point that is
 * farthest from the surface. */
static Status open_tunnel(Repairer *repairer, const Lattice *lattice, Err *err)
{
    PointLink link;
    uint32_t best = 0;
    for (uint32_t i = 1; i < lattice->n_points; i++)
        if (is_closed_up(repairer, lattice, i) && has_parts(repairer, i, 2, &link) &&
            (best == 0 || lattice->points[i].height > lattice->points[best].height))
            best = i;
    if (best)
        TRY(add_outside(repairer, lattice, best, err));
    return grow(repairer, lattice, err);
}

/* Returns the maximum distance from the surface of the points that the outside has not reached, in
 * local radii. Heights are in halves of that. */
static double find_width(const Repairer *repairer, const Lattice *lattice)
{
    double width = 0;
    for (size_t i = 1; i < lattice->n_points; i++)
        if (is_closed_up(repairer, lattice, i))
            width = fmax(width, lattice->points[i].height / 2);
    return width;
}

static void take_in(const Repairer *repairer, Lattice *lattice)
{
    for (size_t i = 1; i < lattice->n_points; i++) {
        LatticePoint *point = &lattice->points[i];
        if (!is_closed_up(repairer, lattice, i))
            continue;
        point->height = -point->height - 1e-300; /* below 0 also where it is 0 */
        point->is_repaired = true;
    }
}

static Status prepare(Repairer *repairer, Lattice *lattice, const JunctionSurface *surface,
                      Err *err)
{
    TetrahedronList *all = &repairer->all;
    all->n = 0;
    TRY(lattice_list(lattice, surface, all, err));
    TRY(indexlists_sort(&repairer->around, lattice->n_points,
                        (ItemKeys){(const uint32_t *)all->items, all->n, 4}, what, err));
    TRY(ARRAY_RESERVE(&repairer->states, lattice->n_points, what, err));
    TRY(ARRAY_RESERVE(&repairer->slots, lattice->n_points, what, err));
    for (size_t i = 0; i < lattice->n_points; i++) {
        repairer->states.items[i] = POINT_INSIDE;
        repairer->slots.items[i] = 0;
    }
    return STATUS_OK;
}

Status repair_apply(Repairer *repairer, Lattice *lattice, const JunctionSurface *surface,
                    double farthest, double *width, Err *err)
{
    *width = HUGE_VAL;
    TRY(prepare(repairer, lattice, surface, err));
    if (!seed(repairer, lattice, surface->tree))
        return STATUS_OK;
    repairer->heap.n = 0;
    for (uint32_t i = 0; i < lattice->n_points; i++)
        if (repairer->states.items[i] == POINT_OUTSIDE)
            TRY(push_neighbors(repairer, lattice, i, err));
    TRY(grow(repairer, lattice, err));
    for (size_t i = 0; i < surface->plan->n_loops; i++)
        TRY(open_tunnel(repairer, lattice, err));
    *width = find_width(repairer, lattice);
    if (*width > farthest)
        return STATUS_OK;
    take_in(repairer, lattice);
    return lattice_cut(lattice, surface, err);
}
