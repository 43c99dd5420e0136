/* TIFF through libtiff, strip by strip: little-endian whatever the machine, deflated with the
 * horizontal predictor, no date, so that equal pictures are equal files. BigTIFF where offsets
 * could need more than 32 bits. libtiff goes back to the header at the end, so it needs a file with
 * places. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

enum { STRIP_BYTES = 1 << 18 };
static const double classic_bytes = 4.0e9; /* deflate may add a little to 4 GB less that */

typedef struct Writer {
    TiffStream tiff;
    const ImageForm *form; /* while it is begun */
    size_t row_bytes;
    int rows_per_strip, height;
    uint8_t *strip; /* owned */
    int filled;     /* rows of it */
    uint32_t next;  /* strip */
} Writer;

static Status failed(Writer *self, Err *err)
{
    image_plain_text(self->tiff.complaint);
    if (errno == ENOMEM)
        return mem_out_of("for the TIFF", "that is written", err);
    return err_set(err, STATUS_IO, "writing the TIFF failed: %s",
                   *self->tiff.complaint ? self->tiff.complaint : strerror(errno));
}

static Status guarded(TiffWork *work, Writer *self, Err *err)
{
    return tiff_guard(work, self, &self->tiff, "that is written", err);
}

/* The field that a note is kept in. */
static uint32_t field_of(const char *key)
{
    if (strcmp(key, "Software") == 0)
        return TIFFTAG_SOFTWARE;
    return strcmp(key, "Shard") == 0 ? TIFFTAG_PAGENAME : TIFFTAG_IMAGEDESCRIPTION;
}

static bool set_fields(TIFF *handle, const ImageForm *form, int rows_per_strip)
{
    bool set = TIFFSetField(handle, TIFFTAG_IMAGEWIDTH, (uint32_t)form->width) &&
               TIFFSetField(handle, TIFFTAG_IMAGELENGTH, (uint32_t)form->height) &&
               TIFFSetField(handle, TIFFTAG_SAMPLESPERPIXEL, form->channels) &&
               TIFFSetField(handle, TIFFTAG_BITSPERSAMPLE, form->bits) &&
               TIFFSetField(handle, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT) &&
               TIFFSetField(handle, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
               TIFFSetField(handle, TIFFTAG_PHOTOMETRIC,
                            form->channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK) &&
               TIFFSetField(handle, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
               TIFFSetField(handle, TIFFTAG_ROWSPERSTRIP, (uint32_t)rows_per_strip) &&
               TIFFSetField(handle, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE) &&
               TIFFSetField(handle, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    if (form->notes && form->notes->dpi > 0)
        set = set && TIFFSetField(handle, TIFFTAG_XRESOLUTION, form->notes->dpi) &&
              TIFFSetField(handle, TIFFTAG_YRESOLUTION, form->notes->dpi) &&
              TIFFSetField(handle, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    for (int i = 0; form->notes && set && i < form->notes->count; i++) {
        const ImageNote *note = &form->notes->notes[i];
        set = TIFFSetField(handle, field_of(note->key), note->text);
    }
    return set;
}

static Status begin_handle(void *self, Err *err)
{
    Writer *writer = self;
    const ImageForm *form = writer->form;
    bool big = (double)writer->row_bytes * form->height > classic_bytes;
    if (!tiff_open(&writer->tiff, "picture", big ? "wl8" : "wl") ||
        !set_fields(writer->tiff.handle, form, writer->rows_per_strip))
        return failed(writer, err);
    return STATUS_OK;
}

static Status begin(FILE *stream, const ImageForm *form, void **self, Err *err)
{
    Writer *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *self = writer;
    writer->tiff.stream = stream;
    writer->height = form->height;
    writer->row_bytes = (size_t)form->width * (size_t)form->channels * (size_t)(form->bits / 8);
    writer->rows_per_strip = (int)(STRIP_BYTES / writer->row_bytes);
    if (writer->rows_per_strip < 1)
        writer->rows_per_strip = 1;
    if (writer->rows_per_strip > form->height)
        writer->rows_per_strip = form->height;
    if (fseeko(stream, 0, SEEK_CUR) != 0)
        return err_set(err, STATUS_IO, "a TIFF needs a file, not a pipe");
    TRY(mem_calloc(&writer->strip, (size_t)writer->rows_per_strip, writer->row_bytes, "strips",
                   err));
    writer->form = form;
    return guarded(begin_handle, writer, err);
}

/* libtiff may change the strip that it is given. */
static Status write_strip(void *self, Err *err)
{
    Writer *writer = self;
    tmsize_t size = (tmsize_t)((size_t)writer->filled * writer->row_bytes);
    writer->filled = 0;
    errno = 0; /* without room for libdeflate, libtiff takes zlib, which makes other bytes */
    if (TIFFWriteEncodedStrip(writer->tiff.handle, writer->next++, writer->strip, size) != size ||
        errno == ENOMEM)
        return failed(writer, err);
    return STATUS_OK;
}

static Status write_rows(void *self, const void *values, int first, int n, Err *err)
{
    Writer *writer = self;
    const uint8_t *bytes = values;
    for (int y = 0; y < n; y++) {
        memcpy(writer->strip + (size_t)writer->filled++ * writer->row_bytes,
               bytes + (size_t)y * writer->row_bytes, writer->row_bytes);
        if (writer->filled == writer->rows_per_strip || first + y + 1 == writer->height)
            TRY(guarded(write_strip, writer, err));
    }
    return STATUS_OK;
}

static Status write_directory(void *self, Err *err)
{
    Writer *writer = self;
    return TIFFWriteDirectory(writer->tiff.handle) == 1 ? STATUS_OK : failed(writer, err);
}

static Status end(void *self, Err *err)
{
    return guarded(write_directory, self, err);
}

/* Also writes what libtiff still holds. */
static Status clean_up(void *self, Err *err)
{
    (void)err;
    Writer *writer = self;
    TIFFCleanup(writer->tiff.handle);
    return STATUS_OK;
}

static void release_writer(void *self)
{
    Writer *writer = self;
    if (!writer)
        return;
    if (writer->tiff.handle)
        (void)!guarded(clean_up, writer, NULL);
    free(writer->strip);
    free(writer);
}

const RowEncoder tiff_encoder = {
    .begin = begin, .rows = write_rows, .end = end, .release = release_writer, .keeps_dpi = true};
