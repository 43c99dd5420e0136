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

static Status refuse(const char *option, double value, const char *allowed, Err *err)
{
    char number[NUMBER_TEXT_SIZE];
    return err_set(err, STATUS_USAGE, "%s %s: must be %s", option, number_text(value, number),
                   allowed);
}

static Status check_blood(const GrowParams *params, Err *err)
{
    if (!(params->viscosity_cp > 0) || !isfinite(params->viscosity_cp))
        return refuse("--viscosity", params->viscosity_cp, "a finite number of cP above 0", err);
    if (!(params->hematocrit >= 0) || !(params->hematocrit <= MAX_HEMATOCRIT))
        return refuse("--hematocrit", params->hematocrit, "from 0 to 0.95", err);
    if (!(params->plasma_viscosity_cp > 0) || !isfinite(params->plasma_viscosity_cp))
        return refuse("--plasma-viscosity", params->plasma_viscosity_cp,
                      "a finite number of cP above 0", err);
    return STATUS_OK;
}

static Status check_inlet(Vec3 inlet, const Domain *domain, Err *err)
{
    if (vec3_finite(inlet) && domain_inside(domain, inlet, domain->slack_mm))
        return STATUS_OK;
    Text text = TEXT_INIT;
    domain_text(domain, &text);
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "--inlet %.9g,%.9g,%.9g: must lie in the domain %s",
                         inlet.x, inlet.y, inlet.z, text_chars(&text));
    text_release(&text);
    return status;
}

static Status check_inlets(const GrowParams *params, const Domain *domain, Err *err)
{
    size_t trees = params->inlets > 0 ? params->inlets : 1;
    if (trees > GROW_MAX_INLETS)
        return err_set(err, STATUS_USAGE, "--inlet: %zu of them; at most %d may be given", trees,
                       GROW_MAX_INLETS);
    if (params->terminals < trees)
        return err_set(err, STATUS_USAGE,
                       "--terminals %zu: must be at least one for each of %zu inlets",
                       params->terminals, trees);
    for (size_t k = 0; k < params->inlets; k++) {
        Vec3 inlet = params->inlet[k];
        TRY(check_inlet(inlet, domain, err));
        for (size_t i = 0; i < k; i++)
            if (vec3_distance(inlet, params->inlet[i]) <= domain->slack_mm)
                return err_set(err, STATUS_USAGE,
                               "--inlet %.9g,%.9g,%.9g: is given twice; inlets must be apart",
                               inlet.x, inlet.y, inlet.z);
    }
    return STATUS_OK;
}

static Status check_shares(const GrowParams *params, size_t trees, Err *err)
{
    if (params->inlet_shares != 0 && params->inlet_shares != trees)
        return err_set(err, STATUS_USAGE,
                       "--inlet-shares: %zu shares for %zu inlets; there must be one for each",
                       params->inlet_shares, trees);
    for (size_t k = 0; k < params->inlet_shares; k++)
        if (!(params->inlet_share[k] > 0) || !isfinite(params->inlet_share[k]))
            return refuse("--inlet-shares", params->inlet_share[k], "finite numbers above 0", err);
    return STATUS_OK;
}

Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err)
{
    if (params->terminals < 1 || params->terminals > GROW_MAX_TERMINALS)
        return err_set(err, STATUS_USAGE, "--terminals %zu: must be from 1 to %d",
                       params->terminals, GROW_MAX_TERMINALS);
    if (!(params->gamma > 0) || !(params->gamma <= 10))
        return refuse("--gamma", params->gamma, "above 0 and at most 10", err);
    if (!(params->lambda >= 0) || !isfinite(params->lambda))
        return refuse("--lambda", params->lambda, "a finite number not below 0", err);
    if (!isfinite(params->p_perf_mmhg))
        return refuse("--p-perf", params->p_perf_mmhg, "a finite number of mmHg", err);
    if (!isfinite(params->p_term_mmhg) || !(params->p_term_mmhg < params->p_perf_mmhg)) {
        char number[NUMBER_TEXT_SIZE], allowed[96];
        snprintf(allowed, sizeof allowed, "a finite number of mmHg below --p-perf, which is %s",
                 number_text(params->p_perf_mmhg, number));
        return refuse("--p-term", params->p_term_mmhg, allowed, err);
    }
    if (!(params->q_perf_ml_min > 0) || !isfinite(params->q_perf_ml_min))
        return refuse("--q-perf", params->q_perf_ml_min, "a finite number of ml/min above 0", err);
    TRY(check_blood(params, err));
    if (params->candidates < 1 || params->candidates > GROW_MAX_CANDIDATES)
        return err_set(err, STATUS_USAGE, "--candidates %d: must be from 1 to %d",
                       params->candidates, GROW_MAX_CANDIDATES);
    if (params->from) {
        TRY(continue_check(params, domain, err));
        return check_shares(params, continue_inlets(params->from), err);
    }
    TRY(check_inlets(params, domain, err));
    return check_shares(params, params->inlets > 0 ? params->inlets : 1, err);
}
