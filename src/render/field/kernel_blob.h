/* Terms of the blob [surface/blob.h; kernel_packet.h], times FIELD_LEVEL, so that the level is that
 * of the potential.
 *
 * The field of a segment is 0 beyond its reach, and a polynomial piece by piece, with jumps of the
 * second derivative from piece to piece. Its bounds are those of blob_shape, over segments of any
 * length; tests/unit/blob_test.c holds them against the field. In radii, and before the
 * field is multiplied:
 *
 * - Distance. At the distance x of the segment it is at most ENVELOPE exp(2 - 2 x^2), at most half
 *   of that beyond an end, and at least -DIP: beads beyond an end may outweigh what else is there.
 * - Curvature. The second derivative along any line is at most CURVED_NEAR_END, unless the line
 * stays farther than NEAR_END from both ends, or farther than NEAR_AXIS from the segment; then it
 * is at most the next of the three, times the squared sine of the line to the axis where the line
 * stays out of reach of both ends. It is no less than -1.25 times that. */
#ifndef CORCAST_RENDER_KERNEL_BLOB_H
#define CORCAST_RENDER_KERNEL_BLOB_H

#include "render/field/kernel_packet.h"

#define ENVELOPE 1.05f
#define DIP 0.0085f
#define NEAR_END 1.068f
#define NEAR_AXIS 1.191f
#define CURVED_NEAR_END 36.0f
#define CURVED_NEAR_AXIS 18.5f
#define CURVED_FAR 5.8f

/* A squared length in radii, in units of 1 / k, and a second derivative likewise. */
#define IN_UNITS2(length) (2 * (length) * (length))
#define PER_UNITS2(curvature) (0.5f * LEVEL * (curvature))

static const BlobShape blob_numbers = BLOB_SHAPE;

/* The part of the margin that `n` terms have without the rounding of places. A component is off by
 * at most 10 * 2^-24 of its strength, times the level. */
LANE_FN float fixed_margin(size_t n)
{
    return 1e-6f + 2e-6f * (float)n;
}

/* How much the term may be off where its place is off by 1 mm; MARGIN_PLACE allows for a factor. */
LANE_FN Lanes steepness(const PacketTerm *term)
{
    Lanes inside = 1.0f - (term->e2 + term->past) / term->term->reach2;
    return lanes_max(inside, lanes_set(0)) * (2 * term->term->k);
}

/* Sets what bounds the term. */
LANE_FN void bound_term(PacketTerm *term, LaneMask beyond)
{
    (void)beyond;
    Lanes d2 = term->e2 + term->past;
    Lanes most = ENVELOPE * lanes_exp_minus(d2);
    term->peak = lanes_select(d2 < term->term->reach2, most, lanes_set(0));
}

/* Sets what only packets need that may hit something. */
LANE_FN void complete_term(PacketTerm *term, bool perspective)
{
    (void)perspective;
    Lanes end2 = term->e2 + lanes_min(term->end_y2[0], term->end_y2[1]);
    LaneMask near_axis = term->e2 + term->past < (float)IN_UNITS2(NEAR_AXIS);
    Lanes bend = lanes_select(near_axis, lanes_set(PER_UNITS2(CURVED_NEAR_AXIS)),
                              lanes_set(PER_UNITS2(CURVED_FAR)));
    bend = lanes_select(end2 < (float)IN_UNITS2(NEAR_END), lanes_set(PER_UNITS2(CURVED_NEAR_END)),
                        bend);
    Lanes along = lanes_select(end2 < term->term->reach2, square(term->u1), lanes_set(0));
    term->curvature = bend * (square(term->w1) + along);
    term->spare = term->past;
    place_ends(term);
}

/* Components added up at a place: their values, and half their derivatives, with the opposite sign,
 * by the square of the distance from the axis and by the place along it. */
typedef struct BlobSum {
    Lanes value, across, along;
} BlobSum;

/* Adds a component at the squared distance d2 from it, x of which lies along the axis. */
LANE_FN void add_component(double strength, double radius, Lanes d2, Lanes x, BlobSum *sum)
{
    const float per_radius2 = (float)(1 / IN_UNITS2(radius));
    Lanes inside = lanes_max(1.0f - d2 * per_radius2, lanes_set(0));
    Lanes value = inside * (float)(strength * FIELD_LEVEL), pull = value * (2 * per_radius2);
    sum->value = lanes_fma(value, inside, sum->value);
    sum->across += pull;
    sum->along = lanes_fma(pull, x, sum->along);
}

/* Adds what stands at an end, at x inwards from it and at the squared distance rho2 from the axis;
 * its derivative `along` runs inwards, too. */
LANE_FN void add_end(Lanes rho2, Lanes x, BlobSum *sum)
{
    Lanes d2 = lanes_fma(x, x, rho2);
    for (int i = 0; i < BLOB_TUBES; i++)
        add_component(-0.5 * blob_numbers.tube[i].strength, blob_numbers.tube[i].radius, d2, x,
                      sum);
    for (int i = 0; i < BLOB_BEADS; i++) {
        const float offset = (float)(sqrt(2) * blob_numbers.bead[i].offset);
        Lanes in = x - offset, out = x + offset;
        add_component(blob_numbers.bead[i].strength, blob_numbers.bead[i].radius,
                      lanes_fma(in, in, rho2), in, sum);
        add_component(-blob_numbers.bead[i].strength, blob_numbers.bead[i].radius,
                      lanes_fma(out, out, rho2), out, sum);
    }
}

/* Where the term is at dz. */
LANE_FN BlobSum blob_sum(const PacketTerm *term, Lanes dz, Lanes w)
{
    const Lanes zero = lanes_set(0);
    const float reach =
        (float)(sqrt(2) * (blob_numbers.bead[1].offset + blob_numbers.bead[1].radius));
    BlobSum sum = {zero, zero, zero}, last = sum;
    Lanes u = lanes_fma(term->u1, dz, term->u0), v = lanes_fma(-term->u1, dz, term->v0);
    Lanes rho2 = lanes_fma(w, w, term->e2), x = lanes_min(u, zero) - lanes_min(v, zero);
    Lanes d2 = lanes_fma(x, x, rho2);
    for (int i = 0; i < BLOB_TUBES; i++)
        add_component(blob_numbers.tube[i].strength, blob_numbers.tube[i].radius, d2, x, &sum);
    if (lanes_any(u < reach))
        add_end(rho2, u, &sum);
    if (lanes_any(v < reach)) {
        add_end(rho2, v, &last);
        sum.value += last.value;
        sum.across += last.across;
        sum.along -= last.along;
    }
    return sum;
}

/* The slope along the ray of a sum. */
LANE_FN Lanes slope_of(const PacketTerm *term, Lanes w, const BlobSum *sum)
{
    return -2.0f * lanes_fma(sum->across, w * term->w1, sum->along * term->u1);
}

LANE_FN void add_sample(const PacketTerm *term, Lanes z, PacketSample *sample)
{
    Lanes dz = z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    BlobSum sum = blob_sum(term, dz, w);
    sample->phi += sum.value;
    sample->slope += slope_of(term, w, &sum);
    sample->curvature += term->curvature;
}

LANE_FN void add_gradient(const PacketTerm *term, const Packet *packet, Lanes z, Lanes *phi,
                          Gradient *sum)
{
    const float k = term->term->k;
    Lanes dz = z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    BlobSum at = blob_sum(term, dz, w);
    *phi += at.value;
    add_direction(term, packet, dz, at.across * (-2 * k * k), at.along * (-2 * k), sum);
    name_largest(term->term, at.value, sum);
}

/* The lanes on which a term is above the level somewhere beyond z, whatever the other of `n` terms
 * are: far from its ends it is at least 1.35 times the level where the ray is nearest to the axis,
 * and 40 others take away less than 0.34. */
LANE_FN LaneMask term_hides(const PacketTerm *term, Lanes z, size_t n)
{
    const float reach2 = term->term->reach2;
    LaneMask near = term->e2 <= (float)IN_UNITS2(0.92);
    if (n > 40 || !lanes_any(near))
        return (LaneMask){0};
    Lanes dz = -term->w0 * inverse(term->w1);
    Lanes u = lanes_fma(term->u1, dz, term->u0), v = lanes_fma(-term->u1, dz, term->v0);
    Lanes inside = lanes_min(u, v);
    return near & (inside > 0.0f) & (square(inside) >= reach2) & (dz + term->z > z);
}

/* No more than this is the term anywhere from z on. */
LANE_FN Lanes most_beyond(const PacketTerm *term, Lanes z)
{
    return lanes_min(ENVELOPE * gauss_beyond(term, z), term->peak);
}

LANE_FN TermThere term_at(const PacketTerm *term, Lanes z)
{
    Lanes dz = z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    BlobSum sum = blob_sum(term, dz, w);
    return (TermThere){sum.value, slope_of(term, w, &sum), most_beyond(term, z)};
}

#endif
