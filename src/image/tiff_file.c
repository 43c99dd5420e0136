/* TIFF through libtiff, from the file in memory: a single page in strips or tiles, grey or RGB, 8
 * or 16 bits or 32-bit floats, however it is compressed. Its Orientation is undone on the way: the
 * place of a pixel is a linear function of its column and row in the file. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

typedef struct Tiff {
    ImageBytes file;
    TiffStream tiff;
    uint32_t width, height; /* in the file */
    int samples, bits;
    bool floats;
    bool swapped;                     /* its rows are columns */
    int64_t origin, across, down;     /* the pixel of column 0, row 0; how far the next ones are */
    uint32_t part_width, part_height; /* of a tile, or of a row */
    size_t part_bytes;
    void *part;  /* owned */
    Image image; /* made; owned */
} Tiff;

static bool tiff_is(const ImageBytes *file)
{
    return file->size >= 4 &&
           (memcmp(file->bytes, "II*\0", 4) == 0 || memcmp(file->bytes, "MM\0*", 4) == 0 ||
            memcmp(file->bytes, "II+\0", 4) == 0 || memcmp(file->bytes, "MM\0+", 4) == 0);
}

static Status unsound(Tiff *self, Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", self->file.name, err);
    image_plain_text(self->tiff.complaint);
    return err_set(err, STATUS_INPUT, "%s: is not a sound TIFF file: %s", self->file.name,
                   *self->tiff.complaint ? self->tiff.complaint
                                         : "its directory does not fit its data");
}

/* Where pixels go. The orientations are counted as TIFF does: from 5 on rows are columns. */
static void set_places(Tiff *self, int orientation)
{
    bool mirrored = orientation == ORIENTATION_TOPRIGHT || orientation == ORIENTATION_BOTRIGHT ||
                    orientation == ORIENTATION_RIGHTBOT || orientation == ORIENTATION_LEFTBOT;
    bool upended = orientation == ORIENTATION_BOTRIGHT || orientation == ORIENTATION_BOTLEFT ||
                   orientation == ORIENTATION_RIGHTTOP || orientation == ORIENTATION_RIGHTBOT;
    self->swapped = orientation >= ORIENTATION_LEFTTOP;
    self->across = self->swapped ? self->height : 1;
    self->down = self->swapped ? 1 : self->width;
    self->origin = 0;
    if (mirrored) {
        self->origin += self->across * (self->width - 1);
        self->across = -self->across;
    }
    if (upended) {
        self->origin += self->down * (self->height - 1);
        self->down = -self->down;
    }
}

static Status check_form(Tiff *self, Err *err)
{
    uint16_t samples, bits, format, planar, photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(self->tiff.handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_PLANARCONFIG, &planar);
    self->samples = samples;
    self->bits = bits;
    self->floats = format == SAMPLEFORMAT_IEEEFP;
    bool depth =
        self->floats ? bits == 32 : format == SAMPLEFORMAT_UINT && (bits == 8 || bits == 16);
    bool color = photometric == PHOTOMETRIC_RGB
                     ? samples == 3 || samples == 4
                     : photometric == PHOTOMETRIC_MINISBLACK && (samples == 1 || samples == 2);
    if (depth && color && (planar == PLANARCONFIG_CONTIG || samples == 1))
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "%s: has %d samples a pixel of %d bits in a form that cannot be read; grey or RGB "
        "of 8 or 16 bits or 32-bit floats, interleaved, can",
        self->file.name, samples, bits);
}

/* The bytes that a file of this size can hold, with much to spare. Blank pictures shrink 1400-fold
 * by LZW, 1032-fold by deflate and 64-fold by PackBits; of the others ZSTD reaches 32768-fold, and
 * WebP and LERC take a few bytes for a blank strip of any size. */
static size_t most_bytes(const Tiff *self)
{
    enum { COMMON_RATIO = 10000, RATIO = 100000, BLANK_STRIP = 64 << 20 };
    uint16_t compression;
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_COMPRESSION, &compression);
    bool common = compression == COMPRESSION_NONE || compression == COMPRESSION_LZW ||
                  compression == COMPRESSION_PACKBITS || compression == COMPRESSION_DEFLATE ||
                  compression == COMPRESSION_ADOBE_DEFLATE;
    return common ? self->file.size * COMMON_RATIO : self->file.size * RATIO + BLANK_STRIP;
}

/* `width` x `height` pixels, of the whole or of a tile. */
static Status check_claim(const Tiff *self, uint32_t width, uint32_t height, Err *err)
{
    TRY(image_check_sides(self->file.name, width, height, err));
    size_t pixel = (size_t)self->samples * (size_t)(self->bits / 8);
    return image_check_claim(&self->file, width, height, pixel * width * height, most_bytes(self),
                             err);
}

/* Strips are read row by row, tiles whole. */
static Status set_parts(Tiff *self, Err *err)
{
    self->part_width = self->width;
    self->part_height = 1;
    bool tiled = TIFFIsTiled(self->tiff.handle);
    if (tiled) {
        TIFFGetField(self->tiff.handle, TIFFTAG_TILEWIDTH, &self->part_width);
        TIFFGetField(self->tiff.handle, TIFFTAG_TILELENGTH, &self->part_height);
        TRY(check_claim(self, self->part_width, self->part_height, err));
    }
    self->part_bytes = (size_t)self->part_width * self->part_height * (size_t)self->samples *
                       (size_t)(self->bits / 8);
    TRY(image_check_memory((int)self->part_width, (int)self->part_height, self->part_bytes, err));
    if ((size_t)(tiled ? TIFFTileSize(self->tiff.handle) : TIFFScanlineSize(self->tiff.handle)) !=
        self->part_bytes)
        return unsound(self, err);
    return mem_calloc(&self->part, self->part_bytes, 1, "bytes of a part of a TIFF", err);
}

/* What is not said is sRGB's. */
static Status check_colors(Tiff *self, Err *err)
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
    if (self->samples >= 3 && !image_is_srgb(xy))
        return image_other_colors(self->file.name, "PrimaryChromaticities or WhitePoint", err);
    if (!self->floats && TIFFGetField(self->tiff.handle, TIFFTAG_ICCPROFILE, &size, &profile))
        return image_check_profile(self->file.name, profile, size, err);
    return STATUS_OK;
}

static Status read_header(Tiff *self, Err *err)
{
    uint16_t orientation;
    TRY(check_form(self, err));
    TIFFGetField(self->tiff.handle, TIFFTAG_IMAGEWIDTH, &self->width);
    TIFFGetField(self->tiff.handle, TIFFTAG_IMAGELENGTH, &self->height);
    TRY(check_claim(self, self->width, self->height, err));
    TIFFGetFieldDefaulted(self->tiff.handle, TIFFTAG_ORIENTATION, &orientation);
    set_places(self, orientation);
    TRY(check_colors(self, err));
    return set_parts(self, err);
}

/* `n` pixels of row `y` of the file, from column `x` on, at `values`. */
static void take_codes(const Tiff *self, const uint8_t *values, uint32_t x, uint32_t y, uint32_t n,
                       Picture *picture)
{
    const uint16_t *deep = (const void *)values;
    size_t at = 0;
    for (uint32_t i = 0; i < n; i++) {
        int64_t place = self->origin + (x + i) * self->across + y * self->down;
        for (int c = 0; c < self->samples; c++, at++)
            picture_set(picture, (size_t)(place * self->samples + c),
                        self->bits == 8 ? values[at] : deep[at]);
    }
}

static void take_floats(const Tiff *self, const uint8_t *values, uint32_t x, uint32_t y, uint32_t n,
                        Plane *plane)
{
    size_t size = (size_t)self->samples * sizeof *plane->values;
    for (uint32_t i = 0; i < n; i++) {
        int64_t place = self->origin + (x + i) * self->across + y * self->down;
        memcpy(plane->values + place * self->samples, values + i * size, size);
    }
}

/* The part of the file that begins at column `x`, row `y`. */
static Status read_part(Tiff *self, uint32_t x, uint32_t y, Image *image, Err *err)
{
    bool read = TIFFIsTiled(self->tiff.handle)
                    ? TIFFReadTile(self->tiff.handle, self->part, x, y, 0, 0) >= 0
                    : TIFFReadScanline(self->tiff.handle, self->part, y, 0) == 1;
    if (!read)
        return unsound(self, err);
    uint32_t n = self->part_width < self->width - x ? self->part_width : self->width - x;
    size_t row_bytes = self->part_bytes / self->part_height;
    for (uint32_t row = 0; row < self->part_height && y + row < self->height; row++) {
        const uint8_t *values = (const uint8_t *)self->part + row * row_bytes;
        if (self->floats)
            take_floats(self, values, x, y + row, n, &image->plane);
        else
            take_codes(self, values, x, y + row, n, &image->picture);
    }
    return STATUS_OK;
}

/* Divides a pixel's codes by its alpha, the last of them. */
static void divide_codes(Picture *picture, size_t first, int colors)
{
    uint32_t alpha = picture_code(picture, first + (size_t)colors);
    uint32_t most = picture->bits == 8 ? 255 : 65535;
    for (size_t i = first; i < first + (size_t)colors && alpha > 0; i++) {
        uint32_t code = (picture_code(picture, i) * most + alpha / 2) / alpha;
        picture_set(picture, i, (uint16_t)(code < most ? code : most));
    }
}

/* Codes are to be without alpha, floats multiplied by it. */
static void settle_colors(const Tiff *self, Image *image)
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

static Status read_parts(Tiff *self, Image *image, Err *err)
{
    for (uint32_t y = 0; y < self->height; y += self->part_height)
        for (uint32_t x = 0; x < self->width; x += self->part_width)
            TRY(read_part(self, x, y, image, err));
    if (self->samples == 2 || self->samples == 4)
        settle_colors(self, image);
    return STATUS_OK;
}

/* Smaller versions of the page and masks are no pages. */
static Status check_single(Tiff *self, Err *err)
{
    while (!TIFFLastDirectory(self->tiff.handle)) {
        uint32_t kind = 0;
        if (!TIFFReadDirectory(self->tiff.handle))
            return unsound(self, err);
        TIFFGetField(self->tiff.handle, TIFFTAG_SUBFILETYPE, &kind);
        if (!(kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)))
            return err_set(err, STATUS_INPUT,
                           "%s: has several pages; only a single picture can be read",
                           self->file.name);
    }
    return STATUS_OK;
}

static Status decode(void *work, Err *err)
{
    Tiff *self = work;
    Image *image = &self->image;
    if (!tiff_open(&self->tiff, self->file.name, "r"))
        return unsound(self, err);
    TRY(read_header(self, err));
    int width = (int)(self->swapped ? self->height : self->width);
    int height = (int)(self->swapped ? self->width : self->height);
    if (self->floats)
        TRY(plane_init(&image->plane, width, height, self->samples, err));
    else
        TRY(picture_init(&image->picture, width, height, self->samples, self->bits, err));
    TRY(read_parts(self, image, err));
    return check_single(self, err);
}

static Status tiff_decode(const ImageBytes *file, Image *image, Err *err)
{
    Tiff self = {.file = *file};
    Status status = tiff_guard_bytes(decode, &self, &self.tiff, file, err);
    free(self.part);
    if (status == STATUS_OK)
        *image = self.image;
    else
        image_release(&self.image);
    return status;
}

const ImageDecoder tiff_decoder = {.is = tiff_is, .decode = tiff_decode};
