/* A TIFF in libtiff's hands, read from or written to a stream; private to the room image. */
#ifndef CORCAST_IMAGE_TIFF_STREAM_H
#define CORCAST_IMAGE_TIFF_STREAM_H

#include "image/formats.h"

typedef struct TiffStream {
    FILE *stream; /* borrowed; with places */
    void *bytes;  /* borrowed; of a file that is read, all of it, or NULL */
    size_t size;
    void *handle;        /* a TIFF, or NULL; owned */
    char complaint[200]; /* libtiff's first, "" when there is none */
} TiffStream;

/* Opens the stream's TIFF, `mode` as libtiff has it; false when that fails. Of a file that is read,
 * warnings are no complaints. */
bool tiff_open(TiffStream *tiff, const char *name, const char *mode);

typedef Status TiffWork(void *self, Err *err);

/* work(self, err), which calls libtiff. Where an allocation of libtiff's fails, `work` is left at
 * that place and the handle becomes NULL: it is in no state to be closed, and what it holds is
 * lost. STATUS_MEMORY then, with a sentence that names `name`. */
MUST_CHECK Status tiff_guard(TiffWork *work, void *self, TiffStream *tiff, const char *name,
                             Err *err);

/* The same for a file that is in memory: *tiff, which is in `self`, reads its bytes while `work`
 * runs, which opens it, and is closed behind it. STATUS_MEMORY. */
MUST_CHECK Status tiff_guard_bytes(TiffWork *work, void *self, TiffStream *tiff,
                                   const ImageBytes *file, Err *err);

#endif
