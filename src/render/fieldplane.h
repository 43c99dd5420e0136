/* The first hits of a tile whose vessels all lie in one plane, square to the rays: trees in a disc,
 * seen face-on.
 *
 * With q the square of the distance from the plane, a term is A exp(-k^2 q), A = exp(-E^2) (erf u +
 * erf v) / 2. So the potential falls strictly with q: a ray hits if the sum of A exceeds the level,
 * once on its way to the plane, and needs no search. About a lone vessel ln Phi = ln A - k^2 q gives
 * q at once. Else Halley's method finds it, in units of 1 / K^2, K the largest k of the packet:
 * ln Phi is convex in q, its first derivative is the mean m and its second the variance v of
 * p = (k / K)^2 among the terms.
 *
 * With R the range of p, a step d of Halley's method leaves ln Phi off by less than 0.081 (R d)^3:
 * the parabola it solves by v^2 d^3 / (4 m (1 + v d / (2 m))), of which v <= m R [Bhatia & Davis
 * 2000] and v <= R^2 / 4, and what the parabola leaves out is at most |d|^3 / 6 times the third
 * central moment, R^3 / (6 sqrt 3). Rays that start between surface and plane, and those within the
 * margin of the level, are handed back. */
#include "render/fieldlanes.h"

/* The last step, times the range of p: it leaves Phi within 4e-6 of the level, in parts of it. */
#define PLANE_CLOSE 0.035f
#define PLANE_STEPS 32

typedef struct PlaneTerm {
    Lanes e;
    Lanes amplitude; /* A */
    Lanes slope;     /* A's derivative along the axis, 1 / (2 k) of it */
    Lanes fall;      /* exp(-k^2 q) */
    const TileTerm *term;
} PlaneTerm;

_Static_assert(sizeof(PlaneTerm) + sizeof(uint32_t) <= TILE_WORK_BYTES, "TILE_WORK_BYTES");

typedef struct PlanePacket {
    PlaneTerm *terms;
    size_t n;
    float per_k;         /* 1 / K, mm */
    float middle, range; /* of p */
    Lanes q;
    Lanes step;               /* of q, the last, which the terms have not taken */
    Lanes sum, sum_p, sum_p2; /* of A exp(-k^2 q) times powers of p */
} PlanePacket;

enum {
    PLANE_PACKETS = TILE_SAMPLES / LANES,
    PLANE_PARTS = (PLANE_PACKETS + LANES - 1) / LANES /* vectors with a lane for each packet */
};

/* Where the rays of a packet pass a term: E, and the distances, times k, from the two ends. */
typedef struct PlanePlace {
    Lanes e, u, v;
} PlanePlace;

LANE_FN PlanePlace place_in_plane(const TileTerm *term, Lanes x, Lanes y)
{
    const float axis_x = term->k * term->axis[0], axis_y = term->k * term->axis[1];
    x += term->o[0];
    y += term->o[1];
    Lanes along = lanes_fma(x, lanes_set(axis_x), y * axis_y);
    return (PlanePlace){.e = lanes_fma(y, lanes_set(axis_x), x * -axis_y),
                        .u = along + term->u,
                        .v = term->v - along};
}

/* Sets of `touched`, one for each term, the bits of those packets on whose rays it may be above the
 * cut-off, and returns the bits of those that may hit something: some term must be at least its
 * part, 1 / n, of the level, so near enough; the 0.02 is for the margin. A packet's rays are all
 * within `half` of its middle; those of the first, which is nowhere cut off before another, are the
 * farthest apart. */
LANE_FN uint32_t find_touched(const FieldTile *tile, uint32_t *touched)
{
    const float half_x = 0.5f * (tile->x[LANES - 1] - tile->x[0]);
    const float half_y = 0.5f * (tile->y[LANES - 1] - tile->y[0]);
    const float half = 1.001f * sqrtf(half_x * half_x + half_y * half_y);
    uint32_t hopeful = 0;
    for (int part = 0; part < PLANE_PARTS; part++) {
        Lanes x = lanes_set(half_x), y = lanes_set(half_y);
        for (int lane = 0; lane < LANES && lane < PLANE_PACKETS; lane++) {
            x[lane] += tile->x[(part * LANES + lane) * LANES];
            y[lane] += tile->y[(part * LANES + lane) * LANES];
        }
        Lanes nearest2 = lanes_set(1e30f), count = lanes_set(0);
        for (size_t i = 0; i < tile->n_terms; i++) {
            const TileTerm *term = &tile->terms[i];
            PlanePlace at = place_in_plane(term, x, y);
            Lanes past = lanes_min(lanes_min(at.u, at.v), lanes_set(0));
            Lanes d = lanes_sqrt(lanes_fma(at.e, at.e, square(past))) - half * term->k;
            Lanes d2 = square(lanes_max(d, lanes_set(0)));
            LaneMask touches = d2 < term->reach2;
            nearest2 = lanes_min(nearest2, d2);
            count += lanes_select(touches, lanes_set(1), lanes_set(0));
            touched[i] = (part ? touched[i] : 0) | lanes_bits(touches) << part * LANES;
        }
        Lanes most2 = lanes_log(lanes_max(count, lanes_set(1))) + 2.02f;
        hopeful |= lanes_bits(nearest2 <= most2) << part * LANES;
    }
    return hopeful;
}

/* The part of the margin that `n` terms have without the rounding of places. */
LANE_FN float fixed_margin(size_t n)
{
    return MARGIN_DROPPED + MARGIN_TERM * (float)n;
}

/* Leaves rays that start beyond their hits at -height to double precision, too, and returns the
 * other hits. */
LANE_FN LaneMask hits_in_front(const FieldTile *tile, int first, LaneMask hit, LaneMask unsure,
                               Lanes height, TileHits *hits)
{
    LaneMask behind = hit & (-height <= (float)(tile->z_min - tile->terms[0].z_near));
    unsure |= behind;
    if (lanes_any(unsure))
        give_up(first, unsure, hits);
    return hit & ~behind;
}

/* Traces a packet that only one term touches: with k^2 q = ln(A / C) the gradient is, but for a
 * factor, that of A / A and sqrt q. False if it needs a wider margin than that allows. */
LANE_FN bool trace_lone(const FieldTile *tile, int first, const TileTerm *term, float extent,
                        TileHits *hits)
{
    const float *axis = term->axis;
    const float margin = (term->k * extent * MARGIN_PLACE + fixed_margin(1)) * (1 / LEVEL);
    if (margin > CLOSE_ENOUGH * (1 / LEVEL))
        return false;
    PlanePlace at = place_in_plane(term, lanes_load(&tile->x[first]), lanes_load(&tile->y[first]));
    Lanes above = 2.0f - square(at.e), slope = lanes_set(0), outward = lanes_set(-0.70710678f);
    if (lanes_any((above > 0.0f) & ((at.u < SATURATED) | (at.v < SATURATED)))) {
        Lanes ends, ends_slope;
        axial_factors(at.u, at.v, &ends, &ends_slope);
        ends = lanes_max(ends * 0.5f, lanes_set(1e-30f));
        above += lanes_log(ends);
        slope = ends_slope * 0.28209479f / ends;
        outward = -1.0f / lanes_sqrt(square(at.e) + square(slope) + lanes_max(above, lanes_set(0)));
    }
    /* ln(1 - margin) is above -1.002 margin. */
    LaneMask hit = above >= margin, unsure = ~hit & (above >= -1.002f * margin);
    if (!lanes_any(hit | unsure))
        return true;
    Lanes depth = lanes_sqrt(lanes_max(above, lanes_set(0)));
    Lanes height = depth * (1 / term->k);
    hit = hits_in_front(tile, first, hit, unsure, height, hits);
    const Lanes normal[3] = {outward * lanes_fma(at.e, lanes_set(axis[1]), slope * axis[0]),
                             outward * lanes_fma(slope, lanes_set(axis[1]), -at.e * axis[0]),
                             outward * depth};
    store_hits(tile, first, hit, tile->terms[0].z_near, -height, normal,
               (LaneMask){0} + (int32_t)term->segment, hits);
    return true;
}

LANE_FN void clear_sums(PlanePacket *packet)
{
    packet->sum = packet->sum_p = packet->sum_p2 = lanes_set(0);
}

LANE_FN void add_value(PlanePacket *packet, Lanes value, float p)
{
    packet->sum += value;
    packet->sum_p = lanes_fma(value, lanes_set(p), packet->sum_p);
    packet->sum_p2 = lanes_fma(value, lanes_set(p * p), packet->sum_p2);
}

LANE_FN float square_of(float a)
{
    return a * a;
}

/* Sets the terms of the packet and their sums in the plane, and returns the sum of k exp(-E^2). */
LANE_FN Lanes sum_up_plane(const FieldTile *tile, int first, PlanePacket *packet)
{
    Lanes x = lanes_load(&tile->x[first]), y = lanes_load(&tile->y[first]), places = lanes_set(0);
    float low = packet->terms[0].term->k, high = low;
    for (size_t i = 1; i < packet->n; i++) {
        const float k = packet->terms[i].term->k;
        low = k < low ? k : low;
        high = k > high ? k : high;
    }
    packet->per_k = 1 / high;
    float least = square_of(low * packet->per_k);
    packet->range = 1 - least;
    packet->middle = 0.5f * (1 + least);
    packet->q = lanes_set(0);
    clear_sums(packet);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        PlanePlace at = place_in_plane(term->term, x, y);
        Lanes gauss = lanes_exp_minus(square(at.e)), ends, ends_slope;
        axial_factors(at.u, at.v, &ends, &ends_slope);
        term->e = at.e;
        term->amplitude = 0.5f * gauss * ends;
        term->slope = 0.28209479f * gauss * ends_slope;
        term->fall = lanes_set(1);
        places = lanes_fma(gauss, lanes_set(term->term->k), places);
        add_value(packet, term->amplitude, square_of(term->term->k * packet->per_k));
    }
    return places;
}

LANE_FN void fall_to(PlanePacket *packet)
{
    clear_sums(packet);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        const float p = square_of(term->term->k * packet->per_k);
        term->fall = lanes_exp_minus(packet->q * p);
        add_value(packet, term->amplitude * term->fall, p);
    }
}

/* Halley's step of q, of at most twice Newton's: one so cut short is far from close. */
LANE_FN Lanes plane_step(const PlanePacket *packet)
{
    Lanes sum = packet->sum, above = lanes_log(lanes_max(sum * (1 / LEVEL), lanes_set(1e-30f)));
    Lanes mean2 = square(packet->sum_p);
    Lanes variance = lanes_fma(packet->sum_p2, sum, -mean2);
    Lanes divisor = lanes_fma(above * -0.5f, variance, mean2);
    return above * sum * packet->sum_p / lanes_max(divisor, 0.5f * mean2);
}

/* Finds q of the rays that hit, whose potential exceeds the level in the plane. Returns those for
 * which it has not succeeded. */
LANE_FN LaneMask solve_plane(PlanePacket *packet, LaneMask hit)
{
    const Lanes zero = lanes_set(0);
    for (int steps = 0;; steps++) {
        packet->step = lanes_select(hit, plane_step(packet), zero);
        packet->q = lanes_max(packet->q + packet->step, zero);
        LaneMask close = lanes_abs(packet->step) * packet->range <= PLANE_CLOSE;
        if (!lanes_any(~close) || steps == PLANE_STEPS)
            return hit & ~close;
        fall_to(packet);
    }
}

/* The gradient, 1 / (2 K) of it, at q; what the last step has changed in the terms' proportions is
 * taken as linear, which is right to 2e-4 of each. */
LANE_FN Gradient plane_gradient(const PlanePacket *packet)
{
    Gradient sum = {.largest = lanes_set(-1)};
    Lanes flat = lanes_set(0);
    for (size_t i = 0; i < packet->n; i++) {
        const PlaneTerm *term = &packet->terms[i];
        const float k = term->term->k * packet->per_k, *axis = term->term->axis;
        Lanes change = lanes_fma(packet->step, lanes_set(packet->middle - k * k), lanes_set(1));
        Lanes fall = term->fall * change, value = term->amplitude * fall;
        Lanes across = value * term->e * k, along = term->slope * fall * k;
        sum.x += lanes_fma(along, lanes_set(axis[0]), across * axis[1]);
        sum.y += lanes_fma(along, lanes_set(axis[1]), across * -axis[0]);
        flat = lanes_fma(value, lanes_set(k * k), flat);
        name_largest(term->term, value, &sum);
    }
    sum.z = lanes_sqrt(packet->q) * flat;
    return sum;
}

LANE_FN void trace_several(const FieldTile *tile, int first, PlanePacket *packet, float extent,
                           TileHits *hits)
{
    Lanes places = sum_up_plane(tile, first, packet);
    Lanes margin = places * (extent * MARGIN_PLACE) + fixed_margin(packet->n);
    LaneMask hit = (packet->sum >= LEVEL + margin) & (margin <= CLOSE_ENOUGH);
    LaneMask unsure = ~hit & (packet->sum >= LEVEL - margin);
    if (!lanes_any(hit | unsure))
        return;
    LaneMask unsolved = solve_plane(packet, hit);
    Lanes height = lanes_sqrt(packet->q) * packet->per_k, normal[3];
    hit = hits_in_front(tile, first, hit & ~unsolved, unsure | unsolved, height, hits);
    Gradient at = plane_gradient(packet);
    outward_normal(&at, normal);
    store_hits(tile, first, hit, tile->terms[0].z_near, -height, normal, at.segment, hits);
}

LANE_FN void trace_plane(const FieldTile *tile, int number, const uint32_t *touched, float extent,
                         PlaneTerm *memory, TileHits *hits)
{
    PlanePacket packet = {.terms = memory};
    for (size_t i = 0; i < tile->n_terms; i++) {
        memory[packet.n].term = &tile->terms[i];
        packet.n += touched[i] >> number & 1;
    }
    if (packet.n == 0 ||
        (packet.n == 1 && trace_lone(tile, number * LANES, memory[0].term, extent, hits)))
        return;
    trace_several(tile, number * LANES, &packet, extent, hits);
}

LANE_TARGET static __attribute__((noinline)) void PLANE_KERNEL(const FieldTile *tile, void *memory,
                                                               TileHits *hits)
{
    uint32_t *touched = (uint32_t *)((PlaneTerm *)memory + tile->n_terms);
    uint32_t hopeful = find_touched(tile, touched);
    float extent = 0;
    for (size_t i = 0; i < tile->n_terms; i++) {
        float reach = (float)(tile->terms[i].off - tile->terms[i].z_near);
        extent = reach > extent ? reach : extent;
    }
    extent += tile->half_size;
    for (int number = 0; number < PLANE_PACKETS; number++)
        if (hopeful >> number & 1)
            trace_plane(tile, number, touched, extent, memory, hits);
}
