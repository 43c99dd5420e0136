/* The cost of a connection depends on the bifurcation through three lengths only. Where it is
 * least, the derivatives with respect to them pull evenly: the point is the weighted Fermat point
 * for these derivatives as weights [fermat.h]. They vary slowly, so weights at one point and the
 * Fermat point for them in turn converge in a few rounds. A point that collapses onto an end is
 * pushed off it to the shortest length the rules allow, in the direction that costs least: such
 * connections are among the best there are, so they must not be lost. */
#include "grow/place.h"

#include "grow/fermat.h"

enum { PROXIMAL, DISTAL, FRESH, ENDS };
enum { ROUNDS = 3 };
/* Vessels widen as the tree below them grows: the rules hold for radii this much greater, and so at
 * the end of growth for nearly all vessels at their final radii. */
static const double widening_reserve = 1.15;

typedef struct Trial {
    double price;
    double weight[ENDS]; /* d price / d length, greatest 1 */
    double radius[ENDS]; /* mm */
} Trial;

/* False when the trial's figures are beyond what a double can hold. */
static bool evaluate(const Network *net, int32_t host, const Reduced *before,
                     const double length[ENDS], Trial *out)
{
    const Law *law = &net->law;
    double n = net->segment[host].terminals, gauge = (double)net->segment[host].gauge;
    Reduced distal = law_reduce(law, n, length[DISTAL], before->flare_below, before->cost_below);
    Reduced fresh = law_reduce(law, 1, length[FRESH], 0, 0);
    Reduced proximal = law_reduce(law, n + 1, length[PROXIMAL], distal.flare + fresh.flare,
                                  distal.cost + fresh.cost);

    Adjoint top = {net->sensitivity[host].load, law_lambda_power(law, gauge)};
    Adjoint distal_adjoint = law_descend(law, &proximal, top, &distal);
    Adjoint fresh_adjoint = law_descend(law, &proximal, top, &fresh);
    out->price = top.load * (proximal.load - before->load) +
                 top.cost * (proximal.cost - before->cost) + net->sensitivity[host].extra;
    out->weight[PROXIMAL] = law_length_weight(law, &proximal, top, n + 1);
    out->weight[DISTAL] = law_length_weight(law, &distal, distal_adjoint, n);
    out->weight[FRESH] = law_length_weight(law, &fresh, fresh_adjoint, 1);

    double unit = network_radius_unit(net) * gauge;
    out->radius[PROXIMAL] = unit * proximal.rho;
    out->radius[DISTAL] = unit * proximal.widening * distal.rho;
    out->radius[FRESH] = unit * proximal.widening * fresh.rho;

    double greatest = fmax(out->weight[0], fmax(out->weight[1], out->weight[2]));
    if (!isfinite(out->price) || !isfinite(greatest) || !(greatest > 0))
        return false;
    for (int end = 0; end < ENDS; end++) /* none pushes: Fermat's point wants weights above 0 */
        out->weight[end] = fmax(out->weight[end] / greatest, 1e-9);
    return true;
}

static double shortest(const Rules *rules, double radius)
{
    return fmax(rules->least_length, 2 * widening_reserve * rules->thickness * radius);
}

/* Keeps the bifurcation off the three ends. */
static Vec3 push_off(const Rules *rules, const Vec3 end[ENDS], const Trial *trial,
                     const Fermat *fermat)
{
    Vec3 place = fermat->place;
    for (int i = 0; i < ENDS; i++) {
        double least = 1.01 * shortest(rules, trial->radius[i]); /* the radius moves a little too */
        Vec3 away = vec3_sub(place, end[i]);
        double distance = vec3_length(away);
        if (distance >= least)
            continue;
        Vec3 direction = fermat->corner == i ? fermat->inward : away;
        double length = vec3_length(direction);
        if (length > 0)
            place = vec3_add_scaled(end[i], direction, least / length);
    }
    return place;
}

static void measure(const Vec3 end[ENDS], Vec3 place, double length[ENDS])
{
    for (int i = 0; i < ENDS; i++)
        length[i] = vec3_distance(end[i], place);
}

bool place_connection(const Network *net, const Rules *rules, int32_t segment, Vec3 terminal,
                      Connection *out)
{
    Vec3 end[ENDS] = {net->position[net->segment[segment].parent], net->position[segment],
                      terminal};
    Reduced before = network_reduce(net, segment);
    Vec3 middle = vec3_scale(vec3_add(end[PROXIMAL], end[DISTAL]), 0.5);
    Vec3 place = vec3_add_scaled(vec3_scale(middle, 0.75), terminal, 0.25);
    double length[ENDS];
    Trial trial;
    for (int round = 0; round < ROUNDS; round++) {
        measure(end, place, length);
        if (!evaluate(net, segment, &before, length, &trial))
            return false;
        Fermat fermat = fermat_point(end, trial.weight);
        place = push_off(rules, end, &trial, &fermat);
    }
    measure(end, place, length);
    if (!evaluate(net, segment, &before, length, &trial))
        return false;
    for (int i = 0; i < ENDS; i++)
        if (!(length[i] >= shortest(rules, trial.radius[i])))
            return false;
    *out = (Connection){segment,
                        trial.price,
                        place,
                        {trial.radius[PROXIMAL], trial.radius[DISTAL], trial.radius[FRESH]}};
    return true;
}

static double clamp01(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

bool place_is_in_vessel(const Network *net, const Grid *grid, const Rules *rules, Vec3 point)
{
    for (int32_t at = grid->head[grid_cell_at(grid, point)]; at >= 0; at = grid->entry[at].next) {
        int32_t i = grid->entry[at].tag >> 1;
        Vec3 a = net->position[net->segment[i].parent];
        Vec3 u = vec3_sub(net->position[i], a), w = vec3_sub(point, a);
        Vec3 apart = vec3_add_scaled(w, u, -clamp01(vec3_dot(u, w) / vec3_dot(u, u)));
        double radius = rules->thickness * (double)net->segment[i].radius;
        if (vec3_dot(apart, apart) < radius * radius)
            return true;
    }
    return false;
}

double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
{
    Vec3 u = vec3_sub(a1, a0), v = vec3_sub(b1, b0), w = vec3_sub(a0, b0);
    double uu = vec3_dot(u, u), vv = vec3_dot(v, v), uv = vec3_dot(u, v);
    double uw = vec3_dot(u, w), vw = vec3_dot(v, w);
    double denominator = uu * vv - uv * uv;
    double s = denominator > 0 ? clamp01((uv * vw - uw * vv) / denominator) : 0;
    double t = (uv * s + vw) / vv;
    if (t < 0 || t > 1) {
        t = clamp01(t);
        s = clamp01((uv * t - uw) / uu);
    }
    Vec3 apart = vec3_add_scaled(vec3_add_scaled(w, u, s), v, -t);
    return vec3_dot(apart, apart);
}

/* Whether the capsule keeps clear of all segments but `host` and those that end or begin at `node`
 * (-1: none). */
static bool is_clear(const Network *net, const Grid *grid, const Rules *rules, Capsule capsule,
                     int32_t host, int32_t node)
{
    double scale = widening_reserve * rules->thickness;
    capsule.radius = scale * capsule.radius + rules->gap;
    size_t cell;
    for (GridWalk walk = grid_walk(grid, capsule); grid_walk_next(&walk, &cell);) {
        for (int32_t at = grid->head[cell]; at >= 0; at = grid->entry[at].next) {
            int32_t other = grid->entry[at].tag >> 1;
            int32_t parent = net->segment[other].parent;
            if (other == host || other == node || parent == node)
                continue;
            double clearance = capsule.radius + scale * (double)net->segment[other].radius;
            if (segment_distance2(capsule.a, capsule.b, net->position[parent],
                                  net->position[other]) < clearance * clearance)
                return false;
        }
    }
    return true;
}

bool place_is_inside(const Network *net, const Domain *domain, const Connection *connection,
                     Vec3 terminal)
{
    int32_t host = connection->segment;
    Vec3 fork = connection->bifurcation;
    return domain_inside(domain, fork, 0) &&
           (domain_is_convex(domain) ||
            (domain_holds_segment(domain, fork, terminal) &&
             domain_holds_segment(domain, net->position[net->segment[host].parent], fork) &&
             domain_holds_segment(domain, fork, net->position[host])));
}

bool place_is_free(const Network *net, const Grid *grid, const Rules *rules,
                   const Connection *connection, Vec3 terminal)
{
    int32_t host = connection->segment, parent = net->segment[host].parent;
    Vec3 fork = connection->bifurcation;
    const double *radius = connection->radius;
    return is_clear(net, grid, rules, (Capsule){fork, terminal, radius[FRESH]}, host, -1) &&
           is_clear(net, grid, rules, (Capsule){net->position[parent], fork, radius[PROXIMAL]},
                    host, parent) &&
           is_clear(net, grid, rules, (Capsule){fork, net->position[host], radius[DISTAL]}, host,
                    host);
}
