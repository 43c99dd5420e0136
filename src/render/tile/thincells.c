/* Computes the area that thin vessels cover in each cell (the square of the picture that one sample
 * represents), and draws their colors over the sample.
 *
 * A thin vessel is a strip on the picture. Away from the strip's ends, its area in a cell has a
 * closed form: the width of the cell, measured along the strip, is a trapezoid as a function of
 * the distance from the cell's middle across the strip. Near an end, the strip is divided into
 * parallel lines: the area of a line is its length in the cell times the distance of lines.
 *
 * Areas of vessels that follow one another end to end (a run) are added, because these vessels do
 * not overlap on the picture. Vessels of different runs cover one another by chance, so the
 * fractions of the cell that they leave uncovered are multiplied. */
#include "render/tile/thincells.h"

#include "render/tile/interval.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Number of lines into which a strip that is two cells wide is divided near its ends. The area errs
 * most if the strip is parallel to a side of the cell: by one line, about 1 / 12 of the cell. More
 * lines take more time, but only in the few cells at each end of a vessel. */
enum { LINES = 24 };
/* Cells: strips are taken to be wider by this where cells and tiles are chosen, for rounding. A
 * cell that is chosen in vain gets the area 0. */
static const float rounding_margin = 0.01f;

/* fminf and fmaxf would be calls of functions, because of NaN. No argument here is NaN. */
static float least(float a, float b)
{
    return a < b ? a : b;
}

static float greatest(float a, float b)
{
    return a > b ? a : b;
}

/* ---- strips of each tile --------------------------------------------------------------------- */

void thinlayer_release(ThinLayer *layer)
{
    free(layer->is_thin);
    free(layer->strips);
    free(layer->colors);
    indexlists_release(&layer->tiles);
    *layer = (ThinLayer){0};
}

/* Returns 1 / step, finite. */
static float inverse_of(float step)
{
    return 1 / (fabsf(step) > 1e-30f ? step : 1e-30f);
}

/* Shortens the part [*from, *to] of a line to the t at which start + t * step lies in [low, high].
 * Returns false if nothing is left. */
static bool clip(float start, float inverse_step, float low, float high, float *from, float *to)
{
    const float a = (low - start) * inverse_step, b = (high - start) * inverse_step;
    *from = greatest(*from, least(a, b));
    *to = least(*to, greatest(a, b));
    return *from <= *to;
}

/* Returns the tiles, among n, between two positions. */
static TileSpan tiles_between(float low, float high, int n)
{
    int first = (int)floorf(low / TILE_SIDE), last = (int)floorf(high / TILE_SIDE);
    return (TileSpan){first > 0 ? first : 0, last < n ? last : n - 1};
}

/* Returns the tiles of a row that a strip may touch. */
static TileSpan tiles_in_row(const ThinLayer *layer, const ThinStrip *strip, int row)
{
    float reach = strip->width / 2 + rounding_margin, t = 0, end = 1;
    float step_x = strip->x[1] - strip->x[0], top = (float)row * TILE_SIDE;
    if (!clip(strip->y[0], inverse_of(strip->y[1] - strip->y[0]), top - reach,
              top + TILE_SIDE + reach, &t, &end))
        return (TileSpan){0, -1};
    float a = strip->x[0] + t * step_x, b = strip->x[0] + end * step_x;
    return tiles_between(least(a, b) - reach, greatest(a, b) + reach, layer->tile_columns);
}

/* Appends each strip to the lists of the tiles that it may touch. If `puts` is false, only counts
 * the strips of each list. */
static void list_strips(ThinLayer *layer, bool puts)
{
    for (size_t i = 0; i < layer->n; i++) {
        const ThinStrip *strip = &layer->strips[i];
        float reach = strip->width / 2 + rounding_margin;
        TileSpan rows = tiles_between(least(strip->y[0], strip->y[1]) - reach,
                                      greatest(strip->y[0], strip->y[1]) + reach, layer->tile_rows);
        for (int row = rows.first; row <= rows.last; row++) {
            TileSpan columns = tiles_in_row(layer, strip, row);
            for (int column = columns.first; column <= columns.last; column++) {
                size_t tile = (size_t)row * (size_t)layer->tile_columns + (size_t)column;
                if (puts)
                    indexlists_put(&layer->tiles, tile, (uint32_t)i);
                else
                    indexlists_count(&layer->tiles, tile);
            }
        }
    }
}

Status thinlayer_sort(ThinLayer *layer, const Camera *camera, Err *err)
{
    layer->tile_columns = (camera->width + TILE_SIDE - 1) / TILE_SIDE;
    layer->tile_rows = (camera->height + TILE_SIDE - 1) / TILE_SIDE;
    const size_t n = (size_t)layer->tile_columns * (size_t)layer->tile_rows;
    TRY(indexlists_begin(&layer->tiles, n, "thin vessels", err));
    list_strips(layer, false);
    TRY(indexlists_allot(&layer->tiles, "thin vessels", err));
    list_strips(layer, true);
    return STATUS_OK;
}

bool thinlayer_misses(const ThinLayer *layer, int column, int row)
{
    if (!layer)
        return true;
    const uint32_t *first =
        &layer->tiles.first[(size_t)row * (size_t)layer->tile_columns + (size_t)column];
    return first[0] == first[1];
}

/* ---- fragments ------------------------------------------------------------------------------- */

double thinstrip_part(const ThinLayer *layer, const ThinStrip *strip, double s)
{
    double near = (double)strip->z[0], far = (double)strip->z[1];
    if (layer->perspective)
        s = s * near / (far + s * (near - far));
    return (double)strip->part[0] + s * (double)(strip->part[1] - strip->part[0]);
}

/* A strip while it is drawn into a block. Lengths are in cells, positions relative to the block's
 * first cell. */
typedef struct Brush {
    const ThinLayer *layer;
    const ThinStrip *strip;
    ThinCells *cells;
    float x, y;               /* first end of the axis */
    float along_x, along_y;   /* unit, from there to the second end */
    float per_x, per_y;       /* 1 / along */
    float length, half_width; /* of the strip */
    float flat, slope;        /* shape of a cell across the axis [part_below] */
    Status status;
    Err *err;
} Brush;

/* Returns the fragment of the strip's run in the cell whose latest fragment is *first. Adds one if
 * the latest fragment is of another run. Returns NULL, brush->status set, if there is no memory. */
static ThinFragment *fragment_at(Brush *brush, uint32_t *first)
{
    ThinCells *cells = brush->cells;
    uint32_t run = brush->strip->run;
    if (*first > 0 && cells->fragments.items[*first - 1].run == run)
        return &cells->fragments.items[*first - 1];
    if (brush->status == STATUS_OK)
        brush->status = ARRAY_PUSH(&cells->fragments, "thin vessels", brush->err,
                                   (ThinFragment){.run = run, .next = *first});
    if (brush->status != STATUS_OK)
        return NULL;
    *first = (uint32_t)cells->fragments.n;
    return &cells->fragments.items[*first - 1];
}

/* Returns the area of a cell on one side of a line that is parallel to the strip. `distance` is the
 * signed distance of the line from the cell's middle. The length of the line in the cell is
 * constant up to the distance `flat`, and from there falls linearly to 0 at `flat + slope`. */
static float part_below(const Brush *brush, float distance)
{
    const float flat = brush->flat, slope = brush->slope, deep = 1 / (2 * flat + slope);
    const float off = fabsf(distance), left = greatest(flat + slope - off, 0);
    const float above =
        off > flat ? left * left / greatest(2 * slope, 1e-30f) * deep : 0.5f - off * deep;
    return distance > 0 ? 1 - above : above;
}

/* Returns the area of the strip in a cell that may contain one of its ends, by parallel lines. */
static float area_at_end(const Brush *brush, float x, float y)
{
    const int lines = 1 + (int)(LINES * least(1, brush->half_width));
    float sum = 0;
    for (int k = 0; k < lines; k++) {
        const float aside = ((2 * (float)k + 1) / (float)lines - 1) * brush->half_width;
        float from = 0, to = brush->length;
        if (clip(x - brush->along_y * aside, brush->per_x, 0, 1, &from, &to) &&
            clip(y + brush->along_x * aside, brush->per_y, 0, 1, &from, &to))
            sum += to - from;
    }
    return least(1, sum * 2 * brush->half_width / (float)lines);
}

/* Adds the part of a cell that the strip covers to the fragment of the strip's run. */
static void cover_cell(Brush *brush, int column, int row)
{
    const ThinStrip *strip = brush->strip;
    ThinCells *cells = brush->cells;
    const float x = brush->x - (float)column, y = brush->y - (float)row;
    const float across = (0.5f - y) * brush->along_x - (0.5f - x) * brush->along_y;
    const float at = (0.5f - x) * brush->along_x + (0.5f - y) * brush->along_y;
    const float reach = brush->flat + brush->slope; /* of the cell, across the axis and along it */
    if (fabsf(across) >= brush->half_width + reach || at <= -reach || at >= brush->length + reach)
        return;
    const bool at_end = at < reach || at > brush->length - reach;
    const float area = at_end ? area_at_end(brush, x, y)
                              : part_below(brush, across + brush->half_width) -
                                    part_below(brush, across - brush->half_width);
    if (!(area > 0))
        return;
    ThinFragment *fragment = fragment_at(brush, &cells->first[row * cells->block.columns + column]);
    if (!fragment)
        return;
    const float t = least(greatest(at / brush->length, 0), 1);
    const uint32_t piece = (uint32_t)(t * (float)strip->n_pieces);
    const uint32_t last = strip->n_pieces - 1;
    const float *color = brush->layer->colors[strip->first_piece + (piece < last ? piece : last)];
    const float z = brush->layer->perspective ? 1 / ((1 - t) / strip->z[0] + t / strip->z[1])
                                              : strip->z[0] + t * (strip->z[1] - strip->z[0]);
    fragment->area += area;
    fragment->z += area * z;
    for (int c = 0; c < 3; c++)
        fragment->color[c] += area * color[c];
}

/* Draws the strip into the cells of a rectangle that it may touch, row by row. */
static void draw_strip(Brush *brush, int first_column, int end_column, int first_row, int end_row)
{
    const float reach = brush->half_width + rounding_margin;
    for (int row = first_row; row < end_row; row++) {
        float from = 0, to = brush->length;
        if (!clip(brush->y, brush->per_y, (float)row - reach, (float)row + 1 + reach, &from, &to))
            continue;
        const float a = brush->x + from * brush->along_x, b = brush->x + to * brush->along_x;
        const int left = (int)greatest(least(a, b) - reach, (float)first_column);
        const int right = (int)least(greatest(a, b) + reach, (float)(end_column - 1));
        for (int column = left; column <= right; column++)
            cover_cell(brush, column, row);
    }
}

static Status reserve_cells(ThinCells *cells, Err *err)
{
    size_t n = (size_t)cells->block.columns * (size_t)cells->block.rows;
    if (n <= cells->n_cells)
        return STATUS_OK;
    free(cells->first);
    cells->n_cells = 0;
    TRY(mem_calloc(&cells->first, n, sizeof *cells->first, "thin vessels", err));
    cells->n_cells = n;
    return STATUS_OK;
}

/* Draws the strips of one tile of the picture into the cells of the block that lie in the tile. */
static Status fill_tile(const ThinLayer *layer, int tile_column, int tile_row, ThinCells *cells,
                        Err *err)
{
    const CellBlock *block = &cells->block;
    const int side = block->per_pixel, tile_side = side * TILE_SIDE;
    const int left = tile_column * tile_side - block->column;
    const int top = tile_row * tile_side - block->row;
    const uint32_t *list =
        &layer->tiles.first[(size_t)tile_row * (size_t)layer->tile_columns + (size_t)tile_column];
    for (uint32_t i = list[0]; i < list[1]; i++) {
        const ThinStrip *strip = &layer->strips[layer->tiles.items[i]];
        const float x = (strip->x[1] - strip->x[0]) * (float)side;
        const float y = (strip->y[1] - strip->y[0]) * (float)side, length = sqrtf(x * x + y * y);
        if (!(length > 0))
            continue;
        const float wide = greatest(fabsf(x), fabsf(y)) / length;
        const float narrow = least(fabsf(x), fabsf(y)) / length;
        Brush brush = {
            .layer = layer,
            .strip = strip,
            .cells = cells,
            .x = (strip->x[0] - (float)(tile_column * TILE_SIDE)) * (float)side + (float)left,
            .y = (strip->y[0] - (float)(tile_row * TILE_SIDE)) * (float)side + (float)top,
            .along_x = x / length,
            .along_y = y / length,
            .per_x = inverse_of(x / length),
            .per_y = inverse_of(y / length),
            .length = length,
            .half_width = strip->width * (float)side / 2,
            .flat = (wide - narrow) / 2,
            .slope = narrow,
            .err = err};
        draw_strip(&brush, left > 0 ? left : 0,
                   left + tile_side < cells->block.columns ? left + tile_side
                                                           : cells->block.columns,
                   top > 0 ? top : 0,
                   top + tile_side < cells->block.rows ? top + tile_side : cells->block.rows);
        TRY(brush.status);
    }
    return STATUS_OK;
}

Status thincells_fill(const ThinLayer *layer, CellBlock block, ThinCells *cells, Err *err)
{
    if (cells->fragments.n > 0)
        memset(cells->first, 0, cells->n_cells * sizeof *cells->first);
    cells->fragments.n = 0;
    if (!layer)
        return STATUS_OK;
    const int tile_side = block.per_pixel * TILE_SIDE;
    const int last_column = (block.column + block.columns - 1) / tile_side;
    const int last_row = (block.row + block.rows - 1) / tile_side;
    cells->block = block;
    TRY(reserve_cells(cells, err));
    for (int y = block.row / tile_side; y <= last_row && y < layer->tile_rows; y++)
        for (int x = block.column / tile_side; x <= last_column && x < layer->tile_columns; x++)
            TRY(fill_tile(layer, x, y, cells, err));
    return ARRAY_RESERVE(&cells->order, cells->fragments.n, "thin vessels", err);
}

void thincells_release(ThinCells *cells)
{
    free(cells->first);
    ARRAY_RELEASE(&cells->fragments);
    ARRAY_RELEASE(&cells->order);
    *cells = (ThinCells){0};
}

/* ---- from front to back ---------------------------------------------------------------------- */

/* Lists the fragments of a cell that are not behind z, from front to back. Fragments of equal depth
 * stay in the order of the cell's list. Returns their number. Insertion sort suffices, because
 * cells have few fragments. */
static size_t sort_fragments(ThinCells *cells, uint32_t first, float z)
{
    ThinDepth *order = cells->order.items;
    size_t n = 0;
    for (uint32_t i = first; i > 0; i = cells->fragments.items[i - 1].next) {
        const ThinFragment *at = &cells->fragments.items[i - 1];
        const ThinDepth depth = {at->z / at->area, i - 1};
        if (depth.z > z)
            continue;
        size_t to = n++;
        for (; to > 0 && order[to - 1].z > depth.z; to--)
            order[to] = order[to - 1];
        order[to] = depth;
    }
    return n;
}

void thincells_over(ThinCells *cells, int column, int row, float z, float color[3])
{
    const size_t n = sort_fragments(cells, cells->first[row * cells->block.columns + column], z);
    float clear = 1, sum[3] = {0};
    for (size_t i = 0; i < n && clear > 0; i++) {
        const ThinFragment *at = &cells->fragments.items[cells->order.items[i].index];
        const float part = clear * least(1, at->area);
        for (int c = 0; c < 3; c++)
            sum[c] += part * at->color[c] / at->area;
        clear -= part;
    }
    for (int c = 0; c < 3; c++)
        color[c] = sum[c] + clear * color[c];
}
