/* Connections are made with a reserve for vessels to widen [place.c], which some few outgrow. Each
 * segment that breaks a rule in the end has bifurcations at its ends: the nearest place where the
 * three segments that meet there keep all rules is looked for on rays from the present one, ever
 * further out. Every move changes all radii a little, so this goes round until a round finds nothing
 * to do.
 *
 * Suspects are found from the grid alone, cell by cell, in single precision with room for its
 * rounding; all else is double. */
#include "grow/mend.h"

#include <stdlib.h>

enum { ROUNDS = 8 };
/* Ways out are those to the points of a lattice up to so many steps from its middle. */
enum { SPREAD = 3 };
/* Of clearances, for the rounding of the grid's items. */
static const double suspicion = 1.001;
/* What a bifurcation that moves leaves between the vessels, over their radii. */
static const double reserve = 1.01;
/* How far bifurcations move, over the radius of the vessel that is in the way. */
static const double first_step = 0.05, step_growth = 1.5, last_step = 8;

typedef struct Mending {
    Network *net;
    Grid *grid;
    const Domain *domain;
    const Rules *rules;
    int32_t *suspect; /* segments, some perhaps more than once */
    size_t n_suspects, capacity;
} Mending;

static bool have_common_node(const Network *net, int32_t i, int32_t j)
{
    int32_t from_i = net->segment[i].parent, from_j = net->segment[j].parent;
    return from_i == from_j || from_i == j || from_j == i;
}

/* Whether the segment, were it from `a` to `b`, would keep the rules with its vessel and all others
 * wider by `factor`. Those that begin or end at `moving` do not count. */
static bool is_right(const Mending *mending, int32_t i, Vec3 a, Vec3 b, double factor,
                     int32_t moving)
{
    const Network *net = mending->net;
    const Grid *grid = mending->grid;
    double scale = factor * mending->rules->thickness, radius = (double)net->segment[i].radius;
    if (vec3_distance(a, b) < 2 * scale * radius)
        return false;
    GridItem item = grid_item(grid, (Capsule){a, b, scale * radius + mending->rules->gap}, radius);
    size_t cell;
    for (GridWalk walk = grid_walk(grid, &item); grid_walk_next(&walk, &cell);) {
        for (uint32_t k = 0; k < grid->cell[cell].count; k++) {
            int32_t j = grid->cell[cell].tag[k] >> 1;
            if (j == i || j == moving || net->segment[j].parent == moving ||
                have_common_node(net, i, j))
                continue;
            double clearance =
                scale * (radius + (double)net->segment[j].radius) + mending->rules->gap;
            if (segment_distance2(a, b, net->position[net->segment[j].parent], net->position[j]) <
                clearance * clearance)
                return false;
        }
    }
    return true;
}

/* The segments that meet at bifurcation `node`: the one above and its daughters. */
static void meeting_at(const Network *net, int32_t node, int32_t segment[3])
{
    segment[0] = node;
    segment[1] = net->segment[node].child[0];
    segment[2] = net->segment[node].child[1];
}

static bool has_room_at(const Mending *mending, int32_t node, Vec3 place)
{
    const Network *net = mending->net;
    if (!domain_inside(mending->domain, place, 0))
        return false;
    int32_t segment[3];
    meeting_at(net, node, segment);
    for (int k = 0; k < 3; k++) {
        Vec3 other = net->position[k == 0 ? net->segment[node].parent : segment[k]];
        if (!domain_is_convex(mending->domain) &&
            !domain_holds_segment(mending->domain, other, place))
            return false;
        if (!is_right(mending, segment[k], other, place, reserve, node))
            return false;
    }
    return true;
}

static Status move_to(Mending *mending, int32_t node, Vec3 place, Err *err)
{
    Network *net = mending->net;
    int32_t segment[3];
    meeting_at(net, node, segment);
    for (int k = 0; k < 3; k++)
        grid_remove(mending->grid, segment[k]);
    network_move(net, node, place);
    for (int k = 0; k < 3; k++) {
        Capsule capsule = network_capsule(net, segment[k]);
        double radius = capsule.radius;
        capsule.radius = place_reach(mending->rules, radius);
        TRY(grid_add(mending->grid, 0, segment[k], net->segment[segment[k]].child[0] < 0,
                     grid_item(mending->grid, capsule, radius), err));
    }
    return STATUS_OK;
}

/* Moves the bifurcation to the nearest place with room; *done tells whether there is one. */
static Status nudge(Mending *mending, int32_t node, double radius, bool *done, Err *err)
{
    const Network *net = mending->net;
    Vec3 from = net->position[node];
    int depth = domain_dimension(mending->domain) == 3 ? SPREAD : 0;
    for (double step = first_step; step < last_step; step *= step_growth)
        for (int z = -depth; z <= depth; z++)
            for (int y = -SPREAD; y <= SPREAD; y++)
                for (int x = -SPREAD; x <= SPREAD; x++) {
                    Vec3 way = vec3(x, y, z);
                    double length = vec3_length(way);
                    if (!(length > 0))
                        continue;
                    Vec3 place = vec3_add_scaled(from, way, step * radius / length);
                    if (has_room_at(mending, node, place)) {
                        *done = true;
                        return move_to(mending, node, place, err);
                    }
                }
    return STATUS_OK;
}

static Status mend_segment(Mending *mending, int32_t i, bool *done, Err *err)
{
    const Network *net = mending->net;
    const int32_t ends[2] = {i, net->segment[i].parent};
    for (int k = 0; k < 2 && !*done; k++)
        if (ends[k] != 0 && net->segment[ends[k]].child[1] >= 0)
            TRY(nudge(mending, ends[k], (double)net->segment[i].radius, done, err));
    return STATUS_OK;
}

static Status suspect(Mending *mending, int32_t i, Err *err)
{
    TRY(mem_reserve(&mending->suspect, &mending->capacity, mending->n_suspects + 1,
                    sizeof *mending->suspect, "segments to mend", err));
    mending->suspect[mending->n_suspects++] = i;
    return STATUS_OK;
}

static bool are_one(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Whether the items' vessels may overlap, and not just meet at a node. */
static bool may_overlap(const GridItem *a, const GridItem *b, double thickness)
{
    float along = 0, apart = 0; /* squares of their lengths together, and of twice their distance */
    for (int k = 0; k < 3; k++) {
        float ua = a->distal[k] - a->proximal[k], ub = b->distal[k] - b->proximal[k];
        float between = a->proximal[k] + a->distal[k] - b->proximal[k] - b->distal[k];
        along += ua * ua + ub * ub;
        apart += between * between;
    }
    double clearance = suspicion * thickness * ((double)a->radius + (double)b->radius);
    double reach = sqrt(2 * (double)along) + 2 * clearance; /* u + v <= sqrt(2 (u^2 + v^2)) */
    if ((double)apart > reach * reach || are_one(a->proximal, b->distal) ||
        are_one(a->distal, b->proximal) || are_one(a->proximal, b->proximal))
        return false;
    return segment_distance2(place_point(a->proximal), place_point(a->distal),
                             place_point(b->proximal),
                             place_point(b->distal)) < clearance * clearance;
}

static Status suspect_pairs(Mending *mending, const GridCell *cell, Err *err)
{
    for (uint32_t p = 1; p < cell->count; p++)
        for (uint32_t q = 0; q < p; q++) {
            int32_t i = cell->tag[p] >> 1, j = cell->tag[q] >> 1;
            const GridItem *item = mending->grid->item;
            if (!may_overlap(&item[i], &item[j], mending->rules->thickness))
                continue;
            TRY(suspect(mending, i, err));
            TRY(suspect(mending, j, err));
        }
    return STATUS_OK;
}

static Status find_suspects(Mending *mending, Err *err)
{
    const Network *net = mending->net;
    mending->n_suspects = 0;
    for (size_t i = 1; i < net->n; i++) {
        const Segment *segment = &net->segment[i];
        mending->grid->item[i].radius = segment->radius;
        if (segment->length < 2 * mending->rules->thickness * (double)segment->radius)
            TRY(suspect(mending, (int32_t)i, err));
    }
    size_t cells = grid_cells(mending->grid);
    for (size_t k = 0; k < cells; k++)
        TRY(suspect_pairs(mending, &mending->grid->cell[k], err));
    return STATUS_OK;
}

/* Whether anything has moved, in *moved. */
static Status mend_suspects(Mending *mending, bool *moved, Err *err)
{
    const Network *net = mending->net;
    for (size_t k = 0; k < mending->n_suspects; k++) {
        int32_t i = mending->suspect[k];
        bool done = false;
        if (!is_right(mending, i, net->position[net->segment[i].parent], net->position[i], 1, -2))
            TRY(mend_segment(mending, i, &done, err));
        *moved = *moved || done;
    }
    return STATUS_OK;
}

Status mend_network(Network *net, Grid *grid, const Domain *domain, const Rules *rules, Err *err)
{
    Mending mending = {.net = net, .grid = grid, .domain = domain, .rules = rules};
    Status status = STATUS_OK;
    bool moved = true;
    for (int round = 0; moved && round < ROUNDS; round++) {
        moved = false;
        network_refresh(net);
        TRY_GOTO(find_suspects(&mending, err));
        TRY_GOTO(mend_suspects(&mending, &moved, err));
    }
done:
    free(mending.suspect);
    return status;
}
