/* A template for the page, and one for each kind of item. Text stays text, in a family whose
 * letters are as wide as Arial's and Helvetica's, which stand in where it is not installed. */
#include "figure/figure.h"

#include "tmpl/tmpl.h"
#include <stdio.h>
#include <string.h>

/* Items being written. */
typedef struct Svg {
    const FigurePage *page;
    const FigureNotes *notes;
    bool pictures; /* these, or all else */
} Svg;

/* A number of mm, to a thousandth. */
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

static Status put_text(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    static const char *const anchors[] = {
        [ALIGN_LEFT] = "start", [ALIGN_CENTER] = "middle", [ALIGN_RIGHT] = "end"};
    Markup parts = {0};
    put_mm(item->at[0].x, markup_text(&parts, "x"));
    put_mm(item->at[0].y, markup_text(&parts, "y"));
    put_mm(item->size_pt * MM_PER_POINT, markup_text(&parts, "size"));
    text_puts(markup_text(&parts, "weight"), item->bold ? "bold" : "normal");
    text_puts(markup_text(&parts, "anchor"), anchors[item->align]);
    put_color(item->color, markup_text(&parts, "color"));
    text_puts(markup_text(&parts, "text"), item->text);
    return markup_put(&parts, svg->notes->templates, "figure/text.svg", out, err);
}

static Status put_stops(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    Status status = STATUS_OK;
    for (int i = 0; i < FIGURE_STOPS && status == STATUS_OK; i++) {
        Markup parts = {0};
        text_printf(markup_text(&parts, "offset"), "%.6g", (double)i / (FIGURE_STOPS - 1));
        put_color(item->ramp[i], markup_text(&parts, "color"));
        status = markup_put(&parts, svg->notes->templates, "figure/stop.svg", out, err);
    }
    return status;
}

static Status put_ramp(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    Markup parts = {0};
    Status status = put_stops(svg, item, markup_raw(&parts, "stops"), err);
    put_box(&item->box, &parts);
    text_printf(markup_text(&parts, "id"), "ramp%zu", (size_t)(item - svg->page->items));
    text_puts(markup_text(&parts, "y1"), item->upwards ? "1" : "0");
    text_puts(markup_text(&parts, "x2"), item->upwards ? "0" : "1");
    if (status == STATUS_OK)
        return markup_put(&parts, svg->notes->templates, "figure/ramp.svg", out, err);
    markup_release(&parts);
    return status;
}

static Status put_picture(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    Markup parts = {0};
    put_box(&item->box, &parts);
    Status status = picture_put_uri(item->picture, markup_raw(&parts, "png"), err);
    if (status == STATUS_OK)
        return markup_put(&parts, svg->notes->templates, "figure/picture.svg", out, err);
    markup_release(&parts);
    return status;
}

static Status put_shape(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    Markup parts = {0};
    put_corners(item, markup_text(&parts, "points"));
    put_color(item->color, markup_text(&parts, "color"));
    return markup_put(&parts, svg->notes->templates, "figure/shape.svg", out, err);
}

static Status put_line(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
    Markup parts = {0};
    put_corners(item, markup_text(&parts, "points"));
    text_puts(markup_text(&parts, "end"), item->closed ? "Z" : "");
    put_color(item->color, markup_text(&parts, "color"));
    put_mm(item->width_mm, markup_text(&parts, "width"));
    return markup_put(&parts, svg->notes->templates, "figure/line.svg", out, err);
}

/* Strokes of one width, which follow one another, are one path. */
static Status put_strokes(const Svg *svg, const FigureItem *item, Text *out, Err *err)
{
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
        TRY(markup_put(&parts, svg->notes->templates, "figure/strokes.svg", out, err));
    }
    return STATUS_OK;
}

static Status put_items(Text *out, void *context, Err *err)
{
    static Status (*const put[])(const Svg *, const FigureItem *, Text *, Err *) = {
        [FIGURE_PICTURE] = put_picture, [FIGURE_SHAPE] = put_shape, [FIGURE_LINE] = put_line,
        [FIGURE_RAMP] = put_ramp,       [FIGURE_TEXT] = put_text,   [FIGURE_STROKES] = put_strokes};
    const Svg *svg = context;
    for (size_t i = 0; i < svg->page->n; i++) {
        const FigureItem *item = &svg->page->items[i];
        if ((item->kind == FIGURE_PICTURE) == svg->pictures)
            TRY(put[item->kind](svg, item, out, err));
    }
    return STATUS_OK;
}

Status figure_put_svg(const FigurePage *page, const FigureNotes *notes, Text *out, Err *err)
{
    Markup parts = {0};
    Svg svg = {.page = page, .notes = notes, .pictures = true};
    put_mm(page->width_mm, markup_text(&parts, "width"));
    put_mm(page->height_mm, markup_text(&parts, "height"));
    put_color(page->background, markup_text(&parts, "background"));
    text_puts(markup_text(&parts, "description"), notes->description);
    text_puts(markup_text(&parts, "generator"), notes->generator);
    text_puts(markup_text(&parts, "command"), notes->command);
    Status status = put_items(markup_raw(&parts, "pictures"), &svg, err);
    svg.pictures = false;
    if (status == STATUS_OK)
        status = put_items(markup_raw(&parts, "items"), &svg, err);
    if (status == STATUS_OK)
        return markup_put(&parts, notes->templates, "figure/page.svg", out, err);
    markup_release(&parts);
    return status;
}
