/* Computes the mean of a number per segment at a point, weighted by the segments' terms, for colors
 * that blend where vessels blend.
 *
 * A segment counts at a point if its term is not cut off there. A box about each segment reaches to
 * where its term is cut off, and a hierarchy of these boxes finds the segments that count. A group
 * is summed once: when the first of its members that counts is found. */
#include "field/field.h"

#include <stdlib.h>

struct TermMean {
    const Geometry *geometry;
    BoxTree tree;
};

static bool is_blob(const Geometry *geometry)
{
    return model_has(geometry->model, MODEL_BLOB);
}

static Box reach_of(const Geometry *geometry, const FieldSegment *segment)
{
    double reach;
    if (is_blob(geometry)) {
        reach = blob_reach(&blob_shape) * segment->radius_mm;
    } else {
        FieldTube tube = fieldtube_of(segment, 0);
        reach = sqrt(fmax(tube.reach2, 0)) / tube.k;
    }
    return box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach);
}

Status termmean_new(const Geometry *geometry, TermMean **out, Err *err)
{
    const size_t n = geometry->n_segments;
    TermMean *mean = NULL;
    Box *boxes = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&mean, 1, sizeof *mean, "means", err));
    TRY_GOTO(mem_calloc(&boxes, n, sizeof *boxes, "boxes", err));
    mean->geometry = geometry;
    for (size_t i = 0; i < n; i++)
        boxes[i] = reach_of(geometry, &geometry->segments[i]);
    TRY_GOTO(boxtree_build(boxes, n, &mean->tree, err));
    *out = mean;
    mean = NULL;
done:
    free(boxes);
    termmean_free(mean);
    return status;
}

void termmean_free(TermMean *mean)
{
    if (mean)
        boxtree_release(&mean->tree);
    free(mean);
}

/* Sums over the segments that count at a point. A number that is unknown (NAN) has no weight. */
typedef struct TermSums {
    double all;     /* the terms of all segments */
    double known;   /* the terms of the segments that have a number */
    double numbers; /* the terms of the segments that have a number, times the numbers */
} TermSums;

/* Returns the term of a segment, or 0 below the cut-off, so that exactly the segments whose boxes
 * hold x may count. */
static double cut_off_term(const TermMean *mean, uint32_t segment, Vec3 x)
{
    const Geometry *geometry = mean->geometry;
    const FieldSegment *of = &geometry->segments[segment];
    double term = is_blob(geometry) ? blob_segment_value(of, x) : potential_term(of, x);
    return term < RAY_TERM_CUTOFF ? 0 : term;
}

static void add_weighted(TermSums *sum, double term, double number)
{
    sum->all += term;
    if (isnan(number))
        return;
    sum->known += term;
    sum->numbers += term * number;
}

/* Returns the sums over a group, or zeros if a member before `first` counts at x. */
static TermSums sum_group(const TermMean *mean, uint32_t group, uint32_t first,
                          const double *numbers, Vec3 x)
{
    const Geometry *geometry = mean->geometry;
    const IndexLists *members = &geometry->blend.members;
    TermSums sum = {0};
    for (uint32_t k = members->first[group]; k < members->first[group + 1]; k++) {
        uint32_t segment = members->items[k];
        double term = cut_off_term(mean, segment, x);
        if (term > 0 && segment < first)
            return (TermSums){0};
        add_weighted(&sum, term, numbers[geometry->segments[segment].segment]);
    }
    return sum;
}

/* Raises *best to the largest of the sums over the groups whose first member that counts is this
 * segment. */
static void raise_to_groups(const TermMean *mean, uint32_t segment, const double *numbers, Vec3 x,
                            TermSums *best)
{
    const IndexLists *groups = &mean->geometry->blend.groups;
    for (uint32_t k = groups->first[segment]; k < groups->first[segment + 1]; k++) {
        TermSums sum = sum_group(mean, groups->items[k], segment, numbers, x);
        if (sum.all > best->all)
            *best = sum;
    }
}

double termmean_at(const TermMean *mean, const double *numbers, Vec3 x)
{
    const Geometry *geometry = mean->geometry;
    TermSums sum = {0};
    uint32_t i;
    for (BoxWalk walk = boxwalk_box(&mean->tree, (Box){x, x}); boxwalk_next(&walk, &i);) {
        double term = cut_off_term(mean, i, x);
        if (!(term > 0))
            continue;
        if (geometry->blend.n_groups)
            raise_to_groups(mean, i, numbers, x, &sum);
        else
            add_weighted(&sum, term, numbers[geometry->segments[i].segment]);
    }
    return sum.known > 0 && 2 * sum.known >= sum.all ? sum.numbers / sum.known : (double)NAN;
}
