/* Writes a page as PDF or EPS with cairo. Text stays text, and subsets of the fonts are embedded.
 * The date in the file is constant, so that equal pages give equal bytes.
 *
 * cairo 1.16 ignores some failed allocations and crashes after others, and it never releases the
 * fonts. It therefore runs in a child process. If cairo ignored a failed allocation, errno is
 * ENOMEM at the end. */
#include "figure/artwork.h"
#include "figure/fonts.h"
#include "figure/items.h"
#include "figure/pdf_inks.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-ps.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The page that is being written. The unit of the cairo context is the mm. */
typedef struct PdfPage {
    cairo_t *cairo;
    cairo_font_face_t *face[FACES];
    const FigurePage *page;
} PdfPage;

static void set_color(const PdfPage *pdf, FigureColor color)
{
    cairo_set_source_rgb(pdf->cairo, color.rgb[0] / 255.0, color.rgb[1] / 255.0,
                         color.rgb[2] / 255.0);
}

/* Sets the color, and makes the item's corners the current path. */
static void put_path(const PdfPage *pdf, const FigureItem *item)
{
    set_color(pdf, item->color);
    for (int i = 0; i < item->n; i++)
        cairo_line_to(pdf->cairo, item->at[i].x, item->at[i].y);
    if (item->closed || item->kind == FIGURE_SHAPE)
        cairo_close_path(pdf->cairo);
}

static Status put_shape(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    put_path(pdf, item);
    cairo_fill(pdf->cairo);
    return artwork_check_cairo(cairo_status(pdf->cairo), err);
}

static Status put_line(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    put_path(pdf, item);
    cairo_set_line_width(pdf->cairo, item->width_mm);
    cairo_stroke(pdf->cairo);
    return artwork_check_cairo(cairo_status(pdf->cairo), err);
}

static Status put_bars(void *context, const FigureItem *item, Err *err)
{
    for (size_t i = 0; i < item->bars->n; i++) {
        const FigureItem bar = figure_bar(item, i);
        TRY(put_shape(context, &bar, err));
    }
    return STATUS_OK;
}

/* Draws a color ramp as a gradient. */
static Status put_ramp(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    const FigureBox *box = &item->box;
    cairo_pattern_t *ramp = item->upwards
                                ? cairo_pattern_create_linear(0, box->bottom, 0, box->top)
                                : cairo_pattern_create_linear(box->left, 0, box->right, 0);
    for (int i = 0; i < FIGURE_STOPS; i++) {
        const uint8_t *rgb = item->ramp[i].rgb;
        cairo_pattern_add_color_stop_rgb(ramp, (double)i / (FIGURE_STOPS - 1), rgb[0] / 255.0,
                                         rgb[1] / 255.0, rgb[2] / 255.0);
    }
    cairo_set_source(pdf->cairo, ramp);
    cairo_rectangle(pdf->cairo, box->left, box->top, box->right - box->left,
                    box->bottom - box->top);
    cairo_fill(pdf->cairo);
    cairo_pattern_destroy(ramp);
    return artwork_check_cairo(cairo_status(pdf->cairo), err);
}

/* The arrays that cairo_show_text_glyphs needs for a run of glyphs. A cluster states which bytes of
 * `text` a glyph represents, so that viewers can search the text. */
typedef struct GlyphRun {
    cairo_glyph_t *glyph;
    cairo_text_cluster_t *cluster;
    Text text;
} GlyphRun;

/* Fills a run, letters of one font and size, with glyphs in mm of the page and with their text,
 * which readers of PDF search. */
static Status fill_run(const FigureItem *item, const Glyph *from, size_t n, GlyphRun *run, Err *err)
{
    const double size = item->size_pt * MM_PER_POINT;
    TRY(mem_calloc(&run->glyph, n, sizeof *run->glyph, "letters", err));
    TRY(mem_calloc(&run->cluster, n, sizeof *run->cluster, "letters", err));
    for (size_t i = 0; i < n; i++) {
        const size_t before = run->text.length;
        text_put_character(&run->text, from[i].letter);
        run->glyph[i] = (cairo_glyph_t){from[i].index, item->box.left + from[i].x * size,
                                        item->at[0].y - from[i].rise * size};
        run->cluster[i] = (cairo_text_cluster_t){(int)(run->text.length - before), 1};
    }
    return text_check(&run->text, err);
}

/* Draws letters as paths instead of text, because viewers would find the text of a halo twice. */
static void fill_outlined(cairo_t *cairo, const GlyphRun *run, int n, double width_mm)
{
    cairo_set_line_width(cairo, width_mm);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_glyph_path(cairo, run->glyph, n);
    cairo_stroke_preserve(cairo);
    cairo_fill(cairo);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
}

static Status show_run(const PdfPage *pdf, const FigureItem *item, const Glyph *from, size_t n,
                       Err *err)
{
    GlyphRun run = {.text = TEXT_INIT};
    Status status;
    TRY_GOTO(fill_run(item, from, n, &run, err));
    cairo_set_font_face(pdf->cairo, pdf->face[from->face]);
    cairo_set_font_size(pdf->cairo, item->size_pt * MM_PER_POINT * from->scale);
    if (item->outline_mm > 0)
        fill_outlined(pdf->cairo, &run, (int)n, item->outline_mm);
    else
        cairo_show_text_glyphs(pdf->cairo, text_chars(&run.text), (int)run.text.length, run.glyph,
                               (int)n, run.cluster, (int)n, 0);
done:
    free(run.glyph);
    free(run.cluster);
    text_release(&run.text);
    return status;
}

static Status show_glyphs(const PdfPage *pdf, const FigureItem *item, const Glyphs *glyphs,
                          Err *err)
{
    for (size_t i = 0, n; i < glyphs->n; i += n) {
        n = glyphs_run(glyphs, i);
        TRY(show_run(pdf, item, &glyphs->glyph[i], n, err));
    }
    return STATUS_OK;
}

static Status put_text(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    Glyphs glyphs;
    TRY(fonts_shape(pdf->page->fonts, item->text, item->bold, &glyphs, err));
    set_color(pdf, item->color);
    Status status = show_glyphs(pdf, item, &glyphs, err);
    glyphs_release(&glyphs);
    return status == STATUS_OK ? artwork_check_cairo(cairo_status(pdf->cairo), err) : status;
}

static Status put_strokes(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    const Strokes *all = item->strokes;
    cairo_save(pdf->cairo);
    cairo_translate(pdf->cairo, item->at[0].x, item->at[0].y);
    cairo_set_line_cap(pdf->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(pdf->cairo, CAIRO_LINE_JOIN_ROUND);
    set_color(pdf, item->color);
    for (size_t i = 0; i < all->n; i++) {
        const Stroke *stroke = &all->strokes[i];
        cairo_set_line_width(pdf->cairo, stroke->width_mm);
        for (size_t k = 0; k < stroke->n; k++)
            cairo_line_to(pdf->cairo, all->points[stroke->first + k][0],
                          all->points[stroke->first + k][1]);
        cairo_stroke(pdf->cairo);
    }
    cairo_restore(pdf->cairo);
    return artwork_check_cairo(cairo_status(pdf->cairo), err);
}

/* Loads the fonts into cairo, without hinting of glyphs or of their positions. */
static Status set_fonts(PdfPage *pdf, Err *err)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_status_t failed = cairo_font_options_status(options);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(pdf->cairo, options);
    cairo_font_options_destroy(options);
    for (int i = 0; i < FACES; i++) {
        pdf->face[i] = cairo_ft_font_face_create_for_ft_face(
            fonts_face(pdf->page->fonts, (FontFace)i), FT_LOAD_NO_HINTING);
        if (failed == CAIRO_STATUS_SUCCESS)
            failed = cairo_font_face_status(pdf->face[i]);
    }
    return artwork_check_cairo(failed, err);
}

/* The filter asks viewers not to smooth the picture. */
static Status put_picture(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    return artwork_draw_picture(item->picture, &item->box, CAIRO_FILTER_NEAREST, pdf->cairo, err);
}

static Status put_artwork(void *context, const FigureItem *item, Err *err)
{
    const PdfPage *pdf = context;
    return artwork_draw(item->artwork, &item->box, pdf->cairo, err);
}

static Status put_page(PdfPage *pdf, Err *err)
{
    static FigurePut *const put[FIGURE_KINDS] = {
        [FIGURE_PICTURE] = put_picture, [FIGURE_SHAPE] = put_shape,    [FIGURE_LINE] = put_line,
        [FIGURE_RAMP] = put_ramp,       [FIGURE_TEXT] = put_text,      [FIGURE_BARS] = put_bars,
        [FIGURE_STROKES] = put_strokes, [FIGURE_ARTWORK] = put_artwork};
    set_color(pdf, pdf->page->background);
    cairo_paint(pdf->cairo);
    return figure_put_items(pdf->page, put, pdf, err);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Sets the metadata. The constant date replaces the current date, which cairo would write. */
static void set_pdf_notes(cairo_surface_t *pdf, const FigureNotes *notes)
{
    static const char date[] = "2000-01-01T00:00:00Z";
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_TITLE, notes->description);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_SUBJECT, notes->command);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATOR, notes->generator);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATE_DATE, date);
    cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_MOD_DATE, date);
}

/* Adds a comment of one line to an EPS. cairo refuses lines of more than 255 bytes. */
static void set_eps_note(cairo_surface_t *eps, const char *key, const char *value)
{
    char line[256];
    snprintf(line, sizeof line, "%%%%%s: %s", key, value);
    cairo_ps_surface_dsc_comment(eps, line);
}

/* Sets the header of an EPS. The resolution is that of translucent parts: PostScript has no
 * transparency, so cairo replaces these parts by pixels. */
static void set_eps_notes(cairo_surface_t *eps, const FigureNotes *notes, double dpi)
{
    cairo_ps_surface_set_eps(eps, 1);
    cairo_surface_set_fallback_resolution(eps, dpi, dpi);
    set_eps_note(eps, "Title", notes->description);
    set_eps_note(eps, "For", notes->generator);
}

/* Replaces the current date, which cairo writes into the header of an EPS. */
static Status remove_date(Text *bytes, Err *err)
{
    static const char key[] = "%%CreationDate: ", date[] = "Sat Jan  1 00:00:00 2000";
    const size_t length = bytes->length;
    char *chars = NULL;
    TRY(text_take(bytes, &chars, err));
    char *at = strstr(chars, key);
    if (at && strcspn(at + strlen(key), "\n") == strlen(date))
        memcpy(at + strlen(key), date, strlen(date));
    text_append(bytes, chars, length);
    free(chars);
    return STATUS_OK;
}

/* What the child process draws. */
typedef struct PdfWork {
    const FigurePage *page;
    const FigureNotes *notes;
    bool eps;
} PdfWork;

static cairo_surface_t *make_page(const PdfWork *work, Text *bytes)
{
    const double width = work->page->width_mm / MM_PER_POINT;
    const double height = work->page->height_mm / MM_PER_POINT;
    cairo_surface_t *page =
        work->eps
            ? cairo_ps_surface_create_for_stream(artwork_write_to_text, bytes, width, height)
            : cairo_pdf_surface_create_for_stream(artwork_write_to_text, bytes, width, height);
    if (work->eps)
        set_eps_notes(page, work->notes, work->page->dpi);
    else
        set_pdf_notes(page, work->notes);
    return page;
}

/* Ends the page and the file. Returns the first error of the two steps. */
static cairo_status_t finish(cairo_t *cairo, cairo_surface_t *pdf)
{
    cairo_show_page(cairo);
    cairo_status_t failed = cairo_status(cairo);
    cairo_surface_finish(pdf);
    return failed == CAIRO_STATUS_SUCCESS ? cairo_surface_status(pdf) : failed;
}

/* An IsolatedWork: appends the file. The child process ends when this function returns, so nothing
 * is released. */
static Status put_pdf(const void *context, Text *bytes, Err *err)
{
    const PdfWork *work = context;
    const FigurePage *page = work->page;
    errno = 0;
    cairo_surface_t *surface = make_page(work, bytes);
    PdfPage self = {.cairo = cairo_create(surface), .page = page};
    cairo_scale(self.cairo, 1 / MM_PER_POINT, 1 / MM_PER_POINT);
    if (page->fonts)
        TRY(set_fonts(&self, err));
    TRY(put_page(&self, err));
    TRY(artwork_check_cairo(finish(self.cairo, surface), err));
    if (work->eps)
        TRY(remove_date(bytes, err));
    if (page->inks)
        TRY(page_to_inks(page->inks, work->eps, bytes, err));
    return errno == ENOMEM ? mem_out_of("for", "the page", err) : STATUS_OK;
}

Status figure_write_pdf(const FigurePage *page, const FigureNotes *notes, bool eps,
                        const char *path, Err *err)
{
    const PdfWork work = {page, notes, eps};
    Text bytes = TEXT_INIT;
    Status status;
    TRY_GOTO(isolated_run(put_pdf, &work, "the page", &bytes, err));
    status = file_write_text(path, &bytes, err);
done:
    text_release(&bytes);
    return status;
}

void figure_put_libraries(Text *text)
{
    text_printf(text, "FreeType %d.%d.%d, cairo %s", FREETYPE_MAJOR, FREETYPE_MINOR, FREETYPE_PATCH,
                cairo_version_string());
}
