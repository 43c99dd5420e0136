/* blob_search: finds the hits of a ray with a blob (POV-Ray's implicit surface of summed fields),
 * by isolating the roots of quartics.
 *
 * A blob is a sum of components, tubes and beads (balls), of radius R and with the field (1 - d^2 /
 * R^2)^2 at the distance d [field/blob.h]. Along a ray, 1 - d^2 / R^2 is a parabola top - curve (t
 * - nearest)^2: everywhere for a ball, and for a tube with other coefficients before, beside and
 * beyond its axis. A component therefore is a few *pieces*, each with one parabola. Between two
 * consecutive ends of pieces, the sum of the fields is one quartic in t.
 *
 * A hierarchy of boxes finds the segments whose field may reach the ray. Each segment reaches it in
 * one interval of t, its span. Spans that overlap form a group. Groups are searched in their order
 * along the ray until one holds a hit. Within a group, the ends of pieces are visited in order.
 * Between two of them, the parabola of a piece has Bernstein coefficients w0, w1, w2. Its square,
 * the field, has the coefficients w0^2, w0 w1, (2 w1^2 + w0 w2) / 3, w1 w2, w2^2. These formulas
 * subtract no large numbers from each other, however far the ray has come, so no digits are lost.
 *
 * The sum of the fields minus 1 is a quartic in Bernstein form. geom/quartic.h isolates its roots
 * by the signs of its coefficients. Therefore no root is missed, except a pair of roots closer than
 * 2^-32 of the interval. Where rounding makes two consecutive quartics disagree about the sign at
 * their common end, that end is the root. */
#include "render/cast/raysearch.h"

#include <stdlib.h>

/* Maximum number of pieces of a segment: 5 of each tube [put_tube], and 4 of each kind of beads,
 * two at each end [put_beads]. */
enum { MAX_PIECES = 5 * BLOB_TUBES + 4 * BLOB_BEAD_PAIRS };

/* A piece of a component: 1 - d^2 / R^2 = top - curve (t - nearest)^2 for t0 <= t <= t1. */
typedef struct BlobPiece {
    double t0, t1;
    double nearest, top, curve;
    double strength;
} BlobPiece;

/* The part of a ray that segment or piece `number` reaches. */
typedef struct BlobSpan {
    double t0, t1;
    uint32_t number;
} BlobSpan;

/* The position of a ray relative to a segment. */
typedef struct BlobCourse {
    double along;        /* cosine of the angle between ray and axis */
    double across2;      /* squared sine of this angle */
    double t[2];         /* parameters of the points nearest to the two ends */
    double distance2[2]; /* squared distances of these points from the ends, mm^2 */
    double slope[2];     /* half the change of distance2 as the end moves along the axis, 1/mm */
    double gate[2];      /* parameters at which the ray crosses the planes perpendicular to the axis
                          * at the ends */
    double t_axis, axis_distance2; /* point nearest to the axis line: parameter, squared distance */
} BlobCourse;

/* The workspace of one thread. All arrays are owned. */
typedef struct BlobScratch {
    BlobSpan *spans;   /* of segments */
    BlobPiece *pieces; /* of a group */
    BlobSpan *order;   /* of pieces */
    uint32_t *active;
} BlobScratch;

/* ---- building -------------------------------------------------------------------------------- */

/* Returns a box that contains all points at which the segment's field is not 0. */
static Box segment_box(const RayIndex *index, size_t i)
{
    const FieldSegment *segment = &index->geometry->segments[i];
    double reach = segment->radius_mm * blob_reach(&blob_shape);
    return box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach);
}

static Status build(RayIndex *index, const CellParams *cells, Err *err)
{
    (void)cells;
    return rayindex_build_boxes(index, index->geometry->n_segments, segment_box, err);
}

static void workspace_free(void *workspace)
{
    BlobScratch *scratch = workspace;
    if (!scratch)
        return;
    free(scratch->spans);
    free(scratch->pieces);
    free(scratch->order);
    free(scratch->active);
    free(scratch);
}

static Status workspace_new(const Geometry *geometry, size_t n, void **out, Err *err)
{
    (void)geometry;
    BlobScratch *scratch = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&scratch, 1, sizeof *scratch, "workspaces", err));
    TRY_GOTO(mem_calloc(&scratch->spans, n, sizeof *scratch->spans, "segments", err));
    TRY_GOTO(mem_calloc(&scratch->pieces, n, MAX_PIECES * sizeof *scratch->pieces, "pieces", err));
    TRY_GOTO(mem_calloc(&scratch->order, n, MAX_PIECES * sizeof *scratch->order, "pieces", err));
    TRY_GOTO(mem_calloc(&scratch->active, n, MAX_PIECES * sizeof *scratch->active, "pieces", err));
    *out = scratch;
    scratch = NULL;
done:
    workspace_free(scratch);
    return status;
}

/* ---- pieces ---------------------------------------------------------------------------------- */

/* Returns the position of a ray relative to a segment. */
static BlobCourse course_of(const FieldSegment *segment, Ray ray)
{
    BlobCourse course;
    const Vec3 end[2] = {segment->a, segment->b};
    Vec3 axis = vec3_normalized(vec3_sub(end[1], end[0])), d = ray.direction;
    course.along = vec3_dot(d, axis);
    Vec3 across = vec3_add_scaled(axis, d, -course.along);
    Vec3 aside = vec3_add_scaled(d, axis, -course.along); /* as long, and perpendicular to the
                                                           * axis */
    course.across2 = vec3_dot(aside, aside);
    for (int e = 0; e < 2; e++) {
        course.t[e] = vec3_dot(vec3_sub(end[e], ray.origin), d);
        Vec3 off = vec3_sub(end[e], ray_at(ray, course.t[e]));
        course.distance2[e] = vec3_dot(off, off);
        course.slope[e] = vec3_dot(off, across);
        /* At t[e] the ray is off . axis short of the end, along the axis. */
        double short_of = vec3_dot(off, axis);
        course.gate[e] = course.t[e] + short_of / course.along;
        if (e == 0) {
            Vec3 from_axis = vec3_add_scaled(off, axis, -short_of);
            double t = course.across2 > 0 ? vec3_dot(from_axis, aside) / course.across2 : 0;
            Vec3 least = vec3_add_scaled(from_axis, aside, -t);
            course.t_axis = course.t[0] + t;
            course.axis_distance2 = vec3_dot(least, least);
        }
    }
    return course;
}

/* Appends a piece at `end`, unless it is empty: the part of [low, high] in which the field is not
 * 0. Returns the new end. The squared distance along the ray is distance2 + curve (t -
 * nearest)^2. */
static BlobPiece *put_piece(BlobPiece *end, double nearest, double distance2, double curve,
                            double radius2, double strength, double low, double high)
{
    if (!(distance2 < radius2))
        return end;
    double half = sqrt((radius2 - distance2) / curve);
    *end = (BlobPiece){fmax(nearest - half, low),
                       fmin(nearest + half, high),
                       nearest,
                       1 - distance2 / radius2,
                       curve / radius2,
                       strength};
    return end + (end->t0 < end->t1);
}

/* The parts of a ray before the plane across the axis at the segment's first end, between the
 * planes at both ends, and beyond the plane at the second end. A part is empty if `low` is above
 * `high`. */
typedef struct BlobParts {
    double low[3], high[3];
} BlobParts;

/* Returns the intervals of the ray in which it is before the segment's first end, beside the
 * segment, and beyond its second end. `distance_along` is the position along the axis, in lengths
 * of the segment; it decides where the ray is perpendicular to the axis. */
static BlobParts parts_of(const BlobCourse *course, double distance_along)
{
    BlobParts parts = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (course->along > 0)
        return (BlobParts){{-INFINITY, course->gate[0], course->gate[1]},
                           {course->gate[0], course->gate[1], INFINITY}};
    if (course->along < 0)
        return (BlobParts){{course->gate[0], course->gate[1], -INFINITY},
                           {INFINITY, course->gate[0], course->gate[1]}};
    int part = distance_along < 0 ? 0 : distance_along > 1 ? 2 : 1;
    parts.low[part] = -INFINITY;
    parts.high[part] = INFINITY;
    return parts;
}

/* Returns the position along the axis, 0..1 between the ends, at which a ray perpendicular to the
 * axis passes the segment. */
static double position_along(const FieldSegment *segment, Ray ray)
{
    Vec3 span = vec3_sub(segment->b, segment->a);
    return vec3_dot(vec3_sub(ray.origin, segment->a), span) / vec3_dot(span, span);
}

/* Appends the pieces of a tube, and of the two balls of minus half its strength at its ends
 * [field/blob.h]. Beyond an end, the tube's own field is that of a ball, so the sum is a ball of
 * half the strength. */
static BlobPiece *put_tube(BlobPiece *end, const BlobCourse *course, const BlobParts *parts,
                           const BlobTube *tube, double radius_mm)
{
    double radius2 = tube->radius * radius_mm * (tube->radius * radius_mm);
    double half = 0.5 * tube->strength;
    end = put_piece(end, course->t_axis, course->axis_distance2, course->across2, radius2,
                    tube->strength, parts->low[1], parts->high[1]);
    for (int e = 0; e < 2; e++) {
        int outside = 2 * e;
        double t = course->t[e], distance2 = course->distance2[e];
        end = put_piece(end, t, distance2, 1, radius2, half, parts->low[outside],
                        parts->high[outside]);
        /* The part that is not outside this end: between the ends or beyond the other end. */
        double low = fmin(parts->low[1], parts->low[2 - outside]);
        double high = fmax(parts->high[1], parts->high[2 - outside]);
        end = put_piece(end, t, distance2, 1, radius2, -half, low, high);
    }
    return end;
}

/* Appends the pieces of the two pairs of beads at the ends. */
static BlobPiece *put_beads(BlobPiece *end, const BlobCourse *course, const BlobBead *bead,
                            double radius_mm)
{
    double radius2 = bead->radius * radius_mm * (bead->radius * radius_mm);
    for (int e = 0; e < 2; e++)
        for (int side = 1; side >= -1; side -= 2) {
            double shift = (e ? -side : side) * bead->offset * radius_mm;
            double distance2 =
                course->distance2[e] + shift * (2 * course->slope[e] + shift * course->across2);
            end = put_piece(end, course->t[e] + shift * course->along, distance2, 1, radius2,
                            side * bead->strength, -INFINITY, INFINITY);
        }
    return end;
}

/* Appends the pieces of all components of a segment. */
static BlobPiece *put_segment(BlobPiece *end, const FieldSegment *segment, Ray ray)
{
    BlobCourse course = course_of(segment, ray);
    BlobParts parts = parts_of(&course, position_along(segment, ray));
    for (int i = 0; i < BLOB_TUBES; i++)
        end = put_tube(end, &course, &parts, &blob_shape.tube[i], segment->radius_mm);
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        end = put_beads(end, &course, &blob_shape.bead[i], segment->radius_mm);
    return end;
}

/* Finds the interval in which the segment's field can be nonzero on the ray: within its reach. */
static bool find_span(const FieldSegment *segment, Ray ray, double reach, double t_max,
                      BlobSpan *span)
{
    BlobCourse course = course_of(segment, ray);
    BlobParts parts = parts_of(&course, position_along(segment, ray));
    double radius2 = reach * segment->radius_mm * (reach * segment->radius_mm);
    BlobPiece piece[3], *end = piece;
    end = put_piece(end, course.t_axis, course.axis_distance2, course.across2, radius2, 1,
                    parts.low[1], parts.high[1]);
    for (int e = 0; e < 2; e++)
        end = put_piece(end, course.t[e], course.distance2[e], 1, radius2, 1, parts.low[2 * e],
                        parts.high[2 * e]);
    span->t0 = INFINITY;
    span->t1 = -INFINITY;
    for (const BlobPiece *p = piece; p < end; p++) {
        span->t0 = fmin(span->t0, p->t0);
        span->t1 = fmax(span->t1, p->t1);
    }
    span->t0 = fmax(span->t0, 0);
    return span->t0 < span->t1 && span->t0 < t_max;
}

/* Sorts spans by ascending t0, then by index [Shell; gaps of Ciura 2001]. */
static void sort_spans(BlobSpan *spans, size_t n)
{
    static const size_t gaps[] = {701, 301, 132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < n; i++) {
            BlobSpan span = spans[i];
            size_t j = i;
            for (; j >= gaps[g]; j -= gaps[g]) {
                const BlobSpan *before = &spans[j - gaps[g]];
                if (before->t0 < span.t0 || (before->t0 == span.t0 && before->number < span.number))
                    break;
                spans[j] = *before;
            }
            spans[j] = span;
        }
}

/* ---- roots ----------------------------------------------------------------------------------- */

/* Adds the Bernstein coefficients on [low, high] of a piece's field. */
static void add_piece(const BlobPiece *piece, double low, double high, double b[5])
{
    double l = low - piece->nearest, h = high - piece->nearest;
    double w0 = piece->top - piece->curve * l * l;
    double w1 = piece->top - piece->curve * l * h;
    double w2 = piece->top - piece->curve * h * h;
    double s = piece->strength;
    b[0] += s * w0 * w0;
    b[1] += s * w0 * w1;
    b[2] += s * (2 * w1 * w1 + w0 * w2) * (1.0 / 3);
    b[3] += s * w1 * w2;
    b[4] += s * w2 * w2;
}

/* A walk over the pieces of a group. */
typedef struct BlobWalk {
    const BlobPiece *pieces;
    const BlobSpan *order;
    size_t n, next;
    uint32_t *active;
    size_t n_active;
} BlobWalk;

/* Adds the pieces that start at `t` or before, and removes the pieces that end there. Returns the
 * next start or end of a piece; infinity after the last. */
static double walk_to(BlobWalk *walk, double t)
{
    double until = INFINITY;
    for (; walk->next < walk->n && walk->order[walk->next].t0 <= t; walk->next++)
        walk->active[walk->n_active++] = walk->order[walk->next].number;
    size_t kept = 0;
    for (size_t i = 0; i < walk->n_active; i++) {
        double end = walk->pieces[walk->active[i]].t1;
        if (end <= t)
            continue;
        walk->active[kept++] = walk->active[i];
        until = fmin(until, end);
    }
    walk->n_active = kept;
    return walk->next < walk->n ? fmin(until, walk->order[walk->next].t0) : until;
}

/* Finds the first root in (t_min, t_max) of the sum of n pieces minus 1. scratch->order lists the
 * pieces by their starts. `known` is false until the sign before the present interval is known. */
static bool first_root(BlobScratch *scratch, size_t n, double t_min, double t_max, double *t)
{
    BlobWalk walk = {scratch->pieces, scratch->order, n, 0, scratch->active, 0};
    double low = fmax(scratch->order[0].t0, 0);
    bool inside = false, known = low > 0;
    while (low < t_max) {
        double high = walk_to(&walk, low);
        if (high == (double)INFINITY)
            return false;
        double b[5] = {-1, -1, -1, -1, -1}, roots[4];
        for (size_t i = 0; i < walk.n_active; i++)
            add_piece(&walk.pieces[walk.active[i]], low, high, b);
        if (known && inside != (b[0] >= 0) && low > t_min) {
            *t = low;
            return true;
        }
        int count = quartic_roots(b, low, high, roots);
        for (int i = 0; i < count; i++)
            if (roots[i] > t_min) {
                *t = roots[i];
                return *t < t_max;
            }
        inside = b[4] >= 0;
        known = true;
        low = high;
    }
    return false;
}

/* ---- casting --------------------------------------------------------------------------------- */

/* A search along a ray. The spans are in scratch->spans; [first, end) are those of the group that
 * is searched, at the end those of the group that is hit. */
typedef struct BlobQuery {
    const Geometry *geometry;
    BlobScratch *scratch;
    RayPart part;
    size_t n;          /* number of spans */
    size_t first, end; /* the group */
    double t;          /* of the hit */
} BlobQuery;

/* Adds the span of a segment, if its field can be nonzero on the ray. */
static void add_span(BlobQuery *query, uint32_t number)
{
    BlobSpan *span = &query->scratch->spans[query->n];
    span->number = number;
    query->n += find_span(&query->geometry->segments[number], query->part.ray,
                          blob_reach(&blob_shape), query->part.t_max, span);
}

/* Finds the first hit among the segments of the group. */
static bool group_root(BlobQuery *query)
{
    BlobScratch *scratch = query->scratch;
    BlobPiece *last = scratch->pieces;
    for (size_t i = query->first; i < query->end; i++)
        last = put_segment(last, &query->geometry->segments[scratch->spans[i].number],
                           query->part.ray);
    size_t n = (size_t)(last - scratch->pieces);
    for (size_t i = 0; i < n; i++)
        scratch->order[i] = (BlobSpan){scratch->pieces[i].t0, scratch->pieces[i].t1, (uint32_t)i};
    sort_spans(scratch->order, n);
    return n > 0 && first_root(scratch, n, query->part.t_min, query->part.t_max, &query->t);
}

/* Finds the first hit among the segments that have spans. */
static bool find_hit(BlobQuery *query)
{
    const BlobSpan *spans = query->scratch->spans;
    sort_spans(query->scratch->spans, query->n);
    for (query->first = 0; query->first < query->n; query->first = query->end) {
        double until = spans[query->first].t1;
        size_t end = query->first + 1;
        for (; end < query->n && spans[end].t0 <= until; end++)
            until = fmax(until, spans[end].t1);
        query->end = end;
        if (until > query->part.t_min && group_root(query))
            return true;
    }
    return false;
}

/* Adds the spans of the segments whose boxes the ray meets. */
static void add_spans_in_boxes(const RayIndex *index, BlobQuery *query)
{
    BoxWalk walk;
    const Ray *ray = &query->part.ray;
    boxwalk_start(&walk, &index->boxes, ray->origin, ray->direction, 0, false);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, query->part.t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++)
            add_span(query, index->boxes.items[i]);
}

/* Collects the segments whose field the ray may meet, and searches the first hit of their sum.
 * Returns true if there is one. */
static bool search_segments(const RayIndex *index, BlobQuery *query)
{
    if (index->boxes.nodes)
        add_spans_in_boxes(index, query);
    for (size_t i = 0; i < index->n; i++)
        add_span(query, index->list[i]);
    return find_hit(query);
}

/* Sets the normal and the segment of a hit: the normal from the gradients of the group's segments
 * there, the segment from the largest term; of equal terms, the one with the lowest index. */
static void describe_hit(const BlobQuery *query, RayHit *hit)
{
    Vec3 x = ray_at(query->part.ray, query->t), sum = vec3(0, 0, 0);
    double largest = -INFINITY;
    hit->t = query->t;
    for (size_t i = query->first; i < query->end; i++) {
        const BlobSpan *span = &query->scratch->spans[i];
        if (!(span->t0 <= hit->t && hit->t <= span->t1))
            continue;
        BlobComponent components[BLOB_COMPONENTS];
        Vec3 gradient;
        blob_components(&blob_shape, &query->geometry->segments[span->number], components);
        double term = blob_components_at(components, x, &gradient);
        sum = vec3_add(sum, gradient);
        if (term > largest || (term == largest && span->number < hit->index)) {
            largest = term;
            hit->index = span->number;
        }
    }
    /* POV-Ray's normal where the gradient is 0. */
    bool flat = sum.x == 0 && sum.y == 0 && sum.z == 0;
    hit->normal = flat ? vec3(1, 0, 0) : vec3_scale(vec3_normalized(sum), -1);
}

static bool first_of_blob(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit)
{
    BlobQuery query = {index->geometry, workspace, *part, .n = 0};
    if (!search_segments(index, &query))
        return false;
    describe_hit(&query, hit);
    return true;
}

static bool any_of_blob(const RayIndex *index, void *workspace, const RayPart *part)
{
    BlobQuery query = {index->geometry, workspace, *part, .n = 0};
    return search_segments(index, &query);
}

const RaySearch blob_search = {.nearest_mm = BLOB_NEAREST_MM,
                               .shadow_from_mm = BLOB_NEAREST_MM,
                               .build = build,
                               .workspace_new = workspace_new,
                               .workspace_free = workspace_free,
                               .first = first_of_blob,
                               .any = any_of_blob};
