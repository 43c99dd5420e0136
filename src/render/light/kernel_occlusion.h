/* The kernels of ambient occlusion [occlusionkernels.h], LANES numbers at once: `trace` blocks the
 * cones of one line by capsules, and `ambient` averages the answers around a pixel. A source
 * includes this file once per instruction set.
 *
 * `trace` sorts the cones along the line by their apexes into a grid perpendicular to the line.
 * Then each capsule (vessel) in turn blocks its part of the cones in the cells that it can touch.
 * The cones of a row of cells are consecutive, so that LANES cones are processed at once.
 *
 * The reverse order, capsules sorted into tiles and cones that query the tiles, is slower, because
 * neighbouring cones seldom touch the same capsules. Each shading point has a cone along one of the
 * two directions of the line. The cones of both directions are sorted together, so that a capsule
 * is projected once for both.
 *
 * Of the cones that are processed, a capsule blocks about a third at least in part. Whether it
 * blocks any of the LANES cones is not tested first: this branch is unpredictable, and costs more
 * than the division and the root that it may save. */
#include "render/light/occlusionkernels.h"
#include "render/tile/lanes.h"

/* pi / 4. A disc that lies within a cone's section counts as a rectangle of the disc's area and
 * width, whose length is this number times the disc's diameter. */
static const float disc_length = 0.7853982f;

static inline float smaller_of(float a, float b)
{
    return a < b ? a : b;
}

static inline float larger_of(float a, float b)
{
    return a > b ? a : b;
}

/* ---- capsules -------------------------------------------------------------------------------- */

/* Returns the coordinates of LANES points along an axis. */
LANE_FN Lanes along_axis(const float axis[3], const float point[3][OCCLUDER_BLOCK], int first)
{
    return axis[0] * lanes_load(&point[0][first]) + axis[1] * lanes_load(&point[1][first]) +
           axis[2] * lanes_load(&point[2][first]);
}

/* Sets lean[strip] and reach[strip] of LANES capsules [ProjectedBlock]. The middle line of the
 * strip runs through the capsule's middle in the direction (ux, uy); the strip extends `wide` mm to
 * either side. Strip 0 is along the capsule's axis, strip 1 across it. The rows of the grid are
 * `row` mm high. In the row whose middle is y mm from the capsule's middle, the strip covers |x -
 * lean y| <= reach. */
LANE_FN void set_strip(Lanes ux, Lanes uy, Lanes wide, float row, int strip, int i,
                       ProjectedBlock *projected)
{
    /* A strip parallel to the rows, to a thousandth, does not bound x; the other strip does. */
    LaneMask is_along_rows = lanes_abs(uy) < 1e-3f;
    Lanes lean = lanes_select(is_along_rows, lanes_set(0), ux / uy);
    Lanes reach = wide / lanes_abs(uy) + lanes_abs(lean) * (0.5f * row);
    lanes_store(&projected->lean[strip][i], lean);
    lanes_store(&projected->reach[strip][i],
                lanes_select(is_along_rows, lanes_set(HUGE_VALF), reach));
}

/* Projects LANES capsules of a block. Returns a bit mask of the capsules that may block a cone:
 * their bounds, widened by `reach`, overlap the grid. */
LANE_FN uint32_t project_lanes(const OcclusionLine *direction, const CapsuleBlock *block, int i,
                               float reach, ConeScratch *scratch)
{
    ProjectedBlock *projected = &scratch->projected;
    Lanes radius = lanes_load(&block->radius[i]);
    Lanes ax = along_axis(direction->axes[0], block->a, i);
    Lanes ay = along_axis(direction->axes[1], block->a, i);
    Lanes az = along_axis(direction->axes[2], block->a, i);
    Lanes bx = along_axis(direction->axes[0], block->b, i);
    Lanes by = along_axis(direction->axes[1], block->b, i);
    Lanes bz = along_axis(direction->axes[2], block->b, i);
    Lanes x = bx - ax, y = by - ay, length = lanes_sqrt(x * x + y * y);
    /* A capsule parallel to the line is projected to a disc: its projected axis is shorter than a
     * thousandth of the radius, too short for a direction. */
    LaneMask is_along_line = length < 1e-3f * radius;
    Lanes ux = lanes_select(is_along_line, lanes_set(1), x / length);
    Lanes uy = lanes_select(is_along_line, lanes_set(0), y / length);
    Lanes half = lanes_select(is_along_line, lanes_set(0), 0.5f * length);
    Lanes far = radius + reach, along = half + far, up = lanes_abs(uy), across = lanes_abs(ux);
    Lanes reach_x = across * along + up * far, reach_y = up * along + across * far;
    x = 0.5f * (ax + bx);
    y = 0.5f * (ay + by);
    LaneMask over = (radius >= 0.0f) & (x + reach_x > scratch->low[0]) &
                    (x - reach_x < scratch->high[0]) & (y + reach_y > scratch->low[1]) &
                    (y - reach_y < scratch->high[1]);
    if (!lanes_any(over))
        return 0;
    lanes_store(&projected->x[i], x);
    lanes_store(&projected->y[i], y);
    lanes_store(&projected->z[i], 0.5f * (az + bz));
    lanes_store(&projected->ux[i], ux);
    lanes_store(&projected->uy[i], uy);
    lanes_store(&projected->half[i], half);
    lanes_store(&projected->slope[i],
                lanes_select(is_along_line, lanes_set(0), (bz - az) / length));
    lanes_store(&projected->radius[i], radius);
    lanes_store(&projected->round[i],
                lanes_select(is_along_line, disc_length * radius, lanes_set(0)));
    lanes_store(&projected->low[i], y - reach_y);
    lanes_store(&projected->high[i], y + reach_y);
    lanes_store(&projected->reach_x[i], reach_x);
    set_strip(ux, uy, far, 1 / scratch->rows_per_mm, 0, i, projected);
    set_strip(-uy, ux, along, 1 / scratch->rows_per_mm, 1, i, projected);
    return lanes_bits(over);
}

/* ---- cones ----------------------------------------------------------------------------------- */

/* Returns the index of each lane. */
LANE_FN LaneMask lane_numbers(void)
{
    static const int32_t numbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    LaneMask number;
    __builtin_memcpy(&number, numbers, sizeof number);
    return number;
}

/* Lists the cones of all points, and computes the bounds of their apexes. The half width of a cone
 * grows with the cosine between line and normal, up to the line's `widening`. Cones that point into
 * the ground are blocked: ground_side * ground_cosine is the line's upward component away from the
 * ground, on the point's side, and the sign of widening is the direction along the line. */
LANE_FN void list_cones(const OcclusionLine *direction, const OcclusionPoints *points,
                        ConeScratch *scratch)
{
    const float(*axes)[3] = direction->axes;
    const Lanes most = lanes_set(direction->widening);
    Lanes low[2] = {lanes_set(HUGE_VALF), lanes_set(HUGE_VALF)}, high[2] = {-low[0], -low[1]};
    for (uint32_t first = 0; first < points->n; first += LANES) {
        LaneMask here = lane_numbers() < (int32_t)(points->n - first);
        Lanes at[3], facing = lanes_set(0);
        for (int i = 0; i < 3; i++)
            at[i] = axes[i][0] * lanes_load(&points->position[0][first]) +
                    axes[i][1] * lanes_load(&points->position[1][first]) +
                    axes[i][2] * lanes_load(&points->position[2][first]);
        for (int c = 0; c < 3; c++)
            facing = facing + axes[2][c] * lanes_load(&points->normal[c][first]);
        for (int i = 0; i < 2; i++) {
            low[i] = lanes_select(here, lanes_min(low[i], at[i]), low[i]);
            high[i] = lanes_select(here, lanes_max(high[i], at[i]), high[i]);
        }
        Lanes widening = lanes_max(lanes_min(facing, most), -most);
        Lanes ground =
            lanes_load(&points->ground_side[first]) * direction->ground_cosine * widening;
        ConeGroup *listed = &scratch->listed[first / OCCLUDER_BLOCK];
        const uint32_t lane = first % OCCLUDER_BLOCK;
        lanes_store(&listed->x[lane], at[0]);
        lanes_store(&listed->y[lane], at[1]);
        lanes_store(&listed->z[lane], at[2]);
        lanes_store(&listed->widening[lane], widening);
        lanes_store(&listed->unblocked[lane],
                    lanes_select(ground < 0.0f, lanes_set(0), lanes_set(1)));
    }
    for (int i = 0; i < 2; i++) {
        scratch->low[i] = lanes_reduce_min(low[i]);
        scratch->high[i] = lanes_reduce_max(high[i]);
    }
}

/* Chooses the grid over the apexes. A square of the grid has about `cones_per_square` cones, one to
 * five vectors of LANES, but is not narrower than the widest cone. A square is divided into
 * `columns_per_square` cells side by side, because a capsule blocks cones row by row, from one
 * column to another. Larger squares and fewer columns process more cones that the capsule cannot
 * reach; smaller ones cost more rows per capsule. The result depends on neither. The minimum side
 * of 1e-6 mm avoids a division by 0 if all apexes coincide. */
static inline void set_grid(const OcclusionPoints *points, float wide, ConeScratch *scratch)
{
    const float cones_per_square = 20, columns_per_square = 4;
    float width = scratch->high[0] - scratch->low[0], height = scratch->high[1] - scratch->low[1];
    float side = larger_of(wide, sqrtf(cones_per_square * width * height / (float)(points->n + 1)));
    side = larger_of(larger_of(side, larger_of(width, height) / (CONE_MAX_SQUARES - 1)), 1e-6f);
    scratch->rows_per_mm = 1 / side;
    scratch->columns_per_mm = columns_per_square / side;
    scratch->columns = (int)(width / side * columns_per_square) + 1;
    scratch->rows = (int)(height / side) + 1;
}

/* Returns the cell, 0 to n - 1, of the coordinate `at` along an axis of the grid. */
LANE_FN int cell_along(float at, float first, float per_cell, int n)
{
    float cell = (at - first) * per_cell;
    return cell < 0 ? 0 : cell < (float)n ? (int)cell : n - 1;
}

/* Counts the cones of each cell. */
LANE_FN void count_cones(ConeScratch *scratch, uint32_t n)
{
    const int stride = scratch->columns + 1;
    __builtin_memset(scratch->ends, 0, (size_t)(scratch->rows * stride) * sizeof *scratch->ends);
    for (uint32_t i = 0; i < n; i++) {
        const ConeGroup *listed = &scratch->listed[i / OCCLUDER_BLOCK];
        const uint32_t lane = i % OCCLUDER_BLOCK;
        int column =
            cell_along(listed->x[lane], scratch->low[0], scratch->columns_per_mm, scratch->columns);
        int row = cell_along(listed->y[lane], scratch->low[1], scratch->rows_per_mm, scratch->rows);
        scratch->slot[i] = (uint32_t)(row * stride + 1 + column);
        scratch->ends[scratch->slot[i]]++;
    }
}

/* Fills the rest of the ConeGroup that contains the index `end` with padding. Returns the index of
 * the next group's first cone; `end` if it is that already. */
static inline uint32_t fill_group(ConeScratch *scratch, uint32_t end)
{
    for (; end % OCCLUDER_BLOCK > 0; end++) {
        ConeGroup *sorted = &scratch->sorted[end / OCCLUDER_BLOCK];
        const uint32_t lane = end % OCCLUDER_BLOCK;
        sorted->x[lane] = sorted->y[lane] = sorted->z[lane] = 0;
        sorted->widening[lane] = sorted->unblocked[lane] = 0;
    }
    return end;
}

/* Sorts the listed cones by their cells. First, the count of each cell becomes the index of its
 * first cone, with padding behind each row. Then each cone is stored at the index of its cell,
 * which increases: at last it is the index past the cell's last cone. */
LANE_FN void sort_cones(ConeScratch *scratch, uint32_t n)
{
    uint32_t end = 0, *ends = scratch->ends;
    for (int row = 0; row < scratch->rows; row++) {
        *ends++ = end;
        for (int column = 0; column < scratch->columns; column++, ends++) {
            uint32_t count = *ends;
            *ends = end;
            end += count;
        }
        end = fill_group(scratch, end);
    }
    for (uint32_t i = 0; i < n; i++) {
        const ConeGroup *listed = &scratch->listed[i / OCCLUDER_BLOCK];
        const uint32_t from = i % OCCLUDER_BLOCK, number = scratch->ends[scratch->slot[i]]++;
        ConeGroup *sorted = &scratch->sorted[number / OCCLUDER_BLOCK];
        const uint32_t to = number % OCCLUDER_BLOCK;
        sorted->x[to] = listed->x[from];
        sorted->y[to] = listed->y[from];
        sorted->z[to] = listed->z[from];
        sorted->widening[to] = listed->widening[from];
        sorted->unblocked[to] = listed->unblocked[from];
        scratch->slot[i] = number;
    }
}

/* ---- blocking -------------------------------------------------------------------------------- */

/* One capsule of a ProjectedBlock. */
typedef struct Cover {
    float x, y, z, ux, uy, half, slope, radius, round;
    float wide; /* maximum half width of a cone */
} Cover;

/* Returns the length of the intersection of two intervals with the half lengths a and b whose
 * middles are `apart` apart; negative if they do not meet. */
LANE_FN Lanes shared_stretch(Lanes a, Lanes b, Lanes apart)
{
    Lanes least = lanes_min(a, b);
    return lanes_min(a + b - apart, least + least);
}

/* Reduces `unblocked` of LANES cones of a group by the part that the capsule covers. The section of
 * a cone at the height of the capsule counts as a square with sides along and across the projected
 * axis. The capsule covers a rectangle of the square. Across, the rectangle is the overlap with the
 * capsule's width; along, the overlap with the capsule's length, which the round ends extend. For a
 * cone that is narrower than the capsule, the extension is half the chord of the end's disc at the
 * cone's axis. The minimum width of 1e-6 mm avoids 0 / 0. */
LANE_FN void cover_lanes(const Cover *cover, ConeGroup *cones, uint32_t lane)
{
    const Lanes zero = lanes_set(0), radius = lanes_set(cover->radius);
    /* The apex, relative to the capsule's centre: across and along its projected axis. */
    Lanes qx = lanes_load(&cones->x[lane]) - cover->x, qy = lanes_load(&cones->y[lane]) - cover->y;
    Lanes off = lanes_abs(qy * cover->ux - qx * cover->uy);
    Lanes along = qx * cover->ux + qy * cover->uy;
    Lanes on = lanes_max(lanes_min(along, lanes_set(cover->half)), lanes_set(-cover->half));
    Lanes height = on * cover->slope + cover->z - lanes_load(&cones->z[lane]);
    Lanes width = lanes_min(height * lanes_load(&cones->widening[lane]), lanes_set(cover->wide));
    LaneMask ahead = width > 0.0f;
    width = lanes_max(width, lanes_set(1e-6f));
    Lanes chord = lanes_sqrt(lanes_max(radius * radius - off * off, zero));
    Lanes rounded = lanes_select(width < radius, chord, lanes_set(cover->round));
    Lanes across = shared_stretch(radius, width, off);
    Lanes length = shared_stretch(cover->half + rounded, width, lanes_abs(along));
    Lanes covered = lanes_max(across, zero) * lanes_max(length, zero) / (4.0f * width * width);
    Lanes free = lanes_load(&cones->unblocked[lane]);
    lanes_store(&cones->unblocked[lane], lanes_select(ahead, free * (1.0f - covered), free));
}

/* Processes the sorted cones [first, end). The range is extended to multiples of LANES; the added
 * cones are out of the capsule's reach and do not change. */
LANE_FN void cover_cones(const Cover *cover, ConeGroup *sorted, uint32_t first, uint32_t end)
{
    for (uint32_t i = first / LANES * LANES; i < end; i += LANES)
        cover_lanes(cover, &sorted[i / OCCLUDER_BLOCK], i % OCCLUDER_BLOCK);
}

/* Reduces `unblocked` of all cones by the parts that a capsule covers. Visits, in each row of the
 * grid that the capsule can touch, the cells between the bounds of its two strips
 * [ProjectedBlock]. */
LANE_FN void cover_rows(const ProjectedBlock *projected, int i, float wide, ConeScratch *scratch)
{
    const Cover cover = {.x = projected->x[i],
                         .y = projected->y[i],
                         .z = projected->z[i],
                         .ux = projected->ux[i],
                         .uy = projected->uy[i],
                         .half = projected->half[i],
                         .slope = projected->slope[i],
                         .radius = projected->radius[i],
                         .round = projected->round[i],
                         .wide = wide};
    const float side = 1 / scratch->rows_per_mm, from_x = cover.x - scratch->low[0];
    const int first =
        cell_along(projected->low[i], scratch->low[1], scratch->rows_per_mm, scratch->rows);
    const int last =
        cell_along(projected->high[i], scratch->low[1], scratch->rows_per_mm, scratch->rows);
    for (int row = first; row <= last; row++) {
        float y = ((float)row + 0.5f) * side + (scratch->low[1] - cover.y);
        float low = -projected->reach_x[i], high = projected->reach_x[i];
        for (int strip = 0; strip < 2; strip++) {
            float middle = projected->lean[strip][i] * y;
            low = larger_of(low, middle - projected->reach[strip][i]);
            high = smaller_of(high, middle + projected->reach[strip][i]);
        }
        const uint32_t *ends = &scratch->ends[row * (scratch->columns + 1)];
        int left = cell_along(low, -from_x, scratch->columns_per_mm, scratch->columns);
        int right = cell_along(high, -from_x, scratch->columns_per_mm, scratch->columns);
        if (low < high)
            cover_cones(&cover, scratch->sorted, ends[left], ends[right + 1]);
    }
}

/* OcclusionKernels.trace: computes the answers for the cones of one line. */
LANE_TARGET static void LANES_NAME(trace)(const OccluderSet *occluders,
                                          const OcclusionLine *direction,
                                          const OcclusionPoints *points, ConeScratch *scratch,
                                          uint8_t *answers)
{
    list_cones(direction, points, scratch);
    set_grid(points, occluders->max_half_width, scratch);
    count_cones(scratch, points->n);
    sort_cones(scratch, points->n);
    for (size_t block = 0; block < occluders->n_blocks; block++)
        for (int i = 0; i < OCCLUDER_BLOCK; i += LANES)
            for (uint32_t left =
                     project_lanes(direction, &occluders->capsules[block], i,
                                   occluders->max_half_width + occluders->slack, scratch);
                 left; left &= left - 1)
                cover_rows(&scratch->projected, i + __builtin_ctz(left), occluders->max_half_width,
                           scratch);
    for (uint32_t i = 0; i < points->n; i++) {
        const ConeGroup *sorted = &scratch->sorted[scratch->slot[i] / OCCLUDER_BLOCK];
        const uint32_t lane = scratch->slot[i] % OCCLUDER_BLOCK;
        int free = (int)((float)CONE_UNBLOCKED * sorted->unblocked[lane] + 0.5f);
        answers[i] = (uint8_t)(free + (sorted->widening[lane] < 0 ? CONE_BACKWARD : 0));
    }
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* Per pixel of a quad: the weights of the 9 quads around it, row by row. They decrease with the
 * distance from the pixel: 3 : 4 : 1 or 1 : 4 : 3 along a row and along a column. The pixel is a
 * quarter of a quad's side from its quad's middle, so the nearer neighbour has the larger
 * weight. */
static const int weights[QUAD][QUADS_AROUND] = {{9, 12, 3, 12, 16, 4, 3, 4, 1},
                                                {3, 12, 9, 4, 16, 12, 1, 4, 3},
                                                {3, 4, 1, 12, 16, 4, 9, 12, 3},
                                                {1, 4, 3, 4, 16, 12, 3, 12, 9}};

/* Adds the LANES lines from `first` on to two sums: *all sums the cosines of lines with an answer,
 * and *open the cosines times the mean unblocked fraction. An answer counts if its cone is on the
 * side of the normal: XOR with `against` clears CONE_BACKWARD for these answers and sets it for the
 * others. */
LANE_FN void add_lines(const OcclusionLines *lines, const QuadAnswers *answers, int pixel,
                       int first, const float normal[3], Lanes *open, Lanes *all)
{
    Lanes cosine = normal[0] * lanes_load(&lines->upward[0][first]) +
                   normal[1] * lanes_load(&lines->upward[1][first]) +
                   normal[2] * lanes_load(&lines->upward[2][first]);
    LaneMask against = (cosine < 0.0f) & CONE_BACKWARD, free = {0}, asked = {0};
    for (int i = 0; i < answers->n; i++) {
        LaneMask answer = lanes_load_bytes(answers->of[i] + first) ^ against;
        LaneMask part = (answer < CONE_BACKWARD) & weights[pixel][answers->quad[i]];
        free += part * answer;
        asked += part;
    }
    Lanes by = __builtin_convertvector(asked, Lanes);
    cosine = lanes_select(asked > 0, lanes_abs(cosine), lanes_set(0));
    *open += cosine * (__builtin_convertvector(free, Lanes) / lanes_max(by, lanes_set(1)));
    *all += cosine;
}

/* OcclusionKernels.ambient: the ambient visibility of a pixel. The order of the additions is the
 * same for all numbers of lanes. */
LANE_TARGET static float LANES_NAME(ambient)(const OcclusionLines *lines,
                                             const QuadAnswers *answers, int n, int pixel,
                                             const float normal[3])
{
    float open[ANSWER_STEP] = {0}, all[ANSWER_STEP] = {0};
    for (int first = 0; first < ANSWER_STEP; first += LANES) {
        Lanes open_lanes = lanes_set(0), all_lanes = lanes_set(0);
        for (int i = 0; i < n; i++)
            for (int k = first; k < lines[i].n; k += ANSWER_STEP)
                add_lines(&lines[i], &answers[i], pixel, k, normal, &open_lanes, &all_lanes);
        lanes_store(&open[first], open_lanes);
        lanes_store(&all[first], all_lanes);
    }
    for (int half = ANSWER_STEP / 2; half > 0; half /= 2)
        for (int i = 0; i < half; i++) {
            open[i] += open[i + half];
            all[i] += all[i + half];
        }
    return all[0] > 0 ? open[0] / (CONE_UNBLOCKED * all[0]) : 1;
}

const OcclusionKernels LANES_NAME(occlusionkernels) = {.trace = LANES_NAME(trace),
                                                       .ambient = LANES_NAME(ambient)};
