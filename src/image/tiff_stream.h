/* Opens a TIFF with libtiff from a FILE or from a file in memory. tiff_open must be called from a
 * function that guard_run runs [guard.h], because errors of libtiff leave the function by longjmp.
 * Private to the module image. */
#ifndef CORCAST_IMAGE_TIFF_STREAM_H
#define CORCAST_IMAGE_TIFF_STREAM_H

#include "image/formats.h"
#include <tiffio.h>

/* The source of a TIFF and its handle. The caller sets the first three members. */
typedef struct TiffStream {
    FILE *stream;         /* borrowed; seekable; not used if `bytes` is not NULL */
    const uint8_t *bytes; /* borrowed; the whole file, if it is read from memory; else NULL */
    size_t size;          /* number of bytes */
    TIFF *handle;         /* NULL: not open. The caller closes it with TIFFClose. Use and close it
                           * only inside guard_run with the same Guard. Once Guard.failed is true, do
                           * neither: the handle is lost */
} TiffStream;

/* Opens tiff->bytes, or tiff->stream if `bytes` is NULL, and sets tiff->handle. `name` is the
 * file's name for libtiff, `mode` the mode of TIFFOpen. Returns false on failure. Errors of libtiff
 * become the message of the running guard; so do its warnings if a file is written. */
bool tiff_open(TiffStream *tiff, const char *name, const char *mode);

#endif
