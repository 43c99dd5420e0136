/* Evaluates the term of one segment in the potential, bounds it in a box, and counts segments
 * without a visible surface.
 *
 * A term is computed in the coordinates of its segment, in units of 1 / k = sqrt(2) s = radius /
 * sqrt(2). There, u and v are the distances of x from the two ends, inwards along the axis, and E
 * is the distance from the axis line. The term is exp(-E^2) (erf u + erf v) / 2. Beyond an end,
 * both erf are close to -1 and +1, and their sum is computed as a difference of erfc, which keeps
 * the digits of the tail. E comes from the component of x - a across the axis, and v from b, so
 * that no large squares or lengths are subtracted from each other.
 *
 * A term is largest half way along its segment, where it is erf(k l / 2). The surface can miss a
 * segment only if this is below the level, that is, if the segment is shorter than 0.17 of its
 * radius. It then misses the segment unless the terms of neighbours make up for the difference. The
 * index of segments finds the neighbours, and is built only if there is such a segment. */
#include "field/field.h"

/* 1 / sqrt(pi) */
static const double inv_sqrt_pi = 0.56418958354775628695;

typedef struct TermPosition {
    double k;    /* 1/mm */
    double u, v; /* beyond a and before b, times k */
    Vec3 axis;   /* unit, a to b */
    Vec3 across; /* x less its foot on the axis line, mm */
} TermPosition;

static TermPosition position_of(const FieldSegment *segment, Vec3 x)
{
    TermPosition position = {.k = potential_k(segment->radius_mm)};
    position.axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    Vec3 from_a = vec3_sub(x, segment->a);
    double along = vec3_dot(from_a, position.axis);
    position.u = position.k * along;
    position.v = position.k * vec3_dot(vec3_sub(segment->b, x), position.axis);
    position.across = vec3_add_scaled(from_a, position.axis, -along);
    return position;
}

static double radial_factor(const TermPosition *position)
{
    return elementary_exp(-position->k * position->k *
                          vec3_dot(position->across, position->across));
}

static double axial_factor(double u, double v)
{
    if (u < 0)
        return 0.5 * (elementary_erfc(-u) - elementary_erfc(v));
    if (v < 0)
        return 0.5 * (elementary_erfc(-v) - elementary_erfc(u));
    return 0.5 * (elementary_erf(u) + elementary_erf(v));
}

double potential_term(const FieldSegment *segment, Vec3 x)
{
    TermPosition position = position_of(segment, x);
    return radial_factor(&position) * axial_factor(position.u, position.v);
}

double potential_term_gradient(const FieldSegment *segment, Vec3 x, Vec3 *gradient)
{
    TermPosition position = position_of(segment, x);
    double radial = radial_factor(&position);
    double term = radial * axial_factor(position.u, position.v);
    double axial_slope =
        elementary_exp(-position.u * position.u) - elementary_exp(-position.v * position.v);
    *gradient = vec3_add_scaled(vec3_scale(position.across, -2 * position.k * position.k * term),
                                position.axis, position.k * inv_sqrt_pi * radial * axial_slope);
    return term;
}

static double gap(double x, double low, double high)
{
    return x < low ? x - low : x > high ? x - high : 0;
}

/* Returns the vector from the nearest point of the box to x. */
static Vec3 gap_to_box(Vec3 x, const Box *box)
{
    return vec3(gap(x.x, box->low.x, box->high.x), gap(x.y, box->low.y, box->high.y),
                gap(x.z, box->low.z, box->high.z));
}

/* The squared distance of the box from the point a + s (b - a), with s in [0, 1], is a convex
 * function of s. Its derivative by s is piecewise linear and rising, with bends where the point
 * passes the plane of a face. The interval [s0, s1] about the zero of the derivative is narrowed at
 * each bend, until the derivative in it is one straight line. */
double segment_box_distance2(const FieldSegment *segment, const Box *box)
{
    Vec3 a = segment->a, span = vec3_sub(segment->b, a);
    Vec3 gap0 = gap_to_box(a, box), gap1 = gap_to_box(segment->b, box);
    double s0 = 0, slope0 = vec3_dot(gap0, span);
    double s1 = 1, slope1 = vec3_dot(gap1, span);
    if (slope0 >= 0)
        return vec3_dot(gap0, gap0);
    if (slope1 <= 0)
        return vec3_dot(gap1, gap1);
    const double bends[6] = {(box->low.x - a.x) / span.x,  (box->low.y - a.y) / span.y,
                             (box->low.z - a.z) / span.z,  (box->high.x - a.x) / span.x,
                             (box->high.y - a.y) / span.y, (box->high.z - a.z) / span.z};
    for (int i = 0; i < 6; i++) {
        if (!(bends[i] > s0 && bends[i] < s1)) /* also when the segment is parallel to the face */
            continue;
        double slope = vec3_dot(gap_to_box(vec3_add_scaled(a, span, bends[i]), box), span);
        if (slope < 0) {
            s0 = bends[i];
            slope0 = slope;
        } else {
            s1 = bends[i];
            slope1 = slope;
        }
    }
    double s = s0 + (s1 - s0) * (slope0 / (slope0 - slope1));
    Vec3 nearest = gap_to_box(vec3_add_scaled(a, span, s), box);
    return vec3_dot(nearest, nearest);
}

double potential_term_peak(const FieldSegment *segment)
{
    double k = potential_k(segment->radius_mm);
    return elementary_erf(0.5 * k * vec3_distance(segment->a, segment->b));
}

/* Beside the segment the axial factor is largest half way, where it is erf(k l / 2). At e / k
 * beyond an end it is the integral of exp(-(e + y)^2) / sqrt(pi) over y in [0, k l], at most
 * exp(-e^2) erf(k l) / 2, which is at most exp(-e^2) erf(k l / 2); and e^2 + E^2 = (k dist)^2. */
double potential_term_bound(const FieldSegment *segment, Box box)
{
    double k = potential_k(segment->radius_mm);
    return elementary_exp(-k * k * segment_box_distance2(segment, &box)) *
           potential_term_peak(segment);
}

double potential_log_form(double phi)
{
    return sqrt(-2 * elementary_log(fmin(fmax(phi, LOG_FORM_FLOOR), LOG_FORM_CEILING))) - 2;
}

/* Returns the largest sum of a group that the segment belongs to. */
static double potential_of_groups(const Geometry *geometry, size_t segment, Vec3 x)
{
    const IndexLists *groups = &geometry->blend.groups, *members = &geometry->blend.members;
    double largest = 0;
    for (uint32_t i = groups->first[segment]; i < groups->first[segment + 1]; i++) {
        uint32_t group = groups->items[i];
        double sum = 0;
        for (uint32_t k = members->first[group]; k < members->first[group + 1]; k++)
            sum += potential_term(&geometry->segments[members->items[k]], x);
        largest = fmax(largest, sum);
    }
    return largest;
}

Status surface_count_missing(const Geometry *geometry, size_t *count, Err *err)
{
    FieldIndex *index = NULL;
    size_t found = 0;
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        if (potential_term_peak(segment) >= FIELD_LEVEL)
            continue;
        bool all_blend = geometry->blend.n_groups == 0;
        if (!index && all_blend)
            TRY(fieldindex_build(geometry, &index, err));
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        double potential = all_blend ? fieldindex_potential(index, middle)
                                     : potential_of_groups(geometry, i, middle);
        found += potential < FIELD_LEVEL;
    }
    fieldindex_free(index);
    *count = found;
    return STATUS_OK;
}
