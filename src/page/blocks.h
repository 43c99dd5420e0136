/* The numbers of a page, as blocks of base64; private to the room page. */
#ifndef CORCAST_PAGE_BLOCKS_H
#define CORCAST_PAGE_BLOCKS_H

#include "page/page.h"

/* Whether all values are whole numbers that 16 bits hold, or NAN. */
bool field_is_whole(const FieldSeries *series);

/* Appends all blocks, a script element for each, whose id names it. */
void put_blocks(const PageParams *params, Text *out);

#endif
