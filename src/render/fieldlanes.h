/* What the kernels of fieldkernel.h and fieldplane.h share: constants of the proof, the factor of a
 * segment's ends, and how hits are stored. */
#ifndef CORCAST_RENDER_FIELDLANES_H
#define CORCAST_RENDER_FIELDLANES_H

#include "render/fieldtile.h"
#include "render/lanes.h"
#include "scene/scene.h"

#define LEVEL ((float)FIELD_LEVEL)
/* No more than this may the margin be, and the lack of potential at which a hit that is just certain
 * is closed by Newton's method. */
#define CLOSE_ENOUGH (1e-3f * LEVEL)
/* The margin: a part for terms left out, one for each term's arithmetic, and one for the rounding
 * of places, in units of the last place of the packet's extent. */
#define MARGIN_DROPPED 2e-5f
#define MARGIN_TERM 6e-7f
#define MARGIN_PLACE 1.2e-7f
/* From here on erf is 1 and its derivative 0, to 2e-8. */
#define SATURATED 4.0f

LANE_FN Lanes square(Lanes a)
{
    return a * a;
}

/* The axial factor of a term, twice, and exp(-u^2) - exp(-v^2). */
LANE_FN void axial_factors(Lanes u, Lanes v, Lanes *ends, Lanes *ends_slope)
{
    *ends = lanes_set(2);
    *ends_slope = lanes_set(0);
    if (lanes_any(u < SATURATED)) {
        Lanes gauss = lanes_exp_minus(square(u));
        *ends = lanes_erf(u, gauss) + 1.0f;
        *ends_slope = gauss;
    }
    if (lanes_any(v < SATURATED)) {
        Lanes gauss = lanes_exp_minus(square(v));
        *ends += lanes_erf(v, gauss) - 1.0f;
        *ends_slope -= gauss;
    }
}

/* What the picture needs of a hit. */
typedef struct Gradient {
    Lanes x, y, z;
    Lanes largest; /* term */
    LaneMask segment;
} Gradient;

LANE_FN void name_largest(const TileTerm *term, Lanes value, Gradient *sum)
{
    int32_t segment = (int32_t)term->segment;
    LaneMask larger = (value > sum->largest) | ((value == sum->largest) & (segment < sum->segment));
    sum->largest = lanes_select(larger, value, sum->largest);
    sum->segment = (larger & segment) | (~larger & sum->segment);
}

/* Stores the hits at base + z of the packet that begins at sample `first`. */
LANE_FN void store_hits(const FieldTile *tile, int first, LaneMask hit, double base, Lanes z,
                        const Gradient *at, TileHits *hits)
{
    double *depth = &hits->z[first];
    uint8_t *state = &hits->state[first];
    for (int lane = 0; tile->blend->first && lane < LANES; lane++)
        if (state[lane] == TILE_UNSURE ||
            (state[lane] == TILE_HIT && depth[lane] <= base + (double)z[lane]))
            hit[lane] = 0; /* another sum's hit is nearer */
    for (int lane = 0; lane < LANES; lane++) {
        uint64_t here, old, mine = (uint64_t)(int64_t)hit[lane];
        double place = base + (double)z[lane];
        __builtin_memcpy(&here, &place, sizeof here);
        __builtin_memcpy(&old, &depth[lane], sizeof old);
        here = (here & mine) | (old & ~mine);
        __builtin_memcpy(&depth[lane], &here, sizeof here);
        state[lane] |= (uint8_t)(hit[lane] & TILE_HIT);
    }
    hits->any_hit |= lanes_any(hit);
    Lanes outward = -1.0f / lanes_sqrt(square(at->x) + square(at->y) + square(at->z));
    const Lanes normal[3] = {at->x * outward, at->y * outward, at->z * outward};
    for (int c = 0; c < 3; c++) {
        float *to = &hits->normal[c][first];
        lanes_store(to, lanes_select(hit, normal[c], lanes_load(to)));
    }
    LaneMask segment;
    __builtin_memcpy(&segment, &hits->segment[first], sizeof segment);
    segment = (hit & at->segment) | (~hit & segment);
    __builtin_memcpy(&hits->segment[first], &segment, sizeof segment);
}

/* Leaves rays of the packet that begins at sample `first` to double precision. */
LANE_FN void give_up(int first, LaneMask unsure, TileHits *hits)
{
    for (int lane = 0; lane < LANES; lane++)
        if (unsure[lane])
            hits->state[first + lane] = TILE_UNSURE;
    hits->any_unsure = true;
}

#endif
