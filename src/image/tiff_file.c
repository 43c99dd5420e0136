/* TIFF through libtiff, from the file in memory: the first image, in strips, grey or RGB, 8 or 16
 * bits or 32-bit floats, however it is compressed. */
#include "image/formats.h"

#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

typedef struct Tiff {
    ImageBytes file;
    size_t at;
    TIFF *handle;
    uint32_t width, height;
    int samples, bits;
    bool floats;
    void *row; /* owned */
    char complaint[200];
} Tiff;

bool tiff_is(const ImageBytes *file)
{
    return file->size >= 4 &&
           (memcmp(file->bytes, "II*\0", 4) == 0 || memcmp(file->bytes, "MM\0*", 4) == 0 ||
            memcmp(file->bytes, "II+\0", 4) == 0 || memcmp(file->bytes, "MM\0+", 4) == 0);
}

/* -------------------------------------------------------------------------------- what libtiff calls */

static tmsize_t on_read(thandle_t user, void *out, tmsize_t size)
{
    Tiff *self = user;
    size_t left = self->file.size - self->at;
    size_t count = (size_t)size < left ? (size_t)size : left;
    memcpy(out, self->file.bytes + self->at, count);
    self->at += count;
    return (tmsize_t)count;
}

static tmsize_t on_write(thandle_t user, void *bytes, tmsize_t size)
{
    (void)user;
    (void)bytes;
    (void)size;
    return -1;
}

static toff_t on_seek(thandle_t user, toff_t offset, int whence)
{
    Tiff *self = user;
    toff_t start = whence == SEEK_CUR ? self->at : whence == SEEK_END ? self->file.size : 0;
    toff_t target = start + offset;
    self->at = target < self->file.size ? (size_t)target : self->file.size;
    return self->at;
}

static int on_close(thandle_t user)
{
    (void)user;
    return 0;
}

static toff_t on_size(thandle_t user)
{
    const Tiff *self = user;
    return self->file.size;
}

static int on_error(TIFF *handle, void *user, const char *module, const char *format,
                    va_list values) PRINTF_LIKE(4, 0);
static int on_error(TIFF *handle, void *user, const char *module, const char *format,
                    va_list values)
{
    (void)handle;
    (void)module;
    Tiff *self = user;
    if (!*self->complaint)
        vsnprintf(self->complaint, sizeof self->complaint, format, values);
    return 1;
}

static int on_warning(TIFF *handle, void *user, const char *module, const char *format,
                      va_list values) PRINTF_LIKE(4, 0);
static int on_warning(TIFF *handle, void *user, const char *module, const char *format,
                      va_list values)
{
    (void)handle;
    (void)user;
    (void)module;
    (void)format;
    (void)values;
    return 1;
}

static TIFF *open_handle(Tiff *self)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options)
        return NULL;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, self);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, self);
    TIFF *handle = TIFFClientOpenExt(self->file.name, "rm", self, on_read, on_write, on_seek,
                                     on_close, on_size, NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return handle;
}

/* ---------------------------------------------------------------------------------------- reading */

static Status unsound(Tiff *self, Err *err)
{
    image_plain_text(self->complaint);
    return err_set(err, STATUS_INPUT, "%s: is not a sound TIFF file: %s", self->file.name,
                   *self->complaint ? self->complaint : "its directory does not fit its data");
}

static Status read_header(Tiff *self, Err *err)
{
    uint16_t samples, bits, format, planar, photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(self->handle, TIFFTAG_IMAGEWIDTH, &self->width);
    TIFFGetField(self->handle, TIFFTAG_IMAGELENGTH, &self->height);
    TIFFGetField(self->handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(self->handle, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(self->handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(self->handle, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(self->handle, TIFFTAG_PLANARCONFIG, &planar);
    self->samples = samples;
    self->bits = bits;
    self->floats = format == SAMPLEFORMAT_IEEEFP;
    bool depth =
        self->floats ? bits == 32 : format == SAMPLEFORMAT_UINT && (bits == 8 || bits == 16);
    bool color = photometric == PHOTOMETRIC_RGB
                     ? samples == 3 || samples == 4
                     : photometric == PHOTOMETRIC_MINISBLACK && (samples == 1 || samples == 2);
    if (!depth || !color || (planar != PLANARCONFIG_CONTIG && samples > 1) ||
        TIFFIsTiled(self->handle))
        return err_set(err, STATUS_INPUT,
                       "%s: has %d samples a pixel of %d bits in a form that cannot be read; grey "
                       "or RGB of 8 or 16 bits or 32-bit floats, in interleaved strips, can",
                       self->file.name, samples, bits);
    TRY(image_check_sides(self->file.name, self->width, self->height, err));
    if ((size_t)TIFFScanlineSize(self->handle) !=
        self->width * (size_t)samples * (size_t)(bits / 8))
        return unsound(self, err);
    return mem_calloc(&self->row, self->width * (size_t)samples, (size_t)bits / 8,
                      "values of a row", err);
}

/* One row of the file as codes; alpha must be opaque. */
static Status take_codes(const Tiff *self, int y, Picture *picture, Err *err)
{
    size_t next = (size_t)y * picture_stride(picture);
    const uint8_t *row8 = self->row;
    const uint16_t *row16 = self->row;
    for (size_t x = 0; x < self->width; x++)
        for (int c = 0; c < self->samples; c++) {
            size_t i = x * (size_t)self->samples + (size_t)c;
            uint16_t code = self->bits == 8 ? row8[i] : row16[i];
            if (c < picture->channels)
                picture_set(picture, next++, code);
            else if (code != (self->bits == 8 ? 255 : 65535))
                return err_set(err, STATUS_INPUT,
                               "%s: is transparent at column %zu, row %d; only opaque pictures can "
                               "be read",
                               self->file.name, x, y);
        }
    return STATUS_OK;
}

static Status read_rows(Tiff *self, Picture *picture, Plane *plane, Err *err)
{
    for (uint32_t y = 0; y < self->height; y++) {
        if (TIFFReadScanline(self->handle, self->row, y, 0) != 1)
            return unsound(self, err);
        size_t values = self->width * (size_t)self->samples;
        if (self->floats)
            memcpy(plane->values + y * values, self->row, values * sizeof *plane->values);
        else
            TRY(take_codes(self, (int)y, picture, err));
    }
    bool alpha = self->floats && (self->samples == 2 || self->samples == 4);
    return alpha ? plane_drop_alpha(plane, self->file.name, err) : STATUS_OK;
}

static Status decode(Tiff *self, Image *image, Err *err)
{
    self->handle = open_handle(self);
    if (!self->handle)
        return unsound(self, err);
    TRY(read_header(self, err));
    int width = (int)self->width, height = (int)self->height;
    if (self->floats)
        TRY(plane_init(&image->plane, width, height, self->samples, err));
    else
        TRY(picture_init(&image->picture, width, height, self->samples < 3 ? 1 : 3, self->bits,
                         err));
    return read_rows(self, &image->picture, &image->plane, err);
}

Status tiff_decode(const ImageBytes *file, Image *image, Err *err)
{
    Tiff self = {.file = *file};
    Image made = {0};
    Status status = decode(&self, &made, err);
    if (self.handle)
        TIFFClose(self.handle);
    free(self.row);
    if (status == STATUS_OK)
        *image = made;
    else
        image_release(&made);
    return status;
}
