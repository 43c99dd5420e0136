/* Beams, several at a time: included by each source that compiles it for its lanes.
 *
 * Beams of one line, along its direction and against it, are sorted into a grid across it, where
 * they begin, and each capsule in turn takes what it covers from those in the cells that it can
 * touch: those of a row stand one after another, to be taken many at once. The other way about,
 * capsules in tiles for beams to ask, beams that lie side by side seldom touch the same ones. Beams
 * of both directions go together because each place begins one of the two: a capsule is set once
 * for both, and finds twice as many beams in its cells. */
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

/* Sees LANES of a block's capsules. As bits, those that may cover a beam: their bounds, wider by
 * `reach`, are over the grid. */
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
    LaneMask over = (radius >= 0.0f) & (lanes_max(ax, bx) + far > work->low[0]) &
                    (lanes_min(ax, bx) - far < work->high[0]) &
                    (lanes_max(ay, by) + far > work->low[1]) &
                    (lanes_min(ay, by) - far < work->high[1]);
    if (!lanes_any(over))
        return 0;
    LaneMask falls = az > bz;
    Lanes x = lanes_select(falls, ax - bx, bx - ax), y = lanes_select(falls, ay - by, by - ay);
    Lanes z = lanes_abs(bz - az), length = lanes_sqrt(x * x + y * y);
    /* One along the line is a ball at the end that a beam's sky is at. */
    LaneMask stands = length < 1e-3f * radius;
    lanes_store(&seen->x[i], lanes_select(falls, bx, ax));
    lanes_store(&seen->y[i], lanes_select(falls, by, ay));
    lanes_store(&seen->z[i], lanes_select(falls, bz, az));
    lanes_store(&seen->ux[i], lanes_select(stands, lanes_set(1), x / length));
    lanes_store(&seen->uy[i], lanes_select(stands, zero, y / length));
    lanes_store(&seen->length[i], lanes_select(stands, zero, length));
    lanes_store(&seen->slope[i], lanes_select(stands, zero, z / length));
    lanes_store(&seen->radius[i], radius);
    lanes_store(&seen->round[i], lanes_select(stands, quarter_turn * radius, zero));
    lanes_store(&seen->rise[i], lanes_select(stands, z, zero));
    return lanes_bits(over);
}

/* ---- beams ----------------------------------------------------------------------------------- */

/* The number of each lane. */
LANE_FN LaneMask lane_numbers(void)
{
    static const int32_t numbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    LaneMask number;
    __builtin_memcpy(&number, numbers, sizeof number);
    return number;
}

/* Lists the beams of all places, and sets between what they begin. Of those that the ground hides
 * nothing is free. */
LANE_FN void list_beams(const BeamDirection *direction, const BeamPlaces *places, BeamWork *work)
{
    const BeamList *listed = &work->listed;
    const float(*axes)[3] = direction->axes;
    const Lanes most = lanes_set(direction->widening);
    Lanes low[2] = {lanes_set(HUGE_VALF), lanes_set(HUGE_VALF)}, high[2] = {-low[0], -low[1]};
    for (uint32_t first = 0; first < places->n; first += LANES) {
        LaneMask here = lane_numbers() < (int32_t)(places->n - first);
        Lanes at[3], facing = lanes_set(0);
        for (int i = 0; i < 3; i++)
            at[i] = axes[i][0] * lanes_load(&places->at[0][first]) +
                    axes[i][1] * lanes_load(&places->at[1][first]) +
                    axes[i][2] * lanes_load(&places->at[2][first]);
        for (int c = 0; c < 3; c++)
            facing = facing + axes[2][c] * lanes_load(&places->normal[c][first]);
        for (int i = 0; i < 2; i++) {
            low[i] = lanes_select(here, lanes_min(low[i], at[i]), low[i]);
            high[i] = lanes_select(here, lanes_max(high[i], at[i]), high[i]);
        }
        Lanes widening = lanes_max(lanes_min(facing, most), -most);
        Lanes ground = lanes_load(&places->above[first]) * direction->ground * widening;
        lanes_store(&listed->x[first], at[0]);
        lanes_store(&listed->y[first], at[1]);
        lanes_store(&listed->z[first], at[2]);
        lanes_store(&listed->widening[first], widening);
        lanes_store(&listed->free[first], lanes_select(ground < 0.0f, lanes_set(0), lanes_set(1)));
    }
    for (int i = 0; i < 2; i++) {
        work->low[i] = lanes_least(low[i]);
        work->high[i] = lanes_largest(high[i]);
    }
}

/* Sets a grid over the beams, a few a cell. Its cells are as wide as a quarter of their height:
 * rows are what capsules go through one by one. */
static inline void set_grid(const BeamPlaces *places, float wide, BeamWork *work)
{
    const float a_square = 20, columns_a_square = 4;
    float width = work->high[0] - work->low[0], height = work->high[1] - work->low[1];
    float side = most_of(wide, sqrtf(a_square * width * height / (float)(places->n + 1)));
    side = most_of(most_of(side, most_of(width, height) / (BEAM_MOST_SQUARES - 1)), 1e-6f);
    work->per_row = 1 / side;
    work->per_column = columns_a_square / side;
    work->columns = (int)(width / side * columns_a_square) + 1;
    work->rows = (int)(height / side) + 1;
}

LANE_FN int cell_along(float at, float first, float per_cell, int n)
{
    float cell = (at - first) * per_cell;
    return cell < 0 ? 0 : cell < (float)n ? (int)cell : n - 1;
}

/* Counts the beams of each cell. */
LANE_FN void count_beams(BeamWork *work, uint32_t n)
{
    const BeamList *listed = &work->listed;
    __builtin_memset(work->first, 0,
                     ((size_t)(work->columns * work->rows) + 1) * sizeof *work->first);
    for (uint32_t i = 0; i < n; i++) {
        int column = cell_along(listed->x[i], work->low[0], work->per_column, work->columns);
        int row = cell_along(listed->y[i], work->low[1], work->per_row, work->rows);
        work->cell[i] = (uint32_t)(row * work->columns + column);
        work->first[work->cell[i] + 1]++;
    }
}

/* Sorts what is listed into cells. */
LANE_FN void sort_beams(BeamWork *work, uint32_t n)
{
    const BeamList *listed = &work->listed, *sorted = &work->sorted;
    uint32_t n_cells = (uint32_t)(work->columns * work->rows);
    for (uint32_t cell = 0; cell < n_cells; cell++)
        work->first[cell + 1] += work->first[cell];
    for (uint32_t i = 0; i < n; i++) {
        uint32_t to = work->first[work->cell[i]]++;
        sorted->x[to] = listed->x[i];
        sorted->y[to] = listed->y[i];
        sorted->z[to] = listed->z[i];
        sorted->widening[to] = listed->widening[i];
        sorted->free[to] = listed->free[i];
        work->place[to] = i;
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
    float x, y, z, ux, uy, length, slope, radius, round, rise;
    float wide;  /* the most of half a beam's width */
    float reach; /* beyond its axis and its ends */
} Cover;

/* Takes what the capsule covers of the beams [first, end). A beam is a square, as wide as where it
 * passes the axis: the capsule covers a strip of it between its ends. */
LANE_FN void cover_beams(const Cover *cover, const BeamList beams, uint32_t first, uint32_t end)
{
    const Lanes zero = lanes_set(0), radius = lanes_set(cover->radius);
    for (uint32_t i = first; i < end; i += LANES) {
        Lanes qx = lanes_load(&beams.x[i]) - cover->x, qy = lanes_load(&beams.y[i]) - cover->y;
        Lanes off = lanes_abs(qy * cover->ux - qx * cover->uy);
        LaneMask here = lane_numbers() < (int32_t)(end - i);
        if (!lanes_any((off < cover->reach) & here))
            continue;
        Lanes along = qx * cover->ux + qy * cover->uy, widening = lanes_load(&beams.widening[i]);
        Lanes on = lanes_max(lanes_min(along, lanes_set(cover->length)), zero);
        Lanes rise = lanes_select(widening > 0.0f, lanes_set(cover->rise), zero);
        Lanes height = cover->z + on * cover->slope + rise - lanes_load(&beams.z[i]);
        Lanes half = lanes_min(height * widening, lanes_set(cover->wide));
        LaneMask touches = (half > 0.0f) & (off < radius + half) & here;
        if (!lanes_any(touches))
            continue;
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
        Lanes free = lanes_load(&beams.free[i]);
        lanes_store(&beams.free[i], lanes_select(touches, free * (1.0f - covered), free));
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
                   .rise = seen->rise[i],
                   .wide = beams->wide,
                   .reach = seen->radius[i] + beams->wide + beams->slack};
}

/* The columns of x, relative to a capsule's. */
LANE_FN LaneMask columns_at(Lanes x, float from, const BeamWork *work)
{
    Lanes column = (x + (from - work->low[0])) * work->per_column;
    column = lanes_min(column, lanes_set((float)(work->columns - 1)));
    return __builtin_convertvector(lanes_max(column, lanes_set(0)), LaneMask);
}

/* Takes what a capsule covers of all beams. A row of cells from y on cuts its rectangle, the
 * product of two strips, in part of each strip's stretch of x. */
LANE_FN void cover_rows(const Cover *cover, BeamWork *work)
{
    const float across = fabsf(cover->ux), up = fabsf(cover->uy), side = 1 / work->per_row;
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
    int first = cell_along(cover->y + low_y, work->low[1], work->per_row, work->rows);
    int last = cell_along(cover->y + high_y, work->low[1], work->per_row, work->rows);
    for (int row = first; row <= last; row += LANES) {
        LaneMask rows = lane_numbers() + row, there = rows <= last;
        rows = (rows & there) | (last & ~there);
        Lanes y = (__builtin_convertvector(rows, Lanes) + 0.5f) * side + (work->low[1] - cover->y);
        Lanes middle = lean * y, ends = middle_ends + lean_ends * y;
        Lanes from = lanes_max(lanes_max(middle - half, ends - half_ends), lanes_set(low_x));
        Lanes to = lanes_min(lanes_min(middle + half, ends + half_ends), lanes_set(high_x));
        LaneMask left = columns_at(from, cover->x, work), right = columns_at(to, cover->x, work);
        LaneMask begin = lanes_gather(work->first, rows * work->columns + left);
        LaneMask end = lanes_gather(work->first, rows * work->columns + right + 1);
        LaneMask any = (from < to) & (begin < end) & there;
        uint32_t begins[LANES], after[LANES];
        __builtin_memcpy(begins, &begin, sizeof begin);
        __builtin_memcpy(after, &end, sizeof end);
        for (uint32_t bits = lanes_bits(any); bits; bits &= bits - 1) {
            int i = __builtin_ctz(bits);
            cover_beams(cover, work->sorted, begins[i], after[i]);
        }
    }
}

LANE_TARGET static void BEAM_KERNEL(ask)(const Beams *beams, const BeamDirection *direction,
                                         const BeamPlaces *places, BeamWork *work, uint8_t *answers)
{
    list_beams(direction, places, work);
    set_grid(places, beams->wide, work);
    count_beams(work, places->n);
    sort_beams(work, places->n);
    for (size_t block = 0; block < beams->n_blocks; block++)
        for (int i = 0; i < BEAM_BLOCK; i += LANES)
            for (uint32_t left = see_lanes(direction, &beams->capsules[block], i, work,
                                           beams->wide + beams->slack, &work->seen);
                 left; left &= left - 1) {
                const Cover cover = cover_of(beams, &work->seen, i + __builtin_ctz(left));
                cover_rows(&cover, work);
            }
    for (uint32_t i = 0; i < places->n; i++) {
        int free = (int)((float)BEAM_FREE * work->sorted.free[i] + 0.5f);
        answers[work->place[i]] =
            (uint8_t)(free + (work->sorted.widening[i] < 0 ? BEAM_AGAINST : 0));
    }
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* Adds LANES of the lines, from one on. */
LANE_FN void add_lines(const BeamLines *lines, const BeamAnswers *answers, int pixel, int first,
                       const float normal[3], Lanes *open, Lanes *all)
{
    Lanes cosine = normal[0] * lanes_load(&lines->towards[0][first]) +
                   normal[1] * lanes_load(&lines->towards[1][first]) +
                   normal[2] * lanes_load(&lines->towards[2][first]);
    LaneMask against = (cosine < 0.0f) & BEAM_AGAINST, free = {0}, asked = {0};
    for (int i = 0; i < answers->n; i++) {
        LaneMask answer = lanes_load_bytes(answers->of[i] + first) ^ against;
        LaneMask part = (answer < BEAM_AGAINST) & answers->weight[pixel][i];
        free += part * answer;
        asked += part;
    }
    Lanes by = __builtin_convertvector(asked, Lanes);
    cosine = lanes_select(asked > 0, lanes_abs(cosine), lanes_set(0));
    *open += cosine * (__builtin_convertvector(free, Lanes) / lanes_max(by, lanes_set(1)));
    *all += cosine;
}

LANE_TARGET static float BEAM_KERNEL(open)(const BeamLines *lines, const BeamAnswers *answers,
                                           int n, int pixel, const float normal[3])
{
    float open[SUMMED] = {0}, all[SUMMED] = {0};
    for (int first = 0; first < SUMMED; first += LANES) {
        Lanes open_lanes = lanes_set(0), all_lanes = lanes_set(0);
        for (int i = 0; i < n; i++)
            for (int k = first; k < lines[i].n; k += SUMMED)
                add_lines(&lines[i], &answers[i], pixel, k, normal, &open_lanes, &all_lanes);
        lanes_store(&open[first], open_lanes);
        lanes_store(&all[first], all_lanes);
    }
    for (int half = SUMMED / 2; half > 0; half /= 2)
        for (int i = 0; i < half; i++) {
            open[i] += open[i + half];
            all[i] += all[i + half];
        }
    return all[0] > 0 ? open[0] / (BEAM_FREE * all[0]) : 1;
}

const BeamKernels BEAM_KERNEL(beamkernels) = {.ask = BEAM_KERNEL(ask), .open = BEAM_KERNEL(open)};
