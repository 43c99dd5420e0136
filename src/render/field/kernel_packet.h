/* Places the segments of a tile relative to a packet of rays: where along each ray a segment
 * contributes to the field, and how far it is from the ray. A packet is a block of LANES
 * neighbouring rays, one per lane of the vector registers. A term is the contribution of one
 * segment to the field.
 *
 * The positions are the same for the two fields, the potential and the blob. The values of the
 * terms are computed in kernel_potential.h or kernel_blob.h; a source includes one of these two,
 * which include this file. For each packet, divide_workspace comes first. terms_near then selects
 * terms, and place_orthographic or place_perspective computes their coefficients. w, u and v are
 * affine in z, so each sample costs a few operations (point_at).
 *
 * Notation, with the fields of PacketTerm. Lengths are in units of 1 / k [FrameSegment.k].
 * - z is the parameter of a ray: the depth. dz is z minus the z of Q [TileTerm].
 * - E is the distance between the ray and the axis line of the segment. e2 is E^2.
 * - w, u, v are coordinates of a point of the ray in the plane that is parallel to ray and axis: w
 *   is the distance across the axis, u the distance along the axis from the segment's first end,
 *   and v the distance along the axis to the second end. Beside the segment, u and v are >= 0.
 * - d is the distance between the ray and the segment: d^2 = e2 + past2.
 * - s, a are the sine and the cosine of the angle between ray and axis; a is `cosine`.
 * - h is 1/2 if the ray is nearest to the axis line beyond an end of the segment, else 1.
 * - B (`peak`) is an upper bound of the term on the ray, and M (`curvature`) one of its second
 *   derivative along the ray. 1e30 stands for infinity. */
#ifndef CORCAST_RENDER_FIELD_KERNEL_PACKET_H
#define CORCAST_RENDER_FIELD_KERNEL_PACKET_H

#include "render/field/kernel_trace_common.h"

/* Marks functions that must be inlined, so that results that a caller does not use are not
 * computed. */
#define FOLDED_FN LANE_FN __attribute__((always_inline))

/* A term along the rays of a packet. place_term [kernel_trace.h] sets the fields up to
 * inverse_speed2. complete_term sets the other Lanes up to end_z and `flat`, and place_windows
 * [kernel_trace.h] `window` and `reach`, both only if the packet may hit something. The kernel of
 * the blob uses neither gauss, h_per_sine, cosine, half_gauss nor flat. */
typedef struct PacketTerm {
    Lanes w0, w1, u0, u1, v0; /* w = w0 + w1 dz, u = u0 + u1 dz, v = v0 - u1 dz */
    Lanes peak;               /* B, an upper bound of the term on the ray; 0: the term is below the
                               * cut-off */
    Lanes gauss;              /* exp(-d^2) */
    Lanes e2, end_y2[2];      /* E^2; and the squared distances between the ray and the two ends,
                               * minus E^2 */
    Lanes past2; /* d^2 - E^2: the squared distance past an end where the ray is nearest
                  * to the segment */
    Lanes h_per_sine, cosine; /* h / s (1 / s before bound_term); a */
    Lanes inverse_speed2;     /* 1 / (w1^2 + u1^2) */
    Lanes half_gauss;         /* exp(-E^2) / 2 */
    Lanes curvature;          /* M, an upper bound of the second derivative */
    Lanes peak_fall;          /* where B is not 0, it is at least exp(-E^2 - peak_fall) */
    Lanes steepness;          /* steepness() of the term */
    Lanes end_z[2];           /* dz of the points of the ray that are nearest to the two ends */
    Lanes window[2]; /* interval of z outside which the term is below its share of the level
                      * [Windows in kernel_trace.h] */
    Lanes reach[2];  /* interval of z outside which the term is below the cut-off */
    const TileTerm *term;
    float z;          /* z of Q [TileTerm]. This z, z_range, window and reach are relative to one
                       * base, TermRun.base [kernel_trace.h] */
    float z_range[2]; /* TileTerm.z_begin and z_end */
    bool flat;        /* true: u and v are constant along the ray, and half_gauss includes the axial
                       * factor */
} PacketTerm;

/* LANES terms of a tile of an orthographic view, one per lane: their segments projected to the
 * view's plane. A position (x, y) in mm, plus `o`, times `cross` is a distance in units of 1 /
 * k. */
typedef struct ProjectedTerms {
    Lanes o[2], cross[2]; /* as in TileTerm */
    Lanes first, last;    /* distances of the two ends from P [TileTerm], along the projected
                           * axis; units of 1 / k */
    Lanes reach, k;       /* distance of the cut-off, units of 1 / k; TileTerm.k */
} ProjectedTerms;

_Static_assert(sizeof(ProjectedTerms) + sizeof(PacketTerm) + sizeof(PacketTerm *) +
                       sizeof(uint32_t) <=
                   TILE_WORK_BYTES,
               "TILE_WORK_BYTES");

/* A packet: LANES rays, and the terms of the tile along them. All pointers except `tile` point into
 * the kernel's workspace. */
typedef struct Packet {
    const FieldTile *tile;
    Lanes x, y;                /* positions of the samples */
    float middle[2], half;     /* middle and radius of a circle around the samples */
    ProjectedTerms *projected; /* the tile's terms; orthographic views only */
    PacketTerm *terms;     /* the terms of the tile that can exceed the cut-off in the packet, in
                            * the order of the tile */
    PacketTerm **selected; /* the terms whose sum is searched: all, or those of one blend group */
    uint32_t *segments;    /* per term: its segment; used to find blend groups */
    size_t n, n_selected;  /* numbers of `terms` and of `selected` */
} Packet;

/* Projects the tile's terms. Lanes past the last term repeat the first term of their block. */
LANE_FN void project_terms(const FieldTile *tile, ProjectedTerms *projected)
{
    for (size_t i = 0; i < tile->n_terms; i += LANES) {
        ProjectedTerms *out = &projected[i / LANES];
        for (size_t lane = 0; lane < LANES; lane++) {
            const TileTerm *term = &tile->terms[i + lane < tile->n_terms ? i + lane : i];
            for (int c = 0; c < 2; c++) {
                out->o[c][lane] = term->o[c];
                out->cross[c][lane] = term->cross[c];
            }
            out->first[lane] = term->u * term->sine;
            out->last[lane] = term->v * term->sine;
            out->reach[lane] = term->reach2;
            out->k[lane] = term->k;
        }
        out->reach = lanes_sqrt(out->reach);
    }
}

/* Divides the workspace, which begins at packet->terms, among the arrays, and projects the terms of
 * an orthographic view. */
LANE_FN void divide_workspace(Packet *packet)
{
    const FieldTile *tile = packet->tile;
    packet->projected = (ProjectedTerms *)(packet->terms + tile->n_terms);
    packet->selected = (PacketTerm **)(packet->projected + (tile->n_terms + LANES - 1) / LANES);
    packet->segments = (uint32_t *)(packet->selected + tile->n_terms);
    if (!tile->perspective)
        project_terms(tile, packet->projected);
}

/* Returns a bit mask of the terms, among the LANES terms from `first` on, that may exceed the
 * cut-off in the packet: in an orthographic view, those whose projected segment is within reach of
 * the circle around the samples. In perspective the lengths depend on z, and all terms are
 * returned. */
LANE_FN uint32_t terms_near(const Packet *packet, size_t first)
{
    const FieldTile *tile = packet->tile;
    const size_t n = tile->n_terms - first < LANES ? tile->n_terms - first : LANES;
    const uint32_t all = (1u << n) - 1;
    if (tile->perspective)
        return all;
    const ProjectedTerms *terms = &packet->projected[first / LANES];
    Lanes x = terms->o[0] + packet->middle[0], y = terms->o[1] + packet->middle[1];
    Lanes along = lanes_fma(x, terms->cross[1], -(y * terms->cross[0]));
    Lanes across = lanes_fma(y, terms->cross[1], x * terms->cross[0]);
    Lanes past = lanes_min(lanes_min(along + terms->first, terms->last - along), lanes_set(0));
    Lanes far = lanes_fma(terms->k, lanes_set(packet->half), terms->reach);
    return all & lanes_bits(lanes_fma(past, past, square(across)) < square(far));
}

/* Returns 1 / a, or 1e20 if |a| is at most 1e-20. An axis or ray without extent in this direction
 * then gets a crossing that is too far away to matter, but finite. */
LANE_FN Lanes inverse(Lanes a)
{
    return 1.0f / lanes_select(lanes_abs(a) > 1e-20f, a, lanes_set(1e-20f));
}

/* An interval of dz; empty if low > high. */
typedef struct DepthInterval {
    Lanes low, high;
} DepthInterval;

/* 1 / w1 and 1 / u1 of a term. */
typedef struct Inverses {
    Lanes w, u;
} Inverses;

/* Returns the inverses of a term. */
LANE_FN Inverses inverses_of(const PacketTerm *term, bool perspective)
{
    if (perspective)
        return (Inverses){inverse(term->w1), inverse(term->u1)};
    return (Inverses){lanes_set(term->term->per_k_sine), lanes_set(term->term->per_k_cosine)};
}

/* Returns the interval in which |w| is at most `width` and the point is at most `beyond` outside
 * the ends, along the axis. Empty where width2, the square of `width`, is negative. */
LANE_FN DepthInterval interval_within(const PacketTerm *term, const Inverses *per, Lanes width2,
                                      Lanes width, Lanes beyond)
{
    Lanes first = (-beyond - term->u0) * per->u, last = (term->v0 + beyond) * per->u;
    Lanes from = lanes_max((-width - term->w0) * per->w, lanes_min(first, last));
    Lanes to = lanes_min((width - term->w0) * per->w, lanes_max(first, last));
    LaneMask seen = (width2 >= 0.0f) & (from <= to);
    return (DepthInterval){lanes_select(seen, from, lanes_set(1e30f)),
                           lanes_select(seen, to, lanes_set(-1e30f))};
}

/* Returns an interval that contains two sets of points of the ray: the points beside the segment
 * whose squared distance from the axis is at most beside2 + E^2, and the points whose squared
 * distance from an end is at most beyond2 + E^2. */
LANE_FN DepthInterval interval_about(const PacketTerm *term, const Inverses *per, Lanes beside2,
                                     Lanes beyond2)
{
    const Lanes zero = lanes_set(0), none = lanes_set(1e30f);
    DepthInterval about =
        interval_within(term, per, beside2, lanes_sqrt(lanes_max(beside2, zero)), zero);
    for (int end = 0; end < 2; end++) {
        Lanes chord2 = (beyond2 - term->end_y2[end]) * term->inverse_speed2;
        LaneMask seen = chord2 >= 0.0f;
        Lanes half = lanes_sqrt(lanes_max(chord2, zero));
        about.low = lanes_min(about.low, lanes_select(seen, term->end_z[end] - half, none));
        about.high = lanes_max(about.high, lanes_select(seen, term->end_z[end] + half, -none));
    }
    return about;
}

/* Position and direction of the rays at dz = 0, relative to the term. */
typedef struct TermRays {
    Lanes o[3], d[3];
} TermRays;

/* Returns the rays of a packet relative to a term. */
FOLDED_FN TermRays rays_of(const Packet *packet, const TileTerm *term)
{
    const FieldTile *tile = packet->tile;
    TermRays rays = {{packet->x + term->o[0], packet->y + term->o[1], lanes_set(term->o[2])},
                     {lanes_set(0), lanes_set(0), lanes_set(1)}};
    if (tile->perspective) {
        float z = (float)term->z_near;
        rays.o[0] = packet->x * z + term->o[0];
        rays.o[1] = packet->y * z + term->o[1];
        rays.d[0] = packet->x + (float)tile->middle_x;
        rays.d[1] = packet->y + (float)tile->middle_y;
    }
    return rays;
}

/* Sets the coefficients of w, u and v, e2, h_per_sine (to 1 / s), cosine and inverse_speed2 of a
 * term in an orthographic view. Returns false if the term is below the cut-off on every ray; some
 * fields are then not set. */
FOLDED_FN bool place_orthographic(const Packet *packet, const TileTerm *term, PacketTerm *out)
{
    const float k = term->k, s = term->sine, a = term->cosine, *cross = term->cross;
    Lanes x = packet->x + term->o[0], y = packet->y + term->o[1];
    Lanes along = lanes_fma(x, lanes_set(cross[1]), -(y * cross[0]));
    out->e2 = square(lanes_fma(y, lanes_set(cross[1]), x * cross[0]));
    if (!lanes_any(out->e2 < term->reach2))
        return false;
    out->w0 = along * -a;
    out->w1 = lanes_set(k * s);
    out->u0 = lanes_fma(along, lanes_set(s), lanes_set(term->u));
    out->v0 = lanes_fma(along, lanes_set(-s), lanes_set(term->v));
    out->u1 = lanes_set(k * a);
    out->h_per_sine = lanes_set(term->per_sine);
    out->cosine = lanes_set(fabsf(a));
    out->inverse_speed2 = lanes_set(term->per_k2);
    return true;
}

/* Returns the dot product of a and b. */
LANE_FN Lanes dot(const Lanes a[3], const float b[3])
{
    return lanes_fma(a[0], lanes_set(b[0]), lanes_fma(a[1], lanes_set(b[1]), a[2] * b[2]));
}

/* Sets the fields that place_orthographic sets, in perspective, where rays are not parallel. The
 * part of the cross products that all directions share was computed for the tile in double
 * precision, so that rays that are nearly parallel to the axis lose no digits. */
FOLDED_FN void place_perspective(const Packet *packet, const TileTerm *term, PacketTerm *out)
{
    const float k = term->k, *axis = term->axis;
    TermRays rays = rays_of(packet, term);
    Lanes cx = lanes_fma(packet->y, lanes_set(axis[2]), lanes_set(term->cross[0]));
    Lanes cy = lanes_fma(packet->x, lanes_set(-axis[2]), lanes_set(term->cross[1]));
    Lanes cz = packet->x * axis[1] - packet->y * axis[0] + term->cross[2];
    Lanes crossed = lanes_sqrt(square(cx) + square(cy) + square(cz));
    Lanes per_cross = 1.0f / lanes_max(crossed, lanes_set(1e-20f));
    cx *= per_cross;
    cy *= per_cross;
    cz *= per_cross;
    /* axis x cross: across the axis, in the plane of ray and axis */
    Lanes nx = axis[1] * cz - axis[2] * cy, ny = axis[2] * cx - axis[0] * cz,
          nz = axis[0] * cy - axis[1] * cx;
    Lanes along = dot(rays.o, axis), speed = dot(rays.d, axis);
    out->e2 = square((rays.o[0] * cx + rays.o[1] * cy + rays.o[2] * cz) * k);
    out->w0 = (rays.o[0] * nx + rays.o[1] * ny + rays.o[2] * nz) * k;
    out->w1 = crossed * k;
    out->u0 = lanes_fma(along, lanes_set(k), lanes_set(term->u));
    out->v0 = lanes_fma(along, lanes_set(-k), lanes_set(term->v));
    out->u1 = speed * k;
    Lanes length2 = square(crossed) + square(speed), length = lanes_sqrt(length2);
    out->h_per_sine = per_cross * length;
    out->cosine = lanes_abs(speed) / length;
    out->inverse_speed2 = 1.0f / (length2 * (k * k));
}

/* One point of each ray: its dz, w, u and v. */
typedef struct RayPoint {
    Lanes dz, w, u, v;
} RayPoint;

/* Returns the points of the rays at dz. */
FOLDED_FN RayPoint point_at(const PacketTerm *term, Lanes dz)
{
    return (RayPoint){dz, lanes_fma(term->w1, dz, term->w0), lanes_fma(term->u1, dz, term->u0),
                      lanes_fma(-term->u1, dz, term->v0)};
}

/* Computes end_z of a term. */
LANE_FN void place_ends(PacketTerm *term)
{
    Lanes across = term->w0 * term->w1;
    term->end_z[0] = -lanes_fma(term->u0, term->u1, across) * term->inverse_speed2;
    term->end_z[1] = lanes_fma(term->v0, term->u1, -across) * term->inverse_speed2;
}

/* The value of a term at one point of each ray, and its derivative along the ray. */
typedef struct TermSample {
    Lanes value, slope;
} TermSample;

/* The sum of terms at one point of each ray, and its derivative along the ray. */
typedef struct PacketSample {
    Lanes phi, slope;
    Lanes curvature; /* sum of the bounds M of the terms within reach; valid until `next` */
    Lanes next;      /* the next z at which another term comes within reach */
    Lanes steepness; /* maximum error of phi per mm of error of the position */
    float depth;     /* maximum over the terms of the length of z_range, mm */
    size_t n;        /* number of terms that were added */
} PacketSample;

/* Returns an empty sum. */
LANE_FN PacketSample nothing_sampled(void)
{
    return (PacketSample){.next = lanes_set(1e30f)};
}

/* Adds a term to the sum in the lanes `here`. */
LANE_FN void add_sample(const TermSample *one, LaneMask here, const PacketTerm *term,
                        PacketSample *sum)
{
    sum->phi = lanes_add_where(here, sum->phi, one->value);
    sum->slope = lanes_add_where(here, sum->slope, one->slope);
    sum->curvature = lanes_add_where(here, sum->curvature, term->curvature);
    sum->steepness = lanes_add_where(here, sum->steepness, term->steepness);
    float depth = term->z_range[1] - term->z_range[0];
    sum->depth = depth > sum->depth ? depth : sum->depth;
    sum->n++;
}

/* Adds the gradient of a term at dz: `across` times the vector from the axis line to the point,
 * plus `along` times the axis. */
LANE_FN void add_direction(const PacketTerm *term, const Packet *packet, Lanes dz, Lanes across,
                           Lanes along, Gradient *sum)
{
    const float *axis = term->term->axis;
    TermRays rays = rays_of(packet, term->term);
    for (int c = 0; c < 3; c++)
        rays.o[c] = lanes_fma(rays.d[c], dz, rays.o[c]);
    along -= across * dot(rays.o, axis);
    sum->x += lanes_fma(across, rays.o[0], along * axis[0]);
    sum->y += lanes_fma(across, rays.o[1], along * axis[1]);
    sum->z += lanes_fma(across, rays.o[2], along * axis[2]);
}

/* The value of a term at a point of each ray, and its upper bound from this point on. */
typedef struct BoundedSample {
    TermSample at;
    Lanes bound;
} BoundedSample;

/* Returns an upper bound of exp(-x^2), where x is the minimum distance between the segment and the
 * part of the ray from w on. The ray runs towards one of the two ends; `end_distance` is the
 * distance along the axis, at w, to this end. It is negative beyond the end. */
LANE_FN Lanes gauss_beyond(Lanes e2, Lanes w, Lanes end_distance)
{
    /* w increases along the ray; the ray is nearest to the axis line at w = 0. */
    Lanes away = lanes_max(w, lanes_set(0)), past = lanes_min(end_distance, lanes_set(0));
    return lanes_exp_minus(lanes_fma(past, past, lanes_fma(away, away, e2)));
}

#endif
