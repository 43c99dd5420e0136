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
 *   recedes from the segment's line it is at most exp(-E^2 - w^2) from there on, at x before the
 *   end that it leaves at most (1 + erf x) / 2 of that, beyond it at most exp(-E^2 - w^2 - x^2) /
 *   2, once it falls at most what it is there, and elsewhere at most B. A place is lit if at the
 *   end of the stretch these sum up to less than the level.
 * - Dark. A term that is passed at E^2 <= 1.9, both its ends 1.5 / k or more away, is 1.06 times
 *   the level there alone.
 *
 * These tests set out a term only to know what it is at the places, and keep little of it. Terms
 * that are out of reach of a whole packet are left out before that, several at once.
 *
 * What is left is looked at in full packets. That Phi is above the level somewhere on the way is
 * proof enough, where is not asked: one place is tried, where the term passed nearest is. Then rays
 * are marched, each step of which may end in a proof of either kind.
 *
 * - Rim. Places are on the surface as well as it was found: until Phi has fallen below RIM of the
 *   level on leaving it, the level is SKIN times that. */
#ifndef SHADOW_KERNEL
#error "define SHADOW_KERNEL, the name of the function"
#endif

#define RIM 0.998f
#define SKIN 1.002f
#define SURELY_BELOW (0.999f * LEVEL)

/* What is kept of a term to tell whether it matters beyond the places. */
typedef struct Blocker {
    Lanes w, w1;      /* at the place, and its change with z, >= 0 */
    Lanes leaves, u1; /* the distance, at the place, from the end that is left, and how it falls */
    Lanes e2, peak;
} Blocker;

/* Places, LANES of them, and the terms on the ways from there to the light. */
typedef struct Departures {
    Packet packet;
    Blocker *blockers; /* in the memory of the packet's terms */
    size_t n_blockers;
    double base;    /* about which z is */
    Lanes z;        /* of the places */
    float from, to; /* the least and the largest of these */
} Departures;

/* Of the LANES terms from `first` on, as bits, those that may be within reach of a packet and are
 * not all behind its places. */
LANE_FN uint32_t terms_ahead(const Departures *way, size_t first)
{
    const FieldTile *tile = way->packet.tile;
    uint32_t ahead = 0;
    for (uint32_t left = terms_near(&way->packet, first); left; left &= left - 1) {
        int lane = __builtin_ctz(left);
        bool is_ahead = tile->terms[first + (size_t)lane].off >= way->base + (double)way->from;
        ahead |= (uint32_t)is_ahead << lane;
    }
    return ahead;
}

FOLDED_FN void set_depths(const Departures *way, PacketTerm *term)
{
    term->z = (float)(term->term->z_near - way->base);
    term->felt[0] = (float)(term->term->on - way->base);
    term->felt[1] = (float)(term->term->off - way->base);
}

/* Keeps the term as a blocker, and adds what it is at the places to *at. */
FOLDED_FN void pass_term(Departures *way, PacketTerm *term, LaneMask open, PacketSample *at,
                         float *extent)
{
    Lanes dz = way->z - term->z, w = lanes_fma(term->w1, dz, term->w0);
    Lanes u = lanes_fma(term->u1, dz, term->u0), v = lanes_fma(-term->u1, dz, term->v0);
    way->blockers[way->n_blockers++] = (Blocker){.w = w,
                                                 .w1 = term->w1,
                                                 .leaves = lanes_select(term->u1 > 0.0f, v, u),
                                                 .u1 = lanes_abs(term->u1),
                                                 .e2 = term->e2,
                                                 .peak = term->peak};
    if (term->felt[0] > way->to) {
        at->next = lanes_min(at->next, lanes_set(term->felt[0]));
        return;
    }
    if (!matters(term, open))
        return;
    bound_bend(term);
    TermSample one = sample_once(term, w, u, v);
    add_sample(&one, open, term, at);
    float far = fabsf(term->z);
    *extent = far > *extent ? far : *extent;
}

/* Looks at the terms beyond the places: sets the blockers, Phi at the places and the margin for it,
 * and returns the lanes on which one term alone hides the light; all of the former only if some are
 * left. */
LANE_FN LaneMask depart(Departures *way, LaneMask open, PacketSample *at, Lanes *margin)
{
    const FieldTile *tile = way->packet.tile;
    LaneMask hidden = {0};
    float extent = 0, width = tile->half_size;
    way->n_blockers = 0;
    *at = nothing_sampled();
    *margin = lanes_set(0);
    for (size_t i = 0; i < tile->n_terms; i += LANES)
        for (uint32_t near = terms_ahead(way, i); near; near &= near - 1) {
            PacketTerm term;
            if (!place_term(&way->packet, &tile->terms[i + (size_t)__builtin_ctz(near)], &term))
                continue;
            set_depths(way, &term);
            hidden |= term_hides(&term, way->z, tile->n_terms);
            if (!lanes_any(open & ~hidden))
                return hidden;
            pass_term(way, &term, open, at, &extent);
        }
    if (tile->perspective)
        width *= (float)fabs(way->base);
    *margin = at->steep * ((extent + width + way->to - way->from) * MARGIN_PLACE) +
              fixed_margin(way->n_blockers);
    return hidden;
}

/* Of the open lanes, those that are proven lit by what is at the places and beyond the first
 * stretch. */
LANE_FN LaneMask lit_at_once(const Departures *way, LaneMask open, const PacketSample *at,
                             Lanes margin)
{
    LaneMask leaving = at->phi > RIM * LEVEL;
    Lanes safe =
        lanes_select(leaving, lanes_set(SKIN * LEVEL), lanes_set(LEVEL)) - at->phi - margin;
    open &= (safe > 0.0f) & (margin <= CLOSE_ENOUGH);
    if (!lanes_any(open))
        return open;
    Lanes curvature = lanes_max(at->curvature, lanes_set(1e-30f)), slope = at->slope;
    Lanes root =
        lanes_sqrt(lanes_fma(slope, slope, 2.0f * curvature * lanes_max(safe, lanes_set(0))));
    Lanes step =
        lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
    step = lanes_min(step, at->next - way->z);
    Lanes sum = lanes_set(fixed_margin(way->n_blockers));
    for (size_t i = 0; i < way->n_blockers; i++) {
        const Blocker *term = &way->blockers[i];
        Lanes beyond = most_beyond(term->e2, lanes_fma(term->w1, step, term->w),
                                   lanes_fma(term->u1, -step, term->leaves));
        sum += lanes_min(beyond, term->peak);
    }
    return open & (sum < SURELY_BELOW);
}

/* As sample_at, and the most that Phi is from z on. */
LANE_FN PacketSample sample_departing(const Group *group, Lanes z, LaneMask live, Lanes *beyond)
{
    PacketSample sample = nothing_sampled();
    *beyond = lanes_set(0);
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        LaneMask here = lanes_reached(term, z, live, &sample.next);
        *beyond = lanes_add_where(z < term->reach[0], *beyond, term->peak);
        if (!lanes_any(here))
            continue;
        TermThere there = term_at(term, z);
        add_sample(&there.at, here, term, &sample);
        *beyond = lanes_add_where(here, *beyond, there.most);
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

/* Of the live lanes at z, those that are above the level in the middle of the window, beyond z, of
 * the term that may be the largest there. */
LANE_FN LaneMask lanes_hidden(const Group *group, LaneMask live, Lanes z)
{
    Lanes largest = lanes_set(0), middle = lanes_set(1e30f);
    for (size_t i = 0; i < group->n; i++) {
        const PacketTerm *term = group->terms[i];
        Lanes there = 0.5f * (term->window[0] + term->window[1]);
        LaneMask larger = (there > z) & (term->peak > largest);
        largest = lanes_select(larger, term->peak, largest);
        middle = lanes_select(larger, there, middle);
    }
    PacketSample at = sample_at(group, middle, live);
    Lanes margin = margin_at(group, &at, middle);
    return live & (at.phi - margin >= SKIN * LEVEL) & (margin <= CLOSE_ENOUGH);
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
        LaneMask hidden = lanes_hidden(&group, live, from);
        *dark |= hidden;
        live &= ~hidden;
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
typedef struct ShadowPlaces {
    float x[LANES], y[LANES];
    double z[LANES];
    uint16_t numbers[LANES];
    int n;
} ShadowPlaces;

/* Sets the circle about the places. */
LANE_FN void enclose(Departures *way)
{
    const Lanes sides[2] = {way->packet.x, way->packet.y};
    float half2 = 0;
    for (int c = 0; c < 2; c++) {
        float low = lanes_least(sides[c]), high = lanes_largest(sides[c]);
        way->packet.middle[c] = 0.5f * (low + high);
        half2 += (high - low) * (high - low);
    }
    way->packet.half = 0.501f * sqrtf(half2);
}

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
    enclose(way);
    return open < n;
}

/* Decides what is decided fast of the places from `first` on, and returns the lanes that are left.
 */
LANE_FN LaneMask decide_at_once(ShadowPoints *places, int first, Departures *way)
{
    LaneMask open = load_places(&places->x[first], &places->y[first], &places->z[first],
                                places->n - first, way);
    PacketSample at;
    Lanes margin;
    LaneMask dark = open & depart(way, open, &at, &margin);
    for (uint32_t left = lanes_bits(dark); left; left &= left - 1)
        places->state[first + __builtin_ctz(left)] = SHADOW_DARK;
    open &= ~dark;
    if (lanes_any(open))
        open &= ~lit_at_once(way, open, &at, margin);
    return open;
}

LANE_FN void set_states(ShadowPoints *places, const uint16_t *numbers, LaneMask which,
                        ShadowState state)
{
    for (uint32_t left = lanes_bits(which); left; left &= left - 1)
        places->state[numbers[__builtin_ctz(left)]] = (uint8_t)state;
}

/* Sets the terms beyond the places. */
LANE_FN void place_terms(Departures *way)
{
    const FieldTile *tile = way->packet.tile;
    way->packet.n = 0;
    for (size_t i = 0; i < tile->n_terms; i += LANES)
        for (uint32_t near = terms_ahead(way, i); near; near &= near - 1)
            add_to_packet(&way->packet, &tile->terms[i + (size_t)__builtin_ctz(near)]);
}

/* Decides the places that have been put off, and forgets them. */
LANE_FN void decide_by_march(ShadowPoints *places, ShadowPlaces *later, Departures *way)
{
    for (int lane = later->n; lane < LANES; lane++) {
        later->x[lane] = later->x[later->n - 1];
        later->y[lane] = later->y[later->n - 1];
        later->z[lane] = later->z[later->n - 1];
    }
    LaneMask open = load_places(later->x, later->y, later->z, later->n, way), dark = {0},
             unsure = {0};
    place_terms(way);
    if (way->packet.tile->groups) {
        look_through_union(way, &open, &dark, &unsure);
    } else {
        way->packet.n_sum = way->packet.n;
        for (size_t i = 0; i < way->packet.n; i++)
            way->packet.sum[i] = &way->packet.terms[i];
        look_through_sum(way, &open, &dark, &unsure);
    }
    set_states(places, later->numbers, unsure, SHADOW_UNSURE);
    set_states(places, later->numbers, dark, SHADOW_DARK);
    later->n = 0;
}

LANE_FN void put_off(const ShadowPoints *places, int number, ShadowPlaces *later)
{
    int n = later->n++;
    later->x[n] = places->x[number];
    later->y[n] = places->y[number];
    later->z[n] = places->z[number];
    later->numbers[n] = (uint16_t)number;
}

LANE_TARGET void SHADOW_KERNEL(const FieldTile *tile, TileWork *work, ShadowPoints *places)
{
    ShadowPlaces later = {.n = 0};
    assert(tile->n_terms <= work->capacity);
    Departures way = {.packet = {.tile = tile, .terms = work->memory}, .blockers = work->memory};
    share_memory(&way.packet);
    __builtin_memset(places->state, SHADOW_LIT, (size_t)places->n);
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
