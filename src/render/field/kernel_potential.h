/* Computes a term of the potential (the contribution of one segment), its derivative and bounds of
 * both, along LANES rays at once. The search for hits (kernel_trace.h) and the search for blockers
 * of light (kernel_shadow.h) step along the rays by these bounds. For each packet of rays,
 * bound_term comes first. sample_once, bound_curvature, term_ensures_hit and bound_beyond need
 * nothing else; sample_term, add_gradient and bounded_sample need complete_term.
 *
 * A term is exp(-E^2 - w^2) (erf u + erf v) / 2. kernel_packet.h defines the letters. Lengths are
 * in units of 1 / k. E is the distance between the ray and the segment's axis line (E^2 is e2). w
 * is the distance across the axis in the plane parallel to ray and axis; it is affine in z and has
 * the derivative w1. u and v are the distances along the axis from the two ends, positive beside
 * the segment. d is the distance between ray and segment (d^2 is e2 + past2). s and a are the sine
 * and the cosine of the angle between ray and axis. h is 1/2 if the ray is nearest to the axis line
 * beyond an end, else 1 (h_per_sine is h / s).
 *
 * - Peak. The term is the integral of exp(-|x - y|^2) / sqrt(pi) over the points y of the segment.
 *   On the ray |x - y|^2 = rho^2 + q^2, where rho >= d is the distance of y from the ray and q is
 *   the distance along the ray. Therefore the term is at most B = exp(-d^2) min(1, h / s), `peak`.
 * - Curvature. The second derivative of exp(-q^2) is at most 4 exp(-3/2). The integrals of its
 *   positive part and of its negative part are 2 sqrt(2 / e) each. Therefore the second derivative
 *   of the term is at most M = k^2 exp(-d^2) min(4 exp(-3/2) h / s, 2 sqrt(2 / e) / sqrt(pi) / a),
 *   `curvature`. The second derivative of exp(-q^2) is at least -2; that of the term is at least -M
 *   exp(3/2) / 2.
 * - Distance. The term is at most exp(-E^2 - w^2) beside the segment, and at most exp(-E^2 - w^2 -
 *   x^2) / 2 at the distance x beyond an end. */
#ifndef CORCAST_RENDER_FIELD_KERNEL_POTENTIAL_H
#define CORCAST_RENDER_FIELD_KERNEL_POTENTIAL_H

#include "render/field/kernel_packet.h"

/* A crossing ahead is certain if the squared slope exceeds CROSSING_FACTOR times M times the
 * deficit (level minus potential). A parabola with this slope and the minimum second derivative, -M
 * exp(3/2) / 2, reaches the level if the squared slope is at least exp(3/2) = 4.48 times M times
 * the deficit. 4.6 leaves a margin for rounding. A larger factor is safe, but proves fewer
 * crossings. */
#define CROSSING_FACTOR 4.6f

/* Returns the margin [kernel_trace_common.h] of n terms, without the rounding of positions. */
LANE_FN float fixed_margin(size_t n)
{
    return MARGIN_DROPPED + MARGIN_TERM * (float)n;
}

/* Returns the maximum error of the term per mm of error of its position, up to a constant factor
 * that MARGIN_POSITION contains. */
LANE_FN Lanes steepness(const PacketTerm *term)
{
    return term->peak * term->term->k;
}

/* Sets gauss and peak (B), and multiplies h_per_sine by h. `beyond`: the rays that are nearest to
 * the axis line beyond an end. */
LANE_FN void bound_term(PacketTerm *term, LaneMask beyond)
{
    term->h_per_sine *= lanes_select(beyond, lanes_set(0.5f), lanes_set(1));
    term->gauss = lanes_exp_minus(term->e2 + term->past2);
    term->peak = term->gauss * lanes_min(term->h_per_sine, lanes_set(1));
}

/* The two factors of M: 4 exp(-3/2), and 2 sqrt(2 / e) / sqrt(pi). */
#define BEND_ACROSS 0.8925207f
#define BEND_ALONG 0.9678830f
/* The derivative of erf at 0, 2 / sqrt(pi). */
#define ERF_SLOPE 1.12837917f

/* Sets curvature (M) and `steepness`. */
LANE_FN void bound_curvature(PacketTerm *term)
{
    const Lanes tiny = lanes_set(1e-20f);
    Lanes speed2 = square(term->w1) + square(term->u1);
    Lanes bend =
        lanes_min(term->h_per_sine * BEND_ACROSS, BEND_ALONG / lanes_max(term->cosine, tiny));
    term->curvature = term->gauss * speed2 * bend;
    term->steepness = steepness(term);
}

/* Sets half_gauss and `flat`. Where the rays are perpendicular to the axis, u and v do not change,
 * and half_gauss includes the axial factor. A |cosine| below 1e-8 changes u and v by less than
 * single precision resolves. */
LANE_FN void prepare_samples(PacketTerm *term, bool perspective)
{
    term->half_gauss = term->gauss * 0.5f;
    if (lanes_any(term->past2 > 0.0f))
        term->half_gauss = lanes_exp_minus(term->e2) * 0.5f;
    term->flat = !perspective && fabsf(term->term->cosine) < 1e-8f;
    if (term->flat) {
        Lanes ends, ends_slope;
        axial_factors(term->u0, term->v0, &ends, &ends_slope);
        term->half_gauss *= ends;
    }
}

/* Sets all other fields except `window` and `reach`, for packets that may hit something. peak_fall
 * is an upper bound of -ln B - E^2. If the ray is nearest to the axis line beside the segment, B is
 * exp(-d^2); beyond an end, where h / s >= 1 / 2, B is at least half of this, hence ln 2. */
LANE_FN void complete_term(PacketTerm *term, bool perspective)
{
    const Lanes ln_2 = lanes_set(0.69314718f);
    bound_curvature(term);
    prepare_samples(term, perspective);
    term->peak_fall = term->past2 + lanes_select(term->past2 > 0.0f, ln_2, lanes_set(0));
    place_ends(term);
}

/* Returns the value and the slope of the term at z. complete_term must have been called. */
FOLDED_FN TermSample sample_term(const PacketTerm *term, Lanes z)
{
    const RayPoint at = point_at(term, z - term->z);
    Lanes gauss = term->half_gauss * lanes_exp_minus(square(at.w));
    Lanes w_slope = -2.0f * at.w * term->w1;
    if (term->flat)
        return (TermSample){gauss, gauss * w_slope};
    Lanes ends, ends_slope;
    axial_factors(at.u, at.v, &ends, &ends_slope);
    Lanes change = lanes_fma(term->u1 * ends_slope, lanes_set(ERF_SLOPE), w_slope * ends);
    return (TermSample){gauss * ends, gauss * change};
}

/* Returns the value and the slope of the term at a point of the ray. Does not need
 * complete_term. */
LANE_FN TermSample sample_once(const PacketTerm *term, const RayPoint *at)
{
    Lanes half_gauss = lanes_exp_minus(lanes_fma(at->w, at->w, term->e2)) * 0.5f, ends, ends_slope;
    axial_factors(at->u, at->v, &ends, &ends_slope);
    Lanes change =
        lanes_fma(term->u1 * ends_slope, lanes_set(ERF_SLOPE), -2.0f * at->w * term->w1 * ends);
    return (TermSample){half_gauss * ends, half_gauss * change};
}

/* Adds the value of the term at z to *phi and its gradient to *sum. complete_term must have been
 * called. */
LANE_FN void add_gradient(const PacketTerm *term, const Packet *packet, Lanes z, Lanes *phi,
                          Gradient *sum)
{
    const float k = term->term->k;
    const RayPoint at = point_at(term, z - term->z);
    Lanes gauss = term->half_gauss * lanes_exp_minus(square(at.w)), value = gauss, ends_slope;
    if (term->flat) {
        ends_slope = lanes_exp_minus(square(at.u)) - lanes_exp_minus(square(at.v));
        gauss = lanes_exp_minus(square(at.w) + term->e2) * 0.5f;
    } else {
        Lanes ends;
        axial_factors(at.u, at.v, &ends, &ends_slope);
        value *= ends;
    }
    *phi += value;
    add_direction(term, packet, at.dz, value * (-2.0f * k * k),
                  gauss * ends_slope * (k * ERF_SLOPE), sum);
    keep_largest(term->term, value, sum);
}

/* Returns the lanes on which this term alone exceeds the level at a point beyond z. Terms are
 * positive, so the sum with any other terms exceeds the level, too; the number n of terms does not
 * matter. The point is the one nearest to the axis line. With E^2 <= 1.9 and both ends at least 1.5
 * / k away, the term is at least exp(-1.9) erf 1.5 = 0.144 there; the level is exp(-2) = 0.135. The
 * two limits leave 6 % for rounding; others would miss some points, which the march then
 * decides. */
LANE_FN LaneMask term_ensures_hit(const PacketTerm *term, Lanes z, size_t n)
{
    (void)n;
    LaneMask near = term->e2 <= 1.9f;
    if (!lanes_any(near))
        return near;
    const RayPoint at = point_at(term, -term->w0 * inverse(term->w1));
    return near & (lanes_min(at.u, at.v) >= 1.5f) & (at.dz + term->z > z);
}

/* Returns an upper bound of a term from w on. end_distance is the distance x along the axis, at w,
 * to the end that the ray runs towards; negative beyond it. From there on the axial factor is at
 * most (1 + erf x) / 2. This is at most its tangent at x = 0, 1/2 + x / sqrt(pi), and at most 1. */
LANE_FN Lanes bound_beyond(Lanes e2, Lanes w, Lanes end_distance)
{
    const Lanes half = lanes_set(0.5f);
    Lanes ends = lanes_fma(lanes_max(end_distance, lanes_set(0)), half * ERF_SLOPE, half);
    return gauss_beyond(e2, w, end_distance) * lanes_min(ends, lanes_set(1));
}

/* Returns the value and the slope of a term at z, and an upper bound from z on. complete_term must
 * have been called.
 *
 * The bound is the value itself if the term decreases from z on. A term is log-concave along a
 * line: where it has begun to decrease, it continues to. It decreases in three cases:
 * - the ray recedes from the axis line, and is beyond the end that it runs towards;
 * - w > 4.8: the whole term is below exp(-23) = 1e-10 from there on;
 * - the computed slope is negative, and erf u + erf v exceeds 0.02. The error of the sum is below
 *   6e-7, so the error of the slope is below 3e-5 of its two summands. A term with such a small
 *   positive slope rises by less than 1e-7 before it decreases.
 * Otherwise the bound is B. */
LANE_FN BoundedSample bounded_sample(const PacketTerm *term, Lanes z)
{
    const RayPoint at = point_at(term, z - term->z);
    Lanes gauss = term->half_gauss * lanes_exp_minus(square(at.w));
    Lanes w_slope = -2.0f * at.w * term->w1;
    BoundedSample there = {{gauss, gauss * w_slope}, lanes_set(0)};
    LaneMask falls = at.w >= 0.0f;
    if (!term->flat) {
        Lanes ends, ends_slope;
        axial_factors(at.u, at.v, &ends, &ends_slope);
        Lanes change = lanes_fma(term->u1 * ends_slope, lanes_set(ERF_SLOPE), w_slope * ends);
        there.at.value = gauss * ends;
        there.at.slope = gauss * change;
        falls &= lanes_select(term->u1 > 0.0f, at.v, at.u) < 0.0f;
        falls |= (at.w > 4.8f) | ((change < 0.0f) & (ends > 0.02f));
    }
    there.bound = lanes_select(falls, there.at.value, term->peak);
    return there;
}

#endif
