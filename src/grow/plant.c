/* A tree takes a far point for its first, and asks for less with every few points that will not do.
 * Root segments stay in the Voronoi cells of their inlets, so they cannot cross; only their
 * thickness is left to look after. */
#include "grow/plant.h"

#include "grow/place.h"

/* Points after which less distance is asked for, by how much; and after which all is in vain. */
enum { TRIES_PER_NOTCH = 3, MAX_TRIES = 20000 };
static const double notch = 0.1;
/* Roots widen as trees grow. */
static const double reserve = 1.3;

/* A root segment that has yet to prove itself. */
typedef struct Shoot {
    Vec3 from, to;
    double radius; /* mm; at least what it will have while it is alone */
} Shoot;

static Shoot shoot_of(const Network *net, Vec3 from, Vec3 to)
{
    return (Shoot){from, to, net->radius_scale * sqrt(sqrt(vec3_distance(from, to)))};
}

static bool is_nearest(const Network *net, size_t tree, Vec3 point)
{
    double own = vec3_distance(point, net->position[net->inlet[tree]]);
    for (size_t k = 0; k < net->inlets; k++)
        if (k != tree && !(own < vec3_distance(point, net->position[net->inlet[k]])))
            return false;
    return true;
}

/* Whether the shoot keeps clear of the root segments of the trees before `tree`. */
static bool is_clear(const Network *net, size_t tree, const Shoot *shoot)
{
    for (size_t k = 0; k < tree; k++) {
        int32_t inlet = net->inlet[k];
        Shoot other =
            shoot_of(net, net->position[inlet], net->position[net->segment[inlet].child[0]]);
        double clear = reserve * (shoot->radius + other.radius);
        if (segment_distance2(shoot->from, shoot->to, other.from, other.to) < clear * clear)
            return false;
    }
    return true;
}

static Status plant_tree(Network *net, size_t tree, const Domain *domain, Random *random,
                         double *distance, uint64_t *tosses, Err *err)
{
    int32_t inlet = net->inlet[tree];
    Vec3 from = net->position[inlet];
    for (int tries = 1; tries <= MAX_TRIES; tries++) {
        Shoot shoot = shoot_of(net, from, domain_sample(domain, random));
        ++*tosses;
        if (vec3_distance(shoot.to, from) >= *distance && is_nearest(net, tree, shoot.to) &&
            (domain_is_convex(domain) || domain_holds_segment(domain, from, shoot.to)) &&
            is_clear(net, tree, &shoot)) {
            network_append(net, inlet, shoot.to);
            return STATUS_OK;
        }
        if (tries % TRIES_PER_NOTCH == 0)
            *distance *= 1 - notch;
    }
    if (net->inlets == 1)
        return err_set(err, STATUS_INFEASIBLE,
                       "no straight vessel leads from the inlet into the domain; choose an --inlet "
                       "further inside");
    return err_set(err, STATUS_INFEASIBLE,
                   "no straight vessel leads from --inlet %.9g,%.9g,%.9g into the domain, clear of "
                   "those of the other inlets; choose inlets further inside and further apart",
                   from.x, from.y, from.z);
}

Status plant_trees(Network *net, const Domain *domain, Random *random, double *distance,
                   uint64_t *tosses, Err *err)
{
    double farthest = *distance;
    for (size_t k = 0; k < net->inlets; k++) {
        double own = farthest;
        TRY(plant_tree(net, k, domain, random, &own, tosses, err));
        *distance = fmin(*distance, own);
    }
    network_resum(net);
    return STATUS_OK;
}
