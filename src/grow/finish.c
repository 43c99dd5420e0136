/* Radii are r = q g rho: rho is summed up from the terminals, g multiplied down from the root
 * [law.h]. Both sweeps only add and multiply positive numbers, so nothing cancels and every radius
 * is exact to a few units in the last place for any gamma: Murray's law holds by the definition of
 * P, and the daughters of a bifurcation see one pressure by that of g. */
#include "grow/finish.h"

#include <float.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static Status sweep_down(const Network *net, Tree *tree, Err *err)
{
    double unit = net->radius_unit;
    double *gauge = NULL;
    TRY(mem_calloc(&gauge, net->n, sizeof *gauge, "gauges", err));
    gauge[1] = 1;
    Status status = STATUS_OK;
    for (size_t i = 1; i < net->n && status == STATUS_OK; i++) {
        Reduced reduced = network_reduce(net, (int32_t)i);
        tree->radius_mm[i] = unit * gauge[i] * reduced.rho;
        for (int slot = 0; slot < 2; slot++)
            if (net->segment[i].child[slot] >= 0)
                gauge[net->segment[i].child[slot]] = gauge[i] * reduced.widening;
        if (!(tree->radius_mm[i] >= DBL_MIN) || !isfinite(tree->radius_mm[i]))
            status = err_set(err, STATUS_INFEASIBLE,
                             "the radii span more than a double can hold; move --gamma, now %g, "
                             "towards 3",
                             net->law.gamma);
    }
    tree->radius_mm[0] = tree->radius_mm[1];
    free(gauge);
    return status;
}

static Status add_number(Tree *tree, const char *key, double value, Err *err)
{
    char number[NUMBER_TEXT_SIZE], line[128];
    snprintf(line, sizeof line, "%s: %s", key, number_text(value, number));
    return tree_add_line(tree, line, err);
}

/* Of a domain from a file, the header tells the file's name, not the user's folders. */
static Status add_domain(Tree *tree, const Domain *domain, Err *err)
{
    Text spec = TEXT_INIT, line = TEXT_INIT;
    domain_text(domain, &spec);
    Status status = text_check(&spec, err);
    if (status == STATUS_OK) {
        size_t kind = strcspn(spec.chars, ":") + 1;
        text_printf(&line, "domain: %.*s%s", (int)kind, spec.chars, file_name(spec.chars + kind));
        status = text_check(&line, err);
    }
    if (status == STATUS_OK)
        status = tree_add_line(tree, line.chars, err);
    text_release(&spec);
    text_release(&line);
    return status;
}

static Status write_header(const GrowParams *params, const Domain *domain, Tree *tree, Err *err)
{
    TreeHeader *header = &tree->header;
    header->has.seed = header->has.dimension = header->has.gamma = header->has.lambda = true;
    header->has.p_perf = header->has.p_term = header->has.q_perf = header->has.viscosity = true;
    header->seed = params->seed;
    header->dimension = domain_dimension(domain);
    header->gamma = params->gamma;
    header->lambda = params->lambda;
    header->p_perf_mmhg = params->p_perf_mmhg;
    header->p_term_mmhg = params->p_term_mmhg;
    header->q_perf_ml_min = params->q_perf_ml_min;
    header->viscosity_cp = params->viscosity_cp;
    char seed[64];
    snprintf(seed, sizeof seed, "seed: %" PRIu64, params->seed);
    TRY(tree_add_line(tree, "generator: corcast " CORCAST_VERSION, err));
    TRY(tree_add_line(tree, seed, err));
    TRY(add_number(tree, "dimension", header->dimension, err));
    TRY(add_domain(tree, domain, err));
    TRY(add_number(tree, "gamma", header->gamma, err));
    TRY(add_number(tree, "lambda", header->lambda, err));
    TRY(add_number(tree, "p_perf_mmHg", header->p_perf_mmhg, err));
    TRY(add_number(tree, "p_term_mmHg", header->p_term_mmhg, err));
    TRY(add_number(tree, "q_perf_ml_min", header->q_perf_ml_min, err));
    return add_number(tree, "viscosity_cP", header->viscosity_cp, err);
}

Status finish_tree(Network *net, const GrowParams *params, const Domain *domain, Tree *out,
                   Err *err)
{
    network_retire(net);
    TRY(network_reorder(net, err));
    network_resum(net);
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(tree_init(&made, net->n, err));
    TRY_GOTO(sweep_down(net, &made, err));
    TRY_GOTO(write_header(params, domain, &made, err));
    for (size_t i = 0; i < net->n; i++) {
        made.id[i] = (int32_t)i + 1;
        made.type[i] = GROW_SWC_TYPE;
        made.parent[i] = i ? net->segment[i].parent : TREE_NO_PARENT;
        made.position[i] = net->position[i];
    }
    *out = made;
done:
    if (status != STATUS_OK)
        tree_release(&made);
    return status;
}
