/* A capsule about an item is seen within a range of rows. Of each row, what is within reach of its
 * slab is seen within a range of columns; in few tiles, the whole of it serves all rows. */
#include "render/rasterreach.h"

static const double slack_pixels = 1e-3; /* covers rounding where tiles are told apart */
enum { FEW_TILES = 2 };

static const RasterSpan nowhere = {1, 0};
static const RasterRange everywhere = {-HUGE_VAL, HUGE_VAL}, nothing = {HUGE_VAL, -HUGE_VAL};

static double min_of(double a, double b)
{
    return a < b ? a : b;
}

static double max_of(double a, double b)
{
    return a > b ? a : b;
}

/* A range as pixels, whose middles are whole numbers; pixel 0 is at `first`, and `per` pixels follow
 * in a unit. */
static RasterRange pixels_within(RasterRange range, double first, double per)
{
    double from = (range.low - first) * per, to = (range.high - first) * per;
    return (RasterRange){min_of(from, to) - slack_pixels, max_of(from, to) + slack_pixels};
}

/* The tiles of `count` pixels from pixel `least` on that samples in a range of pixels lie in. */
static RasterSpan tiles_within(RasterRange pixels, double stray, int least, int count)
{
    double low = max_of(pixels.low - stray, least);
    double high = min_of(pixels.high + stray, least + count - 1);
    if (!(low <= high))
        return nowhere;
    int first_pixel = (int)low - least, last_pixel = (int)high - least;
    first_pixel += first_pixel + least < low;
    return first_pixel <= last_pixel ? (RasterSpan){first_pixel / TILE_SIDE, last_pixel / TILE_SIDE}
                                     : nowhere;
}

/* What a ball at coordinate c in one direction of a perspective view's plane, and at depth z >
 * radius, covers there. */
static RasterRange ball_shadow(double c, double z, double radius)
{
    double half = radius * sqrt(max_of(c * c + z * z - radius * radius, 0));
    double per = 1 / ((z - radius) * (z + radius));
    return (RasterRange){(c * z - half) * per, (c * z + half) * per};
}

static Vec3 item_axis(const RasterItem *item)
{
    double sine = (double)item->sine;
    return vec3(sine * (double)item->ex, sine * (double)item->ey, (double)item->cosine);
}

static Vec3 item_point(const RasterItem *item, double along)
{
    return vec3_add_scaled(vec3(item->x, item->y, item->z), item_axis(item), along);
}

/* How far it reaches to both sides of its middle in depth. */
static double item_depth(const RasterItem *item)
{
    return (double)item->cosine * (double)item->half + (double)item->radius;
}

static RasterRange capsule_shadow(double c0, double z0, double c1, double z1, double radius)
{
    RasterRange one = ball_shadow(c0, z0, radius), other = ball_shadow(c1, z1, radius);
    return (RasterRange){min_of(one.low, other.low), max_of(one.high, other.high)};
}

static bool may_be_anywhere(const RasterView *view, const RasterItem *item)
{
    return view->perspective && item_is_close(item);
}

/* What the whole of it covers, across the view or up it. */
static RasterRange whole_range(const RasterView *view, const RasterItem *item, bool across)
{
    double half = (double)item->half, radius = (double)item->radius;
    if (view->perspective) {
        Vec3 a = item_point(item, -half), b = item_point(item, half);
        return capsule_shadow(across ? a.x : a.y, a.z, across ? b.x : b.y, b.z, radius);
    }
    double middle = across ? item->x : item->y;
    double slope = (double)(across ? item->ex : item->ey) * (double)item->sine;
    double reach = fabs(slope) * half + radius;
    return (RasterRange){middle - reach, middle + reach};
}

static RasterRange pixels_down(const RasterView *view, const RasterItem *item)
{
    if (may_be_anywhere(view, item))
        return everywhere;
    return pixels_within(whole_range(view, item, false), view->top, view->per_y);
}

RasterSpan rasterreach_rows(const RasterView *view, const RasterItem *item)
{
    if (item->z + item_depth(item) < 0)
        return nowhere;
    return tiles_within(pixels_down(view, item), view->stray, view->first, view->rows);
}

RasterSlab rasterslab_of(const RasterView *view, size_t row)
{
    int first = view->first + (int)row * TILE_SIDE, last = first + TILE_SIDE - 1;
    RasterSlab slab;
    slab.y[0] = view->top + (last + view->stray + slack_pixels) * view->step_y;
    slab.y[1] = view->top + (first - view->stray - slack_pixels) * view->step_y;
    for (int i = 0; i < 2; i++)
        slab.per_length[i] = 1 / sqrt(1 + slab.y[i] * slab.y[i]);
    return slab;
}

/* The part [*from, *to] of the way where something that is at_a at its beginning and at_b at its
 * end is not below 0. */
static void clip_part(double at_a, double at_b, double *from, double *to)
{
    if (at_a < 0)
        *from = at_b < 0 ? HUGE_VAL : max_of(*from, at_a / (at_a - at_b));
    else if (at_b < 0)
        *to = min_of(*to, at_a / (at_a - at_b));
}

/* What the part of the capsule within reach of the slab covers of a row. */
static RasterRange parallel_range(const RasterItem *item, const RasterSlab *slab)
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
    return (RasterRange){item->x + min_of(from, to) - radius, item->x + max_of(from, to) + radius};
}

static RasterRange perspective_range(const RasterItem *item, const RasterSlab *slab)
{
    double half = (double)item->half, radius = (double)item->radius, from = 0, to = 1;
    Vec3 a = item_point(item, -half), span = vec3_scale(item_axis(item), 2 * half);
    Vec3 b = vec3_add(a, span);
    for (int plane = 0; plane < 2; plane++) {
        double sign = plane ? -slab->per_length[plane] : slab->per_length[plane];
        double y = slab->y[plane];
        clip_part(sign * (a.y - y * a.z) + radius, sign * (b.y - y * b.z) + radius, &from, &to);
    }
    if (from > to)
        return nothing;
    Vec3 first = vec3_add_scaled(a, span, from), last = vec3_add_scaled(a, span, to);
    return capsule_shadow(first.x, first.z, last.x, last.z, radius);
}

/* The pixels across the picture that the part of the capsule within reach of a row's slab covers;
 * `slab` NULL: that the whole of it covers. */
static RasterRange pixels_across(const RasterView *view, const RasterItem *item,
                                 const RasterSlab *slab)
{
    if (may_be_anywhere(view, item))
        return everywhere;
    RasterRange range = !slab               ? whole_range(view, item, true)
                        : view->perspective ? perspective_range(item, slab)
                                            : parallel_range(item, slab);
    return range.low > range.high ? range : pixels_within(range, view->left, view->per_x);
}

static RasterSpan columns_of(const RasterView *view, RasterRange across)
{
    return tiles_within(across, view->stray, 0, view->columns);
}

RasterSpan rasterreach_columns(const RasterView *view, const RasterItem *item,
                               const RasterSlab *slab)
{
    return columns_of(view, pixels_across(view, item, slab));
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/* Where in a tile a pixel is, in parts of its side. */
static uint32_t part_of(double pixel, int tile)
{
    double part = (pixel - tile * TILE_SIDE + 0.5) * (RASTERBOX_PARTS / TILE_SIDE);
    return (uint32_t)(int)min_of(max_of(part, 0), RASTERBOX_PARTS - 1);
}

/* The box in the tiles of a row, counted from that of pixel 0. */
static uint32_t box_of(RasterSpan columns, RasterRange across, int row, RasterRange down)
{
    const uint32_t last = RASTERBOX_PARTS - 1;
    return RASTERBOX_GUARDS | part_of(across.high, columns.last) |
           (last - part_of(across.low, columns.first)) << 8 | part_of(down.high, row) << 16 |
           (last - part_of(down.low, row)) << 24;
}

RasterReach rasterreach_of(const RasterView *view, const RasterItem *item)
{
    RasterReach reach = {.down = pixels_down(view, item),
                         .across = pixels_across(view, item, NULL)};
    double near = item->z - item_depth(item) - view->z_middle;
    reach.near = (float)(near - 1e-6 * fabs(near));
    reach.columns = columns_of(view, reach.across);
    return reach;
}

RasterSpan rasterreach_box(const RasterReach *reach, const RasterView *view, const RasterItem *item,
                           RasterSpan rows, int row, const RasterSlab *slab, RasterBox *box)
{
    RasterSpan columns = reach->columns;
    RasterRange across = reach->across;
    if (rows.last - rows.first >= FEW_TILES || columns.last - columns.first >= FEW_TILES) {
        across = pixels_across(view, item, slab);
        columns = columns_of(view, across);
    }
    *box = (RasterBox){box_of(columns, across, view->first / TILE_SIDE + row, reach->down),
                       reach->near};
    return columns;
}
