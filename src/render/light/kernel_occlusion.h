/* OccluderSet, several at a time: included by each source that compiles it for its lanes.
 *
 * OccluderSet of one line, along its direction and against it, are sorted into a grid across it,
 * where they begin, and each capsule in turn takes what it covers from those in the cells that it
 * can touch: those of a row stand one after another, to be taken many at once. The other way about,
 * capsules in tiles for beams to ask, beams that lie side by side seldom touch the same ones.
 * OccluderSet of both directions go together because each place begins one of the two: a capsule is
 * set once for both, and finds twice as many beams in its cells.
 *
 * Of beams taken at once a capsule covers a third. Whether it covers any is not asked before all is
 * worked out: a processor foresees the answer badly, and what it does in vain costs more than a
 * division and a root. */
#ifndef BEAM_KERNEL
#error "define BEAM_KERNEL(name), the name of a function"
#endif

#include "render/light/occlusionkernels.h"
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

/* Sets where a strip through the middles of capsules crosses the rows of the grid, which are `row`
 * mm high. The strip runs along (ux, uy), `wide` mm to either side; what a row at y, mm from the
 * middle, has of it lies within `reach` of x = lean y. */
LANE_FN void set_strip(Lanes ux, Lanes uy, Lanes wide, float row, int strip, int i, SeenBlock *seen)
{
    /* A strip along the rows holds all of them: the other bounds it. */
    LaneMask lies = lanes_abs(uy) < 1e-3f;
    Lanes lean = lanes_select(lies, lanes_set(0), ux / uy);
    Lanes reach = wide / lanes_abs(uy) + lanes_abs(lean) * (0.5f * row);
    lanes_store(&seen->lean[strip][i], lean);
    lanes_store(&seen->reach[strip][i], lanes_select(lies, lanes_set(HUGE_VALF), reach));
}

/* Sees LANES of a block's capsules. As bits, those that may cover a beam: their bounds, wider by
 * `reach`, are over the grid. */
LANE_FN uint32_t see_lanes(const BeamDirection *direction, const CapsuleBlock *block, int i,
                           float reach, BeamWork *work)
{
    SeenBlock *seen = &work->seen;
    Lanes radius = lanes_load(&block->radius[i]);
    Lanes ax = along_axis(direction->axes[0], block->a, i);
    Lanes ay = along_axis(direction->axes[1], block->a, i);
    Lanes az = along_axis(direction->axes[2], block->a, i);
    Lanes bx = along_axis(direction->axes[0], block->b, i);
    Lanes by = along_axis(direction->axes[1], block->b, i);
    Lanes bz = along_axis(direction->axes[2], block->b, i);
    Lanes x = bx - ax, y = by - ay, length = lanes_sqrt(x * x + y * y);
    /* One along the line is a ball. */
    LaneMask stands = length < 1e-3f * radius;
    Lanes ux = lanes_select(stands, lanes_set(1), x / length);
    Lanes uy = lanes_select(stands, lanes_set(0), y / length);
    Lanes half = lanes_select(stands, lanes_set(0), 0.5f * length);
    Lanes far = radius + reach, along = half + far, up = lanes_abs(uy), across = lanes_abs(ux);
    Lanes reach_x = across * along + up * far, reach_y = up * along + across * far;
    x = 0.5f * (ax + bx);
    y = 0.5f * (ay + by);
    LaneMask over = (radius >= 0.0f) & (x + reach_x > work->low[0]) &
                    (x - reach_x < work->high[0]) & (y + reach_y > work->low[1]) &
                    (y - reach_y < work->high[1]);
    if (!lanes_any(over))
        return 0;
    lanes_store(&seen->x[i], x);
    lanes_store(&seen->y[i], y);
    lanes_store(&seen->z[i], 0.5f * (az + bz));
    lanes_store(&seen->ux[i], ux);
    lanes_store(&seen->uy[i], uy);
    lanes_store(&seen->half[i], half);
    lanes_store(&seen->slope[i], lanes_select(stands, lanes_set(0), (bz - az) / length));
    lanes_store(&seen->radius[i], radius);
    lanes_store(&seen->round[i], lanes_select(stands, quarter_turn * radius, lanes_set(0)));
    lanes_store(&seen->low[i], y - reach_y);
    lanes_store(&seen->high[i], y + reach_y);
    lanes_store(&seen->reach_x[i], reach_x);
    set_strip(ux, uy, far, 1 / work->per_row, 0, i, seen);
    set_strip(-uy, ux, along, 1 / work->per_row, 1, i, seen);
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
        BeamGroup *listed = &work->listed[first / BEAM_BLOCK];
        const uint32_t lane = first % BEAM_BLOCK;
        lanes_store(&listed->x[lane], at[0]);
        lanes_store(&listed->y[lane], at[1]);
        lanes_store(&listed->z[lane], at[2]);
        lanes_store(&listed->widening[lane], widening);
        lanes_store(&listed->free[lane], lanes_select(ground < 0.0f, lanes_set(0), lanes_set(1)));
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
    const int stride = work->columns + 1;
    __builtin_memset(work->ends, 0, (size_t)(work->rows * stride) * sizeof *work->ends);
    for (uint32_t i = 0; i < n; i++) {
        const BeamGroup *listed = &work->listed[i / BEAM_BLOCK];
        const uint32_t lane = i % BEAM_BLOCK;
        int column = cell_along(listed->x[lane], work->low[0], work->per_column, work->columns);
        int row = cell_along(listed->y[lane], work->low[1], work->per_row, work->rows);
        work->at[i] = (uint32_t)(row * stride + 1 + column);
        work->ends[work->at[i]]++;
    }
}

/* Fills up the group that ends at a number of sorted beams, by beams that nothing touches, and
 * returns where the next group begins. */
static inline uint32_t fill_group(BeamWork *work, uint32_t end)
{
    for (; end % BEAM_BLOCK > 0; end++) {
        BeamGroup *sorted = &work->sorted[end / BEAM_BLOCK];
        const uint32_t lane = end % BEAM_BLOCK;
        sorted->x[lane] = sorted->y[lane] = sorted->z[lane] = 0;
        sorted->widening[lane] = sorted->free[lane] = 0;
    }
    return end;
}

/* Sorts what is listed into cells. */
LANE_FN void sort_beams(BeamWork *work, uint32_t n)
{
    uint32_t end = 0, *ends = work->ends;
    for (int row = 0; row < work->rows; row++) {
        *ends++ = end;
        for (int column = 0; column < work->columns; column++, ends++) {
            uint32_t count = *ends;
            *ends = end;
            end += count;
        }
        end = fill_group(work, end);
    }
    for (uint32_t i = 0; i < n; i++) {
        const BeamGroup *listed = &work->listed[i / BEAM_BLOCK];
        const uint32_t from = i % BEAM_BLOCK, number = work->ends[work->at[i]]++;
        BeamGroup *sorted = &work->sorted[number / BEAM_BLOCK];
        const uint32_t to = number % BEAM_BLOCK;
        sorted->x[to] = listed->x[from];
        sorted->y[to] = listed->y[from];
        sorted->z[to] = listed->z[from];
        sorted->widening[to] = listed->widening[from];
        sorted->free[to] = listed->free[from];
        work->at[i] = number;
    }
}

/* ---- what capsules cover --------------------------------------------------------------------- */

/* One capsule of those seen. */
typedef struct Cover {
    float x, y, z, ux, uy, half, slope, radius, round;
    float wide; /* the most of half a beam's width */
} Cover;

/* What stretches of half a length a and b share, whose middles are `apart`; below 0: nothing. */
LANE_FN Lanes shared_stretch(Lanes a, Lanes b, Lanes apart)
{
    Lanes least = lanes_min(a, b);
    return lanes_min(a + b - apart, least + least);
}

/* Takes what the capsule covers of LANES beams of a group. A beam is a square, as wide as where it
 * passes the axis: the capsule covers a strip of it between its ends. */
LANE_FN void cover_lanes(const Cover *cover, BeamGroup *beams, uint32_t lane)
{
    const Lanes zero = lanes_set(0), radius = lanes_set(cover->radius);
    Lanes qx = lanes_load(&beams->x[lane]) - cover->x, qy = lanes_load(&beams->y[lane]) - cover->y;
    Lanes off = lanes_abs(qy * cover->ux - qx * cover->uy);
    Lanes along = qx * cover->ux + qy * cover->uy;
    Lanes on = lanes_max(lanes_min(along, lanes_set(cover->half)), lanes_set(-cover->half));
    Lanes height = on * cover->slope + cover->z - lanes_load(&beams->z[lane]);
    Lanes width = lanes_min(height * lanes_load(&beams->widening[lane]), lanes_set(cover->wide));
    LaneMask ahead = width > 0.0f;
    width = lanes_max(width, lanes_set(1e-6f));
    Lanes chord = lanes_sqrt(lanes_max(radius * radius - off * off, zero));
    Lanes rounded = lanes_select(width < radius, chord, lanes_set(cover->round));
    Lanes across = shared_stretch(radius, width, off);
    Lanes length = shared_stretch(cover->half + rounded, width, lanes_abs(along));
    Lanes covered = lanes_max(across, zero) * lanes_max(length, zero) / (4.0f * width * width);
    Lanes free = lanes_load(&beams->free[lane]);
    lanes_store(&beams->free[lane], lanes_select(ahead, free * (1.0f - covered), free));
}

/* Likewise of the sorted beams [first, end). Others of their row that stand in the first and the
 * last LANES with them are worked out too, but lie out of the capsule's reach. */
LANE_FN void cover_beams(const Cover *cover, BeamGroup *sorted, uint32_t first, uint32_t end)
{
    for (uint32_t i = first / LANES * LANES; i < end; i += LANES)
        cover_lanes(cover, &sorted[i / BEAM_BLOCK], i % BEAM_BLOCK);
}

/* Takes what a capsule covers of all beams. */
LANE_FN void cover_rows(const SeenBlock *seen, int i, float wide, BeamWork *work)
{
    const Cover cover = {.x = seen->x[i],
                         .y = seen->y[i],
                         .z = seen->z[i],
                         .ux = seen->ux[i],
                         .uy = seen->uy[i],
                         .half = seen->half[i],
                         .slope = seen->slope[i],
                         .radius = seen->radius[i],
                         .round = seen->round[i],
                         .wide = wide};
    const float side = 1 / work->per_row, from_x = cover.x - work->low[0];
    const int first = cell_along(seen->low[i], work->low[1], work->per_row, work->rows);
    const int last = cell_along(seen->high[i], work->low[1], work->per_row, work->rows);
    for (int row = first; row <= last; row++) {
        float y = ((float)row + 0.5f) * side + (work->low[1] - cover.y);
        float low = -seen->reach_x[i], high = seen->reach_x[i];
        for (int strip = 0; strip < 2; strip++) {
            float middle = seen->lean[strip][i] * y;
            low = most_of(low, middle - seen->reach[strip][i]);
            high = least_of(high, middle + seen->reach[strip][i]);
        }
        const uint32_t *ends = &work->ends[row * (work->columns + 1)];
        int left = cell_along(low, -from_x, work->per_column, work->columns);
        int right = cell_along(high, -from_x, work->per_column, work->columns);
        if (low < high)
            cover_beams(&cover, work->sorted, ends[left], ends[right + 1]);
    }
}

LANE_TARGET static void BEAM_KERNEL(ask)(const OccluderSet *beams, const BeamDirection *direction,
                                         const BeamPlaces *places, BeamWork *work, uint8_t *answers)
{
    list_beams(direction, places, work);
    set_grid(places, beams->wide, work);
    count_beams(work, places->n);
    sort_beams(work, places->n);
    for (size_t block = 0; block < beams->n_blocks; block++)
        for (int i = 0; i < BEAM_BLOCK; i += LANES)
            for (uint32_t left = see_lanes(direction, &beams->capsules[block], i,
                                           beams->wide + beams->slack, work);
                 left; left &= left - 1)
                cover_rows(&work->seen, i + __builtin_ctz(left), beams->wide, work);
    for (uint32_t i = 0; i < places->n; i++) {
        const BeamGroup *sorted = &work->sorted[work->at[i] / BEAM_BLOCK];
        const uint32_t lane = work->at[i] % BEAM_BLOCK;
        int free = (int)((float)BEAM_FREE * sorted->free[lane] + 0.5f);
        answers[i] = (uint8_t)(free + (sorted->widening[lane] < 0 ? BEAM_AGAINST : 0));
    }
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* Of each pixel of a quad, the weights of the quads about it, row by row: they fall with the
 * distance from the pixel, along a row and a column as 3 : 4 : 1 or 1 : 4 : 3. */
static const int weights[QUAD][QUADS_ABOUT] = {{9, 12, 3, 12, 16, 4, 3, 4, 1},
                                               {3, 12, 9, 4, 16, 12, 1, 4, 3},
                                               {3, 4, 1, 12, 16, 4, 9, 12, 3},
                                               {1, 4, 3, 4, 16, 12, 3, 12, 9}};

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
        LaneMask part = (answer < BEAM_AGAINST) & weights[pixel][answers->quad[i]];
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
