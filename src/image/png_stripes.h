/* The rows of a PNG as stripes that threads compress side by side; private to the room image. */
#ifndef CORCAST_IMAGE_PNG_STRIPES_H
#define CORCAST_IMAGE_PNG_STRIPES_H

#include "image/formats.h"

typedef struct PngStripes PngStripes;

/* Takes the bytes of the zlib stream as they come, in order: those of one stripe each time. */
typedef void PngTakeBytes(void *context, const uint8_t *bytes, size_t n);

/* For the rows of a picture of codes, of form->packing.threads. `up`: each row is filtered by the
 * one above (PNG's filter Up), otherwise none is. Holds up to 3 MB a thread, or ten rows where that
 * is more. *out is owned by the caller, who releases it, also on failure, which is STATUS_MEMORY.
 */
MUST_CHECK Status pngstripes_open(PngStripes **out, const ImageForm *form, bool up, Err *err);
/* Takes the next `n` rows, as RowEncoder has them. What is compressed by then is handed to `take`;
 * with the last row that is all of the stream. `take` may leave by longjmp, after which only
 * pngstripes_free may follow. */
void pngstripes_rows(PngStripes *self, const void *codes, int n, PngTakeBytes *take, void *context);
void pngstripes_free(PngStripes *self); /* NULL is allowed */

#endif
