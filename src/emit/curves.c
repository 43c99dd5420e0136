/* Joins segments to curves, for formats that store vessels as curves.
 *
 * A segment continues the curve of its parent if both have the same kind and no other daughter
 * continues it. All other segments begin a curve. By Strahler's rule at most one daughter has the
 * order of its parent, so curves are as long as possible. */
#include "emit/curves.h"

#include <stdlib.h>

#define NONE UINT32_MAX

void curves_release(Curves *curves)
{
    free(curves->kinds);
    free(curves->segments);
    free(curves->first);
    *curves = (Curves){0};
}

static int compare_kinds(const CurveKind *a, const CurveKind *b)
{
    const int tree = compare_numbers(a->tree, b->tree), order = compare_numbers(a->order, b->order);
    return tree ? tree : order ? order : compare_numbers(a->paint, b->paint);
}

static Status find_kinds(const EmitParams *params, const uint32_t *paints, Curves *curves, Err *err)
{
    const VesselTree *vessels = params->vessels;
    TRY(mem_calloc(&curves->kinds, vessels->n_segments, sizeof *curves->kinds, "curves", err));
    for (size_t i = 0; i < vessels->n_segments; i++) {
        uint32_t number = vessels->segments[i].segment;
        curves->kinds[i] =
            (CurveKind){params->anatomy->component[number],
                        (uint32_t)params->anatomy->order[number], paints ? paints[i] : 0};
    }
    return STATUS_OK;
}

/* Finds, per segment, the next segment of its curve (NONE at the end of a curve), and whether it
 * begins a curve. `into` is workspace with one element per node: the segment that ends at the
 * node. */
static void chain_segments(const Curves *curves, uint32_t *into, uint32_t *next, bool *heads)
{
    const VesselTree *vessels = curves->vessels;
    for (size_t node = 0; node < vessels->n_nodes; node++)
        into[node] = NONE;
    for (uint32_t i = 0; i < vessels->n_segments; i++)
        into[vessels->nodes[i][1]] = i;
    for (uint32_t i = 0; i < vessels->n_segments; i++)
        next[i] = NONE;
    for (uint32_t i = 0; i < vessels->n_segments; i++) {
        uint32_t before = into[vessels->nodes[i][0]];
        heads[i] = before == NONE || next[before] != NONE ||
                   compare_kinds(&curves->kinds[before], &curves->kinds[i]) != 0;
        if (!heads[i])
            next[before] = i;
    }
}

/* The first segment of a curve, and its kind, by which curves are sorted. */
typedef struct CurveHead {
    CurveKind kind;
    uint32_t segment;
} CurveHead;

static int compare_heads(const void *a, const void *b)
{
    const CurveHead *one = a, *other = b;
    int order = compare_kinds(&one->kind, &other->kind);
    return order ? order : compare_numbers(one->segment, other->segment);
}

static Status sort_heads(const Curves *curves, const bool *heads, CurveHead **sorted, Err *err)
{
    size_t n = 0;
    TRY(mem_calloc(sorted, curves->n, sizeof **sorted, "curves", err));
    for (uint32_t i = 0; i < curves->vessels->n_segments; i++)
        if (heads[i])
            (*sorted)[n++] = (CurveHead){curves->kinds[i], i};
    qsort(*sorted, n, sizeof **sorted, compare_heads);
    return STATUS_OK;
}

/* Sets curves->first and curves->segments: the curves sorted by kind, and the segments of each
 * curve from its start to its end. */
static Status list_curves(Curves *curves, const uint32_t *next, const bool *heads, Err *err)
{
    size_t n = curves->vessels->n_segments, at = 0;
    CurveHead *sorted = NULL;
    for (size_t i = 0; i < n; i++)
        curves->n += heads[i];
    TRY(mem_calloc(&curves->segments, n, sizeof *curves->segments, "curves", err));
    TRY(mem_calloc(&curves->first, curves->n + 1, sizeof *curves->first, "curves", err));
    TRY(sort_heads(curves, heads, &sorted, err));
    for (size_t k = 0; k < curves->n; k++) {
        for (uint32_t i = sorted[k].segment; i != NONE; i = next[i])
            curves->segments[at++] = i;
        curves->first[k + 1] = at;
    }
    free(sorted);
    return STATUS_OK;
}

Status curves_find(const EmitParams *params, const uint32_t *paints, Curves *out, Err *err)
{
    Curves made = {.vessels = params->vessels};
    uint32_t *into = NULL, *next = NULL;
    bool *heads = NULL;
    size_t n = made.vessels->n_segments;
    Status status;
    TRY_GOTO(find_kinds(params, paints, &made, err));
    TRY_GOTO(mem_calloc(&into, made.vessels->n_nodes, sizeof *into, "nodes", err));
    TRY_GOTO(mem_calloc(&next, n, sizeof *next, "curves", err));
    TRY_GOTO(mem_calloc(&heads, n, sizeof *heads, "curves", err));
    chain_segments(&made, into, next, heads);
    TRY_GOTO(list_curves(&made, next, heads, err));
    *out = made;
    made = (Curves){0};
done:
    curves_release(&made);
    free(into);
    free(next);
    free(heads);
    return status;
}

size_t curves_group_end(const Curves *curves, size_t curve)
{
    const CurveKind *kind = curve_kind(curves, curve);
    while (curve < curves->n && curve_kind(curves, curve)->tree == kind->tree &&
           curve_kind(curves, curve)->order == kind->order)
        curve++;
    return curve;
}

void curves_put_name(const EmitParams *params, const CurveKind *kind, Text *out)
{
    if (params->anatomy->n_trees > 1)
        text_printf(out, "tree_%u_", kind->tree + 1);
    text_printf(out, "order_%u", kind->order);
}
