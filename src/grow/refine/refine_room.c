/* Radii change all over the tree with every move, so that no test of the moved segments alone can
 * keep vessels clear. Every segment therefore books a radius a little above its own, to which no
 * other vessel's booking comes near, and which is at most half its length. While all radii stay
 * within their bookings the rules hold for the whole tree, and one number at the root tells whether
 * they do [Branch.fullness]. A move that makes some radius exceed its booking must find it more
 * room, or is undone. */
#include "grow/refine/refine_room.h"

#include <stdlib.h>

/* Cells of the grid a terminal. */
static const double cells_per_terminal = 4;
/* Bookings over the radii: as a rule, and at least when a segment moves. Vessels that touch would
 * make every other move impossible that widens them ever so little. */
static const double reserve = 1.1, least_reserve = 1.04;
/* The share of segments that must be clear at the level, and the least level but 0. */
static const double clear_share = 0.9;
static const double least_level = 1.0 / 64;
/* Room for the rounding of radii and lengths, over them. */
static const double slack = 1e-9;

static Box box_of(const Domain *domain, const Arbor *arbor)
{
    if (domain)
        return domain_bounds(domain);
    Box box = box_empty();
    for (size_t i = 1; i < arbor->n; i++)
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

static Status enter(Room *room, const Arbor *arbor, int32_t i, Err *err)
{
    const Shape *shape = &arbor->shape[i];
    Capsule capsule = {shape->from, shape->to, shape->booked};
    return grid_add(&room->grid, 0, i, arbor->branch[i].child[0] < 0,
                    grid_item(&room->grid, capsule, shape->booked), err);
}

static double longest_booking(const Branch *branch)
{
    return branch->length / 2 * (1 - slack);
}

static double distance_of(const Shape *a, const Shape *b)
{
    return sqrt(segment_distance2(a->from, a->to, b->from, b->to));
}

/* What a segment of `radius` books when it has this share of room: at 0 the radius, at 1 the
 * reserve as well, at -1 nothing. Never more than its length allows. */
static double booking(const Room *room, const Branch *branch, double radius, double share)
{
    double longest = longest_booking(branch), least = fmin(room->level * radius, longest);
    if (share < 0)
        return least * (1 + share);
    return least + (fmin(reserve * room->level * radius, longest) - least) * share;
}

/* The greatest share of room at which two segments so far apart leave it to each other. */
static double common_share(const Room *room, const Branch *a, double radius_a, const Branch *b,
                           double radius_b, double apart)
{
    double least = booking(room, a, radius_a, 0) + booking(room, b, radius_b, 0);
    double most = booking(room, a, radius_a, 1) + booking(room, b, radius_b, 1);
    apart -= room->gap;
    if (apart >= most)
        return 1;
    return apart >= least ? (apart - least) / (most - least) : fmax(apart, 0) / least - 1;
}

/* The greatest share that segment i and all it meets leave to each other. */
static double fair_share(const Room *room, const Arbor *arbor, const double *radius, int32_t i)
{
    const Shape *shape = &arbor->shape[i];
    const Branch *branch = arbor->branch;
    Capsule capsule = {shape->from, shape->to, shape->booked + room->gap};
    GridItem item = grid_item(&room->grid, capsule, 0);
    double share = 1;
    size_t index;
    for (GridWalk walk = grid_walk(&room->grid, &item); grid_walk_next(&walk, &index);) {
        const GridCell *cell = &room->grid.cell[index];
        for (uint32_t k = 0; k < cell->count; k++) {
            int32_t other = cell->tag[k] >> 1;
            if (other != i && !arbor_are_joined(arbor, i, other))
                share = fmin(share,
                             common_share(room, &branch[i], radius[i], &branch[other],
                                          radius[other], distance_of(shape, &arbor->shape[other])));
        }
    }
    return share;
}

/* Finds the radii of all segments and empties the grid. */
static Status measure(Room *room, Arbor *arbor, Err *err)
{
    TRY(grid_reset(&room->grid, room->box, cells_per_terminal * (double)(arbor->n / 2), arbor->n, 1,
                   err));
    arbor_look(arbor);
    for (size_t i = 1; i < arbor->n; i++)
        room->radius[i] = arbor_radius_seen(arbor, (int32_t)i);
    return STATUS_OK;
}

/* Books at the room's level; *clear is the share of segments that have the room they should. */
static Status book(Room *room, Arbor *arbor, double *clear, Err *err)
{
    TRY(measure(room, arbor, err));
    for (size_t i = 1; i < arbor->n; i++) {
        arbor->shape[i].booked = booking(room, &arbor->branch[i], room->radius[i], 1);
        TRY(enter(room, arbor, (int32_t)i, err));
    }
    for (size_t i = 1; i < arbor->n; i++)
        room->share[i] = fair_share(room, arbor, room->radius, (int32_t)i);
    size_t count = 0;
    for (size_t i = 1; i < arbor->n; i++) {
        Branch *branch = &arbor->branch[i];
        double radius = room->radius[i], booked = booking(room, branch, radius, room->share[i]);
        arbor->shape[i].booked = booked;
        count += room_is_clear(room, arbor, (int32_t)i);
        branch->tightness = booked > 0 ? fmin(room->level / booked, 1 / radius) : 0;
    }
    arbor_sum(arbor);
    *clear = (double)count / (double)(arbor->n - 1);
    return STATUS_OK;
}

Status room_init(Room *room, const Domain *domain, Arbor *arbor, Err *err)
{
    double total = 0, clear;
    for (size_t i = 1; i < arbor->n; i++)
        total += arbor->branch[i].length;
    Box box = box_of(domain, arbor);
    *room = (Room){.domain = domain,
                   .box = box,
                   .level = 1,
                   .least_length = 1e-3 * total / (double)(arbor->n - 1),
                   .gap = 1e-7 * vec3_distance(box.low, box.high)};
    TRY(mem_calloc(&room->radius, arbor->n, sizeof *room->radius, "radii", err));
    TRY(mem_calloc(&room->share, arbor->n, sizeof *room->share, "bookings", err));
    TRY(book(room, arbor, &clear, err));
    while (clear < clear_share && room->level > 0) {
        room->level = room->level > least_level ? room->level / 2 : 0;
        TRY(book(room, arbor, &clear, err));
    }
    return STATUS_OK;
}

void room_release(Room *room)
{
    grid_release(&room->grid);
    free(room->radius);
    free(room->share);
    *room = (Room){0};
}

Status room_book(Room *room, Arbor *arbor, Err *err)
{
    double clear;
    return book(room, arbor, &clear, err);
}

Status room_waive(Room *room, Arbor *arbor, double reserved, Err *err)
{
    TRY(measure(room, arbor, err));
    for (size_t i = 1; i < arbor->n; i++) {
        arbor->shape[i].booked = reserved * room->level * room->radius[i];
        arbor->branch[i].tightness = 0;
        TRY(enter(room, arbor, (int32_t)i, err));
    }
    arbor_sum(arbor);
    return STATUS_OK;
}

/* The most that segment i can book, up to `wish`, as the others' bookings are. */
static double most_room(const Room *room, const Arbor *arbor, int32_t i, double wish)
{
    const Shape *shape = &arbor->shape[i];
    double most = fmin(wish, longest_booking(&arbor->branch[i]));
    size_t index;
    Capsule capsule = {shape->from, shape->to, most + room->gap};
    GridItem item = grid_item(&room->grid, capsule, 0);
    for (GridWalk walk = grid_walk(&room->grid, &item); grid_walk_next(&walk, &index);) {
        const GridCell *cell = &room->grid.cell[index];
        for (uint32_t k = 0; k < cell->count; k++) {
            int32_t other = cell->tag[k] >> 1;
            const Shape *there = &arbor->shape[other];
            if (there->saved != arbor->move && !arbor_are_joined(arbor, i, other))
                most = fmin(most, distance_of(shape, there) - there->booked - room->gap);
        }
    }
    for (int k = 0; k < arbor->n_saved_shapes; k++) { /* the grid has them as they were */
        int32_t other = arbor->saved_shape[k].i;
        const Shape *there = &arbor->shape[other];
        if (other != i && !arbor_are_joined(arbor, i, other))
            most = fmin(most, distance_of(shape, there) - there->booked - room->gap);
    }
    return most;
}

bool room_encloses(const Room *room, const Arbor *arbor)
{
    const Domain *domain = room->domain;
    for (int k = 0; k < arbor->n_saved_shapes; k++) {
        int32_t i = arbor->saved_shape[k].i;
        const Shape *was = &arbor->saved_shape[k].was, *shape = &arbor->shape[i];
        if (!(arbor->branch[i].length >= room->least_length))
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

/* Books for the segments that the move has moved. */
static bool book_moved(const Room *room, Arbor *arbor)
{
    int moved = arbor->n_saved_shapes;
    double need[ARBOR_MOVE_SHAPES];
    for (int k = 0; k < moved; k++) {
        int32_t i = arbor->saved_shape[k].i;
        need[k] = room->level * arbor_radius(arbor, i);
        arbor_book(arbor, i, need[k], 0);
    }
    for (int k = 0; k < moved; k++) {
        int32_t i = arbor->saved_shape[k].i;
        double booked = most_room(room, arbor, i, reserve * need[k]);
        if (!(booked >= least_reserve * need[k]))
            return false;
        arbor_book(arbor, i, booked, booked > 0 ? room->level / booked : 0);
    }
    for (int k = 0; k < moved; k++)
        arbor_climb(arbor, arbor->saved_shape[k].i);
    return true;
}

bool room_allows(const Room *room, Arbor *arbor)
{
    if (!room_encloses(room, arbor) || !book_moved(room, arbor))
        return false;
    double radius;
    for (int32_t i; (i = arbor_overfull(arbor, &radius)) != 0;) {
        if (arbor->n_saved_shapes == ARBOR_MOVE_SHAPES)
            return false;
        double thickness = arbor->branch[i].tightness * arbor->shape[i].booked;
        double booked = most_room(room, arbor, i, reserve * thickness * radius);
        if (!(booked >= thickness * radius * (1 + slack)))
            return false;
        arbor_book(arbor, i, booked, thickness / booked);
        arbor_climb(arbor, i);
    }
    return true;
}

Status room_follow(Room *room, const Arbor *arbor, Err *err)
{
    for (int k = 0; k < arbor->n_saved_shapes; k++)
        grid_remove(&room->grid, arbor->saved_shape[k].i);
    for (int k = 0; k < arbor->n_saved_shapes; k++)
        TRY(enter(room, arbor, arbor->saved_shape[k].i, err));
    return STATUS_OK;
}
