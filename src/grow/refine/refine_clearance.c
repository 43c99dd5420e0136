/* Decides whether a move of the refinement keeps vessels clear of each other, by reserved radii,
 * and distributes the reserved radii.
 *
 * Radii change all over the tree with every move, so testing only the moved segments cannot keep
 * vessels clear. Therefore every segment has a reserved radius slightly above its own radius. No
 * other vessel's reserved radius meets it, and it is at most half the segment's length. While every
 * radius stays within its reservation, the rules hold for the whole tree; one number at the root
 * shows whether that is so [Branch.utilisation]. If a move makes a radius exceed its reservation,
 * it must find more room for the segment, or it is undone (clearance_allows: reserve_moved, then
 * arbor_find_overuse until there is none).
 *
 * clearance_reserve distributes the room between segments. First every segment requests its radius
 * plus the reserve. Then each gets the largest share of its request that it and all segments that
 * it meets can have together (fair_share, of common_share). */
#include "grow/refine/refine_clearance.h"

#include <stdlib.h>

/* Number of segments that a thread processes at a time [share_out]. */
enum { BATCH = 4096 };
/* Number of grid cells per terminal: two per segment. With fewer cells, a query finds more segments
 * out of reach; with more, a segment is entered in more cells. Results do not depend on it. */
static const double cells_per_terminal = 4;
/* Ratio of reserved radii to radii: the wanted ratio, and the minimum for a segment that moves.
 * With a ratio of 1, a vessel that touches another would forbid every move that widens it slightly.
 */
static const double reserve = 1.1, least_reserve = 1.04;
/* Share of the segments that must keep the rules at the level. Segments that break a rule at the
 * start may break it further, so a tree in which many do is refined with thinner vessels. */
static const double clear_share = 0.9;
/* The smallest level above 0: with vessels that much thinner, nearly only centrelines count. */
static const double least_level = 1.0 / 64;
/* Relative margin for the rounding of radii and lengths. */
static const double slack = 1e-9;

static Box box_of(const Domain *domain, const Arbor *arbor)
{
    if (domain)
        return domain->bounds;
    Box box = box_empty();
    for (size_t i = arbor->inlets; i < arbor->n; i++)
        box = box_with_ball(box_with_ball(box, arbor->shape[i].from, 0), arbor->shape[i].to, 0);
    /* Not thinner than a hundredth of its length, or the grid's cells would be too small. */
    Vec3 size = vec3_sub(box.high, box.low);
    double least = 0.01 * fmax(size.x, fmax(size.y, size.z));
    box.high.x = fmax(box.high.x, box.low.x + least);
    box.high.y = fmax(box.high.y, box.low.y + least);
    if (size.z > 0)
        box.high.z = fmax(box.high.z, box.low.z + least);
    return box;
}

/* Enters the reserved capsule of segment i in the grid. */
static Status enter(Clearance *clearance, const Arbor *arbor, int32_t i, Err *err)
{
    const Shape *shape = &arbor->shape[i];
    double wide = clearance->tree_gap > 0 ? clearance->radius[i] : 0;
    Capsule capsule = {shape->from, shape->to, fmax(shape->reserved_radius, wide)};
    return grid_add(&clearance->grid, 0, i, arbor->branch[i].child[0] < 0,
                    grid_item(&clearance->grid, capsule, shape->reserved_radius), err);
}

/* Returns the largest radius that a segment can reserve: half its length. */
static double most_reservation(const Branch *branch)
{
    return branch->length / 2 * (1 - slack);
}

static double distance_of(const Shape *a, const Shape *b)
{
    return sqrt(segment_distance2(a->from, a->to, b->from, b->to));
}

double clearance_search_radius(const Clearance *clearance, int32_t i, double reserved_radius)
{
    double wide = clearance->tree_gap > 0 ? clearance->radius[i] : 0;
    return fmax(reserved_radius, wide) + clearance->gap + clearance->tree_gap;
}

/* Returns the reserved radius of a segment of `radius` mm if it gets this share of its request, in
 * [-1, 1]. At 0 the reserved radius is the radius, at 1 it includes the full reserve, at -1 it is
 * 0. It is never more than the segment's length allows. */
static inline double reservation(const Clearance *clearance, const Branch *branch, double radius,
                                 double share)
{
    double longest = most_reservation(branch), least = fmin(clearance->level * radius, longest);
    if (share < 0)
        return least * (1 + share);
    return least + (fmin(reserve * clearance->level * radius, longest) - least) * share;
}

/* Returns the sum of the reserved radii of two segments that both get this share. */
static inline double both_reserve(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                  int32_t j, double share)
{
    return reservation(clearance, &arbor->branch[i], clearance->radius[i], share) +
           reservation(clearance, &arbor->branch[j], clearance->radius[j], share);
}

/* Returns the greatest share that two segments can both get without meeting. */
static inline double common_share(const Clearance *clearance, const Arbor *arbor, int32_t i,
                                  int32_t j)
{
    double apart =
        distance_of(&arbor->shape[i], &arbor->shape[j]) - clearance_between(clearance, arbor, i, j);
    double least = both_reserve(clearance, arbor, i, j, 0);
    double most = both_reserve(clearance, arbor, i, j, 1);
    if (apart >= most)
        return 1;
    return apart >= least ? (apart - least) / (most - least) : fmax(apart, 0) / least - 1;
}

double clearance_axis_distance(const Clearance *clearance, const Arbor *arbor, int32_t i, int32_t j)
{
    return both_reserve(clearance, arbor, i, j, 0) + clearance_between(clearance, arbor, i, j);
}

/* Returns the greatest share that segment i can get if every segment that it meets gets the same.
 */
static double fair_share(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    const Shape *shape = &arbor->shape[i];
    Capsule capsule = {shape->from, shape->to,
                       clearance_search_radius(clearance, i, shape->reserved_radius)};
    GridItem item = grid_item(&clearance->grid, capsule, 0);
    double share = 1;
    int32_t other;
    for (GridVisit visit = grid_visit(&clearance->grid, &item); grid_visit_next(&visit, &other);)
        if (other != i && !arbor_are_joined(arbor, i, other))
            share = fmin(share, common_share(clearance, arbor, i, other));
    return share;
}

/* Computes the radii of all segments, and empties the grid. */
static Status measure(Clearance *clearance, Arbor *arbor, Err *err)
{
    TRY(grid_reset(&clearance->grid, clearance->box, cells_per_terminal * (double)arbor->terminals,
                   arbor->n, 1, err));
    arbor_refresh(arbor);
    for (size_t i = arbor->inlets; i < arbor->n; i++)
        clearance->radius[i] = arbor_stored_radius(arbor, (int32_t)i);
    return STATUS_OK;
}

/* The context of share_out. */
typedef struct Sharing {
    const Clearance *clearance;
    const Arbor *arbor;
} Sharing;

/* Finds the fair shares of one batch of segments. */
static void share_out(size_t batch, int worker, void *context)
{
    (void)worker;
    const Sharing *sharing = context;
    const Clearance *clearance = sharing->clearance;
    size_t from = batch * BATCH, to = from + BATCH;
    for (size_t i = from; i < to && i < sharing->arbor->n; i++)
        if (!arbor_is_inlet(sharing->arbor, (int32_t)i))
            clearance->share[i] = fair_share(clearance, sharing->arbor, (int32_t)i);
}

Status clearance_reserve(Clearance *clearance, Arbor *arbor, Err *err)
{
    TRY(measure(clearance, arbor, err));
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        arbor->shape[i].reserved_radius =
            reservation(clearance, &arbor->branch[i], clearance->radius[i], 1);
        TRY(enter(clearance, arbor, (int32_t)i, err));
    }
    threads_for(arbor->n / BATCH + 1, 0, share_out, &(Sharing){clearance, arbor});
    size_t count = 0;
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        Branch *branch = &arbor->branch[i];
        double radius = clearance->radius[i],
               reserved_radius = reservation(clearance, branch, radius, clearance->share[i]);
        arbor->shape[i].reserved_radius = reserved_radius;
        count += clearance_is_kept(clearance, arbor, (int32_t)i);
        branch->inverse_limit =
            reserved_radius > 0 ? fmin(clearance->level / reserved_radius, 1 / radius) : 0;
    }
    arbor_sum(arbor);
    clearance->clear_fraction = (double)count / (double)(arbor->n - arbor->inlets);
    return STATUS_OK;
}

Status clearance_init(Clearance *clearance, const Domain *domain, double tree_gap, Arbor *arbor,
                      Err *err)
{
    double total = 0;
    for (size_t i = arbor->inlets; i < arbor->n; i++)
        total += arbor->branch[i].length;
    Box box = box_of(domain, arbor);
    *clearance = (Clearance){.domain = domain,
                             .box = box,
                             .level = 1,
                             .min_length = 1e-3 * total / (double)(arbor->n - arbor->inlets),
                             .gap = 1e-7 * vec3_distance(box.low, box.high),
                             .tree_gap = tree_gap};
    TRY(mem_calloc(&clearance->radius, arbor->n, sizeof *clearance->radius, "radii", err));
    TRY(mem_calloc(&clearance->share, arbor->n, sizeof *clearance->share, "reservations", err));
    TRY(clearance_reserve(clearance, arbor, err));
    while (clearance->clear_fraction < clear_share && clearance->level > 0) {
        clearance->level = clearance->level > least_level ? clearance->level / 2 : 0;
        TRY(clearance_reserve(clearance, arbor, err));
    }
    if (tree_gap > 0 && clearance->level < 1)
        return err_set(err, STATUS_INFEASIBLE,
                       "more than a tenth of the vessels are shorter than wide or touch other "
                       "vessels; refinement would have to count all vessels with only %g of their "
                       "radii, and could not keep `clearance_mm` %g; refine the tree with a "
                       "clearance of 0",
                       clearance->level, tree_gap);
    return STATUS_OK;
}

void clearance_release(Clearance *clearance)
{
    grid_release(&clearance->grid);
    free(clearance->radius);
    free(clearance->share);
    *clearance = (Clearance){0};
}

Status clearance_suspend(Clearance *clearance, Arbor *arbor, Err *err)
{
    TRY(measure(clearance, arbor, err));
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        arbor->shape[i].reserved_radius =
            SUSPENDED_RESERVE * clearance->level * clearance->radius[i];
        arbor->branch[i].inverse_limit = 0;
        TRY(enter(clearance, arbor, (int32_t)i, err));
    }
    arbor_sum(arbor);
    return STATUS_OK;
}

/* Returns the largest radius that segment i can reserve beside the reservation of segment j;
 * INFINITY if they share a node. */
static double room_beside(const Clearance *clearance, const Arbor *arbor, int32_t i, int32_t j)
{
    const Shape *there = &arbor->shape[j];
    if (j == i || arbor_are_joined(arbor, i, j))
        return INFINITY;
    return distance_of(&arbor->shape[i], there) - there->reserved_radius -
           clearance_between(clearance, arbor, i, j);
}

/* Returns the largest radius, at most `wish`, that segment i can reserve beside the reserved radii
 * of all other segments. */
static double most_room(const Clearance *clearance, const Arbor *arbor, int32_t i, double wish)
{
    const Shape *shape = &arbor->shape[i];
    double most = fmin(wish, most_reservation(&arbor->branch[i]));
    int32_t other;
    Capsule capsule = {shape->from, shape->to, clearance_search_radius(clearance, i, most)};
    GridItem item = grid_item(&clearance->grid, capsule, 0);
    for (GridVisit visit = grid_visit(&clearance->grid, &item); grid_visit_next(&visit, &other);)
        if (arbor->shape[other].saved != arbor->move)
            most = fmin(most, room_beside(clearance, arbor, i, other));
    for (int k = 0; k < arbor->n_saved_shapes; k++) /* the grid has them as they were */
        most = fmin(most, room_beside(clearance, arbor, i, arbor->saved_shape[k].i));
    return most;
}

bool clearance_holds_segment(const Clearance *clearance, const Arbor *arbor, int32_t i)
{
    const Domain *domain = clearance->domain;
    const Shape *shape = &arbor->shape[i];
    if (!(arbor->branch[i].length >= clearance->min_length))
        return false;
    return !domain ||
           (domain_inside(domain, shape->to, 0) &&
            (domain_is_convex(domain) || domain_holds_segment(domain, shape->from, shape->to)));
}

bool clearance_holds_move(const Clearance *clearance, const Arbor *arbor)
{
    const Domain *domain = clearance->domain;
    for (int k = 0; k < arbor->n_saved_shapes; k++) {
        int32_t i = arbor->saved_shape[k].i;
        const Shape *was = &arbor->saved_shape[k].was, *shape = &arbor->shape[i];
        if (!(arbor->branch[i].length >= clearance->min_length))
            return false;
        if (!domain)
            continue;
        bool moved = vec3_distance(was->to, shape->to) > 0;
        if (moved && !domain_inside(domain, shape->to, 0))
            return false;
        if (!domain_is_convex(domain) && !domain_holds_segment(domain, shape->from, shape->to))
            return false;
    }
    return true;
}

/* Reserves radii for the segments that the present move has placed. Returns false if one of them
 * lacks room. */
static bool reserve_moved(const Clearance *clearance, Arbor *arbor)
{
    int moved = arbor->n_saved_shapes;
    double need[ARBOR_MOVE_SHAPES];
    for (int k = 0; k < moved; k++) {
        int32_t i = arbor->saved_shape[k].i;
        need[k] = clearance->level * arbor_radius(arbor, i);
        arbor_reserve(arbor, i, need[k], 0);
    }
    for (int k = 0; k < moved; k++) {
        int32_t i = arbor->saved_shape[k].i;
        double reserved_radius = most_room(clearance, arbor, i, reserve * need[k]);
        if (!(reserved_radius >= least_reserve * need[k]))
            return false;
        arbor_reserve(arbor, i, reserved_radius,
                      reserved_radius > 0 ? clearance->level / reserved_radius : 0);
    }
    for (int k = 0; k < moved; k++)
        arbor_sum_from(arbor, arbor->saved_shape[k].i);
    return true;
}

bool clearance_allows(const Clearance *clearance, Arbor *arbor)
{
    if (!clearance_holds_move(clearance, arbor) || !reserve_moved(clearance, arbor))
        return false;
    double radius;
    for (int32_t i; (i = arbor_find_overuse(arbor, &radius)) != 0;) {
        if (arbor->n_saved_shapes == ARBOR_MOVE_SHAPES)
            return false;
        double thickness = arbor->branch[i].inverse_limit * arbor->shape[i].reserved_radius;
        double reserved_radius = most_room(clearance, arbor, i, reserve * thickness * radius);
        if (!(reserved_radius >= thickness * radius * (1 + slack)))
            return false;
        arbor_reserve(arbor, i, reserved_radius, thickness / reserved_radius);
        arbor_sum_from(arbor, i);
    }
    return true;
}

Status clearance_update_grid(Clearance *clearance, const Arbor *arbor, Err *err)
{
    for (int k = 0; k < arbor->n_saved_shapes; k++)
        grid_remove(&clearance->grid, arbor->saved_shape[k].i);
    for (int k = 0; k < arbor->n_saved_shapes; k++)
        TRY(enter(clearance, arbor, arbor->saved_shape[k].i, err));
    return STATUS_OK;
}
