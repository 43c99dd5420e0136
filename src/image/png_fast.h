/* Reads and writes the most common kinds of PNG faster than libpng: png_decode_plain decodes
 * without libpng, and a PngDeflater compresses on several threads. Private to the module image. */
#ifndef CORCAST_IMAGE_PNG_FAST_H
#define CORCAST_IMAGE_PNG_FAST_H

#include "image/formats.h"

/* Maximum compression ratio of deflate. With the file's size it bounds the number of pixels that
 * the header of a valid PNG can state. */
enum { DEFLATE_MAX_RATIO = 1032 };

/* Decodes a PNG of the common form: 8 or 16 bits, no palette, not interlaced, colors of sRGB. The
 * last of 2 or 4 channels is alpha. Returns false, and leaves *picture unchanged, if the file has
 * another form or is broken, or if memory runs out. */
bool png_decode_plain(const ImageBytes *file, Picture *picture);

/* Converts 16-bit codes in place between big-endian, the order of the file, and the byte order of
 * the machine. */
void png_swap_codes(uint16_t *codes, size_t n);

/* Compresses the rows of a PNG on several threads. */
typedef struct PngDeflater PngDeflater;

/* Receives the bytes of the zlib stream in order, one stripe of rows at a time. */
typedef void PngTakeBytes(void *context, const uint8_t *bytes, size_t n);

/* Makes a deflater for rows of codes on form->packing.threads threads.
 *
 * up       each row is replaced by its difference from the row above (filter Up of PNG); false:
 *          rows stay as they are
 * out      is owned; release it with pngdeflater_free, even after an error.
 * Errors   STATUS_MEMORY. Takes up to 3 MB per thread, or a few rows if these need more. */
MUST_CHECK Status pngdeflater_open(PngDeflater **out, const ImageForm *form, bool up, Err *err);
/* Returns the number of rows that pngdeflater_rows expects at a time. */
int pngdeflater_rows_at_once(const PngDeflater *self);
/* Compresses the next `n_rows` rows and passes them to `take`. `n_rows` is
 * pngdeflater_rows_at_once, or fewer at the end of the image. The last rows complete the stream.
 *
 * rows     the bytes of the rows in the order of the file: 16-bit codes with the high byte first
 * take     may leave by longjmp. The only call that may then follow is pngdeflater_free. */
void pngdeflater_rows(PngDeflater *self, const uint8_t *rows, int n_rows, PngTakeBytes *take,
                      void *context);
void pngdeflater_free(PngDeflater *self); /* NULL is allowed */

#endif
