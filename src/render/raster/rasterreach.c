/* Finds the rows and columns of tiles that an item (a projected primitive) may touch, and the items
 * that no sample can hit. An item's capsule stands for it.
 *
 * With one sample at the centre of each pixel, no sample hits a third of the vessels of a tree of a
 * million, because they are short and thin. These vessels are found first and left out, by their
 * distances from the few samples near them.
 *
 * A capsule covers a range of rows of tiles. In each row, the part of the capsule near the row's
 * slab, the space that its lines of sight fill, covers a range of columns. If the item touches few
 * tiles, the columns of the whole item are used in all rows. */
#include "render/raster/rasteritem.h"

static const Interval everywhere = {-HUGE_VAL, HUGE_VAL}, nothing = {HUGE_VAL, -HUGE_VAL};

static Vec3 item_axis(const RasterItem *item)
{
    double sine = (double)item->sine;
    return vec3(sine * (double)item->ex, sine * (double)item->ey, (double)item->cosine);
}

static Vec3 item_point(const RasterItem *item, double along)
{
    return vec3_add_scaled(vec3(item->x, item->y, item->z), item_axis(item), along);
}

RasterSlab rasterslab_of(const RasterView *view, size_t row)
{
    int first = (int)row * TILE_SIDE, last = first + TILE_SIDE - 1;
    RasterSlab slab;
    slab.y[0] = view->top + (last + view->max_offset + SLACK_SAMPLES) * view->step_y;
    slab.y[1] = view->top + (first - view->max_offset - SLACK_SAMPLES) * view->step_y;
    for (int i = 0; i < 2; i++)
        slab.per_length[i] = 1 / sqrt(1 + slab.y[i] * slab.y[i]);
    return slab;
}

/* Returns the extent, across the view, of the part of the capsule that may lie in the slab: of the
 * part of its axis that is within its radius of the slab. For a parallel view. */
static Interval parallel_range(const RasterItem *item, const RasterSlab *slab)
{
    double radius = (double)item->radius, ex = (double)item->ex, ey = (double)item->ey;
    double half = (double)item->sine * (double)item->half, low = -half, high = half;
    double below = slab->y[0] - radius - item->y, over = slab->y[1] + radius - item->y;
    double rise = fabs(ey) * half;
    if (-rise > over || rise < below)
        return nothing;
    if (-rise < below || rise > over) {
        double per = 1 / ey, one = below * per, other = over * per;
        low = max_of(low, min_of(one, other));
        high = min_of(high, max_of(one, other));
    }
    double from = ex * low, to = ex * high;
    return (Interval){item->x + min_of(from, to) - radius, item->x + max_of(from, to) + radius};
}

/* The same for a perspective view. */
static Interval perspective_range(const RasterItem *item, const RasterSlab *slab)
{
    double half = (double)item->half, radius = (double)item->radius, from = 0, to = 1;
    Vec3 a = item_point(item, -half), span = vec3_scale(item_axis(item), 2 * half);
    Vec3 b = vec3_add(a, span);
    for (int plane = 0; plane < 2; plane++) {
        double sign = plane ? -slab->per_length[plane] : slab->per_length[plane];
        double y = slab->y[plane];
        clip_parameters(sign * (a.y - y * a.z) + radius, sign * (b.y - y * b.z) + radius, &from,
                        &to);
    }
    if (from > to)
        return nothing;
    Vec3 first = vec3_add_scaled(a, span, from), last = vec3_add_scaled(a, span, to);
    return capsule_extent(true, first.x, first.z, last.x, last.z, radius);
}

static TileSpan columns_of(const RasterView *view, Interval across)
{
    return tilespan_intersection(tilespan_of_samples(across, view->max_offset, view->columns),
                                 view->listed_columns);
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/* Returns the position of a pixel in a tile, in units of RASTERBOX_PARTS per side. */
static uint32_t part_of(double pixel, int tile)
{
    double part = (pixel - tile * TILE_SIDE + 0.5) * (RASTERBOX_PARTS / TILE_SIDE);
    return (uint32_t)(int)min_of(max_of(part, 0), RASTERBOX_PARTS - 1);
}

/* Packs two bounds: the low bound as a position in the first tile, the high bound in the last. */
static uint32_t parts_of(Interval pixels, TileSpan tiles)
{
    return part_of(pixels.high, tiles.last) |
           (RASTERBOX_PARTS - 1 - part_of(pixels.low, tiles.first)) << 8;
}

/* ---- items ----------------------------------------------------------------------------------- */

/* Returns the pixels that the whole item covers, across the image or down the image. */
static inline Interval whole_pixels(const RasterView *view, const RasterItem *item, bool across)
{
    double half = (double)item->half, radius = (double)item->radius;
    double middle = across ? item->x : item->y, slope = (double)(across ? item->ex : item->ey);
    double reach = fabs(slope) * (double)item->sine * half + radius;
    Interval range = {middle - reach, middle + reach};
    if (view->eye.perspective) {
        if (item_is_close(item))
            return everywhere;
        Vec3 a = item_point(item, -half), b = item_point(item, half);
        range = capsule_extent(true, across ? a.x : a.y, a.z, across ? b.x : b.y, b.z, radius);
    }
    return across ? interval_in_samples(range, view->left, view->per_x)
                  : interval_in_samples(range, view->top, view->per_y);
}

/* Returns true if the item is entirely behind the viewer. */
static bool is_behind(const RasterItem *item)
{
    return item->z + item_half_depth(item) < 0;
}

/* Returns the samples within `reach` of `middle`. There are `count` samples, `per` per unit, the
 * first at `first`. */
static inline SampleSpan samples_about(double middle, double reach, double first, double per,
                                       double max_offset, int count)
{
    Interval range = interval_in_samples((Interval){middle - reach, middle + reach}, first, per);
    return samplespan_within(range, max_offset, count);
}

/* Returns true if a point is within the distance sqrt(reach2) of a segment. (dx, dy) leads from the
 * middle of the segment to the point. */
static inline bool is_within(double dx, double dy, Vec3 span, double length2, double reach2)
{
    double along = dx * span.x + dy * span.y, across = dx * span.y - dy * span.x;
    if (2 * fabs(along) < length2)
        return across * across <= reach2 * length2;
    double end = along < 0 ? -0.5 : 0.5, x = dx - end * span.x, y = dy - end * span.y;
    return x * x + y * y <= reach2;
}

/* Returns true if all these samples, at the centres of their pixels, are farther from a capsule's
 * axis than its radius. */
static bool samples_are_beside(const RasterView *view, SampleSpan columns, SampleSpan rows,
                               Vec3 middle, Vec3 span, double radius)
{
    double reach = radius + SLACK_SAMPLES * max_of(view->step_x, -view->step_y);
    double length2 = span.x * span.x + span.y * span.y;
    for (int j = rows.first; j <= rows.last; j++)
        for (int i = columns.first; i <= columns.last; i++)
            if (is_within(view->left + i * view->step_x - middle.x,
                          view->top + j * view->step_y - middle.y, span, length2, reach * reach))
                return false;
    return true;
}

/* Returns true if a ball is beyond the lines of sight at one edge of a range of tiles. Works in the
 * plane of z and of one axis; `at` is the ball's coordinate on that axis, and `pixel` is the first
 * pixel beyond the edge. */
static inline bool is_beyond(double at, double z, double radius, double pixel, double first,
                             double step, bool above)
{
    double line = first + pixel * step, off = at - line * z;
    return (above ? off : -off) > radius * (1 + fabs(line));
}

/* Returns true if a ball is outside all tiles of a perspective view. */
static bool is_beside(const RasterView *view, Vec3 middle, double radius)
{
    const TileSpan *columns = &view->listed_columns, *rows = &view->listed_rows;
    double left = columns->first * TILE_SIDE - 1, right = (columns->last + 1) * TILE_SIDE;
    double top = rows->first * TILE_SIDE - 1, bottom = (rows->last + 1) * TILE_SIDE;
    return is_beyond(middle.x, middle.z, radius, left, view->left, view->step_x, false) ||
           is_beyond(middle.x, middle.z, radius, right, view->left, view->step_x, true) ||
           is_beyond(middle.y, middle.z, radius, top, view->top, view->step_y, true) ||
           is_beyond(middle.y, middle.z, radius, bottom, view->top, view->step_y, false);
}

bool rasterreach_misses(const RasterView *view, Vec3 middle, Vec3 span, double radius)
{
    /* The samples are tested one by one only if there are at most this many. A capsule near more
     * samples is seldom missed by all of them. */
    enum { FEW = 4 };
    if (view->eye.perspective)
        return is_beside(view, middle, radius + vec3_length(span) / 2);
    SampleSpan columns = samples_about(middle.x, fabs(span.x) / 2 + radius, view->left, view->per_x,
                                       view->max_offset, view->columns);
    SampleSpan rows = samples_about(middle.y, fabs(span.y) / 2 + radius, view->top, view->per_y,
                                    view->max_offset, view->rows);
    int wide = columns.last - columns.first + 1, high = rows.last - rows.first + 1;
    if (wide <= 0 || high <= 0)
        return true;
    return view->many && wide <= FEW && high <= FEW && wide * high <= FEW &&
           view->max_offset == 0 && 2 * radius < view->step_x &&
           samples_are_beside(view, columns, rows, middle, span, radius);
}

void rasterreach_set(const RasterView *view, RasterItem *item)
{
    TileSpan rows = NO_TILES, columns = NO_TILES;
    if (!is_behind(item)) {
        Interval across = whole_pixels(view, item, true), down = whole_pixels(view, item, false);
        rows = tilespan_intersection(tilespan_of_samples(down, view->max_offset, view->rows),
                                     view->listed_rows);
        columns = columns_of(view, across);
        if (columns.first > columns.last)
            rows = NO_TILES;
        if (view->light)
            item->box = RASTERBOX_GUARDS | parts_of(across, columns) | parts_of(down, rows) << 16;
    }
    item->rows = rastertiles_of(rows);
    item->columns = rastertiles_of(columns);
}

float rasterreach_near(const RasterView *view, const RasterItem *item)
{
    double near = item->z - item_half_depth(item) - view->z_middle;
    return (float)(near - 1e-6 * fabs(near)); /* the margin keeps rounding from raising it */
}

TileSpan rasterreach_in_row(const RasterView *view, const RasterItem *item, int row,
                            const RasterSlab *slab, uint32_t *box)
{
    TileSpan columns = {item->columns.first, item->columns.last};
    *box = item->box | (row < item->rows.last ? RASTERBOX_X_MAX_BITS << 16 : 0) |
           (row > item->rows.first ? RASTERBOX_X_MIN_BITS << 16 : 0);
    /* A light view also needs the box in each row, so only items in up to two rows or columns skip
     * the computation. */
    int few = view->light ? 1 : 0;
    if (item->rows.last - item->rows.first <= few || columns.last - columns.first <= few ||
        (view->eye.perspective && item_is_close(item)))
        return columns;
    Interval range =
        view->eye.perspective ? perspective_range(item, slab) : parallel_range(item, slab);
    if (range.low > range.high)
        return NO_TILES;
    range = interval_in_samples(range, view->left, view->per_x);
    columns = columns_of(view, range);
    if (view->light)
        *box = (*box & ~(RASTERBOX_X_MAX_BITS | RASTERBOX_X_MIN_BITS)) | parts_of(range, columns);
    return columns;
}
