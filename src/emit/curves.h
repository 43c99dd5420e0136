/* Joins segments of vessels to curves, for formats that draw curves (Blender, USD). curves_find
 * joins them; the other functions read the result. Private to the module emit.
 *
 * A curve is a chain of connected segments of one kind: the same tree, the same Strahler order and
 * the same paint. It has one point more than segments. Curves are sorted by tree and order, so that
 * a writer can write all curves of one tree and order as a group, which ends at curves_group_end.
 */
#ifndef CORCAST_EMIT_CURVES_H
#define CORCAST_EMIT_CURVES_H

#include "emit/emit.h"

/* The properties that the segments of a curve share. Curves are sorted by tree, order and paint. */
typedef struct CurveKind {
    uint32_t tree, order;
    uint32_t paint; /* index of a color or material, chosen by the caller of curves_find */
} CurveKind;

/* The curves. Curve k consists of segments[first[k] .. first[k + 1]), from its start to its end. If
 * the struct is zeroed, there are no curves. */
typedef struct Curves {
    const VesselTree *vessels; /* borrowed */
    CurveKind *kinds;          /* per segment; owned */
    uint32_t *segments;        /* segment indices; owned */
    size_t *first;             /* owned */
    size_t n;
} Curves;

/* Joins the segments of params->vessels to curves. A segment is continued by its daughter of the
 * same Strahler order [params->anatomy] and the same paint. At most one daughter has the same order
 * as its parent.
 *
 * paints   per segment: index of its color or material; NULL: all segments have the same paint.
 * out      receives the curves; release it with curves_release. It borrows params->vessels.
 * Errors   STATUS_MEMORY.
 * Cost     O(n log n). */
MUST_CHECK Status curves_find(const EmitParams *params, const uint32_t *paints, Curves *out,
                              Err *err);
void curves_release(Curves *curves);

/* Returns the kind of a curve, borrowed. */
static inline const CurveKind *curve_kind(const Curves *curves, size_t curve)
{
    return &curves->kinds[curves->segments[curves->first[curve]]];
}
/* Returns the first curve after `curve` that is of another tree or order, or curves->n. */
size_t curves_group_end(const Curves *curves, size_t curve);
/* Appends the name of a group of curves of one tree and order: "order_3"; "tree_2_order_3" if there
 * are several trees. */
void curves_put_name(const EmitParams *params, const CurveKind *kind, Text *out);

/* Returns the number of points of a curve: its start, and the end of each of its segments. */
static inline size_t curve_points(const Curves *curves, size_t curve)
{
    return curves->first[curve + 1] - curves->first[curve] + 1;
}
/* Returns the index of the segment whose values a point of a curve has. This is the segment that
 * ends at the point; for point 0 it is the first segment. */
static inline uint32_t curve_segment(const Curves *curves, size_t curve, size_t point)
{
    return curves->segments[curves->first[curve] + (point ? point - 1 : 0)];
}
/* Return the position, and the radius in mm, of a point of a curve. */
static inline Vec3 curve_point(const Curves *curves, size_t curve, size_t point)
{
    const FieldSegment *segment = &curves->vessels->segments[curve_segment(curves, curve, point)];
    return point ? segment->b : segment->a;
}
static inline double curve_radius(const Curves *curves, size_t curve, size_t point)
{
    return curves->vessels->segments[curve_segment(curves, curve, point)].radius_mm;
}

#endif
