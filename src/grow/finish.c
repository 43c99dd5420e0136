/* Makes a Tree of the grown network: computes the radii, the flow shares of the terminals and the
 * metadata.
 *
 * The radius of a segment is radius_unit * gauge * rho. `rho` depends on the segment's subtree and
 * is accumulated from the terminals to the root. `gauge` depends on the path from the root and is
 * multiplied from the root down. law.h derives both; there, radius_unit is q and gauge is g. Both
 * sweeps only add and multiply positive numbers. Nothing cancels, so every radius is exact to a few
 * units in the last place for any gamma. Murray's law holds by construction, because the load of a
 * parent is computed from the sum of rho^gamma over its daughters. The daughters of a bifurcation
 * begin at the same pressure, because they have the same gauge.
 *
 * If viscosity or gamma depend on the radius, two steps alternate until they agree: the radii, then
 * the viscosities and exponents at these radii. The iteration nearly always converges, because the
 * radius depends only on the fourth root of the viscosity, and the viscosity changes by far less
 * than the fourth power of the radius in all except the thinnest vessels. gamma depends only on the
 * logarithm of the radius. If a round changes the values by no less than the round before, the step
 * is halved. */
#include "grow/finish.h"

#include "grow/continue_tree.h"
#include "grow/mates.h"
#include "grow/segment_weights.h"
#include <assert.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Computes the radius of segment i, whose gauge is known, and the gauges of its daughters. A
 * segment of the trunk keeps its radius; the argument 1 of trunk_drop_fraction stands for its whole
 * length. */
static void sweep_node(const Network *net, size_t i, double *gauge, Tree *tree)
{
    const Segment *segment = &net->segment[i];
    double below = 1;
    double kept = network_kept_radius(net, (int32_t)i);
    if (kept > 0 && segment->parent >= 0) {
        tree->radius_mm[i] = kept;
        below = trunk_gauge(gauge[i], trunk_drop_fraction(net, (int32_t)i, segment->terminals, 1));
    } else if (segment->parent >= 0) {
        Reduced reduced = network_reduce(net, (int32_t)i);
        tree->radius_mm[i] = net->radius_unit * gauge[i] * reduced.rho;
        below = gauge[i] * reduced.widening;
    }
    for (int slot = 0; slot < 2 && segment->child[slot] >= 0; slot++)
        gauge[segment->child[slot]] = below;
}

/* Computes all radii from the values of the subtrees [network_reduce]. The root of a tree gets the
 * largest radius of the segments that begin there. */
static Status sweep_down(const Network *net, Tree *tree, Err *err)
{
    double *gauge = NULL;
    TRY(mem_calloc(&gauge, net->n, sizeof *gauge, "gauges", err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < net->n && status == STATUS_OK; i++) {
        sweep_node(net, i, gauge, tree);
        bool fits = tree->radius_mm[i] >= DBL_MIN && isfinite(tree->radius_mm[i]);
        if (!fits && net->segment[i].parent >= 0)
            status = err_set(err, STATUS_INFEASIBLE,
                             "the radii span more than a double can hold; move `gamma` towards 3");
    }
    for (size_t k = 0; k < net->inlets; k++)
        tree->radius_mm[net->inlet[k]] = 0;
    for (size_t i = 0; i < net->n; i++) {
        int32_t parent = net->segment[i].parent;
        if (parent >= 0 && net->segment[parent].parent < 0)
            tree->radius_mm[parent] = fmax(tree->radius_mm[parent], tree->radius_mm[i]);
    }
    free(gauge);
    return status;
}

/* Viscosities and exponents agree with the radii if a round changes them by no more than this
 * tolerance: viscosities relatively, exponents absolutely. It is some hundred units in the last
 * place, so that the written radii obey the law to rounding. */
static const double agreement = 1e-13;
/* Rounds after which the search fails. Most trees need far fewer; steps that were halved often need
 * more. */
enum { MAX_ROUNDS = 200 };

/* Finds radii that agree with the viscosities and exponents that follow from them. The flows follow
 * from the flow shares of the terminals and stay fixed. `part` is the fraction of each change that
 * a round applies. `flow` is a workspace of one number per node. */
static Status settle_radii(Network *net, const GrowParams *params, double *flow, Tree *tree,
                           Err *err)
{
    double part = 1, last = INFINITY, change;
    weights_flows(net, flow);
    for (int round = 0; round < MAX_ROUNDS; round++) {
        TRY(sweep_down(net, tree, err));
        TRY(weights_update(net, params, (WeightsInput){flow, tree->radius_mm, part}, &change, err));
        if (change <= agreement)
            return STATUS_OK;
        part = change < last ? part : part / 2;
        last = change;
        network_resum(net);
    }
    return err_set(
        err, STATUS_INFEASIBLE,
        params->gamma.n > 1
            ? "`gamma` changes too fast with the radius: the radii of %zu terminals do "
              "not converge; put its values at radii that are further apart"
            : "the vessels of %zu terminals are too thin for `viscosity_law` pries: "
              "radii and viscosities do not converge; lower `terminals` or raise `q_perf`",
        net->terminals);
}

/* Checks that the vessels whose radii are kept (the trunk) do not use up the pressure drop: a part
 * of it must remain for every subtree that branches off them [TRUNK_MOST_SPENT]. */
static Status check_trunk(const Network *net, const GrowParams *params, Err *err)
{
    double *spent = NULL;
    size_t where = 0;
    TRY(mem_calloc(&spent, net->n, sizeof *spent, "drops of pressure", err));
    double most = trunk_most_spent(net, spent, &where);
    free(spent);
    if (most <= TRUNK_MOST_SPENT)
        return STATUS_OK;
    Vec3 at = net->position[where];
    return err_set(err, STATUS_INFEASIBLE,
                   "`keep_radii`: the vessels of `from` are too narrow for `q_perf` %g ml/min: on "
                   "the path to (%.4g, %.4g, %.4g), where the radius is %.4g mm, the pressure "
                   "would fall by %.4g times `p_perf` - `p_term`; give a flow below %.4g ml/min",
                   params->blood.q_perf_ml_min, at.x, at.y, at.z, net->trunk->radius[where], most,
                   params->blood.q_perf_ml_min * TRUNK_MOST_SPENT / most);
}

/* Sets the radii of the tree, and its flow shares if they are not equal. */
static Status write_radii(Network *net, const GrowParams *params, Tree *tree, Err *err)
{
    if (!weights_are_needed(params))
        return sweep_down(net, tree, err);
    double *flow = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&flow, net->n, sizeof *flow, "flows", err));
    TRY_GOTO(settle_radii(net, params, flow, tree, err));
    if (params->blood.terminal_flow == TERMINAL_FLOW_EQUAL)
        goto done;
    TRY_GOTO(tree_add_flow_shares(tree, err));
    for (size_t i = 0; i < net->n; i++)
        tree->flow_share[i] = net->trait[i].share;
done:
    free(flow);
    return status;
}

/* Stores the description of the domain as metadata. A file in it is named without its folder. */
static Status describe_domain(const Domain *domain, TreeMeta *meta, Err *err)
{
    Text spec = TEXT_INIT, bare = TEXT_INIT;
    Status status;
    domain_text(domain, &spec);
    TRY_GOTO(text_check(&spec, err));
    const char *chars = text_chars(&spec);
    size_t kind = strcspn(chars, ":") + 1;
    text_append(&bare, chars, kind);
    text_put_line(&bare, file_name(chars + kind));
    TRY_GOTO(text_check(&bare, err));
    TRY_GOTO(meta_set_text(meta, META_DOMAIN, text_chars(&bare), err));
done:
    text_release(&spec);
    text_release(&bare);
    return status;
}

Status finish_describe(const GrowParams *params, const Domain *domain, TreeMeta *meta, Err *err)
{
    grow_describe(params, meta);
    meta_set_number(meta, META_DIMENSION, domain->dimension);
    TRY(meta_set_text(meta, META_GENERATOR, "corcast " CORCAST_VERSION, err));
    return describe_domain(domain, meta, err);
}

/* network_reorder puts parents before children, and network_resum then recomputes the values of all
 * subtrees in this order. */
Status finish_tree(Network *net, const GrowParams *params, const Domain *domain, Tree *out,
                   Err *err)
{
    network_free_workspace(net);
    TRY(network_reorder(net, err));
    network_resum(net);
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(tree_init(&made, net->n, err));
    TRY_GOTO(write_radii(net, params, &made, err));
    TRY_GOTO(finish_describe(params, domain, &made.meta, err));
    TRY_GOTO(meta_add_lines(&made.meta, err));
    static_assert(TREE_NO_PARENT == -1, "as in a Segment");
    for (size_t i = 0; i < net->n; i++) {
        made.type[i] = TREE_VESSEL_TYPE;
        made.parent[i] = net->segment[i].parent;
        made.position[i] = net->position[i];
    }
    tree_renumber(&made);
    if (params->pair_mm > 0)
        TRY_GOTO(mates_write(net, &made, err));
    if (net->trunk)
        TRY_GOTO(check_trunk(net, params, err));
    if (params->from)
        TRY_GOTO(continue_restore(params->from, net, &made, err));
    *out = made;
    return STATUS_OK;
done:
    tree_release(&made);
    return status;
}
