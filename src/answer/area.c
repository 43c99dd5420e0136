/* Computes area answers: bounds of the mean color over the square of a pixel.
 *
 * A pixel is a heap of leaves (rectangles). The leaf that adds most to the width of the pixel's
 * interval is divided, until the interval is narrow enough or the limit of leaves is reached.
 *
 * Color varies across a vessel and hardly along it. A leaf that shows one wall is therefore turned:
 * it is replaced by a rectangle along the wall, clipped to the square of the leaf. The rectangle is
 * halved across the wall only, as long as it shows this wall alone and its interval is wide because
 * of shading, not because of the strips along cuts. */
#include "answer/region.h"

#include <math.h>

static double half_length(const double side[2])
{
    return sqrt(side[0] * side[0] + side[1] * side[1]);
}

LeafPolygon arealeaf_polygon(const AreaLeaf *leaf)
{
    LeafPolygon polygon = {4, {-1, 1, 1, -1}, {-1, -1, 1, 1}};
    if (!leaf->turned)
        return polygon;
    const Form x = {leaf->x, leaf->along[0], leaf->across[0], 0};
    const Form y = {leaf->y, leaf->along[1], leaf->across[1], 0};
    polygon = polygon_cut(&polygon, x, leaf->clip[0]);
    polygon = polygon_cut(&polygon, form_neg(x), -leaf->clip[1]);
    polygon = polygon_cut(&polygon, y, leaf->clip[2]);
    return polygon_cut(&polygon, form_neg(y), -leaf->clip[3]);
}

/* Shrinks a turned leaf to the bounds of its polygon along the vessel. */
static void fit_leaf(AreaLeaf *leaf)
{
    const LeafPolygon polygon = arealeaf_polygon(leaf);
    double low = 1, high = -1;
    if (!leaf->turned || polygon.n < 3)
        return;
    for (int i = 0; i < polygon.n; i++) {
        low = box_min(low, polygon.x[i]);
        high = box_max(high, polygon.x[i]);
    }
    /* Not beyond the ends: there the other half begins, if the leaf was halved along the vessel. */
    const double pad = 1e-9;
    const double from = box_max(low - pad, -1), to = box_min(high + pad, 1);
    const double mid = 0.5 * (from + to), half = 0.5 * (to - from);
    leaf->x += mid * leaf->along[0];
    leaf->y += mid * leaf->along[1];
    leaf->along[0] *= half;
    leaf->along[1] *= half;
}

void arealeaf_measure(AnswerWorkspace *work, int i, int j, AreaLeaf *leaf)
{
    const LeafPolygon polygon = arealeaf_polygon(leaf);
    const double scale = fabs(leaf->along[0] * leaf->across[1] - leaf->along[1] * leaf->across[0]);
    const Beam beam = answerplan_beam(work->plan, i + 0.5 + leaf->x, j + 0.5 + leaf->y, leaf->along,
                                      leaf->across);
    RegionSum sum = {0};
    double width = 0;
    if (polygon.n >= 3)
        sum = region_integrate(work, &beam, &work->pixel, &polygon);
    work->beams++;
    for (int c = 0; c < 3; c++) {
        leaf->low[c] = scale * (sum.low[c] - 1e-14 * fabs(sum.low[c]));
        leaf->high[c] = scale * (sum.high[c] + 1e-14 * fabs(sum.high[c]));
        width += sum.high[c] - sum.low[c];
    }
    leaf->is_mixed = !sum.walls || sum.strips > 0.5 * width;
    leaf->turn[0] = leaf->turn[1] = 0;
    if (!leaf->is_mixed && !leaf->turned && !work->plan->params.squares) {
        const Form w = work->hits[sum.walls - 1].w;
        /* The gradient of w in pixels; the leaf is a square. */
        const double g[2] = {w.x / leaf->along[0], w.y / leaf->across[1]};
        const double length = half_length(g);
        if (length > 0 && isfinite(length)) {
            leaf->turn[0] = g[0] / length;
            leaf->turn[1] = g[1] / length;
        }
    }
}

/* Makes the rectangle across the wall that contains the leaf's square. */
static AreaLeaf turned_leaf(const AreaLeaf *leaf)
{
    AreaLeaf made = *leaf;
    const double half = leaf->across[1];
    const double reach = half * (fabs(leaf->turn[0]) + fabs(leaf->turn[1])) * (1 + 1e-9);
    made.turned = true;
    made.across[0] = reach * leaf->turn[0];
    made.across[1] = reach * leaf->turn[1];
    made.along[0] = reach * leaf->turn[1];
    made.along[1] = -reach * leaf->turn[0];
    made.clip[0] = leaf->x - half;
    made.clip[1] = leaf->x + half;
    made.clip[2] = leaf->y - half;
    made.clip[3] = leaf->y + half;
    return made;
}

/* Halves a leaf by its side `by` into two. */
static void halve(const AreaLeaf *leaf, const double by[2], bool is_along, AreaLeaf parts[2])
{
    for (int k = 0; k < 2; k++) {
        const double step = k ? 0.5 : -0.5;
        parts[k] = *leaf;
        parts[k].x += step * by[0];
        parts[k].y += step * by[1];
        double *side = is_along ? parts[k].along : parts[k].across;
        side[0] *= 0.5;
        side[1] *= 0.5;
        fit_leaf(&parts[k]);
    }
}

/* Divides a leaf. Returns the number of parts, 2 or 4. */
static int divide(const AreaLeaf *leaf, AreaLeaf parts[4])
{
    AreaLeaf from = *leaf;
    const bool turns = !leaf->turned && (leaf->turn[0] != 0 || leaf->turn[1] != 0);
    if (turns)
        from = turned_leaf(leaf);
    if (from.turned) {
        const double across = half_length(from.across), along = half_length(from.along);
        const bool is_along = (from.is_mixed && along > across) || along > 64 * across;
        halve(&from, is_along ? from.along : from.across, is_along, parts);
        return 2;
    }
    AreaLeaf rows[2];
    halve(&from, from.across, false, rows);
    halve(&rows[0], from.along, true, parts);
    halve(&rows[1], from.along, true, parts + 2);
    return 4;
}

/* ---- the pixel ------------------------------------------------------------------------------- */

/* The width in sRGB that a leaf adds, near the pixel's present color. */
static double weight_of(const AreaLeaf *leaf, const double slopes[3])
{
    double weight = 0;
    for (int c = 0; c < 3; c++)
        weight = box_max(weight, (leaf->high[c] - leaf->low[c]) * slopes[c]);
    return weight;
}

static ColorInterval interval_of_leaves(const AnswerPlan *plan, const AreaLeaf *leaves,
                                        const Heap *heap)
{
    ColorInterval interval = {{0}, {0}};
    for (size_t k = 0; k < heap->n; k++)
        for (int c = 0; c < 3; c++) {
            interval.low[c] += leaves[heap->items[k].value].low[c];
            interval.high[c] += leaves[heap->items[k].value].high[c];
        }
    /* Each leaf's area has an error below 1e-13 of a pixel. */
    const double whole = plan->params.filter * plan->params.filter;
    for (int c = 0; c < 3; c++) {
        interval.low[c] /= whole;
        interval.high[c] /= whole;
        const double error = (1e-13 * (double)heap->n + 1e-11) * plan->most[c];
        interval.low[c] = box_max(interval.low[c] - error, plan->least[c]);
        interval.high[c] = box_min(interval.high[c] + error, plan->most[c]);
    }
    return interval;
}

static Status push(AnswerWorkspace *work, Heap *heap, size_t leaf, const double slopes[3], Err *err)
{
    const double weight = weight_of(&work->leaves.items[leaf], slopes);
    return heap_push(
        heap, (HeapItem){isfinite(weight) ? -weight : -1e300, (uint32_t)leaf, (uint32_t)leaf},
        "leaves", err);
}

/* Divides leaves until the sum of their widths is small enough. */
static Status refine(AnswerWorkspace *work, int i, int j, Heap *heap, ColorInterval *interval,
                     Err *err)
{
    const AnswerPlan *plan = work->plan;
    double slopes[3];
    for (;;) {
        *interval = interval_of_leaves(plan, work->leaves.items, heap);
        if (interval_width(interval) <= plan->params.width)
            return STATUS_OK;
        if ((int)work->leaves.n >= plan->params.leaves)
            return STATUS_OK;
        interval_slopes(interval, slopes);
        /* Several leaves at once, because the sum over all leaves takes its time, too. */
        const size_t count = heap->n / 8 + 1;
        for (size_t k = 0; k < count; k++) {
            AreaLeaf parts[4];
            const size_t widest = heap_pop(heap).value;
            const int n = divide(&work->leaves.items[widest], parts);
            TRY(ARRAY_RESERVE(&work->leaves, 4, "leaves", err));
            for (int p = 0; p < n; p++) {
                arealeaf_measure(work, i, j, &parts[p]);
                const size_t at = p == 0 ? widest : work->leaves.n++;
                work->leaves.items[at] = parts[p];
                TRY(push(work, heap, at, slopes, err));
            }
        }
    }
}

/* Keeps only the faces that some ray through the pixel may see first: no leaf shows the others. */
static void drop_unseen_faces(AnswerWorkspace *work)
{
    const BeamHits found = beam_hits(work, &work->whole, &work->pixel);
    if (found.overflows)
        return;
    for (work->pixel.n = 0; work->pixel.n < found.n; work->pixel.n++)
        work->pixel.faces[work->pixel.n] =
            (uint32_t)(work->hits[work->pixel.n].face - work->plan->faces);
}

Status area_answer(AnswerWorkspace *work, int i, int j, ColorInterval *out, Err *err)
{
    static const double slopes[3] = {1, 1, 1};
    const double half = 0.5 * work->plan->params.filter;
    AreaLeaf whole = {.across = {0, half}, .along = {half, 0}};
    Heap *heap = &work->heap;
    work->leaves.n = heap->n = work->n_cached = work->n_cached_faces = 0;
    work->whole = answerplan_beam(work->plan, i + 0.5, j + 0.5, whole.along, whole.across);
    drop_unseen_faces(work);
    arealeaf_measure(work, i, j, &whole);
    TRY(ARRAY_PUSH(&work->leaves, "leaves", err, whole));
    TRY(push(work, heap, 0, slopes, err));
    return refine(work, i, j, heap, out, err);
}
