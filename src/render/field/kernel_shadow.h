/* Whether something stands between places and a light, several places at once: included after
 * kernel_trace.h by each source that compiles it for its lanes, and told by SHADOW_KERNEL how to
 * call it.
 *
 * Lines of sight lead from the places to the light, which is at the end of z. On most nothing is in
 * the way, and that is proven at once:
 *
 * - Start. Phi, its slope and the bound M of its curvature at the place give the stretch on which
 *   Phi stays below the level, as a step of kernel_trace.h's march does.
 * - Beyond. A term is a Gaussian convolved with a segment, and log-concave along a line. Where it
 *   recedes from the segment's line it is at most exp(-E^2 - w^2) from there on, beyond an end that
 *   it leaves at most exp(-E^2 - w^2 - x^2) / 2, once it falls at most what it is there, and
 *   elsewhere at most B. A place is lit if at the end of the stretch these sum up to less than the
 *   level.
 * - Dark. A term that is passed at E^2 <= 1.9, both its ends 1.5 / k or more away, is 1.06 times
 *   the level there alone.
 *
 * What is left is marched in full packets, each step of which may end in a proof of either kind;
 * that Phi is above the level somewhere on the way is proof enough, where is not asked.
 *
 * - Rim. Places are on the surface as well as it was found: until Phi has fallen below RIM of the
 *   level on leaving it, the level is SKIN times that. */
#ifndef SHADOW_KERNEL
#error "define SHADOW_KERNEL, the name of the function"
#endif

#define RIM 0.998f
#define SKIN 1.002f
#define SURELY_BELOW (0.999f * LEVEL)

/* Places, LANES of them, and the terms on the ways from there to the light. */
typedef struct Departures {
    Packet packet;
    double base;    /* about which z is */
    Lanes z;        /* of the places */
    float from, to; /* the least and the largest of these */
} Departures;

/* Sets the terms beyond the places, and returns the lanes on which one of them hides the light. */
LANE_FN LaneMask depart(Departures *way, LaneMask open)
{
    const FieldTile *tile = way->packet.tile;
    LaneMask hidden = {0};
    way->packet.n = 0;
    for (size_t i = 0; i < tile->n_terms; i++) {
        const TileTerm *term = &tile->terms[i];
        size_t n = way->packet.n;
        if (term->off < way->base + (double)way->from)
            continue;
        add_to_packet(&way->packet, term);
        if (way->packet.n == n)
            continue;
        PacketTerm *added = &way->packet.terms[n];
        added->z = (float)(term->z_near - way->base);
        added->on = (float)(term->on - way->base);
        added->off = (float)(term->off - way->base);
        hidden |= term_hides(added, way->z, tile->n_terms);
        if (!lanes_any(open & ~hidden))
            break;
    }
    return hidden;
}

/* Phi at the places. Sets the margin for it. */
LANE_FN PacketSample sample_places(const Departures *way, LaneMask open, Lanes *margin)
{
    const Packet *packet = &way->packet;
    PacketSample sample = nothing_sampled();
    float extent = 0, width = packet->tile->half_size;
    for (size_t i = 0; i < packet->n; i++) {
        PacketTerm *term = &packet->terms[i];
        if (term->on > way->to) {
            sample.next = lanes_min(sample.next, lanes_set(term->on));
            continue;
        }
        if (term->off < way->from || !matters(term, open))
            continue;
        bend_term(term, packet->tile->perspective);
        TermSample one = sample_term(term, way->z);
        add_sample(&one, open, term, &sample);
        extent = fmaxf(extent, fabsf(term->z));
    }
    if (packet->tile->perspective)
        width *= (float)fabs(way->base);
    *margin = sample.steep * ((extent + width + way->to - way->from) * MARGIN_PLACE) +
              fixed_margin(packet->n);
    return sample;
}

/* Of the open lanes, those that are proven lit by what is at the places and beyond the first
 * stretch. */
LANE_FN LaneMask lit_at_once(const Departures *way, LaneMask open)
{
    const Packet *packet = &way->packet;
    Lanes margin;
    PacketSample at = sample_places(way, open, &margin);
    LaneMask leaving = at.phi > RIM * LEVEL;
    Lanes safe = lanes_select(leaving, lanes_set(SKIN * LEVEL), lanes_set(LEVEL)) - at.phi - margin;
    open &= (safe > 0.0f) & (margin <= CLOSE_ENOUGH);
    if (!lanes_any(open))
        return open;
    Lanes curvature = lanes_max(at.curvature, lanes_set(1e-30f)), slope = at.slope;
    Lanes root =
        lanes_sqrt(lanes_fma(slope, slope, 2.0f * curvature * lanes_max(safe, lanes_set(0))));
    Lanes step =
        lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
    Lanes to = lanes_min(way->z + step, at.next);
    Lanes sum = lanes_set(fixed_margin(packet->n));
    for (size_t i = 0; i < packet->n; i++)
        sum += most_beyond(&packet->terms[i], to);
    return open & (sum < SURELY_BELOW);
}

/* As sample_at, and the most that Phi is from z on. */
LANE_FN PacketSample sample_departing(const Group *group, Lanes z, LaneMask live, Lanes *beyond)
{
    const Lanes zero = lanes_set(0);
    PacketSample sample = nothing_sampled();
    *beyond = zero;
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        LaneMask here = lanes_reached(term, z, live, &sample.next);
        *beyond += lanes_select(z < term->reach[0], term->peak, zero);
        if (!lanes_any(here))
            continue;
        TermThere there = term_at(term, z);
        add_sample(&there.at, here, term, &sample);
        *beyond += lanes_select(here, there.most, zero);
    }
    return sample;
}

/* Marches the live lanes on from z, until they are proven dark, or undecided; `leaving` are those
 * that start where they left the surface. */
LANE_FN void march_to_light(const Group *group, LaneMask live, LaneMask leaving, Lanes z,
                            LaneMask *dark, LaneMask *unsure)
{
    for (int steps = 0; lanes_any(live); steps++) {
        Lanes beyond;
        PacketSample at = sample_departing(group, z, live, &beyond);
        Lanes margin = margin_at(group, &at, z);
        live &= ~(beyond + margin < SURELY_BELOW);
        leaving &= at.phi > RIM * LEVEL;
        Lanes level = lanes_select(leaving, lanes_set(SKIN * LEVEL), lanes_set(LEVEL));
        Lanes lack = level - at.phi, safe = lack - margin, slope = at.slope;
        Lanes curvature = lanes_max(at.curvature, lanes_set(1e-30f)), slope2 = square(slope);
        LaneMask rises = (slope > 0.0f) & (slope2 >= SURE * curvature * (lack + margin));
        LaneMask met = live & ~leaving & ((lack <= -margin) | rises) & (margin <= CLOSE_ENOUGH);
        *dark |= met;
        live &= ~met;
        Lanes root = lanes_sqrt(lanes_max(slope2 + 2.0f * curvature * safe, lanes_set(0)));
        Lanes step =
            lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
        Lanes to = lanes_min(z + step, at.next);
        LaneMask stuck = live & ~((safe > 0.0f) & (to > z) & (margin <= CLOSE_ENOUGH));
        if (steps == MOST_STEPS)
            stuck = live;
        *unsure |= stuck;
        to = lanes_select(leaving, to, next_window(group, to));
        live &= ~stuck & (to < 1e30f);
        z = lanes_select(live, to, z);
    }
}

/* Sorts the terms chosen by rising `on`. */
LANE_FN void sort_sum(const Packet *packet)
{
    for (size_t i = 1; i < packet->n_sum; i++) {
        PacketTerm *term = packet->sum[i];
        size_t hole = i;
        for (; hole > 0 && packet->sum[hole - 1]->term->on > term->term->on; hole--)
            packet->sum[hole] = packet->sum[hole - 1];
        packet->sum[hole] = term;
    }
}

/* Looks for the light through the sum of the terms chosen. */
LANE_FN void look_through_sum(const Departures *way, LaneMask *open, LaneMask *dark,
                              LaneMask *unsure)
{
    const Packet *packet = &way->packet;
    const double nearest = way->base + (double)way->from;
    sort_sum(packet);
    for (size_t i = 0; i < packet->n_sum && lanes_any(*open);) {
        Group group;
        i = next_group(packet, i, nearest, &group);
        group.width += way->to - way->from;
        group.extent += way->to - way->from;
        LaneMask live = *open, stuck = {0};
        if (!group_window(&group, &live))
            continue;
        Lanes from = way->z + (float)(way->base - group.base);
        Lanes start = next_window(&group, lanes_set(-1e30f));
        live &= next_window(&group, from) < 1e30f;
        march_to_light(&group, live, start <= from, lanes_max(start, from), dark, &stuck);
        *unsure |= stuck;
        *open &= ~*dark;
    }
}

/* Likewise through the sums of the groups that blend, one after the other. */
LANE_FN void look_through_union(Departures *way, LaneMask *open, LaneMask *dark, LaneMask *unsure)
{
    size_t n_groups = find_groups(&way->packet);
    for (size_t group = 0; group < n_groups; group++) {
        sum_group(&way->packet, group);
        look_through_sum(way, open, dark, unsure);
    }
}

/* Some of a tile's places, and their numbers there. */
typedef struct Places {
    float x[LANES], y[LANES];
    double z[LANES];
    uint16_t numbers[LANES];
    int n;
} Places;

/* Takes LANES places, the first n of which count. Returns the lanes of those. */
LANE_FN LaneMask load_places(const float *x, const float *y, const double *z, int n,
                             Departures *way)
{
    LaneMask open;
    for (int lane = 0; lane < LANES; lane++)
        open[lane] = lane;
    way->base = z[0];
    way->packet.x = lanes_load(x);
    way->packet.y = lanes_load(y);
    way->z = lanes_of_doubles(z, -way->base);
    way->from = lanes_least(way->z);
    way->to = lanes_largest(way->z);
    return open < n;
}

/* Decides what is decided fast of the places from `first` on, and returns the lanes that are left.
 */
LANE_FN LaneMask decide_at_once(FieldPlaces *places, int first, Departures *way)
{
    LaneMask open = load_places(&places->x[first], &places->y[first], &places->z[first],
                                places->n - first, way);
    LaneMask dark = open & depart(way, open);
    for (uint32_t left = lanes_bits(dark); left; left &= left - 1)
        places->state[first + __builtin_ctz(left)] = PLACE_DARK;
    open &= ~dark;
    if (lanes_any(open))
        open &= ~lit_at_once(way, open);
    return open;
}

LANE_FN void set_states(FieldPlaces *places, const uint16_t *numbers, LaneMask which,
                        PlaceState state)
{
    for (uint32_t left = lanes_bits(which); left; left &= left - 1)
        places->state[numbers[__builtin_ctz(left)]] = (uint8_t)state;
}

/* Decides the places that have been put off, and forgets them. */
LANE_FN void decide_by_march(FieldPlaces *places, Places *later, Departures *way)
{
    for (int lane = later->n; lane < LANES; lane++) {
        later->x[lane] = later->x[later->n - 1];
        later->y[lane] = later->y[later->n - 1];
        later->z[lane] = later->z[later->n - 1];
    }
    LaneMask open = load_places(later->x, later->y, later->z, later->n, way), dark = {0},
             unsure = {0};
    depart(way, open);
    if (way->packet.tile->groups) {
        look_through_union(way, &open, &dark, &unsure);
    } else {
        way->packet.n_sum = way->packet.n;
        for (size_t i = 0; i < way->packet.n; i++)
            way->packet.sum[i] = &way->packet.terms[i];
        look_through_sum(way, &open, &dark, &unsure);
    }
    set_states(places, later->numbers, unsure, PLACE_UNSURE);
    set_states(places, later->numbers, dark, PLACE_DARK);
    later->n = 0;
}

LANE_FN void put_off(const FieldPlaces *places, int number, Places *later)
{
    int n = later->n++;
    later->x[n] = places->x[number];
    later->y[n] = places->y[number];
    later->z[n] = places->z[number];
    later->numbers[n] = (uint16_t)number;
}

LANE_TARGET void SHADOW_KERNEL(const FieldTile *tile, TileWork *work, FieldPlaces *places)
{
    Places later = {.n = 0};
    assert(tile->n_terms <= work->capacity);
    Departures way = {.packet = {.tile = tile, .terms = work->memory}};
    way.packet.sum = (PacketTerm **)(way.packet.terms + tile->n_terms);
    way.packet.segments = (uint32_t *)(way.packet.sum + tile->n_terms);
    __builtin_memset(places->state, PLACE_LIT, (size_t)places->n);
    for (int first = 0; first < places->n; first += LANES)
        for (uint32_t open = lanes_bits(decide_at_once(places, first, &way)); open;
             open &= open - 1) {
            put_off(places, first + __builtin_ctz(open), &later);
            if (later.n == LANES)
                decide_by_march(places, &later, &way);
        }
    if (later.n)
        decide_by_march(places, &later, &way);
}
