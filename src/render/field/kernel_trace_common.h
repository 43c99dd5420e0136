/* The common part of the kernels of kernel_trace.h and kernel_trace_flat.h, which include this
 * file: bounds of the rounding error, the axial factor of a term, and functions that store hits.
 *
 * A term of the potential is the contribution of one segment: a Gaussian of the distance from the
 * axis times the axial factor (erf(u) + erf(v)) / 2, where u and v are the signed distances along
 * the axis from the two ends, positive inside, times potential_k [field/field.h]. The kernels
 * compare the sum of the terms with the level of the surface. The margin is a bound of the error of
 * the computed sum. A ray whose sum is within the margin of the level is TILE_UNSURE and is decided
 * in double precision. */
#ifndef CORCAST_RENDER_FIELD_KERNEL_TRACE_COMMON_H
#define CORCAST_RENDER_FIELD_KERNEL_TRACE_COMMON_H

#include "render/field/fieldterms.h"
#include "render/tile/lanes.h"
#include "scene/scene.h"

/* The level of the surface, in single precision. */
#define LEVEL ((float)FIELD_LEVEL)
/* Maximum margin for which a kernel decides rays; with a larger margin all rays are TILE_UNSURE. It
 * is 0.1 % of the level; with about 190 terms of the potential the margin reaches this value. A
 * larger value leaves fewer rays to double precision. In kernel_trace.h it is also the deficit
 * (level minus potential) up to which Newton's method may complete any hit. */
#define MAX_MARGIN (1e-3f * LEVEL)
/* The three parts of the margin. MARGIN_DROPPED bounds the sum of the terms that were left out: it
 * is 20 terms at the cut-off, an allowance. MARGIN_TERM, 10 * 2^-24, bounds the rounding errors of
 * the arithmetic of one term. MARGIN_POSITION bounds the effect of rounded positions: one unit in
 * the last place, relative to the size of positions (`extent`), times the steepness of the term.
 * Larger values leave more rays to double precision; smaller ones would be wrong. */
#define MARGIN_DROPPED 2e-5f
#define MARGIN_TERM 6e-7f
#define MARGIN_POSITION 1.2e-7f
/* For arguments x above this, erf is 1 to 2e-8, and exp(-x^2) is 0 to 1.2e-7. */
#define SATURATED 4.0f

LANE_FN Lanes square(Lanes a)
{
    return a * a;
}

/* Computes twice the axial factor of a term, erf(u) + erf(v), and exp(-u^2) - exp(-v^2). There is
 * no branch for ends that are out of reach of all lanes, because a branch that is predicted wrongly
 * costs more than it saves. */
LANE_FN void axial_factors(Lanes u, Lanes v, Lanes *ends, Lanes *ends_slope)
{
    Lanes gauss_u = lanes_exp_minus(square(u)), gauss_v = lanes_exp_minus(square(v));
    *ends = lanes_erf(u, gauss_u) + lanes_erf(v, gauss_v);
    *ends_slope = gauss_u - gauss_v;
}

/* The gradient of the potential at a hit, and the segment of the largest term. */
typedef struct Gradient {
    Lanes x, y, z;
    Lanes largest;    /* value of the largest term so far */
    LaneMask segment; /* index of the segment of the largest term */
} Gradient;

/* Replaces the largest term of *sum where `value`, the value of `term`, is larger. Of equal terms,
 * the term with the lowest segment index is kept. */
LANE_FN void keep_largest(const TileTerm *term, Lanes value, Gradient *sum)
{
    int32_t segment = (int32_t)term->segment;
    LaneMask larger = (value > sum->largest) | ((value == sum->largest) & (segment < sum->segment));
    sum->largest = lanes_select(larger, value, sum->largest);
    sum->segment = (larger & segment) | (~larger & sum->segment);
}

/* Computes the outward unit normal, which is opposite to the gradient. */
LANE_FN void outward_normal(const Gradient *at, Lanes normal[3])
{
    Lanes outward = -1.0f / lanes_sqrt(square(at->x) + square(at->y) + square(at->z));
    normal[0] = at->x * outward;
    normal[1] = at->y * outward;
    normal[2] = at->z * outward;
}

/* Sets the depths of the lanes `hit` to base + z. Processes half of the lanes at a time, because
 * doubles are twice as wide. */
LANE_FN void store_depths(LaneMask hit, double base, Lanes z, double *depths)
{
    enum { HALF = LANES / 2 };
    typedef float Floats __attribute__((vector_size(4 * HALF)));
    typedef int32_t Masks __attribute__((vector_size(4 * HALF)));
    typedef double Doubles __attribute__((vector_size(8 * HALF)));
    typedef int64_t LongMasks __attribute__((vector_size(8 * HALF)));
    Floats floats[2];
    Masks masks[2];
    __builtin_memcpy(floats, &z, sizeof z);
    __builtin_memcpy(masks, &hit, sizeof hit);
    for (int half = 0; half < 2; half++) {
        Doubles here = __builtin_convertvector(floats[half], Doubles) + base, old;
        LongMasks mine = __builtin_convertvector(masks[half], LongMasks);
        __builtin_memcpy(&old, depths + half * HALF, sizeof old);
        here = (Doubles)(((LongMasks)here & mine) | ((LongMasks)old & ~mine));
        __builtin_memcpy(depths + half * HALF, &here, sizeof here);
    }
}

/* Sets the state of the lanes `hit` to TILE_HIT, by OR: none of them may be TILE_UNSURE. Processes
 * four lanes at a time. */
LANE_FN void store_states(LaneMask hit, uint8_t *states)
{
    static const uint8_t sets[16][4] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0},
                                        {0, 0, 1, 0}, {1, 0, 1, 0}, {0, 1, 1, 0}, {1, 1, 1, 0},
                                        {0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1},
                                        {0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};
    /* sets[mask] has TILE_HIT for each of the four lanes in the mask. */
    _Static_assert(TILE_HIT == 1, "the sets are of hits");
    for (int i = 0; i < LANES; i += 4) {
        uint32_t set, old;
        __builtin_memcpy(&set, sets[lanes_bits(hit) >> i & 15], sizeof set);
        __builtin_memcpy(&old, states + i, sizeof old);
        old |= set;
        __builtin_memcpy(states + i, &old, sizeof old);
    }
}

/* Stores the hits of the packet that begins at sample `first`, at the depths base + z. If the tile
 * has blend groups, a ray keeps the state TILE_UNSURE, and of two hits the nearer one. */
LANE_FN void store_hits(const FieldTile *tile, int first, LaneMask hit, double base, Lanes z,
                        const Lanes normal[3], LaneMask segment, TileHits *hits)
{
    double *depth = &hits->z[first];
    uint8_t *state = &hits->state[first];
    for (int lane = 0; tile->groups && lane < LANES; lane++)
        if (state[lane] == TILE_UNSURE ||
            (state[lane] == TILE_HIT && depth[lane] <= base + (double)z[lane]))
            hit[lane] = 0; /* undecided, or the hit of another group is nearer */
    store_depths(hit, base, z, depth);
    store_states(hit, state);
    hits->any_hit |= lanes_any(hit);
    for (int c = 0; c < 3; c++) {
        float *to = &hits->normal[c][first];
        lanes_store(to, lanes_select(hit, normal[c], lanes_load(to)));
    }
    LaneMask old;
    __builtin_memcpy(&old, &hits->segment[first], sizeof old);
    segment = (hit & segment) | (~hit & old);
    __builtin_memcpy(&hits->segment[first], &segment, sizeof segment);
}

/* Marks the rays `unsure` of the packet that starts at sample `first` as TILE_UNSURE. */
LANE_FN void mark_unsure(int first, LaneMask unsure, TileHits *hits)
{
    for (int lane = 0; lane < LANES; lane++)
        if (unsure[lane])
            hits->state[first + lane] = TILE_UNSURE;
    hits->any_unsure = true;
}

#endif
