/* An exterior penalty in the l1 norm: at a finite price, the best tree keeps the rules exactly
 * wherever a mm gained by breaking them is worth less than that. As not even the shape of the tree
 * is known at which the rules hold, prices are not one number that rises, but one for each segment,
 * which rises most while the segment breaks a rule ([METHODS M], the breakout method): where rules
 * hold they stay low, and the tree can go on giving way to those places where they do not. */
#include "grow/refine/refine_toll.h"

#include <stdlib.h>

/* How prices rise: all, and those of segments that break the rules. */
static const double rise = 1.1, steep_rise = 2.2;
/* Bookings over the radii: radii grow a little before they are booked for anew. */
static const double reserve = 1.05;

Status tolls_init(Tolls *tolls, size_t segments, Err *err)
{
    TRY(mem_calloc(&tolls->price, segments, sizeof *tolls->price, "prices", err));
    TRY(mem_calloc(&tolls->broken, segments, sizeof *tolls->broken, "segments", err));
    return mem_calloc(&tolls->seen, segments, sizeof *tolls->seen, "segments", err);
}

void tolls_release(Tolls *tolls)
{
    free(tolls->price);
    free(tolls->broken);
    free(tolls->seen);
    *tolls = (Tolls){0};
}

void tolls_open(Tolls *tolls, const Arbor *arbor, double price)
{
    double length = 0;
    for (size_t i = 1; i < arbor->n; i++)
        length += arbor->branch[i].length;
    for (size_t i = 1; i < arbor->n; i++)
        tolls->price[i] = price * arbor_cost(arbor) / length;
    tolls->open = true;
}

Status tolls_book(Room *room, Arbor *arbor, Err *err)
{
    return room_waive(room, arbor, reserve, err);
}

void tolls_raise(Tolls *tolls, const Room *room, const Arbor *arbor)
{
    tolls->n_broken = 0;
    for (size_t i = 1; i < arbor->n; i++) {
        bool clear = room_is_clear(room, arbor, (int32_t)i);
        tolls->price[i] *= clear ? rise : steep_rise;
        if (!clear)
            tolls->broken[tolls->n_broken++] = (int32_t)i;
    }
}

/* What two segments pay together. */
static double toll_between(const Tolls *tolls, const Room *room, const Arbor *arbor, int32_t i,
                           int32_t j)
{
    const Shape *a = &arbor->shape[i], *b = &arbor->shape[j];
    double reach = a->booked + b->booked + room->gap;
    double distance2 = segment_distance2(a->from, a->to, b->from, b->to);
    if (distance2 >= reach * reach || arbor_are_joined(arbor, i, j) || !arbor_has(arbor, j))
        return 0;
    return (reach - sqrt(distance2)) * fmax(tolls->price[i], tolls->price[j]);
}

/* What segment i pays for itself and with all that this count has not come across yet. */
static double toll_of_segment(Tolls *tolls, const Room *room, const Arbor *arbor, int32_t i)
{
    const Shape *shape = &arbor->shape[i];
    double sum = fmax(0, 2 * shape->booked - arbor->branch[i].length) * tolls->price[i];
    Capsule capsule = {shape->from, shape->to, shape->booked + room->gap};
    GridItem item = grid_item(&room->grid, capsule, 0);
    size_t index;
    for (GridWalk walk = grid_walk(&room->grid, &item); grid_walk_next(&walk, &index);) {
        const GridCell *cell = &room->grid.cell[index];
        for (uint32_t k = 0; k < cell->count; k++) {
            int32_t other = cell->tag[k] >> 1;
            if (tolls->seen[other] == tolls->count || arbor->shape[other].saved == arbor->move)
                continue;
            tolls->seen[other] = tolls->count;
            sum += toll_between(tolls, room, arbor, i, other);
        }
    }
    for (int k = 0; k < arbor->n_saved_shapes; k++) { /* the grid has them as they were */
        int32_t other = arbor->saved_shape[k].i;
        if (tolls->seen[other] != tolls->count)
            sum += toll_between(tolls, room, arbor, i, other);
    }
    return sum;
}

double toll_of(Tolls *tolls, const Room *room, const Arbor *arbor, const int32_t *segment,
               int count)
{
    double sum = 0;
    for (int k = 0; k < count && tolls->open; k++) {
        tolls->count++;
        for (int j = 0; j <= k; j++)
            tolls->seen[segment[j]] = tolls->count;
        sum += toll_of_segment(tolls, room, arbor, segment[k]);
    }
    return sum;
}

double toll_of_fork(Tolls *tolls, const Room *room, Arbor *arbor, int32_t i)
{
    const int32_t *child = arbor->branch[i].child;
    Reduced mother = arbor_reduce(arbor, i);
    double unit = reserve * room->level * arbor->radius_unit * arbor_outlook(arbor, i).gauge;
    arbor_book(arbor, i, unit * mother.rho, 0);
    for (int side = 0; side < 2; side++)
        arbor_book(arbor, child[side],
                   unit * mother.widening * arbor_reduce(arbor, child[side]).rho, 0);
    const int32_t moved[] = {i, child[0], child[1]};
    return toll_of(tolls, room, arbor, moved, 3);
}
