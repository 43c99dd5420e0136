/* The cost of a connection depends on the bifurcation through three lengths only. Where it is
 * least, the derivatives with respect to them pull evenly: the point is the weighted Fermat point
 * for these derivatives as weights [fermat.h]. They vary slowly, so weights at one place and the
 * Fermat point for them in turn converge in a few rounds. To rank connections one round from a
 * middling place does, priced to first order by the same weights; the rest are for the one that is
 * made. A point that collapses onto an end is pushed off it to the shortest length the rules allow,
 * in the direction that costs least: such connections are among the best there are, so they must
 * not be lost. A segment that must stay straight is split at the best place along it. */
#include "grow/connection.h"

#include "grow/cco/fermat.h"
#include <stdlib.h>
#include <string.h>

/* Vessels widen as the tree below them grows: the rules hold for radii this much greater, and so at
 * the end of growth for nearly all vessels at their final radii. For length, and for keeping clear
 * of others. */
static const double length_reserve = 1.15, clearance_reserve = 1.1;
/* How often the place of the connection that is made is found anew. */
enum { ROUNDS = 2 };

/* The segment to be split, as it is. */
typedef struct Host {
    double burden[PARTS]; /* of the segments that splitting it makes */
    double gauge;
    Below below;
    Reduced whole;
    Adjoint adjoint;
    double extra;
    bool given, piece;
    double length; /* mm */
} Host;

typedef struct Trial {
    double price;
    double weight[PARTS]; /* d price / d length */
    double radius[PARTS]; /* mm */
} Trial;

static Host host_of(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    int32_t terminals = segment->terminals;
    Host host = {.burden = {[PROXIMAL] = network_burden(net, i, terminals + 1),
                            [DISTAL] = network_burden(net, i, terminals),
                            [FRESH] = net->fresh_weight},
                 .gauge = (double)segment->gauge,
                 .below = network_below(net, i),
                 .extra = net->sensitivity[i].extra,
                 .given = network_is_given(net, i),
                 .piece = network_is_piece(net, i),
                 .length = segment->length};
    host.whole = law_extend(&net->law, host.burden[DISTAL], segment->length, &host.below);
    host.adjoint = (Adjoint){net->sensitivity[i].load, law_lambda_power(&net->law, host.gauge)};
    return host;
}

/* What splitting the host costs when the parts have these lengths. */
static Trial evaluate(const Network *net, const Host *host, const double length[PARTS])
{
    const Law *law = &net->law;
    const Below nothing = {0};
    const double *burden = host->burden;
    Reduced distal = law_extend(law, burden[DISTAL], length[DISTAL], &host->below);
    Reduced fresh = law_extend(law, burden[FRESH], length[FRESH], &nothing);
    Below fork = law_gather(law, distal.rho_gamma + fresh.rho_gamma, distal.cost + fresh.cost);
    Reduced proximal = law_extend(law, burden[PROXIMAL], length[PROXIMAL], &fork);

    Trial out;
    Adjoint top = host->adjoint;
    Adjoint distal_adjoint = law_descend(law, &proximal, top, &distal);
    Adjoint fresh_adjoint = law_descend(law, &proximal, top, &fresh);
    out.price = top.load * (proximal.load - host->whole.load) +
                top.cost * (proximal.cost - host->whole.cost) + host->extra;
    out.weight[PROXIMAL] = law_length_weight(law, &proximal, top, burden[PROXIMAL]);
    out.weight[DISTAL] = law_length_weight(law, &distal, distal_adjoint, burden[DISTAL]);
    out.weight[FRESH] = law_length_weight(law, &fresh, fresh_adjoint, burden[FRESH]);

    double unit = net->radius_unit * host->gauge;
    out.radius[PROXIMAL] = unit * proximal.rho;
    out.radius[DISTAL] = unit * proximal.widening * distal.rho;
    out.radius[FRESH] = unit * proximal.widening * fresh.rho;
    return out;
}

static double shortest(const Rules *rules, double radius)
{
    double width = 2 * length_reserve * rules->thickness * radius;
    return width > rules->least_length ? width : rules->least_length;
}

/* The shortest that a part of the host may be: of a piece of a vessel, nearly a quarter will do. */
static double shortest_part(const Rules *rules, const Host *host, int part, double radius)
{
    double least = shortest(rules, radius);
    return host->piece && part != FRESH ? fmin(least, 0.24 * host->length) : least;
}

/* Keeps the bifurcation off the three ends. */
static Vec3 push_off(const Rules *rules, const Vec3 end[PARTS], const double radius[PARTS],
                     const Fermat *fermat)
{
    Vec3 place = fermat->place;
    for (int i = 0; i < PARTS; i++) {
        double least = 1.02 * shortest(rules, radius[i]); /* the radius moves a little too */
        Vec3 away = vec3_sub(place, end[i]);
        if (vec3_dot(away, away) >= least * least)
            continue;
        Vec3 direction = fermat->corner == i ? fermat->inward : away;
        double length = vec3_length(direction);
        if (length > 0)
            place = vec3_add_scaled(end[i], direction, least / length);
    }
    return place;
}

static void measure(const Vec3 end[PARTS], Vec3 place, double length[PARTS])
{
    for (int i = 0; i < PARTS; i++)
        length[i] = vec3_distance(end[i], place);
}

static void find_ends(const Network *net, int32_t segment, Vec3 terminal, Vec3 end[PARTS])
{
    end[PROXIMAL] = net->position[net->segment[segment].parent];
    end[DISTAL] = net->position[segment];
    end[FRESH] = terminal;
}

/* Where the bifurcation is best by a trial's weights, as far as the rules allow. False when they
 * are beyond what a double can hold. */
static bool find_place(const Rules *rules, const Host *host, const Vec3 end[PARTS],
                       const Trial *trial, Vec3 *place)
{
    double greatest = fmax(trial->weight[0], fmax(trial->weight[1], trial->weight[2]));
    if (!isfinite(trial->price) || !isfinite(greatest) || !(greatest > 0))
        return false;
    double weight[PARTS];
    for (int i = 0; i < PARTS; i++) /* none pushes: Fermat's point wants weights above 0 */
        weight[i] = fmax(trial->weight[i] / greatest, 1e-9);
    if (host->given) {
        double margin[2];
        for (int i = 0; i < 2; i++)
            margin[i] = 1.02 * shortest_part(rules, host, i, trial->radius[i]);
        *place = fermat_point_between(end, weight, margin);
        return true;
    }
    Fermat fermat = fermat_point(end, weight);
    *place = push_off(rules, end, trial->radius, &fermat);
    return true;
}

bool connection_estimate(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                         Connection *out)
{
    Vec3 end[PARTS], middle, place;
    find_ends(net, segment, terminal, end);
    Host host = host_of(net, segment);
    middle = vec3_scale(vec3_add(end[PROXIMAL], end[DISTAL]), 0.5);
    double from[PARTS], to[PARTS];
    measure(end, vec3_add_scaled(vec3_scale(middle, 0.75), terminal, 0.25), from);
    Trial trial = evaluate(net, &host, from);
    if (!find_place(rules, &host, end, &trial, &place))
        return false;
    measure(end, place, to);
    *out = (Connection){.segment = segment, .price = trial.price, .bifurcation = place};
    for (int i = 0; i < PARTS; i++)
        out->price += trial.weight[i] * (to[i] - from[i]);
    return true;
}

bool connection_may_split(const Network *net, const Grid *grid, const Rules *rules, int32_t segment)
{
    if (network_is_piece(net, segment))
        return true;
    const GridItem *item = &grid->item[segment];
    double least = 2 * shortest(rules, (double)item->radius);
    return grid_length2(item) > least * least;
}

static bool is_long_enough(const Rules *rules, const Host *host, const double length[PARTS],
                           const double radius[PARTS])
{
    for (int i = 0; i < PARTS; i++)
        if (!(length[i] >= shortest_part(rules, host, i, radius[i])))
            return false;
    return true;
}

bool connection_optimise(const Network *net, const Rules *rules, Vec3 terminal,
                         Connection *connection)
{
    Vec3 end[PARTS], place = connection->bifurcation;
    find_ends(net, connection->segment, terminal, end);
    Host host = host_of(net, connection->segment);
    for (int round = 0; round <= ROUNDS; round++) {
        double length[PARTS];
        measure(end, place, length);
        Trial trial = evaluate(net, &host, length);
        if (!isfinite(trial.price) || !is_long_enough(rules, &host, length, trial.radius))
            return round > 0;
        connection->price = trial.price;
        connection->bifurcation = place;
        memcpy(connection->radius, trial.radius, sizeof trial.radius);
        if (!find_place(rules, &host, end, &trial, &place))
            break;
    }
    return true;
}

GridItem connection_item(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part)
{
    int32_t host = connection->segment;
    double radius = connection->radius[part];
    Capsule capsule = {connection->bifurcation, terminal, entry_reach(rules, radius)};
    if (part == PROXIMAL)
        capsule = (Capsule){net->position[net->segment[host].parent], connection->bifurcation,
                            capsule.radius};
    else if (part == DISTAL)
        capsule.b = net->position[host];
    return grid_item(grid, capsule, radius);
}

bool connection_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                          Vec3 terminal)
{
    int32_t host = connection->segment;
    Vec3 fork = connection->bifurcation;
    if (network_is_given(net, host))
        return domain_inside(domain, fork, 0) && domain_holds_segment(domain, fork, terminal);
    return domain_inside(domain, fork, 0) &&
           (domain_is_convex(domain) ||
            (domain_holds_segment(domain, fork, terminal) &&
             domain_holds_segment(domain, net->position[net->segment[host].parent], fork) &&
             domain_holds_segment(domain, fork, net->position[host])));
}

/* A new segment that is to keep clear of all but its kin. */
typedef struct Newcomer {
    const Network *net;
    GridItem item;
    GridBoxQuery probe;
    double radius;    /* mm */
    double thickness; /* at which all radii count */
    double gap;       /* mm */
    int32_t kin[4];   /* the first is the segment to split */
} Newcomer;

/* Its kin are the segment to split and all that end or begin where the newcomer does. */
static Newcomer newcomer(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part)
{
    int32_t host = connection->segment;
    Newcomer out = {.net = net,
                    .item = connection_item(net, grid, rules, connection, terminal, part),
                    .radius = connection->radius[part],
                    .thickness = rules->thickness,
                    .gap = rules->gap,
                    .kin = {host, host, host, host}};
    double per_radius = clearance_reserve * rules->thickness;
    out.probe = grid_box_query(&out.item, per_radius * out.radius + rules->gap, per_radius);
    if (part != FRESH) {
        int32_t node = part == PROXIMAL ? net->segment[host].parent : host;
        out.kin[1] = node;
        out.kin[2] = net->segment[node].child[0];
        out.kin[3] = net->segment[node].child[1];
    }
    return out;
}

/* Whether the newcomer keeps clear of another segment, with the reserve unless the segment that is
 * split did not either. What begins in a vessel of many pieces overlaps those about its beginning:
 * from them only the centrelines must keep apart. */
static bool is_clear_of(const Grid *grid, const Newcomer *newcomer, int32_t other)
{
    const GridItem *item = &grid->item[other];
    double touch = newcomer->thickness * (newcomer->radius + (double)item->radius);
    double clear = clearance_reserve * touch + newcomer->gap;
    double apart2 = grid_distance2(&newcomer->item, item);
    if (apart2 >= clear * clear)
        return true;
    touch = newcomer->gap + (network_is_piece(newcomer->net, other) ? 0 : touch);
    return apart2 >= touch * touch && apart2 >= grid_distance2(&grid->item[newcomer->kin[0]], item);
}

static bool is_clear(const Grid *grid, const Newcomer *newcomer, const GridCell *cell)
{
    const int32_t *kin = newcomer->kin;
    for (uint32_t k = 0; k < cell->count; k += GRID_LANES) {
        unsigned near = grid_boxes_near(grid, cell, k, &newcomer->probe);
        for (const int32_t *tag = cell->tag + k; near; near >>= 1, tag++) {
            int32_t other = *tag >> 1;
            if ((near & 1) && other != kin[0] && other != kin[1] && other != kin[2] &&
                other != kin[3] && !is_clear_of(grid, newcomer, other))
                return false;
        }
    }
    return true;
}

static bool is_clear_all_along(const Grid *grid, const Newcomer *newcomer)
{
    size_t cell;
    for (GridWalk walk = grid_walk(grid, &newcomer->item); grid_walk_next(&walk, &cell);)
        if (!is_clear(grid, newcomer, &grid->cell[cell]))
            return false;
    return true;
}

ConnectionClearance connection_clearance(const Network *net, const Grid *grid, const Rules *rules,
                                         Box zone, const Connection *connection, Vec3 terminal)
{
    for (int part = 0; part < PARTS; part++) {
        Newcomer part_of = newcomer(net, grid, rules, connection, terminal, part);
        if (!grid_zone_holds(grid, zone, &part_of.item))
            return CONNECTION_BEYOND;
        bool is_given = part != FRESH && network_is_given(net, connection->segment);
        if (!is_given && !is_clear_all_along(grid, &part_of))
            return CONNECTION_BLOCKED;
    }
    return CONNECTION_CLEAR;
}
