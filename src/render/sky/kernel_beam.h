/* Beams, several at a time: included by each source that compiles it for its lanes. Loops over
 * lanes have no branches, for compilers to make vectors of.
 *
 * Beams of one direction are sorted into a grid across it, where they begin, and each capsule in
 * turn takes what it covers from those in the cells that it can touch: those of a row stand one
 * after another, to be taken many at once. The other way about, capsules in tiles for beams to ask,
 * beams that lie side by side seldom touch the same ones. */
#ifndef BEAM_KERNEL
#error "define BEAM_KERNEL(name), the name of a function"
#endif

#include "render/sky/beamkernels.h"
#include "render/tile/lanes.h"

/* Of a ball far away, that is drawn as a square. */
static const float quarter_turn = 0.7853982f;

static inline float least_of(float a, float b)
{
    return a < b ? a : b;
}

static inline float most_of(float a, float b)
{
    return a > b ? a : b;
}

/* ---- capsules -------------------------------------------------------------------------------- */

LANE_FN Lanes along_axis(const float axis[3], const float point[3][BEAM_BLOCK], int first)
{
    return axis[0] * lanes_load(&point[0][first]) + axis[1] * lanes_load(&point[1][first]) +
           axis[2] * lanes_load(&point[2][first]);
}

/* Sees LANES of a block's capsules. As bits, those that may cover a beam: they stand above one, and
 * their bounds, wider by `reach`, are over the grid. */
LANE_FN uint32_t see_lanes(const BeamDirection *direction, const CapsuleBlock *block, int i,
                           const BeamWork *work, float reach, SeenBlock *seen)
{
    const Lanes zero = lanes_set(0);
    Lanes radius = lanes_load(&block->radius[i]);
    Lanes ax = along_axis(direction->axes[0], block->a, i);
    Lanes ay = along_axis(direction->axes[1], block->a, i);
    Lanes az = along_axis(direction->axes[2], block->a, i);
    Lanes bx = along_axis(direction->axes[0], block->b, i);
    Lanes by = along_axis(direction->axes[1], block->b, i);
    Lanes bz = along_axis(direction->axes[2], block->b, i);
    Lanes far = 1.5f * (radius + reach);
    LaneMask over =
        (radius >= 0.0f) & (lanes_max(az, bz) > work->low[2]) &
        (lanes_max(ax, bx) + far > work->low[0]) & (lanes_min(ax, bx) - far < work->high[0]) &
        (lanes_max(ay, by) + far > work->low[1]) & (lanes_min(ay, by) - far < work->high[1]);
    if (!lanes_any(over))
        return 0;
    LaneMask falls = az > bz;
    Lanes x = lanes_select(falls, ax - bx, bx - ax), y = lanes_select(falls, ay - by, by - ay);
    Lanes length = lanes_sqrt(x * x + y * y);
    /* One that points to the sky is a ball at its upper end. */
    LaneMask stands = length < 1e-3f * radius, from_b = falls ^ stands;
    lanes_store(&seen->x[i], lanes_select(from_b, bx, ax));
    lanes_store(&seen->y[i], lanes_select(from_b, by, ay));
    lanes_store(&seen->z[i], lanes_select(from_b, bz, az));
    lanes_store(&seen->ux[i], lanes_select(stands, lanes_set(1), x / length));
    lanes_store(&seen->uy[i], lanes_select(stands, zero, y / length));
    lanes_store(&seen->length[i], lanes_select(stands, zero, length));
    lanes_store(&seen->slope[i], lanes_select(stands, zero, lanes_abs(bz - az) / length));
    lanes_store(&seen->radius[i], radius);
    lanes_store(&seen->round[i], lanes_select(stands, quarter_turn * radius, zero));
    return lanes_bits(over);
}

/* ---- beams ----------------------------------------------------------------------------------- */

/* LANES of the places as the direction sees them, and how much each faces it. */
LANE_FN Lanes see_places(const BeamDirection *direction, const BeamPlaces *places, uint32_t first,
                         Lanes at[3])
{
    const float(*axes)[3] = direction->axes;
    Lanes facing = lanes_set(0);
    for (int i = 0; i < 3; i++)
        at[i] = axes[i][0] * lanes_load(&places->at[0][first]) +
                axes[i][1] * lanes_load(&places->at[1][first]) +
                axes[i][2] * lanes_load(&places->at[2][first]);
    for (int c = 0; c < 3; c++)
        facing = facing + axes[2][c] * lanes_load(&places->normal[c][first]);
    return facing;
}

/* Sets between what the places lie that face the direction: false if none does. */
LANE_FN bool bound_beams(const BeamDirection *direction, const BeamPlaces *places, BeamWork *work)
{
    Lanes low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = lanes_set(HUGE_VALF);
        high[i] = -low[i];
    }
    for (uint32_t first = 0; first < places->n; first += LANES) {
        Lanes at[3];
        LaneMask faces = see_places(direction, places, first, at) > 0.0f;
        for (int i = 0; i < 3; i++) {
            low[i] = lanes_select(faces, lanes_min(low[i], at[i]), low[i]);
            high[i] = lanes_select(faces, lanes_max(high[i], at[i]), high[i]);
        }
    }
    for (int i = 0; i < 3; i++) {
        work->low[i] = lanes_least(low[i]);
        work->high[i] = lanes_largest(high[i]);
    }
    return work->low[0] <= work->high[0];
}

/* Sets a grid of squares over the beams, a few a cell. */
static inline void set_grid(const BeamPlaces *places, float wide, BeamWork *work)
{
    const float a_cell = 12;
    float width = work->high[0] - work->low[0], height = work->high[1] - work->low[1];
    float side = most_of(wide, sqrtf(a_cell * width * height / (float)(places->n + 1)));
    side = most_of(most_of(side, most_of(width, height) / (BEAM_MOST_CELLS - 1)), 1e-6f);
    work->per_cell = 1 / side;
    work->columns = (int)(width / side) + 1;
    work->rows = (int)(height / side) + 1;
}

LANE_FN int cell_along(float at, float first, float per_cell, int n)
{
    float cell = (at - first) * per_cell;
    return cell < 0 ? 0 : cell < (float)n ? (int)cell : n - 1;
}

/* Lists the places whose surface faces the direction, and counts those of each cell; those that the
 * ground hides it from get their answers, as do the others. */
LANE_FN void list_beams(const BeamDirection *direction, const BeamPlaces *places, BeamWork *work,
                        uint8_t *answers)
{
    BeamList *listed = &work->listed;
    float x[LANES], y[LANES], z[LANES], widening[LANES];
    uint32_t n = 0;
    for (uint32_t first = 0; first < places->n; first += LANES) {
        Lanes at[3], facing = see_places(direction, places, first, at);
        LaneMask faces = facing > 0.0f;
        LaneMask hidden = faces & (lanes_load(&places->above[first]) * direction->ground < 0.0f);
        uint32_t grounded = lanes_bits(hidden);
        lanes_store(x, at[0]);
        lanes_store(y, at[1]);
        lanes_store(z, at[2]);
        lanes_store(widening, lanes_min(facing, lanes_set(direction->widening)));
        for (uint32_t i = 0; i < LANES && first + i < places->n; i++)
            answers[first + i] = grounded >> i & 1 ? 0 : BEAM_UNASKED;
        for (uint32_t asks = lanes_bits(faces & ~hidden); asks; asks &= asks - 1, n++) {
            int i = __builtin_ctz(asks);
            int column = cell_along(x[i], work->low[0], work->per_cell, work->columns);
            int row = cell_along(y[i], work->low[1], work->per_cell, work->rows);
            listed->x[n] = x[i];
            listed->y[n] = y[i];
            listed->z[n] = z[i];
            listed->widening[n] = widening[i];
            listed->place[n] = first + (uint32_t)i;
            listed->cell[n] = (uint32_t)(row * work->columns + column);
            work->first[listed->cell[n] + 1]++;
        }
    }
    work->n = n;
}

/* Sorts what is listed into cells. */
LANE_FN void sort_beams(BeamWork *work)
{
    const BeamList *listed = &work->listed;
    BeamList *sorted = &work->sorted;
    uint32_t n_cells = (uint32_t)(work->columns * work->rows);
    for (uint32_t cell = 0; cell < n_cells; cell++)
        work->first[cell + 1] += work->first[cell];
    for (uint32_t i = 0; i < work->n; i++) {
        uint32_t to = work->first[listed->cell[i]]++;
        sorted->x[to] = listed->x[i];
        sorted->y[to] = listed->y[i];
        sorted->z[to] = listed->z[i];
        sorted->widening[to] = listed->widening[i];
        sorted->place[to] = listed->place[i];
        work->free[to] = 1;
    }
    /* Each cell's first is now the one behind its last. */
    for (uint32_t cell = n_cells; cell > 0; cell--)
        work->first[cell] = work->first[cell - 1];
    work->first[0] = 0;
}

/* ---- what capsules cover --------------------------------------------------------------------- */

/* One capsule, and the rectangle about it, turned as it is, in which the beams begin that it
 * touches. */
typedef struct Cover {
    float x, y, z, ux, uy, length, slope, radius, round;
    float wide;  /* the most of half a beam's width */
    float reach; /* beyond its axis and its ends */
    float top;   /* above which no beam begins that it touches */
} Cover;

/* Takes what the capsule covers of the beams [first, end). A beam is a square, as wide as where it
 * passes the axis: the capsule covers a strip of it between its ends. */
LANE_FN void cover_beams(const Cover *cover, uint32_t first, uint32_t end, BeamWork *work)
{
    static const int32_t numbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Lanes zero = lanes_set(0), radius = lanes_set(cover->radius);
    const BeamList *beams = &work->sorted;
    LaneMask number;
    __builtin_memcpy(&number, numbers, sizeof number);
    for (uint32_t i = first; i < end; i += LANES) {
        Lanes qx = lanes_load(&beams->x[i]) - cover->x, qy = lanes_load(&beams->y[i]) - cover->y;
        Lanes z = lanes_load(&beams->z[i]);
        Lanes off = lanes_abs(qy * cover->ux - qx * cover->uy);
        LaneMask touches = (off < cover->reach) & (z < cover->top) & (number < (int32_t)(end - i));
        if (!lanes_any(touches))
            continue;
        Lanes along = qx * cover->ux + qy * cover->uy;
        Lanes on = lanes_max(lanes_min(along, lanes_set(cover->length)), zero);
        Lanes height = cover->z + on * cover->slope - z;
        touches &= height > 0.0f;
        Lanes half = lanes_min(height * lanes_load(&beams->widening[i]), lanes_set(cover->wide));
        half = lanes_max(half, lanes_set(1e-6f));
        Lanes rounded = lanes_set(cover->round);
        LaneMask narrow = half < radius;
        if (lanes_any(narrow & touches)) {
            Lanes chord = lanes_sqrt(lanes_max(radius * radius - off * off, zero));
            rounded = lanes_select(narrow, chord, rounded);
        }
        Lanes across = lanes_min(off + radius, half) - lanes_max(off - radius, -half);
        Lanes length =
            lanes_min(cover->length - along + rounded, half) - lanes_max(-along - rounded, -half);
        Lanes covered = lanes_max(across, zero) * lanes_max(length, zero) / (4.0f * half * half);
        Lanes free = lanes_load(&work->free[i]);
        lanes_store(&work->free[i], lanes_select(touches, free * (1.0f - covered), free));
    }
}

static inline Cover cover_of(const Beams *beams, const SeenBlock *seen, int i)
{
    return (Cover){.x = seen->x[i],
                   .y = seen->y[i],
                   .z = seen->z[i],
                   .ux = seen->ux[i],
                   .uy = seen->uy[i],
                   .length = seen->length[i],
                   .slope = seen->slope[i],
                   .radius = seen->radius[i],
                   .round = seen->round[i],
                   .wide = beams->wide,
                   .reach = seen->radius[i] + beams->wide + beams->slack,
                   .top = seen->z[i] + seen->length[i] * seen->slope[i]};
}

/* Takes what a capsule covers of all beams. A row of cells from y on cuts its rectangle, the
 * product of two strips, in part of each strip's stretch of x. */
LANE_FN void cover_rows(const Cover *cover, BeamWork *work)
{
    const float across = fabsf(cover->ux), up = fabsf(cover->uy), side = 1 / work->per_cell;
    const float reach = cover->reach, reach_x = reach * (across + up);
    const float low_x = least_of(cover->ux * cover->length, 0) - reach_x;
    const float high_x = most_of(cover->ux * cover->length, 0) + reach_x;
    const float low_y = least_of(cover->uy * cover->length, 0) - reach_x;
    const float high_y = most_of(cover->uy * cover->length, 0) + reach_x;
    /* x of the middle of either strip changes with y by so much. */
    const float lean = up > 1e-3f ? cover->ux / cover->uy : 0;
    const float lean_ends = across > 1e-3f ? -cover->uy / cover->ux : 0;
    const float half = up > 1e-3f ? reach / up + fabsf(lean) * side / 2 : HUGE_VALF;
    const float middle_ends = across > 1e-3f ? cover->length / 2 / cover->ux : 0;
    const float half_ends = across > 1e-3f
                                ? (cover->length / 2 + reach) / across + fabsf(lean_ends) * side / 2
                                : HUGE_VALF;
    int first = cell_along(cover->y + low_y, work->low[1], work->per_cell, work->rows);
    int last = cell_along(cover->y + high_y, work->low[1], work->per_cell, work->rows);
    for (int row = first; row <= last; row++) {
        float y = work->low[1] + ((float)row + 0.5f) * side - cover->y;
        float from =
            most_of(most_of(lean * y - half, middle_ends + lean_ends * y - half_ends), low_x);
        float to =
            least_of(least_of(lean * y + half, middle_ends + lean_ends * y + half_ends), high_x);
        if (!(from < to))
            continue;
        int low = cell_along(cover->x + from, work->low[0], work->per_cell, work->columns);
        int high = cell_along(cover->x + to, work->low[0], work->per_cell, work->columns);
        const uint32_t *begins = &work->first[row * work->columns];
        cover_beams(cover, begins[low], begins[high + 1], work);
    }
}

LANE_TARGET static void BEAM_KERNEL(ask)(const Beams *beams, const BeamDirection *direction,
                                         const BeamPlaces *places, BeamWork *work, uint8_t *answers)
{
    if (!bound_beams(direction, places, work)) {
        __builtin_memset(answers, BEAM_UNASKED, places->n);
        return;
    }
    set_grid(places, beams->wide, work);
    __builtin_memset(work->first, 0,
                     ((size_t)(work->columns * work->rows) + 1) * sizeof *work->first);
    list_beams(direction, places, work, answers);
    sort_beams(work);
    for (size_t block = 0; block < beams->n_blocks; block++)
        for (int i = 0; i < BEAM_BLOCK; i += LANES)
            for (uint32_t left = see_lanes(direction, &beams->capsules[block], i, work,
                                           beams->wide + beams->slack, &work->seen);
                 left; left &= left - 1) {
                const Cover cover = cover_of(beams, &work->seen, i + __builtin_ctz(left));
                cover_rows(&cover, work);
            }
    for (uint32_t i = 0; i < work->n; i++)
        answers[work->sorted.place[i]] = (uint8_t)((float)BEAM_FREE * work->free[i] + 0.5f);
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* What neighbours answer, of several directions, by the weights of those who do. */
LANE_TARGET static void BEAM_KERNEL(add)(const uint8_t *answers, int n, int weight, uint16_t *free,
                                         uint16_t *asked)
{
    for (int k = 0; k < n; k++) {
        uint16_t part = (uint16_t)(answers[k] == BEAM_UNASKED ? 0 : weight);
        free[k] = (uint16_t)(free[k] + part * answers[k]);
        asked[k] = (uint16_t)(asked[k] + part);
    }
}

typedef uint16_t LaneWords __attribute__((vector_size(2 * LANES)));

LANE_FN Lanes load_words(const uint16_t *words)
{
    LaneWords lanes;
    __builtin_memcpy(&lanes, words, sizeof lanes);
    return __builtin_convertvector(lanes, Lanes);
}

LANE_TARGET static float BEAM_KERNEL(mean)(const float *const directions[3], const float normal[3],
                                           const uint16_t *free, const uint16_t *asked, int n)
{
    float open[SUMMED] = {0}, all[SUMMED] = {0};
    for (int first = 0; first < SUMMED; first += LANES) {
        Lanes open_lanes = lanes_set(0), all_lanes = lanes_set(0);
        for (int k = first; k < n; k += SUMMED) {
            Lanes cosine = normal[0] * lanes_load(&directions[0][k]) +
                           normal[1] * lanes_load(&directions[1][k]) +
                           normal[2] * lanes_load(&directions[2][k]);
            Lanes by = load_words(&asked[k]);
            cosine = lanes_select(by > 0.0f, lanes_max(cosine, lanes_set(0)), lanes_set(0));
            open_lanes += cosine * (load_words(&free[k]) / lanes_max(by, lanes_set(1)));
            all_lanes += cosine;
        }
        lanes_store(&open[first], open_lanes);
        lanes_store(&all[first], all_lanes);
    }
    for (int i = 1; i < SUMMED; i++) {
        open[0] += open[i];
        all[0] += all[i];
    }
    return all[0] > 0 ? open[0] / (BEAM_FREE * all[0]) : 1;
}

const BeamKernels BEAM_KERNEL(beamkernels) = {
    .ask = BEAM_KERNEL(ask), .add = BEAM_KERNEL(add), .mean = BEAM_KERNEL(mean)};
