#include "grow/continue_tree.h"
#include "grow/grow.h"

GrowParams grow_defaults(void)
{
    return (GrowParams){.terminals = 1000,
                        .gamma = 3,
                        .lambda = 2,
                        .seed = 1,
                        .p_perf_mmhg = 100,
                        .p_term_mmhg = 60,
                        .q_perf_ml_min = 500,
                        .viscosity_cp = 3.6,
                        .hematocrit = 0.45,
                        .plasma_viscosity_cp = 1.2,
                        .candidates = 8,
                        .toss = GROW_TOSS_SEGMENT};
}

void grow_describe(const GrowParams *params, TreeMeta *meta)
{
    meta_set_seed(meta, params->seed);
    meta_set_number(meta, META_GAMMA, params->gamma);
    meta_set_number(meta, META_LAMBDA, params->lambda);
    meta_set_number(meta, META_P_PERF, params->p_perf_mmhg);
    meta_set_number(meta, META_P_TERM, params->p_term_mmhg);
    meta_set_number(meta, META_Q_PERF, params->q_perf_ml_min);
    if (params->viscosity_law == VISCOSITY_CONSTANT) {
        meta_set_number(meta, META_VISCOSITY, params->viscosity_cp);
    } else {
        meta_set_number(meta, META_VISCOSITY_LAW, params->viscosity_law);
        meta_set_number(meta, META_HEMATOCRIT, params->hematocrit);
        meta_set_number(meta, META_PLASMA_VISCOSITY, params->plasma_viscosity_cp);
    }
    if (params->terminal_flow != TERMINAL_FLOW_EQUAL)
        meta_set_number(meta, META_TERMINAL_FLOW, params->terminal_flow);
}

static Status check_physics(const GrowParams *params, Err *err)
{
    TreeMeta meta = {0};
    grow_describe(params, &meta);
    return meta_check_cco(&meta, META_OF_OPTIONS, err);
}

static Status check_inlet(Vec3 inlet, const Domain *domain, Err *err)
{
    if (vec3_finite(inlet) && domain_inside(domain, inlet, domain->slack_mm))
        return STATUS_OK;
    Text text = TEXT_INIT;
    domain_text(domain, &text);
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "`inlet` %.9g,%.9g,%.9g: must lie in the domain %s",
                         inlet.x, inlet.y, inlet.z, text_chars(&text));
    text_release(&text);
    return status;
}

static Status check_inlets(const GrowParams *params, const Domain *domain, Err *err)
{
    size_t trees = params->inlets > 0 ? params->inlets : 1;
    if (trees > GROW_MAX_INLETS)
        return err_set(err, STATUS_USAGE, "`inlet`: %zu of them; at most %d may be given", trees,
                       GROW_MAX_INLETS);
    if (params->terminals < trees)
        return err_set(err, STATUS_USAGE,
                       "`terminals` %zu: must be at least one for each of %zu inlets",
                       params->terminals, trees);
    for (size_t k = 0; k < params->inlets; k++) {
        Vec3 inlet = params->inlet[k];
        TRY(check_inlet(inlet, domain, err));
        for (size_t i = 0; i < k; i++)
            if (vec3_distance(inlet, params->inlet[i]) <= domain->slack_mm)
                return err_set(err, STATUS_USAGE,
                               "`inlet` %.9g,%.9g,%.9g: is given twice; inlets must be apart",
                               inlet.x, inlet.y, inlet.z);
    }
    return STATUS_OK;
}

static Status check_shares(const GrowParams *params, size_t trees, Err *err)
{
    if (params->inlet_shares != 0 && params->inlet_shares != trees)
        return err_set(err, STATUS_USAGE,
                       "`inlet_shares`: %zu shares for %zu inlets; there must be one for each",
                       params->inlet_shares, trees);
    for (size_t k = 0; k < params->inlet_shares; k++)
        if (!(params->inlet_share[k] > 0) || !isfinite(params->inlet_share[k]))
            return err_set(err, STATUS_USAGE, "`inlet_shares` %g: must be finite numbers above 0",
                           params->inlet_share[k]);
    return STATUS_OK;
}

Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err)
{
    if (params->terminals < 1 || params->terminals > GROW_MAX_TERMINALS)
        return err_set(err, STATUS_USAGE, "`terminals` %zu: must be from 1 to %d",
                       params->terminals, GROW_MAX_TERMINALS);
    TRY(check_physics(params, err));
    if (params->candidates < 1 || params->candidates > GROW_MAX_CANDIDATES)
        return err_set(err, STATUS_USAGE, "`candidates` %d: must be from 1 to %d",
                       params->candidates, GROW_MAX_CANDIDATES);
    if (params->from) {
        TRY(continue_check(params, domain, err));
        return check_shares(params, continue_inlets(params->from), err);
    }
    TRY(check_inlets(params, domain, err));
    return check_shares(params, params->inlets > 0 ? params->inlets : 1, err);
}
