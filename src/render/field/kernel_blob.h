/* Terms of the blob [field/blob.h; kernel_packet.h], times FIELD_LEVEL, so that the level is that
 * of the potential.
 *
 * The field of a segment is 0 beyond its reach. It is a polynomial piece by piece, and its second
 * derivative jumps from piece to piece. The bounds below hold for blob_shape and segments of any
 * length; tests/unit/blob_test.c compares them with the field. Lengths are in radii, and the field
 * is not yet multiplied:
 *
 * - Distance. At the distance x from the segment, the field is at most ENVELOPE exp(2 - 2 x^2).
 *   Beyond an end it is at most half of that. At y within an end it is at most 1/2 + INWARDS y of
 *   that. The field is at least -DIP: beads beyond an end may outweigh the other components there.
 * - Steepness. At the distance x within the reach R, the gradient is at most STEEPNESS (1 - x^2 /
 *   R^2).
 * - Curvature. A line passes the segment at the distance d, and the nearer of its ends at the
 *   distance e. Along the line, the second derivative is at most the largest of CURVED (1 - x^2 /
 *   WIDTH^2), near an end with x = e, near the axis and far from it with x = d, and of 0. Where
 *   the line stays out of reach of both ends, it is at most that times the squared sine of the
 *   angle between line and axis. It is at least -1.25 times that. */
#ifndef CORCAST_RENDER_FIELD_KERNEL_BLOB_H
#define CORCAST_RENDER_FIELD_KERNEL_BLOB_H

#include "render/field/kernel_packet.h"

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

/* IN_UNITS2 converts a squared length from radii to units of 1 / k. PER_UNITS2 converts a second
 * derivative, and multiplies it by the level. */
#define IN_UNITS2(length) (2 * (length) * (length))
#define PER_UNITS2(curvature) (0.5f * LEVEL * (curvature))

/* A crossing is certain to lie ahead if the squared slope exceeds SURE times curvature times lack
 * of potential. */
#define SURE 2.6f

_Static_assert(BLOB_TUBES == 2 && BLOB_BEAD_PAIRS == 2, "the sums below name them one by one");
static const BlobShape blob_numbers = BLOB_SHAPE;

/* Returns the margin of `n` terms, without the rounding of positions. A component is off by at most
 * 10 * 2^-24 of its strength, times the level. */
LANE_FN float fixed_margin(size_t n)
{
    return 1e-6f + 2e-6f * (float)n;
}

/* Returns the maximum error of the term per mm of error of its position, up to a factor that
 * MARGIN_PLACE includes. */
LANE_FN Lanes steepness(const PacketTerm *term)
{
    Lanes inside = 1.0f - (term->e2 + term->past) / term->term->reach2;
    return lanes_max(inside, lanes_set(0)) * (STEEPNESS / (float)sqrt(2) * LEVEL * term->term->k);
}

/* Sets what bounds the term. */
LANE_FN void bound_term(PacketTerm *term, LaneMask beyond)
{
    (void)beyond;
    Lanes d2 = term->e2 + term->past;
    Lanes most = ENVELOPE * lanes_exp_minus(d2);
    term->peak = lanes_select(d2 < term->term->reach2, most, lanes_set(0));
}

/* Returns the bound CURVED (1 - x^2 / WIDTH^2), in units of 1 / k, from x^2 in these units. */
LANE_FN Lanes curved_within(float curved, float width, Lanes distance2)
{
    const float most = PER_UNITS2(curved);
    return lanes_fma(distance2, lanes_set(-most / (float)IN_UNITS2(width)), lanes_set(most));
}

/* Sets the bound of the term's second derivative, and its maximum error. */
LANE_FN void bound_bend(PacketTerm *term)
{
    Lanes d2 = term->e2 + term->past;
    Lanes end2 = term->e2 + lanes_min(term->end_y2[0], term->end_y2[1]);
    Lanes near_end = curved_within(NEAR_END_CURVED, NEAR_END_WIDTH, end2);
    Lanes near_axis = curved_within(NEAR_AXIS_CURVED, NEAR_AXIS_WIDTH, d2);
    Lanes far = lanes_max(curved_within(FAR_CURVED, FAR_WIDTH, d2), lanes_set(0));
    Lanes bend = lanes_max(lanes_max(near_end, near_axis), far);
    Lanes along = lanes_select(end2 < term->term->reach2, square(term->u1), lanes_set(0));
    term->curvature = bend * (square(term->w1) + along);
    term->steep = steepness(term);
}

/* Sets the fields that a sample of the term needs. */
LANE_FN void bend_term(PacketTerm *term, bool perspective)
{
    (void)perspective;
    bound_bend(term);
    term->bent = true;
}

/* Sets the fields that only packets need that may hit something. */
LANE_FN void complete_term(PacketTerm *term, bool perspective)
{
    bend_term(term, perspective);
    term->spare = term->past;
    place_ends(term);
}

/* The sum of components at a point: their values, and minus half of their derivatives, by the
 * squared distance from the axis and by the position along the axis. */
typedef struct BlobSum {
    Lanes value, across, along;
} BlobSum;

/* Adds `part` of the strength of a tube, at a squared distance from the tube. The compiler knows
 * the numbers of the tube where it inlines this function. */
FOLDED_FN void add_tube(const BlobTube *tube, double part, Lanes distance2, BlobSum *sum)
{
    const double strength = part * tube->strength * FIELD_LEVEL, per = 1 / IN_UNITS2(tube->radius);
    Lanes inside =
        lanes_max(lanes_fma(distance2, lanes_set((float)-per), lanes_set(1)), lanes_set(0));
    sum->value = lanes_fma(inside * (float)strength, inside, sum->value);
    sum->across = lanes_fma(inside, lanes_set((float)(2 * strength * per)), sum->across);
}

/* Adds two opposite beads: one inwards of an end of the segment, one beyond it. The point is at x
 * inwards from the end and at a squared distance from the end. What is added to `along` lacks x
 * times what is added to `across`; the caller adds that. */
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

/* Returns the sum of the components at an end, at the position x inwards from the end and at the
 * squared distance rho2 from the axis. Its derivative `along` points inwards, too. */
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

/* Returns the value of the term at a place of its ray. */
FOLDED_FN BlobSum blob_sum_at(const PacketTerm *term, const RayPlace *at)
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

/* Returns the value of the term at a place. Only the fields of its ray need to be set. */
FOLDED_FN TermSample sample_once(const PacketTerm *term, const RayPlace *at)
{
    BlobSum sum = blob_sum_at(term, at);
    Lanes slope = lanes_fma(sum.across, at->w * term->w1, sum.along * term->u1);
    return (TermSample){sum.value, -2.0f * slope};
}

FOLDED_FN TermSample sample_term(const PacketTerm *term, Lanes z)
{
    const RayPlace at = place_at(term, z - term->z);
    return sample_once(term, &at);
}

LANE_FN void add_gradient(const PacketTerm *term, const Packet *packet, Lanes z, Lanes *phi,
                          Gradient *sum)
{
    const float k = term->term->k;
    const RayPlace at = place_at(term, z - term->z);
    BlobSum here = blob_sum_at(term, &at);
    *phi += here.value;
    add_direction(term, packet, at.dz, here.across * (-2 * k * k), here.along * (-2 * k), sum);
    name_largest(term->term, here.value, sum);
}

/* Returns the lanes on which a term exceeds the level somewhere beyond z, for any values of the
 * other `n` - 1 terms: far from its ends, the term is at least 1.35 times the level where the ray
 * is nearest to the axis, and 40 other terms subtract less than 0.34. */
LANE_FN LaneMask term_hides(const PacketTerm *term, Lanes z, size_t n)
{
    const float reach2 = term->term->reach2;
    LaneMask near = term->e2 <= (float)IN_UNITS2(0.92);
    if (n > 40 || !lanes_any(near))
        return (LaneMask){0};
    const RayPlace at = place_at(term, -term->w0 * inverse(term->w1));
    Lanes inside = lanes_min(at.u, at.v);
    return near & (inside > 0.0f) & (square(inside) >= reach2) & (at.dz + term->z > z);
}

/* Returns an upper bound of a term from w on. The end that the ray leaves is at `leaves`. */
LANE_FN Lanes most_beyond(Lanes e2, Lanes w, Lanes leaves)
{
    const float half = 0.5f * ENVELOPE, inwards = INWARDS / (float)sqrt(2) * ENVELOPE;
    Lanes ends = lanes_fma(lanes_max(leaves, lanes_set(0)), lanes_set(inwards), lanes_set(half));
    return gauss_beyond(e2, w, leaves) * lanes_min(ends, lanes_set(ENVELOPE));
}

LANE_FN TermThere term_at(const PacketTerm *term, Lanes z)
{
    const RayPlace at = place_at(term, z - term->z);
    Lanes most = most_beyond(term->e2, at.w, lanes_select(term->u1 > 0.0f, at.v, at.u));
    return (TermThere){sample_once(term, &at), lanes_min(most, term->peak)};
}

#endif
