/* Closes tunnels and hollows in the lattice of a junction region that the exact surface does not
 * have.
 *
 * Where two vessels that do not blend part at a small angle, the groove between their surfaces is
 * narrower at its bottom than any cell. The lattice points that happen to be in the groove make
 * tunnels and hollows. Smaller cells make more of them. So the remedy is not a
 * finer lattice, but a surface of the right topology.
 *
 * The outside is grown anew, from the faces of the octree's root inwards, over the lattice points
 * whose field is below the level. The point with the lowest field comes first. A point is added to
 * the outside only if the addition does not change the topology. The neighbours of a point, with
 * the triangles between them, form a sphere: the point's link. The topology stays if the neighbours
 * outside are connected, and the neighbours inside are connected, too [G. Bertrand: Simple points,
 * topological numbers and geodesic neighborhoods in cubic grids, 1994, here for tetrahedra]. At
 * first the outside is the complement of a ball. So the inside stays a ball. A tunnel is entered
 * from both its ends, and is closed where its points are nearest to the surface.
 *
 * If the vessels of the region form loops, one tunnel per loop is wanted. Then the widest tunnels
 * are opened again, each at a point whose neighbours outside have two parts, and whose neighbours
 * inside have one. O(points log points), and O(points) per loop. */
#include "mesh/lattice/latticerepair.h"

#include <stdlib.h>

/* Capacity of a PointLink, which is on the stack. A point with more neighbours stays inside. A
 * regular lattice point has 14 neighbours; grading makes more, but far fewer than 256. */
enum { MAX_LINK = 256 };

/* Pending points are outside by their field, and wait in the heap. */
typedef enum PointState { POINT_INSIDE, POINT_PENDING, POINT_OUTSIDE } PointState;

/* The state of one repair. All arrays are owned. */
typedef struct Repairer {
    TetrahedronList all; /* all tetrahedra of the octree */
    IndexLists around;   /* per lattice point: its tetrahedra */
    uint8_t *states;     /* per lattice point: PointState */
    uint32_t *slots;     /* per lattice point: its position in the current link */
    Heap heap;           /* points that may be added to the outside, lowest field first */
} Repairer;

/* The neighbours of a point, and their disjoint sets [base/sets.h]. */
typedef struct PointLink {
    uint32_t points[MAX_LINK], root[MAX_LINK];
    uint32_t n;
} PointLink;

/* Returns the position of a point in the link, after adding it if it is not there; MAX_LINK if
 * there is no room. */
static uint32_t place_in_link(const Repairer *repairer, PointLink *link, uint32_t point)
{
    uint32_t slot = repairer->slots[point];
    if (slot < link->n && link->points[slot] == point)
        return slot;
    if (link->n == MAX_LINK)
        return MAX_LINK;
    repairer->slots[point] = link->n;
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
        bool one = repairer->states[link->points[a]] == POINT_OUTSIDE;
        bool other = repairer->states[link->points[b]] == POINT_OUTSIDE;
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
            parts[repairer->states[link->points[i]] == POINT_OUTSIDE]++;
    return parts[0] == 1 && parts[1] == outside;
}

/* Adds the neighbours of a point that are outside by their field to the heap, unless they are
 * pending or outside already. */
static Status push_neighbors(Repairer *repairer, const Lattice *lattice, uint32_t point, Err *err)
{
    const IndexLists *around = &repairer->around;
    for (uint32_t i = around->first[point]; i < around->first[point + 1]; i++)
        for (int k = 0; k < 4; k++) {
            uint32_t other = repairer->all.items[around->items[i]].at[k];
            double height = lattice->points[other].height;
            if (repairer->states[other] != POINT_INSIDE || height < 0)
                continue;
            repairer->states[other] = POINT_PENDING;
            TRY(heap_push(&repairer->heap, (HeapItem){-height, other, other}, patch_items, err));
        }
    return STATUS_OK;
}

/* Makes the points on the faces of the root, and the centres of the cells there, the first points
 * outside. Returns false if one of them is inside by its field. 1e-9 of the side absorbs rounding:
 * it is far smaller than a cell. */
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
            repairer->states[lattice->centers.items[i]] = POINT_OUTSIDE;
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

/* Moves a point to the outside, and adds its neighbours to the heap. */
static Status add_outside(Repairer *repairer, const Lattice *lattice, uint32_t point, Err *err)
{
    repairer->states[point] = POINT_OUTSIDE;
    return push_neighbors(repairer, lattice, point, err);
}

/* Adds points to the outside, the lowest field first, until no point can be added. A point that
 * cannot be added now may be pushed again by a later neighbour. */
static Status grow(Repairer *repairer, const Lattice *lattice, Err *err)
{
    PointLink link;
    while (repairer->heap.n) {
        uint32_t point = heap_pop(&repairer->heap).value;
        repairer->states[point] = POINT_INSIDE;
        if (has_parts(repairer, point, 1, &link))
            TRY(add_outside(repairer, lattice, point, err));
    }
    return STATUS_OK;
}

static bool is_closed_up(const Repairer *repairer, const Lattice *lattice, size_t point)
{
    return lattice->points[point].height >= 0 && repairer->states[point] != POINT_OUTSIDE;
}

/* Opens the widest closed tunnel, if there is one: adds the closed point that is farthest from the
 * surface to the outside. */
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

/* Turns the lattice points that the outside has not reached into points inside. */
static void take_in(const Repairer *repairer, Lattice *lattice)
{
    for (size_t i = 1; i < lattice->n_points; i++) {
        LatticePoint *point = &lattice->points[i];
        if (!is_closed_up(repairer, lattice, i))
            continue;
        point->height = -point->height - 1e-300; /* below 0 also if the height is 0 */
        point->is_repaired = true;
    }
}

/* Lists all tetrahedra of the octree, and the tetrahedra at each point. */
static Status prepare(Repairer *repairer, Lattice *lattice, const JunctionSurface *surface,
                      Err *err)
{
    TetrahedronList *all = &repairer->all;
    TRY(lattice_list(lattice, surface, all, err));
    TRY(indexlists_sort(&repairer->around, lattice->n_points,
                        (ItemKeys){(const uint32_t *)all->items, all->n, 4}, patch_items, err));
    size_t n = lattice->n_points;
    TRY(mem_calloc(&repairer->states, n, sizeof *repairer->states, patch_items, err));
    return mem_calloc(&repairer->slots, n, sizeof *repairer->slots, patch_items, err);
}

/* Grows the outside, and opens one tunnel per loop. */
static Status grow_outside(Repairer *repairer, const Lattice *lattice, size_t n_loops, Err *err)
{
    for (uint32_t i = 0; i < lattice->n_points; i++)
        if (repairer->states[i] == POINT_OUTSIDE)
            TRY(push_neighbors(repairer, lattice, i, err));
    TRY(grow(repairer, lattice, err));
    for (size_t i = 0; i < n_loops; i++)
        TRY(open_tunnel(repairer, lattice, err));
    return STATUS_OK;
}

Status lattice_repair(Lattice *lattice, const JunctionSurface *surface, double max_distance,
                      double *distance, Err *err)
{
    Repairer repairer = {0};
    Status status;
    *distance = HUGE_VAL;
    TRY_GOTO(prepare(&repairer, lattice, surface, err));
    if (seed(&repairer, lattice, surface->tree)) {
        TRY_GOTO(grow_outside(&repairer, lattice, surface->plan->n_loops, err));
        *distance = find_width(&repairer, lattice);
    }
    if (*distance <= max_distance) {
        take_in(&repairer, lattice);
        TRY_GOTO(lattice_extract_again(lattice, surface, err));
    }
done:
    ARRAY_RELEASE(&repairer.all);
    indexlists_release(&repairer.around);
    free(repairer.states);
    free(repairer.slots);
    ARRAY_RELEASE(&repairer.heap);
    return status;
}
