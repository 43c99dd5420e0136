/* Writes the numbers of a page as blocks of base64. Each block is a script element of the page; the
 * viewer finds it by its id [templates/viewer/tree.js]. Private to the module page. */
#ifndef CORCAST_PAGE_BLOCKS_H
#define CORCAST_PAGE_BLOCKS_H

#include "page/page.h"

/* Returns true if every value of the field is an integer from 0 to 65534, or NAN. The values of
 * such a field are written in 16 bits each instead of 32. */
bool field_is_whole(const FieldSeries *series);

/* Appends all blocks. The id of a block's element is the name of the block [blocks.c]. If memory
 * runs out, `out` is marked as failed [base/text.h]. */
void put_blocks(const PageParams *params, Text *out);

#endif
