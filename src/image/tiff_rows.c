/* TIFF row by row through libtiff, from a stream: strips of any compression, whose rows follow each
 * other. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

enum { MOST_NOTES = 3 };

typedef struct Rows {
    const char *name; /* borrowed */
    TiffStream tiff;
    ImageForm form;
    ImageNotes notes;
    ImageNote note[MOST_NOTES]; /* texts are libtiff's */
    uint32_t next;              /* row */
    /* What `read` is to do: */
    uint8_t *values;
    int n;
} Rows;

static bool tiff_rows_is(const ImageBytes *file)
{
    return tiff_decoder.is(file);
}

static Status unsound(Rows *self, Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", self->name, err);
    image_plain_text(self->tiff.complaint);
    return err_set(err, STATUS_INPUT, "%s: is not a sound TIFF file: %s", self->name,
                   *self->tiff.complaint ? self->tiff.complaint
                                         : "its directory does not fit its data");
}

static void take_notes(Rows *self)
{
    static const struct {
        uint32_t field;
        const char *key;
    } fields[MOST_NOTES] = {{TIFFTAG_SOFTWARE, "Software"},
                            {TIFFTAG_IMAGEDESCRIPTION, "Comment"},
                            {TIFFTAG_PAGENAME, "Shard"}};
    float dpi = 0;
    self->notes = (ImageNotes){.notes = self->note};
    for (int i = 0; i < MOST_NOTES; i++) {
        const char *text;
        if (TIFFGetField(self->tiff.handle, fields[i].field, &text))
            self->note[self->notes.count++] = (ImageNote){fields[i].key, text};
    }
    if (TIFFGetField(self->tiff.handle, TIFFTAG_XRESOLUTION, &dpi))
        self->notes.dpi = (double)dpi;
}

static ImageCompression compression_of(TIFF *handle)
{
    uint16_t compression;
    TIFFGetFieldDefaulted(handle, TIFFTAG_COMPRESSION, &compression);
    return compression == COMPRESSION_NONE            ? IMAGE_UNCOMPRESSED
           : compression == COMPRESSION_ADOBE_DEFLATE ? IMAGE_DEFLATE
                                                      : IMAGE_LZW;
}

/* Grey, RGB, or RGB with alpha that the colours are not multiplied by. */
static bool has_known_samples(TIFF *handle, int samples)
{
    uint16_t photometric = PHOTOMETRIC_YCBCR, extra = 0;
    const uint16_t *kinds = NULL;
    TIFFGetField(handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(handle, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    if (samples == 1)
        return photometric == PHOTOMETRIC_MINISBLACK;
    bool alpha = extra == 1 && kinds[0] == EXTRASAMPLE_UNASSALPHA;
    return photometric == PHOTOMETRIC_RGB && (samples == 3 || (samples == 4 && alpha));
}

static Status read_header(void *work, Err *err)
{
    Rows *self = work;
    uint32_t width = 0, height = 0;
    uint16_t samples, bits, format, planar, orientation;
    if (!tiff_open(&self->tiff, self->name, "r"))
        return unsound(self, err);
    TIFF *handle = self->tiff.handle;
    TIFFGetField(handle, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(handle, TIFFTAG_IMAGELENGTH, &height);
    TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(handle, TIFFTAG_PLANARCONFIG, &planar);
    TIFFGetFieldDefaulted(handle, TIFFTAG_ORIENTATION, &orientation);
    TRY(image_check_sides(self->name, width, height, err));
    size_t row_bytes = (size_t)width * samples * (bits / 8);
    if (!has_known_samples(handle, samples) || (bits != 8 && bits != 16) ||
        format != SAMPLEFORMAT_UINT || planar != PLANARCONFIG_CONTIG ||
        orientation != ORIENTATION_TOPLEFT || TIFFIsTiled(handle) ||
        (size_t)TIFFScanlineSize(handle) != row_bytes)
        return image_no_rows(self->name, err);
    take_notes(self);
    self->form = (ImageForm){.width = (int)width,
                             .height = (int)height,
                             .channels = samples,
                             .bits = bits,
                             .encoding = ENCODING_SRGB,
                             .notes = &self->notes,
                             .packing = {.compression = compression_of(handle)}};
    return STATUS_OK;
}

static Status begin(FILE *stream, const char *name, ImageForm *form, void **self, Err *err)
{
    Rows *rows;
    TRY(mem_calloc(&rows, 1, sizeof *rows, "readers", err));
    *self = rows;
    rows->name = name;
    rows->tiff.stream = stream;
    errno = 0;
    TRY(tiff_guard(read_header, rows, &rows->tiff, name, err));
    *form = rows->form;
    return STATUS_OK;
}

static Status read(void *work, Err *err)
{
    Rows *self = work;
    size_t row_bytes =
        (size_t)self->form.width * (size_t)self->form.channels * (size_t)(self->form.bits / 8);
    for (size_t y = 0; y < (size_t)self->n; y++)
        if (TIFFReadScanline(self->tiff.handle, self->values + y * row_bytes, self->next++, 0) != 1)
            return unsound(self, err);
    return STATUS_OK;
}

static Status rows(void *self, void *values, int n, Err *err)
{
    Rows *reader = self;
    reader->values = values;
    reader->n = n;
    errno = 0;
    return tiff_guard(read, reader, &reader->tiff, reader->name, err);
}

static Status check_single(void *work, Err *err)
{
    const Rows *self = work;
    return TIFFLastDirectory(self->tiff.handle) ? STATUS_OK : image_no_rows(self->name, err);
}

static Status end(void *self, Err *err)
{
    Rows *reader = self;
    return tiff_guard(check_single, reader, &reader->tiff, reader->name, err);
}

static void release(void *self)
{
    Rows *reader = self;
    if (!reader)
        return;
    if (reader->tiff.handle)
        TIFFClose(reader->tiff.handle);
    free(reader);
}

const RowDecoder tiff_rows_decoder = {tiff_rows_is, begin, rows, end, release};
