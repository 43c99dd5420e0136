/* Flow is gathered from the shares of the nodes by one backward sweep; everything else follows from
 * it segment by segment, but for pressure, which is a forward sweep. Inside are mm, g and s:
 * mm^3/s, Pa, Pa s. */
#include "derive/fields.h"

#include <stdlib.h>
#include <string.h>

static const double density_g_mm3 = 1.05e-3; /* of blood */
static const double pi = 3.14159265358979323846;

/* A quantity that an option or the header may say. */
typedef struct Given {
    bool known;
    double value;
    const char *what, *option, *key;
} Given;

static Given given_q_perf(const Tree *tree, const FlowParams *params)
{
    const TreeHeader *header = &tree->header;
    return (Given){params->has.q_perf || header->has.q_perf,
                   params->has.q_perf ? params->q_perf_ml_min : header->q_perf_ml_min,
                   "flow through the inlet", "--q-perf ML_MIN", "q_perf_ml_min"};
}

static Given given_p_perf(const Tree *tree, const FlowParams *params)
{
    const TreeHeader *header = &tree->header;
    return (Given){params->has.p_perf || header->has.p_perf,
                   params->has.p_perf ? params->p_perf_mmhg : header->p_perf_mmhg,
                   "pressure at the inlet", "--p-perf MMHG", "p_perf_mmHg"};
}

static Given given_viscosity(const Tree *tree, const FlowParams *params)
{
    const TreeHeader *header = &tree->header;
    return (Given){params->has.viscosity || header->has.viscosity,
                   params->has.viscosity ? params->viscosity_cp : header->viscosity_cp,
                   "viscosity of the blood", "--viscosity CP", "viscosity_cP"};
}

static Given given_plasma_viscosity(const Tree *tree, const FlowParams *params)
{
    const TreeHeader *header = &tree->header;
    return (Given){params->has.plasma_viscosity || header->has.plasma_viscosity,
                   params->has.plasma_viscosity ? params->plasma_viscosity_cp
                                                : header->plasma_viscosity_cp,
                   "viscosity of the plasma", "--plasma-viscosity CP", "plasma_viscosity_cP"};
}

static Given given_hematocrit(const Tree *tree, const FlowParams *params)
{
    const TreeHeader *header = &tree->header;
    return (Given){params->has.hematocrit || header->has.hematocrit,
                   params->has.hematocrit ? params->hematocrit : header->hematocrit, "hematocrit",
                   "--hematocrit H", "hematocrit"};
}

/* The sentence goes on from "the field NAME ". */
static Status need(const Given *given, Err *err)
{
    if (given->known)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "needs the %s, which the tree does not say; give %s, or the header key %s",
                   given->what, given->option, given->key);
}

/* What viscosity follows from. */
typedef struct Blood {
    ViscosityLaw law;
    double viscosity_pa_s; /* of the blood; by Pries's law of the plasma */
    double hematocrit;     /* by Pries's law */
} Blood;

ViscosityLaw derive_viscosity_law(const Tree *tree, const FlowParams *params)
{
    if (params->has.viscosity_law)
        return params->viscosity_law;
    if (params->has.viscosity || !tree->header.has.viscosity_law)
        return VISCOSITY_CONSTANT;
    return tree->header.viscosity_law;
}

static Status blood_of(const Tree *tree, const FlowParams *params, Blood *blood, Err *err)
{
    ViscosityLaw law = derive_viscosity_law(tree, params);
    Given viscosity = law == VISCOSITY_CONSTANT ? given_viscosity(tree, params)
                                                : given_plasma_viscosity(tree, params);
    Given hematocrit = given_hematocrit(tree, params);
    TRY(need(&viscosity, err));
    if (law == VISCOSITY_PRIES)
        TRY(need(&hematocrit, err));
    *blood = (Blood){law, pa_s_from_cp(viscosity.value), hematocrit.value};
    return STATUS_OK;
}

static double viscosity_pa_s(const Blood *blood, double radius_mm)
{
    if (blood->law == VISCOSITY_CONSTANT)
        return blood->viscosity_pa_s;
    return viscosity_pries_pa_s(radius_mm, blood->hematocrit, blood->viscosity_pa_s);
}

bool pressure_is_known(const Tree *tree, const FlowParams *params)
{
    Blood blood;
    return given_q_perf(tree, params).known && given_p_perf(tree, params).known &&
           blood_of(tree, params, &blood, NULL) == STATUS_OK;
}

/* Fills `value` with the flow shares at and below every node; *total is that of all roots. */
static Status gather_shares(const Tree *tree, double *value, double *total, Err *err)
{
    double *share = NULL;
    TRY(tree_flow_shares(tree, &share, err));
    memcpy(value, share, tree->n * sizeof *value);
    free(share);
    *total = 0;
    for (size_t i = tree->n; i-- > 0;) {
        if (tree_is_segment(tree, i))
            value[tree->parent[i]] += value[i];
        else
            *total += value[i];
    }
    return STATUS_OK;
}

/* mm^3/s; a root has the sum of what leaves it. All 0 in a tree without shares above 0. */
static Status flow_mm3_s(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Given given = given_q_perf(tree, params);
    TRY(need(&given, err));
    double q_perf = mm3_s_from_ml_min(given.value);
    double total;
    TRY(gather_shares(tree, value, &total, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] = total > 0 ? value[i] * q_perf / total : 0;
    return STATUS_OK;
}

Status field_flow(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] = ml_min_from_mm3_s(value[i]);
    return STATUS_OK;
}

Status field_velocity(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        value[i] = radius > 0 ? value[i] / (pi * radius * radius) : (double)NAN;
    }
    return STATUS_OK;
}

Status field_wss(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Blood blood;
    TRY(blood_of(tree, params, &blood, err));
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i], viscosity = viscosity_pa_s(&blood, radius);
        value[i] =
            radius > 0 ? 4 * viscosity * value[i] / (pi * radius * radius * radius) : (double)NAN;
    }
    return STATUS_OK;
}

Status field_reynolds(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Blood blood;
    TRY(blood_of(tree, params, &blood, err));
    TRY(field_velocity(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        value[i] *= 2 * density_g_mm3 * radius / viscosity_pa_s(&blood, radius);
    }
    return STATUS_OK;
}

static double poiseuille_drop_pa(double viscosity, double length, double flow, double radius)
{
    double radius2 = radius * radius;
    return radius > 0 ? 8 * viscosity * length * flow / (pi * radius2 * radius2) : (double)NAN;
}

Status field_pressure(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Given p_perf = given_p_perf(tree, params);
    Blood blood;
    TRY(need(&p_perf, err));
    TRY(blood_of(tree, params, &blood, err));
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            value[i] = p_perf.value;
            continue;
        }
        double radius = tree->radius_mm[i];
        double drop_pa = poiseuille_drop_pa(viscosity_pa_s(&blood, radius),
                                            tree_segment_length(tree, i), value[i], radius);
        value[i] = value[tree->parent[i]] - mmhg_from_pa(drop_pa);
    }
    return STATUS_OK;
}
