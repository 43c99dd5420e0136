/* The first terminal of a tree should be far from its inlet, so the distance asked for begins at
 * the size of the domain and is lowered with every few points that will not do. Root segments stay
 * in the Voronoi cells of their inlets, so their centrelines cannot cross; only their thickness is
 * left to test. */
#include "grow/first_segments.h"

#include "grow/connection.h"
#include "grow/mates.h"

/* After every TRIES_PER_NOTCH points that will not do, the distance asked for falls by the fraction
 * `notch`; after MAX_TRIES there is no root segment. */
enum { TRIES_PER_NOTCH = 3, MAX_TRIES = 20000 };
static const double notch = 0.1;
/* Root segments keep clear of each other at this many times their radii: they widen as trees grow.
 */
static const double reserve = 1.3;

/* A root segment, or a candidate for one. */
typedef struct FirstSegment {
    Vec3 from, to;
    double radius; /* mm; at least what it will have while it is alone */
} FirstSegment;

static FirstSegment first_segment(const Network *net, Vec3 from, Vec3 to)
{
    return (FirstSegment){from, to, net->radius_scale * sqrt(sqrt(vec3_distance(from, to)))};
}

static bool is_nearest(const Network *net, size_t tree, Vec3 point)
{
    double own = vec3_distance(point, net->position[net->inlet[tree]]);
    for (size_t k = 0; k < net->inlets; k++)
        if (k != tree && !(own < vec3_distance(point, net->position[net->inlet[k]])))
            return false;
    return true;
}

/* Whether the fresh segment keeps clear of the root segments of the trees before `tree`. */
static bool is_clear(const Network *net, size_t tree, const FirstSegment *fresh, const Rules *rules)
{
    for (size_t k = 0; k < tree; k++) {
        int32_t inlet = net->inlet[k];
        FirstSegment other =
            first_segment(net, net->position[inlet], net->position[net->segment[inlet].child[0]]);
        double clear = reserve * (fresh->radius + other.radius) + rules->apart;
        if (rules->pair > 0)
            clear = clear_of_mate(rules, clear);
        if (segment_distance2(fresh->from, fresh->to, other.from, other.to) < clear * clear)
            return false;
    }
    return true;
}

/* A random point of the domain; for the second tree of pairs a mate of the first's terminal. */
static Vec3 sample(const Network *net, size_t tree, const Domain *domain, const Rules *rules,
                   Random *random)
{
    if (tree == 0 || rules->pair == 0)
        return domain_sample(domain, random);
    return mates_place(net->position[net->segment[net->inlet[0]].child[0]], rules->pair,
                       domain->dimension, random);
}

/* Whether the segment is where that of the tree may be. */
static bool is_allowed(const Network *net, size_t tree, const Domain *domain, const Rules *rules,
                       const FirstSegment *fresh)
{
    return (rules->pair > 0 ? domain_inside(domain, fresh->to, 0)
                            : is_nearest(net, tree, fresh->to)) &&
           (domain_is_convex(domain) || domain_holds_segment(domain, fresh->from, fresh->to)) &&
           is_clear(net, tree, fresh, rules);
}

static Status add_first_segment(Network *net, size_t tree, const Domain *domain, const Rules *rules,
                                Random *random, double *distance, uint64_t *tosses, Err *err)
{
    int32_t inlet = net->inlet[tree];
    Vec3 from = net->position[inlet];
    for (int tries = 1; tries <= MAX_TRIES; tries++) {
        FirstSegment fresh = first_segment(net, from, sample(net, tree, domain, rules, random));
        ++*tosses;
        if (vec3_distance(fresh.to, from) >= *distance &&
            is_allowed(net, tree, domain, rules, &fresh)) {
            int32_t end = network_append(net, inlet, fresh.to);
            if (tree == 1 && rules->pair > 0)
                network_pair(net, net->segment[net->inlet[0]].child[0], end);
            return STATUS_OK;
        }
        if (tries % TRIES_PER_NOTCH == 0)
            *distance *= 1 - notch;
    }
    if (net->inlets == 1)
        return err_set(err, STATUS_INFEASIBLE,
                       "no straight vessel leads from the inlet into the domain; choose an `inlet` "
                       "further inside");
    return err_set(err, STATUS_INFEASIBLE,
                   "no straight vessel leads from `inlet` %.9g,%.9g,%.9g into the domain, clear of "
                   "those of the other inlets; choose inlets further inside and further apart",
                   from.x, from.y, from.z);
}

Status first_segments_add(Network *net, const Domain *domain, const Rules *rules, Random *random,
                          double *distance, uint64_t *tosses, Err *err)
{
    double farthest = *distance;
    for (size_t k = 0; k < net->inlets; k++) {
        double own = farthest;
        TRY(add_first_segment(net, k, domain, rules, random, &own, tosses, err));
        *distance = fmin(*distance, own);
    }
    network_resum(net);
    return STATUS_OK;
}
