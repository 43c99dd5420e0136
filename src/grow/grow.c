/* One terminal at a time [METHODS 1]: toss a random point until one is far enough from the tree,
 * connect it to each of the nearest segments at the bifurcation that is best for that segment, and
 * keep the cheapest connection that has room. The domain has its final size throughout: scaling all
 * lengths scales all costs alike, so this chooses as a domain that grows with the tree does.
 *
 * The toss distance starts where the last terminal was accepted, one notch up, and shrinks by a
 * notch after every few points that are too near, so it follows the filling of the domain without
 * being searched for anew. It shrinks, too, when points have no way to the tree within the tissue,
 * because nearer ones may. Connections are tested for room cheapest first, so most tests are never
 * made. When no point finds room at the vessels' real thickness, they are taken to be thinner, in
 * the end bare centrelines. */
#include "grow/grow.h"

#include "grow/finish.h"
#include "grow/grid.h"
#include "grow/network.h"
#include "grow/place.h"
#include <stdlib.h>

/* Cells of the grid a terminal, when the grid is made; it serves until the terminals doubled. */
static const double cells_per_terminal = 4;
/* The sensitivities serve until there are this many times the terminals. */
static const double refresh_growth = 1.1;
/* A notch of the toss distance, and the points tossed at each. */
static const double toss_notch = 0.9;
enum { TOSSES_PER_NOTCH = 10 };
/* Segments are no shorter than this share of the toss distance. */
static const double least_length_share = 0.1;
/* Points without a connection in a row: then vessels count as half as thick, below the least
 * thickness as lines, and at last the domain is full. */
enum { PATIENCE = 200, LAST_PATIENCE = 20000 };
static const double least_thickness = 1.0 / 64;
/* Radii enter the grid with the reserve the rules want and room to grow until it is made anew. */
static const double reach_reserve = 1.4;

typedef struct Growth {
    const GrowParams *params;
    const Domain *domain;
    double size; /* of the domain's box, mm */
    Network net;
    Grid grid;
    Random random;
    size_t grid_until, refresh_until; /* terminals */
    double toss_distance;             /* mm */
    Rules rules;
    Near *near; /* params->candidates of each */
    Connection *connections;
    uint64_t tosses, rejected;
} Growth;

static Status enter(Growth *growth, int32_t segment, Err *err)
{
    Capsule capsule = network_capsule(&growth->net, segment);
    capsule.radius = fmin(capsule.radius * reach_reserve * growth->rules.thickness, growth->size);
    bool terminal = growth->net.segment[segment].terminals == 1;
    return grid_add(&growth->grid, segment, terminal, capsule, err);
}

static Status make_grid(Growth *growth, Err *err)
{
    Network *net = &growth->net;
    size_t terminals = network_terminals(net);
    TRY(network_reorder(net, err));
    growth->grid_until = 2 * terminals;
    TRY(grid_reset(&growth->grid, domain_bounds(growth->domain),
                   cells_per_terminal * (double)terminals, 2 * growth->grid_until + 2, err));
    for (size_t i = 1; i < net->n; i++)
        TRY(enter(growth, (int32_t)i, err));
    return STATUS_OK;
}

/* Brings what ages with growth up to date when it is due. */
static Status keep_up(Growth *growth, Err *err)
{
    size_t terminals = network_terminals(&growth->net);
    if (terminals >= growth->refresh_until) {
        network_refresh(&growth->net);
        growth->refresh_until = (size_t)(refresh_growth * (double)terminals) + 1;
    }
    return terminals >= growth->grid_until ? make_grid(growth, err) : STATUS_OK;
}

static void set_toss_distance(Growth *growth, double distance)
{
    growth->toss_distance = fmin(distance, growth->size);
    growth->rules.least_length = least_length_share * growth->toss_distance;
}

static bool is_too_near(const Growth *growth, Vec3 point)
{
    if (growth->net.n == 1)
        return vec3_distance(point, growth->net.position[0]) < growth->toss_distance;
    return grid_any_within(&growth->grid, point, growth->toss_distance,
                           growth->params->toss == GROW_TOSS_TERMINAL);
}

/* A random point at the toss distance, which falls until there is one. */
static Vec3 toss(Growth *growth)
{
    for (int tries = 1;; tries++) {
        Vec3 point = domain_sample(growth->domain, &growth->random);
        growth->tosses++;
        if (!is_too_near(growth, point))
            return point;
        if (tries % TOSSES_PER_NOTCH == 0)
            set_toss_distance(growth, growth->toss_distance * toss_notch);
    }
}

typedef enum Choice {
    CHOICE_MADE,
    CHOICE_CROWDED, /* vessels are in the way */
    CHOICE_OUTSIDE, /* every way leads through what is not tissue */
} Choice;

/* The cheapest connection with room in *out, when there is one. */
static Choice choose(Growth *growth, Vec3 terminal, Connection *out)
{
    const Network *net = &growth->net;
    Connection *connections = growth->connections;
    if (place_is_in_vessel(net, &growth->grid, &growth->rules, terminal))
        return CHOICE_CROWDED;
    int near = grid_nearest(&growth->grid, terminal, growth->params->candidates, growth->near);
    int count = 0;
    for (int i = 0; i < near; i++)
        if (place_connection(net, &growth->rules, growth->near[i].segment, terminal,
                             &connections[count]))
            count++;
    Choice choice = count > 0 ? CHOICE_OUTSIDE : CHOICE_CROWDED;
    while (count > 0) {
        int best = 0;
        for (int i = 1; i < count; i++)
            if (connections[i].price < connections[best].price)
                best = i;
        if (place_is_inside(net, growth->domain, &connections[best], terminal)) {
            choice = CHOICE_CROWDED;
            if (place_is_free(net, &growth->grid, &growth->rules, &connections[best], terminal)) {
                *out = connections[best];
                return CHOICE_MADE;
            }
        }
        connections[best] = connections[--count];
    }
    return choice;
}

/* The first segment, from the inlet to a point that it reaches within the domain. */
static Status plant(Growth *growth, Err *err)
{
    for (int tries = 1; tries <= LAST_PATIENCE; tries++) {
        Vec3 point = toss(growth);
        if (domain_is_convex(growth->domain) ||
            domain_holds_segment(growth->domain, growth->net.position[0], point)) {
            network_plant(&growth->net, point);
            return STATUS_OK;
        }
        if (tries % TOSSES_PER_NOTCH == 0)
            set_toss_distance(growth, growth->toss_distance * toss_notch);
    }
    return err_set(err, STATUS_INFEASIBLE,
                   "no straight vessel leads from the inlet into the domain; choose an --inlet "
                   "further inside");
}

static Status connect(Growth *growth, const Connection *connection, Vec3 terminal, Err *err)
{
    Network *net = &growth->net;
    int32_t host = connection->segment, fresh = (int32_t)net->n;
    grid_remove(&growth->grid, host, net->position[net->segment[host].parent], net->position[host]);
    network_split(net, host, connection->bifurcation, terminal);
    TRY(enter(growth, host, err));
    TRY(enter(growth, fresh, err));
    return enter(growth, fresh + 1, err);
}

static Status check_range(const Growth *growth, Err *err)
{
    double cost = network_cost(&growth->net);
    if (cost > 0 && isfinite(cost))
        return STATUS_OK;
    return err_set(err, STATUS_INFEASIBLE,
                   "with --gamma %g and --lambda %g the radii of %zu terminals span more than a "
                   "double can hold; move --gamma towards 3, or lower --lambda",
                   growth->params->gamma, growth->params->lambda, growth->params->terminals);
}

static Status add_terminal(Growth *growth, Err *err)
{
    Rules *rules = &growth->rules;
    set_toss_distance(growth, growth->toss_distance / toss_notch);
    int crowded = 0, outside = 0;
    while (crowded + outside < LAST_PATIENCE) {
        Vec3 terminal = toss(growth);
        Connection connection = {0};
        Choice choice = choose(growth, terminal, &connection);
        if (choice == CHOICE_MADE)
            return connect(growth, &connection, terminal, err);
        growth->rejected++;
        if (choice == CHOICE_CROWDED && ++crowded % PATIENCE == 0)
            rules->thickness = rules->thickness > least_thickness ? rules->thickness / 2 : 0;
        if (choice == CHOICE_OUTSIDE && ++outside % TOSSES_PER_NOTCH == 0)
            set_toss_distance(growth, growth->toss_distance * toss_notch);
    }
    return err_set(err, STATUS_INFEASIBLE,
                   "no room for terminal %zu of --terminals %zu in %d tries: lower --terminals, "
                   "choose a larger --domain, or move --gamma and --lambda towards 3 and 2",
                   network_terminals(&growth->net) + 1, growth->params->terminals,
                   crowded + outside);
}

static Status start(Growth *growth, Err *err)
{
    const GrowParams *params = growth->params;
    const double pi = 3.14159265358979323846;
    Box box = domain_bounds(growth->domain);
    growth->size = vec3_distance(box.low, box.high);
    growth->rules = (Rules){.thickness = 1, .gap = 1e-7 * growth->size};
    set_toss_distance(growth, growth->size);
    growth->refresh_until = growth->grid_until = 1;
    random_seed(&growth->random, params->seed);
    size_t slots = (size_t)params->candidates;
    TRY(mem_calloc(&growth->near, slots, sizeof *growth->near, "candidates", err));
    TRY(mem_calloc(&growth->connections, slots, sizeof *growth->connections, "candidates", err));

    double drop = pa_from_mmhg(params->p_perf_mmhg) - pa_from_mmhg(params->p_term_mmhg);
    double resistance = 8 * pa_s_from_cp(params->viscosity_cp) / pi;
    double scale = sqrt(sqrt(resistance * mm3_s_from_ml_min(params->q_perf_ml_min) / drop));
    Vec3 inlet = params->has_inlet ? params->inlet : domain_default_inlet(growth->domain);
    return network_init(&growth->net, (Law){params->gamma, params->lambda}, scale,
                        params->terminals, inlet, err);
}

static void report_progress(const Growth *growth)
{
    size_t terminals = network_terminals(&growth->net);
    if (growth->params->progress && terminals % 256 == 0)
        growth->params->progress((double)terminals / (double)growth->params->terminals,
                                 growth->params->progress_context);
}

static double target_of(const Tree *tree)
{
    double target = 0;
    for (size_t i = 1; i < tree->n; i++)
        target += tree_segment_length(tree, i) * pow(tree->radius_mm[i], tree->header.lambda);
    return target;
}

Status grow_tree(const GrowParams *params, const Domain *domain, Tree *out, GrowReport *report,
                 Err *err)
{
    TRY(grow_params_check(params, domain, err));
    double begun = clock_seconds();
    Growth growth = {.params = params, .domain = domain};
    Status status = STATUS_OK;
    TRY_GOTO(start(&growth, err));
    TRY_GOTO(plant(&growth, err));
    while (network_terminals(&growth.net) < params->terminals) {
        TRY_GOTO(check_range(&growth, err));
        TRY_GOTO(keep_up(&growth, err));
        status = add_terminal(&growth, err);
        if (status == STATUS_INFEASIBLE && params->partial)
            break;
        TRY_GOTO(status);
        report_progress(&growth);
    }
    bool complete = status == STATUS_OK;
    TRY_GOTO(check_range(&growth, err));
    grid_release(&growth.grid);
    TRY_GOTO(finish_tree(&growth.net, params, domain, out, err));
    if (report)
        *report = (GrowReport){.seconds = clock_seconds() - begun,
                               .terminals = network_terminals(&growth.net),
                               .target = target_of(out),
                               .root_radius_mm = out->radius_mm[0],
                               .tosses = growth.tosses,
                               .rejected = growth.rejected,
                               .thickness = growth.rules.thickness,
                               .complete = complete};
done:
    free(growth.near);
    free(growth.connections);
    grid_release(&growth.grid);
    network_release(&growth.net);
    return status;
}
