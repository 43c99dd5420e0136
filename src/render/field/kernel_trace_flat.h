/* Finds the first hits of a tile whose vessels are all in one plane perpendicular to the rays, as
 * in a planar tree that is viewed from above. trace_plane is called by kernel_trace.h. The source
 * that compiles the kernels of the potential includes this file once, before kernel_trace.h.
 *
 * Let q be the square of the distance from the plane. A term is A exp(-k^2 q) with A = exp(-E^2)
 * (erf u + erf v) / 2; E, u and v do not depend on q. kernel_packet.h defines these letters: E is
 * the distance in the plane between ray and axis line, u and v are the distances along the axis
 * from the two ends; all are in units of 1 / k. So the potential Phi, the sum of the terms,
 * decreases strictly as q grows. A ray hits if and only if the sum of the A exceeds the level C =
 * exp(-2), and then it hits once before the plane. No search is needed.
 *
 * For a single term, ln Phi = ln A - k^2 q gives q directly. For several terms, Halley's method
 * finds q in units of 1 / K^2, where K is the largest k of the tile. ln Phi is a convex function of
 * q. Let p = (k / K)^2 of a term, and let m and v be the mean and the variance of p, weighted by
 * the terms. Then the first derivative of ln Phi is -m and the second derivative is v.
 *
 * Error of a step d of q. Halley's step solves the second-order Taylor polynomial of ln Phi with an
 * error of v^2 |d|^3 / (4 m (1 + v d / (2 m))). The polynomial leaves out |d|^3 / 6 times the third
 * central moment of p at a point of the step. Let R be the range of p. The third central moment is
 * at most R v. It is also minus the derivative of v, so v changes along the step by at most the
 * factor exp(R |d|). Further, v <= m R [Bhatia & Davis 2000]. If R |d| <= 1, the error of ln Phi
 * after the step is therefore less than R v |d|^3.
 *
 * Rays that start between surface and plane, and rays whose sum is within the margin of the level,
 * are TILE_UNSURE. */
#include "render/field/kernel_potential.h"

/* Lets kernel_trace.h call trace_plane. */
#define TRACES_PLANES

/* Maximum error of ln Phi after the last step. Rounding adds 1e-6, so that a much smaller value
 * would cost steps and gain no digits. */
#define PLANE_CLOSE 3e-6f
/* Maximum number of steps; rays that need more are TILE_UNSURE. Halley's method triples the number
 * of digits per step, so that rays need a few; this only bounds the time of a ray that fails. */
#define PLANE_STEPS 32

/* A tile whose vessels are in one plane. */
typedef struct PlaneTile {
    const FieldTile *tile;
    TileHits *hits;
    double base;  /* z of the plane */
    float extent; /* upper bound of a coordinate, mm; rounding errors of positions are proportional
                   * to it */
    float k;      /* K: the largest k of the tile, 1 / mm */
} PlaneTile;

/* A term along the rays of a packet. */
typedef struct PlaneTerm {
    Lanes e;         /* E */
    Lanes amplitude; /* A */
    Lanes slope;     /* derivative of A along the axis, divided by 2 k */
    Lanes fall;      /* exp(-k^2 q) */
    const TileTerm *term;
    float p; /* (k / K)^2 */
} PlaneTerm;

/* A packet: LANES rays, and the terms that exceed the cut-off on one of them. */
typedef struct PlanePacket {
    const PlaneTile *plane;
    PlaneTerm *terms;
    size_t n;
    int first;                /* index of the first sample */
    LaneMask hit;             /* lanes whose potential in the plane exceeds the level */
    LaneMask unsure;          /* lanes where this is not certain */
    LaneMask solved;          /* lanes whose q is found */
    float low, range;         /* smallest p, and R: range of p */
    Lanes q;                  /* in units of 1 / K^2 */
    Lanes step;               /* last step of q; the sums and PlaneTerm.fall belong to q before
                               * this step */
    Lanes sum, sum_p, sum_p2; /* sums of A exp(-k^2 q) times 1, p and p^2 */
} PlanePacket;

enum {
    PLANE_PACKETS = TILE_SAMPLES / LANES,
    PLANE_PARTS = (PLANE_PACKETS + LANES - 1) / LANES /* vectors with a lane for each packet */
};

_Static_assert(PLANE_PACKETS * sizeof(PlaneTerm) + sizeof(uint32_t) <= TILE_WORK_BYTES,
               "TILE_WORK_BYTES");

/* The position of the rays of a packet relative to a term, in units of 1 / k: E with a sign, and
 * the distances from the two ends along the axis. */
typedef struct PlanePosition {
    Lanes e, u, v;
} PlanePosition;

/* Returns the position of the rays at (x, y) relative to a term. */
LANE_FN PlanePosition position_in_plane(const TileTerm *term, Lanes x, Lanes y)
{
    const float *cross = term->cross;
    x += term->o[0];
    y += term->o[1];
    Lanes along = lanes_fma(x, lanes_set(cross[1]), -(y * cross[0]));
    return (PlanePosition){.e = lanes_fma(y, lanes_set(cross[1]), x * cross[0]),
                           .u = along + term->u,
                           .v = term->v - along};
}

/* Finds which packets may hit something, and which terms may exceed the cut-off on their rays.
 *
 * touched   receives, per term, a bit mask of the packets on whose rays the term may exceed the
 *           cut-off.
 * Returns   a bit mask of the packets that may hit something. For a hit with n terms, at least one
 *           term must be 1 / n of the level exp(-2) or more. It is at most exp(-d^2), so its
 *           distance d must satisfy d^2 <= 2 + ln n; 2.02 leaves 0.02 for the margin.
 *
 * All rays of a packet are within `half` of the packet's middle; 1.001 covers rounding. `half` is
 * taken from the first packet, the largest: packets at the edge of the image are smaller. A single
 * term is not tested, because trace_lone() is as fast; all bits are then set. */
LANE_FN uint32_t find_touched(const FieldTile *tile, uint32_t *touched)
{
    if (tile->n_terms == 1)
        return touched[0] = UINT32_MAX;
    const float half_x = 0.5f * (tile->x[LANES - 1] - tile->x[0]);
    const float half_y = 0.5f * (tile->y[LANES - 1] - tile->y[0]);
    const float half = 1.001f * sqrtf(half_x * half_x + half_y * half_y);
    uint32_t may_hit = 0;
    for (int part = 0; part < PLANE_PARTS; part++) {
        Lanes x = lanes_set(half_x), y = lanes_set(half_y);
        for (int lane = 0; lane < LANES && lane < PLANE_PACKETS; lane++) {
            x[lane] += tile->x[(part * LANES + lane) * LANES];
            y[lane] += tile->y[(part * LANES + lane) * LANES];
        }
        Lanes nearest2 = lanes_set(1e30f), count = lanes_set(0);
        for (size_t i = 0; i < tile->n_terms; i++) {
            const TileTerm *term = &tile->terms[i];
            PlanePosition at = position_in_plane(term, x, y);
            Lanes past = lanes_min(lanes_min(at.u, at.v), lanes_set(0));
            Lanes d = lanes_sqrt(lanes_fma(at.e, at.e, square(past))) - half * term->k;
            Lanes d2 = square(lanes_max(d, lanes_set(0)));
            LaneMask touches = d2 < term->reach2;
            nearest2 = lanes_min(nearest2, d2);
            count += lanes_select(touches, lanes_set(1), lanes_set(0));
            touched[i] = (part ? touched[i] : 0) | lanes_bits(touches) << part * LANES;
        }
        Lanes most2 = lanes_log(lanes_max(count, lanes_set(1))) + 2.02f;
        may_hit |= lanes_bits(nearest2 <= most2) << part * LANES;
    }
    return may_hit;
}

/* Marks the `unsure` rays, and the rays that start between their hit and the plane, as TILE_UNSURE.
 * `height` is the distance of the hit from the plane. Returns the other hits. */
LANE_FN LaneMask hits_in_front(const PlaneTile *plane, int first, LaneMask hit, LaneMask unsure,
                               Lanes height)
{
    LaneMask behind = hit & (-height <= (float)(plane->tile->z_min - plane->base));
    unsure |= behind;
    if (lanes_any(unsure))
        mark_unsure(first, unsure, plane->hits);
    return hit & ~behind;
}

/* Traces a packet on which only one term exceeds the cut-off. With f = (erf u + erf v) / 2, `above`
 * is k^2 q = ln(A / C) = 2 - E^2 + ln f. The gradient of ln Phi is 2 k times the vector (-E, slope,
 * -sqrt(above)), across the axis, along it and out of the plane. `slope` is (exp(-u^2) - exp(-v^2))
 * / (2 sqrt(pi) f); 0.282 is 1 / (2 sqrt(pi)). Far from both ends f = 1, slope = 0 and the vector
 * has the length sqrt 2. 1e-30 keeps the logarithm finite. Returns false, without a result, if the
 * margin is above MAX_MARGIN. */
LANE_FN bool trace_lone(const PlaneTile *plane, int first, const TileTerm *term)
{
    const FieldTile *tile = plane->tile;
    const float *axis = term->axis;
    const float margin =
        (term->k * plane->extent * MARGIN_POSITION + fixed_margin(1)) * (1 / LEVEL);
    if (margin > MAX_MARGIN * (1 / LEVEL))
        return false;
    PlanePosition at =
        position_in_plane(term, lanes_load(&tile->x[first]), lanes_load(&tile->y[first]));
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
    hit = hits_in_front(plane, first, hit, unsure, height);
    const Lanes normal[3] = {outward * lanes_fma(at.e, lanes_set(axis[1]), slope * axis[0]),
                             outward * lanes_fma(slope, lanes_set(axis[1]), -at.e * axis[0]),
                             outward * depth};
    store_hits(tile, first, hit, plane->base, -height, normal,
               (LaneMask){0} + (int32_t)term->segment, plane->hits);
    return true;
}

/* Sets the sums to 0. */
LANE_FN void clear_sums(PlanePacket *packet)
{
    packet->sum = packet->sum_p = packet->sum_p2 = lanes_set(0);
}

/* Adds the value of a term to the sums. */
LANE_FN void add_value(PlanePacket *packet, Lanes value, float p)
{
    packet->sum += value;
    packet->sum_p = lanes_fma(value, lanes_set(p), packet->sum_p);
    packet->sum_p2 = lanes_fma(value * p, lanes_set(p), packet->sum_p2);
}

/* Computes the terms of the packet at q = 0, their sums, and which rays hit. 0.564 is 1 / sqrt(pi),
 * half the derivative of erf at 0. */
LANE_FN void sum_up_plane(PlanePacket *packet)
{
    const PlaneTile *plane = packet->plane;
    Lanes x = lanes_load(&plane->tile->x[packet->first]);
    Lanes y = lanes_load(&plane->tile->y[packet->first]), steep = lanes_set(0);
    const float per_k = 1 / plane->k;
    float low = 1, high = 0;
    packet->q = lanes_set(0);
    clear_sums(packet);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        const float k = term->term->k, ratio = k * per_k;
        term->p = ratio * ratio;
        low = term->p < low ? term->p : low;
        high = term->p > high ? term->p : high;
        PlanePosition at = position_in_plane(term->term, x, y);
        Lanes gauss = lanes_exp_minus(square(at.e)), ends, ends_slope;
        axial_factors(at.u, at.v, &ends, &ends_slope);
        Lanes half = 0.5f * gauss;
        term->e = at.e;
        term->amplitude = half * ends;
        term->slope = half * ends_slope * 0.56418958f;
        term->fall = lanes_set(1);
        steep = lanes_fma(gauss, lanes_set(k), steep);
        add_value(packet, term->amplitude, term->p);
    }
    packet->low = low;
    packet->range = high - low;
    Lanes margin = steep * (plane->extent * MARGIN_POSITION) + fixed_margin(packet->n);
    packet->hit = (packet->sum >= LEVEL + margin) & (margin <= MAX_MARGIN);
    packet->unsure = ~packet->hit & (packet->sum >= LEVEL - margin);
}

/* Computes `fall` of the terms, and the sums, at the current q. */
LANE_FN void fall_to(PlanePacket *packet)
{
    clear_sums(packet);
    for (size_t i = 0; i < packet->n; i++) {
        PlaneTerm *term = &packet->terms[i];
        term->fall = lanes_exp_minus(packet->q * term->p);
        add_value(packet, term->amplitude * term->fall, term->p);
    }
}

/* Takes one step of Halley's method, limited to twice the step of Newton's method. Sets `solved` in
 * the lanes in which the error bound after the step is at most PLANE_CLOSE. A limited step is never
 * the last: it has v d > 2 m, hence R d > 2, and the last step needs R |d| <= 1. */
LANE_FN void plane_step(PlanePacket *packet)
{
    Lanes sum = packet->sum, above = lanes_log(lanes_max(sum * (1 / LEVEL), lanes_set(1e-30f)));
    Lanes mean2 = square(packet->sum_p);
    Lanes variance = lanes_fma(packet->sum_p2, sum, -mean2);
    Lanes divisor = lanes_max(lanes_fma(above * -0.5f, variance, mean2), 0.5f * mean2);
    Lanes step = lanes_select(packet->hit, above * sum * packet->sum_p / divisor, lanes_set(0));
    Lanes change = lanes_abs(step) * packet->range;
    packet->step = step;
    packet->q = lanes_max(packet->q + step, lanes_set(0));
    packet->solved =
        (change <= 1.0f) & (change * square(step) * variance <= PLANE_CLOSE * square(sum));
}

/* Takes the remaining steps after the first. */
LANE_FN void solve_plane(PlanePacket *packet)
{
    for (int steps = 0; lanes_any(~packet->solved) && steps < PLANE_STEPS; steps++) {
        fall_to(packet);
        plane_step(packet);
    }
    packet->unsure |= packet->hit & ~packet->solved;
    packet->hit &= packet->solved;
}

/* Returns half the gradient at a height before the plane. The last step changes the proportions of
 * the terms by factors exp(y) with |y| <= R |d| / 2; these are computed to second order. */
LANE_FN Gradient plane_gradient(const PlanePacket *packet, Lanes height)
{
    Gradient sum = {.largest = lanes_set(-1)};
    const float middle = packet->low + 0.5f * packet->range, k = packet->plane->k;
    Lanes flat = lanes_set(0);
    for (size_t i = 0; i < packet->n; i++) {
        const PlaneTerm *term = &packet->terms[i];
        const float *cross = term->term->cross;
        Lanes y = packet->step * (middle - term->p), one = lanes_set(1);
        Lanes fall = term->fall * lanes_fma(y, lanes_fma(y, lanes_set(0.5f), one), one);
        Lanes value = term->amplitude * fall;
        Lanes across = value * term->e, along = term->slope * fall;
        sum.x += lanes_fma(along, lanes_set(cross[1]), -(across * cross[0]));
        sum.y -= lanes_fma(along, lanes_set(cross[0]), across * cross[1]);
        flat = lanes_fma(value, lanes_set(term->p), flat);
        keep_largest(term->term, value, &sum);
    }
    sum.z = height * flat * (k * k);
    return sum;
}

/* Stores the hits of a packet. */
LANE_FN void describe_plane_hits(const PlanePacket *packet)
{
    const PlaneTile *plane = packet->plane;
    Lanes height = lanes_sqrt(packet->q) * (1 / plane->k), normal[3];
    LaneMask hit = hits_in_front(plane, packet->first, packet->hit, packet->unsure, height);
    Gradient at = plane_gradient(packet, height);
    outward_normal(&at, normal);
    store_hits(plane->tile, packet->first, hit, plane->base, -height, normal, at.segment,
               plane->hits);
}

/* Collects the terms of packet `number`, and their sums. Returns false if the packet is finished:
 * no term touches it, a single term does and trace_lone has traced it, or no ray can hit. */
LANE_FN bool begin_packet(const PlaneTile *plane, int number, const uint32_t *touched,
                          PlaneTerm *terms, PlanePacket *packet)
{
    const FieldTile *tile = plane->tile;
    size_t n = 0;
    for (size_t i = 0; i < tile->n_terms; i++) {
        terms[n].term = &tile->terms[i];
        n += touched[i] >> number & 1;
    }
    if (n == 0 || (n == 1 && trace_lone(plane, number * LANES, terms[0].term)))
        return false;
    packet->plane = plane;
    packet->terms = terms;
    packet->n = n;
    packet->first = number * LANES;
    sum_up_plane(packet);
    return lanes_any(packet->hit | packet->unsure);
}

/* Traces a tile in one plane. `memory` is the workspace of the kernel, TILE_WORK_BYTES per term.
 * The work for one packet is a long chain of dependent operations; each stage is therefore done for
 * all packets before the next stage begins, so that the processor can overlap them. */
LANE_TARGET static __attribute__((noinline)) void trace_plane(const FieldTile *tile, void *memory,
                                                              TileHits *hits)
{
    PlaneTerm *terms = memory;
    uint32_t *touched = (uint32_t *)(terms + PLANE_PACKETS * tile->n_terms);
    uint32_t may_hit = find_touched(tile, touched);
    PlaneTile plane = {.tile = tile, .hits = hits, .base = tile->terms[0].z_near};
    for (size_t i = 0; i < tile->n_terms; i++) {
        const TileTerm *term = &tile->terms[i];
        float reach = (float)(term->z_end - term->z_near);
        plane.extent = reach > plane.extent ? reach : plane.extent;
        plane.k = term->k > plane.k ? term->k : plane.k;
    }
    plane.extent += tile->half_size;
    PlanePacket packets[PLANE_PACKETS];
    int n = 0;
    for (int number = 0; number < PLANE_PACKETS; number++)
        if (may_hit >> number & 1 && begin_packet(&plane, number, touched, terms, &packets[n]))
            terms += packets[n++].n;
    for (int i = 0; i < n; i++)
        plane_step(&packets[i]);
    for (int i = 0; i < n; i++)
        solve_plane(&packets[i]);
    for (int i = 0; i < n; i++)
        describe_plane_hits(&packets[i]);
}
