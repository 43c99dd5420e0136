/* The place of a connection is found by the optimiser of a bifurcation [bifurcation.h]. To rank
 * connections (connection_estimate) one round of it from a middling place does, priced to first
 * order by the same weights; the rest of the rounds (connection_optimise) are for the one that is
 * to be made. Whether it may be made is asked last, because that is dearest: whether its segments
 * are in the domain (connection_is_inside), and clear of all others (connection_clearance). */
#include "grow/connection.h"

#include "grow/trunk.h"

#include <string.h>

/* Vessels widen as the tree below them grows: the rules hold for radii this much greater, and so at
 * the end of growth for nearly all vessels at their final radii. For length, and for keeping clear
 * of others. */
static const double length_reserve = 1.15, clearance_reserve = 1.1;
/* Bifurcations keep this many times the least length from the ends, as radii change a little too.
 */
static const double margin = 1.02;
/* How often the place of the connection that is made is found anew. */
enum { ROUNDS = 2 };

/* A piece of a vessel may be split into parts a little shorter than a quarter of it, however wide
 * it is. */
static const double least_part_of_piece = 0.24;

/* The bifurcation at which `segment` would be split for `terminal`. */
static Bifurcation bifurcation_of(const Network *net, const Rules *rules, int32_t i, Vec3 terminal)
{
    const Segment *segment = &net->segment[i];
    int32_t terminals = segment->terminals;
    double gauge = (double)segment->gauge;
    Bifurcation out = {.end = {net->position[segment->parent], net->position[i], terminal},
                       .burden = {network_burden(net, i, terminals + 1),
                                  network_burden(net, i, terminals), net->fresh_weight},
                       .below = {network_below(net, i)},
                       .adjoint = {net->sensitivity[i].load, law_lambda_power(&net->law, gauge)},
                       .radius_unit = net->radius_unit * gauge,
                       .extra = net->sensitivity[i].extra,
                       .least_length = rules->least_length,
                       .least_widths = length_reserve * rules->thickness,
                       .least_part = network_is_piece(net, i)
                                         ? least_part_of_piece * segment->length
                                         : (double)INFINITY,
                       .margin = margin,
                       .straight = network_is_given(net, i)};
    const Law law = network_law(net, i);
    Reduced whole = law_extend(&law, out.burden[DISTAL], segment->length, &out.below[0]);
    out.load_before = whole.load;
    out.cost_before = whole.cost;
    return out;
}

/* The part of a segment at which the point of it next to `terminal` lies, `least` mm or more off
 * the ends. */
static double nearest_part(Vec3 a, Vec3 b, Vec3 terminal, double length, double least)
{
    double part = vec3_dot(vec3_sub(terminal, a), vec3_sub(b, a)) / (length * length);
    return fmin(fmax(part, least / length), 1 - least / length);
}

/* The connection to a segment that keeps its radius: the straight one to the nearest place, as what
 * is spent on the way there changes little along a segment. */
static bool connect_to_trunk(const Network *net, const Rules *rules, int32_t i, Vec3 terminal,
                             Connection *out)
{
    const Segment *segment = &net->segment[i];
    double kept = net->trunk->radius[i], length = segment->length;
    double width = fmax(2 * length_reserve * rules->thickness * kept, rules->least_length);
    Vec3 from = net->position[segment->parent], to = net->position[i];
    double part =
        nearest_part(from, to, terminal, length, fmin(width, least_part_of_piece * length));
    double gauge =
        trunk_gauge((double)segment->gauge, trunk_spent(net, i, segment->terminals + 1, part));
    Vec3 place = vec3_add_scaled(from, vec3_sub(to, from), part);
    Below nothing = {0};
    Reduced fresh =
        law_extend(&net->law, net->fresh_weight, vec3_distance(place, terminal), &nothing);
    *out = (Connection){.segment = i,
                        .bifurcation = place,
                        .radius = {kept, kept, net->radius_unit * gauge * fresh.rho},
                        .price = law_lambda_power(&net->law, gauge) * fresh.cost +
                                 net->sensitivity[i].extra +
                                 net->trunk->stake[i] * trunk_spent(net, i, 1, part)};
    return isfinite(out->price);
}

bool connection_estimate(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                         Connection *out)
{
    if (network_kept_radius(net, segment) > 0)
        return connect_to_trunk(net, rules, segment, terminal, out);
    Bifurcation problem = bifurcation_of(net, rules, segment, terminal);
    const Law law = network_law(net, segment);
    BifurcationState state;
    Vec3 middle = vec3_scale(vec3_add(problem.end[PROXIMAL], problem.end[DISTAL]), 0.5), place;
    bifurcation_at(&law, &problem, vec3_add_scaled(vec3_scale(middle, 0.75), terminal, 0.25),
                   &state);
    if (!bifurcation_next(&problem, &state, &place))
        return false;
    *out = (Connection){.segment = segment, .price = state.price, .bifurcation = place};
    for (int i = 0; i < ENDS; i++)
        out->price += state.weight[i] * (vec3_distance(problem.end[i], place) - state.length[i]);
    return true;
}

bool connection_may_split(const Network *net, const Grid *grid, const Rules *rules, int32_t segment)
{
    if (network_is_piece(net, segment) || network_kept_radius(net, segment) > 0)
        return true;
    const GridItem *item = &grid->item[segment];
    double width = 2 * length_reserve * rules->thickness * (double)item->radius;
    double least = 2 * (width > rules->least_length ? width : rules->least_length);
    return grid_length2(item) > least * least;
}

/* Whether the new segment of a connection to the trunk is longer than wide. */
static bool is_long_enough(const Rules *rules, const Connection *connection, Vec3 terminal)
{
    double width = 2 * length_reserve * rules->thickness * connection->radius[FRESH];
    return vec3_distance(connection->bifurcation, terminal) >= fmax(width, rules->least_length);
}

bool connection_optimise(const Network *net, const Rules *rules, Vec3 terminal,
                         Connection *connection)
{
    if (network_kept_radius(net, connection->segment) > 0)
        return is_long_enough(rules, connection, terminal);
    Bifurcation problem = bifurcation_of(net, rules, connection->segment, terminal);
    const Law law = network_law(net, connection->segment);
    Vec3 place = connection->bifurcation;
    for (int round = 0; round <= ROUNDS; round++) {
        BifurcationState state;
        bifurcation_at(&law, &problem, place, &state);
        if (!isfinite(state.price) || !bifurcation_is_long_enough(&problem, &state))
            return round > 0;
        connection->price = state.price;
        connection->bifurcation = place;
        memcpy(connection->radius, state.radius, sizeof state.radius);
        if (!bifurcation_next(&problem, &state, &place))
            break;
    }
    return true;
}

bool connection_settle(const Network *net, const Rules *rules, const Domain *domain, Vec3 terminal,
                       Connection *connection)
{
    if (network_is_given(net, connection->segment))
        return true;
    Bifurcation problem = bifurcation_of(net, rules, connection->segment, terminal);
    const Law law = network_law(net, connection->segment);
    BifurcationState state;
    bifurcation_at(&law, &problem, domain_settle(domain, connection->bifurcation), &state);
    connection->price = state.price;
    connection->bifurcation = state.place;
    memcpy(connection->radius, state.radius, sizeof state.radius);
    return isfinite(state.price) && bifurcation_is_long_enough(&problem, &state);
}

/* A segment of the connection, as wide as it will be. */
static Capsule capsule_of(const Network *net, const Connection *connection, Vec3 terminal, int part)
{
    int32_t host = connection->segment;
    Capsule capsule = {connection->bifurcation, terminal, connection->radius[part]};
    if (part == PROXIMAL)
        capsule = (Capsule){net->position[net->segment[host].parent], connection->bifurcation,
                            capsule.radius};
    else if (part == DISTAL)
        capsule.b = net->position[host];
    return capsule;
}

GridItem connection_item(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part)
{
    Capsule capsule = capsule_of(net, connection, terminal, part);
    double radius = capsule.radius;
    capsule.radius = entry_reach(rules, radius);
    return grid_item(grid, capsule, radius);
}

bool connections_are_clear(const Network *net, const Rules *rules, const Connection connection[2],
                           const Vec3 terminal[2])
{
    bool are_mates = network_mate(net, connection[0].segment) == connection[1].segment;
    for (int i = 0; i < ENDS; i++)
        for (int j = 0; j < ENDS; j++) {
            Capsule a = capsule_of(net, &connection[0], terminal[0], i);
            Capsule b = capsule_of(net, &connection[1], terminal[1], j);
            double clear = clearance_reserve * rules->thickness * (a.radius + b.radius) +
                           rules->gap + rules->apart;
            if (i == j && (i == FRESH || (i == DISTAL && are_mates)))
                clear = clear_of_mate(rules, clear);
            if (segment_distance2(a.a, a.b, b.a, b.b) < clear * clear)
                return false;
        }
    return true;
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

/* A new segment that is to keep clear of all others but its kin, those it shares a node with. */
typedef struct Newcomer {
    const Network *net;
    const Rules *rules;
    GridItem item;
    GridBoxQuery probe;
    double radius;  /* mm */
    int32_t mate;   /* the terminal that the one it ends in is paired with; -1: none */
    int32_t kin[4]; /* the first is the segment that is split */
} Newcomer;

/* The part of a connection as a newcomer: its kin are the segment that is split and all that end or
 * begin at the newcomer's outer end. */
static Newcomer newcomer(const Network *net, const Grid *grid, const Rules *rules,
                         const Connection *connection, Vec3 terminal, int part)
{
    int32_t host = connection->segment;
    Newcomer out = {.net = net,
                    .item = connection_item(net, grid, rules, connection, terminal, part),
                    .rules = rules,
                    .radius = connection->radius[part],
                    .mate = part == DISTAL ? network_mate(net, host) : -1,
                    .kin = {host, host, host, host}};
    double per_radius = clearance_reserve * rules->thickness;
    out.probe =
        grid_box_query(&out.item, per_radius * out.radius + rules->gap + rules->apart, per_radius);
    if (part != FRESH) {
        int32_t node = part == PROXIMAL ? net->segment[host].parent : host;
        out.kin[1] = node;
        out.kin[2] = net->segment[node].child[0];
        out.kin[3] = net->segment[node].child[1];
    }
    return out;
}

/* Whether the newcomer keeps clear of another segment. It has to keep the reserve as well, unless
 * the segment that is split was as near to the other. What begins in a given vessel of many pieces
 * overlaps the pieces next to its beginning: it only has to keep off their centrelines. */
static bool is_clear_of(const Grid *grid, const Newcomer *newcomer, int32_t other)
{
    const GridItem *item = &grid->item[other];
    const Rules *rules = newcomer->rules;
    double touch = rules->thickness * (newcomer->radius + (double)item->radius);
    double clear = clearance_reserve * touch + rules->gap;
    double apart2 = grid_distance2(&newcomer->item, item);
    bool is_mate = other == newcomer->mate;
    bool is_other_tree = rules->apart > 0 && network_tree(newcomer->net, other) !=
                                                 network_tree(newcomer->net, newcomer->kin[0]);
    if (is_other_tree)
        clear += rules->apart;
    if (is_mate)
        clear = clear_of_mate(rules, clear);
    if (apart2 >= clear * clear)
        return true;
    if (is_other_tree || is_mate)
        return false;
    touch = rules->gap + (network_is_piece(newcomer->net, other) ? 0 : touch);
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
    for (int part = 0; part < ENDS; part++) {
        Newcomer part_of = newcomer(net, grid, rules, connection, terminal, part);
        if (!grid_zone_holds(grid, zone, &part_of.item))
            return CONNECTION_BEYOND;
        bool is_given = part != FRESH && network_is_given(net, connection->segment);
        if (!is_given && !is_clear_all_along(grid, &part_of))
            return CONNECTION_BLOCKED;
    }
    return CONNECTION_CLEAR;
}
