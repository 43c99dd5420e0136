/* Draws a page as pixels.
 *
 * FreeType's rasterizer fills glyphs, polygons and lines: it converts outlines to spans of exact
 * coverage, which are blended into the rows. The result does not depend on how the page is divided
 * into bands. Boxes, and lines parallel to the pixel grid, are rounded to whole pixels, so that
 * their edges are sharp. A pixel of a ramp has the color at its centre. Each segment of a polyline
 * is a separate polygon. */
#include "figure/artwork.h"
#include "figure/fonts.h"
#include "figure/items.h"

#include <math.h>
#include <stdlib.h>
#include FT_OUTLINE_H
#include FT_STROKER_H

/* The band of the page that is being drawn. Coordinates of outlines are in 1/64 pixels, x to the
 * right and y up. They are relative to the pixel (`left`, `top`), because spans have 16-bit
 * coordinates. */
typedef struct PixelRows {
    const FigurePage *page;
    Picture *rows;
    int first; /* index in the page of the first row */
    int left, top;
    const uint8_t *color;
} PixelRows;

static double pixels_of(const PixelRows *target, double mm)
{
    return mm / MM_PER_INCH * target->page->dpi;
}

/* Blends an 8-bit color over the fraction `alpha` / 255 of a pixel. If there is a channel of black
 * ink, black is blended into this channel only, and any other color reduces it. */
static void blend(Picture *rows, size_t pixel, const uint8_t color[3], unsigned alpha)
{
    const size_t channels = (size_t)rows->channels;
    const unsigned scale = rows->bits == 8 ? 1 : 257;
    const bool black = channels == 4 && color[0] + color[1] + color[2] == 0;
    for (size_t c = black ? 3 : 0; c < channels; c++) {
        const unsigned above = c < 3 ? color[c] : black ? 255 : 0;
        unsigned below = picture_code(rows, channels * pixel + c);
        unsigned sum = above * scale * alpha + below * (255 - alpha);
        picture_set(rows, channels * pixel + c, (uint16_t)((sum + 127) / 255));
    }
}

/* ---- outlines -------------------------------------------------------------------------------- */

/* A callback of FreeType: blends the color over the spans of a row. */
static void take_spans(int y, int count, const FT_Span *spans, void *user)
{
    const PixelRows *target = user;
    const int row = target->top - 1 - y - target->first;
    if (row < 0 || row >= target->rows->height)
        return;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < spans[i].len; k++) {
            int column = target->left + spans[i].x + k;
            if (column >= 0 && column < target->rows->width)
                blend(target->rows, (size_t)row * (size_t)target->rows->width + (size_t)column,
                      target->color, spans[i].coverage);
        }
}

/* Fills an outline with the color of the target. */
static Status fill(PixelRows *target, FT_Outline *outline, Err *err)
{
    FT_Raster_Params params = {.source = outline,
                               .flags = FT_RASTER_FLAG_AA | FT_RASTER_FLAG_DIRECT,
                               .gray_spans = take_spans,
                               .user = target};
    if (FT_Outline_Render(fonts_library(target->page->fonts), outline, &params))
        return mem_out_of("for", "the page", err);
    return STATUS_OK;
}

/* Converts a pixel position on the page to the coordinates of outlines. */
static FT_Vector vector_of(const PixelRows *target, double x, double y)
{
    return (FT_Vector){lround(64 * (x - target->left)), lround(64 * (target->top - y))};
}

static Status fill_polygon(PixelRows *target, const FigurePoint *corner, int n, Err *err)
{
    FT_Vector points[FIGURE_CORNERS];
    char on[FIGURE_CORNERS];
    short end = (short)(n - 1);
    for (int i = 0; i < n; i++) {
        points[i] = vector_of(target, corner[i].x, corner[i].y);
        on[i] = FT_CURVE_TAG_ON;
    }
    FT_Outline outline = {
        .n_contours = 1, .n_points = (short)n, .points = points, .tags = on, .contours = &end};
    return fill(target, &outline, err);
}

/* ---- outlines around outlines ---------------------------------------------------------------- */

/* Sets the width of a stroker's lines. FreeType takes half the width, in 1/64 pixels. */
static void set_width(FT_Stroker stroker, double pixels)
{
    FT_Stroker_Set(stroker, lround(32 * pixels), FT_STROKER_LINECAP_ROUND,
                   FT_STROKER_LINEJOIN_ROUND, 0);
}

/* Exports the outline of the stroker's paths. Release *outline with FT_Outline_Done. */
static FT_Error export_outline(const PixelRows *target, FT_Stroker stroker, FT_Outline *outline)
{
    FT_UInt points, contours;
    FT_Error failed = FT_Stroker_GetCounts(stroker, &points, &contours);
    if (!failed)
        failed =
            FT_Outline_New(fonts_library(target->page->fonts), points, (FT_Int)contours, outline);
    if (failed)
        return failed;
    outline->n_points = outline->n_contours = 0;
    FT_Stroker_Export(stroker, outline);
    return FT_Err_Ok;
}

/* Draws the contours of an outline as lines of `width` pixels. */
static Status fill_around(PixelRows *target, FT_Outline *around, double width, Err *err)
{
    FT_Stroker stroker;
    FT_Outline outline;
    if (FT_Stroker_New(fonts_library(target->page->fonts), &stroker))
        return mem_out_of("for", "letters", err);
    set_width(stroker, width);
    FT_Error failed = FT_Stroker_ParseOutline(stroker, around, 0);
    if (!failed)
        failed = export_outline(target, stroker, &outline);
    FT_Stroker_Done(stroker);
    if (failed)
        return mem_out_of("for", "letters", err);
    Status status = fill(target, &outline, err);
    FT_Outline_Done(fonts_library(target->page->fonts), &outline);
    return status;
}

/* ---- items ----------------------------------------------------------------------------------- */

/* Returns true if the item's corners are those of a rectangle parallel to the axes. */
static bool is_box(const FigureItem *item)
{
    return item->n == 4 && item->at[0].x == item->at[3].x && item->at[1].x == item->at[2].x &&
           item->at[0].y == item->at[1].y && item->at[2].y == item->at[3].y;
}

static Status draw_shape(PixelRows *target, const FigureItem *item, Err *err)
{
    FigurePoint corner[FIGURE_CORNERS];
    for (int i = 0; i < item->n; i++) {
        double x = pixels_of(target, item->at[i].x), y = pixels_of(target, item->at[i].y);
        corner[i] = is_box(item) ? (FigurePoint){round(x), round(y)} : (FigurePoint){x, y};
    }
    return fill_polygon(target, corner, item->n, err);
}

/* Draws a segment of a line. Each end extends by half the width. */
static Status draw_stroke(PixelRows *target, FigurePoint from, FigurePoint to, double width,
                          Err *err)
{
    double x = to.x - from.x, y = to.y - from.y, length = elementary_hypot(x, y);
    if (!(length > 0))
        return STATUS_OK;
    x *= width / 2 / length;
    y *= width / 2 / length;
    const FigurePoint corner[] = {{from.x - x - y, from.y - y + x},
                                  {to.x + x - y, to.y + y + x},
                                  {to.x + x + y, to.y + y - x},
                                  {from.x - x + y, from.y - y - x}};
    return fill_polygon(target, corner, 4, err);
}

/* Draws a line whose width is rounded to an integer number of pixels, at least 1. The edges of a
 * line parallel to the pixel grid are on edges of pixels. */
static Status draw_line(PixelRows *target, const FigureItem *item, Err *err)
{
    const double width = fmax(1, round(pixels_of(target, item->width_mm)));
    const double half = fmod(width, 2) / 2;
    const bool along =
        is_box(item) ||
        (item->n == 2 && (item->at[0].x == item->at[1].x || item->at[0].y == item->at[1].y));
    FigurePoint at[FIGURE_CORNERS];
    for (int i = 0; i < item->n; i++) {
        double x = pixels_of(target, item->at[i].x), y = pixels_of(target, item->at[i].y);
        at[i] = along ? (FigurePoint){round(x - half) + half, round(y - half) + half}
                      : (FigurePoint){x, y};
    }
    for (int i = 0; i + 1 < item->n + item->closed; i++)
        TRY(draw_stroke(target, at[i], at[(i + 1) % item->n], width, err));
    return STATUS_OK;
}

/* Draws a rectangle whose color is interpolated between the stops of the ramp. */
static Status draw_ramp(PixelRows *target, const FigureItem *item, Err *err)
{
    (void)err;
    const int left = (int)round(pixels_of(target, item->box.left));
    const int right = (int)round(pixels_of(target, item->box.right));
    const int top = (int)round(pixels_of(target, item->box.top));
    const int bottom = (int)round(pixels_of(target, item->box.bottom));
    for (int y = 0; y < target->rows->height; y++)
        for (int x = left < 0 ? 0 : left; x < right && x < target->rows->width; x++) {
            int row = target->first + y;
            double position = item->upwards ? (bottom - row - 0.5) / (bottom - top)
                                            : (x + 0.5 - left) / (right - left);
            if (row < top || row >= bottom)
                continue;
            double stop = position * (FIGURE_STOPS - 1);
            int i = (int)fmin(stop, FIGURE_STOPS - 2);
            uint8_t color[3];
            for (int c = 0; c < 3; c++) {
                double a = item->ramp[i].rgb[c], b = item->ramp[i + 1].rgb[c];
                color[c] = (uint8_t)lround(a + (stop - i) * (b - a));
            }
            blend(target->rows, (size_t)y * (size_t)target->rows->width + (size_t)x, color, 255);
        }
    return STATUS_OK;
}

/* Draws a glyph of a line of text that begins at `at`. `size` is the font size in pixels. With
 * outline_px above 0, draws the glyph's outline as a line of this width as well. FreeType owns the
 * outline until the next glyph is loaded. The outline's points are converted in place. */
static Status draw_glyph(PixelRows *target, const Glyph *glyph, FigurePoint at, double size,
                         double outline_px, Err *err)
{
    FT_Face face = fonts_face(target->page->fonts, glyph->face);
    if (FT_Load_Glyph(face, glyph->index, FT_LOAD_NO_SCALE))
        return mem_out_of("for", "letters", err);
    FT_Outline *outline = &face->glyph->outline;
    const double scale = glyph->scale * size / face->units_per_EM;
    for (int i = 0; i < outline->n_points; i++) {
        FT_Vector *point = &outline->points[i];
        *point = vector_of(target, at.x + glyph->x * size + (double)point->x * scale,
                           at.y - glyph->rise * size - (double)point->y * scale);
    }
    if (outline_px > 0)
        TRY(fill_around(target, outline, outline_px, err));
    return fill(target, outline, err);
}

static Status draw_text(PixelRows *target, const FigureItem *item, Err *err)
{
    const FigureFonts *fonts = target->page->fonts;
    const FigurePoint at = {pixels_of(target, item->box.left), pixels_of(target, item->at[0].y)};
    const double size = pixels_of(target, item->size_pt * MM_PER_POINT);
    const double outline_px = pixels_of(target, item->outline_mm);
    Glyphs glyphs;
    TRY(fonts_shape(fonts, item->text, item->bold, &glyphs, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < glyphs.n && status == STATUS_OK; i++)
        status = draw_glyph(target, &glyphs.glyph[i], at, size, outline_px, err);
    glyphs_release(&glyphs);
    return status;
}

/* ---- strokes --------------------------------------------------------------------------------- */

/* Maximum number of stroke points per outline. An outline stores the number of its points in 16
 * bits. The stroker makes about ten points of each, most at round joints, so 256 is far below the
 * limit. Parts share a point, where the round ends hide the joint. */
enum { STROKE_POINTS = 256 };

/* Makes the outline of `n` points of a stroke. The points are mm relative to `at`. */
static FT_Error stroke_outline(PixelRows *target, FT_Stroker stroker, FigurePoint at,
                               const double (*point)[2], size_t n, FT_Outline *outline)
{
    FT_Error failed = FT_Err_Ok;
    target->left = (int)floor(pixels_of(target, at.x + point[0][0]));
    target->top = (int)floor(pixels_of(target, at.y + point[0][1]));
    FT_Stroker_Rewind(stroker);
    for (size_t i = 0; i < n && !failed; i++) {
        FT_Vector to = vector_of(target, pixels_of(target, at.x + point[i][0]),
                                 pixels_of(target, at.y + point[i][1]));
        failed = i ? FT_Stroker_LineTo(stroker, &to) : FT_Stroker_BeginSubPath(stroker, &to, 1);
    }
    if (!failed)
        failed = FT_Stroker_EndSubPath(stroker);
    return failed ? failed : export_outline(target, stroker, outline);
}

/* Draws up to STROKE_POINTS points of a stroke. */
static Status draw_stroke_part(PixelRows *target, FT_Stroker stroker, FigurePoint at,
                               const double (*point)[2], size_t n, Err *err)
{
    FT_Outline outline;
    if (stroke_outline(target, stroker, at, point, n, &outline))
        return mem_out_of("for", "lines", err);
    Status status = fill(target, &outline, err);
    FT_Outline_Done(fonts_library(target->page->fonts), &outline);
    return status;
}

static Status draw_strokes(PixelRows *target, const FigureItem *item, Err *err)
{
    const Strokes *all = item->strokes;
    FT_Stroker stroker;
    Status status = STATUS_OK;
    if (FT_Stroker_New(fonts_library(target->page->fonts), &stroker))
        return mem_out_of("for", "lines", err);
    for (size_t i = 0; i < all->n && status == STATUS_OK; i++) {
        const Stroke *stroke = &all->strokes[i];
        set_width(stroker, pixels_of(target, stroke->width_mm));
        for (size_t k = 0; k + 1 < stroke->n && status == STATUS_OK; k += STROKE_POINTS - 1) {
            size_t n = stroke->n - k < STROKE_POINTS ? stroke->n - k : STROKE_POINTS;
            status =
                draw_stroke_part(target, stroker, item->at[0],
                                 (const double(*)[2]) & all->points[stroke->first + k], n, err);
        }
    }
    FT_Stroker_Done(stroker);
    return status;
}

/* Copies the pixels of a picture to its place in the rows. */
static Status draw_picture(PixelRows *target, const FigureItem *item, Err *err)
{
    (void)err;
    const Picture *picture = item->picture;
    Picture *rows = target->rows;
    int columns = picture->width;
    if (columns > rows->width - item->column)
        columns = rows->width - item->column;
    for (int y = 0; y < picture->height; y++) {
        int row = item->row + y - target->first;
        if (row < 0 || row >= rows->height)
            continue;
        const size_t channels = (size_t)rows->channels;
        size_t to = (size_t)row * picture_stride(rows) + channels * (size_t)item->column;
        for (size_t i = 0; i < 3 * (size_t)columns; i++) {
            uint16_t code = picture_code(picture, (size_t)y * picture_stride(picture) + i);
            picture_set(rows, to + i / 3 * channels + i % 3,
                        rows->bits == 8 ? code : (uint16_t)(code * 257));
        }
    }
    return STATUS_OK;
}

/* Rounds the artwork's box to whole pixels, and draws the artwork as a picture. */
static Status draw_artwork(PixelRows *target, const FigureItem *item, Err *err)
{
    const FigureBox *box = &item->box;
    const int left = figure_pixels(target->page, box->left);
    const int top = figure_pixels(target->page, box->top);
    const int width = figure_pixels(target->page, box->right) - left;
    const int height = figure_pixels(target->page, box->bottom) - top;
    Picture picture;
    if (width < 1 || height < 1)
        return STATUS_OK;
    TRY(artwork_rasterize(item->artwork, width, height, target->page->background, &picture, err));
    const FigureItem pixels = {.picture = &picture, .column = left, .row = top};
    Status status = draw_picture(target, &pixels, err);
    picture_release(&picture);
    return status;
}

static Status draw_bars(PixelRows *target, const FigureItem *item, Err *err)
{
    for (size_t i = 0; i < item->bars->n; i++) {
        const FigureItem bar = figure_bar(item, i);
        target->color = bar.color.rgb;
        TRY(draw_shape(target, &bar, err));
    }
    return STATUS_OK;
}

/* Returns true if the item may cover a pixel of the rows. The box is enlarged, because rounding
 * moves an item by up to one pixel, and accents and tall letters of DejaVu Sans extend beyond a
 * text's box by less than the font size. */
static bool may_cover(const PixelRows *target, const FigureItem *item)
{
    const double beyond = 2 + pixels_of(target, item->size_pt * MM_PER_POINT);
    return pixels_of(target, item->box.bottom) + beyond > target->first &&
           pixels_of(target, item->box.top) - beyond < target->first + target->rows->height;
}

/* A FigurePut. */
static Status draw_item(void *context, const FigureItem *item, Err *err)
{
    static Status (*const draw[FIGURE_KINDS])(PixelRows *, const FigureItem *, Err *) = {
        [FIGURE_PICTURE] = draw_picture, [FIGURE_SHAPE] = draw_shape,    [FIGURE_LINE] = draw_line,
        [FIGURE_RAMP] = draw_ramp,       [FIGURE_TEXT] = draw_text,      [FIGURE_BARS] = draw_bars,
        [FIGURE_STROKES] = draw_strokes, [FIGURE_ARTWORK] = draw_artwork};
    PixelRows *target = context;
    if (!may_cover(target, item))
        return STATUS_OK;
    target->color = item->color.rgb;
    target->left = (int)floor(pixels_of(target, item->box.left)) - 1;
    target->top = (int)floor(pixels_of(target, item->box.top)) - 1;
    return draw[item->kind](target, item, err);
}

Status figure_draw(const FigurePage *page, int first, Picture *rows, Err *err)
{
    static FigurePut *const put[FIGURE_KINDS] = {draw_item, draw_item, draw_item, draw_item,
                                                 draw_item, draw_item, draw_item, draw_item};
    PixelRows target = {.page = page, .rows = rows, .first = first};
    return figure_put_items(page, put, &target, err);
}

/* ---- bars in linear light --------------------------------------------------------------------
 *
 * The color of a pixel is the mean over its area. Bars do not overlap, so the covered areas and the
 * colors weighted by area can be summed in any order. The rest of the pixel is background. */

/* Channels of the plane of sums: three of color times area, and the covered area of the pixel. */
enum { COVERED = 3, SUMS = 4 };

/* Returns the length of the part of pixel `at` between two positions on an axis, 0 to 1. */
static double covered(int at, double from, double to)
{
    return fmax(0, fmin(to, at + 1) - fmax(from, at));
}

/* Return the first pixel that an interval touches, and the pixel after the last one. */
static int first_pixel(double from)
{
    return (int)fmax(0, floor(from));
}

static int end_pixel(double to, int size)
{
    return (int)fmin(size, ceil(to));
}

/* Adds the bar between the pixel positions x[0] and x[1], y[0] and y[1]. */
static void add_bar(const double x[2], const double y[2], const float color[3], Plane *sums)
{
    for (int row = first_pixel(y[0]); row < end_pixel(y[1], sums->height); row++)
        for (int at = first_pixel(x[0]); at < end_pixel(x[1], sums->width); at++) {
            float *sum = &sums->values[SUMS * ((size_t)row * (size_t)sums->width + (size_t)at)];
            float part = (float)(covered(row, y[0], y[1]) * covered(at, x[0], x[1]));
            for (int c = 0; c < 3; c++)
                sum[c] += part * color[c];
            sum[COVERED] += part;
        }
}

/* Converts the sums to colors. Because of rounding, the sum of the areas may slightly exceed 1. */
static void mix(const Plane *sums, const float background[3], Plane *color)
{
    size_t pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *sum = &sums->values[SUMS * i];
        float part = fmaxf(1, sum[COVERED]), rest = fmaxf(0, 1 - sum[COVERED]);
        for (int c = 0; c < 3; c++)
            color->values[3 * i + (size_t)c] = sum[c] / part + rest * background[c];
    }
}

Status figure_draw_bars(const FigureBars *bars, double scale, const double offset[2],
                        const float background[3], Plane *color, Err *err)
{
    Plane sums;
    TRY(plane_init(&sums, color->width, color->height, SUMS, err));
    for (size_t i = 0; i < bars->n; i++) {
        const FigureBar *bar = &bars->bars[i];
        const double x[2] = {offset[0] + scale * bar->x[0], offset[0] + scale * bar->x[1]};
        const double y[2] = {offset[1] + scale * bar->y[0], offset[1] + scale * bar->y[1]};
        add_bar(x, y, bars->color[bar->index], &sums);
    }
    mix(&sums, background, color);
    plane_release(&sums);
    return STATUS_OK;
}
