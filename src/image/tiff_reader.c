/* Reads TIFF with libtiff, in two ways.
 *
 * decode() reads a whole file from memory: a single page in strips or tiles, with interleaved
 * samples or separate planes, in any compression that libtiff supports. Grey codes and palettes of
 * 1, 2 and 4 bits become 8-bit codes. Floats of 16 and 64 bits become 32-bit floats. The tag
 * Orientation is applied while pixels are copied: the index of a pixel in the image is a linear
 * function of its column and row in the file.
 *
 * begin(), rows() and end() read a file row by row from a stream, if its rows need no conversion
 * [has_plain_rows]. They are meant for files that this program wrote: sRGB, with a resolution per
 * inch, and compressed with LZW or deflate or not at all. They do not check these properties.
 *
 * A chunk is what one call of libtiff reads: a row or a tile. */
#define IMATH_HALF_NO_LOOKUP_TABLE /* the table is in a separate library */
#include "image/tiff_stream.h"

#include <Imath/half.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

enum { MAX_NOTES = 3 }; /* number of fields that read_notes reads */

typedef struct TiffReader {
    ImageInput input;
    TiffStream tiff;
    uint32_t width, height; /* in the file */
    int samples, bits;      /* samples per pixel; bits per sample; in the file */
    int planes;             /* 1: samples are interleaved; else the number of samples */
    int channels;           /* of the image */
    bool floats, min_is_white;
    const uint16_t *palette[3];   /* borrowed; NULL: none. Red, green, blue of 2^bits codes */
    int palette_shift;            /* right shift that converts the palette's entries to 8 bits */
    bool swapped;                 /* rows of the file are columns of the image */
    int64_t origin, across, down; /* index in the image of the file's column 0, row 0; index steps
                                   * to the file's next column and row */
    uint32_t chunk_width, chunk_height; /* pixels of a tile, or of a row */
    size_t chunk_bytes;
    void *chunk; /* owned */
    ImageNotes notes;
    ImageNote note[MAX_NOTES]; /* the texts belong to libtiff */
    uint32_t next;             /* index of the next row */
} TiffReader;

static bool tiff_is(const ImageBytes *file)
{
    return file->size >= 4 &&
           (memcmp(file->bytes, "II*\0", 4) == 0 || memcmp(file->bytes, "MM\0*", 4) == 0 ||
            memcmp(file->bytes, "II+\0", 4) == 0 || memcmp(file->bytes, "MM\0+", 4) == 0);
}

/* Sets origin, across and down. Orientations from 5 on swap rows and columns. `mirrored`: the
 * columns of the file run against the axis of the image that they are on; `flipped`: its rows do.
 */
static void set_orientation(TiffReader *self, int orientation)
{
    bool mirrored = orientation == ORIENTATION_TOPRIGHT || orientation == ORIENTATION_BOTRIGHT ||
                    orientation == ORIENTATION_RIGHTBOT || orientation == ORIENTATION_LEFTBOT;
    bool flipped = orientation == ORIENTATION_BOTRIGHT || orientation == ORIENTATION_BOTLEFT ||
                   orientation == ORIENTATION_RIGHTTOP || orientation == ORIENTATION_RIGHTBOT;
    self->swapped = orientation >= ORIENTATION_LEFTTOP;
    self->across = self->swapped ? self->height : 1;
    self->down = self->swapped ? 1 : self->width;
    self->origin = 0;
    if (mirrored) {
        self->origin += self->across * (self->width - 1);
        self->across = -self->across;
    }
    if (flipped) {
        self->origin += self->down * (self->height - 1);
        self->down = -self->down;
    }
}

/* Returns the error for a property of a file that cannot be read. */
static Status refuse(const TiffReader *self, const char *what, Err *err)
{
    return err_set(err, STATUS_INPUT,
                   "%s: has %s, which cannot be read; gray, RGB and palettes of 1, 2, 4, 8 or 16 "
                   "bits can, and gray and RGB floats of 16, 32 or 64 bits",
                   self->input.file.name, what);
}

static const char *photometric_name(uint16_t photometric)
{
    static const struct {
        uint16_t photometric;
        const char *name;
    } names[] = {{PHOTOMETRIC_MASK, "a mask for a picture"},
                 {PHOTOMETRIC_SEPARATED, "CMYK colors"},
                 {PHOTOMETRIC_YCBCR, "YCbCr colors without JPEG compression"},
                 {PHOTOMETRIC_CIELAB, "CIELAB colors"},
                 {PHOTOMETRIC_ICCLAB, "ICCLAB colors"},
                 {PHOTOMETRIC_ITULAB, "ITULAB colors"},
                 {PHOTOMETRIC_CFA, "the raw colors of a camera (CFA)"},
                 {PHOTOMETRIC_LOGL, "LogL light"},
                 {PHOTOMETRIC_LOGLUV, "LogLuv colors"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i].photometric == photometric)
            return names[i].name;
    return "colors of an unknown kind (PhotometricInterpretation)";
}

static Status check_samples(TiffReader *self, uint16_t format, Err *err)
{
    static const char *const types[] = {[SAMPLEFORMAT_INT] = "signed integers",
                                        [SAMPLEFORMAT_VOID] = "samples of no known type",
                                        [SAMPLEFORMAT_COMPLEXINT] = "complex integers",
                                        [SAMPLEFORMAT_COMPLEXIEEEFP] = "complex floats"};
    const int bits = self->bits;
    char what[64];
    if (format < sizeof types / sizeof *types && types[format])
        return refuse(self, types[format], err);
    self->floats = format == SAMPLEFORMAT_IEEEFP;
    if (self->floats && bits != 16 && bits != 32 && bits != 64)
        snprintf(what, sizeof what, "floats of %d bits", bits);
    else if (!self->floats && bits != 1 && bits != 2 && bits != 4 && bits != 8 && bits != 16)
        snprintf(what, sizeof what, "integers of %d bits", bits);
    else
        return STATUS_OK;
    return refuse(self, what, err);
}

/* Borrows the palette. Its entries have 16 bits. Some old programs write entries of 8 bits instead;
 * 8 bits are assumed if no entry is above 255. */
static Status read_palette(TiffReader *self, Err *err)
{
    uint16_t *red, *green, *blue;
    if (!TIFFGetField(self->tiff.handle, TIFFTAG_COLORMAP, &red, &green, &blue) || self->bits > 8)
        return refuse(self, "a palette of more than 8 bits, or none", err);
    self->palette[0] = red;
    self->palette[1] = green;
    self->palette[2] = blue;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 1 << self->bits; i++)
            if (self->palette[c][i] > 255)
                self->palette_shift = 8;
    return STATUS_OK;
}

/* Checks the kind of colors and the number of samples per pixel. Only grey and RGB have alpha.
 * libtiff converts YCbCr colors of JPEG to RGB. */
static Status check_colors_of_samples(TiffReader *self, uint16_t photometric, Err *err)
{
    const int samples = self->samples;
    uint16_t compression;
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_COMPRESSION, &compression);
    if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG &&
        TIFFSetField(self->tiff.handle, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB))
        photometric = PHOTOMETRIC_RGB;
    if (compression == COMPRESSION_JPEG)
        self->input.image.lossy = "JPEG";
    bool grey = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
    bool is_palette = photometric == PHOTOMETRIC_PALETTE;
    self->min_is_white = photometric == PHOTOMETRIC_MINISWHITE;
    self->channels = is_palette ? 3 : samples;
    if (!grey && !is_palette && photometric != PHOTOMETRIC_RGB)
        return refuse(self, photometric_name(photometric), err);
    if ((self->min_is_white || is_palette) && (samples != 1 || self->floats))
        return refuse(self,
                      is_palette ? "a palette with alpha or of floats"
                                 : "white as the lowest value with alpha or of floats",
                      err);
    if (samples == (grey || is_palette ? 1 : 3) || samples == (grey ? 2 : 4))
        return is_palette ? read_palette(self, err) : STATUS_OK;
    char what[64];
    snprintf(what, sizeof what, "%d samples per pixel", samples);
    return refuse(self, what, err);
}

/* Checks the kind of samples and colors. A file that does not state its colors is grey. */
static Status check_form(TiffReader *self, Err *err)
{
    uint16_t samples, bits, format, planar, photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(self->tiff.handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_PLANARCONFIG, &planar);
    self->samples = samples;
    self->bits = bits;
    self->planes = planar == PLANARCONFIG_CONTIG ? 1 : samples;
    TRY(check_samples(self, format, err));
    return check_colors_of_samples(self, photometric, err);
}

/* Returns the number of bits per sample of the decoded image: 8, 16, or 32 for floats. */
static int image_bits(const TiffReader *self)
{
    return self->floats ? 32 : self->bits <= 8 ? 8 : 16;
}

/* Returns an upper bound on the number of bytes of pixels that a file of this size can hold. LZW
 * compresses a blank picture by a factor of 1400, deflate by 1032, PackBits by 64 and ZSTD by
 * 32768. The two ratios are at least three times the highest of their kind. WebP and LERC take a
 * few bytes for a blank strip of any size, so one strip of BLANK_STRIP bytes is added. BLANK_STRIP
 * is a strip of 4096 x 4096 pixels of 4 bytes. A larger value lets a tiny file make the program
 * allocate more; a smaller value refuses more blank pictures. */
static size_t max_bytes(const TiffReader *self)
{
    enum { COMMON_RATIO = 10000, RATIO = 100000, BLANK_STRIP = 64 << 20 };
    uint16_t compression;
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_COMPRESSION, &compression);
    bool common = compression == COMPRESSION_NONE || compression == COMPRESSION_LZW ||
                  compression == COMPRESSION_PACKBITS || compression == COMPRESSION_DEFLATE ||
                  compression == COMPRESSION_ADOBE_DEFLATE;
    size_t samples_per_byte = self->bits < 8 ? 8 / (size_t)self->bits : 1;
    return common ? self->input.file.size * COMMON_RATIO * samples_per_byte
                  : self->input.file.size * RATIO * samples_per_byte + BLANK_STRIP;
}

/* Checks that the file is large enough for `width` x `height` pixels of the image, or of a tile. */
static Status check_claim(const TiffReader *self, uint32_t width, uint32_t height, Err *err)
{
    size_t pixel = (size_t)self->channels * (size_t)(image_bits(self) / 8);
    return image_check_stated_size(&self->input.file, width, height, pixel * width * height,
                                   max_bytes(self), err);
}

/* Sets the size of a chunk, and allocates it. Refuses a file for which libtiff computes another
 * size, because copy_row relies on this layout. */
static Status set_chunks(TiffReader *self, Err *err)
{
    self->chunk_width = self->width;
    self->chunk_height = 1;
    bool tiled = TIFFIsTiled(self->tiff.handle);
    if (tiled) {
        TIFFGetField(self->tiff.handle, TIFFTAG_TILEWIDTH, &self->chunk_width);
        TIFFGetField(self->tiff.handle, TIFFTAG_TILELENGTH, &self->chunk_height);
        TRY(check_claim(self, self->chunk_width, self->chunk_height, err));
    }
    const size_t row_samples = (size_t)self->chunk_width * (size_t)(self->samples / self->planes);
    self->chunk_bytes = (row_samples * (size_t)self->bits + 7) / 8 * self->chunk_height;
    TRY(image_check_memory((int)self->chunk_width, (int)self->chunk_height, self->chunk_bytes,
                           err));
    if ((size_t)(tiled ? TIFFTileSize(self->tiff.handle) : TIFFScanlineSize(self->tiff.handle)) !=
        self->chunk_bytes)
        return guard_failure(err);
    return mem_calloc(&self->chunk, self->chunk_bytes, 1, "bytes of a part of a TIFF", err);
}

/* Checks that the colors are sRGB. Chromaticities that the file does not state are assumed to be
 * those of sRGB. */
static Status check_colors(TiffReader *self, Err *err)
{
    double xy[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
    const float *primaries, *white;
    uint32_t size;
    const void *profile;
    if (TIFFGetField(self->tiff.handle, TIFFTAG_PRIMARYCHROMATICITIES, &primaries))
        for (int i = 0; i < 6; i++)
            xy[i] = (double)primaries[i];
    if (TIFFGetField(self->tiff.handle, TIFFTAG_WHITEPOINT, &white))
        for (int i = 0; i < 2; i++)
            xy[6 + i] = (double)white[i];
    if (self->channels >= 3 && !image_is_srgb(xy))
        return image_fail_not_srgb(self->input.file.name, "PrimaryChromaticities or WhitePoint",
                                   err);
    if (!self->floats && TIFFGetField(self->tiff.handle, TIFFTAG_ICCPROFILE, &size, &profile))
        return image_check_profile(self->input.file.name, profile, size, err);
    return STATUS_OK;
}

static void read_sides(TiffReader *self)
{
    TIFFGetField(self->tiff.handle, TIFFTAG_IMAGEWIDTH, &self->width);
    TIFFGetField(self->tiff.handle, TIFFTAG_IMAGELENGTH, &self->height);
}

static Status read_header(TiffReader *self, Err *err)
{
    uint16_t orientation;
    TRY(check_form(self, err));
    read_sides(self);
    TRY(check_claim(self, self->width, self->height, err));
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_ORIENTATION, &orientation);
    set_orientation(self, orientation);
    TRY(check_colors(self, err));
    return set_chunks(self, err);
}

/* Returns sample i of a row of integers of 1, 2, 4, 8 or 16 bits. Samples of fewer than 8 bits are
 * packed; the first sample is in the highest bits of its byte. */
static unsigned integer_at(const uint8_t *row, size_t i, int bits)
{
    if (bits == 8)
        return row[i];
    if (bits == 16)
        return ((const uint16_t *)(const void *)row)[i];
    size_t first = i * (size_t)bits;
    return row[first / 8] >> (8 - (size_t)bits - first % 8) & ((1u << bits) - 1);
}

/* Returns sample i of a row of floats of 16, 32 or 64 bits. */
static float float_at(const uint8_t *row, size_t i, int bits)
{
    double value;
    float single;
    if (bits == 16)
        return imath_half_to_float(((const imath_half_bits_t *)(const void *)row)[i]);
    if (bits == 64) {
        memcpy(&value, row + 8 * i, sizeof value);
        return (float)value;
    }
    memcpy(&single, row + 4 * i, sizeof single);
    return single;
}

/* Sets codes of a pixel: with a palette all three codes of color `value`, otherwise the code of
 * channel `c`. */
static void set_code(const TiffReader *self, unsigned value, size_t pixel, int c, Picture *picture)
{
    const size_t first = pixel * (size_t)self->channels;
    const unsigned max_value = (1u << self->bits) - 1;
    if (self->palette[0]) {
        for (size_t i = 0; i < 3; i++)
            picture_set(picture, first + i,
                        (uint16_t)(self->palette[i][value] >> self->palette_shift));
        return;
    }
    if (self->min_is_white)
        value = max_value - value;
    picture_set(picture, first + (size_t)c,
                (uint16_t)(self->bits < 8 ? value * 255 / max_value : value));
}

/* Copies `n` pixels of row `y` of the file, from column `x` on. `row` holds all samples of these
 * pixels, or only the samples of `plane`. */
static void copy_row(const TiffReader *self, const uint8_t *row, uint32_t x, uint32_t y, uint32_t n,
                     int plane, Image *image)
{
    const int samples = self->samples / self->planes;
    size_t at = 0;
    for (uint32_t i = 0; i < n; i++) {
        size_t pixel = (size_t)(self->origin + (x + i) * self->across + y * self->down);
        for (int c = plane; c < plane + samples; c++, at++)
            if (self->floats)
                image->plane.values[pixel * (size_t)self->channels + (size_t)c] =
                    float_at(row, at, self->bits);
            else
                set_code(self, integer_at(row, at, self->bits), pixel, c, &image->picture);
    }
}

/* Reads the tile, or the row, that begins at column `x`, row `y`. */
static Status read_chunk(TiffReader *self, uint32_t x, uint32_t y, int plane, Image *image,
                         Err *err)
{
    TIFF *handle = self->tiff.handle;
    bool read = TIFFIsTiled(handle)
                    ? TIFFReadTile(handle, self->chunk, x, y, 0, (uint16_t)plane) >= 0
                    : TIFFReadScanline(handle, self->chunk, y, (uint16_t)plane) == 1;
    if (!read)
        return guard_failure(err);
    uint32_t n = self->chunk_width < self->width - x ? self->chunk_width : self->width - x;
    size_t row_bytes = self->chunk_bytes / self->chunk_height;
    for (uint32_t row = 0; row < self->chunk_height && y + row < self->height; row++)
        copy_row(self, (const uint8_t *)self->chunk + row * row_bytes, x, y + row, n, plane, image);
    return STATUS_OK;
}

/* Divides the color codes of a pixel by its alpha, which follows them. */
static void divide_codes(Picture *picture, size_t first, int colors)
{
    uint32_t alpha = picture_code(picture, first + (size_t)colors);
    uint32_t max_code = picture->bits == 8 ? 255 : 65535;
    for (size_t i = first; i < first + (size_t)colors && alpha > 0; i++) {
        uint32_t code = (picture_code(picture, i) * max_code + alpha / 2) / alpha;
        picture_set(picture, i, (uint16_t)(code < max_code ? code : max_code));
    }
}

/* Converts colors to the convention of Image: codes that were multiplied by alpha are divided by
 * it, and floats that were not are multiplied by it. */
static void convert_alpha(const TiffReader *self, Image *image)
{
    uint16_t extra, *kinds;
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    const size_t samples = (size_t)self->samples, n = (size_t)self->width * self->height;
    bool divide = !self->floats && extra == 1 && kinds[0] == EXTRASAMPLE_ASSOCALPHA;
    bool multiply = self->floats && extra == 1 && kinds[0] == EXTRASAMPLE_UNASSALPHA;
    for (size_t i = 0; divide && i < n; i++)
        divide_codes(&image->picture, i * samples, self->samples - 1);
    for (size_t i = 0; multiply && i < n * samples; i++)
        if (i % samples != samples - 1)
            image->plane.values[i] *= image->plane.values[i - i % samples + samples - 1];
}

static Status read_chunks(TiffReader *self, Image *image, Err *err)
{
    for (int plane = 0; plane < self->planes; plane++)
        for (uint32_t y = 0; y < self->height; y += self->chunk_height)
            for (uint32_t x = 0; x < self->width; x += self->chunk_width)
                TRY(read_chunk(self, x, y, plane, image, err));
    if (self->samples == 2 || self->samples == 4)
        convert_alpha(self, image);
    return STATUS_OK;
}

/* Refuses a file of several pages. Thumbnails and masks do not count as pages. */
static Status check_single(TiffReader *self, Err *err)
{
    while (!TIFFLastDirectory(self->tiff.handle)) {
        uint32_t kind = 0;
        if (!TIFFReadDirectory(self->tiff.handle))
            return guard_failure(err);
        TIFFGetField(self->tiff.handle, TIFFTAG_SUBFILETYPE, &kind);
        if (!(kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)))
            return err_set(err, STATUS_INPUT, "%s: has several pages; it must have one",
                           self->input.file.name);
    }
    return STATUS_OK;
}

static Status open_tiff(TiffReader *self, Err *err)
{
    self->tiff.stream = self->input.stream;
    self->tiff.bytes = self->input.file.bytes;
    self->tiff.size = self->input.file.size;
    return tiff_open(&self->tiff, self->input.file.name, "r") ? STATUS_OK : guard_failure(err);
}

/* After an error of libtiff has left a call by longjmp [guard.failed], the handle is in an
 * undefined state. Then it is not closed, and its memory leaks. */
static void release(void *work)
{
    TiffReader *self = work;
    if (self->tiff.handle && !self->input.guard.failed)
        TIFFClose(self->tiff.handle);
    free(self->chunk);
}

static Status decode(void *work, Err *err)
{
    TiffReader *self = work;
    Image *image = &self->input.image;
    TRY(open_tiff(self, err));
    TRY(read_header(self, err));
    int width = (int)(self->swapped ? self->height : self->width);
    int height = (int)(self->swapped ? self->width : self->height);
    if (self->floats)
        TRY(plane_init(&image->plane, width, height, self->channels, err));
    else
        TRY(picture_init(&image->picture, width, height, self->channels, image_bits(self), err));
    TRY(read_chunks(self, image, err));
    return check_single(self, err);
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Reads the notes and the resolution that this program writes. The note "Shard" states which rows
 * the file has of a picture that several processes render. */
static void read_notes(TiffReader *self)
{
    static const struct {
        uint32_t field;
        const char *key;
    } fields[MAX_NOTES] = {{TIFFTAG_SOFTWARE, "Software"},
                           {TIFFTAG_IMAGEDESCRIPTION, "Comment"},
                           {TIFFTAG_PAGENAME, "Shard"}};
    float dpi = 0;
    self->notes = (ImageNotes){.notes = self->note};
    for (int i = 0; i < MAX_NOTES; i++) {
        const char *text;
        if (TIFFGetField(self->tiff.handle, fields[i].field, &text))
            self->note[self->notes.count++] = (ImageNote){fields[i].key, text};
    }
    if (TIFFGetField(self->tiff.handle, TIFFTAG_XRESOLUTION, &dpi))
        self->notes.dpi = (double)dpi;
}

/* Returns the compression of a file that this program wrote. */
static ImageCompression compression_of(TIFF *handle)
{
    uint16_t compression;
    TIFFGetFieldDefaulted(handle, TIFFTAG_COMPRESSION, &compression);
    return compression == COMPRESSION_NONE            ? IMAGE_UNCOMPRESSED
           : compression == COMPRESSION_ADOBE_DEFLATE ? IMAGE_DEFLATE
                                                      : IMAGE_LZW;
}

/* Returns true if the rows of the file need no conversion: integers of 8 or 16 bits, interleaved,
 * upright, in strips; grey, RGB, or RGB with an alpha that does not multiply the colors. */
static bool has_plain_rows(const TiffReader *self)
{
    TIFF *handle = self->tiff.handle;
    uint16_t orientation, extra = 0;
    const uint16_t *kinds = NULL;
    TIFFGetFieldDefaulted(handle, TIFFTAG_ORIENTATION, &orientation);
    TIFFGetFieldDefaulted(handle, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    bool straight = extra == 1 && kinds[0] == EXTRASAMPLE_UNASSALPHA;
    size_t row_bytes = (size_t)self->width * (size_t)self->samples * (size_t)(self->bits / 8);
    return !self->floats && self->bits >= 8 && self->planes == 1 && !self->palette[0] &&
           !self->min_is_white && orientation == ORIENTATION_TOPLEFT && !TIFFIsTiled(handle) &&
           (self->samples % 2 == 1 || (self->samples == 4 && straight)) &&
           (size_t)TIFFScanlineSize(handle) == row_bytes;
}

static Status begin(void *work, Err *err)
{
    TiffReader *self = work;
    const char *name = self->input.file.name;
    TRY(open_tiff(self, err));
    read_sides(self);
    TRY(image_check_sides(name, self->width, self->height, err));
    if (check_form(self, err) != STATUS_OK || !has_plain_rows(self))
        return image_fail_no_rows(name, err);
    read_notes(self);
    self->input.form = (ImageForm){.width = (int)self->width,
                                   .height = (int)self->height,
                                   .channels = self->samples,
                                   .bits = self->bits,
                                   .encoding = ENCODING_SRGB,
                                   .notes = &self->notes,
                                   .packing = {.compression = compression_of(self->tiff.handle)}};
    return STATUS_OK;
}

static Status rows(void *work, Err *err)
{
    TiffReader *self = work;
    const ImageForm *form = &self->input.form;
    size_t row_bytes = (size_t)form->width * (size_t)form->channels * (size_t)(form->bits / 8);
    uint8_t *values = self->input.rows;
    for (size_t y = 0; y < (size_t)self->input.n_rows; y++)
        if (TIFFReadScanline(self->tiff.handle, values + y * row_bytes, self->next++, 0) != 1)
            return guard_failure(err);
    return STATUS_OK;
}

static Status end(void *work, Err *err)
{
    const TiffReader *self = work;
    return TIFFLastDirectory(self->tiff.handle) ? STATUS_OK
                                                : image_fail_no_rows(self->input.file.name, err);
}

/* ---- facts ----------------------------------------------------------------------------------- */

static const char *compression_name(uint16_t compression)
{
    return compression == COMPRESSION_NONE  ? "none"
           : compression == COMPRESSION_LZW ? "lzw"
           : compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE
               ? "deflate"
           : compression == COMPRESSION_JPEG     ? "jpeg"
           : compression == COMPRESSION_PACKBITS ? "packbits"
                                                 : "another";
}

static const char *colors_name(uint16_t photometric)
{
    return photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_PALETTE ? "rgb"
           : photometric == PHOTOMETRIC_SEPARATED                               ? "cmyk"
           : photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE
               ? "grey"
               : "another";
}

/* Returns the horizontal resolution in dots per inch, or 0 if the file states none. */
static double resolution(TIFF *handle)
{
    float per_unit = 0;
    uint16_t unit;
    TIFFGetFieldDefaulted(handle, TIFFTAG_RESOLUTIONUNIT, &unit);
    if (!TIFFGetField(handle, TIFFTAG_XRESOLUTION, &per_unit) || unit == RESUNIT_NONE)
        return 0;
    return (double)per_unit * (unit == RESUNIT_CENTIMETER ? MM_PER_INCH / 10 : 1);
}

/* Sets facts.ink_percent to the maximum total ink of a pixel. Leaves it 0 unless the rows hold
 * interleaved inks. */
static Status measure_ink(TiffReader *self, Err *err)
{
    enum { INKS = 4 };
    TIFF *handle = self->tiff.handle;
    const int bits = self->input.facts.bits;
    uint16_t samples, planes;
    double max_ink = 0; /* 1 is one full ink */
    TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(handle, TIFFTAG_PLANARCONFIG, &planes);
    const size_t row_bytes = (size_t)self->width * samples * (size_t)(bits / 8);
    if (samples < INKS || planes != PLANARCONFIG_CONTIG || (bits != 8 && bits != 16) ||
        TIFFIsTiled(handle) || (size_t)TIFFScanlineSize(handle) != row_bytes)
        return STATUS_OK;
    TRY(mem_calloc(&self->chunk, row_bytes, 1, "a row of a TIFF", err));
    for (uint32_t y = 0; y < self->height; y++) {
        if (TIFFReadScanline(handle, self->chunk, y, 0) != 1)
            return guard_failure(err);
        for (size_t x = 0; x < self->width; x++) {
            double sum = 0;
            for (size_t i = x * samples; i < x * samples + INKS; i++)
                sum += bits == 8 ? ((const uint8_t *)self->chunk)[i] / 255.0
                                 : ((const uint16_t *)self->chunk)[i] / 65535.0;
            max_ink = fmax(max_ink, sum);
        }
    }
    self->input.facts.ink_percent = 100 * max_ink;
    return STATUS_OK;
}

/* A file that does not state its colors is reported as "another"; PHOTOMETRIC_YCBCR stands for it.
 */
static Status get_facts(void *work, Err *err)
{
    TiffReader *self = work;
    TRY(open_tiff(self, err));
    TIFF *handle = self->tiff.handle;
    uint32_t size;
    uint16_t bits, compression, photometric = PHOTOMETRIC_YCBCR, extra, *kinds;
    const void *profile;
    ImageFacts *facts = &self->input.facts;
    read_sides(self);
    TIFFGetField(handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(handle, TIFFTAG_COMPRESSION, &compression);
    TIFFGetFieldDefaulted(handle, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    *facts = (ImageFacts){.format = "tif",
                          .compression = compression_name(compression),
                          .width = (int)self->width,
                          .height = (int)self->height,
                          .bits = bits,
                          .dpi = resolution(handle),
                          .has_alpha = extra > 0,
                          .colors = colors_name(photometric)};
    if (TIFFGetField(handle, TIFFTAG_ICCPROFILE, &size, &profile))
        image_profile_name(profile, size, facts->profile);
    facts->pages = TIFFNumberOfDirectories(handle);
    TIFFSetDirectory(handle, 0);
    return photometric == PHOTOMETRIC_SEPARATED ? measure_ink(self, err) : STATUS_OK;
}

const ImageDecoder tiff_decoder = {.format = "TIFF",
                                   .state_size = sizeof(TiffReader),
                                   .is = tiff_is,
                                   .decode = decode,
                                   .get_facts = get_facts,
                                   .begin = begin,
                                   .rows = rows,
                                   .end = end,
                                   .release = release};
