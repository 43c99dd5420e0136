/* Finds texts that overlap other texts, bars or swatches, or the edge of the page. */
#include "figure/figure.h"

/* Two boxes that overlap by less than this in one direction do not collide. The box of a text is a
 * little larger than its letters, so such an overlap cannot be seen. */
static const double slack_mm = 0.1;

/* Maximum number of collisions that are listed. Further collisions are only counted. The list is
 * one line of a warning. */
enum { LISTED = 3 };

static bool is_on_page(const FigurePage *page, const FigureBox *box)
{
    return box->left >= -slack_mm && box->top >= -slack_mm &&
           box->right <= page->width_mm + slack_mm && box->bottom <= page->height_mm + slack_mm;
}

/* Returns true if the text overlaps a solid item, or a text that follows it in the array. Each pair
 * of texts is thereby compared once. */
static bool collide(const FigureItem *text, const FigureItem *other)
{
    const bool is_pair = other->solid || (other->kind == FIGURE_TEXT && other > text);
    return is_pair && figure_boxes_overlap(&text->box, &other->box, slack_mm);
}

/* Appends the beginning of a text, 40 characters, in quotation marks. */
static void put_name(const FigureItem *item, Text *out)
{
    text_puts(out, "'");
    text_put_start(out, item->text, 40);
    text_puts(out, "'");
}

/* Appends the collision of a text with an item, or with the edge of the page if `with` is NULL. */
static void put_collision(const FigureItem *text, const FigureItem *with, int n, Text *out)
{
    if (n > LISTED)
        return;
    text_puts(out, n > 1 ? "; " : "");
    put_name(text, out);
    text_puts(out, " and ");
    if (with && with->text)
        put_name(with, out);
    else
        text_puts(out, with ? "a bar" : "the edge of the page");
}

void figure_put_collisions(const FigurePage *page, Text *out)
{
    int n = 0;
    Text list = TEXT_INIT;
    for (size_t i = 0; i < page->n; i++) {
        const FigureItem *text = &page->items[i];
        if (text->kind != FIGURE_TEXT)
            continue;
        if (!is_on_page(page, &text->box))
            put_collision(text, NULL, ++n, &list);
        for (size_t k = 0; k < page->n; k++)
            if (collide(text, &page->items[k]))
                put_collision(text, &page->items[k], ++n, &list);
    }
    if (n > 0) {
        text_puts(out, "texts overlap: ");
        text_add(out, &list);
    }
    if (n > LISTED)
        text_printf(out, "; and %d more", n - LISTED);
    text_release(&list);
}
