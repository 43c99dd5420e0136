/* Extracts a surface from the lattice of tetrahedra of an octree. O(cells).
 *
 * Three or four leaves meet at each smallest edge of the octree. Two of these leaves that share a
 * face define a tetrahedron: its corners are the centres of the leaves and the two ends of the
 * edge. In a graded octree these tetrahedra fill space, and none is inverted. In an octree of equal
 * cells they are the body-centred cubic lattice, whose tetrahedra are the best known for this
 * purpose [F. Labelle, J. Shewchuk: Isosurface stuffing, SIGGRAPH 2007]. For any signs at the
 * lattice points, the surface that separates the signs is a closed manifold.
 *
 * Three recursions visit cells, faces and edges [T. Ju et al.: Dual contouring of Hermite data,
 * SIGGRAPH 2002]. Lattice points that are almost on the surface are moved away from it, on their
 * own side, so that no triangle becomes a sliver. */
#include "mesh/lattice/lattice.h"

#include <stdlib.h>

/* In units of the cell's side: minimum distance of lattice points from the surface. A smaller
 * distance makes narrower triangles; a larger one moves points so far that tetrahedra near them
 * become flat. */
static const double clearance = 0.1;
/* In units of field_height: a lattice point is tested for its distance from the surface only if its
 * height is below this, which saves the gradients of the other points. A height of 0.3 is 0.15
 * local radii from a lone vessel's surface, while the minimum distance is `clearance` cells, or at
 * most 0.07 radii. */
static const double measured_height = 0.3;
/* Newton steps along an edge end after a step shorter than this fraction of the edge, because the
 * error after such a step is about the square of it; and after MAX_NEWTON_STEPS, where halvings
 * alone have found the crossing to 1e-12 edges. Crossings stay on their edges, because triangles
 * could run into each other if their corners were moved off the edges. */
static const double final_step = 1e-3;
enum { MAX_NEWTON_STEPS = 40 };
/* Away from active cells, all terms of the region are evaluated if there are at most this many.
 * Above it, the terms that matter nearby are selected first, which costs about as much as some
 * evaluations of all terms. The number affects time only. */
enum { MAX_UNNARROWED_TERMS = 512 };

typedef struct LatticeCutter {
    Lattice *lattice;
    const Octree *tree;
    const JunctionPlan *plan;
    Patch *patch;
    Err *err;
    TetrahedronList *list; /* receives all tetrahedra, which are not cut then; NULL: they are cut */
    Octree *away;          /* the tree, if tetrahedra away from active cells count, too; NULL: they
                            * do not */
    LocalField whole;      /* if `away`: all terms, in the stack of the tree */
    LocalField local;      /* if `away`: the terms that matter within local_mm of local_at */
    Vec3 local_at;
    double local_mm;
} LatticeCutter;

void lattice_release(Lattice *lattice)
{
    free(lattice->points);
    ARRAY_RELEASE(&lattice->centers);
    ARRAY_RELEASE(&lattice->crossings);
    keymap_release(&lattice->corners);
    *lattice = (Lattice){0};
}

/* Moves a point by a vector, unless its height would be below the minimum. Returns false if it does
 * not move. */
static bool move_point(const LatticeCutter *cutter, const LocalField *part, Vec3 by,
                       double least_height, LatticePoint *point)
{
    Vec3 moved = vec3_add(point->x, by);
    FieldValue value =
        localfield_value(&cutter->plan->field, &cutter->tree->leaf_fields, part, moved);
    double height = field_height(value.phi);
    if (!(fabs(height) >= least_height))
        return false;
    *point = (LatticePoint){moved, height, NO_CROSSING, false};
    return true;
}

/* Moves a point that is too near to the surface away from it, on its own side. Outside in a crease,
 * the point would come too near to another surface, and is moved to the inside. `side` is the side
 * of the point's cell, mm. */
static void clear_surface(const LatticeCutter *cutter, const LocalField *part, double side,
                          LatticePoint *point)
{
    Vec3 gradient;
    FieldValue value = localfield_gradient(&cutter->plan->field, &cutter->tree->leaf_fields, part,
                                           point->x, &gradient);
    double steepness = vec3_length(gradient), least = clearance * side;
    double inside = (value.phi - FIELD_LEVEL) / steepness; /* mm, about */
    if (!(fabs(inside) < least))
        return;
    double by = (inside >= 0 ? least : -least) - inside;
    double least_height = 0.25 * least * steepness / FIELD_LEVEL; /* half the height at `least` */
    if (!move_point(cutter, part, vec3_scale(gradient, by / steepness), least_height, point))
        move_point(cutter, part, vec3_scale(gradient, (least - inside) / steepness), least_height,
                   point);
}

/* Fills cutter->local with the terms that matter near x. Halves the distance that counts as near,
 * from a sixteenth of the octree's side on, until at most MAX_LOCAL_TERMS terms are left. Gives up
 * after 20 halvings. */
static Status find_local(LatticeCutter *cutter, Vec3 x)
{
    LocalFieldPool *stack = &cutter->away->stack;
    NarrowField narrow;
    const double widest = cutter->away->side / 16;
    double reach = widest;
    do {
        stack->n_terms = cutter->whole.first_term + cutter->whole.n_terms;
        stack->n_groups =
            cutter->whole.first_group + (size_t)cutter->whole.words * cutter->whole.n_groups;
        const FieldBalls balls = {x, reach, reach};
        TRY(localfield_narrow(&cutter->plan->field, stack, &cutter->whole, &balls, &narrow,
                              cutter->err));
        cutter->local = narrow.local;
        cutter->local_at = x;
        cutter->local_mm = reach;
        reach /= 2;
    } while (cutter->local.n_terms > MAX_LOCAL_TERMS && reach > 1e-6 * widest);
    return cutter->local.n_terms > MAX_LOCAL_TERMS ? localfield_too_many_terms(cutter->err)
                                                   : STATUS_OK;
}

/* Finds the terms that matter at a point away from active cells: all terms, or those that matter
 * nearby if there are too many. Points that follow each other are near each other. */
static Status part_away(LatticeCutter *cutter, Vec3 x, const LocalField **part)
{
    bool few = cutter->whole.n_terms <= MAX_UNNARROWED_TERMS;
    if (!few && !(vec3_distance(x, cutter->local_at) < cutter->local_mm))
        TRY(find_local(cutter, x));
    *part = few ? &cutter->whole : &cutter->local;
    return STATUS_OK;
}

/* Adds a lattice point. Its field is that of the cell `from` if that cell is active. */
static Status add_point(LatticeCutter *cutter, const OctreeCell *from, Vec3 x, uint32_t *index)
{
    Lattice *lattice = cutter->lattice;
    TRY(mem_reserve(&lattice->points, &lattice->capacity, lattice->n_points + 1,
                    sizeof *lattice->points, patch_items, cutter->err));
    bool is_near = from && from->state == CELL_ACTIVE;
    FieldValue value;
    if (is_near)
        value = localfield_value(&cutter->plan->field, &cutter->tree->leaf_fields, &from->local, x);
    else {
        const LocalField *part;
        TRY(part_away(cutter, x, &part));
        value = localfield_value(&cutter->plan->field, &cutter->away->stack, part, x);
    }
    LatticePoint point = {x, field_height(value.phi), NO_CROSSING, false};
    if (is_near && fabs(point.height) < measured_height)
        clear_surface(cutter, &from->local, octree_side(cutter->tree, from->level), &point);
    *index = (uint32_t)lattice->n_points;
    lattice->points[lattice->n_points++] = point;
    return STATUS_OK;
}

/* Adds the lattice point at the centre of a cell. */
static Status add_center(LatticeCutter *cutter, const OctreeCell *from, uint32_t cell)
{
    return add_point(cutter, from, octree_center(cutter->tree, &cutter->tree->cells[cell]),
                     &cutter->lattice->centers.items[cell]);
}

/* Finds or adds the lattice point at a corner of cells. `at` is in units of the smallest cells. */
static Status corner_at(LatticeCutter *cutter, const OctreeCell *from, const uint32_t at[3],
                        uint32_t *index)
{
    const Octree *tree = cutter->tree;
    uint64_t key = (uint64_t)at[0] << 42 | (uint64_t)at[1] << 21 | at[2];
    uint32_t *place;
    bool is_new;
    TRY(keymap_put(&cutter->lattice->corners, key, &place, &is_new, cutter->err));
    if (is_new) {
        double unit = octree_side(tree, OCTREE_LEVELS);
        Vec3 x = vec3(tree->corner.x + unit * at[0], tree->corner.y + unit * at[1],
                      tree->corner.z + unit * at[2]);
        TRY(add_point(cutter, from, x, place));
    }
    *index = *place;
    return STATUS_OK;
}

/* Returns FIELD_LEVEL - phi, corrected so that the result, divided by the slope of the field, is
 * the distance to a lone vessel's surface. The correction makes the result linear in the distance
 * to second order, as field_height is. */
static double step_to_surface(double phi)
{
    double lacks = FIELD_LEVEL - phi;
    return fabs(lacks) < 0.5 * phi ? lacks * (1 - 0.375 * lacks / phi) : lacks;
}

/* Finds where the surface crosses the line from a point inside to a point outside, by Newton steps
 * from where it would cross if the height were linear, which it nearly is. A step that would leave
 * the rest of the line halves the rest instead. The end of the last step is not evaluated. */
static PatchPoint find_crossing(const LatticeCutter *cutter, const LocalField *part,
                                const LatticePoint *inside, const LatticePoint *outside)
{
    const JunctionField *field = &cutter->plan->field;
    Vec3 way = vec3_sub(outside->x, inside->x), gradient;
    double low = 0, high = 1, t = inside->height / (inside->height - outside->height);
    for (int i = 0;; i++) {
        Vec3 x = vec3_add_scaled(inside->x, way, t);
        FieldValue value =
            localfield_gradient(field, &cutter->tree->leaf_fields, part, x, &gradient);
        double step = step_to_surface(value.phi) / vec3_dot(gradient, way);
        *(value.phi > FIELD_LEVEL ? &low : &high) = t;
        t += step;
        if (!(t > low && t < high))
            t = 0.5 * (low + high);
        else if (fabs(step) < final_step)
            return patch_surface_point(field, vec3_add_scaled(inside->x, way, t), &value, gradient);
        if (i == MAX_NEWTON_STEPS)
            return patch_surface_point(field, x, &value, gradient);
    }
}

/* Returns the middle of an edge in place of its crossing. Serves edges with a repaired end, which
 * the surface of the field need not cross, and edges away from active cells. */
static Status find_middle(LatticeCutter *cutter, const OctreeCell *from, const LatticePoint *inside,
                          const LatticePoint *outside, PatchPoint *point)
{
    const JunctionField *field = &cutter->plan->field;
    const LocalField *part = from ? &from->local : NULL;
    Vec3 x = vec3_scale(vec3_add(inside->x, outside->x), 0.5), gradient;
    if (!from)
        TRY(part_away(cutter, x, &part));
    const LocalFieldPool *pool = from ? &cutter->tree->leaf_fields : &cutter->away->stack;
    FieldValue value = localfield_gradient(field, pool, part, x, &gradient);
    *point = patch_surface_point(field, x, &value, gradient);
    return STATUS_OK;
}

/* Finds the point of the surface between two lattice points, of which `a` is inside. */
static Status crossing_of(LatticeCutter *cutter, const OctreeCell *from, uint32_t a, uint32_t b,
                          uint32_t *index)
{
    Lattice *lattice = cutter->lattice;
    LatticePoint *points = lattice->points;
    for (*index = points[a].first; *index != NO_CROSSING;
         *index = lattice->crossings.items[*index].next)
        if (lattice->crossings.items[*index].outside == b)
            return STATUS_OK;
    TRY(ARRAY_RESERVE(&lattice->crossings, cutter->patch->n_points + 1, patch_items, cutter->err));
    PatchPoint point;
    if (points[a].is_repaired || !from)
        TRY(find_middle(cutter, from, &points[a], &points[b], &point));
    else
        point = find_crossing(cutter, &from->local, &points[a], &points[b]);
    TRY(patch_add_point(cutter->patch, point, index, cutter->err));
    lattice->crossings.items[*index] = (LatticeCrossing){b, points[a].first};
    points[a].first = *index;
    return STATUS_OK;
}

/* Returns true if a lattice point is inside the surface. */
static bool is_inside(const LatticeCutter *cutter, uint32_t point)
{
    return cutter->lattice->points[point].height < 0;
}

/* Cuts off the corner `lone`, which is alone on its side. others[lone] orders the other corners so
 * that the triangle of the three crossings faces away from the lone corner. */
static Status cut_corner(LatticeCutter *cutter, const OctreeCell *from, const uint32_t corners[4],
                         int lone)
{
    static const int others[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};
    uint32_t apex = corners[lone], at[3];
    bool inside = is_inside(cutter, apex);
    for (int i = 0; i < 3; i++) {
        uint32_t other = corners[others[lone][i]];
        TRY(crossing_of(cutter, from, inside ? apex : other, inside ? other : apex,
                        &at[inside ? i : 2 - i]));
    }
    return patch_add_triangle(cutter->patch, (PatchTriangle){{at[0], at[1], at[2]}}, cutter->err);
}

/* Cuts a tetrahedron (a, b, c, d) of positive volume with a and b inside, c and d outside. The
 * quadrilateral of the crossings is cut along its shorter diagonal. */
static Status cut_middle(LatticeCutter *cutter, const OctreeCell *from, uint32_t a, uint32_t b,
                         uint32_t c, uint32_t d)
{
    uint32_t ac, ad, bc, bd;
    TRY(crossing_of(cutter, from, a, c, &ac));
    TRY(crossing_of(cutter, from, a, d, &ad));
    TRY(crossing_of(cutter, from, b, d, &bd));
    TRY(crossing_of(cutter, from, b, c, &bc));
    const PatchPoint *points = cutter->patch->points;
    bool first =
        vec3_distance(points[ac].x, points[bd].x) <= vec3_distance(points[ad].x, points[bc].x);
    TRY(patch_add_triangle(cutter->patch, (PatchTriangle){{ac, ad, first ? bd : bc}}, cutter->err));
    return patch_add_triangle(cutter->patch, (PatchTriangle){{first ? ac : ad, bd, bc}},
                              cutter->err);
}

/* Cuts a tetrahedron. In all tetrahedra det(at[1] - at[0], at[2] - at[0], at[3] - at[0]) is
 * positive. The orientation of a triangle follows from this. It must not follow from the positions
 * of the crossings, because a triangle may be smaller than the error of these positions. */
static Status cut_tetrahedron(LatticeCutter *cutter, const OctreeCell *from, const uint32_t at[4])
{
    int in[4], out[4], n_in = 0, n_out = 0;
    for (int i = 0; i < 4; i++)
        if (is_inside(cutter, at[i]))
            in[n_in++] = i;
        else
            out[n_out++] = i;
    if (n_in == 1 || n_in == 3)
        return cut_corner(cutter, from, at, n_in == 1 ? in[0] : out[0]);
    if (n_in != 2)
        return STATUS_OK;
    int swap = (in[0] + in[1]) % 2 == 0; /* the order in, out is an odd permutation */
    return cut_middle(cutter, from, at[in[0]], at[in[1]], at[out[swap]], at[out[1 - swap]]);
}

/* Finds the lattice points at the ends of the smallest edge, along `axis`, that four leaves share.
 */
static Status edge_ends(LatticeCutter *cutter, const uint32_t around[4], int axis,
                        const OctreeCell *from, uint32_t ends[2])
{
    const OctreeCell *cells = cutter->tree->cells;
    int smallest = 0;
    for (int i = 1; i < 4; i++)
        if (cells[around[i]].level > cells[around[smallest]].level)
            smallest = i;
    const OctreeCell *cell = &cells[around[smallest]];
    int u = (axis + 1) % 3, v = (axis + 2) % 3, shift = OCTREE_LEVELS - cell->level;
    for (int end = 0; end < 2; end++) {
        uint32_t at[3];
        at[axis] = (uint32_t)(cell->at[axis] + end) << shift;
        at[u] = (uint32_t)(cell->at[u] + 1 - (smallest & 1)) << shift;
        at[v] = (uint32_t)(cell->at[v] + 1 - (smallest >> 1)) << shift;
        TRY(corner_at(cutter, from, at, &ends[end]));
    }
    return STATUS_OK;
}

/* Cuts or lists the tetrahedra about a smallest edge. around[i + 2 j] is the leaf at the lower (0)
 * or upper (1) side along the next axis (i) and along the axis after it (j). */
static Status cut_about_edge(LatticeCutter *cutter, const uint32_t around[4], int axis)
{
    static const int turn[5] = {0, 1, 3, 2, 0};
    const OctreeCell *cells = cutter->tree->cells, *active = NULL;
    bool is_behind = false;
    for (int i = 0; i < 4; i++) {
        is_behind = is_behind || cells[around[i]].state == CELL_BEYOND_PLANE;
        if (cells[around[i]].state == CELL_ACTIVE)
            active = &cells[around[i]];
    }
    if (((!active && !cutter->away) || is_behind) && !cutter->list)
        return STATUS_OK;
    uint32_t at[4], *centers = cutter->lattice->centers.items;
    TRY(edge_ends(cutter, around, axis, active, at));
    for (int i = 0; i < 4; i++) {
        uint32_t a = around[turn[i]], b = around[turn[i + 1]];
        const OctreeCell *from = cells[a].state == CELL_ACTIVE ? &cells[a] : &cells[b];
        from = from->state == CELL_ACTIVE ? from : NULL;
        if (a == b || (!from && !cutter->away))
            continue;
        TRY(centers[a] ? STATUS_OK : add_center(cutter, from, a));
        TRY(centers[b] ? STATUS_OK : add_center(cutter, from, b));
        at[2] = centers[a];
        at[3] = centers[b];
        TRY(cutter->list ? ARRAY_PUSH(cutter->list, patch_items, cutter->err,
                                      (Tetrahedron){{at[0], at[1], at[2], at[3]}})
                         : cut_tetrahedron(cutter, from, at));
    }
    return STATUS_OK;
}

/* Returns the child of a cell at these halves along the axes, or the cell itself if it is a leaf.
 */
static uint32_t child_of(const LatticeCutter *cutter, uint32_t cell, const int half[3])
{
    uint32_t children = cutter->tree->cells[cell].children;
    return children ? children + (uint32_t)(half[0] | half[1] << 1 | half[2] << 2) : cell;
}

static bool is_leaf(const LatticeCutter *cutter, uint32_t cell)
{
    return cutter->tree->cells[cell].children == 0;
}

/* Returns true if the cells have tetrahedra to handle: if one of them is active, or if tetrahedra
 * away from active cells count. A cell that is not active has no active cell below it. */
static bool may_cut(const LatticeCutter *cutter, const uint32_t *cells, int n)
{
    bool may = cutter->away != NULL;
    for (int i = 0; i < n && !may; i++)
        may = cutter->tree->cells[cells[i]].state == CELL_ACTIVE;
    return may;
}

/* Visits the edges, along `axis`, that four cells share. `around` is ordered as in cut_about_edge.
 */
static Status walk_edge(LatticeCutter *cutter, const uint32_t around[4], int axis)
{
    if (!may_cut(cutter, around, 4))
        return STATUS_OK;
    if (is_leaf(cutter, around[0]) && is_leaf(cutter, around[1]) && is_leaf(cutter, around[2]) &&
        is_leaf(cutter, around[3]))
        return cut_about_edge(cutter, around, axis);
    for (int along = 0; along < 2; along++) {
        uint32_t parts[4];
        for (int i = 0; i < 4; i++) {
            int half[3];
            half[axis] = along;
            half[(axis + 1) % 3] = 1 - (i & 1);
            half[(axis + 2) % 3] = 1 - (i >> 1);
            parts[i] = child_of(cutter, around[i], half);
        }
        TRY(walk_edge(cutter, parts, axis));
    }
    return STATUS_OK;
}

/* Visits the edges along `axis` in the face between two cells. `normal` is the normal of the face.
 */
static Status walk_face_edges(LatticeCutter *cutter, const uint32_t sides[2], int normal, int axis)
{
    for (int along = 0; along < 2; along++) {
        uint32_t around[4];
        for (int i = 0; i < 4; i++) {
            int upper[3] = {0}, half[3];
            upper[(axis + 1) % 3] = i & 1;
            upper[(axis + 2) % 3] = i >> 1;
            for (int k = 0; k < 3; k++)
                half[k] = k == axis ? along : k == normal ? 1 - upper[k] : upper[k];
            around[i] = child_of(cutter, sides[upper[normal]], half);
        }
        TRY(walk_edge(cutter, around, axis));
    }
    return STATUS_OK;
}

/* Visits the smaller faces in the face between two cells, and the edges in its middle. */
static Status walk_face(LatticeCutter *cutter, const uint32_t sides[2], int normal)
{
    if (!may_cut(cutter, sides, 2) || (is_leaf(cutter, sides[0]) && is_leaf(cutter, sides[1])))
        return STATUS_OK;
    for (int i = 0; i < 4; i++) {
        uint32_t parts[2];
        for (int side = 0; side < 2; side++) {
            int half[3];
            half[normal] = 1 - side;
            half[(normal + 1) % 3] = i & 1;
            half[(normal + 2) % 3] = i >> 1;
            parts[side] = child_of(cutter, sides[side], half);
        }
        TRY(walk_face(cutter, parts, normal));
    }
    for (int k = 1; k < 3; k++)
        TRY(walk_face_edges(cutter, sides, normal, (normal + k) % 3));
    return STATUS_OK;
}

/* Visits the two edges along `axis` at which four of the eight children of a cell meet. */
static Status walk_inner_edges(LatticeCutter *cutter, uint32_t children, int axis)
{
    for (uint32_t along = 0; along < 2; along++) {
        uint32_t around[4];
        for (uint32_t i = 0; i < 4; i++)
            around[i] = children + (along << axis) + ((i & 1) << (axis + 1) % 3) +
                        ((i >> 1) << (axis + 2) % 3);
        TRY(walk_edge(cutter, around, axis));
    }
    return STATUS_OK;
}

/* Visits all children of a cell, the faces between them, and the edges between them. */
static Status walk_cell(LatticeCutter *cutter, uint32_t cell)
{
    if (is_leaf(cutter, cell) || !may_cut(cutter, &cell, 1))
        return STATUS_OK;
    uint32_t children = cutter->tree->cells[cell].children;
    for (uint32_t i = 0; i < 8; i++)
        TRY(walk_cell(cutter, children + i));
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t lower = children + ((i & 1) << (axis + 1) % 3) + ((i >> 1) << (axis + 2) % 3);
            const uint32_t sides[2] = {lower, lower + (1u << axis)};
            TRY(walk_face(cutter, sides, axis));
        }
        TRY(walk_inner_edges(cutter, children, axis));
    }
    return STATUS_OK;
}

/* Visits all cells, also those away from active cells. */
static Status walk_all(LatticeCutter *cutter)
{
    Octree *tree = cutter->away;
    TRY(localfield_from_field(&cutter->plan->field, &tree->stack, &cutter->whole, cutter->err));
    Status status = walk_cell(cutter, 0);
    tree->stack.n_terms = tree->stack.n_groups = 0;
    return status;
}

static void begin_cut(Lattice *lattice, Patch *patch)
{
    patch->n_points = patch->n_triangles = 0;
    for (size_t i = 0; i < lattice->n_points; i++)
        lattice->points[i].first = NO_CROSSING;
}

Status lattice_make(Lattice *lattice, const JunctionSurface *surface, Err *err)
{
    const Octree *tree = surface->tree;
    LatticeCutter cutter = {lattice, tree, surface->plan, surface->patch, err, .list = NULL};
    TRY(keymap_begin(&lattice->corners, tree->n_cells / 2, patch_items, err));
    TRY(ARRAY_RESERVE(&lattice->centers, tree->n_cells, patch_items, err));
    for (size_t i = 0; i < tree->n_cells; i++)
        lattice->centers.items[i] = 0;
    TRY(mem_reserve(&lattice->points, &lattice->capacity, 1, sizeof *lattice->points, patch_items,
                    err));
    lattice->n_points = 1; /* the first is not used, so that 0 means "not made yet" */
    begin_cut(lattice, surface->patch);
    return walk_cell(&cutter, 0);
}

Status lattice_extract_again(Lattice *lattice, const JunctionSurface *surface, Err *err)
{
    LatticeCutter cutter = {lattice,        surface->tree, surface->plan,
                            surface->patch, err,           .away = surface->tree};
    begin_cut(lattice, surface->patch);
    return walk_all(&cutter);
}

Status lattice_list(Lattice *lattice, const JunctionSurface *surface, TetrahedronList *list,
                    Err *err)
{
    LatticeCutter cutter = {lattice, surface->tree, surface->plan,        NULL,
                            err,     list,          .away = surface->tree};
    return walk_all(&cutter);
}
