/* Builds a page of text, lines, boxes, pictures and drawings. The items of a page are an array in
 * drawing order. Each item stores its bounding box. A group of items can therefore be built at any
 * position, measured and moved, and items outside a band of rows are skipped. */
#include "figure/fonts.h"
#include "figure/items.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void figure_init(FigurePage *page, double width_mm, double height_mm, double dpi,
                 const FigureFonts *fonts)
{
    *page = (FigurePage){.width_mm = width_mm,
                         .height_mm = height_mm,
                         .dpi = dpi,
                         .background = {{255, 255, 255}},
                         .fonts = fonts};
}

void figure_release(FigurePage *page)
{
    for (size_t i = 0; i < page->n; i++) {
        free(page->items[i].text);
        free(page->items[i].ramp);
    }
    free(page->items);
    *page = (FigurePage){0};
}

int figure_pixels(const FigurePage *page, double mm)
{
    return (int)lround(mm / MM_PER_INCH * page->dpi);
}

/* Appends an item and returns it. If memory runs out, marks the page as failed and returns NULL. */
static FigureItem *add(FigurePage *page, FigureItem item)
{
    if (mem_reserve(&page->items, &page->capacity, page->n + 1, sizeof item, "items", NULL) !=
        STATUS_OK) {
        page->failed = true;
        return NULL;
    }
    page->items[page->n] = item;
    return &page->items[page->n++];
}

void figure_add_picture(FigurePage *page, const Picture *picture, int column, int row)
{
    double pixel = MM_PER_INCH / page->dpi;
    add(page, (FigureItem){.kind = FIGURE_PICTURE,
                           .box = {column * pixel, row * pixel, (column + picture->width) * pixel,
                                   (row + picture->height) * pixel},
                           .picture = picture,
                           .column = column,
                           .row = row});
}

/* The box of no items: joining it with another box gives the other box. */
static const FigureBox empty_box = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static FigureBox join_boxes(FigureBox a, FigureBox b)
{
    return (FigureBox){fmin(a.left, b.left), fmin(a.top, b.top), fmax(a.right, b.right),
                       fmax(a.bottom, b.bottom)};
}

static FigureBox pad_box(FigureBox box, double mm)
{
    return (FigureBox){box.left - mm, box.top - mm, box.right + mm, box.bottom + mm};
}

/* Appends an item with these corners. Half of the width of its line extends its box. */
static void add_corners(FigurePage *page, FigureItem item, const FigurePoint *corner, int n)
{
    item.n = n;
    item.box = empty_box;
    for (int i = 0; i < n; i++) {
        const FigureBox point = {corner[i].x, corner[i].y, corner[i].x, corner[i].y};
        item.at[i] = corner[i];
        item.box = join_boxes(item.box, pad_box(point, item.width_mm / 2));
    }
    add(page, item);
}

void figure_add_shape(FigurePage *page, const FigurePoint *corner, int n, FigureColor color)
{
    add_corners(page, (FigureItem){.kind = FIGURE_SHAPE, .color = color}, corner, n);
}

/* Returns a filled rectangle as an item. */
static FigureItem filled_box(FigureBox box, FigureColor color)
{
    return (FigureItem){.kind = FIGURE_SHAPE,
                        .box = box,
                        .color = color,
                        .n = 4,
                        .at = {{box.left, box.top},
                               {box.right, box.top},
                               {box.right, box.bottom},
                               {box.left, box.bottom}}};
}

void figure_add_box(FigurePage *page, FigureBox box, FigureColor color)
{
    add(page, filled_box(box, color));
}

void figure_add_line(FigurePage *page, const FigurePoint *corner, int n, bool closed,
                     double width_mm, FigureColor color)
{
    add_corners(
        page,
        (FigureItem){.kind = FIGURE_LINE, .color = color, .closed = closed, .width_mm = width_mm},
        corner, n);
}

void figure_add_ramp(FigurePage *page, FigureBox box, bool upwards,
                     const FigureColor stops[FIGURE_STOPS])
{
    FigureColor *ramp = NULL;
    if (mem_calloc(&ramp, FIGURE_STOPS, sizeof *ramp, "colors", NULL) != STATUS_OK) {
        page->failed = true;
        return;
    }
    memcpy(ramp, stops, FIGURE_STOPS * sizeof *ramp);
    if (!add(page, (FigureItem){.kind = FIGURE_RAMP, .box = box, .upwards = upwards, .ramp = ramp}))
        free(ramp);
}

void figure_add_strokes(FigurePage *page, const Strokes *strokes, FigurePoint at, FigureColor color)
{
    add(page, (FigureItem){.kind = FIGURE_STROKES,
                           .box = {at.x, at.y, at.x + strokes->width_mm, at.y + strokes->height_mm},
                           .color = color,
                           .at = {at},
                           .n = 1,
                           .strokes = strokes});
}

void figure_add_bars(FigurePage *page, const FigureBars *bars, FigurePoint at, double width_mm,
                     double height_mm)
{
    add(page, (FigureItem){.kind = FIGURE_BARS,
                           .box = {at.x, at.y, at.x + width_mm, at.y + height_mm},
                           .at = {at},
                           .n = 1,
                           .bars = bars});
}

void figure_add_artwork(FigurePage *page, const FigureArtwork *artwork, FigureBox box)
{
    add(page, (FigureItem){.kind = FIGURE_ARTWORK, .box = box, .artwork = artwork});
}

/* Appends the item of a line of text. `glyphs` is the layout of `chars`. Takes ownership of
 * `chars`, also on failure. */
static void add_line_of_text(FigurePage *page, const FigureText *text, char *chars,
                             const Glyphs *glyphs)
{
    const double size = text->size_pt * MM_PER_POINT, width = glyphs->width * size;
    const double before[] = {[ALIGN_LEFT] = 0, [ALIGN_CENTER] = width / 2, [ALIGN_RIGHT] = width};
    const double left = text->x - before[text->align];
    letters_add(&page->missing, &glyphs->missing);
    if (glyphs->unclosed && !page->unclosed)
        page->unclosed = chars;
    if (!add(page, (FigureItem){.kind = FIGURE_TEXT,
                                .box = {left, text->y - glyphs->ascent * size, left + width,
                                        text->y + glyphs->descent * size},
                                .color = text->color,
                                .at = {{text->x, text->y}},
                                .n = 1,
                                .align = text->align,
                                .bold = text->bold,
                                .size_pt = text->size_pt,
                                .text = chars}))
        free(chars);
}

void figure_add_text(FigurePage *page, const FigureText *text)
{
    Text clean = TEXT_INIT;
    Glyphs glyphs;
    char *chars = NULL;
    text_put_line(&clean, text->text);
    if (text_take(&clean, &chars, NULL) != STATUS_OK ||
        fonts_shape(page->fonts, chars, text->bold, &glyphs, NULL) != STATUS_OK) {
        free(chars);
        page->failed = true;
    } else {
        add_line_of_text(page, text, chars, &glyphs);
        glyphs_release(&glyphs);
    }
    text_release(&clean);
}

FigureColor figure_color(const float linear[3])
{
    FigureColor color;
    for (int c = 0; c < 3; c++)
        color.rgb[c] = (uint8_t)image_code(linear[c], ENCODING_SRGB, 8);
    return color;
}

FigureItem figure_bar(const FigureItem *item, size_t i)
{
    const FigureBar *bar = &item->bars->bars[i];
    const FigurePoint at = item->at[0];
    return filled_box(
        (FigureBox){at.x + bar->x[0], at.y + bar->y[0], at.x + bar->x[1], at.y + bar->y[1]},
        figure_color(item->bars->color[bar->index]));
}

void figure_set_halo(FigurePage *page, size_t item, double width_mm, FigureColor color)
{
    page->items[item].halo_mm = width_mm;
    page->items[item].halo = color;
}

/* Returns the halo of an item as a separate item: the text with an outline, or a larger box. */
static FigureItem halo_of(const FigureItem *item)
{
    FigureItem halo = *item;
    if (item->kind != FIGURE_TEXT)
        return filled_box(pad_box(item->box, item->halo_mm), item->halo);
    halo.color = item->halo;
    halo.outline_mm = 2 * item->halo_mm;
    return halo;
}

/* Draws the halo of an item, if it has one, and then the item. */
static Status put_item(const FigureItem *item, FigurePut *const put[FIGURE_KINDS], void *context,
                       Err *err)
{
    if (item->halo_mm > 0) {
        const FigureItem halo = halo_of(item);
        TRY(put[halo.kind](context, &halo, err));
    }
    return put[item->kind](context, item, err);
}

Status figure_put_items(const FigurePage *page, FigurePut *const put[FIGURE_KINDS], void *context,
                        Err *err)
{
    /* Pictures are drawn first, so that they cover no other item. */
    for (int pictures = 1; pictures >= 0; pictures--)
        for (size_t i = 0; i < page->n; i++)
            if ((page->items[i].kind == FIGURE_PICTURE) == pictures)
                TRY(put_item(&page->items[i], put, context, err));
    return STATUS_OK;
}

Status figure_check(const FigurePage *page, Err *err)
{
    return page->failed ? mem_out_of("for", "the page", err) : STATUS_OK;
}

void figure_put_missing(const FigurePage *page, bool boxed, Text *out)
{
    const FigureLetters *missing = &page->missing;
    const uint32_t *letters = boxed ? missing->boxed : missing->fallback;
    const int n = boxed ? missing->n_boxed : missing->n_fallback;
    if (n == 0)
        return;
    text_puts(out, boxed ? "no font has" : "Liberation Sans lacks");
    for (int i = 0; i < n; i++) {
        text_puts(out, i ? ", " : " ");
        text_put_character(out, letters[i]);
        text_printf(out, " (U+%04X)", (unsigned)letters[i]);
    }
    text_puts(out, boxed ? "; a box is drawn in place of each" : "; DejaVu Sans is used for these");
}

void figure_put_unclosed(const FigurePage *page, Text *out)
{
    if (!page->unclosed)
        return;
    text_puts(out, "the text '");
    text_put_start(out, page->unclosed, 60);
    text_puts(out, "' has a group _{ or ^{ without }: the group ends with the text");
}

FigureBox figure_bounds(const FigurePage *page, size_t first)
{
    FigureBox bounds = empty_box;
    for (size_t i = first; i < page->n; i++)
        bounds = join_boxes(bounds, page->items[i].box);
    return bounds;
}

void figure_move(FigurePage *page, size_t first, double dx, double dy)
{
    for (size_t i = first; i < page->n; i++) {
        FigureItem *item = &page->items[i];
        item->box.left += dx;
        item->box.right += dx;
        item->box.top += dy;
        item->box.bottom += dy;
        for (int k = 0; k < item->n; k++) {
            item->at[k].x += dx;
            item->at[k].y += dy;
        }
    }
}

void figure_mark_solid(FigurePage *page, size_t first)
{
    for (size_t i = first; i < page->n; i++)
        page->items[i].solid = page->items[i].kind != FIGURE_TEXT;
}
