/* Connects libtiff to a FILE, or to a file in memory. Private to the module image. */
#ifndef CORCAST_IMAGE_TIFF_STREAM_H
#define CORCAST_IMAGE_TIFF_STREAM_H

#include "image/formats.h"
#include <tiffio.h>

typedef struct TiffStream {
    FILE *stream;         /* borrowed; seekable */
    const uint8_t *bytes; /* borrowed; the whole file, if it is read from memory; else NULL */
    size_t size;          /* number of bytes */
    TIFF *handle;         /* owned; NULL: not open. It must not be used or closed after its guard
                           * was left */
} TiffStream;

/* Opens tiff->stream, or tiff->bytes, with a mode of TIFFOpen. Returns false on failure. The
 * guard's message receives the errors of libtiff, and its warnings when a file is written. */
bool tiff_open(TiffStream *tiff, const char *name, const char *mode);

#endif
