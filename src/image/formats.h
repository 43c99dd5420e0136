/* The file formats behind image_read and ImageWriter; private to the room image. Readers take a
 * whole file and its name for the error sentence. No reader asks for memory for the pixels that a
 * header announces before it has held them against the size of the file: PNM and PFM exactly, PNG,
 * TIFF and OpenEXR by image_check_claim. */
#ifndef CORCAST_IMAGE_FORMATS_H
#define CORCAST_IMAGE_FORMATS_H

#include "image/image.h"

typedef struct ImageBytes {
    const char *name;
    const uint8_t *bytes;
    size_t size;
    const char *layer; /* that is asked for, of formats that have some; or NULL */
} ImageBytes;

/* STATUS_INPUT unless both sides, as a header states them, are in [1, IMAGE_MAX_SIDE]. */
MUST_CHECK Status image_check_sides(const char *name, long long width, long long height, Err *err);

/* STATUS_INPUT, naming the file, its size and the sides, when `bytes` of pixels are more than
 * `most`, the bytes that a file of this size can hold however well it is compressed. */
MUST_CHECK Status image_check_claim(const ImageBytes *file, long long width, long long height,
                                    size_t bytes, size_t most, Err *err);

/* STATUS_MEMORY when the machine has fewer than `bytes` for an image of these sides. */
MUST_CHECK Status image_check_memory(int width, int height, size_t bytes, Err *err);

/* Whether chromaticities, x and y of red, green, blue and white, are sRGB's to 0.002. */
bool image_is_srgb(const double xy[8]);
/* STATUS_INPUT naming the file: its colours are of another space, as `where` in it says. */
Status image_other_colors(const char *name, const char *where, Err *err);
/* The description in an ICC profile, what is no printable ASCII left out; "" when it has none. */
void image_profile_name(const uint8_t *profile, size_t size, char text[IMAGE_PROFILE_NAME]);
/* STATUS_INPUT, naming file and profile, unless an ICC profile is of sRGB. */
MUST_CHECK Status image_check_profile(const char *name, const uint8_t *profile, size_t size,
                                      Err *err);

/* STATUS_INPUT naming the file: it is a picture that cannot be read row by row. */
Status image_no_rows(const char *name, Err *err);

/* Four bytes, the most significant first. */
static inline uint32_t image_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* A library's words as part of a sentence: what is no printable ASCII becomes a blank. */
void image_plain_text(char *text);

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

/* How a format is written. Rows come from the top down, `n` at a time, the first of them row
 * `first`; values are codes of 8 or 16 bits or floats, as the form says. */
typedef struct RowEncoder {
    /* Writes what comes first; *self is owned by the caller, who releases it, also on failure. */
    Status (*begin)(FILE *stream, const ImageForm *form, void **self, Err *err);
    Status (*rows)(void *self, const void *values, int first, int n, Err *err);
    Status (*end)(void *self, Err *err); /* writes what comes last; may be NULL */
    void (*release)(void *self);         /* NULL is allowed */
    double folds;     /* a file is at most this many times smaller than its values; 0: not known */
    bool keeps_dpi;   /* has a place for the resolution on paper */
    bool keeps_inks;  /* takes codes of 4 channels: cyan magenta yellow black */
    bool keeps_alpha; /* takes codes of 4 channels: red green blue alpha */
    bool floats;      /* takes floats, not codes */
} RowEncoder;

extern const RowEncoder ppm_encoder, pgm_encoder, png_encoder, tiff_encoder, jpeg_encoder,
    pfm_encoder, exr_encoder;

/* The text of a note; NULL when there is none of this key. */
const char *image_note(const ImageNotes *notes, const char *key);
/* All notes but software and shard, a line each, for formats that have one place for them; in *text
 * (owned). */
MUST_CHECK Status image_description(const ImageNotes *notes, char **text, Err *err);

/* The bytes of an ICC profile. */
typedef struct ImageProfile {
    uint8_t *bytes;
    size_t size;
} ImageProfile;

/* The profile that a file of this form carries, in *profile (its bytes owned): the press's, or
 * sRGB's; without bytes where the codes are grey or linear. */
MUST_CHECK Status image_profile(const ImageForm *form, ImageProfile *profile, Err *err);

/* `n` pixels of three codes, of as many bits as the inks were read for, to four. */
void inks_convert(const Inks *inks, const void *rgb, void *cmyk, size_t n);
int inks_bits(const Inks *inks);

/* How a format is read a few rows at a time, from a stream with places. */
typedef struct RowDecoder {
    bool (*is)(const ImageBytes *file); /* by the first bytes, all that may be there */
    /* Reads what comes first into *form, whose notes last as long as *self, which is owned by the
     * caller, who releases it, also on failure. STATUS_INPUT for what cannot be read so. */
    Status (*begin)(FILE *stream, const char *name, ImageForm *form, void **self, Err *err);
    /* The next `n` rows, codes of 8 or 16 bits as the form says. */
    Status (*rows)(void *self, void *values, int n, Err *err);
    Status (*end)(void *self, Err *err); /* reads what comes last */
    void (*release)(void *self);         /* NULL is allowed */
} RowDecoder;

extern const RowDecoder png_rows_decoder, tiff_rows_decoder;

/* How a format is read. */
typedef struct ImageDecoder {
    bool (*is)(const ImageBytes *file); /* by the first bytes, all that may be there */
    /* Fills in the picture or the plane of a zeroed image; it is untouched on failure. */
    Status (*decode)(const ImageBytes *file, Image *image, Err *err);
    bool has_layers;
} ImageDecoder;

extern const ImageDecoder png_decoder, pnm_decoder, pfm_decoder, exr_decoder, tiff_decoder,
    jpeg_decoder, webp_decoder;

/* Deflate shrinks at most 1032-fold, which bounds what a PNG's header may claim. */
enum { DEFLATE_MAX_RATIO = 1032 };

/* Decodes a PNG of the common form; false, leaving *picture as it is, on any other, broken ones
 * included. */
bool png_decode_plain(const ImageBytes *file, Picture *picture);

/* What becomes of an alpha channel that is not opaque throughout; one that is, is left out. */
typedef enum ImageAlpha {
    ALPHA_REFUSED,
    ALPHA_KEPT,   /* grey pictures become coloured */
    ALPHA_IS_MASK /* as picture_read_mask reads it */
} ImageAlpha;

/* Makes an image as a decoder hands it over, alpha the last of 2 or 4 channels, what readers of
 * this kind expect. STATUS_INPUT, naming the file, when it is transparent and refused. */
MUST_CHECK Status image_settle_alpha(Image *image, ImageAlpha alpha, const char *name, Err *err);

#endif
