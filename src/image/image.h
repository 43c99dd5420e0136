/* The door of the room image: linear float planes, integer pictures, segment-id planes, the
 * encoding between them, and their files.
 *
 * All hold rows from the top down, pixels from left to right, channels interleaved. Pictures hold
 * integer codes as a file does; planes hold linear numbers. The only colour encoding step of the
 * program is picture_from_plane. */
#ifndef CORCAST_IMAGE_IMAGE_H
#define CORCAST_IMAGE_IMAGE_H

#include "base/base.h"
#include "image/colormap.h"   // IWYU pragma: export
#include "image/colorscale.h" // IWYU pragma: export
#include <stdint.h>
#include <string.h>

enum { IMAGE_MAX_SIDE = 1 << 20, IMAGE_MAX_CHANNELS = 9, IMAGE_MAX_ID = 0xffffff };

/* A rectangle of pixels; `left` and `top` count from 0. */
typedef struct PixelRect {
    int left, top, width, height;
} PixelRect;

/* Linear floats: colour (3 channels, 0 black to 1 white), depth (1, mm, INFINITY where nothing is
 * seen), normal (3, unit vector, 0 0 0 where nothing is seen), or several of them for one file. */
typedef struct Plane {
    int width, height, channels;
    float *values; /* owned; width * height * channels */
} Plane;

/* Integer codes of 8 or 16 bits, each kept in as many. */
typedef struct Picture {
    int width, height, channels; /* channels 1 (grey), 3 (red green blue) or, to be written,
                                  * 4: with alpha */
    int bits;                    /* 8 or 16 */
    double gamma;                /* 0: sRGB's codes; else code / largest code = linear^gamma */
    uint8_t *codes8;             /* owned; width * height * channels of 8 bits, else NULL */
    uint16_t *codes16;           /* owned; width * height * channels of 16 bits, else NULL */
} Picture;

/* A number a pixel: the SWC id of the segment seen, 0 where nothing is seen. Files hold ids up to
 * IMAGE_MAX_ID. */
typedef struct IdPlane {
    int width, height;
    uint32_t *ids; /* owned */
} IdPlane;

/* Zeroed. STATUS_INPUT unless both sides are in [1, IMAGE_MAX_SIDE]; STATUS_MEMORY when the machine
 * has no room for it, said before any of it is touched. */
MUST_CHECK Status plane_init(Plane *plane, int width, int height, int channels, Err *err);
MUST_CHECK Status picture_init(Picture *picture, int width, int height, int channels, int bits,
                               Err *err);
MUST_CHECK Status idplane_init(IdPlane *ids, int width, int height, Err *err);
/* As plane_init, but what the plane holds is not set: for one whose values are all about to be. */
MUST_CHECK Status plane_init_unset(Plane *plane, int width, int height, int channels, Err *err);
void plane_release(Plane *plane);
void picture_release(Picture *picture);
void idplane_release(IdPlane *ids);

/* Code number `i` in the order of the file. */
static inline uint16_t picture_code(const Picture *picture, size_t i)
{
    return picture->bits == 8 ? picture->codes8[i] : picture->codes16[i];
}

static inline void picture_set(Picture *picture, size_t i, uint16_t code)
{
    if (picture->bits == 8)
        picture->codes8[i] = (uint8_t)code;
    else
        picture->codes16[i] = code;
}

/* How many codes a row has. */
static inline size_t picture_stride(const Picture *picture)
{
    return (size_t)picture->width * (size_t)picture->channels;
}

/* The codes of row `y` as 16-bit numbers: borrowed from the picture, or in `scratch`, which has
 * room for them. */
const uint16_t *picture_row(const Picture *picture, int y, uint16_t *scratch);
/* Whether row `y` is the same in two pictures of one shape, from pixel `x` on for `n` pixels. */
bool picture_rows_equal(const Picture *a, const Picture *b, int y, int x, int n);

/* sRGB transfer curve (IEC 61966-2-1), linear to encoded and back, in float as POV-Ray does. */
float srgb_encode(float linear);
float srgb_decode(float encoded);

typedef enum Encoding { ENCODING_SRGB, ENCODING_LINEAR } Encoding;

/* floor(clip(encode(v), 0, 1) * maximum + 1/2), in float: POV-Ray's rounding (base/image/
 * encoding.h of 3.7.0.10), so that equal floats give equal codes. NaN becomes 0. `bits` is 8 or
 * 16. */
uint16_t image_code(float linear, Encoding encoding, int bits);

/* Table for image_code(., ENCODING_SRGB, 8) of many values: the floats from 2^-13 to 1 in cells of
 * 1/128 of an octave, in none of which the code rises twice. Added to the place in its cell, a
 * cell's entry has the code in its third byte. */
enum {
    SRGB_CELL_BITS = 16,
    SRGB_CELL = 1 << SRGB_CELL_BITS, /* floats in a cell */
    SRGB_CELLS_BEGIN = 0x39000000,   /* the bits of 2^-13 */
    SRGB_CELLS = (0x3f800000 - SRGB_CELLS_BEGIN) / SRGB_CELL
};
#define SRGB_LEAST 0x1p-13f      /* has code 0 */
#define SRGB_MOST 0x1.fffffep-1f /* the float before 1; has code 255 */

typedef struct SrgbCodes {
    uint32_t cells[SRGB_CELLS];
} SrgbCodes;

void srgb_codes_init(SrgbCodes *codes);
/* The code that image_code gives. */
static inline uint8_t srgb_code(const SrgbCodes *codes, float linear)
{
    float value = linear > SRGB_LEAST ? linear : SRGB_LEAST;
    value = value < SRGB_MOST ? value : SRGB_MOST;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits -= SRGB_CELLS_BEGIN;
    return (uint8_t)((codes->cells[bits / SRGB_CELL] + bits % SRGB_CELL) / SRGB_CELL);
}

/* New picture of a colour plane (1 or 3 channels), its gamma 0 or 1. */
MUST_CHECK Status picture_from_plane(Picture *picture, const Plane *plane, Encoding encoding,
                                     int bits, Err *err);
/* New picture of 4 channels: the colours of a plane that is multiplied by `alpha`, without that,
 * and alpha, linear. Where alpha is 0 all four are 0. */
MUST_CHECK Status picture_from_transparent(Picture *picture, const Plane *plane, const Plane *alpha,
                                           Encoding encoding, int bits, Err *err);
/* The linear colours of a picture, as its gamma says. */
MUST_CHECK Status plane_from_picture(Plane *plane, const Picture *picture, Err *err);
/* The same colours in sRGB's codes, and the same alpha. */
MUST_CHECK Status picture_to_srgb(Picture *srgb, const Picture *picture, int bits, Err *err);
/* Makes codes of 8 bits codes of 16, of the same brightness. */
MUST_CHECK Status picture_widen(Picture *picture, Err *err);
/* Id planes, of ids up to IMAGE_MAX_ID, as 8-bit pictures: red * 65536 + green * 256 + blue. */
MUST_CHECK Status picture_from_ids(Picture *picture, const IdPlane *ids, Err *err);
/* Leaves the picture empty: its memory becomes the ids'. STATUS_INPUT unless it has 3 channels of 8
 * bits; it is unchanged then. */
MUST_CHECK Status ids_take_picture(IdPlane *ids, Picture *picture, Err *err);

/* Provenance: in a PNG as tEXt chunks, or iTXt chunks where it is not ASCII, in a TIFF as Software,
 * PageName for "Shard", and ImageDescription for the others, a line each, in a JPEG as comments, in
 * OpenEXR as attributes; PNM and PFM hold none. Never a date or a path. */
typedef struct ImageNote {
    const char *key;  /* "Software", "Comment", "Colors", "Shard"; at most 79 characters */
    const char *text; /* UTF-8 */
} ImageNote;

typedef struct ImageNotes {
    const ImageNote *notes; /* borrowed */
    int count;
    double dpi; /* pixels an inch: pHYs of a PNG, XResolution and YResolution of a TIFF, the density
                 * of a JPEG, xDensity of OpenEXR; 0: not written */
} ImageNotes;

/* What becomes of colours that a press cannot print: all are moved, so that none fall together, or
 * they alone, to the nearest that it can. */
typedef enum InkIntent { INKS_PERCEPTUAL, INKS_RELATIVE } InkIntent;

/* The way from sRGB to the cyan, magenta, yellow and black of a press. */
typedef struct Inks Inks;

/* Reads the press's ICC profile, for codes of 8 or 16 `bits`. STATUS_INPUT with a sentence naming
 * the file when it is missing, broken or no profile of a press of four inks. Some 50 ms. */
MUST_CHECK Status inks_read(Inks **out, const char *path, InkIntent intent, int bits, Err *err);
void inks_free(Inks *inks); /* NULL is allowed */

typedef enum ImageCompression { IMAGE_LZW, IMAGE_DEFLATE, IMAGE_UNCOMPRESSED } ImageCompression;

/* Where a format leaves a choice; zeros are the usual one. */
typedef struct ImagePacking {
    ImageCompression compression; /* of a TIFF; none loses anything */
    int threads;                  /* that compress a PNG, whose bytes do not depend on them; 0: all
                                   * processors */
    int quality;                  /* of a JPEG, from 1 to 100; 0: 95 */
    bool half;                    /* OpenEXR: channels of 16 bits, but the exact ones */
    const Inks *inks; /* borrowed; TIFF and JPEG in colours of a press, its profile in the file;
                       * of as many bits as the form. NULL: sRGB */
} ImagePacking;

/* A channel of an OpenEXR file. */
typedef struct ImageChannel {
    const char *name;
    bool is_exact; /* of 32 bits, also where others are half */
} ImageChannel;

/* What is to be written. */
typedef struct ImageForm {
    int width, height;
    int channels;            /* 1, 3 or, of PNG and TIFF, 4: with alpha, not multiplied; of an
                              * OpenEXR file with `named` as many as that has */
    int bits;                /* 8 or 16: codes; 32: floats */
    Encoding encoding;       /* of codes */
    const ImageNotes *notes; /* borrowed; may be NULL */
    ImagePacking packing;
    const ImageChannel *named; /* borrowed; NULL: R G B, or Y */
} ImageForm;

/* An image being written a few rows at a time from the top down, whatever order its file has. It
 * has its final name only after imagewriter_commit. */
typedef struct ImageWriter ImageWriter;

/* Floats go to .exr or PFM ("PF" 3 channels, "Pf" 1), little-endian, rows bottom-up in the file.
 * Codes go by extension: .ppm (P6; a grey picture with its channel three times), .pgm (P5, 1
 * channel), .png, .tif or .tiff (strips; BigTIFF above 4 GB), .jpg or .jpeg (8 bits, which loses a
 * little; 65500 pixels a side); "-" is standard output and a PPM. PNG carries an sRGB chunk when
 * `encoding` is sRGB and gAMA 1.0 when it is linear, and no tIME; colours of TIFF and JPEG carry
 * their ICC profile. STATUS_USAGE on another extension, on what the format cannot hold, and on inks
 * for a picture of other than 3 channels; STATUS_IO when the disk has no room for what is certain
 * to be written. Follow with exactly one of imagewriter_commit and imagewriter_discard, each of
 * which frees the writer, also on failure. */
MUST_CHECK Status imagewriter_open(ImageWriter **out, const char *path, const ImageForm *form,
                                   Err *err);
/* The next rows, all of the form's width, channels and bits. PFM and TIFF in parts need a file, not
 * a pipe. */
MUST_CHECK Status imagewriter_codes(ImageWriter *writer, const Picture *rows, Err *err);
MUST_CHECK Status imagewriter_floats(ImageWriter *writer, const Plane *rows, Err *err);
MUST_CHECK Status imagewriter_commit(ImageWriter *writer, Err *err);
void imagewriter_discard(ImageWriter *writer);

/* Writes a whole picture, as imagewriter_open says. `notes` may be NULL. */
MUST_CHECK Status picture_write(const Picture *picture, const char *path, Encoding encoding,
                                const ImageNotes *notes, Err *err);
MUST_CHECK Status picture_write_packed(const Picture *picture, const char *path, Encoding encoding,
                                       const ImageNotes *notes, ImagePacking packing, Err *err);
/* Appends the bytes of the PNG file that picture_write would write to `out`. */
MUST_CHECK Status picture_to_png(const Picture *picture, Encoding encoding, const ImageNotes *notes,
                                 Text *out, Err *err);
/* Whether files of this name keep ImageNotes.dpi; whether colours in them may be inks; whether
 * pictures in them may be transparent; whether they are of floats. */
bool image_keeps_dpi(const char *path);
bool image_keeps_inks(const char *path);
bool image_keeps_alpha(const char *path);
bool image_is_floats(const char *path);

/* A PNG or TIFF being read a few rows at a time, from the top down, so that a picture of any size
 * takes the memory of its rows. */
typedef struct ImageReader ImageReader;

/* STATUS_INPUT, naming the file, when it is missing or no sound PNG or TIFF of the form that
 * imagewriter_open writes: sRGB or linear codes of 8 or 16 bits in 1, 3 or 4 channels, interleaved,
 * not turned, a single page. Close with imagereader_close. */
MUST_CHECK Status imagereader_open(ImageReader **out, const char *path, Err *err);
/* What the file says of itself, its notes and resolution included; borrowed. Of a TIFF's notes,
 * ImageDescription is "Comment". */
const ImageForm *imagereader_form(const ImageReader *reader);
/* The text of a note, NULL when there is none; borrowed. */
const char *imagereader_note(const ImageReader *reader, const char *key);
/* The next rows->height rows into a picture of the file's width, channels and bits; the last of
 * them read all that there is of the file. STATUS_INPUT when it is broken. */
MUST_CHECK Status imagereader_codes(ImageReader *reader, Picture *rows, Err *err);
void imagereader_close(ImageReader *reader);

/* Appends the picture, its codes sRGB's, as the address of an image that a page holds itself:
 * "data:image/png;base64,...". */
MUST_CHECK Status picture_put_uri(const Picture *picture, Text *out, Err *err);
/* What a file holds: integer codes, or linear floats. */
typedef struct Image {
    Picture picture;     /* without codes when the file holds floats */
    Plane plane;         /* without values when it holds codes */
    Picture transparent; /* the picture before image_lay_on; without codes if it was opaque */
    const char *lossy;   /* the compression that changed the codes: "JPEG", "WebP"; else NULL */
} Image;

void image_release(Image *image);

/* Reads a file, whose format is recognised by its first bytes; "-" is standard input.
 *
 * docs/FORMATS.md, section Pictures, lists the forms of each format that are read. PNM, PNG, JPEG,
 * WebP and TIFF of integers give codes of 8 or 16 bits; PFM, OpenEXR and TIFF of floats give
 * floats, infinities and NaN included. A maxval other than 255 and 65535 is rescaled, to 8 bits
 * below 255 and to 16 above.
 *
 * Errors   STATUS_INPUT with a sentence that names the file and the property that cannot be read,
 * such as an alpha channel that is not opaque throughout, colours of another space than sRGB
 *          (profiles, primaries), animations and several pages, or that says what is truncated or
 *          corrupt. STATUS_MEMORY. */
MUST_CHECK Status image_read(Image *image, const char *path, Err *err);
/* As image_read, but a picture or plane that is transparent anywhere keeps its alpha as the last
 * channel: pictures have 4 then, their colours not multiplied by it, planes 2 or 4, whose colours
 * are. */
MUST_CHECK Status image_read_transparent(Image *image, const char *path, Err *err);
/* As image_read, or image_read_transparent; of an OpenEXR file the part with the name `layer`, or
 * the channels of that layer ("layer.R", "layer.G", ...) of the first part that has some. NULL: of
 * a file with a single part, the channels of no layer. STATUS_INPUT, naming the parts, when there
 * is no such layer. */
MUST_CHECK Status image_read_layer(Image *image, const char *path, const char *layer,
                                   bool transparent, Err *err);
/* As image_read_transparent, and STATUS_INPUT when the file holds floats. */
MUST_CHECK Status picture_read_transparent(Picture *picture, const char *path, Err *err);
/* Likewise, and STATUS_INPUT when the file holds codes. */
MUST_CHECK Status plane_read_transparent(Plane *plane, const char *path, Err *err);
/* Lays an image with alpha on a background, red, green and blue from 0 to 1, in linear light. The
 * result has 3 channels, its codes sRGB's unless they are linear; a picture with alpha moves to
 * image->transparent. STATUS_MEMORY; *image is unchanged then. */
MUST_CHECK Status image_lay_on(Image *image, const float background[3], Err *err);
/* Likewise, and STATUS_INPUT when the file does not hold codes, or floats. */
MUST_CHECK Status picture_read(Picture *picture, const char *path, Err *err);
/* As picture_read; but of a picture that is transparent anywhere only the opacity counts: the codes
 * of a pixel are not 0 where it is at least half opaque, and 0 elsewhere. */
MUST_CHECK Status picture_read_mask(Picture *picture, const char *path, Err *err);
MUST_CHECK Status plane_read(Plane *plane, const char *path, Err *err);

/* Writes a whole plane of 1 or 3 channels as .exr or else PFM; "-" is standard output. */
MUST_CHECK Status plane_write(const Plane *plane, const char *path, Err *err);
MUST_CHECK Status plane_write_packed(const Plane *plane, const char *path, ImagePacking packing,
                                     Err *err);
/* What a renderer delivers, or what is read back from another's files. Planes that were not asked
 * for have NULL values. */
typedef struct Frame {
    Plane color;   /* linear; where there is an alpha plane, times alpha */
    Plane alpha;   /* part of the pixel that is covered, 0 to 1; of transparent views */
    Picture codes; /* 8-bit sRGB codes in its place, if they suffice and the renderer chose so */
    Plane depth;   /* mm */
    Plane normal;  /* unit, world, towards the viewer */
    IdPlane id;
} Frame;

void frame_release(Frame *frame);

enum { IMAGE_PROFILE_NAME = 80 };

/* What a file says of itself. */
typedef struct ImageFacts {
    const char *format; /* "png", "tif", "jpg"; of these alone the rest but `bytes` is known, of
                         * "pdf", "eps", "svg", "exr", "ppm", "pgm", "pfm" and "psd" it is 0 */
    size_t bytes;
    int width, height, bits, pages;
    double dpi; /* across; 0: not said */
    bool has_alpha;
    const char *colors;               /* "rgb", "grey", "cmyk", "another" */
    const char *compression;          /* "lzw", "deflate", "none", "jpeg", "packbits", "another" */
    char profile[IMAGE_PROFILE_NAME]; /* its name; "": none */
} ImageFacts;

/* The format is recognised by the first bytes; pixels are not read. STATUS_INPUT naming the file
 * when it is of no such format or its header is broken. */
MUST_CHECK Status image_facts(const char *path, ImageFacts *out, Err *err);

/* Appends the names and versions of the libraries that read and write images. */
void image_put_libraries(Text *text);

#endif
