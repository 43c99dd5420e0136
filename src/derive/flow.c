/* Flow is counted in terminals by one backward sweep; everything else follows from it segment by
 * segment, but for pressure, which is a forward sweep. Inside are mm, g and s: mm^3/s, Pa, Pa s. */
#include "derive/fields.h"

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

bool pressure_is_known(const Tree *tree, const FlowParams *params)
{
    return given_q_perf(tree, params).known && given_p_perf(tree, params).known &&
           given_viscosity(tree, params).known;
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

/* Fills `value` with the number of terminals at and below every node; returns the total. */
static double count_terminals(const Tree *tree, double *value)
{
    double total = 0;
    for (size_t i = tree->n; i-- > 0;) {
        if (!tree_is_segment(tree, i))
            continue;
        if (value[i] == 0) {
            value[i] = 1;
            total++;
        }
        value[tree->parent[i]] += value[i];
    }
    return total;
}

/* mm^3/s; a root has the sum of what leaves it. */
static Status flow_mm3_s(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Given given = given_q_perf(tree, params);
    TRY(need(&given, err));
    double q_perf = mm3_s_from_ml_min(given.value);
    double terminals = count_terminals(tree, value);
    for (size_t i = 0; i < tree->n; i++)
        value[i] = terminals > 0 ? value[i] * q_perf / terminals : 0;
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
    Given given = given_viscosity(tree, params);
    TRY(need(&given, err));
    double viscosity = pa_s_from_cp(given.value);
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        value[i] =
            radius > 0 ? 4 * viscosity * value[i] / (pi * radius * radius * radius) : (double)NAN;
    }
    return STATUS_OK;
}

Status field_reynolds(const Tree *tree, const FlowParams *params, double *value, Err *err)
{
    Given given = given_viscosity(tree, params);
    TRY(need(&given, err));
    double viscosity = pa_s_from_cp(given.value);
    TRY(field_velocity(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] *= 2 * density_g_mm3 * tree->radius_mm[i] / viscosity;
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
    Given given = given_viscosity(tree, params);
    TRY(need(&p_perf, err));
    TRY(need(&given, err));
    double viscosity = pa_s_from_cp(given.value);
    TRY(flow_mm3_s(tree, params, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            value[i] = p_perf.value;
            continue;
        }
        double drop_pa = poiseuille_drop_pa(viscosity, tree_segment_length(tree, i), value[i],
                                            tree->radius_mm[i]);
        value[i] = value[tree->parent[i]] - mmhg_from_pa(drop_pa);
    }
    return STATUS_OK;
}
