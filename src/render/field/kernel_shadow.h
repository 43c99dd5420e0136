/* The kernel FieldKernels.shadow: decides for LANES points at once whether a blocker is between the
 * point and the light. A source includes kernel_trace.h first, whose march, runs and windows are
 * used here, and includes this file once. A term is the contribution of one segment to the
 * potential Phi; kernel_packet.h defines E, w, B and M.
 *
 * The lines of sight lead from the points to the light, in the direction of ascending z. A point is
 * dark if Phi exceeds the level anywhere on its line. Most points are lit, and a fast test in two
 * steps proves this:
 *
 * 1. Phi at the point, its slope and the bound M of its second derivative give the interval on
 *    which Phi stays below the level, as in a step of the march of kernel_trace.h.
 * 2. For each term there is an upper bound from the end of this interval on (bound_beyond). A point
 *    is lit if the sum of these bounds is below the level. A term of the potential is a Gaussian
 *    convolved with a segment. Where the line recedes from the axis line, the term is at most
 *    exp(-E^2 - w^2). At the distance x before the end that the line runs towards, the term is at
 *    most (1 + erf x) / 2 of this; at x beyond this end, at most exp(-E^2 - w^2 - x^2) / 2.
 *    Elsewhere it is at most B.
 *
 * A second fast test proves that a point is dark: one term alone exceeds the level
 * (term_ensures_hit). Both fast tests evaluate a term only at the points, and store little of it.
 * Terms that are out of reach of a whole packet are skipped first, several at once.
 *
 * The undecided points are collected and tested in full packets. First, Phi is computed at one
 * position: where the line passes the term with the largest bound. Then the lines are marched; each
 * step may prove that the point is lit or dark.
 *
 * A point on the surface has a rounded position, so it may be inside its own vessel. Therefore SKIN
 * times the level replaces the level while the line leaves the surface, until Phi is below RIM
 * times the level. A sum of bounds counts as below the level if it is below SURELY_BELOW. */

/* RIM and SKIN are 0.2 % of the level to either side of it. The points are hits: their potential
 * differs from the level by less than 0.1 % (MAX_MARGIN), plus the error of the rounded position. A
 * wider band would let the shadows of near vessels begin too far from them. SURELY_BELOW leaves
 * 0.1 % for the rounding errors of the bounds themselves. */
#define RIM 0.998f
#define SKIN 1.002f
#define SURELY_BELOW (0.999f * LEVEL)

/* The data of a term that its bound beyond the points needs. Lengths in units of 1 / k. */
typedef struct Blocker {
    Lanes w, w1;        /* w at the point; dw/dz, >= 0 */
    Lanes end_distance; /* distance along the axis from the point to the end that the line runs
                         * towards; negative beyond it */
    Lanes u1;           /* -d(end_distance)/dz, >= 0 */
    Lanes e2, peak;     /* E^2; B */
} Blocker;

/* LANES points, and the terms along the rays from the points to the light. */
typedef struct ShadowPacket {
    Packet packet;
    Blocker *blockers; /* one per term ahead; in the memory of packet.terms, which the fast tests do
                        * not use */
    size_t n_blockers;
    double base;    /* depth that is subtracted from z, `from` and `to`, mm */
    Lanes z;        /* depths of the points */
    float from, to; /* smallest and largest z */
} ShadowPacket;

/* Returns a bit mask of the terms, among the LANES terms from `first` on, that may exceed the
 * cut-off in the packet and are not entirely behind its points. */
LANE_FN uint32_t terms_ahead(const ShadowPacket *rays, size_t first)
{
    const FieldTile *tile = rays->packet.tile;
    uint32_t ahead = 0;
    for (uint32_t left = terms_near(&rays->packet, first); left; left &= left - 1) {
        int lane = __builtin_ctz(left);
        bool is_ahead = tile->terms[first + (size_t)lane].z_end >= rays->base + (double)rays->from;
        ahead |= (uint32_t)is_ahead << lane;
    }
    return ahead;
}

/* Stores the term as a blocker, and adds its value at the points to *at. *extent is the largest |z|
 * of an added term so far; rounding errors of positions are proportional to it. */
FOLDED_FN void add_blocker(ShadowPacket *rays, PacketTerm *term, LaneMask open, PacketSample *at,
                           float *extent)
{
    const RayPoint place = point_at(term, rays->z - term->z);
    rays->blockers[rays->n_blockers++] =
        (Blocker){.w = place.w,
                  .w1 = term->w1,
                  .end_distance = lanes_select(term->u1 > 0.0f, place.v, place.u),
                  .u1 = lanes_abs(term->u1),
                  .e2 = term->e2,
                  .peak = term->peak};
    if (term->z_range[0] > rays->to) {
        at->next = lanes_min(at->next, lanes_set(term->z_range[0]));
        return;
    }
    if (!exceeds_cutoff(term, open))
        return;
    bound_curvature(term);
    TermSample one = sample_once(term, &place);
    add_sample(&one, open, term, at);
    float far = fabsf(term->z);
    *extent = far > *extent ? far : *extent;
}

/* Computes the blockers, Phi at the points and its margin. Returns the lanes on which one term
 * alone proves that the point is dark. If it returns all open lanes, the other results are
 * incomplete. */
LANE_FN LaneMask sample_at_points(ShadowPacket *rays, LaneMask open, PacketSample *at,
                                  Lanes *margin)
{
    const FieldTile *tile = rays->packet.tile;
    LaneMask dark = {0};
    float extent = 0, width = tile->half_size;
    rays->n_blockers = 0;
    *at = nothing_sampled();
    *margin = lanes_set(0);
    for (size_t i = 0; i < tile->n_terms; i += LANES)
        for (uint32_t near = terms_ahead(rays, i); near; near &= near - 1) {
            PacketTerm term;
            if (!place_term(&rays->packet, &tile->terms[i + (size_t)__builtin_ctz(near)], &term))
                continue;
            set_depths(&term, rays->base);
            dark |= term_ensures_hit(&term, rays->z, tile->n_terms);
            if (!lanes_any(open & ~dark))
                return dark;
            add_blocker(rays, &term, open, at, &extent);
        }
    if (tile->perspective)
        width *= (float)fabs(rays->base);
    *margin = at->steepness * ((extent + width + rays->to - rays->from) * MARGIN_POSITION) +
              fixed_margin(rays->n_blockers);
    return dark;
}

/* Returns the open lanes (undecided points) that the first fast test proves lit. The minimum 1e-30
 * of the curvature avoids 0 / 0. */
LANE_FN LaneMask lit_at_once(const ShadowPacket *rays, LaneMask open, const PacketSample *at,
                             Lanes margin)
{
    LaneMask leaving = at->phi > RIM * LEVEL;
    Lanes safe =
        lanes_select(leaving, lanes_set(SKIN * LEVEL), lanes_set(LEVEL)) - at->phi - margin;
    open &= (safe > 0.0f) & (margin <= MAX_MARGIN);
    if (!lanes_any(open))
        return open;
    Lanes curvature = lanes_max(at->curvature, lanes_set(1e-30f)), slope = at->slope;
    Lanes root =
        lanes_sqrt(lanes_fma(slope, slope, 2.0f * curvature * lanes_max(safe, lanes_set(0))));
    Lanes step =
        lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
    step = lanes_min(step, at->next - rays->z);
    Lanes sum = lanes_set(fixed_margin(rays->n_blockers));
    for (size_t i = 0; i < rays->n_blockers; i++) {
        const Blocker *term = &rays->blockers[i];
        Lanes beyond = bound_beyond(term->e2, lanes_fma(term->w1, step, term->w),
                                    lanes_fma(term->u1, -step, term->end_distance));
        sum += lanes_min(beyond, term->peak);
    }
    return open & (sum < SURELY_BELOW);
}

/* Returns the sum of the terms at z, like sample_at, and sets *beyond to an upper bound of Phi from
 * z on. */
LANE_FN PacketSample sample_departing(const TermRun *run, Lanes z, LaneMask live, Lanes *beyond)
{
    PacketSample sample = nothing_sampled();
    *beyond = lanes_set(0);
    for (size_t i = 0; i < run->n; i++) {
        const PacketTerm *term = run->terms[i];
        LaneMask here = lanes_reached(term, z, live, &sample.next);
        *beyond = lanes_add_where(z < term->reach[0], *beyond, term->peak);
        if (!lanes_any(here))
            continue;
        BoundedSample there = bounded_sample(term, z);
        add_sample(&there.at, here, term, &sample);
        *beyond = lanes_add_where(here, *beyond, there.bound);
    }
    return sample;
}

/* Marches the live lanes from z on, until each is proven dark, proven lit or given up, which adds
 * it to *unsure. `leaving`: the lanes whose point is on the surface, which their line leaves. */
LANE_FN void march_to_light(const TermRun *run, LaneMask live, LaneMask leaving, Lanes z,
                            LaneMask *dark, LaneMask *unsure)
{
    for (int steps = 0; lanes_any(live); steps++) {
        Lanes beyond;
        PacketSample at = sample_departing(run, z, live, &beyond);
        Lanes margin = margin_at(run, &at, z);
        live &= ~(beyond + margin < SURELY_BELOW);
        leaving &= at.phi > RIM * LEVEL;
        Lanes level = lanes_select(leaving, lanes_set(SKIN * LEVEL), lanes_set(LEVEL));
        Lanes deficit = level - at.phi, safe = deficit - margin, slope = at.slope;
        Lanes curvature = lanes_max(at.curvature, lanes_set(1e-30f)), slope2 = square(slope);
        LaneMask rises =
            (slope > 0.0f) & (slope2 >= CROSSING_FACTOR * curvature * (deficit + margin));
        LaneMask met = live & ~leaving & ((deficit <= -margin) | rises) & (margin <= MAX_MARGIN);
        *dark |= met;
        live &= ~met;
        Lanes root = lanes_sqrt(lanes_max(slope2 + 2.0f * curvature * safe, lanes_set(0)));
        Lanes step =
            lanes_select(slope > 0.0f, 2.0f * safe / (slope + root), (root - slope) / curvature);
        Lanes to = lanes_min(z + step, at.next);
        LaneMask stuck = live & ~((safe > 0.0f) & (to > z) & (margin <= MAX_MARGIN));
        if (steps == MAX_STEPS)
            stuck = live;
        *unsure |= stuck;
        to = lanes_select(leaving, to, next_window(run, to));
        live &= ~stuck & (to < 1e30f);
        z = lanes_select(live, to, z);
    }
}

/* Returns the live lanes whose potential exceeds the level at one tested point. The point is the
 * middle of a window beyond z, the window of the term with the largest bound. */
LANE_FN LaneMask dark_in_window(const TermRun *run, LaneMask live, Lanes z)
{
    Lanes largest = lanes_set(0), middle = lanes_set(1e30f);
    for (size_t i = 0; i < run->n; i++) {
        const PacketTerm *term = run->terms[i];
        Lanes there = 0.5f * (term->window[0] + term->window[1]);
        LaneMask larger = (there > z) & (term->peak > largest);
        largest = lanes_select(larger, term->peak, largest);
        middle = lanes_select(larger, there, middle);
    }
    PacketSample at = sample_at(run, middle, live);
    Lanes margin = margin_at(run, &at, middle);
    return live & (at.phi - margin >= SKIN * LEVEL) & (margin <= MAX_MARGIN);
}

/* Sorts the selected terms by ascending z_begin. */
LANE_FN void sort_selected(const Packet *packet)
{
    for (size_t i = 1; i < packet->n_selected; i++) {
        PacketTerm *term = packet->selected[i];
        size_t hole = i;
        for (; hole > 0 && packet->selected[hole - 1]->term->z_begin > term->term->z_begin; hole--)
            packet->selected[hole] = packet->selected[hole - 1];
        packet->selected[hole] = term;
    }
}

/* Decides for the open lanes whether the sum of the selected terms exceeds the level before the
 * light. */
LANE_FN void test_selected(const ShadowPacket *rays, LaneMask *open, LaneMask *dark,
                           LaneMask *unsure)
{
    const Packet *packet = &rays->packet;
    const double nearest = rays->base + (double)rays->from;
    sort_selected(packet);
    for (size_t i = 0; i < packet->n_selected && lanes_any(*open);) {
        TermRun run;
        i = next_run(packet, i, nearest, &run);
        run.width += rays->to - rays->from;
        run.extent += rays->to - rays->from;
        LaneMask live = *open, stuck = {0};
        if (!set_windows(&run, &live))
            continue;
        Lanes from = rays->z + (float)(rays->base - run.base);
        Lanes start = next_window(&run, lanes_set(-1e30f));
        live &= next_window(&run, from) < 1e30f;
        LaneMask proven = dark_in_window(&run, live, from);
        *dark |= proven;
        live &= ~proven;
        march_to_light(&run, live, start <= from, lanes_max(start, from), dark, &stuck);
        *unsure |= stuck;
        *open &= ~*dark;
    }
}

/* Calls test_selected for each blend group. */
LANE_FN void test_groups(ShadowPacket *rays, LaneMask *open, LaneMask *dark, LaneMask *unsure)
{
    size_t n_groups = find_groups(&rays->packet);
    for (size_t group = 0; group < n_groups; group++) {
        select_group(&rays->packet, group);
        test_selected(rays, open, dark, unsure);
    }
}

/* Points of a tile that wait for the march, and their indices in the tile. */
typedef struct PendingPoints {
    float x[LANES], y[LANES];
    double z[LANES];
    uint16_t indices[LANES];
    int n;
} PendingPoints;

/* Computes the circle around the points of the packet. The factor 0.501 is 1/2 with a margin for
 * rounding. */
LANE_FN void enclose(ShadowPacket *rays)
{
    const Lanes sides[2] = {rays->packet.x, rays->packet.y};
    float half2 = 0;
    for (int c = 0; c < 2; c++) {
        float low = lanes_reduce_min(sides[c]), high = lanes_reduce_max(sides[c]);
        rays->packet.middle[c] = 0.5f * (low + high);
        half2 += (high - low) * (high - low);
    }
    rays->packet.half = 0.501f * sqrtf(half2);
}

/* Loads LANES points, of which the first n are valid. Returns the mask of the valid lanes. */
LANE_FN LaneMask load_points(const float *x, const float *y, const double *z, int n,
                             ShadowPacket *rays)
{
    LaneMask open;
    for (int lane = 0; lane < LANES; lane++)
        open[lane] = lane;
    rays->base = z[0];
    rays->packet.x = lanes_load(x);
    rays->packet.y = lanes_load(y);
    rays->z = lanes_from_doubles_plus(z, -rays->base);
    rays->from = lanes_reduce_min(rays->z);
    rays->to = lanes_reduce_max(rays->z);
    enclose(rays);
    return open < n;
}

/* Decides those of the points [first, first + LANES) that the fast tests can decide. Returns the
 * other lanes. */
LANE_FN LaneMask decide_at_once(ShadowPoints *points, int first, ShadowPacket *rays)
{
    LaneMask open = load_points(&points->x[first], &points->y[first], &points->z[first],
                                points->n - first, rays);
    PacketSample at;
    Lanes margin;
    LaneMask dark = open & sample_at_points(rays, open, &at, &margin);
    for (uint32_t left = lanes_bits(dark); left; left &= left - 1)
        points->state[first + __builtin_ctz(left)] = SHADOW_DARK;
    open &= ~dark;
    if (lanes_any(open))
        open &= ~lit_at_once(rays, open, &at, margin);
    return open;
}

/* Sets the states of the lanes `which`. */
LANE_FN void set_states(ShadowPoints *points, const uint16_t *indices, LaneMask which,
                        ShadowState state)
{
    for (uint32_t left = lanes_bits(which); left; left &= left - 1)
        points->state[indices[__builtin_ctz(left)]] = (uint8_t)state;
}

/* Computes the terms ahead of the points. */
LANE_FN void place_terms(ShadowPacket *rays)
{
    const FieldTile *tile = rays->packet.tile;
    rays->packet.n = 0;
    for (size_t i = 0; i < tile->n_terms; i += LANES)
        for (uint32_t near = terms_ahead(rays, i); near; near &= near - 1)
            add_to_packet(&rays->packet, &tile->terms[i + (size_t)__builtin_ctz(near)]);
}

/* Decides the collected points by a march, and empties their list. */
LANE_FN void decide_by_march(ShadowPoints *points, PendingPoints *later, ShadowPacket *rays)
{
    for (int lane = later->n; lane < LANES; lane++) {
        later->x[lane] = later->x[later->n - 1];
        later->y[lane] = later->y[later->n - 1];
        later->z[lane] = later->z[later->n - 1];
    }
    LaneMask open = load_points(later->x, later->y, later->z, later->n, rays), dark = {0},
             unsure = {0};
    place_terms(rays);
    if (rays->packet.tile->groups) {
        test_groups(rays, &open, &dark, &unsure);
    } else {
        select_all(&rays->packet);
        test_selected(rays, &open, &dark, &unsure);
    }
    set_states(points, later->indices, unsure, SHADOW_UNSURE);
    set_states(points, later->indices, dark, SHADOW_DARK);
    later->n = 0;
}

/* Appends a point to the list. */
LANE_FN void postpone(const ShadowPoints *points, int index, PendingPoints *later)
{
    int n = later->n++;
    later->x[n] = points->x[index];
    later->y[n] = points->y[index];
    later->z[n] = points->z[index];
    later->indices[n] = (uint16_t)index;
}

/* FieldKernels.shadow: sets the state of the tile's points [ShadowKernel]. */
LANE_TARGET static void LANES_NAME(shadow)(const FieldTile *tile, void *work, ShadowPoints *points)
{
    PendingPoints later = {.n = 0};
    ShadowPacket rays = {.packet = {.tile = tile, .terms = work}, .blockers = work};
    divide_workspace(&rays.packet);
    __builtin_memset(points->state, SHADOW_LIT, (size_t)points->n);
    for (int first = 0; first < points->n; first += LANES)
        for (uint32_t open = lanes_bits(decide_at_once(points, first, &rays)); open;
             open &= open - 1) {
            postpone(points, first + __builtin_ctz(open), &later);
            if (later.n == LANES)
                decide_by_march(points, &later, &rays);
        }
    if (later.n)
        decide_by_march(points, &later, &rays);
}
