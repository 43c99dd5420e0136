/* The numbers of a page as blocks of base64. The viewer reads them by the ids of their elements
 * [templates/viewer/tree.js]. Private to the module page. */
#ifndef CORCAST_PAGE_BLOCKS_H
#define CORCAST_PAGE_BLOCKS_H

#include "page/page.h"

/* Returns true if every value is an integer from 0 to 65534, or NAN. Such a field is written in 16
 * bits per value instead of 32. */
bool field_is_whole(const FieldSeries *series);

/* Appends all blocks. Each is a script element; its id is the name of the block [blocks.c]. Running
 * out of memory marks `out` as failed [base/text.h]. */
void put_blocks(const PageParams *params, Text *out);

#endif
