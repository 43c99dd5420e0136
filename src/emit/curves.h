/* Vessels as curves, for formats of lines: segments of one kind that follow one another; private to
 * the room emit. */
#ifndef CORCAST_EMIT_CURVES_H
#define CORCAST_EMIT_CURVES_H

#include "emit/emit.h"

/* What a curve is of, in the order in which curves are sorted. */
typedef struct CurveKind {
    uint32_t tree, order, paint; /* paint: whatever else parts curves */
} CurveKind;

/* Curve k has the segments[first[k] .. first[k + 1]), by their indices, from its start on. Zeroed:
 * none. */
typedef struct Curves {
    const VesselTree *vessels; /* borrowed */
    CurveKind *kinds;          /* of each segment, by its index; owned */
    uint32_t *segments;        /* owned */
    size_t *first;             /* owned */
    size_t n;
} Curves;

/* Makes curves of params->vessels by params->anatomy: a segment goes on with the daughter of its
 * Strahler order, of which there is one at most, and of its paint. `paints` has one a segment, by
 * its index; NULL: all are the same. Release with curves_release. STATUS_MEMORY. O(n log n). */
MUST_CHECK Status curves_find(const EmitParams *params, const uint32_t *paints, Curves *out,
                              Err *err);
void curves_release(Curves *curves);

static inline const CurveKind *curve_kind(const Curves *curves, size_t curve)
{
    return &curves->kinds[curves->segments[curves->first[curve]]];
}
/* The first curve, from `curve` on, of another tree or order; curves->n behind the last. */
size_t curves_group_end(const Curves *curves, size_t curve);
/* Appends the object's name of a group: "order_3", in a forest "tree_2_order_3". */
void curves_put_name(const EmitParams *params, const CurveKind *kind, Text *out);

/* A curve has a point where it starts and one where each segment ends. */
static inline size_t curve_points(const Curves *curves, size_t curve)
{
    return curves->first[curve + 1] - curves->first[curve] + 1;
}
/* The segment whose values a point has: the one that ends there, at the start the first one. */
static inline uint32_t curve_segment(const Curves *curves, size_t curve, size_t point)
{
    return curves->segments[curves->first[curve] + (point ? point - 1 : 0)];
}
static inline Vec3 curve_point(const Curves *curves, size_t curve, size_t point)
{
    const FieldSegment *segment = &curves->vessels->segments[curve_segment(curves, curve, point)];
    return point ? segment->b : segment->a;
}

#endif
