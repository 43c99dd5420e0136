/* A strip is drawn as lines side by side. The area that a line stands for in a cell is its length
 * in the cell times the distance of lines. Areas of vessels that follow one another end to end (a
 * run) add up, as these vessels lie side by side; vessels of different runs cover one another by
 * chance, so their transparencies multiply. */
#include "render/tile/thincells.h"

#include "render/tile/interval.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Lines of a strip no wider than a cell; of wider ones, as many per cell. */
enum { LINES = 3 };

/* fminf and fmaxf are calls. No argument here is NaN. */
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
    numberlists_release(&layer->tiles);
    *layer = (ThinLayer){0};
}

/* Cuts the part [*from, *to] of a line down to where start + t * step lies in [low, high]. */
static bool clip(float start, float step, float low, float high, float *from, float *to)
{
    if (step == 0)
        return start >= low && start <= high;
    float a = (low - start) / step, b = (high - start) / step;
    *from = greatest(*from, least(a, b));
    *to = least(*to, greatest(a, b));
    return *from <= *to;
}

/* The tiles, at most n, that lie between two places. */
static TileSpan tiles_between(float low, float high, int n)
{
    int first = (int)floorf(low / TILE_SIDE), last = (int)floorf(high / TILE_SIDE);
    return (TileSpan){first > 0 ? first : 0, last < n ? last : n - 1};
}

/* The tiles of a row that a strip may touch. */
static TileSpan tiles_in_row(const ThinLayer *layer, const ThinStrip *strip, int row)
{
    float reach = strip->width / 2 + 0.01f, t = 0, end = 1;
    float step_x = strip->x[1] - strip->x[0], top = (float)row * TILE_SIDE;
    if (!clip(strip->y[0], strip->y[1] - strip->y[0], top - reach, top + TILE_SIDE + reach, &t,
              &end))
        return (TileSpan){0, -1};
    float a = strip->x[0] + t * step_x, b = strip->x[0] + end * step_x;
    return tiles_between(least(a, b) - reach, greatest(a, b) + reach, layer->tile_columns);
}

/* Appends the numbers of the strips to the lists of their tiles; ends[i] is where the list of tile
 * i ends. Only counts them if there are no items yet. */
static void list_strips(ThinLayer *layer, uint32_t *ends)
{
    for (size_t i = 0; i < layer->n; i++) {
        const ThinStrip *strip = &layer->strips[i];
        float reach = strip->width / 2 + 0.01f;
        TileSpan rows = tiles_between(least(strip->y[0], strip->y[1]) - reach,
                                      greatest(strip->y[0], strip->y[1]) + reach, layer->tile_rows);
        for (int row = rows.first; row <= rows.last; row++) {
            TileSpan columns = tiles_in_row(layer, strip, row);
            for (int column = columns.first; column <= columns.last; column++) {
                size_t tile = (size_t)row * (size_t)layer->tile_columns + (size_t)column;
                if (layer->tiles.items)
                    layer->tiles.items[ends[tile]] = (uint32_t)i;
                ends[tile]++;
            }
        }
    }
}

Status thinlayer_sort(ThinLayer *layer, const Camera *camera, Err *err)
{
    NumberLists *lists = &layer->tiles;
    layer->tile_columns = (camera->width + TILE_SIDE - 1) / TILE_SIDE;
    layer->tile_rows = (camera->height + TILE_SIDE - 1) / TILE_SIDE;
    size_t n = (size_t)layer->tile_columns * (size_t)layer->tile_rows;
    TRY(mem_calloc(&lists->first, n + 2, sizeof *lists->first, "thin vessels", err));
    list_strips(layer, lists->first + 2);
    for (size_t tile = 2; tile < n + 2; tile++)
        lists->first[tile] += lists->first[tile - 1];
    TRY(mem_calloc(&lists->items, lists->first[n + 1], sizeof *lists->items, "thin vessels", err));
    list_strips(layer, lists->first + 1);
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

/* A strip on its way through a rectangle of the block. Places are cells from the block's first
 * cell. */
typedef struct Brush {
    const ThinLayer *layer;
    const ThinStrip *strip;
    ThinCells *cells;
    int first_column, end_column, first_row, end_row; /* of the rectangle */
    float x, y, step_x, step_y; /* first end of the axis, and from there to the second */
    float line_width;           /* that a line stands for, cells */
    Status status;
} Brush;

static ThinFragment *fragment_at(Brush *brush, uint32_t *first)
{
    ThinCells *cells = brush->cells;
    uint32_t run = brush->strip->run;
    if (*first > 0 && cells->fragments[*first - 1].run == run)
        return &cells->fragments[*first - 1];
    if (cells->n == cells->capacity) {
        size_t capacity = cells->capacity ? 2 * cells->capacity : 256;
        ThinFragment *more = realloc(cells->fragments, capacity * sizeof *more);
        if (!more) {
            brush->status = STATUS_MEMORY;
            return NULL;
        }
        cells->fragments = more;
        cells->capacity = capacity;
    }
    ThinFragment *fragment = &cells->fragments[cells->n++];
    *fragment = (ThinFragment){.run = run, .next = *first};
    *first = (uint32_t)cells->n;
    return fragment;
}

/* Adds the part of a line from `t` on that lies in a cell; `length` is in cells. */
static void cover(Brush *brush, int column, int row, float length, float t)
{
    const ThinStrip *strip = brush->strip;
    ThinCells *cells = brush->cells;
    ThinFragment *at = fragment_at(brush, &cells->first[row * cells->columns + column]);
    uint32_t piece = (uint32_t)(t * (float)strip->n_pieces);
    if (!at)
        return;
    const float *color =
        brush->layer->colors[strip->first_piece + (piece < strip->n_pieces ? piece : 0)];
    float area = length * brush->line_width;
    float z = brush->layer->perspective ? 1 / ((1 - t) / strip->z[0] + t / strip->z[1])
                                        : strip->z[0] + t * (strip->z[1] - strip->z[0]);
    at->area += area;
    at->z += area * z;
    for (int c = 0; c < 3; c++)
        at->color[c] += area * color[c];
}

/* Where, as t, start + t * step leaves the cell of a number. */
static float leaves(float start, float step, int cell)
{
    if (step == 0)
        return INFINITY;
    return ((float)(step > 0 ? cell + 1 : cell) - start) / step;
}

static int cell_of(float at, int first, int end)
{
    int cell = (int)floorf(at);
    return cell < first ? first : cell >= end ? end - 1 : cell;
}

/* Draws a line, beside the axis by (aside_x, aside_y), from cell to cell; `length` is the strip's,
 * in cells. */
static void draw_line(Brush *brush, float length, float aside_x, float aside_y)
{
    float x = brush->x + aside_x, y = brush->y + aside_y, step_x = brush->step_x,
          step_y = brush->step_y;
    float t = 0, end = 1;
    if (!clip(x, step_x, (float)brush->first_column, (float)brush->end_column, &t, &end) ||
        !clip(y, step_y, (float)brush->first_row, (float)brush->end_row, &t, &end))
        return;
    int column = cell_of(x + t * step_x, brush->first_column, brush->end_column);
    int row = cell_of(y + t * step_y, brush->first_row, brush->end_row);
    while (t < end && column >= brush->first_column && column < brush->end_column &&
           row >= brush->first_row && row < brush->end_row) {
        float out_x = leaves(x, step_x, column), out_y = leaves(y, step_y, row);
        float next = least(end, least(out_x, out_y));
        if (next > t)
            cover(brush, column, row, (next - t) * length, (t + next) / 2);
        t = greatest(t, next);
        if (out_x <= out_y)
            column += step_x > 0 ? 1 : -1;
        else
            row += step_y > 0 ? 1 : -1;
    }
}

static void draw_strip(Brush *brush)
{
    float wide = brush->strip->width * (float)brush->cells->per_pixel;
    float length = sqrtf(brush->step_x * brush->step_x + brush->step_y * brush->step_y);
    if (!(length > 0))
        return;
    int lines = wide > 1 ? (int)ceilf(LINES * wide) : LINES;
    brush->line_width = wide / (float)lines;
    for (int k = 0; k < lines; k++) {
        float aside = (((float)k + 0.5f) / (float)lines - 0.5f) * wide / length;
        draw_line(brush, length, -brush->step_y * aside, brush->step_x * aside);
    }
}

void thincells_clear(ThinCells *cells)
{
    if (cells->n > 0)
        memset(cells->first, 0, cells->n_cells * sizeof *cells->first);
    cells->n = 0;
}

static Status make_room(ThinCells *cells, Err *err)
{
    size_t n = (size_t)cells->columns * (size_t)cells->rows;
    if (n <= cells->n_cells)
        return STATUS_OK;
    free(cells->first);
    cells->n_cells = 0;
    TRY(mem_calloc(&cells->first, n, sizeof *cells->first, "thin vessels", err));
    cells->n_cells = n;
    return STATUS_OK;
}

/* Draws the strips of one tile of the picture into the cells of the block that lie in the tile. The
 * block begins at cell (column, row). */
static Status fill_tile(const ThinLayer *layer, int tile_column, int tile_row, int column, int row,
                        ThinCells *cells, Err *err)
{
    const int side = cells->per_pixel, tile_side = side * TILE_SIDE;
    const int left = tile_column * tile_side - column, top = tile_row * tile_side - row;
    const uint32_t *list =
        &layer->tiles.first[(size_t)tile_row * (size_t)layer->tile_columns + (size_t)tile_column];
    for (uint32_t i = list[0]; i < list[1]; i++) {
        const ThinStrip *strip = &layer->strips[layer->tiles.items[i]];
        Brush brush = {
            .layer = layer,
            .strip = strip,
            .cells = cells,
            .first_column = left > 0 ? left : 0,
            .end_column = left + tile_side < cells->columns ? left + tile_side : cells->columns,
            .first_row = top > 0 ? top : 0,
            .end_row = top + tile_side < cells->rows ? top + tile_side : cells->rows,
            .x = (strip->x[0] - (float)(tile_column * TILE_SIDE)) * (float)side + (float)left,
            .y = (strip->y[0] - (float)(tile_row * TILE_SIDE)) * (float)side + (float)top,
            .step_x = (strip->x[1] - strip->x[0]) * (float)side,
            .step_y = (strip->y[1] - strip->y[0]) * (float)side};
        draw_strip(&brush);
        if (brush.status != STATUS_OK)
            return err_set(err, brush.status, "out of memory: no room for thin vessels");
    }
    return STATUS_OK;
}

Status thincells_fill(const ThinLayer *layer, int per_pixel, int column, int row, int columns,
                      int rows, ThinCells *cells, Err *err)
{
    const int tile_side = per_pixel * TILE_SIDE;
    thincells_clear(cells);
    if (!layer)
        return STATUS_OK;
    cells->columns = columns;
    cells->rows = rows;
    cells->per_pixel = per_pixel;
    TRY(make_room(cells, err));
    for (int y = row / tile_side; y <= (row + rows - 1) / tile_side && y < layer->tile_rows; y++)
        for (int x = column / tile_side;
             x <= (column + columns - 1) / tile_side && x < layer->tile_columns; x++)
            TRY(fill_tile(layer, x, y, column, row, cells, err));
    return STATUS_OK;
}

void thincells_release(ThinCells *cells)
{
    free(cells->first);
    free(cells->fragments);
    *cells = (ThinCells){0};
}

/* ---- from front to back ---------------------------------------------------------------------- */

/* The fragment that is nearest of those behind *last, and before z; NULL: none. Equal depths go by
 * their runs. */
static const ThinFragment *next_behind(const ThinCells *cells, uint32_t first,
                                       const ThinFragment *last, float z)
{
    const ThinFragment *next = NULL;
    float next_z = z, last_z = last ? last->z / last->area : 0;
    for (uint32_t i = first; i > 0; i = cells->fragments[i - 1].next) {
        const ThinFragment *at = &cells->fragments[i - 1];
        float at_z = at->z / at->area;
        bool is_behind = !last || at_z > last_z || (at_z == last_z && at->run > last->run);
        bool is_before = at_z < next_z || (at_z == next_z && (!next || at->run < next->run));
        if (at->area > 0 && is_behind && is_before) {
            next = at;
            next_z = at_z;
        }
    }
    return next;
}

void thincells_over(const ThinCells *cells, int column, int row, float z, float color[3])
{
    const uint32_t first = cells->first[row * cells->columns + column];
    float clear = 1, sum[3] = {0};
    const ThinFragment *at = NULL;
    while (clear > 0 && (at = next_behind(cells, first, at, z))) {
        float part = clear * least(1, at->area);
        for (int c = 0; c < 3; c++)
            sum[c] += part * at->color[c] / at->area;
        clear -= part;
    }
    for (int c = 0; c < 3; c++)
        color[c] = sum[c] + clear * color[c];
}
