/* Places, records and checks the pairs of terminals of two trees, such as an artery and its vein,
 * that are a fixed distance apart.
 *
 * Directions are uniformly distributed: a uniformly distributed point on the unit sphere has a
 * uniformly distributed z, and a uniformly distributed angle about the z axis. */
#include "grow/mates.h"

#include <assert.h>
#include <stdlib.h>

Vec3 mates_place(Vec3 terminal, double distance_mm, int dimension, Random *random)
{
    double angle = FULL_TURN * random_uniform(random);
    double z = dimension == 3 ? 2 * random_uniform(random) - 1 : 0, across = sqrt(1 - z * z);
    return vec3_add_scaled(terminal,
                           vec3(across * elementary_cos(angle), across * elementary_sin(angle), z),
                           distance_mm);
}

Status mates_write(const Network *net, Tree *tree, Err *err)
{
    TreePair *pair = NULL;
    size_t n = 0;
    TRY(mem_calloc(&pair, net->n, sizeof *pair, "pairs", err));
    for (size_t i = 0; i < net->n; i++) {
        int32_t mate = network_mate(net, (int32_t)i);
        if (mate > (int32_t)i)
            pair[n++] = (TreePair){{(int32_t)i, mate}};
    }
    Status status = tree_set_pairs(tree, pair, n, err);
    free(pair);
    return status;
}

/* Returns the distance, mm, that the ends of a pair need so that the walls of its vessels keep
 * the clearance. */
static double needed(const GrowParams *params, const Tree *tree, TreePair pair)
{
    return params->clearance_mm + tree->radius_mm[pair.node[0]] + tree->radius_mm[pair.node[1]];
}

Status mates_check(const GrowParams *params, const Tree *tree, Err *err)
{
    TreePair *pair = NULL;
    size_t n = 0, worst = 0;
    double most = 0;
    TRY(tree_pairs(tree, &pair, &n, err));
    for (size_t k = 0; k < n; k++) {
        double apart =
            vec3_distance(tree->position[pair[k].node[0]], tree->position[pair[k].node[1]]);
        assert(fabs(apart / params->pair_mm - 1) < 1e-6);
        (void)apart;
        if (needed(params, tree, pair[k]) > most) {
            most = needed(params, tree, pair[k]);
            worst = k;
        }
    }
    Status status = STATUS_OK;
    if (most > params->pair_mm)
        status = err_set(err, STATUS_INFEASIBLE,
                         "`pair_mm` is %g; it must be at least %.4g, the radii %.4g and %.4g mm of "
                         "the paired nodes %d and %d plus the clearance; raise `pair_mm` or "
                         "`terminals`, or lower `q_perf`",
                         params->pair_mm, most, tree->radius_mm[pair[worst].node[0]],
                         tree->radius_mm[pair[worst].node[1]], tree->id[pair[worst].node[0]],
                         tree->id[pair[worst].node[1]]);
    free(pair);
    return status;
}
