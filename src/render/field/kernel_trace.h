/* The first hits of a tile, several rays at once: included by each source that compiles it for its
 * lanes, and told by FIELD_KERNEL how to call it.
 *
 * What fieldcast.c proves for one ray in double precision is proven here in single, for a packet of
 * neighbouring rays; lanes whose proof would need more than that are handed back as TILE_UNSURE.
 * In units of 1 / k and with E the distance of ray and axis line, a term on a ray is
 * exp(-E^2 - w^2) (erf u + erf v) / 2, where w, u and v are affine in z. Its segment lies in the
 * plane (w, u) at w = 0, 0 <= u <= u + v, and the ray is a straight line there. With d the distance
 * of ray and segment, s and a sine and cosine of the ray to the axis, and h = 1/2 when that line
 * passes the segment's axis beyond an end, else 1:
 *
 * - Peak. The term is the integral of exp(-|x - y|^2) / sqrt(pi) over the points y of the segment,
 *   and on the ray |x - y|^2 = rho^2 + q^2, where rho >= d is the distance of y from the ray:
 *   Phi_i <= B = exp(-d^2) min(1, h / s).
 * - Curvature. (exp(-q^2))'' is at most 4 exp(-3/2), and its positive part and its negative part
 *   integrate to 2 sqrt(2 / e) each: Phi_i'' <= M = k^2 exp(-d^2) min(4 exp(-3/2) h / s, 2 sqrt(2 /
 *   e) / sqrt(pi) / a). Since (exp(-q^2))'' >= -2, also Phi_i'' >= -M exp(3/2) / 2.
 * - Windows. Phi >= T needs a term of at least its share T B / S, S the sum of all B of the group.
 *   Where that can be is a stretch of the ray within a distance of the segment, found from
 *   exp(-E^2 - w^2) beside it and exp(-E^2 - w^2 - x^2) / 2 at x beyond an end. The march goes from
 *   the first of them to the last. For a lone straight vessel the first begins at its surface.
 * - Steps and acceptance as in fieldcast.c, with a margin about T for what single precision, erf
 * and the terms left out amount to: nothing is stepped over that could reach T - margin, and a hit
 * is one that rises through T + margin. */
#ifndef FIELD_KERNEL
#error "define FIELD_KERNEL, the name of the function"
#endif

#include "render/field/kernel_trace_flat.h"
#include <assert.h>

/* Lack of potential at which a hit that is very certain is closed by Newton's method. */
#define NEAR_ENOUGH (2e-2f * LEVEL)
#define MOST_STEPS 128

/* A term on the rays of a packet, in powers of dz = z - z of the term. The last four Lanes are set
 * once it is known that the packet may hit something. */
typedef struct PacketTerm {
    Lanes w0, w1, u0, u1, v0; /* w = w0 + w1 dz, u = u0 + u1 dz, v = v0 - u1 dz */
    Lanes peak;               /* B */
    Lanes gauss;              /* exp(-d^2) */
    Lanes e2, end_y2[2];      /* E^2, and the squared distances of ray and ends, less E^2 */
    Lanes past;               /* d^2 - E^2 */
    Lanes share, cosine;      /* h / s, and a */
    Lanes inverse_speed2;     /* 1 / (w1^2 + u1^2) */
    Lanes half_gauss;         /* exp(-E^2) / 2 */
    Lanes curvature, spare;   /* M, and -ln B - E^2 */
    Lanes end_z[2];           /* dz nearest to the ends */
    const TileTerm *term;
    float z;       /* of the term, relative to the group's */
    float on, off; /* likewise, between which it may exceed the cut-off */
    bool flat;     /* u and v are the same all along, and their factor is in half_gauss */
} PacketTerm;

_Static_assert(sizeof(PacketTerm) + sizeof(PacketTerm *) + sizeof(uint32_t) <= TILE_WORK_BYTES,
               "TILE_WORK_BYTES");

typedef struct Packet {
    const FieldTile *tile;
    Lanes x, y;         /* of the samples */
    PacketTerm *terms;  /* those of the tile's that matter, in their order */
    PacketTerm **sum;   /* those of them that are added up */
    uint32_t *segments; /* of the terms, where groups are looked for */
    size_t n, n_sum;
} Packet;

/* 1 / a, finite for a near 0. */
LANE_FN Lanes inverse(Lanes a)
{
    return 1.0f / lanes_select(lanes_abs(a) > 1e-20f, a, lanes_set(1e-20f));
}

/* The stretch of dz within sqrt(beside2) of the axis beside the segment or sqrt(beyond2) of an end,
 * both less E^2. Empty (low > high) when there is none. */
LANE_FN void term_stretch(const PacketTerm *term, Lanes beside2, Lanes beyond2, Lanes *low,
                          Lanes *high)
{
    const Lanes none = lanes_set(1e30f);
    Lanes width = lanes_sqrt(lanes_max(beside2, lanes_set(0)));
    Lanes per_w = inverse(term->w1), per_u = inverse(term->u1);
    Lanes first = -term->u0 * per_u, last = term->v0 * per_u;
    Lanes from = lanes_max((-width - term->w0) * per_w, lanes_min(first, last));
    Lanes to = lanes_min((width - term->w0) * per_w, lanes_max(first, last));
    LaneMask seen = (beside2 >= 0.0f) & (from <= to);
    *low = lanes_select(seen, from, none);
    *high = lanes_select(seen, to, -none);
    for (int end = 0; end < 2; end++) {
        Lanes chord2 = (beyond2 - term->end_y2[end]) * term->inverse_speed2;
        seen = chord2 >= 0.0f;
        if (!lanes_any(seen))
            continue;
        Lanes half = lanes_sqrt(lanes_max(chord2, lanes_set(0)));
        *low = lanes_min(*low, lanes_select(seen, term->end_z[end] - half, none));
        *high = lanes_max(*high, lanes_select(seen, term->end_z[end] + half, -none));
    }
}

/* Place and direction, at dz = 0, of the rays as the term sees them. */
typedef struct TermRays {
    Lanes o[3], d[3];
} TermRays;

LANE_FN TermRays rays_of(const Packet *packet, const TileTerm *term)
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

/* The linear part of an orthographic packet's term, 1 / s and a; false, some of it not set, when
 * all rays pass the axis beyond reach. */
LANE_FN bool place_parallel(const Packet *packet, const TileTerm *term, PacketTerm *out)
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
    out->share = lanes_set(term->per_sine);
    out->cosine = lanes_set(fabsf(a));
    out->inverse_speed2 = lanes_set(term->per_k2);
    return true;
}

LANE_FN Lanes dot(const Lanes a[3], const float b[3])
{
    return lanes_fma(a[0], lanes_set(b[0]), lanes_fma(a[1], lanes_set(b[1]), a[2] * b[2]));
}

/* Likewise in perspective, where they are not. The directions' common part of cross products comes
 * from the tile, in double, so that rays nearly along the axis lose nothing. */
LANE_FN void place_bundle(const Packet *packet, const TileTerm *term, PacketTerm *out)
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
    out->share = per_cross * length;
    out->cosine = lanes_abs(speed) / length;
    out->inverse_speed2 = 1.0f / (length2 * (k * k));
}

/* Appends the term unless it is below the cut-off on every ray. */
LANE_FN void add_to_packet(Packet *packet, const TileTerm *tile_term)
{
    PacketTerm *term = &packet->terms[packet->n];
    if (packet->tile->perspective)
        place_bundle(packet, tile_term, term);
    else if (!place_parallel(packet, tile_term, term))
        return;
    Lanes cross_a = lanes_fma(term->u0, term->w1, -(term->w0 * term->u1));
    Lanes cross_b = lanes_fma(term->v0, term->w1, term->w0 * term->u1);
    term->end_y2[0] = square(cross_a) * term->inverse_speed2;
    term->end_y2[1] = square(cross_b) * term->inverse_speed2;
    term->past = lanes_select(cross_a < 0.0f, term->end_y2[0], lanes_set(0));
    term->past = lanes_select(cross_b < 0.0f, term->end_y2[1], term->past);
    Lanes d2 = term->e2 + term->past;
    if (!lanes_any(d2 < tile_term->reach2))
        return;
    term->share *= lanes_select((cross_a < 0.0f) | (cross_b < 0.0f), lanes_set(0.5f), lanes_set(1));
    term->gauss = lanes_exp_minus(d2);
    term->peak = term->gauss * lanes_min(term->share, lanes_set(1));
    term->term = tile_term;
    packet->n++;
}

/* Sets where the ray is nearest to the ends. */
LANE_FN void place_ends(PacketTerm *term)
{
    Lanes across = term->w0 * term->w1;
    term->end_z[0] = -lanes_fma(term->u0, term->u1, across) * term->inverse_speed2;
    term->end_z[1] = lanes_fma(term->v0, term->u1, -across) * term->inverse_speed2;
}

/* Sets what only packets need that may hit something. */
LANE_FN void complete_term(PacketTerm *term, bool perspective)
{
    const Lanes one = lanes_set(1), tiny = lanes_set(1e-20f);
    Lanes factor = lanes_min(term->share, one), speed2 = square(term->w1) + square(term->u1);
    Lanes bend = lanes_min(term->share * 0.8925207f, 0.9678830f / lanes_max(term->cosine, tiny));
    term->curvature = term->gauss * speed2 * bend;
    term->spare = term->past;
    term->half_gauss = term->gauss * 0.5f;
    if (lanes_any(term->past > 0.0f)) {
        term->spare -= lanes_log(factor);
        term->half_gauss = lanes_exp_minus(term->e2) * 0.5f;
    }
    place_ends(term);
    term->flat = !perspective && fabsf(term->term->cosine) < 1e-8f;
    if (term->flat) {
        Lanes ends, ends_slope;
        axial_factors(term->u0, term->v0, &ends, &ends_slope);
        term->half_gauss *= ends;
    }
}

/* Terms that overlap along the packet. z is relative to `base`. */
typedef struct Group {
    const Packet *packet;
    PacketTerm **terms;
    size_t n;
    double base;
    Lanes margin;
} Group;

typedef struct PacketSample {
    Lanes phi, slope,
        curvature; /* curvature: M of the terms counted, and they are all until next */
    float next;
} PacketSample;

/* Whether the term is above the cut-off on some of the rays. */
LANE_FN bool matters(const PacketTerm *term, LaneMask rays)
{
    return lanes_any(rays & (term->peak > (float)TILE_TERM_CUTOFF));
}

LANE_FN void add_sample(const PacketTerm *term, Lanes z, PacketSample *sample)
{
    Lanes dz = z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    Lanes gauss = term->half_gauss * lanes_exp_minus(square(w)), w_slope = -2.0f * w * term->w1;
    sample->curvature += term->curvature;
    if (term->flat) {
        sample->phi += gauss;
        sample->slope = lanes_fma(gauss, w_slope, sample->slope);
        return;
    }
    Lanes ends, ends_slope;
    axial_factors(lanes_fma(term->u1, dz, term->u0), lanes_fma(-term->u1, dz, term->v0), &ends,
                  &ends_slope);
    sample->phi = lanes_fma(gauss, ends, sample->phi);
    Lanes change = lanes_fma(term->u1 * ends_slope, lanes_set(1.12837917f), w_slope * ends);
    sample->slope = lanes_fma(gauss, change, sample->slope);
}

LANE_FN PacketSample sample_at(const Group *group, Lanes z, LaneMask live)
{
    const Lanes far = lanes_set(1e30f);
    float first = lanes_least(lanes_select(live, z, far));
    float last = lanes_largest(lanes_select(live, z, -far));
    PacketSample sample = {lanes_set(0), lanes_set(0), lanes_set(0), 1e30f};
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        if (term->on > last) {
            sample.next = term->on;
            break;
        }
        if (term->off >= first && matters(term, live))
            add_sample(term, z, &sample);
    }
    return sample;
}

/* Sets the margins and the stretch [*start, *end] outside which the group's potential is below
 * LEVEL - margin; false when there is no ray with any. */
LANE_FN bool group_window(Group *group, float extent, LaneMask *live, Lanes *start, Lanes *end)
{
    Lanes sum = lanes_set(0), places = lanes_set(0);
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        sum += term->peak;
        places = lanes_fma(term->peak, lanes_set(term->term->k), places);
    }
    group->margin =
        places * (extent * MARGIN_PLACE) + (MARGIN_DROPPED + MARGIN_TERM * (float)group->n);
    Lanes low_level = lanes_max(LEVEL - group->margin, lanes_set(0.01f * LEVEL));
    *live &= sum >= low_level;
    if (!lanes_any(*live))
        return false;
    Lanes excess = lanes_log(lanes_max(sum / low_level, lanes_set(1)));
    *start = lanes_set(1e30f);
    *end = lanes_set(-1e30f);
    for (size_t i = 0; i < group->n; i++) {
        PacketTerm *term = group->terms[i];
        if (!matters(term, *live))
            continue;
        complete_term(term, group->packet->tile->perspective);
        Lanes low, high, beside2 = excess + term->spare;
        term_stretch(term, beside2, beside2 - 0.69314718f, &low, &high);
        *start = lanes_min(*start, low + term->z);
        *end = lanes_max(*end, high + term->z);
    }
    *live &= *start <= *end;
    return lanes_any(*live);
}

/* Marches the live rays from z to `end`. Those that hit are in *hit, with their place in *z; those
 * that are not decided in *unsure. */
LANE_FN void march(const Group *group, LaneMask live, Lanes *z, Lanes end, LaneMask *hit,
                   LaneMask *unsure)
{
    for (int steps = 0; lanes_any(live); steps++) {
        PacketSample sample = sample_at(group, *z, live);
        Lanes lack = LEVEL - sample.phi, safe = lack - group->margin, slope = sample.slope;
        Lanes curvature = lanes_max(sample.curvature, lanes_set(1e-30f));
        Lanes slope2 = square(slope);
        Lanes safety = lanes_select(lack <= CLOSE_ENOUGH, lanes_set(4.6f), lanes_set(46));
        LaneMask sure = (slope > 0.0f) & (lack >= -group->margin) & (lack <= NEAR_ENOUGH) &
                        (slope2 >= safety * curvature * (lack + group->margin));
        LaneMask met = live & sure;
        *hit |= met;
        *z = lanes_select(met, *z + lack / slope, *z);
        live &= ~met;
        Lanes root = lanes_sqrt(lanes_max(slope2 + 2.0f * curvature * safe, lanes_set(0)));
        Lanes step =
            lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
        Lanes to = lanes_min(*z + step, lanes_set(sample.next));
        LaneMask stuck = live & ~((safe > 0.0f) & (to > *z));
        if (steps == MOST_STEPS)
            stuck = live;
        *unsure |= stuck;
        live &= ~stuck & (to <= end);
        *z = lanes_select(live, to, *z);
    }
}

LANE_FN void add_gradient(const PacketTerm *term, const Packet *packet, Lanes z, Lanes *phi,
                          Gradient *sum)
{
    const TileTerm *tile_term = term->term;
    const float k = tile_term->k, *axis = tile_term->axis;
    TermRays rays = rays_of(packet, tile_term);
    Lanes dz = z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    Lanes gauss = term->half_gauss * lanes_exp_minus(square(w)), value = gauss, ends_slope;
    Lanes u = lanes_fma(term->u1, dz, term->u0), v = lanes_fma(-term->u1, dz, term->v0);
    if (term->flat) {
        ends_slope = lanes_exp_minus(square(u)) - lanes_exp_minus(square(v));
        gauss = lanes_exp_minus(square(w) + term->e2) * 0.5f;
    } else {
        Lanes ends;
        axial_factors(u, v, &ends, &ends_slope);
        value *= ends;
    }
    for (int c = 0; c < 3; c++)
        rays.o[c] = lanes_fma(rays.d[c], dz, rays.o[c]);
    Lanes across = value * (-2.0f * k * k);
    Lanes along = gauss * ends_slope * (k * 1.12837917f) - across * dot(rays.o, axis);
    *phi += value;
    sum->x += lanes_fma(across, rays.o[0], along * axis[0]);
    sum->y += lanes_fma(across, rays.o[1], along * axis[1]);
    sum->z += lanes_fma(across, rays.o[2], along * axis[2]);
    name_largest(tile_term, value, sum);
}

/* The potential and its gradient at the points z of the rays, and the index of the largest term. */
LANE_FN Gradient gradient_at(const Group *group, Lanes z, LaneMask rays, Lanes *phi)
{
    Gradient sum = {.largest = lanes_set(-1)};
    *phi = lanes_set(0);
    for (size_t i = 0; i < group->n; i++)
        if (matters(group->terms[i], rays))
            add_gradient(group->terms[i], group->packet, z, phi, &sum);
    return sum;
}

/* One more Newton step comes with the gradient. */
LANE_FN void describe_hits(const Group *group, int first, LaneMask hit, Lanes z, TileHits *hits)
{
    const FieldTile *tile = group->packet->tile;
    Lanes phi;
    Gradient at = gradient_at(group, z, hit, &phi);
    Lanes slope = at.z;
    if (tile->perspective)
        slope += at.x * (group->packet->x + (float)tile->middle_x) +
                 at.y * (group->packet->y + (float)tile->middle_y);
    z += lanes_select(slope > 0.0f, (LEVEL - phi) / slope, lanes_set(0));
    Lanes normal[3];
    outward_normal(&at, normal);
    store_hits(tile, first, hit, group->base, z, normal, at.segment, hits);
}

/* Makes the terms from `first` on that overlap a group, and returns the number of the next. What is
 * nearer than `nearest` does not matter. */
LANE_FN size_t next_group(const Packet *packet, size_t first, double nearest, Group *group,
                          float *extent)
{
    PacketTerm **terms = packet->sum;
    double begin = fmax(terms[first]->term->on, nearest), end = terms[first]->term->off;
    double base = fmax(terms[first]->term->z_near, nearest);
    size_t last = first + 1;
    for (; last < packet->n_sum && terms[last]->term->on <= end; last++)
        end = terms[last]->term->off > end ? terms[last]->term->off : end;
    for (size_t i = first; i < last; i++) {
        terms[i]->z = (float)(terms[i]->term->z_near - base);
        terms[i]->on = (float)(terms[i]->term->on - base);
        terms[i]->off = (float)(terms[i]->term->off - base);
    }
    double reach = end - base > base - begin ? end - base : base - begin;
    double width = (double)packet->tile->half_size;
    *group = (Group){packet, terms + first, last - first, base, lanes_set(0)};
    *extent =
        (float)(reach + width * (packet->tile->perspective ? fmax(fabs(begin), fabs(end)) : 1));
    return last;
}

/* Traces the sum of the terms chosen. */
LANE_FN void trace_sum(const Packet *packet, int first, TileHits *hits)
{
    LaneMask open = (LaneMask){0} - 1;
    for (size_t i = 0; i < packet->n_sum && lanes_any(open);) {
        Group group;
        Lanes start, end;
        float extent;
        i = next_group(packet, i, -HUGE_VAL, &group, &extent);
        LaneMask live = open, hit = {0}, unsure = {0};
        if (!group_window(&group, extent, &live, &start, &end))
            continue;
        float z_min = (float)(packet->tile->z_min - group.base);
        live &= end >= z_min;
        unsure = live & ((start <= z_min) | (group.margin > CLOSE_ENOUGH));
        live &= ~unsure;
        march(&group, live, &start, end, &hit, &unsure);
        open &= ~(hit | unsure);
        if (lanes_any(hit))
            describe_hits(&group, first, hit, start, hits);
        if (lanes_any(unsure))
            give_up(first, unsure, hits);
    }
}

/* Finds the groups of the packet's terms that blend, whose number it returns. */
LANE_FN size_t find_groups(Packet *packet)
{
    for (size_t i = 0; i < packet->n; i++)
        packet->segments[i] = packet->terms[i].term->segment;
    return localgroups_find(packet->tile->groups, packet->segments, packet->n);
}

/* Makes the terms of one of the groups found those that are added up. */
LANE_FN void sum_group(Packet *packet, size_t group)
{
    const uint32_t *members = localgroups_members(packet->tile->groups, group, &packet->n_sum);
    for (size_t i = 0; i < packet->n_sum; i++)
        packet->sum[i] = &packet->terms[members[i]];
}

/* Traces the sums of the groups of the packet's terms, one after the other. */
LANE_FN void trace_union(Packet *packet, int first, TileHits *hits)
{
    size_t n_groups = find_groups(packet);
    for (size_t group = 0; group < n_groups; group++) {
        sum_group(packet, group);
        trace_sum(packet, first, hits);
    }
}

LANE_FN void trace_packet(Packet *packet, int first, TileHits *hits)
{
    const FieldTile *tile = packet->tile;
    packet->x = lanes_load(&tile->x[first]);
    packet->y = lanes_load(&tile->y[first]);
    packet->n = 0;
    for (size_t i = 0; i < tile->n_terms; i++)
        add_to_packet(packet, &tile->terms[i]);
    if (tile->groups) {
        trace_union(packet, first, hits);
        return;
    }
    packet->n_sum = packet->n;
    for (size_t i = 0; i < packet->n; i++)
        packet->sum[i] = &packet->terms[i];
    trace_sum(packet, first, hits);
}

LANE_TARGET void FIELD_KERNEL(const FieldTile *tile, TileWork *work, TileHits *hits)
{
    assert(tile->n_terms <= work->capacity);
    __builtin_memset(hits, 0, sizeof *hits);
    if (tile->plane) {
        PLANE_KERNEL(tile, work->memory, hits);
        return;
    }
    Packet packet = {.tile = tile, .terms = work->memory};
    packet.sum = (PacketTerm **)(packet.terms + tile->n_terms);
    packet.segments = (uint32_t *)(packet.sum + tile->n_terms);
    for (int first = 0; first < TILE_SAMPLES; first += LANES)
        trace_packet(&packet, first, hits);
}
