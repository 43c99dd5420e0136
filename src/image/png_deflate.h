/* Deflates filtered rows of a PNG, a part of them at a time; private to the room image. */
#ifndef CORCAST_IMAGE_PNG_DEFLATE_H
#define CORCAST_IMAGE_PNG_DEFLATE_H

#include "image/formats.h"

/* Room to work in, for one thread at a time. */
typedef struct PngDeflate PngDeflate;

/* For parts of at most `most` bytes; `line` bytes a row with its filter byte, `unit` of them a
 * pixel: 1 to 4, 6 or 8. Holds 32 KB, and up to 2.7 `most` as parts need it. *out is owned by the
 * caller, who releases it, also on failure, which is STATUS_MEMORY. */
MUST_CHECK Status pngdeflate_open(PngDeflate **out, size_t most, size_t line, size_t unit,
                                  Err *err);
/* The room that a part of `n` bytes needs in `out`. */
size_t pngdeflate_room(size_t n);
/* Deflates whole rows, `n` bytes, behind which PNG_DEFLATE_SLACK more can be read. Gives the bytes
 * written to `out`: blocks of a deflate stream that is not at its end, which reach back to nothing
 * before them and end at a byte. They follow from the rows alone. */
size_t pngdeflate_rows(PngDeflate *self, const uint8_t *rows, size_t n, uint8_t *out);
void pngdeflate_free(PngDeflate *self); /* NULL is allowed */

enum { PNG_DEFLATE_SLACK = 8 };

#endif
