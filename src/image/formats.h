/* The file formats behind picture_read, picture_write, plane_read and plane_write; private to the
 * room image. Readers take a whole file and its name for the error sentence; no size a header
 * claims is believed before it has been held against the size of the file. */
#ifndef CORCAST_IMAGE_FORMATS_H
#define CORCAST_IMAGE_FORMATS_H

#include "image/image.h"

typedef struct ImageBytes {
    const char *name;
    const uint8_t *bytes;
    size_t size;
} ImageBytes;

/* STATUS_INPUT unless both sides, as a header states them, are in [1, IMAGE_MAX_SIDE]. */
MUST_CHECK Status image_check_sides(const char *name, long long width, long long height, Err *err);

/* Walks the header of a PNM or PFM file: words between blanks, '#' comments skipped. */
typedef struct HeaderCursor {
    ImageBytes file;
    size_t at;
} HeaderCursor;

/* The next word as a whole number in [minimum, maximum]; `what` names it. */
MUST_CHECK Status header_integer(HeaderCursor *cursor, const char *what, long long minimum,
                                 long long maximum, long long *out, Err *err);
/* The next word, truncated to size - 1 characters. */
void header_word(HeaderCursor *cursor, char *word, size_t size);
/* Steps over the one blank between header and pixels, and checks that `needed` bytes of pixels
 * follow it. */
MUST_CHECK Status header_end(HeaderCursor *cursor, size_t needed, Err *err);

bool pnm_is(const ImageBytes *file);
MUST_CHECK Status pnm_decode(const ImageBytes *file, Picture *picture, Err *err);
MUST_CHECK Status pnm_encode(FILE *stream, const Picture *picture, int channels, Err *err);

bool png_is(const ImageBytes *file);
MUST_CHECK Status png_decode(const ImageBytes *file, Picture *picture, Err *err);
MUST_CHECK Status png_encode(FILE *stream, const Picture *picture, Encoding encoding,
                             const ImageNotes *notes, Err *err);

#endif
