/* Computes the summary of a whole tree that `info` prints: numbers of segments and ends, sums and
 * extremes over the segments, and the largest values of some fields of derive.c. */
#include "derive/fields.h"

#include <stdlib.h>

/* Computes the members that are sums or extremes over the segments. */
static void sum_segments(const Tree *tree, TreeSummary *summary)
{
    summary->nodes = tree->n;
    summary->min_radius_mm = (double)NAN;
    summary->root_radius_mm = tree_root_radius(tree);
    for (size_t i = 0; i < tree->n; i++) {
        double radius = tree->radius_mm[i];
        if (!tree_is_segment(tree, i)) {
            summary->roots++;
            continue;
        }
        double length = tree_segment_length(tree, i);
        summary->segments++;
        summary->total_length_mm += length;
        summary->volume_mm3 += PI * radius * radius * length;
        if (summary->has.target)
            summary->target += length * elementary_pow(radius, summary->lambda);
        summary->min_radius_mm = fmin(summary->min_radius_mm, radius);
    }
}

static void count_ends(const Tree *tree, const int32_t *children, TreeSummary *summary)
{
    for (size_t i = 0; i < tree->n; i++) {
        summary->terminals += tree_is_segment(tree, i) && children[i] == 0;
        summary->bifurcations += children[i] >= 2;
    }
}

static Status count_components(const Tree *tree, TreeSummary *summary, Err *err)
{
    uint32_t *component;
    TRY(tree_components(tree, &component, &summary->components, err));
    free(component);
    return tree_loop_count(tree, &summary->loops, err);
}

/* Sets *out to the largest value of a field of integers; 0 if there is no segment. */
static Status largest(const Tree *tree, const TreeMeta *overrides, const char *name, int *out,
                      Err *err)
{
    Field field;
    TRY(derive_computed_field(tree, overrides, name, &field, err));
    double maximum = 0;
    for (size_t i = 0; i < field.n; i++)
        maximum = fmax(maximum, field.value[i]);
    field_release(&field);
    *out = (int)maximum;
    return STATUS_OK;
}

/* Sets the mean and the extremes of the pressures at the terminals, if the tree states what they
 * depend on. */
static Status sum_terminal_pressures(const Tree *tree, const TreeMeta *overrides,
                                     const int32_t *children, TreeSummary *summary, Err *err)
{
    if (!pressure_is_known(tree, overrides) || summary->terminals == 0 ||
        !(summary->min_radius_mm > 0))
        return STATUS_OK;
    Field pressure;
    TRY(derive_computed_field(tree, overrides, "pressure", &pressure, err));
    double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i) || children[i] > 0)
            continue;
        low = fmin(low, pressure.value[i]);
        high = fmax(high, pressure.value[i]);
        sum += pressure.value[i];
    }
    field_release(&pressure);
    if (!isfinite(sum)) /* a vessel so narrow that Pries's law closes it */
        return STATUS_OK;
    summary->has.terminal_pressure = true;
    summary->terminal_pressure_min_mmhg = low;
    summary->terminal_pressure_mean_mmhg = sum / (double)summary->terminals;
    summary->terminal_pressure_max_mmhg = high;
    return STATUS_OK;
}

Status derive_summary(const Tree *tree, const TreeMeta *overrides, TreeSummary *summary, Err *err)
{
    const TreeMeta *lambda = value_source(tree, overrides, META_LAMBDA);
    TreeSummary made = {.gamma = meta_gamma(&tree->meta),
                        .lambda = meta_number(lambda, META_LAMBDA),
                        .bounds = tree_bounds(tree)};
    made.has.lambda = made.has.target = lambda->known[META_LAMBDA];
    sum_segments(tree, &made);
    TRY(largest(tree, overrides, "level", &made.max_level, err));
    made.has.orders = !tree->link;
    if (made.has.orders)
        TRY(largest(tree, overrides, "strahler", &made.max_strahler, err));
    TRY(count_components(tree, &made, err));
    int32_t *children = NULL;
    TRY(tree_child_counts(tree, &children, err));
    count_ends(tree, children, &made);
    Status status = sum_terminal_pressures(tree, overrides, children, &made, err);
    free(children);
    if (status == STATUS_OK)
        *summary = made;
    return status;
}
