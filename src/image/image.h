/* The public header of the module image: images in memory, conversions between them, and their
 * files.
 *
 * There are three kinds of images. A Plane holds linear floats: colors, depths or normals. A
 * Picture holds integer codes of 8 or 16 bits, as in a PNG. An IdPlane holds the id of the segment
 * that is visible in each pixel. picture_from_plane, which encodes linear colors as sRGB codes, is
 * the only color encoding step of the program. Rows are stored from the top down, pixels from left
 * to right, channels interleaved.
 *
 *     TRY(picture_read(&picture, "a.png", ALPHA_REFUSED, err));
 *     TRY(picture_write(&picture, "b.tif", ENCODING_SRGB, NULL, NULL, err));
 *     picture_release(&picture); */
#ifndef CORCAST_IMAGE_IMAGE_H
#define CORCAST_IMAGE_IMAGE_H

#include "base/base.h"
#include "image/colormap.h"   // IWYU pragma: export
#include "image/colorscale.h" // IWYU pragma: export
#include <stdint.h>
#include <string.h>

/* Largest side of an image in pixels, largest number of channels of a Plane, and largest id that an
 * image file can hold: an id takes the three bytes of a color. The reasons for the first two values
 * are not recorded. */
enum { IMAGE_MAX_SIDE = 1 << 20, IMAGE_MAX_CHANNELS = 10, IMAGE_MAX_ID = 0xffffff };

/* A rectangle of pixels; `left` and `top` count from 0. */
typedef struct PixelRect {
    int left, top, width, height;
} PixelRect;

/* Linear floats: color (3 channels, 0 black to 1 white), depth (1 channel, mm, INFINITY where
 * nothing is hit), normal (3 channels, unit vector, 0 0 0 where nothing is hit), or several of them
 * for one file. */
typedef struct Plane {
    int width, height, channels;
    float *values; /* owned; width * height * channels */
} Plane;

/* Integer codes of 8 or 16 bits. */
typedef struct Picture {
    int width, height, channels; /* channels: 1 grey, 3 red green blue, 4 with alpha; a decoder may
                                  * also leave 2, grey with alpha */
    int bits;                    /* 8 or 16 */
    double gamma;                /* 0: codes of sRGB; else code / largest code = linear^gamma */
    uint8_t *codes8;             /* owned; width * height * channels if bits is 8, else NULL */
    uint16_t *codes16;           /* owned; width * height * channels if bits is 16, else NULL */
} Picture;

/* Per pixel: the SWC id of the visible segment; 0 where none is visible. Files hold ids up to
 * IMAGE_MAX_ID. */
typedef struct IdPlane {
    int width, height;
    uint32_t *ids; /* owned */
} IdPlane;

/* Make images whose values are 0. Release them with plane_release, picture_release and
 * idplane_release. Errors: STATUS_INPUT unless both sides are in [1, IMAGE_MAX_SIDE];
 * STATUS_MEMORY, before any memory is touched, if the machine has too little. */
MUST_CHECK Status plane_init(Plane *plane, int width, int height, int channels, Err *err);
MUST_CHECK Status picture_init(Picture *picture, int width, int height, int channels, int bits,
                               Err *err);
MUST_CHECK Status idplane_init(IdPlane *ids, int width, int height, Err *err);
/* As plane_init, but leaves the values undefined, for a plane that is about to be filled. */
MUST_CHECK Status plane_init_unset(Plane *plane, int width, int height, int channels, Err *err);
/* Free an image and zero the struct. A zeroed struct is allowed. */
void plane_release(Plane *plane);
void picture_release(Picture *picture);
void idplane_release(IdPlane *ids);

/* Returns the code with index `i`, in the order of the file. */
static inline uint16_t picture_code(const Picture *picture, size_t i)
{
    return picture->bits == 8 ? picture->codes8[i] : picture->codes16[i];
}

/* Sets the code with index `i`, which must fit into the bits of the picture. */
static inline void picture_set(Picture *picture, size_t i, uint16_t code)
{
    if (picture->bits == 8)
        picture->codes8[i] = (uint8_t)code;
    else
        picture->codes16[i] = code;
}

/* Returns the array of all codes, borrowed: uint8_t or uint16_t by picture->bits. */
static inline void *picture_codes(const Picture *picture)
{
    return picture->bits == 8 ? (void *)picture->codes8 : (void *)picture->codes16;
}

/* Returns the number of codes in a row. */
static inline size_t picture_stride(const Picture *picture)
{
    return (size_t)picture->width * (size_t)picture->channels;
}

/* Returns the codes of row `y` as 16-bit numbers: borrowed from the picture, or copied to
 * `scratch`, which must have space for a row. */
const uint16_t *picture_row(const Picture *picture, int y, uint16_t *scratch);
/* Returns true if `n` pixels of row `y`, from pixel `x` on, are equal in two pictures of the same
 * shape. */
bool picture_rows_equal(const Picture *a, const Picture *b, int y, int x, int n);

/* ---- encoding -------------------------------------------------------------------------------- */

/* sRGB transfer curve (IEC 61966-2-1), linear to encoded and back, in float as POV-Ray does. */
float srgb_encode(float linear);
float srgb_decode(float encoded);

typedef enum Encoding { ENCODING_SRGB, ENCODING_LINEAR } Encoding;

/* Returns floor(clip(encode(v), 0, 1) * maximum + 1/2), computed in float, and 0 for NaN. POV-Ray
 * rounds the same way (base/image/encoding.h of 3.7.0.10), so equal floats give equal codes. `bits`
 * is 8 or 16. */
uint16_t image_code(float linear, Encoding encoding, int bits);

/* A table with which srgb_code computes image_code(., ENCODING_SRGB, 8) fast. The floats from 2^-13
 * to 1 are divided into cells of 1/128 of an octave; within a cell the code increases at most once.
 * Each entry is chosen so that (entry + index of the float in its cell) >> 16 is the code: the sum
 * carries into bit 16 where the code increases. */
enum {
    SRGB_CELL_BITS = 16,
    SRGB_CELL = 1 << SRGB_CELL_BITS, /* floats in a cell */
    SRGB_CELLS_BEGIN = 0x39000000,   /* the bits of 2^-13 */
    SRGB_CELLS = (0x3f800000 - SRGB_CELLS_BEGIN) / SRGB_CELL
};
#define SRGB_MIN 0x1p-13f       /* has code 0 */
#define SRGB_MAX 0x1.fffffep-1f /* the float before 1; has code 255 */

/* The table: one entry per cell. */
typedef struct SrgbCodes {
    uint32_t cells[SRGB_CELLS];
} SrgbCodes;

/* Fills the table. */
void srgb_codes_init(SrgbCodes *codes);
/* Returns the same code as image_code(linear, ENCODING_SRGB, 8). */
static inline uint8_t srgb_code(const SrgbCodes *codes, float linear)
{
    float value = linear > SRGB_MIN ? linear : SRGB_MIN;
    value = value < SRGB_MAX ? value : SRGB_MAX;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits -= SRGB_CELLS_BEGIN;
    return (uint8_t)((codes->cells[bits / SRGB_CELL] + bits % SRGB_CELL) / SRGB_CELL);
}

/* The following functions make images, which the caller releases. Errors: STATUS_MEMORY. */

/* Encodes a color plane of 1 or 3 channels. */
MUST_CHECK Status picture_from_plane(Picture *picture, const Plane *plane, Encoding encoding,
                                     int bits, Err *err);
/* Makes a picture of 4 channels from a color plane that is premultiplied by `alpha`. The picture
 * has straight colors (not premultiplied) and linear alpha. Where alpha is 0, all four codes are 0.
 */
MUST_CHECK Status picture_from_transparent(Picture *picture, const Plane *plane, const Plane *alpha,
                                           Encoding encoding, int bits, Err *err);
/* Decodes a picture, by its gamma, to linear colors. */
MUST_CHECK Status plane_from_picture(Plane *plane, const Picture *picture, Err *err);
/* Converts a picture to codes of sRGB. Alpha keeps its value. */
MUST_CHECK Status picture_to_srgb(Picture *srgb, const Picture *picture, int bits, Err *err);
/* Replaces 8-bit codes by 16-bit codes of the same brightness. Does nothing to 16-bit codes. */
MUST_CHECK Status picture_widen(Picture *picture, Err *err);
/* Makes an 8-bit picture of ids up to IMAGE_MAX_ID: red * 65536 + green * 256 + blue. */
MUST_CHECK Status picture_from_ids(Picture *picture, const IdPlane *ids, Err *err);
/* Converts a picture that picture_from_ids made back to ids. The ids reuse the memory of the
 * picture, and *picture is zeroed. Errors: STATUS_INPUT unless the picture has 3 channels of 8
 * bits; STATUS_MEMORY. After an error the picture is unchanged. */
MUST_CHECK Status ids_take_picture(IdPlane *ids, Picture *picture, Err *err);

/* ---- writing --------------------------------------------------------------------------------- */

/* A note on the origin of an image, never a date or a path. A PNG stores a note as a tEXt chunk, or
 * as an iTXt chunk if the note is not ASCII. A TIFF stores "Software" as Software, "Shard" as
 * PageName, and the other notes as lines of ImageDescription. A JPEG stores notes as comments,
 * OpenEXR as attributes. PNM and PFM store no notes. */
typedef struct ImageNote {
    const char *key;  /* "Software", "Comment", "Colors", "Shard"; at most 79 characters */
    const char *text; /* UTF-8 */
} ImageNote;

typedef struct ImageNotes {
    const ImageNote *notes; /* borrowed */
    int count;
    double dpi; /* pixels per inch: pHYs of a PNG, XResolution and YResolution of a TIFF, the
                 * density of a JPEG, xDensity of OpenEXR; 0: not written */
} ImageNotes;

/* The treatment of colors that an output profile cannot reproduce. INKS_PERCEPTUAL compresses all
 * colors, so that different colors stay different. INKS_RELATIVE moves only the colors that cannot
 * be reproduced, each to the nearest one that can. */
typedef enum InkIntent { INKS_PERCEPTUAL, INKS_RELATIVE } InkIntent;

/* The conversion from sRGB to the cyan, magenta, yellow and black of an output profile. */
typedef struct Inks Inks;

/* Reads an ICC output profile, for codes of 8 or 16 `bits`. *out is owned; free it with inks_free.
 * Takes about 50 ms. Errors: STATUS_INPUT, naming the file, if it is missing, broken or not a
 * profile of four inks; STATUS_MEMORY. */
MUST_CHECK Status inks_read(Inks **out, const char *path, InkIntent intent, int bits, Err *err);
void inks_free(Inks *inks); /* NULL is allowed */
/* Converts `n` pixels from sRGB (three codes) to CMYK (four codes): uint8_t or uint16_t, as the
 * bits of the inks. */
void inks_convert(const Inks *inks, const void *rgb, void *cmyk, size_t n);
/* Returns the bytes of the profile, borrowed, and their number in *size. */
const void *inks_profile(const Inks *inks, size_t *size);

typedef enum ImageCompression { IMAGE_LZW, IMAGE_DEFLATE, IMAGE_UNCOMPRESSED } ImageCompression;

/* Choices of a file format. Zeros are the defaults. */
typedef struct ImagePacking {
    ImageCompression compression; /* compression of a TIFF; all are lossless */
    int threads;                  /* number of threads that compress a PNG; the bytes do not depend
                                   * on it; 0: one per processor */
    int quality;                  /* quality of a JPEG, from 1 to 100; 0: 95 */
    bool half;                    /* OpenEXR: channels have 16 bits, except the exact ones */
    const Inks *inks;             /* borrowed; converts the colors of a TIFF or JPEG, whose bits
                                   * must be those of the inks; the file carries the output profile.
                                   * NULL: sRGB */
} ImagePacking;

/* A channel of an OpenEXR file. */
typedef struct ImageChannel {
    const char *name;
    bool is_exact; /* has 32 bits even if others are half */
} ImageChannel;

/* The form of an image that is written or read. */
typedef struct ImageForm {
    int width, height;
    int channels;            /* 1 or 3; 4 in PNG and TIFF, where the last is alpha, with straight
                              * colors; if `named` is set, the number of its elements */
    int bits;                /* 8 or 16: codes; 32: floats */
    Encoding encoding;       /* encoding of codes */
    const ImageNotes *notes; /* borrowed; may be NULL when an image is written */
    ImagePacking packing;
    const ImageChannel *named; /* borrowed; NULL: R G B, or Y */
} ImageForm;

/* An image that is written a few rows at a time from the top down, in any format. The file gets its
 * final name only in imagewriter_commit. */
typedef struct ImageWriter ImageWriter;

/* Opens a file for an image.
 *
 * Floats go to .exr or to PFM ("PF" 3 channels, "Pf" 1), which is little-endian with its rows from
 * the bottom up. Codes go by extension to .ppm (P6; a grey picture is written with three equal
 * channels), .pgm (P5, 1 channel), .png, .tif or .tiff (strips; BigTIFF above 4 GB), .jpg or .jpeg
 * (8 bits, lossy, at most 65500 pixels a side). "-" writes a PPM to standard output. A PNG contains
 * an sRGB chunk if `encoding` is sRGB, or gAMA 1.0 if it is linear, and no tIME. A color TIFF or
 * JPEG contains an ICC profile.
 *
 * out      is owned. Follow with exactly one of imagewriter_commit and imagewriter_discard, which
 *          free the writer, also on failure.
 * Errors   STATUS_USAGE for another extension, for channels or bits that the format cannot store,
 *          and for inks with an unsuitable number of channels; STATUS_IO, also if the disk is too
 *          full for the smallest possible file; STATUS_MEMORY. */
MUST_CHECK Status imagewriter_open(ImageWriter **out, const char *path, const ImageForm *form,
                                   Err *err);
/* Write the next rows, which have the form's width, channels and bits. The output must be seekable
 * for TIFF and OpenEXR, and for PFM unless all rows are written in one call. Errors: STATUS_IO,
 * naming the file; STATUS_MEMORY. After an error only imagewriter_discard may follow. */
MUST_CHECK Status imagewriter_codes(ImageWriter *writer, const Picture *rows, Err *err);
MUST_CHECK Status imagewriter_floats(ImageWriter *writer, const Plane *rows, Err *err);
/* Completes the file and gives it its final name. All rows must have been written. Errors:
 * STATUS_IO, STATUS_MEMORY; the file is then removed. */
MUST_CHECK Status imagewriter_commit(ImageWriter *writer, Err *err);
/* Removes the incomplete file. NULL is allowed. */
void imagewriter_discard(ImageWriter *writer);

/* Write a whole image in the format that imagewriter_open chooses. `notes` may be NULL. A `packing`
 * of NULL means the defaults. A plane must have 1 or 3 channels. Errors: those of
 * imagewriter_open. */
MUST_CHECK Status picture_write(const Picture *picture, const char *path, Encoding encoding,
                                const ImageNotes *notes, const ImagePacking *packing, Err *err);
MUST_CHECK Status plane_write(const Plane *plane, const char *path, const ImagePacking *packing,
                              Err *err);
/* Appends the bytes of the PNG file that picture_write would write to `out`. */
MUST_CHECK Status picture_to_png(const Picture *picture, Encoding encoding, const ImageNotes *notes,
                                 Text *out, Err *err);
/* Appends the picture, whose codes are sRGB, as a data URI: "data:image/png;base64,...". */
MUST_CHECK Status picture_put_uri(const Picture *picture, Text *out, Err *err);

/* The properties that files of a format can have. */
typedef struct ImageTraits {
    bool keeps_dpi;   /* ImageNotes.dpi */
    bool has_profile; /* stores an ICC profile, so that the colors may be inks */
    bool keeps_alpha; /* stores an alpha channel */
    bool floats;      /* stores floats and cannot store codes */
} ImageTraits;

/* Returns the properties of the format that the extension of a file name selects; all false for an
 * unknown extension. */
ImageTraits image_traits(const char *path);

/* ---- reading --------------------------------------------------------------------------------- */

/* A PNG or TIFF that is read a few rows at a time, from the top down, so that only these rows are
 * in memory. */
typedef struct ImageReader ImageReader;

/* Opens a file of a form that imagewriter_open writes: a PNG, or a TIFF of a single page, with 1, 3
 * or 4 interleaved channels of 8 or 16 bits, upright. *out is set on success only; close it with
 * imagereader_close. Errors: STATUS_INPUT, naming the file, if it is missing, broken or of another
 * form; STATUS_MEMORY. */
MUST_CHECK Status imagereader_open(ImageReader **out, const char *path, Err *err);
/* Returns the form that the file states, with its notes and resolution; borrowed. The note
 * "Comment" of a TIFF is its ImageDescription. */
const ImageForm *imagereader_form(const ImageReader *reader);
/* Returns the text of a note; NULL if there is none; borrowed. */
const char *imagereader_note(const ImageReader *reader, const char *key);
/* Reads the next rows->height rows into a picture of the file's width, channels and bits. With the
 * last row the rest of the file is read. Errors: STATUS_INPUT if the file is broken;
 * STATUS_MEMORY. */
MUST_CHECK Status imagereader_codes(ImageReader *reader, Picture *rows, Err *err);
void imagereader_close(ImageReader *reader); /* NULL is allowed */

/* The content of a file: integer codes, or linear floats. */
typedef struct Image {
    Picture picture;     /* has no codes if the file holds floats */
    Plane plane;         /* has no values if the file holds codes */
    Picture transparent; /* the picture before image_composite; has no codes if it was opaque */
    const char *lossy;   /* the compression that changed the codes: "JPEG", "WebP"; NULL: none */
} Image;

void image_release(Image *image);

/* The treatment of an alpha channel. A channel that is opaque in every pixel is always removed. */
typedef enum ImageAlpha {
    ALPHA_REFUSED, /* STATUS_INPUT */
    ALPHA_KEPT,    /* alpha is the last channel; pictures get 4 channels and straight colors; planes
                    * get 2 or 4 channels and colors premultiplied by alpha */
    ALPHA_IS_MASK  /* codes of a picture become 255 where alpha is at least 0.5, and 0 elsewhere; a
                    * plane is refused */
} ImageAlpha;

/* Reads a file, whose format is recognised by its first bytes. "-" is standard input.
 *
 * docs/FORMATS.md, section Pictures, lists the forms of each format that are read. PNM, PNG, JPEG,
 * WebP and TIFF of integers give codes of 8 or 16 bits. PFM, OpenEXR and TIFF of floats give
 * floats, which may be infinite or NaN. If the maximum code of a file is below 255, codes are
 * rescaled to 8 bits; if it is between 255 and 65535, to 16 bits.
 *
 * layer    of an OpenEXR file: the name of a part, or of a layer ("layer.R", "layer.G", ...) in the
 *          first part that has it. NULL: the channels without a layer of a file with one part.
 * Errors   STATUS_INPUT with a sentence that names the file and the property that cannot be read,
 *          such as a color space other than sRGB (profiles, primaries), animations, several pages
 *          or an unknown layer, or that states what is truncated or corrupt. STATUS_MEMORY. */
MUST_CHECK Status image_read(Image *image, const char *path, ImageAlpha alpha, const char *layer,
                             Err *err);
/* Copies a text attribute of an OpenEXR file to `text`, which has room for `size` bytes. Returns
 * false if the file cannot be read, is no OpenEXR, or has no such attribute of less than `size`
 * bytes. */
bool image_exr_text(const char *path, const char *name, char *text, size_t size);
/* Read a file that must hold codes (picture_read) or floats (plane_read), as image_read does.
 * Errors: also STATUS_INPUT if the file holds the other kind. */
MUST_CHECK Status picture_read(Picture *picture, const char *path, ImageAlpha alpha, Err *err);
MUST_CHECK Status plane_read(Plane *plane, const char *path, ImageAlpha alpha, Err *err);
/* Decodes a file in memory as image_read reads a file. `name` is the file's name in errors.
 * Errors: those of image_read, except those of opening a file. */
MUST_CHECK Status image_decode(Image *image, const char *name, const void *bytes, size_t size,
                               ImageAlpha alpha, Err *err);

/* Composites an image with alpha over a background in linear light. `background` is linear red,
 * green and blue, from 0 to 1. The result has 3 channels. Its codes are linear if they were linear,
 * else sRGB. A picture with alpha moves to image->transparent; a plane with alpha is
 * released. Does nothing if the image has no
 * alpha. Errors: STATUS_MEMORY; *image is then unchanged. */
MUST_CHECK Status image_composite(Image *image, const float background[3], Err *err);

/* The images that a renderer computes for one view, or that are read from the files of another
 * renderer. Planes that were not requested have NULL values. Release with frame_release. */
typedef struct Frame {
    Plane color;   /* linear; multiplied by alpha if there is an alpha plane */
    Plane alpha;   /* per pixel: the covered fraction, 0 to 1; only of transparent views */
    Picture codes; /* 8-bit sRGB codes instead of `color`, if the caller allowed them and the
                    * renderer chose them */
    Plane depth;   /* mm */
    Plane normal;  /* unit, world, towards the viewer */
    IdPlane id;
} Frame;

void frame_release(Frame *frame);

/* ---- facts ----------------------------------------------------------------------------------- */

enum { IMAGE_PROFILE_NAME = 80 };

/* The properties that a file states. */
typedef struct ImageFacts {
    const char *format; /* "png", "tif" or "jpg"; or "pdf", "eps", "svg", "exr", "ppm", "pgm", "pfm"
                         * or "psd": for these, all members except format and bytes are 0 or NULL */
    size_t bytes;
    int width, height, bits, pages;
    double dpi; /* horizontal; 0: not stated */
    bool has_alpha;
    const char *colors;               /* "rgb", "grey", "cmyk", "another" */
    const char *compression;          /* "lzw", "deflate", "none", "jpeg", "packbits", "another" */
    char profile[IMAGE_PROFILE_NAME]; /* name of the ICC profile; "": none */
    double ink_percent;               /* of "cmyk": maximum total of the four inks of a pixel, 0 to
                                       * 400; of a JPEG: maximum of the mean over a block of 8 x 8
                                       * pixels, because JPEG rounds single pixels; 0 for a TIFF in
                                       * tiles or with one plane per ink */
} ImageFacts;

/* Finds the properties of a file. Reads no pixels, except those of CMYK for ink_percent. Errors:
 * STATUS_INPUT, naming the file, if it is of none of these formats or its header is broken;
 * STATUS_MEMORY. */
MUST_CHECK Status image_facts(const char *path, ImageFacts *out, Err *err);

/* Appends the names and versions of the libraries that read and write images. */
void image_put_libraries(Text *text);

#endif
