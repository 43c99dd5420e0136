/* The kernel FieldKernels.trace: finds the first hits of a tile, LANES rays at once. The including
 * source must first include the header of its kind of term, kernel_potential.h or kernel_blob.h. If
 * TRACES_PLANES is defined, tiles whose vessels are all in one plane are traced by trace_plane
 * [kernel_trace_flat.h].
 *
 * The potential Phi is the sum of the terms; the surface is Phi = T, the level. As in fieldcast.c,
 * the potential along a ray is bounded by its second derivative, so that no step can jump over a
 * hit. fieldcast.c does this for one ray in double precision; this file does it for a packet of
 * neighbouring rays in single precision. Rays that would need more precision are returned as
 * TILE_UNSURE. For each term, B is an upper bound on the ray, and M an upper bound of the second
 * derivative along the ray [kernel_packet.h]. A group is a set of terms whose intervals of z
 * overlap.
 *
 * - Windows. Let R be the sum of the B of the faint terms of a group, whose B is negligible. Where
 *   Phi >= T, the other terms contribute at least T - R. Let S be the sum of their B. Then at least
 *   one of them is at least its share (T - R) B / S; otherwise their sum would be below T - R. A
 *   term is bounded by a function of the distance from its segment, so it can reach its share only
 *   within a certain distance. The part of the ray within this distance is the term's window. The
 *   march visits only windows. For a single straight vessel, the first window begins at its
 *   surface.
 * - Reach. A term exceeds the cut-off on at most one interval of each ray, its reach, and counts as
 *   0 outside. No step passes the beginning of a reach. Only terms within reach contribute to the
 *   bound of the second derivative.
 * - Steps and acceptance are those of fieldcast.c, with a margin for the errors of single
 *   precision, of erf and of the terms left out. No step passes a point at which Phi could
 *   reach T - margin. A hit is accepted if Phi certainly rises from below T - margin to above T +
 * margin.
 */
#include "render/field/kernel_packet.h"

/* The maximum deficit T - Phi at which Newton's method may complete a hit, if a crossing is certain
 * with ten times the usual safety. The first Newton step then leaves at most a fortieth of the
 * deficit, 5e-4 T, and the second one, in describe_hits, at most 1e-6 T. With a deficit of at most
 * CLOSE_ENOUGH, the usual safety SURE is sufficient. A larger value would save a step of the march
 * and lose digits of the depth. */
#define NEAR_ENOUGH (2e-2f * LEVEL)
/* Maximum number of steps of a march; rays that need more, such as those that graze a surface, are
 * TILE_UNSURE. It bounds the time that a packet spends on its slowest ray. */
#define MOST_STEPS 128

/* Computes a term along the rays of a packet. Returns false if the term is below the cut-off on
 * every ray; some of its fields are then not set. */
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
    term->past = lanes_select(cross_a < 0.0f, term->end_y2[0], lanes_set(0));
    term->past = lanes_select(cross_b < 0.0f, term->end_y2[1], term->past);
    if (!lanes_any(term->e2 + term->past < tile_term->reach2))
        return false;
    term->term = tile_term;
    term->bent = false;
    bound_term(term, (cross_a < 0.0f) | (cross_b < 0.0f));
    return true;
}

/* Appends the term to the packet, unless it is below the cut-off on every ray. */
LANE_FN void add_to_packet(Packet *packet, const TileTerm *term)
{
    packet->n += place_term(packet, term, &packet->terms[packet->n]);
}

/* A group: terms of a packet whose intervals of z overlap. z is relative to `base`. */
typedef struct Group {
    const Packet *packet;
    PacketTerm **terms;
    size_t n;
    double base;
    float extent; /* upper bound of the size of positions, mm, to which their rounding error is
                   * proportional: the sum of the range of z, of the longest z_range, and of
                   * `width` */
    float width;  /* maximum distance of the rays from the middle ray, mm */
} Group;

/* Returns the margin of a sample at z. Positions farther from the base have larger rounding
 * errors. */
LANE_FN Lanes margin_at(const Group *group, const PacketSample *sample, Lanes z)
{
    return lanes_fma(sample->steep * MARGIN_PLACE, lanes_abs(z) + (sample->depth + group->width),
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

/* Returns the sum of the terms of the group at z, for the live lanes (rays still undecided). */
FOLDED_FN PacketSample sample_at(const Group *group, Lanes z, LaneMask live)
{
    PacketSample sample = nothing_sampled();
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        LaneMask here = lanes_reached(term, z, live, &sample.next);
        if (!lanes_any(here))
            continue;
        TermSample one = sample_term(term, z);
        add_sample(&one, here, term, &sample);
    }
    return sample;
}

/* Returns the first z, from the given z on, that is in a window; 1e30 or more if there is none. */
LANE_FN Lanes next_window(const Group *group, Lanes z)
{
    Lanes next = lanes_set(1e30f);
    for (size_t i = 0; i < group->n; i++) {
        const Lanes *window = group->terms[i]->window;
        next = lanes_min_where(z <= window[1], next, window[0]);
    }
    return lanes_max(next, z);
}

/* Computes the window and the reach of a term. exp(excess) is the ratio of a term's B to its share,
 * the same for all terms that count. Faint terms, where `counts` is false, get an empty window. */
LANE_FN void place_windows(PacketTerm *term, bool perspective, Lanes excess, LaneMask counts)
{
    const Lanes none = lanes_set(1e30f);
    const Inverses per = inverses_of(term, perspective);
    Lanes beside2 = excess + term->spare;
    DepthInterval window = interval_about(term, &per, beside2, beside2 - 0.69314718f);
    Lanes reach2 = term->term->reach2 - term->e2,
          within = lanes_sqrt(lanes_max(reach2, lanes_set(0)));
    DepthInterval reach = interval_within(term, &per, reach2, within, within);
    term->window[0] = lanes_select(counts, window.low + term->z, none);
    term->window[1] = lanes_select(counts, window.high + term->z, -none);
    term->reach[0] = reach.low + term->z;
    term->reach[1] = reach.high + term->z;
}

/* Computes the windows and reaches of the group's terms, and removes terms below the cut-off.
 * Removes from *live the rays whose potential cannot reach T - margin. Returns false if no live ray
 * is left. */
LANE_FN bool group_window(Group *group, LaneMask *live)
{
    const bool perspective = group->packet->tile->perspective;
    Lanes sum = lanes_set(0), places = lanes_set(0);
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        sum += term->peak;
        places += steepness(term);
    }
    Lanes margin = places * (group->extent * MARGIN_PLACE) + fixed_margin(group->n);
    Lanes low_level = lanes_max(LEVEL - margin, lanes_set(0.01f * LEVEL));
    *live &= sum >= low_level;
    if (!lanes_any(*live))
        return false;
    const Lanes faint = low_level * (0.5f / (float)group->n);
    Lanes rest = lanes_set(0);
    for (size_t i = 0; i < group->n; i++) {
        Lanes peak = group->terms[i]->peak;
        rest += lanes_select(peak < faint, peak, lanes_set(0));
    }
    Lanes excess = lanes_log(lanes_max((sum - rest) / (low_level - rest), lanes_set(1)));
    size_t n = 0;
    for (size_t i = 0; i < group->n; i++) {
        PacketTerm *term = group->terms[i];
        if (!exceeds_cutoff(term, *live))
            continue;
        complete_term(term, perspective);
        place_windows(term, perspective, excess, term->peak >= faint);
        group->terms[n++] = term;
    }
    group->n = n;
    return true;
}

/* Marches the live rays from *z on. Adds the rays that hit to *hit and sets *z to their hits. Adds
 * the undecided rays to *unsure. */
LANE_FN void march(const Group *group, LaneMask live, Lanes *z, LaneMask *hit, LaneMask *unsure)
{
    for (int steps = 0; lanes_any(live); steps++) {
        PacketSample sample = sample_at(group, *z, live);
        Lanes margin = margin_at(group, &sample, *z);
        Lanes deficit = LEVEL - sample.phi, safe = deficit - margin, slope = sample.slope;
        Lanes curvature = lanes_max(sample.curvature, lanes_set(1e-30f));
        Lanes slope2 = square(slope);
        Lanes safety = lanes_select(deficit <= CLOSE_ENOUGH, lanes_set(SURE), lanes_set(10 * SURE));
        LaneMask sure = (slope > 0.0f) & (deficit >= -margin) & (deficit <= NEAR_ENOUGH) &
                        (slope2 >= safety * curvature * (deficit + margin));
        LaneMask near = margin <= CLOSE_ENOUGH;
        LaneMask met = live & sure & near;
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
        LaneMask stuck = live & ~((safe > 0.0f) & (to > *z) & near);
        if (steps == MOST_STEPS)
            stuck = live;
        *unsure |= stuck;
        to = next_window(group, to);
        live &= ~stuck & (to < 1e30f);
        *z = lanes_select(live, to, *z);
    }
}

/* Computes the potential and its gradient at the points z of the rays, and the index of the largest
 * term. */
LANE_FN Gradient gradient_at(const Group *group, Lanes z, LaneMask rays, Lanes *phi)
{
    Gradient sum = {.largest = lanes_set(-1)};
    *phi = lanes_set(0);
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        if (lanes_any(rays & (z >= term->reach[0]) & (z <= term->reach[1])))
            add_gradient(term, group->packet, z, phi, &sum);
    }
    return sum;
}

/* Stores the hits. The gradient is also used for one more step of Newton's method. */
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

/* Computes the depths of a term relative to `base`. */
FOLDED_FN void set_depths(PacketTerm *term, double base)
{
    term->z = (float)(term->term->z_near - base);
    term->z_range[0] = (float)(term->term->z_begin - base);
    term->z_range[1] = (float)(term->term->z_end - base);
}

/* Forms a group of the terms from index `first` on that overlap. Depths below `nearest` are
 * ignored. Returns the index of the first term of the next group. */
LANE_FN size_t next_group(const Packet *packet, size_t first, double nearest, Group *group)
{
    PacketTerm **terms = packet->sum;
    double begin = fmax(terms[first]->term->z_begin, nearest), end = terms[first]->term->z_end;
    double base = fmax(terms[first]->term->z_near, nearest);
    size_t last = first + 1;
    float depth = 0;
    for (; last < packet->n_sum && terms[last]->term->z_begin <= end; last++)
        end = terms[last]->term->z_end > end ? terms[last]->term->z_end : end;
    for (size_t i = first; i < last; i++) {
        set_depths(terms[i], base);
        depth = fmaxf(depth, terms[i]->z_range[1] - terms[i]->z_range[0]);
    }
    double reach = end - base > base - begin ? end - base : base - begin;
    float width = packet->tile->half_size;
    if (packet->tile->perspective)
        width *= (float)fmax(fabs(begin), fabs(end));
    *group = (Group){.packet = packet,
                     .terms = terms + first,
                     .n = last - first,
                     .base = base,
                     .extent = (float)reach + depth + width,
                     .width = width};
    return last;
}

/* Traces the sum of the selected terms, group by group. Rays whose first window begins before z_min
 * may hit before z_min, and are TILE_UNSURE. */
LANE_FN void trace_sum(const Packet *packet, int first, TileHits *hits)
{
    LaneMask open = (LaneMask){0} - 1;
    for (size_t i = 0; i < packet->n_sum && lanes_any(open);) {
        Group group;
        i = next_group(packet, i, -HUGE_VAL, &group);
        LaneMask live = open, hit = {0}, unsure = {0};
        if (!group_window(&group, &live))
            continue;
        Lanes z = next_window(&group, lanes_set(-1e30f));
        Lanes z_min = lanes_set((float)(packet->tile->z_min - group.base));
        live &= next_window(&group, z_min) < 1e30f;
        unsure = live & (z <= z_min);
        live &= ~unsure;
        march(&group, live, &z, &hit, &unsure);
        open &= ~(hit | unsure);
        if (lanes_any(hit))
            describe_hits(&group, first, hit, z, hits);
        if (lanes_any(unsure))
            give_up(first, unsure, hits);
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
LANE_FN void sum_all(Packet *packet)
{
    packet->n_sum = packet->n;
    for (size_t i = 0; i < packet->n; i++)
        packet->sum[i] = &packet->terms[i];
}

/* Selects the terms of one blend group for the sum. */
LANE_FN void sum_group(Packet *packet, size_t group)
{
    const uint32_t *members = localgroups_members(packet->tile->groups, group, &packet->n_sum);
    for (size_t i = 0; i < packet->n_sum; i++)
        packet->sum[i] = &packet->terms[members[i]];
}

/* Traces the sums of the blend groups, one after another. */
LANE_FN void trace_union(Packet *packet, int first, TileHits *hits)
{
    size_t n_groups = find_groups(packet);
    for (size_t group = 0; group < n_groups; group++) {
        sum_group(packet, group);
        trace_sum(packet, first, hits);
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
        trace_union(packet, first, hits);
        return;
    }
    sum_all(packet);
    trace_sum(packet, first, hits);
}

/* FieldKernels.trace. */
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
