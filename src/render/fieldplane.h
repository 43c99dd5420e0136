/* The first hits of a tile whose vessels all lie in one plane, square to the rays: trees in a disc,
 * seen face-on.
 *
 * With q the square of the distance from the plane, a term is A exp(-k^2 q), A = exp(-E^2) (erf u +
 * erf v) / 2. So the potential falls strictly with q: a ray hits if the sum of A exceeds the level,
 * once on its way to the plane, and needs no search. ln Phi is convex in q, and linear for a lone
 * vessel; Newton's method with the second derivative, the variance of k^2 among the terms, finds q
 * in few steps. Rays that start between surface and plane, and those within the margin of the
 * level, are handed back. */
#include "render/fieldlanes.h"

/* Part of the level by which the potential may differ from it when the last step is taken. */
#define PLANE_CLOSE 4e-6f
#define PLANE_STEPS 32

typedef struct PlaneTerm {
    Lanes e, u, v;
    Lanes gauss, ends_slope; /* exp(-E^2), exp(-u^2) - exp(-v^2) */
    Lanes amplitude;         /* A */
    Lanes fall;              /* exp(-k^2 q) */
    const TileTerm *term;
} PlaneTerm;

_Static_assert(sizeof(PlaneTerm) + sizeof(uint32_t) <= TILE_WORK_BYTES, "TILE_WORK_BYTES");

/* Sums of A exp(-k^2 q) times powers of k^2 on the rays of a packet. */
typedef struct PlanePacket {
    PlaneTerm *terms;
    size_t n;
    float extent; /* mm */
    Lanes q, sum, sum_k2, sum_k4;
} PlanePacket;

enum { PLANE_PACKETS = TILE_SAMPLES / LANES, PLANE_PARTS = (PLANE_PACKETS + LANES - 1) / LANES };

/* What a tile's packets are, several at once: a place in the middle of each, and how far its rays
 * are from there at most. */
typedef struct PlaneMiddles {
    Lanes x[PLANE_PARTS], y[PLANE_PARTS], half[PLANE_PARTS];
} PlaneMiddles;

LANE_FN PlaneMiddles plane_middles(const FieldTile *tile)
{
    float x[PLANE_PARTS * LANES] = {0}, y[PLANE_PARTS * LANES] = {0},
                          half[PLANE_PARTS * LANES] = {0};
    for (int i = 0; i < PLANE_PACKETS; i++) {
        int first = i * LANES, last = first + LANES - 1; /* opposite corners */
        x[i] = 0.5f * (tile->x[first] + tile->x[last]);
        y[i] = 0.5f * (tile->y[first] + tile->y[last]);
        float dx = tile->x[last] - tile->x[first], dy = tile->y[last] - tile->y[first];
        half[i] = 0.2501f * (dx * dx + dy * dy);
    }
    PlaneMiddles middles;
    __builtin_memcpy(middles.x, x, sizeof x);
    __builtin_memcpy(middles.y, y, sizeof y);
    __builtin_memcpy(middles.half, half, sizeof half);
    for (int part = 0; part < PLANE_PARTS; part++)
        middles.half[part] = lanes_sqrt(middles.half[part]);
    return middles;
}

/* Sets of `touched`, one for each term, the bits of those packets on whose rays it may be above the
 * cut-off, and returns the bits of those that may hit something: some term must be at least its
 * part, 1 / n, of the level, so near enough; the 0.02 is for the margin. */
LANE_FN uint32_t find_touched(const FieldTile *tile, uint32_t *touched)
{
    const PlaneMiddles middles = plane_middles(tile);
    uint32_t hopeful = 0;
    for (int part = 0; part < PLANE_PARTS; part++) {
        Lanes nearest2 = lanes_set(1e30f), count = lanes_set(0);
        for (size_t i = 0; i < tile->n_terms; i++) {
            const TileTerm *term = &tile->terms[i];
            const float k = term->k, *axis = term->axis;
            Lanes x = middles.x[part] + term->o[0], y = middles.y[part] + term->o[1];
            Lanes e = lanes_fma(y, lanes_set(axis[0]), -(x * axis[1])) * k;
            Lanes along = lanes_fma(x, lanes_set(axis[0]), y * axis[1]) * k;
            Lanes past = lanes_min(lanes_min(along + term->u, term->v - along), lanes_set(0));
            Lanes d = lanes_sqrt(lanes_fma(e, e, square(past))) - middles.half[part] * k;
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

/* Appends the term unless it is below the cut-off on every ray. */
LANE_FN void place_in_plane(PlanePacket *packet, const TileTerm *term, Lanes x, Lanes y)
{
    PlaneTerm *out = &packet->terms[packet->n];
    const float k = term->k, *axis = term->axis;
    x += term->o[0];
    y += term->o[1];
    out->e = lanes_fma(y, lanes_set(axis[0]), -(x * axis[1])) * k;
    Lanes along = lanes_fma(x, lanes_set(axis[0]), y * axis[1]) * k;
    out->u = along + term->u;
    out->v = term->v - along;
    Lanes past = lanes_min(lanes_min(out->u, out->v), lanes_set(0));
    Lanes d2 = lanes_fma(out->e, out->e, square(past));
    out->term = term;
    float reach = (float)(term->off - term->z_near);
    packet->extent = reach > packet->extent ? reach : packet->extent;
    packet->n += lanes_any(d2 < term->reach2);
}

/* The amplitudes and their sums, and the margin of the potential's arithmetic. */
LANE_FN Lanes sum_up_plane(PlanePacket *packet, float half_size)
{
    Lanes places = lanes_set(0);
    packet->sum = packet->sum_k2 = packet->sum_k4 = lanes_set(0);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        const float k = term->term->k, k2 = k * k;
        Lanes ends;
        axial_factors(term->u, term->v, &ends, &term->ends_slope);
        term->gauss = lanes_exp_minus(square(term->e));
        term->amplitude = 0.5f * term->gauss * ends;
        places = lanes_fma(term->gauss, lanes_set(k), places);
        packet->sum += term->amplitude;
        packet->sum_k2 = lanes_fma(term->amplitude, lanes_set(k2), packet->sum_k2);
        packet->sum_k4 = lanes_fma(term->amplitude, lanes_set(k2 * k2), packet->sum_k4);
    }
    return places * ((packet->extent + half_size) * MARGIN_PLACE) +
           (MARGIN_DROPPED + MARGIN_TERM * (float)packet->n);
}

LANE_FN void fall_to(PlanePacket *packet)
{
    packet->sum = packet->sum_k2 = packet->sum_k4 = lanes_set(0);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        const float k = term->term->k, k2 = k * k;
        term->fall = lanes_exp_minus(packet->q * k2);
        Lanes value = term->amplitude * term->fall;
        packet->sum += value;
        packet->sum_k2 = lanes_fma(value, lanes_set(k2), packet->sum_k2);
        packet->sum_k4 = lanes_fma(value, lanes_set(k2 * k2), packet->sum_k4);
    }
}

/* One step of q: `above` is ln(Phi / C), about. */
LANE_FN Lanes plane_step(const PlanePacket *packet, Lanes above)
{
    Lanes per_sum = 1.0f / packet->sum, mean = packet->sum_k2 * per_sum, mean2 = square(mean);
    Lanes variance = lanes_fma(packet->sum_k4, per_sum, -mean2);
    Lanes left = lanes_max(mean2 - 2.0f * variance * above, 0.25f * mean2);
    return 2.0f * above / (mean + lanes_sqrt(left));
}

/* Finds q of the live rays, whose potential exceeds the level in the plane. Returns those for which
 * it has not succeeded. */
LANE_FN LaneMask solve_plane(PlanePacket *packet, LaneMask live)
{
    const Lanes zero = lanes_set(0);
    Lanes above = lanes_log(lanes_max(packet->sum * (1 / LEVEL), lanes_set(1)));
    packet->q = lanes_select(live, plane_step(packet, above), zero);
    for (int steps = 0; steps < PLANE_STEPS; steps++) {
        fall_to(packet);
        Lanes part = packet->sum * (1 / LEVEL), part2 = square(part);
        above = 3.0f * (part2 - 1.0f) / (part2 + 4.0f * part + 1.0f);
        Lanes q = lanes_max(packet->q + plane_step(packet, above), zero);
        packet->q = lanes_select(live, q, packet->q);
        live &= ~(lanes_abs(above) <= PLANE_CLOSE);
        if (!lanes_any(live))
            break;
    }
    return live;
}

LANE_FN Gradient plane_gradient(const PlanePacket *packet, Lanes height)
{
    Gradient sum = {.largest = lanes_set(-1)};
    for (size_t i = 0; i < packet->n; i++) {
        const PlaneTerm *term = &packet->terms[i];
        const float k = term->term->k, *axis = term->term->axis;
        Lanes value = term->amplitude * term->fall;
        Lanes across = value * term->e * (-2.0f * k);
        Lanes along = term->fall * term->gauss * term->ends_slope * (0.56418958f * k);
        sum.x += lanes_fma(along, lanes_set(axis[0]), across * -axis[1]);
        sum.y += lanes_fma(along, lanes_set(axis[1]), across * axis[0]);
        name_largest(term->term, value, &sum);
    }
    sum.z = 2.0f * height * packet->sum_k2;
    return sum;
}

LANE_FN void trace_plane(const FieldTile *tile, int number, const uint32_t *touched,
                         PlaneTerm *memory, TileHits *hits)
{
    const int first = number * LANES;
    Lanes x = lanes_load(&tile->x[first]), y = lanes_load(&tile->y[first]);
    PlanePacket packet = {.terms = memory};
    for (size_t i = 0; i < tile->n_terms; i++)
        if (touched[i] >> number & 1)
            place_in_plane(&packet, &tile->terms[i], x, y);
    Lanes margin = sum_up_plane(&packet, tile->half_size);
    LaneMask hit = (packet.sum >= LEVEL + margin) & (margin <= CLOSE_ENOUGH);
    LaneMask unsure = ~hit & (packet.sum >= LEVEL - margin);
    double base = tile->terms[0].z_near;
    if (lanes_any(hit)) {
        unsure |= solve_plane(&packet, hit);
        Lanes height = lanes_sqrt(packet.q);
        unsure |= hit & (-height <= (float)(tile->z_min - base));
        hit &= ~unsure;
        Gradient at = plane_gradient(&packet, height);
        store_hits(tile, first, hit, base, -height, &at, hits);
    }
    if (lanes_any(unsure))
        give_up(first, unsure, hits);
}

LANE_TARGET static __attribute__((noinline)) void PLANE_KERNEL(const FieldTile *tile, void *memory,
                                                               TileHits *hits)
{
    uint32_t *touched = (uint32_t *)((PlaneTerm *)memory + tile->n_terms);
    uint32_t hopeful = find_touched(tile, touched);
    for (int number = 0; number < PLANE_PACKETS; number++)
        if (hopeful >> number & 1)
            trace_plane(tile, number, touched, memory, hits);
}
