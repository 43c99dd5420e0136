/* Pages through cairo, as PDF and as pixels.
 *
 * A PDF has text as text, in subsets of the two fonts, and no date but one that is always the same.
 *
 * Pixels are drawn in squares of SQUARE pixels, those alone on which something lies, so that a band
 * of any width costs the memory of one. They stand on a grid of their own, so that a pixel is the
 * same whatever band it is drawn with. In them text is filled outlines: cairo would put letters on
 * whole pixels, and keep them for the next square. Boxes and lines along the grid keep to whole
 * pixels, so that they are sharp. */
#include "figure/fonts.h"

#include <cairo-pdf.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SQUARE = 256 };

/* What is drawn to: the context's unit is the mm. */
typedef struct Canvas {
    cairo_t *cairo;
    const FigurePage *page;
    bool of_pixels;
} Canvas;

static Status check(cairo_status_t failed, const char *what, Err *err)
{
    if (failed == CAIRO_STATUS_SUCCESS)
        return STATUS_OK;
    if (failed == CAIRO_STATUS_NO_MEMORY)
        return mem_out_of("for", "the page", err);
    return err_set(err, STATUS_IO, "%s: %s", what, cairo_status_to_string(failed));
}

static void set_color(const Canvas *canvas, FigureColor color)
{
    cairo_set_source_rgb(canvas->cairo, color.rgb[0] / 255.0, color.rgb[1] / 255.0,
                         color.rgb[2] / 255.0);
}

/* To whole pixels, or as many and a half. */
static double snapped(const Canvas *canvas, double mm, double half)
{
    double pixel = MM_PER_INCH / canvas->page->dpi;
    return canvas->of_pixels ? (round(mm / pixel - half) + half) * pixel : mm;
}

static FigureBox snapped_box(const Canvas *canvas, FigureBox box)
{
    return (FigureBox){snapped(canvas, box.left, 0), snapped(canvas, box.top, 0),
                       snapped(canvas, box.right, 0), snapped(canvas, box.bottom, 0)};
}

static bool is_box(const FigureItem *item)
{
    return item->n == 4 && item->at[0].x == item->at[3].x && item->at[1].x == item->at[2].x &&
           item->at[0].y == item->at[1].y && item->at[2].y == item->at[3].y;
}

static void put_box(const Canvas *canvas, FigureBox box)
{
    FigureBox at = snapped_box(canvas, box);
    cairo_rectangle(canvas->cairo, at.left, at.top, at.right - at.left, at.bottom - at.top);
}

static void put_shape(const Canvas *canvas, const FigureItem *item)
{
    set_color(canvas, item->color);
    if (is_box(item))
        put_box(canvas, item->box);
    for (int i = 0; i < item->n && !is_box(item); i++)
        cairo_line_to(canvas->cairo, item->at[i].x, item->at[i].y);
    cairo_close_path(canvas->cairo);
    cairo_fill(canvas->cairo);
}

/* A line of a whole number of pixels, at least one; along the grid its edges are those of pixels.
 */
static void put_line(const Canvas *canvas, const FigureItem *item)
{
    double pixel = MM_PER_INCH / canvas->page->dpi;
    double pixels = fmax(1, round(item->width_mm / pixel));
    bool along =
        is_box(item) ||
        (item->n == 2 && (item->at[0].x == item->at[1].x || item->at[0].y == item->at[1].y));
    double half = fmod(pixels, 2) / 2;
    set_color(canvas, item->color);
    cairo_set_line_width(canvas->cairo, canvas->of_pixels ? pixels * pixel : item->width_mm);
    for (int i = 0; i < item->n; i++)
        cairo_line_to(canvas->cairo, along ? snapped(canvas, item->at[i].x, half) : item->at[i].x,
                      along ? snapped(canvas, item->at[i].y, half) : item->at[i].y);
    if (item->closed)
        cairo_close_path(canvas->cairo);
    cairo_stroke(canvas->cairo);
}

static void put_ramp(const Canvas *canvas, const FigureItem *item)
{
    const FigureBox *box = &item->box;
    cairo_pattern_t *ramp = item->upwards
                                ? cairo_pattern_create_linear(0, box->bottom, 0, box->top)
                                : cairo_pattern_create_linear(box->left, 0, box->right, 0);
    for (int i = 0; i < FIGURE_STOPS; i++) {
        const uint8_t *rgb = item->ramp[i].rgb;
        cairo_pattern_add_color_stop_rgb(ramp, (double)i / (FIGURE_STOPS - 1), rgb[0] / 255.0,
                                         rgb[1] / 255.0, rgb[2] / 255.0);
    }
    cairo_set_source(canvas->cairo, ramp);
    put_box(canvas, *box);
    cairo_fill(canvas->cairo);
    cairo_pattern_destroy(ramp);
}

static Status put_text(const Canvas *canvas, const FigureItem *item, Err *err)
{
    const double size = item->size_pt * MM_PER_POINT;
    Glyphs glyphs;
    TRY(fonts_shape(canvas->page->fonts, item->text, item->bold, &glyphs, err));
    for (int i = 0; i < glyphs.n; i++) {
        glyphs.glyph[i].x = item->box.left + glyphs.glyph[i].x * size;
        glyphs.glyph[i].y = item->at[0].y + glyphs.glyph[i].y * size;
    }
    set_color(canvas, item->color);
    cairo_set_font_face(canvas->cairo, fonts_cairo(canvas->page->fonts, item->bold));
    cairo_set_font_size(canvas->cairo, size);
    if (canvas->of_pixels) {
        cairo_glyph_path(canvas->cairo, glyphs.glyph, glyphs.n);
        cairo_fill(canvas->cairo);
    } else {
        cairo_show_text_glyphs(canvas->cairo, item->text, -1, glyphs.glyph, glyphs.n,
                               glyphs.cluster, glyphs.n_clusters, 0);
    }
    glyphs_release(&glyphs);
    return STATUS_OK;
}

static void put_strokes(const Canvas *canvas, const FigureItem *item)
{
    const Strokes *all = item->strokes;
    cairo_save(canvas->cairo);
    cairo_translate(canvas->cairo, item->at[0].x, item->at[0].y);
    cairo_set_line_cap(canvas->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(canvas->cairo, CAIRO_LINE_JOIN_ROUND);
    set_color(canvas, item->color);
    for (size_t i = 0; i < all->n; i++) {
        const Stroke *stroke = &all->strokes[i];
        cairo_set_line_width(canvas->cairo, stroke->width_mm);
        for (size_t k = 0; k < stroke->n; k++)
            cairo_line_to(canvas->cairo, all->points[stroke->first + k][0],
                          all->points[stroke->first + k][1]);
        cairo_stroke(canvas->cairo);
    }
    cairo_restore(canvas->cairo);
}

static Status put_item(const Canvas *canvas, const FigureItem *item, Err *err)
{
    switch (item->kind) {
    case FIGURE_SHAPE:
        put_shape(canvas, item);
        break;
    case FIGURE_LINE:
        put_line(canvas, item);
        break;
    case FIGURE_RAMP:
        put_ramp(canvas, item);
        break;
    case FIGURE_TEXT:
        return put_text(canvas, item, err);
    case FIGURE_STROKES:
        put_strokes(canvas, item);
        break;
    case FIGURE_PICTURE:
        break;
    }
    return STATUS_OK;
}

/* Letters as they are: neither hinted nor moved. */
static void set_font_options(cairo_t *cairo)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo, options);
    cairo_font_options_destroy(options);
}

/* ---- pixels ---------------------------------------------------------------------------------- */

typedef struct Square {
    int column, row, width, height; /* of the page */
} Square;

/* Whether the item may have a pixel in the square; snapping moves it by one at most. */
static bool meets(const FigurePage *page, const FigureItem *item, Square square)
{
    double pixel = MM_PER_INCH / page->dpi;
    return item->kind != FIGURE_PICTURE && item->box.right / pixel + 2 > square.column &&
           item->box.left / pixel - 2 < square.column + square.width &&
           item->box.bottom / pixel + 2 > square.row &&
           item->box.top / pixel - 2 < square.row + square.height;
}

/* Lays a premultiplied colour of 8 bits over a code. */
static uint16_t over(uint32_t color, uint32_t alpha, uint16_t code, uint32_t most)
{
    uint32_t below = (code * (255 - alpha) + 127) / 255;
    uint32_t sum = color * (most / 255) + below;
    return (uint16_t)(sum < most ? sum : most);
}

static void blend(const uint32_t *from, Square square, int first, Picture *rows)
{
    uint32_t most = rows->bits == 8 ? 255 : 65535;
    int begin = first > square.row ? first - square.row : 0;
    for (int y = begin; y < square.height && square.row + y < first + rows->height; y++)
        for (int x = 0; x < square.width; x++) {
            uint32_t argb = from[(size_t)y * SQUARE + (size_t)x], alpha = argb >> 24;
            size_t at = (size_t)(square.row - first + y) * picture_stride(rows) +
                        3 * (size_t)(square.column + x);
            for (int c = 0; c < 3 && alpha; c++)
                picture_set(rows, at + (size_t)c,
                            over(argb >> (16 - 8 * c) & 255, alpha,
                                 picture_code(rows, at + (size_t)c), most));
        }
}

static Status draw_items(const FigurePage *page, Square square, cairo_surface_t *surface, Err *err)
{
    Canvas canvas = {.cairo = cairo_create(surface), .page = page, .of_pixels = true};
    Status status = STATUS_OK;
    cairo_set_operator(canvas.cairo, CAIRO_OPERATOR_CLEAR);
    cairo_paint(canvas.cairo);
    cairo_set_operator(canvas.cairo, CAIRO_OPERATOR_OVER);
    set_font_options(canvas.cairo);
    cairo_translate(canvas.cairo, -square.column, -square.row);
    cairo_scale(canvas.cairo, page->dpi / MM_PER_INCH, page->dpi / MM_PER_INCH);
    for (size_t i = 0; i < page->n && status == STATUS_OK; i++)
        if (meets(page, &page->items[i], square))
            status = put_item(&canvas, &page->items[i], err);
    if (status == STATUS_OK)
        status = check(cairo_status(canvas.cairo), "the page", err);
    cairo_destroy(canvas.cairo);
    cairo_surface_flush(surface);
    return status;
}

static Status draw_square(const FigurePage *page, Square square, int first, uint32_t *argb,
                          Picture *rows, Err *err)
{
    bool any = false;
    for (size_t i = 0; i < page->n && !any; i++)
        any = meets(page, &page->items[i], square);
    if (!any)
        return STATUS_OK;
    cairo_surface_t *surface = cairo_image_surface_create_for_data(
        (unsigned char *)argb, CAIRO_FORMAT_ARGB32, SQUARE, SQUARE, SQUARE * (int)sizeof *argb);
    Status status = draw_items(page, square, surface, err);
    cairo_surface_destroy(surface);
    if (status == STATUS_OK)
        blend(argb, square, first, rows);
    return status;
}

/* The part of a picture that lies in the rows. */
static void copy_picture(const FigureItem *item, int first, Picture *rows)
{
    const Picture *picture = item->picture;
    int columns = picture->width;
    if (columns > rows->width - item->column)
        columns = rows->width - item->column;
    for (int y = 0; y < picture->height; y++) {
        int row = item->row + y - first;
        if (row < 0 || row >= rows->height)
            continue;
        size_t to = (size_t)row * picture_stride(rows) + 3 * (size_t)item->column;
        for (size_t i = 0; i < 3 * (size_t)columns; i++) {
            uint16_t code = picture_code(picture, (size_t)y * picture_stride(picture) + i);
            picture_set(rows, to + i, rows->bits == 8 ? code : (uint16_t)(code * 257));
        }
    }
}

Status figure_draw(const FigurePage *page, int first, Picture *rows, Err *err)
{
    uint32_t *argb;
    Status status = STATUS_OK;
    for (size_t i = 0; i < page->n; i++)
        if (page->items[i].kind == FIGURE_PICTURE)
            copy_picture(&page->items[i], first, rows);
    TRY(mem_calloc(&argb, (size_t)SQUARE * SQUARE, sizeof *argb, "a part of the page", err));
    for (int y = first / SQUARE * SQUARE; y < first + rows->height && status == STATUS_OK;
         y += SQUARE)
        for (int x = 0; x < rows->width && status == STATUS_OK; x += SQUARE) {
            int wide = rows->width - x;
            const Square square = {x, y, wide < SQUARE ? wide : SQUARE, SQUARE};
            status = draw_square(page, square, first, argb, rows, err);
        }
    free(argb);
    return status;
}

/* ---- PDF ------------------------------------------------------------------------------------- */

/* The picture in cairo's form. */
static Status make_surface(const Picture *picture, cairo_surface_t **out, Err *err)
{
    if (picture->width > FIGURE_PDF_SIDE || picture->height > FIGURE_PDF_SIDE)
        return err_set(err, STATUS_USAGE,
                       "a picture of %dx%d pixels is too large for a PDF, which takes %d a side: "
                       "use .png or .tif",
                       picture->width, picture->height, FIGURE_PDF_SIDE);
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture->width, picture->height);
    TRY(check(cairo_surface_status(surface), "a picture", err));
    unsigned char *bytes = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            const uint8_t *rgb =
                picture->codes8 + (size_t)y * picture_stride(picture) + 3 * (size_t)x;
            uint32_t pixel = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
            memcpy(bytes + (size_t)y * (size_t)stride + 4 * (size_t)x, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
    *out = surface;
    return STATUS_OK;
}

/* Nearest: a viewer is not asked to smooth it. */
static Status put_picture(const Canvas *canvas, const FigureItem *item, Err *err)
{
    cairo_surface_t *surface = NULL;
    double pixel = MM_PER_INCH / canvas->page->dpi;
    TRY(make_surface(item->picture, &surface, err));
    cairo_save(canvas->cairo);
    cairo_translate(canvas->cairo, item->box.left, item->box.top);
    cairo_scale(canvas->cairo, pixel, pixel);
    cairo_set_source_surface(canvas->cairo, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(canvas->cairo), CAIRO_FILTER_NEAREST);
    cairo_paint(canvas->cairo);
    cairo_restore(canvas->cairo);
    cairo_surface_destroy(surface);
    return STATUS_OK;
}

static Status put_page(const Canvas *canvas, Err *err)
{
    const FigurePage *page = canvas->page;
    set_color(canvas, page->background);
    cairo_paint(canvas->cairo);
    for (size_t i = 0; i < page->n; i++)
        if (page->items[i].kind == FIGURE_PICTURE)
            TRY(put_picture(canvas, &page->items[i], err));
    for (size_t i = 0; i < page->n; i++)
        TRY(put_item(canvas, &page->items[i], err));
    return STATUS_OK;
}

static cairo_status_t take_bytes(void *stream, const unsigned char *bytes, unsigned int n)
{
    return fwrite(bytes, 1, n, stream) == n ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* cairo would write today's. */
static void set_notes(cairo_surface_t *pdf, const FigureNotes *notes)
{
    static const char date[] = "2000-01-01T00:00:00Z";
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_TITLE, notes->description);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_SUBJECT, notes->command);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATOR, notes->generator);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATE_DATE, date);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_MOD_DATE, date);
}

static Status put_pdf(const FigurePage *page, const FigureNotes *notes, const OutFile *file,
                      Err *err)
{
    cairo_surface_t *pdf = cairo_pdf_surface_create_for_stream(
        take_bytes, file->stream, page->width_mm / MM_PER_POINT, page->height_mm / MM_PER_POINT);
    set_notes(pdf, notes);
    Canvas canvas = {.cairo = cairo_create(pdf), .page = page};
    cairo_scale(canvas.cairo, 1 / MM_PER_POINT, 1 / MM_PER_POINT);
    set_font_options(canvas.cairo);
    Status status = put_page(&canvas, err);
    cairo_show_page(canvas.cairo);
    cairo_status_t failed = cairo_status(canvas.cairo);
    cairo_destroy(canvas.cairo);
    cairo_surface_finish(pdf);
    if (failed == CAIRO_STATUS_SUCCESS)
        failed = cairo_surface_status(pdf);
    cairo_surface_destroy(pdf);
    return status == STATUS_OK ? check(failed, file->path, err) : status;
}

Status figure_write_pdf(const FigurePage *page, const FigureNotes *notes, const char *path,
                        Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    Status status = put_pdf(page, notes, &file, err);
    if (status == STATUS_OK)
        return outfile_commit(&file, err);
    outfile_discard(&file);
    return status;
}

void figure_put_libraries(Text *text)
{
    text_printf(text, "cairo %s", cairo_version_string());
}
