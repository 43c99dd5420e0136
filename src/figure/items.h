/* Iterates over the items of a page, for the writers of PDF, SVG and pixels. Private to the module
 * figure. */
#ifndef CORCAST_FIGURE_ITEMS_H
#define CORCAST_FIGURE_ITEMS_H

#include "figure/figure.h"

/* Draws or writes one item. */
typedef Status FigurePut(void *context, const FigureItem *item, Err *err);

/* Calls put[item->kind](context, item, err) for every item of the page: first for the pictures,
 * then for all others, in the order of the page. Stops at the first error and returns it. */
MUST_CHECK Status figure_put_items(const FigurePage *page, FigurePut *const put[FIGURE_KINDS],
                                   void *context, Err *err);

/* Returns bar `i`, below item->bars->n, of an item of the kind FIGURE_BARS as an item of the kind
 * FIGURE_SHAPE, which owns nothing. */
FigureItem figure_bar(const FigureItem *item, size_t i);

#endif
