/* Computes the fields of blood flow: flow, velocity, wall shear stress, Reynolds number, pressure.
 *
 * Each terminal has a share of the perfusion flow. A sweep from the terminals to the root sums the
 * flows. Velocity, wall shear stress and Reynolds number follow from the flow of each segment. The
 * pressure follows by a sweep from the root, which subtracts the Poiseuille drop of each segment.
 * In the arrays of a tree, parents come before children. Networks with loops (tree->link is set)
 * are solved by treenetwork.c. Internal units are mm, g and s: mm^3/s, Pa, Pa s; derive.h lists the
 * units of the fields. */
#include "derive/fields.h"

#include <stdlib.h>
#include <string.h>

Status needed_value(const Tree *tree, const TreeMeta *overrides, MetaKey key, double *value,
                    Err *err)
{
    const TreeMeta *source = value_source(tree, overrides, key);
    const MetaRow *row = &meta_rows[key];
    *value = source->number[key];
    if (source->known[key])
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "needs the %s, which is not stored in this tree; give `%s` or the header key %s",
                   row->meaning, row->name, row->name);
}

/* The values from which the viscosity of the blood in a segment follows. */
typedef struct Blood {
    ViscosityLaw law;
    double viscosity_pa_s; /* of the blood; with Pries's law, of the plasma */
    double hematocrit;     /* discharge hematocrit, a fraction; used with Pries's law only */
} Blood;

ViscosityLaw derive_viscosity_law(const Tree *tree, const TreeMeta *overrides)
{
    if (overrides->known[META_VISCOSITY] && !overrides->known[META_VISCOSITY_LAW])
        return VISCOSITY_CONSTANT;
    const TreeMeta *source = value_source(tree, overrides, META_VISCOSITY_LAW);
    return (ViscosityLaw)meta_number(source, META_VISCOSITY_LAW);
}

/* Reads the values that the viscosity law needs. Errors: STATUS_INPUT if one is missing. */
static Status read_blood(const Tree *tree, const TreeMeta *overrides, Blood *blood, Err *err)
{
    Blood made = {.law = derive_viscosity_law(tree, overrides)};
    bool constant = made.law == VISCOSITY_CONSTANT;
    double viscosity_cp;
    TRY(needed_value(tree, overrides, constant ? META_VISCOSITY : META_PLASMA_VISCOSITY,
                     &viscosity_cp, err));
    if (!constant)
        TRY(needed_value(tree, overrides, META_HEMATOCRIT, &made.hematocrit, err));
    made.viscosity_pa_s = pa_s_from_cp(viscosity_cp);
    *blood = made;
    return STATUS_OK;
}

/* Returns the apparent viscosity in a vessel. */
static double viscosity_pa_s(const Blood *blood, double radius_mm)
{
    if (blood->law == VISCOSITY_CONSTANT)
        return blood->viscosity_pa_s;
    return viscosity_pries_pa_s(radius_mm, blood->hematocrit, blood->viscosity_pa_s);
}

Status derive_viscosity(const Tree *tree, const TreeMeta *overrides, double **value, Err *err)
{
    Blood blood;
    TRY(read_blood(tree, overrides, &blood, err));
    TRY(mem_calloc(value, tree->n, sizeof **value, "viscosities", err));
    for (size_t i = 0; i < tree->n; i++)
        (*value)[i] = viscosity_pa_s(&blood, tree->radius_mm[i]);
    return STATUS_OK;
}

bool pressure_is_known(const Tree *tree, const TreeMeta *overrides)
{
    Blood blood;
    double value;
    return needed_value(tree, overrides, META_Q_PERF, &value, NULL) == STATUS_OK &&
           needed_value(tree, overrides, META_P_PERF, &value, NULL) == STATUS_OK &&
           read_blood(tree, overrides, &blood, NULL) == STATUS_OK;
}

/* Sets value[i] to the sum of the flow shares at and below node i, and *total to the sum of all
 * shares. */
static Status sum_shares_upstream(const Tree *tree, double *value, double *total, Err *err)
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

/* Computes the flow of each segment, mm^3/s. A root gets the sum of the flows of its children. All
 * flows are 0 in a tree whose shares are all 0. */
static Status flow_mm3_s(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    double q_perf_ml_min, total;
    if (tree->link)
        return solve_network_flow(tree, overrides, value, NULL, err);
    TRY(needed_value(tree, overrides, META_Q_PERF, &q_perf_ml_min, err));
    double q_perf = mm3_s_from_ml_min(q_perf_ml_min);
    TRY(sum_shares_upstream(tree, value, &total, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] = total > 0 ? value[i] * q_perf / total : 0;
    return STATUS_OK;
}

Status field_flow(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    TRY(flow_mm3_s(tree, overrides, value, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] = ml_min_from_mm3_s(value[i]);
    return STATUS_OK;
}

Status field_velocity(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    TRY(flow_mm3_s(tree, overrides, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        value[i] = radius > 0 ? value[i] / (PI * radius * radius) : (double)NAN;
    }
    return STATUS_OK;
}

Status field_wss(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    Blood blood;
    TRY(read_blood(tree, overrides, &blood, err));
    TRY(flow_mm3_s(tree, overrides, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i], viscosity = viscosity_pa_s(&blood, radius);
        value[i] =
            radius > 0 ? 4 * viscosity * value[i] / (PI * radius * radius * radius) : (double)NAN;
    }
    return STATUS_OK;
}

Status field_reynolds(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    Blood blood;
    TRY(read_blood(tree, overrides, &blood, err));
    TRY(field_velocity(tree, overrides, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        value[i] *= 2 * BLOOD_DENSITY_G_MM3 * radius / viscosity_pa_s(&blood, radius);
    }
    return STATUS_OK;
}

Status field_pressure(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    double p_perf_mmhg;
    Blood blood;
    TRY(needed_value(tree, overrides, META_P_PERF, &p_perf_mmhg, err));
    TRY(read_blood(tree, overrides, &blood, err));
    if (tree->link) {
        TRY(solve_network_flow(tree, overrides, NULL, value, err));
        for (size_t i = 0; i < tree->n; i++)
            value[i] = mmhg_from_pa(value[i]);
        return STATUS_OK;
    }
    TRY(flow_mm3_s(tree, overrides, value, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            value[i] = p_perf_mmhg;
            continue;
        }
        /* poiseuille_resistance times the flow would round the last bit differently, and the bits
         * of fields must not change from version to version. */
        double radius = tree->radius_mm[i], radius2 = radius * radius;
        double drop_pa = 8 * viscosity_pa_s(&blood, radius) * tree_segment_length(tree, i) *
                         value[i] / (PI * radius2 * radius2);
        value[i] = value[tree->parent[i]] - (radius > 0 ? mmhg_from_pa(drop_pa) : (double)NAN);
    }
    return STATUS_OK;
}
