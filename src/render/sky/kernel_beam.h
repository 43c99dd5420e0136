/* Beams, sixteen capsules at a time: included by each source that compiles it for its lanes. Loops
 * over capsules have no branches, for compilers to make vectors of. */
#ifndef BEAM_KERNEL
#error "define BEAM_KERNEL(name), the name of a function"
#endif

#include "render/sky/beamkernels.h"
#include "render/tile/lanes.h"

/* Beams side by side are one; this is what a tile's capsules, LANES at a time, leave of it. */
typedef struct Beam {
    Lanes x, y, z;  /* where it begins */
    Lanes widening; /* of half its width with length */
    Lanes wide;     /* the most of that */
} Beam;

/* Multiplies free[LANES] by what capsules leave of the beam, which is a square, as wide as where it
 * passes the axis: a capsule covers a strip of it between its ends. */
LANE_FN void pass_capsules(const CapsuleBlock *block, int first, const Beam *beam, float *free)
{
    const Lanes zero = lanes_set(0);
    Lanes qx = beam->x - lanes_load(&block->x[first]), qy = beam->y - lanes_load(&block->y[first]);
    Lanes ux = lanes_load(&block->ux[first]), uy = lanes_load(&block->uy[first]);
    Lanes radius = lanes_load(&block->radius[first]), whole = lanes_load(&block->length[first]);
    Lanes along = qx * ux + qy * uy, off = lanes_abs(qy * ux - qx * uy);
    Lanes on = lanes_max(lanes_min(along, whole), zero);
    Lanes height = lanes_load(&block->z[first]) + on * lanes_load(&block->slope[first]) - beam->z;
    Lanes half = lanes_max(lanes_min(height * beam->widening, beam->wide), lanes_set(1e-6f));
    Lanes chord = lanes_sqrt(lanes_max(radius * radius - off * off, zero));
    Lanes end = lanes_select(half < radius, chord, lanes_load(&block->round[first]));
    Lanes across = lanes_min(off + radius, half) - lanes_max(off - radius, -half);
    Lanes length = lanes_min(whole - along + end, half) - lanes_max(-along - end, -half);
    Lanes covered = lanes_max(across, zero) * lanes_max(length, zero) / (4.0f * half * half);
    Lanes left = lanes_load(free) * (1.0f - covered);
    lanes_store(free, lanes_select(height > 0.0f, left, lanes_load(free)));
}

/* The part of a beam that the blocks [first, end) leave free. */
LANE_FN float pass_blocks(const BeamView *view, uint32_t first, uint32_t end, const Beam *beam)
{
    float free[CAPSULES], all = 1;
    for (int i = 0; i < CAPSULES; i++)
        free[i] = 1;
    for (uint32_t block = first; block < end; block++)
        for (int i = 0; i < CAPSULES; i += LANES)
            pass_capsules(&view->blocks[block], i, beam, &free[i]);
    for (int i = 0; i < CAPSULES; i++)
        all *= free[i];
    return all;
}

LANE_FN int32_t beam_tile(float at, float first, float per_tile, int32_t count)
{
    float tile = (at - first) * per_tile;
    return tile >= 0 && tile < (float)count ? (int32_t)tile : -1;
}

LANE_TARGET static void BEAM_KERNEL(open)(const BeamView *view, float wide, BeamQueries *queries)
{
    for (int i = 0; i < queries->n; i++) {
        float at[3];
        for (int c = 0; c < 3; c++)
            at[c] = view->axes[c][0] * queries->at[0][i] + view->axes[c][1] * queries->at[1][i] +
                    view->axes[c][2] * queries->at[2][i];
        int32_t column = beam_tile(at[0], view->left, view->per_tile, view->columns);
        int32_t row = beam_tile(at[1], view->top, view->per_tile, view->rows);
        queries->open[i] = 1;
        if (column < 0 || row < 0)
            continue;
        const uint32_t *first = &view->first[row * view->columns + column];
        const Beam beam = {.x = lanes_set(at[0]),
                           .y = lanes_set(at[1]),
                           .z = lanes_set(at[2]),
                           .widening = lanes_set(queries->widening[i]),
                           .wide = lanes_set(wide)};
        queries->open[i] = pass_blocks(view, first[0], first[1], &beam);
    }
}

LANE_TARGET static void BEAM_KERNEL(sum)(const float *cosines, const uint8_t *answers, int n,
                                         float part, float sums[2])
{
    float open[SUMMED] = {0}, all[SUMMED] = {0};
    for (int k = 0; k < n; k += SUMMED)
        for (int i = 0; i < SUMMED; i++) {
            float cosine = cosines[k + i];
            cosine *= (float)((cosine > 0) & (answers[k + i] != BEAM_UNASKED));
            open[i] += cosine * (float)answers[k + i];
            all[i] += cosine;
        }
    for (int i = 1; i < SUMMED; i++) {
        open[0] += open[i];
        all[0] += all[i];
    }
    sums[0] += part * open[0];
    sums[1] += part * all[0];
}

LANE_TARGET static void BEAM_KERNEL(cosines)(const float *const directions[3],
                                             const float normal[3], int n, float *cosines)
{
    const float x = normal[0], y = normal[1], z = normal[2];
    for (int k = 0; k < n; k++)
        cosines[k] = x * directions[0][k] + y * directions[1][k] + z * directions[2][k];
}

const BeamKernels BEAM_KERNEL(beamkernels) = {
    .open = BEAM_KERNEL(open), .cosines = BEAM_KERNEL(cosines), .sum = BEAM_KERNEL(sum)};
