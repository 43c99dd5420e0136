/* The kernel FieldKernels.trace: finds the first hits of a tile, LANES rays at once. A source
 * includes the header of its kind of term first, kernel_potential.h or kernel_blob.h, and includes
 * this file once. If TRACES_PLANES is defined, tiles whose vessels are all in one plane are traced
 * by trace_plane [kernel_trace_flat.h].
 *
 * A term is the contribution of one segment to the potential Phi, the sum of the terms. The surface
 * is Phi = T, the level. For each term, B is an upper bound of the term on the ray, and M is an
 * upper bound of its second derivative along the ray: PacketTerm.peak and curvature
 * [kernel_packet.h]. A march steps along each ray. At each step, Phi ahead is at most the parabola
 * that the value, the slope and the sum of M give, so that no step can jump over a hit.
 *
 * fieldcast.c does this for one ray in double precision. This file does it for a packet of
 * neighbouring rays in single precision; rays that need more precision are TILE_UNSURE. A run is a
 * set of terms whose intervals of z overlap; the runs of a ray are searched one after another.
 *
 * - Windows. A term of a run is faint if its B is negligible; R is the sum of B over the faint
 *   terms, and S the sum of B over the other terms. Where Phi >= T, the other terms contribute at
 *   least T - R together. The share of a term is (T - R) B / S. The shares add up to T - R, so at
 *   least one term reaches its share there. A term is bounded by a function of the distance from
 *   its segment, so it can reach its share only within a certain distance. The part of the ray
 *   within this distance is the term's window. The march visits only windows. For a single straight
 *   vessel, the first window begins at its surface.
 * - Reach. The reach of a term is the one interval of the ray on which the term may exceed the
 *   cut-off; outside, the term counts as 0. No step passes the beginning of a reach. Only terms
 *   within reach contribute to the bound of the second derivative.
 * - Steps. No step passes a point at which Phi could reach T - margin. The margin bounds the errors
 *   of single precision, of the approximation of erf in the terms and of the terms left out.
 * - Hits. A hit is accepted if Phi certainly rises from below T - margin to above T + margin. */
#include "render/field/kernel_packet.h"

/* A crossing ahead is certain if slope^2 >= CROSSING_FACTOR M (deficit + margin), where the deficit
 * is T - Phi. Newton's method then completes the hit if the deficit is at most MAX_MARGIN, or at
 * most NEWTON_DEFICIT and ten times the factor is reached. The second derivative is at least
 * -CROSSING_FACTOR M / 2, so in the second case a Newton step leaves at most 1/40 of the deficit:
 * 5e-4 T after the first step, and 1e-6 T after the second one, in describe_hits. A larger value
 * would save a step of the march and lose digits of the depth. */
#define NEWTON_DEFICIT (2e-2f * LEVEL)
/* Maximum number of steps of a march; rays that need more, such as those that graze a surface, are
 * TILE_UNSURE. It bounds the time that a packet spends on its slowest ray. */
#define MAX_STEPS 128

/* Computes a term along the rays of a packet. Returns false if the term is below the cut-off on
 * every ray; some of its fields are then not set.
 *
 * In the plane of w and u, cross_a / w1 is u where the ray meets the axis line, and |cross_a| /
 * speed is the distance of the ray from the first end; cross_b is the same for v and the second
 * end. A negative value means that the ray meets the axis line beyond this end. The end is then the
 * point of the segment that is nearest to the ray. */
FOLDED_FN bool place_term(const Packet *packet, const TileTerm *tile_term, PacketTerm *term)
{
    if (packet->tile->perspective)
        place_perspective(packet, tile_term, term);
    else if (!place_orthographic(packet, tile_term, term))
        return false;
    Lanes cross_a = lanes_fma(term->u0, term->w1, -(term->w0 * term->u1));
    Lanes cross_b = lanes_fma(term->v0, term->w1, term->w0 * term->u1);
    term->end_y2[0] = square(cross_a) * term->inverse_speed2;
    term->end_y2[1] = square(cross_b) * term->inverse_speed2;
    term->past2 = lanes_select(cross_a < 0.0f, term->end_y2[0], lanes_set(0));
    term->past2 = lanes_select(cross_b < 0.0f, term->end_y2[1], term->past2);
    if (!lanes_any(term->e2 + term->past2 < tile_term->reach2))
        return false;
    term->term = tile_term;
    bound_term(term, (cross_a < 0.0f) | (cross_b < 0.0f));
    return true;
}

/* Appends the term to the packet, unless it is below the cut-off on every ray. */
LANE_FN void add_to_packet(Packet *packet, const TileTerm *term)
{
    packet->n += place_term(packet, term, &packet->terms[packet->n]);
}

/* A run: selected terms of a packet whose intervals of z overlap. z is relative to `base`. */
typedef struct TermRun {
    const Packet *packet;
    PacketTerm **terms;
    size_t n;
    double base;  /* z of Q [TileTerm] of the first term, at least `nearest` of next_run */
    float extent; /* upper bound of a coordinate, mm; rounding errors of positions are proportional
                   * to it. Sum of the largest |z|, the longest z_range and `width` */
    float width;  /* maximum distance of the rays from the middle ray of the tile, mm */
} TermRun;

/* Returns the margin [kernel_trace_common.h] of a sample at z. */
LANE_FN Lanes margin_at(const TermRun *run, const PacketSample *sample, Lanes z)
{
    return lanes_fma(sample->steepness * MARGIN_POSITION,
                     lanes_abs(z) + (sample->depth + run->width),
                     lanes_set(fixed_margin(sample->n)));
}

/* Returns true if the term exceeds the cut-off on one of the rays `rays`. */
LANE_FN bool exceeds_cutoff(const PacketTerm *term, LaneMask rays)
{
    return lanes_any(rays & (term->peak > (float)TILE_TERM_CUTOFF));
}

/* Returns the live lanes on which z is within the term's reach. On lanes that are before the reach,
 * lowers *next to the z at which the reach begins. */
LANE_FN LaneMask lanes_reached(const PacketTerm *term, Lanes z, LaneMask live, Lanes *next)
{
    *next = lanes_min_where(z < term->reach[0], *next, term->reach[0]);
    return live & (z >= term->reach[0]) & (z <= term->reach[1]);
}

/* Returns the sum of the terms of the run at z, for the live lanes. A lane is live while its ray is
 * neither decided nor given up. */
FOLDED_FN PacketSample sample_at(const TermRun *run, Lanes z, LaneMask live)
{
    PacketSample sample = nothing_sampled();
    for (size_t i = 0; i < run->n; i++) {
        const PacketTerm *term = run->terms[i];
        LaneMask here = lanes_reached(term, z, live, &sample.next);
        if (!lanes_any(here))
            continue;
        TermSample one = sample_term(term, z);
        add_sample(&one, here, term, &sample);
    }
    return sample;
}

/* Returns the first z, from the given z on, that is in a window; 1e30 or more if there is none. */
LANE_FN Lanes next_window(const TermRun *run, Lanes z)
{
    Lanes next = lanes_set(1e30f);
    for (size_t i = 0; i < run->n; i++) {
        const Lanes *window = run->terms[i]->window;
        next = lanes_min_where(z <= window[1], next, window[0]);
    }
    return lanes_max(next, z);
}

/* Computes the window and the reach of a term. `excess` is ln(S / (T - R)), the logarithm of B over
 * the share, for all terms that are not faint. Faint terms, where `counts` is false, get an empty
 * window. Beyond an end a term is at most half of what it can be beside the segment; therefore ln 2
 * is subtracted there. */
LANE_FN void place_windows(PacketTerm *term, bool perspective, Lanes excess, LaneMask counts)
{
    const Lanes none = lanes_set(1e30f);
    const Inverses per = inverses_of(term, perspective);
    Lanes beside2 = excess + term->peak_fall;
    DepthInterval window = interval_about(term, &per, beside2, beside2 - 0.69314718f);
    Lanes reach2 = term->term->reach2 - term->e2,
          within = lanes_sqrt(lanes_max(reach2, lanes_set(0)));
    DepthInterval reach = interval_within(term, &per, reach2, within, within);
    term->window[0] = lanes_select(counts, window.low + term->z, none);
    term->window[1] = lanes_select(counts, window.high + term->z, -none);
    term->reach[0] = reach.low + term->z;
    term->reach[1] = reach.high + term->z;
}

/* Computes the windows and reaches of the run's terms, and removes terms below the cut-off. Removes
 * from *live the rays whose potential cannot reach T - margin. Returns false if no live ray is
 * left.
 *
 * A term is faint if its B is below half of the level over the number of terms: the faint terms
 * then contribute less than half of the level. 0.01 T, far above any usual margin, keeps T - margin
 * positive. */
LANE_FN bool set_windows(TermRun *run, LaneMask *live)
{
    const bool perspective = run->packet->tile->perspective;
    Lanes sum = lanes_set(0), steep = lanes_set(0);
    for (size_t i = 0; i < run->n; i++) {
        const PacketTerm *term = run->terms[i];
        sum += term->peak;
        steep += steepness(term);
    }
    Lanes margin = steep * (run->extent * MARGIN_POSITION) + fixed_margin(run->n);
    Lanes low_level = lanes_max(LEVEL - margin, lanes_set(0.01f * LEVEL));
    *live &= sum >= low_level;
    if (!lanes_any(*live))
        return false;
    const Lanes faint = low_level * (0.5f / (float)run->n);
    Lanes rest = lanes_set(0);
    for (size_t i = 0; i < run->n; i++) {
        Lanes peak = run->terms[i]->peak;
        rest += lanes_select(peak < faint, peak, lanes_set(0));
    }
    Lanes excess = lanes_log(lanes_max((sum - rest) / (low_level - rest), lanes_set(1)));
    size_t n = 0;
    for (size_t i = 0; i < run->n; i++) {
        PacketTerm *term = run->terms[i];
        if (!exceeds_cutoff(term, *live))
            continue;
        complete_term(term, perspective);
        place_windows(term, perspective, excess, term->peak >= faint);
        run->terms[n++] = term;
    }
    run->n = n;
    return true;
}

/* Marches the live rays from *z on. Adds the rays that hit to *hit and sets *z to their hits. Adds
 * the rays that it gives up to *unsure. The minimum 1e-30 of the curvature avoids 0 / 0. */
LANE_FN void march(const TermRun *run, LaneMask live, Lanes *z, LaneMask *hit, LaneMask *unsure)
{
    for (int steps = 0; lanes_any(live); steps++) {
        PacketSample sample = sample_at(run, *z, live);
        Lanes margin = margin_at(run, &sample, *z);
        Lanes deficit = LEVEL - sample.phi, safe = deficit - margin, slope = sample.slope;
        Lanes curvature = lanes_max(sample.curvature, lanes_set(1e-30f));
        Lanes slope2 = square(slope);
        Lanes safety = lanes_select(deficit <= MAX_MARGIN, lanes_set(CROSSING_FACTOR),
                                    lanes_set(10 * CROSSING_FACTOR));
        LaneMask sure = (slope > 0.0f) & (deficit >= -margin) & (deficit <= NEWTON_DEFICIT) &
                        (slope2 >= safety * curvature * (deficit + margin));
        LaneMask precise = margin <= MAX_MARGIN;
        LaneMask met = live & sure & precise;
        *hit |= met;
        live &= ~met;
        Lanes root = lanes_sqrt(lanes_max(slope2 + 2.0f * curvature * safe, lanes_set(0)));
        LaneMask rises = slope > 0.0f;
        Lanes above = lanes_select(rises, 2.0f * safe, root - slope);
        Lanes below = lanes_select(rises, slope + root, curvature);
        /* The step to the z at which Phi may first reach T - margin: the root of safe - slope s -
         * curvature s^2 / 2, in the form that loses no digits for the sign of the slope. A division
         * is slow, so one division serves both this step and the Newton step of rays that hit. */
        Lanes step = lanes_select(met, deficit, above) / lanes_select(met, slope, below);
        Lanes to = lanes_min(*z + step, lanes_select(met, lanes_set(1e30f), sample.next));
        *z = lanes_select(met, to, *z);
        LaneMask stuck = live & ~((safe > 0.0f) & (to > *z) & precise);
        if (steps == MAX_STEPS)
            stuck = live;
        *unsure |= stuck;
        to = next_window(run, to);
        live &= ~stuck & (to < 1e30f);
        *z = lanes_select(live, to, *z);
    }
}

/* Computes the potential and its gradient at the points z of the rays, and the index of the largest
 * term. */
LANE_FN Gradient gradient_at(const TermRun *run, Lanes z, LaneMask rays, Lanes *phi)
{
    Gradient sum = {.largest = lanes_set(-1)};
    *phi = lanes_set(0);
    for (size_t i = 0; i < run->n; i++) {
        const PacketTerm *term = run->terms[i];
        if (lanes_any(rays & (z >= term->reach[0]) & (z <= term->reach[1])))
            add_gradient(term, run->packet, z, phi, &sum);
    }
    return sum;
}

/* Stores the hits. The gradient is also used for one more step of Newton's method. */
LANE_FN void describe_hits(const TermRun *run, int first, LaneMask hit, Lanes z, TileHits *hits)
{
    const FieldTile *tile = run->packet->tile;
    Lanes phi;
    Gradient at = gradient_at(run, z, hit, &phi);
    Lanes slope = at.z;
    if (tile->perspective)
        slope += at.x * (run->packet->x + (float)tile->middle_x) +
                 at.y * (run->packet->y + (float)tile->middle_y);
    z += lanes_select(slope > 0.0f, (LEVEL - phi) / slope, lanes_set(0));
    Lanes normal[3];
    outward_normal(&at, normal);
    store_hits(tile, first, hit, run->base, z, normal, at.segment, hits);
}

/* Computes the depths of a term relative to `base`. */
FOLDED_FN void set_depths(PacketTerm *term, double base)
{
    term->z = (float)(term->term->z_near - base);
    term->z_range[0] = (float)(term->term->z_begin - base);
    term->z_range[1] = (float)(term->term->z_end - base);
}

/* Forms a run of the selected terms from index `first` on that overlap. Depths below `nearest` are
 * ignored. Returns the index of the first term of the next run. */
LANE_FN size_t next_run(const Packet *packet, size_t first, double nearest, TermRun *run)
{
    PacketTerm **terms = packet->selected;
    double begin = fmax(terms[first]->term->z_begin, nearest), end = terms[first]->term->z_end;
    double base = fmax(terms[first]->term->z_near, nearest);
    size_t end_index = first + 1;
    float depth = 0;
    for (; end_index < packet->n_selected && terms[end_index]->term->z_begin <= end; end_index++)
        end = terms[end_index]->term->z_end > end ? terms[end_index]->term->z_end : end;
    for (size_t i = first; i < end_index; i++) {
        set_depths(terms[i], base);
        depth = fmaxf(depth, terms[i]->z_range[1] - terms[i]->z_range[0]);
    }
    double reach = end - base > base - begin ? end - base : base - begin;
    float width = packet->tile->half_size;
    if (packet->tile->perspective)
        width *= (float)fmax(fabs(begin), fabs(end));
    *run = (TermRun){.packet = packet,
                     .terms = terms + first,
                     .n = end_index - first,
                     .base = base,
                     .extent = (float)reach + depth + width,
                     .width = width};
    return end_index;
}

/* Traces the sum of the selected terms, run by run. Rays whose first window begins before z_min may
 * hit before z_min, and are TILE_UNSURE. */
LANE_FN void trace_selected(const Packet *packet, int first, TileHits *hits)
{
    LaneMask open = (LaneMask){0} - 1;
    for (size_t i = 0; i < packet->n_selected && lanes_any(open);) {
        TermRun run;
        i = next_run(packet, i, -HUGE_VAL, &run);
        LaneMask live = open, hit = {0}, unsure = {0};
        if (!set_windows(&run, &live))
            continue;
        Lanes z = next_window(&run, lanes_set(-1e30f));
        Lanes z_min = lanes_set((float)(packet->tile->z_min - run.base));
        live &= next_window(&run, z_min) < 1e30f;
        unsure = live & (z <= z_min);
        live &= ~unsure;
        march(&run, live, &z, &hit, &unsure);
        open &= ~(hit | unsure);
        if (lanes_any(hit))
            describe_hits(&run, first, hit, z, hits);
        if (lanes_any(unsure))
            mark_unsure(first, unsure, hits);
    }
}

/* Finds the blend groups of the packet's terms. Returns their number. */
LANE_FN size_t find_groups(Packet *packet)
{
    for (size_t i = 0; i < packet->n; i++)
        packet->segments[i] = packet->terms[i].term->segment;
    return localgroups_find(packet->tile->groups, packet->segments, packet->n);
}

/* Selects all terms for the sum. */
LANE_FN void select_all(Packet *packet)
{
    packet->n_selected = packet->n;
    for (size_t i = 0; i < packet->n; i++)
        packet->selected[i] = &packet->terms[i];
}

/* Selects the terms of one blend group for the sum. */
LANE_FN void select_group(Packet *packet, size_t group)
{
    const uint32_t *members = localgroups_members(packet->tile->groups, group, &packet->n_selected);
    for (size_t i = 0; i < packet->n_selected; i++)
        packet->selected[i] = &packet->terms[members[i]];
}

/* Traces the sums of the blend groups, one after another. */
LANE_FN void trace_groups(Packet *packet, int first, TileHits *hits)
{
    size_t n_groups = find_groups(packet);
    for (size_t group = 0; group < n_groups; group++) {
        select_group(packet, group);
        trace_selected(packet, first, hits);
    }
}

/* Computes the circle around the samples from `first` on, which form a rectangular block. The
 * factor 0.501 is 1/2 with a margin for rounding. */
LANE_FN void enclose_block(Packet *packet, int first)
{
    const float *sides[2] = {&packet->tile->x[first], &packet->tile->y[first]};
    float size2 = 0;
    for (int c = 0; c < 2; c++) {
        float size = sides[c][LANES - 1] - sides[c][0];
        packet->middle[c] = sides[c][0] + 0.5f * size;
        size2 += size * size;
    }
    packet->half = 0.501f * sqrtf(size2);
}

/* Traces the packet of the samples [first, first + LANES). */
LANE_FN void trace_packet(Packet *packet, int first, TileHits *hits)
{
    const FieldTile *tile = packet->tile;
    packet->x = lanes_load(&tile->x[first]);
    packet->y = lanes_load(&tile->y[first]);
    enclose_block(packet, first);
    packet->n = 0;
    for (size_t i = 0; i < tile->n_terms; i += LANES)
        for (uint32_t near = terms_near(packet, i); near; near &= near - 1)
            add_to_packet(packet, &tile->terms[i + (size_t)__builtin_ctz(near)]);
    if (tile->groups) {
        trace_groups(packet, first, hits);
        return;
    }
    select_all(packet);
    trace_selected(packet, first, hits);
}

/* FieldKernels.trace: finds the first hits of the tile's samples [FieldKernel]. */
LANE_TARGET static void LANES_NAME(trace)(const FieldTile *tile, void *work, TileHits *hits)
{
    __builtin_memset(hits, 0, sizeof *hits);
#ifdef TRACES_PLANES
    if (tile->plane) {
        trace_plane(tile, work, hits);
        return;
    }
#endif
    Packet packet = {.tile = tile, .terms = work};
    divide_workspace(&packet);
    for (int first = 0; first < TILE_SAMPLES; first += LANES)
        trace_packet(&packet, first, hits);
}
