/* Draws the overlay of the window that the command `view` opens: legend, status line and list of
 * keys. The module figure draws a page over a picture and knows no opacity. The page is therefore
 * drawn over black and over white. The opacity of a pixel is 255 minus the difference between the
 * two drawings, and the code over black is the color multiplied by the opacity. Boxes in the color
 * of the background are below all text, so that the text can be read over vessels. Distances on the
 * page are in em, the size of the text; their reasons are not recorded. */
#include "cli/command/view_overlay.h"

#include "job/picture/annotation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* 96 pixels per inch, the number of CSS, stand for the unknown resolution of the screen. Larger
 * text_pt: larger text. */
static const double screen_dpi = 96, text_pt = 10;

/* The page that is being filled. */
typedef struct OverlayPage {
    FigurePage *page;
    FigureColor ink, paper;
    double size_pt; /* of text */
    double em;      /* size of text, mm */
} OverlayPage;

static FigureBox widened(FigureBox box, double mm)
{
    return (FigureBox){box.left - mm, box.top - mm, box.right + mm, box.bottom + mm};
}

/* Adds a box in the color of the background around `box`. */
static void put_box(const OverlayPage *to, FigureBox box)
{
    figure_add_box(to->page, widened(box, 0.5 * to->em), to->paper);
}

static void put_framed_box(const OverlayPage *to, FigureBox box)
{
    const FigureBox frame = widened(box, to->em);
    const FigurePoint corner[] = {{frame.left, frame.top},
                                  {frame.right, frame.top},
                                  {frame.right, frame.bottom},
                                  {frame.left, frame.bottom}};
    figure_add_box(to->page, frame, to->paper);
    figure_add_line(to->page, corner, FIGURE_CORNERS, true, 0.06 * to->em, to->ink);
}

static void put_text(const OverlayPage *to, const char *text, double x, double y, bool bold)
{
    const FigureText line = {
        .text = text, .x = x, .y = y, .size_pt = to->size_pt, .bold = bold, .color = to->ink};
    figure_add_text(to->page, &line);
}

/* Adds the legend, a box of the legend's size that covers it, and the legend again on top of the
 * box. The size of the legend is known only after it has been added. */
static Status put_legend(const OverlayPage *to, const Scene *scene, Err *err)
{
    const Annotation annotation = {.legend = true, .legend_at = LEGEND_RIGHT, .text_pt = text_pt};
    const FigureBox all = {0, 0, to->page->width_mm, to->page->height_mm};
    const size_t first = to->page->n;
    TRY(annotation_put(&annotation, scene, all, to->page, err));
    put_box(to, figure_bounds(to->page, first));
    return annotation_put(&annotation, scene, all, to->page, err);
}

/* Adds the status line in the lower left corner. */
static void put_status(const OverlayPage *to, const char *status)
{
    const double width = figure_text_width(to->page->fonts, status, text_pt, false);
    const double bottom = to->page->height_mm - 0.5 * to->em;
    put_box(to, (FigureBox){0.5 * to->em, bottom - to->em, 0.5 * to->em + width, bottom});
    put_text(to, status, 0.5 * to->em, bottom - 0.2 * to->em, false);
}

/* Returns the width of the widest text of a column of the list of keys: the keys or their
 * meanings. */
static double column_width(const OverlayPage *to, const OverlayKey *keys, size_t n, bool of_keys)
{
    double widest = 0;
    for (size_t i = 0; i < n; i++) {
        const char *text = of_keys ? keys[i].keys : keys[i].meaning;
        widest = fmax(widest, figure_text_width(to->page->fonts, text, to->size_pt, of_keys));
    }
    return widest;
}

/* Adds the list of keys in the middle of the page: keys in one column, their meanings in the other.
 * The text is smaller if the page is too small. A line has the height of 1.5 em, and its text
 * stands 1.1 em below its top; one em is between the columns. */
static void put_keys(OverlayPage to, const OverlayKey *keys, size_t n)
{
    const double line = 1.5, columns[] = {column_width(&to, keys, n, true) / to.em,
                                          column_width(&to, keys, n, false) / to.em};
    const double width = columns[0] + 1 + columns[1], height = (double)n * line; /* in em */
    const FigurePage *page = to.page;
    const double fit = fmin(page->width_mm / (width + 3), page->height_mm / (height + 3)) / to.em;
    to.em *= fmin(1, fit);
    to.size_pt *= fmin(1, fit);
    const double left = (page->width_mm - width * to.em) / 2;
    const double top = (page->height_mm - height * to.em) / 2;
    put_framed_box(&to, (FigureBox){left, top, left + width * to.em, top + height * to.em});
    for (size_t i = 0; i < n; i++) {
        const double y = top + ((double)i * line + 1.1) * to.em;
        put_text(&to, keys[i].keys, left, y, true);
        put_text(&to, keys[i].meaning, left + (columns[0] + 1) * to.em, y, false);
    }
}

static Status fill_page(FigurePage *page, const OverlayContent *content, Err *err)
{
    const Rgb background = content->scene->view.background;
    const OverlayPage to = {.page = page,
                            .ink = annotation_text_color(background),
                            .paper = annotation_color(background),
                            .size_pt = text_pt,
                            .em = text_pt * MM_PER_POINT};
    if (content->scene->appearance.colors)
        TRY(put_legend(&to, content->scene, err));
    put_status(&to, content->status);
    if (content->n_keys)
        put_keys(to, content->keys, content->n_keys);
    return figure_check(page, err);
}

/* Fills a picture with one grey value, and draws the page over it. */
static Status draw_over(const FigurePage *page, uint8_t code, int width, int height, Picture *out,
                        Err *err)
{
    TRY(picture_init(out, width, height, 3, 8, err));
    memset(out->codes8, code, (size_t)width * (size_t)height * 3);
    return figure_draw(page, 0, out, err);
}

/* Makes RGBA pixels of the drawings over black and over white. All channels have the same opacity,
 * so it is computed from the green channel alone. */
static void find_opacity(const Picture *black, const Picture *white, uint8_t *rgba, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t *dark = black->codes8 + 3 * i, *light = white->codes8 + 3 * i;
        memcpy(rgba + 4 * i, dark, 3);
        rgba[4 * i + 3] = (uint8_t)(255 - (light[1] - dark[1]));
    }
}

Status overlay_open(ViewOverlay *overlay, Err *err)
{
    return sheet_open(&overlay->sheet, err);
}

Status overlay_draw(ViewOverlay *overlay, const OverlayContent *content, int width, int height,
                    Err *err)
{
    const size_t n = (size_t)width * (size_t)height;
    Picture black = {0}, white = {0};
    uint8_t *rgba = NULL;
    Status status;
    figure_release(&overlay->sheet.page);
    sheet_begin(&overlay->sheet, (const int[]){width, height}, screen_dpi);
    TRY_GOTO(fill_page(&overlay->sheet.page, content, err));
    TRY_GOTO(draw_over(&overlay->sheet.page, 0, width, height, &black, err));
    TRY_GOTO(draw_over(&overlay->sheet.page, 255, width, height, &white, err));
    TRY_GOTO(mem_calloc(&rgba, n, 4, "pixels of an overlay", err));
    find_opacity(&black, &white, rgba, n);
    free(overlay->rgba);
    overlay->rgba = rgba;
    overlay->width = width;
    overlay->height = height;
done:
    picture_release(&black);
    picture_release(&white);
    return status;
}

void overlay_release(ViewOverlay *overlay)
{
    sheet_release(&overlay->sheet);
    free(overlay->rgba);
    *overlay = (ViewOverlay){0};
}
