/* The decoders and encoders of image formats, which image_read, ImageReader and ImageWriter call.
 * Private to the module image.
 *
 * To add a format, write an ImageDecoder, a RowEncoder, or both. Each is a table of functions that
 * share a state of the format's own. The state begins with an ImageInput or ImageOutput, which
 * contains the arguments and results of the functions. Every function is called by guard_run
 * [guard.h], because the image libraries report errors by longjmp.
 *
 * A header may state more pixels than the file can hold. Therefore no decoder allocates memory for
 * pixels before it has compared the stated size with the size of the file. PNM and PFM files must
 * have exactly the stated size. For the other formats, image_check_stated_size allows the best
 * possible compression. */
#ifndef CORCAST_IMAGE_FORMATS_H
#define CORCAST_IMAGE_FORMATS_H

#include "image/guard.h"
#include "image/image.h"

/* A file in memory. All pointers are borrowed. */
typedef struct ImageBytes {
    const char *name; /* name of the file, for errors */
    const uint8_t *bytes;
    size_t size;
    const char *layer; /* the requested layer, of formats that have layers; NULL: none */
} ImageBytes;

/* ---- checks that formats share --------------------------------------------------------------- */

/* Checks the sides that a header states, in pixels. Errors: STATUS_INPUT unless both are in
 * [1, IMAGE_MAX_SIDE]. */
MUST_CHECK Status image_check_sides(const char *name, long long width, long long height, Err *err);

/* Checks the size that a header states.
 *
 * bytes    the size of the pixels after decompression.
 * maximum  the largest size that a file of this size can hold at the best compression.
 * Errors   those of image_check_sides; STATUS_INPUT, with the file, its size and the sides, if
 *          `bytes` is above `maximum`. */
MUST_CHECK Status image_check_stated_size(const ImageBytes *file, long long width, long long height,
                                          size_t bytes, size_t maximum, Err *err);

/* Checks that the machine has `bytes` of memory for an image of these sides. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status image_check_memory(int width, int height, size_t bytes, Err *err);

/* Returns true if the chromaticities (x and y of red, green, blue and white) differ by at most
 * 0.002 from those of sRGB. This is four times the error of programs that round to three digits. */
bool image_is_srgb(const double xy[8]);
/* Sets the error that the colors of the file are not sRGB, and returns STATUS_INPUT. `where` names
 * the part of the file that states the color space. */
Status image_fail_not_srgb(const char *name, const char *where, Err *err);
/* Copies the description of an ICC profile to `text`, without the characters that are not printable
 * ASCII; "" if the profile has no description. */
void image_profile_name(const uint8_t *profile, size_t size, char text[IMAGE_PROFILE_NAME]);
/* Checks that an ICC profile is an sRGB profile. Errors: STATUS_INPUT, with the names of file and
 * profile. */
MUST_CHECK Status image_check_profile(const char *name, const uint8_t *profile, size_t size,
                                      Err *err);

/* Sets the error that the picture cannot be read row by row, and returns STATUS_INPUT. */
Status image_fail_no_rows(const char *name, Err *err);

/* Returns the big-endian number in four bytes. */
static inline uint32_t image_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The state of reading the header of a PNM or PFM file, which consists of words that blanks
 * separate. A comment from '#' to the end of the line counts as a blank. */
typedef struct HeaderCursor {
    ImageBytes file;
    size_t at; /* offset in the file of the next character */
} HeaderCursor;

/* Reads the next word as an integer in [minimum, maximum]. `what` is its name in errors. Errors:
 * STATUS_INPUT. */
MUST_CHECK Status header_integer(HeaderCursor *cursor, const char *what, long long minimum,
                                 long long maximum, long long *out, Err *err);
/* Reads the next word, truncated to size - 1 characters; "" at the end of the file. */
void header_word(HeaderCursor *cursor, char *word, size_t size);
/* Steps over the one blank between header and pixels. Errors: STATUS_INPUT unless exactly `needed`
 * bytes of pixels follow it. */
MUST_CHECK Status header_end(HeaderCursor *cursor, size_t needed, Err *err);

/* ---- reading --------------------------------------------------------------------------------- */

/* A file that is being read. The state of every decoder begins with an ImageInput; imageinput_open
 * zeroes the rest of the state. */
typedef struct ImageInput {
    Guard guard;
    const struct ImageDecoder *decoder;
    ImageBytes file; /* the whole file; `bytes` is NULL if rows are read from `stream` */
    FILE *stream;    /* the file from which rows are read, seekable, at its beginning; NULL: the
                      * file is in memory */
    /* Results; the decoder need not release them on failure. */
    Image image;      /* result of `decode`; alpha is the last of 2 or 4 channels */
    ImageFacts facts; /* result of `get_facts` */
    ImageForm form;   /* result of `begin`; its notes are owned by the decoder's state */
    /* Arguments of `rows`: */
    void *rows; /* receives the rows: integer codes of form.bits bits */
    int n_rows; /* number of rows to read */
} ImageInput;

/* The functions that read a format. All functions except `is` receive the decoder's state. */
typedef struct ImageDecoder {
    const char *format; /* for errors */
    size_t state_size;
    bool (*is)(const ImageBytes *file); /* recognises the first bytes; `file` may hold only the
                                         * first 16 bytes of the file */
    GuardedWork *decode;                /* decodes the whole file */
    GuardedWork *get_facts;             /* finds the properties; NULL: not supported */
    /* Read rows from a stream; NULL: the format can only be read as a whole. */
    GuardedWork *begin;          /* sets `form`; returns image_fail_no_rows if `rows` cannot read
                                  * it */
    GuardedWork *rows;           /* reads the next rows */
    GuardedWork *end;            /* reads the rest of the file */
    void (*release)(void *self); /* releases what the state owns; NULL: nothing */
    bool has_layers;
} ImageDecoder;

extern const ImageDecoder png_decoder, pnm_decoder, pfm_decoder, exr_decoder, tiff_decoder,
    jpeg_decoder, webp_decoder;

/* Returns the decoder of a file by its first bytes; NULL if the format is unknown. */
const ImageDecoder *imagedecoder_of(const ImageBytes *file);

/* Makes the state of a decoder: for a file in memory if `stream` is NULL, else for reading rows
 * from the stream, which is borrowed. *out is set on success only; close it with imageinput_close.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status imageinput_open(const ImageDecoder *decoder, const ImageBytes *file, FILE *stream,
                                  ImageInput **out, Err *err);
void imageinput_close(ImageInput *input); /* NULL is allowed */

/* Treats the alpha channel of a decoded image, the last of 2 or 4 channels, as `alpha` says.
 * Errors: STATUS_INPUT, with the file's name, if the image is transparent and `alpha` is
 * ALPHA_REFUSED. */
MUST_CHECK Status image_apply_alpha(Image *image, ImageAlpha alpha, const char *name, Err *err);

/* ---- writing --------------------------------------------------------------------------------- */

/* The bytes of an ICC profile. */
typedef struct ImageProfile {
    uint8_t *bytes; /* owned */
    size_t size;    /* 0: no profile */
} ImageProfile;

/* A file that is being written. The state of every encoder begins with an ImageOutput; the rest of
 * the state is zeroed before `begin`. */
typedef struct ImageOutput {
    Guard guard;
    const struct RowEncoder *encoder;
    FILE *stream; /* borrowed */
    ImageForm form;
    size_t row_bytes;     /* bytes of a row in memory */
    ImageProfile profile; /* if the encoder has profiles */
    char *description;    /* all notes, one per line, except "Software" and "Shard" (which part of a
                           * picture the file has), which have tags of their own; owned; set if the
                           * encoder has profiles */
    int chunk_rows;       /* number of rows per call of `rows`; the last call may have fewer. Set by
                           * `begin`. 0: as many rows as each call of the ImageWriter passes */
    uint8_t *chunk;       /* owned; NULL if chunk_rows is 0. `rows` may change it */
    int n_gathered;       /* rows in the chunk */
    uint8_t *row;         /* owned; workspace of the encoder for a row, which `begin` allocates;
                           * NULL: it needs none */
    /* Arguments of `rows`: */
    const void *values; /* the rows: codes or floats, as the form states. Equal to `chunk` unless
                         * chunk_rows is 0 */
    int first, n;       /* index in the image of the first row; number of rows */
} ImageOutput;

/* The functions that write a format, from the top row down. */
typedef struct RowEncoder {
    const char *format; /* for errors */
    size_t state_size;
    GuardedWork *begin;          /* writes the part of the file before the rows */
    GuardedWork *rows;           /* writes the next rows */
    GuardedWork *end;            /* writes the part of the file after the rows; NULL: there is
                                  * none */
    void (*release)(void *self); /* releases what the state owns besides the ImageOutput; runs in
                                  * the guard; NULL: nothing */
    int channels;                /* channels in the file; 0: as the form states */
    double max_ratio;            /* the largest possible ratio of the size of the values to the size
                                  * of the file, which gives the file's minimum size; 0: unknown */
    ImageTraits traits;
} RowEncoder;

extern const RowEncoder ppm_encoder, pgm_encoder, png_encoder, tiff_encoder, jpeg_encoder,
    pfm_encoder, exr_encoder;

/* Checks that the output is seekable, for formats that must go back in the file. Errors: STATUS_IO
 * if the output is a pipe. */
MUST_CHECK Status imageoutput_check_seekable(const ImageOutput *output, Err *err);

/* Returns the text of the note with this key; NULL if there is none. */
const char *image_note(const ImageNotes *notes, const char *key);

/* Makes the ICC profile for a file of this form: the output profile of the inks if the form has
 * inks, else the profile of sRGB. If the codes are grey or linear, profile->size is 0. The caller
 * frees profile->bytes, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status image_profile(const ImageForm *form, ImageProfile *profile, Err *err);

/* Returns the number of bits of the codes that inks_convert converts: 8 or 16. */
int inks_bits(const Inks *inks);

#endif
