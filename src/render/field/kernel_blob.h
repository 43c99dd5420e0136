/* Computes a term of the blob (the field of one segment [field/blob.h], times FIELD_LEVEL so that
 * blob and potential have the same level), its derivative and bounds of both, along LANES rays at
 * once. For each packet of rays, bound_term comes first. sample_once, sample_term, add_gradient,
 * bound_curvature, term_ensures_hit and bound_beyond need nothing else; complete_term prepares the
 * march. kernel_packet.h defines the fields of PacketTerm that are used here. The main ones are e2,
 * the squared distance between the ray and the segment's axis line; e2 + past2, the squared
 * distance between ray and segment; w, the distance across the axis in the plane parallel to ray
 * and axis; u and v, the distances along the axis from the two ends, positive beside the segment;
 * w1 and u1, the derivatives of w and u by z. All these lengths are in units of 1 / k = radius /
 * sqrt 2.
 *
 * The field of a segment is 0 beyond its reach. The field is piecewise polynomial, and its second
 * derivative jumps between the pieces. The bounds below hold for blob_shape and segments of any
 * length; tests/unit/blob_test.c compares them with the field. In this comment, lengths are in
 * radii and the field is not multiplied by FIELD_LEVEL.
 *
 * - Distance. At the distance x from the segment, the field is at most F = ENVELOPE exp(2 - 2 x^2).
 *   Beyond an end it is at most F / 2. Where the projection on the axis is y inwards from an end,
 *   it is at most (1/2 + INWARDS y) F. The field is at least -DIP: beyond an end, beads with
 *   negative strength may outweigh the other components.
 * - Steepness. At the distance x from the segment, within the reach R, the gradient is at most
 *   STEEPNESS (1 - x^2 / R^2).
 * - Curvature. Let d be the distance between a line and the segment, and e the distance between the
 *   line and the nearer end of the segment. The second derivative along the line is at most the
 *   maximum of 0 and three bounds of the form CURVED (1 - x^2 / WIDTH^2), with x = e for NEAR_END_
 *   and x = d for NEAR_AXIS_ and FAR_. The maximum holds everywhere; the names tell where each of
 *   the three is the largest. If both ends are out of the line's reach, the maximum is multiplied
 *   by the squared sine of the angle between line and axis. The second derivative is at least -1.25
 *   times the bound. */
#ifndef CORCAST_RENDER_FIELD_KERNEL_BLOB_H
#define CORCAST_RENDER_FIELD_KERNEL_BLOB_H

#include "render/field/kernel_packet.h"

/* The constants of the bounds above: maxima over the field of blob_shape, rounded up. They were
 * found numerically and are checked by tests/unit/blob_test.c; smaller values would be wrong,
 * larger ones make the steps of the march shorter. */
#define ENVELOPE 1.05f
#define INWARDS 0.62f
#define DIP 0.0085f
#define STEEPNESS 7.2f
#define NEAR_END_CURVED 37.5f
#define NEAR_END_WIDTH 1.06f
#define NEAR_AXIS_CURVED 18.9f
#define NEAR_AXIS_WIDTH 1.21f
#define FAR_CURVED 6.8f
#define FAR_WIDTH 1.675f

/* IN_UNITS2(x) is (x radii)^2 in units of 1 / k^2. PER_UNITS2 converts a second derivative from 1 /
 * radius^2 to k^2, and multiplies it by the level. */
#define IN_UNITS2(length) (2 * (length) * (length))
#define PER_UNITS2(curvature) (0.5f * LEVEL * (curvature))

/* A crossing ahead is certain if the squared slope exceeds CROSSING_FACTOR times M times the
 * deficit D (level minus field), where M is the curvature bound. A parabola with the second
 * derivative -1.25 M rises by D if the squared slope is at least 2 * 1.25 M D; 2.6 leaves a margin
 * for rounding. */
#define CROSSING_FACTOR 2.6f

_Static_assert(BLOB_TUBES == 2 && BLOB_BEAD_PAIRS == 2, "the sums below name them one by one");
static const BlobShape blob_numbers = BLOB_SHAPE;

/* Returns the margin [kernel_trace_common.h] of n terms, without the rounding of positions. The
 * error of a component is at most 10 * 2^-24 of its strength, times the level. The strengths of a
 * segment's components add up to 21, which gives less than 2e-6 per term. */
LANE_FN float fixed_margin(size_t n)
{
    return 1e-6f + 2e-6f * (float)n;
}

/* Returns the maximum error of the term per mm of error of its position, up to a constant factor
 * that MARGIN_POSITION contains. */
LANE_FN Lanes steepness(const PacketTerm *term)
{
    Lanes inside = 1.0f - (term->e2 + term->past2) / term->term->reach2;
    return lanes_max(inside, lanes_set(0)) * (STEEPNESS / (float)sqrt(2) * LEVEL * term->term->k);
}

/* Sets peak, the upper bound of the term on the ray. */
LANE_FN void bound_term(PacketTerm *term, LaneMask beyond)
{
    (void)beyond;
    Lanes d2 = term->e2 + term->past2;
    Lanes most = ENVELOPE * lanes_exp_minus(d2);
    term->peak = lanes_select(d2 < term->term->reach2, most, lanes_set(0));
}

/* Returns the bound CURVED (1 - x^2 / WIDTH^2), in units of 1 / k, from x^2 in these units. */
LANE_FN Lanes curved_within(float curved, float width, Lanes distance2)
{
    const float most = PER_UNITS2(curved);
    return lanes_fma(distance2, lanes_set(-most / (float)IN_UNITS2(width)), lanes_set(most));
}

/* Sets curvature, the bound of the second derivative, and `steepness`. */
LANE_FN void bound_curvature(PacketTerm *term)
{
    Lanes d2 = term->e2 + term->past2;
    Lanes end2 = term->e2 + lanes_min(term->end_y2[0], term->end_y2[1]);
    Lanes near_end = curved_within(NEAR_END_CURVED, NEAR_END_WIDTH, end2);
    Lanes near_axis = curved_within(NEAR_AXIS_CURVED, NEAR_AXIS_WIDTH, d2);
    Lanes far = lanes_max(curved_within(FAR_CURVED, FAR_WIDTH, d2), lanes_set(0));
    Lanes bend = lanes_max(lanes_max(near_end, near_axis), far);
    Lanes along = lanes_select(end2 < term->term->reach2, square(term->u1), lanes_set(0));
    term->curvature = bend * (square(term->w1) + along);
    term->steepness = steepness(term);
}

/* Sets curvature, steepness, peak_fall and end_z, for packets that may hit something. */
LANE_FN void complete_term(PacketTerm *term, bool perspective)
{
    (void)perspective;
    bound_curvature(term);
    term->peak_fall = term->past2;
    place_ends(term);
}

/* The sum of components at a point. */
typedef struct BlobSum {
    Lanes value;
    Lanes across; /* times the vector from the axis to the point: -1/2 of the gradient across it */
    Lanes along;  /* -1/2 of the derivative by the position along the axis */
} BlobSum;

/* Adds a tube, with its strength times `part`, at a squared distance from the tube. Inlining makes
 * the numbers of the tube constants for the compiler. */
FOLDED_FN void add_tube(const BlobTube *tube, double part, Lanes distance2, BlobSum *sum)
{
    const double strength = part * tube->strength * FIELD_LEVEL, per = 1 / IN_UNITS2(tube->radius);
    Lanes inside =
        lanes_max(lanes_fma(distance2, lanes_set((float)-per), lanes_set(1)), lanes_set(0));
    sum->value = lanes_fma(inside * (float)strength, inside, sum->value);
    sum->across = lanes_fma(inside, lanes_set((float)(2 * strength * per)), sum->across);
}

/* Adds a pair of beads with opposite strengths at an end of the segment: one inside the end, one
 * beyond it. The point is at the position x inwards from the end and at a squared distance from the
 * end. `along` does not include x times `across`, which the caller adds. */
FOLDED_FN void add_beads(const BlobBead *bead, Lanes distance2, Lanes x, BlobSum *sum)
{
    const double offset = sqrt(2) * bead->offset, per = 1 / IN_UNITS2(bead->radius);
    const double strength = bead->strength * FIELD_LEVEL;
    Lanes middle =
        lanes_fma(distance2, lanes_set((float)-per), lanes_set((float)(1 - offset * offset * per)));
    Lanes side = x * (float)(2 * offset * per);
    Lanes in = lanes_max(middle + side, lanes_set(0)), out = lanes_max(middle - side, lanes_set(0));
    Lanes more = in - out, both = in + out;
    sum->value = lanes_fma(more * (float)strength, both, sum->value);
    sum->across = lanes_fma(more, lanes_set((float)(2 * strength * per)), sum->across);
    sum->along = lanes_fma(both, lanes_set((float)(-2 * strength * per * offset)), sum->along);
}

/* Returns the sum of the components at an end. The point is at the position x inwards from the end,
 * and rho2 is its squared distance from the axis. `along` is the derivative in the inward
 * direction. */
LANE_FN BlobSum sum_end(Lanes rho2, Lanes x)
{
    BlobSum sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
    Lanes distance2 = lanes_fma(x, x, rho2);
    add_tube(&blob_numbers.tube[0], -0.5, distance2, &sum);
    add_tube(&blob_numbers.tube[1], -0.5, distance2, &sum);
    add_beads(&blob_numbers.bead[0], distance2, x, &sum);
    add_beads(&blob_numbers.bead[1], distance2, x, &sum);
    sum.along = lanes_fma(sum.across, x, sum.along);
    return sum;
}

/* Returns the sum of all components of the term at a point of the ray. */
FOLDED_FN BlobSum blob_sum_at(const PacketTerm *term, const RayPoint *at)
{
    const Lanes zero = lanes_set(0);
    const float reach =
        (float)(sqrt(2) * (blob_numbers.bead[1].offset + blob_numbers.bead[1].radius));
    BlobSum sum = {zero, zero, zero};
    Lanes rho2 = lanes_fma(at->w, at->w, term->e2);
    Lanes x = lanes_min(at->u, zero) - lanes_min(at->v, zero);
    Lanes distance2 = lanes_fma(x, x, rho2);
    add_tube(&blob_numbers.tube[0], 1, distance2, &sum);
    add_tube(&blob_numbers.tube[1], 1, distance2, &sum);
    sum.along = sum.across * x;
    if (lanes_any(at->u < reach)) {
        BlobSum end = sum_end(rho2, at->u);
        sum.value += end.value;
        sum.across += end.across;
        sum.along += end.along;
    }
    if (lanes_any(at->v < reach)) {
        BlobSum end = sum_end(rho2, at->v);
        sum.value += end.value;
        sum.across += end.across;
        sum.along -= end.along;
    }
    return sum;
}

/* Returns the value and the slope of the term at a point of the ray. */
FOLDED_FN TermSample sample_once(const PacketTerm *term, const RayPoint *at)
{
    BlobSum sum = blob_sum_at(term, at);
    Lanes slope = lanes_fma(sum.across, at->w * term->w1, sum.along * term->u1);
    return (TermSample){sum.value, -2.0f * slope};
}

/* Returns the value and the slope of the term at z. */
FOLDED_FN TermSample sample_term(const PacketTerm *term, Lanes z)
{
    const RayPoint at = point_at(term, z - term->z);
    return sample_once(term, &at);
}

/* Adds the value of the term at z to *phi and its gradient to *sum. */
LANE_FN void add_gradient(const PacketTerm *term, const Packet *packet, Lanes z, Lanes *phi,
                          Gradient *sum)
{
    const float k = term->term->k;
    const RayPoint at = point_at(term, z - term->z);
    BlobSum here = blob_sum_at(term, &at);
    *phi += here.value;
    add_direction(term, packet, at.dz, here.across * (-2 * k * k), here.along * (-2 * k), sum);
    keep_largest(term->term, here.value, sum);
}

/* Returns the lanes on which the sum of n terms exceeds the level at a point beyond z, whatever the
 * other n - 1 terms are. The point is the one nearest to the axis. Within 0.92 radii of the axis
 * and out of reach of both ends, the term is at least 1.35 times the level; up to 40 other terms
 * subtract at most 40 DIP = 0.34 times the level. */
LANE_FN LaneMask term_ensures_hit(const PacketTerm *term, Lanes z, size_t n)
{
    const float reach2 = term->term->reach2;
    LaneMask near = term->e2 <= (float)IN_UNITS2(0.92);
    if (n > 40 || !lanes_any(near))
        return (LaneMask){0};
    const RayPoint at = point_at(term, -term->w0 * inverse(term->w1));
    Lanes inside = lanes_min(at.u, at.v);
    return near & (inside > 0.0f) & (square(inside) >= reach2) & (at.dz + term->z > z);
}

/* Returns an upper bound of a term from w on. end_distance is the distance along the axis, at w, to
 * the end that the ray runs towards; negative beyond it. */
LANE_FN Lanes bound_beyond(Lanes e2, Lanes w, Lanes end_distance)
{
    const float half = 0.5f * ENVELOPE, inwards = INWARDS / (float)sqrt(2) * ENVELOPE;
    Lanes ends =
        lanes_fma(lanes_max(end_distance, lanes_set(0)), lanes_set(inwards), lanes_set(half));
    return gauss_beyond(e2, w, end_distance) * lanes_min(ends, lanes_set(ENVELOPE));
}

/* Returns the value and the slope of a term at z, and an upper bound from z on. */
LANE_FN BoundedSample bounded_sample(const PacketTerm *term, Lanes z)
{
    const RayPoint at = point_at(term, z - term->z);
    Lanes bound = bound_beyond(term->e2, at.w, lanes_select(term->u1 > 0.0f, at.v, at.u));
    return (BoundedSample){sample_once(term, &at), lanes_min(bound, term->peak)};
}

#endif
