/* Writes a page as SVG. There is one template for the page and one for each kind of item. Text is
 * written as text, not as outlines. Where Liberation Sans is not installed, viewers use Arial or
 * Helvetica, whose letters have the same widths. */
#include "figure/artwork.h"
#include "figure/fonts.h"
#include "figure/items.h"
#include "tmpl/tmpl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The page that is being written. */
typedef struct SvgPage {
    const FigurePage *page;
    const char *templates; /* the folder of templates */
    Text *out;             /* borrowed */
} SvgPage;

/* Appends a length in mm with up to three decimals. Adding 0 makes -0 to 0. */
static void put_mm(double mm, Text *text)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.3f", mm + 0);
    size_t length = strlen(digits);
    while (digits[length - 1] == '0')
        length--;
    text_append(text, digits, digits[length - 1] == '.' ? length - 1 : length);
}

static void put_color(FigureColor color, Text *text)
{
    text_printf(text, "#%02x%02x%02x", color.rgb[0], color.rgb[1], color.rgb[2]);
}

static void put_box(const FigureBox *box, Markup *parts)
{
    put_mm(box->left, markup_text(parts, "x"));
    put_mm(box->top, markup_text(parts, "y"));
    put_mm(box->right - box->left, markup_text(parts, "width"));
    put_mm(box->bottom - box->top, markup_text(parts, "height"));
}

static void put_corners(const FigureItem *item, Text *text)
{
    for (int i = 0; i < item->n; i++) {
        text_puts(text, i ? " " : "");
        put_mm(item->at[i].x, text);
        text_puts(text, ",");
        put_mm(item->at[i].y, text);
    }
}

/* Consecutive glyphs of equal style. */
typedef struct SvgRun {
    const Glyph *glyph;
    size_t n;
} SvgRun;

/* Appends the letters of a run of equal style. A run that is upright, of full size and at the
 * height of the previous run is plain text; any other run is a `tspan`. `*rise` is the height above
 * the baseline: of the previous run before the call, of this run after it. */
static Status put_run(const SvgPage *svg, const FigureItem *item, const SvgRun *run, double *rise,
                      Text *out, Err *err)
{
    const Glyph *glyph = run->glyph;
    const double size = item->size_pt * MM_PER_POINT, down = size * (*rise - glyph->rise);
    const bool italic = glyph->face == FACE_ITALIC || glyph->face == FACE_BOLD_ITALIC;
    Text letters = TEXT_INIT;
    Markup parts = {0};
    for (size_t i = 0; i < run->n; i++)
        text_put_character(&letters, glyph[i].drawn);
    text_escaped(markup_raw(&parts, "text"), text_chars(&letters));
    text_release(&letters);
    *rise = glyph->rise;
    if (!italic && glyph->scale == 1 && down == 0) {
        text_add(out, &parts.parts[0].text);
        markup_release(&parts);
        return STATUS_OK;
    }
    text_puts(markup_text(&parts, "style"), italic ? "italic" : "normal");
    put_mm(size * glyph->scale, markup_text(&parts, "size"));
    put_mm(down, markup_text(&parts, "down"));
    return markup_put(&parts, svg->templates, "figure/span.svg", out, err);
}

static Status put_runs(const SvgPage *svg, const FigureItem *item, Text *out, Err *err)
{
    Glyphs glyphs;
    Status status = STATUS_OK;
    double rise = 0;
    TRY(fonts_shape(svg->page->fonts, item->text, item->bold, &glyphs, err));
    for (size_t i = 0, n; i < glyphs.n && status == STATUS_OK; i += n) {
        n = glyphs_run(&glyphs, i);
        status = put_run(svg, item, &(SvgRun){&glyphs.glyph[i], n}, &rise, out, err);
    }
    glyphs_release(&glyphs);
    return status;
}

static Status put_text(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    static const char *const anchors[] = {
        [ALIGN_LEFT] = "start", [ALIGN_CENTER] = "middle", [ALIGN_RIGHT] = "end"};
    Markup parts = {0};
    Status status;
    put_mm(item->at[0].x, markup_text(&parts, "x"));
    put_mm(item->at[0].y, markup_text(&parts, "y"));
    put_mm(item->size_pt * MM_PER_POINT, markup_text(&parts, "size"));
    text_puts(markup_text(&parts, "weight"), item->bold ? "bold" : "normal");
    text_puts(markup_text(&parts, "anchor"), anchors[item->align]);
    put_color(item->color, markup_text(&parts, "color"));
    TRY_GOTO(put_runs(svg, item, markup_raw(&parts, "text"), err));
    if (item->outline_mm > 0)
        put_mm(item->outline_mm, markup_text(&parts, "outline"));
    status =
        markup_put(&parts, svg->templates,
                   item->outline_mm > 0 ? "figure/halo.svg" : "figure/text.svg", svg->out, err);
done:
    markup_release(&parts);
    return status;
}

static Status put_stops(const SvgPage *svg, const FigureItem *item, Text *out, Err *err)
{
    for (int i = 0; i < FIGURE_STOPS; i++) {
        Markup parts = {0};
        text_printf(markup_text(&parts, "offset"), "%.6g", (double)i / (FIGURE_STOPS - 1));
        put_color(item->ramp[i], markup_text(&parts, "color"));
        TRY(markup_put(&parts, svg->templates, "figure/stop.svg", out, err));
    }
    return STATUS_OK;
}

static Status put_ramp(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    Markup parts = {0};
    Status status;
    TRY_GOTO(put_stops(svg, item, markup_raw(&parts, "stops"), err));
    put_box(&item->box, &parts);
    text_printf(markup_text(&parts, "id"), "ramp%zu", (size_t)(item - svg->page->items));
    text_puts(markup_text(&parts, "y1"), item->upwards ? "1" : "0");
    text_puts(markup_text(&parts, "x2"), item->upwards ? "0" : "1");
    status = markup_put(&parts, svg->templates, "figure/ramp.svg", svg->out, err);
done:
    markup_release(&parts);
    return status;
}

static Status put_picture(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    Markup parts = {0};
    Status status;
    put_box(&item->box, &parts);
    TRY_GOTO(picture_put_uri(item->picture, markup_raw(&parts, "png"), err));
    status = markup_put(&parts, svg->templates, "figure/picture.svg", svg->out, err);
done:
    markup_release(&parts);
    return status;
}

/* Returns the content of an SVG between its outer tags, and sets *view to the value of its viewBox.
 * Both point into `svg`, which is changed. Returns NULL if a tag or the viewBox is missing. */
static char *cut_svg(char *svg, char **view)
{
    char *root = strstr(svg, "<svg"), *end = strstr(svg, "</svg>");
    char *box = root ? strstr(root, "viewBox=\"") : NULL, *body = box ? strchr(box, '>') : NULL;
    if (!body || !end)
        return NULL;
    *end = '\0';
    *view = box + strlen("viewBox=\"");
    (*view)[strcspn(*view, "\"")] = '\0';
    return body + 1;
}

/* Appends a drawing that cairo made, with `prefix` before each id and each reference to an id. This
 * keeps the ids of several drawings in one SVG apart. */
static void put_with_prefix(const char *drawing, const char *prefix, Text *out)
{
    static const char *const before[] = {"id=\"", "url(#", "href=\"#"}; /* begin with i, u, h */
    for (size_t length; *drawing; drawing += length) {
        size_t i = 0;
        while (i < 3 && strncmp(drawing, before[i], strlen(before[i])) != 0)
            i++;
        length = i < 3 ? strlen(before[i]) : 1 + strcspn(drawing + 1, "iuh");
        text_append(out, drawing, length);
        text_puts(out, i < 3 ? prefix : "");
    }
}

/* Appends an SVG that cairo wrote as a nested `svg` element. Changes `drawing`. */
static Status put_drawing(const SvgPage *svg, const FigureItem *item, char *drawing, Err *err)
{
    Markup parts = {0};
    char prefix[32], *view, *body = cut_svg(drawing, &view);
    if (!body)
        return err_set(err, STATUS_IO, "the page: cairo wrote no SVG");
    snprintf(prefix, sizeof prefix, "artwork%zu-", (size_t)(item - svg->page->items));
    put_box(&item->box, &parts);
    text_puts(markup_text(&parts, "view"), view);
    put_with_prefix(body, prefix, markup_raw(&parts, "drawing"));
    return markup_put(&parts, svg->templates, "figure/artwork.svg", svg->out, err);
}

/* An artwork of pixels becomes a picture; vectors become a nested `svg` element. */
static Status put_artwork(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    const FigureBox *box = &item->box;
    FigureItem pixels = *item;
    pixels.picture = &item->artwork->picture;
    if (pixels.picture->width > 0)
        return put_picture(context, &pixels, err);
    Text drawing = TEXT_INIT;
    char *chars = NULL;
    Status status;
    TRY_GOTO(artwork_put_svg(item->artwork, box->right - box->left, box->bottom - box->top,
                             &drawing, err));
    TRY_GOTO(text_take(&drawing, &chars, err));
    status = put_drawing(svg, item, chars, err);
done:
    text_release(&drawing);
    free(chars);
    return status;
}

static Status put_shape(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    Markup parts = {0};
    put_corners(item, markup_text(&parts, "points"));
    put_color(item->color, markup_text(&parts, "color"));
    return markup_put(&parts, svg->templates, "figure/shape.svg", svg->out, err);
}

static Status put_line(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    Markup parts = {0};
    put_corners(item, markup_text(&parts, "points"));
    text_puts(markup_text(&parts, "end"), item->closed ? "Z" : "");
    put_color(item->color, markup_text(&parts, "color"));
    put_mm(item->width_mm, markup_text(&parts, "width"));
    return markup_put(&parts, svg->templates, "figure/line.svg", svg->out, err);
}

/* Consecutive strokes of equal width become one path. */
static Status put_strokes(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    const Strokes *all = item->strokes;
    for (size_t i = 0; i < all->n;) {
        Markup parts = {0};
        Text *points = markup_text(&parts, "points");
        const double width_mm = all->strokes[i].width_mm;
        for (; i < all->n && all->strokes[i].width_mm == width_mm; i++)
            for (size_t k = 0; k < all->strokes[i].n; k++) {
                const double *point = all->points[all->strokes[i].first + k];
                text_puts(points, k ? " " : "M");
                put_mm(item->at[0].x + point[0], points);
                text_puts(points, ",");
                put_mm(item->at[0].y + point[1], points);
            }
        put_color(item->color, markup_text(&parts, "color"));
        put_mm(width_mm, markup_text(&parts, "width"));
        TRY(markup_put(&parts, svg->templates, "figure/strokes.svg", svg->out, err));
    }
    return STATUS_OK;
}

/* ---- bars ------------------------------------------------------------------------------------ */

/* The template and the texts of a bar. The texts are reused for every bar. */
typedef struct SvgBar {
    Tmpl tmpl;
    Text id, title;
} SvgBar;

static Status put_bar(const SvgPage *svg, const FigureBars *bars, size_t i, SvgBar *self, Err *err)
{
    const FigureBar *bar = &bars->bars[i];
    char number[4][NUMBER_TEXT_SIZE], color[8];
    const FigureColor shown = figure_color(bars->color[bar->index]);
    text_clear(&self->id);
    text_clear(&self->title);
    bars->put_label(bars->context, i, &self->id, &self->title);
    TRY(text_check(&self->id, err));
    TRY(text_check(&self->title, err));
    snprintf(color, sizeof color, "#%02x%02x%02x", shown.rgb[0], shown.rgb[1], shown.rgb[2]);
    const TmplValue values[] = {{"id", text_chars(&self->id)},
                                {"x", number_text(bar->x[0], number[0])},
                                {"y", number_text(bar->y[0], number[1])},
                                {"width", number_text(bar->x[1] - bar->x[0], number[2])},
                                {"height", number_text(fmax(0, bar->y[1] - bar->y[0]), number[3])},
                                {"color", color},
                                {"title", text_chars(&self->title)}};
    return tmpl_apply(&self->tmpl, values, sizeof values / sizeof *values, svg->out, err);
}

/* The context of put_each_bar, a TmplPut, which writes the bars of a diagram. */
typedef struct SvgBars {
    const SvgPage *svg;
    const FigureBars *bars;
} SvgBars;

/* put_bar appends to svg->out, which is `out`. */
static Status put_each_bar(Text *out, const void *context, Err *err)
{
    (void)out;
    const SvgBars *self = context;
    SvgBar bar = {.id = TEXT_INIT, .title = TEXT_INIT};
    Status status;
    TRY_GOTO(tmpl_load(&bar.tmpl, self->svg->templates, "figure/bar.svg", err));
    for (size_t i = 0; i < self->bars->n; i++)
        TRY_GOTO(put_bar(self->svg, self->bars, i, &bar, err));
done:
    tmpl_release(&bar.tmpl);
    text_release(&bar.id);
    text_release(&bar.title);
    return status;
}

static void put_number(double value, Text *text)
{
    char digits[NUMBER_TEXT_SIZE];
    text_puts(text, number_text(value, digits));
}

/* Coordinates of bars have all their digits, because bars may be thinner than 0.001 mm. */
static Status put_bars(void *context, const FigureItem *item, Err *err)
{
    const SvgPage *svg = context;
    const SvgBars bars = {svg, item->bars};
    const TmplPart part = {"bars", put_each_bar, &bars};
    Markup parts = {0};
    put_number(item->at[0].x, markup_text(&parts, "x"));
    put_number(item->at[0].y, markup_text(&parts, "y"));
    return markup_stream(&parts, svg->templates, "figure/bars.svg", &part, 1, svg->out, err);
}

/* ---- pages ----------------------------------------------------------------------------------- */

static Status put_items(Text *out, const void *context, Err *err)
{
    static FigurePut *const put[FIGURE_KINDS] = {
        [FIGURE_PICTURE] = put_picture, [FIGURE_SHAPE] = put_shape,    [FIGURE_LINE] = put_line,
        [FIGURE_RAMP] = put_ramp,       [FIGURE_TEXT] = put_text,      [FIGURE_BARS] = put_bars,
        [FIGURE_STROKES] = put_strokes, [FIGURE_ARTWORK] = put_artwork};
    SvgPage svg = *(const SvgPage *)context;
    svg.out = out;
    return figure_put_items(svg.page, put, &svg, err);
}

Status figure_put_svg(const FigurePage *page, const FigureNotes *notes, Text *out, Err *err)
{
    const SvgPage svg = {.page = page, .templates = notes->templates};
    const TmplPart items = {"items", put_items, &svg};
    Markup parts = {0};
    (page->exact ? put_number : put_mm)(page->width_mm, markup_text(&parts, "width"));
    (page->exact ? put_number : put_mm)(page->height_mm, markup_text(&parts, "height"));
    put_color(page->background, markup_text(&parts, "background"));
    text_puts(markup_text(&parts, "description"), notes->description);
    text_puts(markup_text(&parts, "generator"), notes->generator);
    text_puts(markup_text(&parts, "command"), notes->command);
    return markup_stream(&parts, notes->templates, "figure/page.svg", &items, 1, out, err);
}
