/* The numbers of a page as blocks of base64; private to the module page. */
#ifndef CORCAST_PAGE_BLOCKS_H
#define CORCAST_PAGE_BLOCKS_H

#include "page/page.h"

/* Returns true if every value is an integer from 0 to 65534, or NAN. */
bool field_is_whole(const FieldSeries *series);

/* Appends all blocks, each a script element whose id is the name of the block [blocks.c]. */
void put_blocks(const PageParams *params, Text *out);

#endif
