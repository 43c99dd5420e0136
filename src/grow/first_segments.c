/* Places the first segment of each tree, from its inlet to a random point.
 *
 * The first terminal should be far from its inlet. The required distance therefore begins at the
 * size of the domain, and is lowered after every few points that are not suitable. First segments
 * stay in the Voronoi cells of their inlets, so that their centrelines cannot cross; only their
 * thickness is tested. */
#include "grow/first_segments.h"

#include "grow/mates.h"

/* After every TRIES_PER_NOTCH points that are not suitable, the required distance falls by the
 * fraction `notch`: slowly enough that a point near the far end of the domain is usually found.
 * After MAX_TRIES points the search fails; the distance is then 0 to rounding. */
enum { TRIES_PER_NOTCH = 3, MAX_TRIES = 20000 };
static const double notch = 0.1;
/* First segments keep clear of each other with this many times their radii, because they widen as
 * trees grow. A larger reserve refuses inlets that are close together. */
static const double reserve = 1.3;

/* Returns a root segment, or a candidate for one, with at least the radius that the segment has
 * while it is the only one of its tree. */
static Capsule root_segment(const Network *net, Vec3 from, Vec3 to)
{
    return (Capsule){from, to, net->radius_scale * sqrt(sqrt(vec3_distance(from, to)))};
}

static bool is_nearest(const Network *net, size_t tree, Vec3 point)
{
    double own = vec3_distance(point, net->position[net->inlet[tree]]);
    for (size_t k = 0; k < net->inlets; k++)
        if (k != tree && !(own < vec3_distance(point, net->position[net->inlet[k]])))
            return false;
    return true;
}

/* Returns true if the fresh segment keeps clear of the root segments of the trees before `tree`. */
static bool is_clear(const Site *site, size_t tree, const Capsule *fresh)
{
    const Network *net = &site->net;
    for (size_t k = 0; k < tree; k++) {
        int32_t inlet = net->inlet[k];
        Capsule other =
            root_segment(net, net->position[inlet], net->position[net->segment[inlet].child[0]]);
        double clear = reserve * (fresh->radius + other.radius) + site->rules.tree_gap;
        if (site->rules.pair_mm > 0)
            clear = pair_axis_distance(&site->rules, clear);
        if (segment_distance2(fresh->a, fresh->b, other.a, other.b) < clear * clear)
            return false;
    }
    return true;
}

/* Returns the terminal of the first tree, which has one. */
static int32_t first_terminal(const Network *net)
{
    return net->segment[net->inlet[0]].child[0];
}

/* Draws a random point of the domain; for the second tree of pairs, a mate of the first
 * tree's terminal. */
static Vec3 sample(const Site *site, size_t tree, Random *random)
{
    if (tree == 0 || site->rules.pair_mm == 0)
        return domain_sample(site->domain, random);
    return mates_place(site->net.position[first_terminal(&site->net)], site->rules.pair_mm,
                       site->domain->dimension, random);
}

/* Returns true if the tree's root segment may be the fresh one. */
static bool is_allowed(const Site *site, size_t tree, const Capsule *fresh)
{
    const Domain *domain = site->domain;
    return (site->rules.pair_mm > 0 ? domain_inside(domain, fresh->b, 0)
                                    : is_nearest(&site->net, tree, fresh->b)) &&
           (domain_is_convex(domain) || domain_holds_segment(domain, fresh->a, fresh->b)) &&
           is_clear(site, tree, fresh);
}

static Status add_first_segment(Site *site, size_t tree, FirstTosses *tosses, double *distance,
                                Err *err)
{
    Network *net = &site->net;
    int32_t inlet = net->inlet[tree];
    Vec3 from = net->position[inlet];
    for (int tries = 1; tries <= MAX_TRIES; tries++) {
        Capsule fresh = root_segment(net, from, sample(site, tree, tosses->random));
        tosses->count++;
        if (vec3_distance(fresh.b, from) >= *distance && is_allowed(site, tree, &fresh)) {
            int32_t end = network_append(net, inlet, fresh.b);
            if (tree == 1 && site->rules.pair_mm > 0)
                network_pair(net, first_terminal(net), end);
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

Status first_segments_add(Site *site, FirstTosses *tosses, Err *err)
{
    double farthest = tosses->distance;
    for (size_t k = 0; k < site->net.inlets; k++) {
        double own = farthest;
        TRY(add_first_segment(site, k, tosses, &own, err));
        tosses->distance = fmin(tosses->distance, own);
    }
    network_resum(&site->net);
    return STATUS_OK;
}
