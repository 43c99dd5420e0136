/* The parameters of growth: their defaults, and the check of their values. The table of keys
 * [tree/meta.h] checks the values that a tree's file also states; this file checks the others. */
#include "grow/continue_tree.h"
#include "grow/grow.h"
#include <stddef.h>

GrowParams grow_defaults(void)
{
    return (GrowParams){.terminals = 1000,
                        .gamma = logcurve_constant(3),
                        .lambda = 2,
                        .seed = 1,
                        .blood.p_perf_mmhg = 100,
                        .blood.p_term_mmhg = 60,
                        .blood.q_perf_ml_min = 500,
                        .blood.viscosity_cp = 3.6,
                        .blood.hematocrit = 0.45,
                        .blood.plasma_viscosity_cp = 1.2,
                        .candidates = 8,
                        .relax = 300,
                        .toss = GROW_TOSS_SEGMENT};
}

/* The parameters that a tree's file also states: their keys, and their positions in GrowParams. */
static const struct {
    MetaKey key;
    size_t offset;
} numbers[] = {{META_LAMBDA, offsetof(GrowParams, lambda)},
               {META_P_PERF, offsetof(GrowParams, blood.p_perf_mmhg)},
               {META_P_TERM, offsetof(GrowParams, blood.p_term_mmhg)},
               {META_Q_PERF, offsetof(GrowParams, blood.q_perf_ml_min)},
               {META_VISCOSITY, offsetof(GrowParams, blood.viscosity_cp)},
               {META_HEMATOCRIT, offsetof(GrowParams, blood.hematocrit)},
               {META_PLASMA_VISCOSITY, offsetof(GrowParams, blood.plasma_viscosity_cp)},
               {META_CLEARANCE, offsetof(GrowParams, clearance_mm)}};

enum { N_NUMBERS = sizeof numbers / sizeof *numbers };

void grow_describe(const GrowParams *params, TreeMeta *meta)
{
    bool constant = params->blood.viscosity_law == VISCOSITY_CONSTANT;
    meta_set_seed(meta, params->seed);
    for (size_t i = 0; i < N_NUMBERS; i++)
        meta_set_number(meta, numbers[i].key,
                        *(const double *)((const char *)params + numbers[i].offset));
    meta_set_gamma(meta, &params->gamma);
    meta_set_number(meta, META_VISCOSITY_LAW, params->blood.viscosity_law);
    meta_set_number(meta, META_TERMINAL_FLOW, params->blood.terminal_flow);
    meta->known[META_VISCOSITY] = constant;
    meta->known[META_VISCOSITY_LAW] = meta->known[META_HEMATOCRIT] =
        meta->known[META_PLASMA_VISCOSITY] = !constant;
    meta->known[META_TERMINAL_FLOW] = params->blood.terminal_flow != TERMINAL_FLOW_EQUAL;
    meta->known[META_CLEARANCE] = params->clearance_mm > 0;
}

void grow_set_from_meta(GrowParams *params, const TreeMeta *meta, const bool given[META_KEYS])
{
    for (size_t i = 0; i < N_NUMBERS; i++)
        if (meta->known[numbers[i].key] && !given[numbers[i].key])
            *(double *)((char *)params + numbers[i].offset) = meta->number[numbers[i].key];
    if (!given[META_GAMMA] && meta_gamma(meta).n > 0)
        params->gamma = meta_gamma(meta);
    if (!given[META_VISCOSITY_LAW] && !given[META_VISCOSITY])
        params->blood.viscosity_law = (ViscosityLaw)meta_number(meta, META_VISCOSITY_LAW);
    if (!given[META_TERMINAL_FLOW])
        params->blood.terminal_flow = (TerminalFlow)meta_number(meta, META_TERMINAL_FLOW);
}

Status grow_blood_check(const GrowParams *params, Err *err)
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
        status =
            err_set(err, STATUS_USAGE, "`inlet` is %.9g,%.9g,%.9g; it must be inside the domain %s",
                    inlet.x, inlet.y, inlet.z, text_chars(&text));
    text_release(&text);
    return status;
}

static Status check_inlets(const GrowParams *params, const Domain *domain, Err *err)
{
    size_t trees = params->inlets > 0 ? params->inlets : 1;
    if (trees > GROW_MAX_INLETS)
        return err_set(err, STATUS_USAGE, "`inlet`: there are %zu inlets; at most %d are allowed",
                       trees, GROW_MAX_INLETS);
    if (params->terminals < trees)
        return err_set(err, STATUS_USAGE,
                       "`terminals` is %zu; it must be at least %zu, one per inlet",
                       params->terminals, trees);
    for (size_t k = 0; k < params->inlets; k++) {
        Vec3 inlet = params->inlet[k];
        TRY(check_inlet(inlet, domain, err));
        for (size_t i = 0; i < k; i++)
            if (vec3_distance(inlet, params->inlet[i]) <= domain->slack_mm)
                return err_set(
                    err, STATUS_USAGE,
                    "`inlet` %.9g,%.9g,%.9g occurs twice; all inlets must be different points",
                    inlet.x, inlet.y, inlet.z);
    }
    return STATUS_OK;
}

static Status check_shares(const GrowParams *params, size_t trees, Err *err)
{
    if (params->inlet_shares != 0 && params->inlet_shares != trees)
        return err_set(err, STATUS_USAGE,
                       "`inlet_shares` has %zu shares for %zu inlets; it must have one per inlet",
                       params->inlet_shares, trees);
    for (size_t k = 0; k < params->inlet_shares; k++)
        if (!(params->inlet_share[k] > 0) || !isfinite(params->inlet_share[k]))
            return err_set(err, STATUS_USAGE,
                           "a share of `inlet_shares` is %g; it must be a finite number above 0",
                           params->inlet_share[k]);
    return STATUS_OK;
}

/* The parameters that are lengths in mm and must not be below 0. */
static const struct {
    const char *name;
    size_t offset;
} lengths[] = {{"clearance_mm", offsetof(GrowParams, clearance_mm)},
               {"min_radius_mm", offsetof(GrowParams, min_radius_mm)},
               {"pair_mm", offsetof(GrowParams, pair_mm)}};

static Status check_lengths(const GrowParams *params, Err *err)
{
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        double mm = *(const double *)((const char *)params + lengths[i].offset);
        if (!(mm >= 0) || !isfinite(mm))
            return err_set(err, STATUS_USAGE,
                           "`%s` is %g; it must be a finite number of mm, 0 or more",
                           lengths[i].name, mm);
    }
    return STATUS_OK;
}

static Status check_pairs(const GrowParams *params, const Domain *domain, Err *err)
{
    double mm = params->pair_mm;
    double across = vec3_distance(domain->bounds.low, domain->bounds.high);
    if (mm == 0)
        return STATUS_OK;
    if (params->from)
        return err_set(err, STATUS_USAGE,
                       "`pair_mm` cannot be combined with `from`: both trees must be new");
    if (params->inlets != 2)
        return err_set(err, STATUS_USAGE,
                       "`pair_mm` needs two trees: specify `inlet` twice, once per tree");
    if (params->terminals % 2 != 0 ||
        (params->inlet_shares == 2 && params->inlet_share[0] != params->inlet_share[1]))
        return err_set(
            err, STATUS_USAGE,
            "`pair_mm` needs an even number of `terminals` and equal `inlet_shares`: each "
            "pair has one terminal of each tree");
    if (mm < params->clearance_mm)
        return err_set(err, STATUS_USAGE,
                       "`pair_mm` is %g; it must be at least `clearance_mm`, which is %g, plus the "
                       "radii of both terminals",
                       mm, params->clearance_mm);
    if (mm > across)
        return err_set(err, STATUS_USAGE,
                       "`pair_mm` is %g; it must be at most %.4g mm, the diagonal of the domain's "
                       "bounding box",
                       mm, across);
    return STATUS_OK;
}

Status grow_params_check(const GrowParams *params, const Domain *domain, Err *err)
{
    if (params->terminals < 1 || params->terminals > GROW_MAX_TERMINALS)
        return err_set(err, STATUS_USAGE, "`terminals` is %zu; it must be from 1 to %d",
                       params->terminals, GROW_MAX_TERMINALS);
    TRY(grow_blood_check(params, err));
    TRY(check_lengths(params, err));
    if (params->clearance_mm > 0 && !params->from && params->inlets <= 1)
        return err_set(
            err, STATUS_USAGE,
            "`clearance_mm` is %g, the distance between trees, but there is only one tree; "
            "repeat `inlet` to grow several",
            params->clearance_mm);
    if (params->candidates < 1 || params->candidates > GROW_MAX_CANDIDATES)
        return err_set(err, STATUS_USAGE, "`candidates` is %d; it must be from 1 to %d",
                       params->candidates, GROW_MAX_CANDIDATES);
    if (params->blood.terminal_flow == TERMINAL_FLOW_DEMAND && !params->demand)
        return err_set(err, STATUS_USAGE,
                       "`terminal_flow` demand needs a demand map; specify `demand`");
    if (params->demand)
        TRY(demand_check(params->demand, domain, err));
    if (params->keep_radii && !params->from)
        return err_set(err, STATUS_USAGE,
                       "`keep_radii` needs `from`, the tree whose radii are kept");
    if (params->from) {
        TRY(check_pairs(params, domain, err));
        TRY(continue_check(params, domain, err));
        return check_shares(params, continue_count_roots(params->from), err);
    }
    TRY(check_inlets(params, domain, err));
    TRY(check_pairs(params, domain, err));
    return check_shares(params, params->inlets > 0 ? params->inlets : 1, err);
}
