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

_Static_assert(sizeof(PlaneTerm) <= TILE_WORK_BYTES, "TILE_WORK_BYTES");

/* A packet's rays, and sums of A exp(-k^2 q) times powers of k^2. */
typedef struct PlanePacket {
    PlaneTerm *terms;
    size_t n;
    float extent;   /* mm */
    Lanes nearest2; /* least squared distance of a segment, in its units */
    Lanes q, sum, sum_k2, sum_k4;
} PlanePacket;

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
    packet->nearest2 = lanes_min(packet->nearest2, d2);
    out->term = term;
    float reach = (float)(term->off - term->z_near);
    bool counts = lanes_any(d2 < term->reach2);
    packet->extent = counts && reach > packet->extent ? reach : packet->extent;
    packet->n += counts;
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

LANE_FN void trace_plane(const FieldTile *tile, int first, PlaneTerm *memory, TileHits *hits)
{
    Lanes x = lanes_load(&tile->x[first]), y = lanes_load(&tile->y[first]);
    PlanePacket packet = {.terms = memory, .nearest2 = lanes_set(1e30f)};
    for (size_t i = 0; i < tile->n_terms; i++)
        place_in_plane(&packet, &tile->terms[i], x, y);
    /* Some term must be at least the n-th part of the level; the rest is for the margin. */
    float most2 = packet.n > 1 ? 2.02f + logf((float)packet.n) : 2.02f;
    if (!packet.n || !lanes_any(packet.nearest2 <= most2))
        return;
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
    for (int first = 0; first < TILE_SAMPLES; first += LANES)
        trace_plane(tile, first, memory, hits);
}
