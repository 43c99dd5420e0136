/* Plans the connection of a new terminal to a segment of the tree: the position of the bifurcation
 * that splits the segment, the increase of the target (the price), and whether there is space.
 *
 * The optimiser of a bifurcation [bifurcation.h] finds the position. connection_estimate ranks
 * candidates: it makes one round of the optimiser from a position in the middle, and computes the
 * price to first order with the same weights. connection_optimise makes the remaining rounds, only
 * for connections that may be used. The most expensive tests come last: whether the segments are in
 * the domain (connection_is_inside), and whether they are clear of all other segments
 * (connection_clearance). */
#include "grow/connection.h"

#include <string.h>

/* Vessels widen as the tree below them grows. The rules of length and of clearance are therefore
 * tested with radii multiplied by these factors, so that at the end of growth nearly all vessels
 * keep the rules with their final radii; repair.c mends the others. Larger factors leave more
 * points without a connection, smaller ones leave more to repair. */
static const double length_reserve = 1.15, clearance_reserve = 1.1;
/* Bifurcations keep this many times the minimum length from the ends. The minimum depends on radii,
 * which change a little with the position; without the margin, the next round of the optimiser
 * would find the segment too short. */
static const double margin = 1.02;
/* Rounds of the optimiser for a connection that may be used: it converges in a few rounds
 * [cco/bifurcation.c], and estimating has made one. */
enum { ROUNDS = 2 };

/* Minimum length of the parts into which a piece of a given vessel [network_is_piece] is split,
 * relative to the piece, for any radius. Pieces may be shorter than wide, so that the rule of
 * length cannot apply. A little less than a quarter, so that the middle half is free to choose. */
static const double least_part_of_piece = 0.24;

/* Returns the problem of the bifurcation at which segment i would be split for `terminal`. */
static Bifurcation bifurcation_of(const Site *site, int32_t i, Vec3 terminal)
{
    const Network *net = &site->net;
    const Segment *segment = &net->segment[i];
    int32_t terminals = segment->terminals;
    double gauge = (double)segment->gauge;
    Bifurcation out = {.end = {net->position[segment->parent], net->position[i], terminal},
                       .burden = {network_burden(net, i, terminals + 1),
                                  network_burden(net, i, terminals), net->new_terminal_weight},
                       .below = {network_below(net, i)},
                       .adjoint = {net->sensitivity[i].load, law_lambda_power(&net->law, gauge)},
                       .radius_unit = net->radius_unit * gauge,
                       .extra = net->sensitivity[i].extra,
                       .min_length = site->rules.min_length,
                       .min_diameters = length_reserve * site->rules.thickness,
                       .min_part_length = network_is_piece(net, i)
                                              ? least_part_of_piece * segment->length
                                              : (double)INFINITY,
                       .margin = margin,
                       .straight = network_is_given(net, i)};
    const Law law = network_law(net, i);
    Reduced whole = law_add_segment(&law, out.burden[DISTAL], segment->length, &out.below[0]);
    out.load_before = whole.load;
    out.cost_before = whole.cost;
    return out;
}

/* Returns the minimum length, mm, of a segment of `radius` mm. */
static double min_length(const Rules *rules, double radius)
{
    return fmax(2 * length_reserve * rules->thickness * radius, rules->min_length);
}

/* Returns the position, 0 to 1 along the segment from a to b, that is nearest to `terminal`, but at
 * least `least` mm from both ends. */
static double nearest_part(Vec3 a, Vec3 b, Vec3 terminal, double length, double least)
{
    double part = vec3_dot(vec3_sub(terminal, a), vec3_sub(b, a)) / (length * length);
    return fmin(fmax(part, least / length), 1 - least / length);
}

/* Estimates the connection to a segment of the trunk, which keeps its radius [trunk.c]: a straight
 * one to the nearest point, because the pressure drop up to there changes little along a
 * segment. */
static bool connect_to_trunk(const Site *site, int32_t i, Vec3 terminal, Connection *out)
{
    const Network *net = &site->net;
    const Segment *segment = &net->segment[i];
    double kept = net->trunk->radius[i], length = segment->length;
    Vec3 from = net->position[segment->parent], to = net->position[i];
    double least = fmin(min_length(&site->rules, kept), least_part_of_piece * length);
    double part = nearest_part(from, to, terminal, length, least);
    double gauge = trunk_gauge((double)segment->gauge,
                               trunk_drop_fraction(net, i, segment->terminals + 1, part));
    Vec3 place = vec3_add_scaled(from, vec3_sub(to, from), part);
    Subtree nothing = {0};
    Reduced fresh = law_add_segment(&net->law, net->new_terminal_weight,
                                    vec3_distance(place, terminal), &nothing);
    *out = (Connection){.terminal = terminal,
                        .segment = i,
                        .bifurcation = place,
                        .radius = {kept, kept, net->radius_unit * gauge * fresh.rho},
                        .price = law_lambda_power(&net->law, gauge) * fresh.cost +
                                 net->sensitivity[i].extra +
                                 net->trunk->drop_cost[i] * trunk_drop_fraction(net, i, 1, part)};
    return isfinite(out->price);
}

bool connection_estimate(const Site *site, int32_t segment, Vec3 terminal, Connection *out)
{
    if (network_kept_radius(&site->net, segment) > 0)
        return connect_to_trunk(site, segment, terminal, out);
    Bifurcation problem = bifurcation_of(site, segment, terminal);
    const Law law = network_law(&site->net, segment);
    BifurcationState state;
    Vec3 middle = vec3_scale(vec3_add(problem.end[PROXIMAL], problem.end[DISTAL]), 0.5), place;
    bifurcation_at(&law, &problem, vec3_add_scaled(vec3_scale(middle, 0.75), terminal, 0.25),
                   &state);
    if (!bifurcation_next(&problem, &state, &place))
        return false;
    *out = (Connection){
        .terminal = terminal, .segment = segment, .price = state.price, .bifurcation = place};
    for (int i = 0; i < ENDS; i++)
        out->price += state.weight[i] * (vec3_distance(problem.end[i], place) - state.length[i]);
    return true;
}

bool connection_may_split(const Site *site, int32_t segment)
{
    if (network_is_piece(&site->net, segment) || network_kept_radius(&site->net, segment) > 0)
        return true;
    const GridItem *item = &site->grid.item[segment];
    double width = 2 * length_reserve * site->rules.thickness * (double)item->radius;
    double least = 2 * (width > site->rules.min_length ? width : site->rules.min_length);
    return grid_length2(item) > least * least;
}

/* Sets position, price and radii of the connection from the state of its bifurcation. */
static void take_state(const BifurcationState *state, Connection *connection)
{
    connection->price = state->price;
    connection->bifurcation = state->place;
    memcpy(connection->radius, state->radius, sizeof state->radius);
}

bool connection_optimise(const Site *site, Connection *connection)
{
    int32_t host = connection->segment;
    if (network_kept_radius(&site->net, host) > 0)
        return vec3_distance(connection->bifurcation, connection->terminal) >=
               min_length(&site->rules, connection->radius[FRESH]);
    Bifurcation problem = bifurcation_of(site, host, connection->terminal);
    const Law law = network_law(&site->net, host);
    Vec3 place = connection->bifurcation;
    for (int round = 0; round <= ROUNDS; round++) {
        BifurcationState state;
        bifurcation_at(&law, &problem, place, &state);
        if (!isfinite(state.price) || !bifurcation_is_long_enough(&problem, &state))
            return round > 0;
        take_state(&state, connection);
        if (!bifurcation_next(&problem, &state, &place))
            break;
    }
    return true;
}

bool connection_project(const Site *site, Connection *connection)
{
    int32_t host = connection->segment;
    if (network_is_given(&site->net, host))
        return true;
    Bifurcation problem = bifurcation_of(site, host, connection->terminal);
    const Law law = network_law(&site->net, host);
    BifurcationState state;
    bifurcation_at(&law, &problem, domain_project(site->domain, connection->bifurcation), &state);
    take_state(&state, connection);
    return isfinite(state.price) && bifurcation_is_long_enough(&problem, &state);
}

/* Returns a segment of the connection, with the radius that it will have. */
static Capsule capsule_of(const Network *net, const Connection *connection, int part)
{
    int32_t host = connection->segment;
    Vec3 fork = connection->bifurcation;
    double radius = connection->radius[part];
    if (part == PROXIMAL)
        return (Capsule){net->position[net->segment[host].parent], fork, radius};
    return (Capsule){fork, part == DISTAL ? net->position[host] : connection->terminal, radius};
}

GridItem connection_item(const Site *site, const Connection *connection, int part)
{
    Capsule capsule = capsule_of(&site->net, connection, part);
    double radius = capsule.radius;
    capsule.radius = site_reach(&site->rules, radius);
    return grid_item(&site->grid, capsule, radius);
}

bool connections_are_clear(const Site *site, const Connection connection[2])
{
    const Network *net = &site->net;
    const Rules *rules = &site->rules;
    bool are_mates = network_mate(net, connection[0].segment) == connection[1].segment;
    for (int i = 0; i < ENDS; i++)
        for (int j = 0; j < ENDS; j++) {
            Capsule a = capsule_of(net, &connection[0], i);
            Capsule b = capsule_of(net, &connection[1], j);
            double clear = clearance_reserve * rules->thickness * (a.radius + b.radius) +
                           rules->gap + rules->tree_gap;
            if (i == j && (i == FRESH || (i == DISTAL && are_mates)))
                clear = pair_axis_distance(rules, clear);
            if (segment_distance2(a.a, a.b, b.a, b.b) < clear * clear)
                return false;
        }
    return true;
}

bool connection_is_inside(const Site *site, const Connection *connection)
{
    const Domain *domain = site->domain;
    const Network *net = &site->net;
    int32_t host = connection->segment;
    Vec3 fork = connection->bifurcation, terminal = connection->terminal;
    if (network_is_given(net, host))
        return domain_inside(domain, fork, 0) && domain_holds_segment(domain, fork, terminal);
    return domain_inside(domain, fork, 0) &&
           (domain_is_convex(domain) ||
            (domain_holds_segment(domain, fork, terminal) &&
             domain_holds_segment(domain, net->position[net->segment[host].parent], fork) &&
             domain_holds_segment(domain, fork, net->position[host])));
}

/* A new segment that must keep clear of all segments except its kin, with which it shares a
 * node. */
typedef struct Newcomer {
    const Site *site;
    GridItem item;
    GridBoxQuery probe;
    double radius;  /* mm */
    int32_t mate;   /* the terminal that is paired with the newcomer's distal end; -1: none */
    int32_t kin[4]; /* the first is the segment that is split */
} Newcomer;

/* Returns a part of a connection as a newcomer: its kin are the segment that is split and all that
 * end or begin at the newcomer's outer end. */
static Newcomer newcomer(const Site *site, const Connection *connection, int part)
{
    const Network *net = &site->net;
    const Rules *rules = &site->rules;
    int32_t host = connection->segment;
    Newcomer out = {.site = site,
                    .item = connection_item(site, connection, part),
                    .radius = connection->radius[part],
                    .mate = part == DISTAL ? network_mate(net, host) : -1,
                    .kin = {host, host, host, host}};
    double per_radius = clearance_reserve * rules->thickness;
    out.probe = grid_box_query(&out.item, per_radius * out.radius + rules->gap + rules->tree_gap,
                               per_radius);
    if (part != FRESH) {
        int32_t node = part == PROXIMAL ? net->segment[host].parent : host;
        out.kin[1] = node;
        out.kin[2] = net->segment[node].child[0];
        out.kin[3] = net->segment[node].child[1];
    }
    return out;
}

/* Returns true if the newcomer keeps clear of another segment. The newcomer must keep the reserve
 * as well, unless the segment that is split was as near to the other; then it only must not touch
 * it. A newcomer that begins in a given vessel of many pieces overlaps the pieces next to its
 * beginning, and must only avoid their centrelines. */
static bool is_clear_of(const Newcomer *newcomer, int32_t other)
{
    const Network *net = &newcomer->site->net;
    const Rules *rules = &newcomer->site->rules;
    const GridItem *items = newcomer->site->grid.item, *item = &items[other];
    int32_t host = newcomer->kin[0];
    double touch = rules->thickness * (newcomer->radius + (double)item->radius);
    double clear = clearance_reserve * touch + rules->gap;
    double apart2 = grid_distance2(&newcomer->item, item);
    bool is_mate = other == newcomer->mate;
    bool is_other_tree = rules->tree_gap > 0 && network_tree(net, other) != network_tree(net, host);
    if (is_other_tree)
        clear += rules->tree_gap;
    if (is_mate)
        clear = pair_axis_distance(rules, clear);
    if (apart2 >= clear * clear)
        return true;
    if (is_other_tree || is_mate)
        return false;
    touch = rules->gap + (network_is_piece(net, other) ? 0 : touch);
    return apart2 >= touch * touch && apart2 >= grid_distance2(&items[host], item);
}

/* Returns true if the newcomer keeps clear of all segments except its kin. */
static bool is_clear(const Newcomer *newcomer)
{
    const int32_t *kin = newcomer->kin;
    int32_t other;
    for (GridVisit visit = grid_visit(&newcomer->site->grid, &newcomer->item);
         grid_visit_near(&visit, &newcomer->probe, &other);)
        if (other != kin[0] && other != kin[1] && other != kin[2] && other != kin[3] &&
            !is_clear_of(newcomer, other))
            return false;
    return true;
}

ConnectionClearance connection_clearance(const Site *site, Box zone, const Connection *connection)
{
    for (int part = 0; part < ENDS; part++) {
        Newcomer part_of = newcomer(site, connection, part);
        if (!grid_zone_holds(&site->grid, zone, &part_of.item))
            return CONNECTION_UNDECIDED;
        bool is_given = part != FRESH && network_is_given(&site->net, connection->segment);
        if (!is_given && !is_clear(&part_of))
            return CONNECTION_BLOCKED;
    }
    return CONNECTION_CLEAR;
}
