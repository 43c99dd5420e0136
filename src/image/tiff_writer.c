/* TIFF through libtiff, strip by strip: little-endian whatever the machine, compressed with the
 * horizontal predictor, no date, so that equal pictures are equal files. The usual compression is
 * LZW, which every journal takes and some ask for, though deflate is smaller. BigTIFF where offsets
 * could need more than 32 bits. libtiff goes back to the header at the end, so it needs a file with
 * places. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

enum { STRIP_BYTES = 1 << 18 };
static const double classic_bytes = 4.0e9; /* a little may be added to 4 GB less that */
static const double worst_growth = 1.5;    /* of LZW, which writes 8 bits as up to 12 */

typedef struct Writer {
    TiffStream tiff;
    const ImageForm *form; /* while it is begun */
    ImageProfile profile;  /* owned */
    char *description;     /* owned */
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
    if (ferror(self->tiff.stream)) /* libtiff does not say why */
        return err_set(err, STATUS_IO, "writing the TIFF failed: %s", strerror(errno));
    return err_set(err, STATUS_IO, "writing the TIFF failed: %s",
                   *self->tiff.complaint ? self->tiff.complaint : strerror(errno));
}

static Status guarded(TiffWork *work, Writer *self, Err *err)
{
    return tiff_guard(work, self, &self->tiff, "that is written", err);
}

static bool set_notes(TIFF *handle, const ImageNotes *notes, const char *description)
{
    bool set = *description ? TIFFSetField(handle, TIFFTAG_IMAGEDESCRIPTION, description) : true;
    if (notes->dpi > 0)
        set = set && TIFFSetField(handle, TIFFTAG_XRESOLUTION, notes->dpi) &&
              TIFFSetField(handle, TIFFTAG_YRESOLUTION, notes->dpi) &&
              TIFFSetField(handle, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    const char *software = image_note(notes, "Software"), *shard = image_note(notes, "Shard");
    return set && (!software || TIFFSetField(handle, TIFFTAG_SOFTWARE, software)) &&
           (!shard || TIFFSetField(handle, TIFFTAG_PAGENAME, shard));
}

static bool set_fields(const Writer *self)
{
    const bool press = self->form->packing.inks;
    const uint16_t photometric[] = {[1] = PHOTOMETRIC_MINISBLACK,
                                    [3] = PHOTOMETRIC_RGB,
                                    [4] = press ? PHOTOMETRIC_SEPARATED : PHOTOMETRIC_RGB};
    static const uint16_t compression[] = {[IMAGE_LZW] = COMPRESSION_LZW,
                                           [IMAGE_DEFLATE] = COMPRESSION_ADOBE_DEFLATE,
                                           [IMAGE_UNCOMPRESSED] = COMPRESSION_NONE};
    TIFF *handle = self->tiff.handle;
    const ImageForm *form = self->form;
    bool set = TIFFSetField(handle, TIFFTAG_IMAGEWIDTH, (uint32_t)form->width) &&
               TIFFSetField(handle, TIFFTAG_IMAGELENGTH, (uint32_t)form->height) &&
               TIFFSetField(handle, TIFFTAG_SAMPLESPERPIXEL, form->channels) &&
               TIFFSetField(handle, TIFFTAG_BITSPERSAMPLE, form->bits) &&
               TIFFSetField(handle, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT) &&
               TIFFSetField(handle, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
               TIFFSetField(handle, TIFFTAG_PHOTOMETRIC, photometric[form->channels]) &&
               TIFFSetField(handle, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
               TIFFSetField(handle, TIFFTAG_ROWSPERSTRIP, (uint32_t)self->rows_per_strip) &&
               TIFFSetField(handle, TIFFTAG_COMPRESSION, compression[form->packing.compression]);
    if (form->packing.compression != IMAGE_UNCOMPRESSED)
        set = set && TIFFSetField(handle, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    if (press)
        set = set && TIFFSetField(handle, TIFFTAG_INKSET, INKSET_CMYK);
    else if (form->channels == 4)
        set = set && TIFFSetField(handle, TIFFTAG_EXTRASAMPLES, 1,
                                  (const uint16_t[]){EXTRASAMPLE_UNASSALPHA});
    if (self->profile.size > 0)
        set = set && TIFFSetField(handle, TIFFTAG_ICCPROFILE, (uint32_t)self->profile.size,
                                  self->profile.bytes);
    return set && (!form->notes || set_notes(handle, form->notes, self->description));
}

static Status begin_handle(void *self, Err *err)
{
    Writer *writer = self;
    const ImageForm *form = writer->form;
    double growth = form->packing.compression == IMAGE_LZW ? worst_growth : 1;
    bool big = (double)writer->row_bytes * form->height * growth > classic_bytes;
    if (!tiff_open(&writer->tiff, "picture", big ? "wl8" : "wl") || !set_fields(writer))
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
    TRY(image_profile(form, &writer->profile, err));
    TRY(image_description(form->notes, &writer->description, err));
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
    free(writer->profile.bytes);
    free(writer->description);
    free(writer->strip);
    free(writer);
}

const RowEncoder tiff_encoder = {.begin = begin,
                                 .rows = write_rows,
                                 .end = end,
                                 .release = release_writer,
                                 .folds = 1400, /* LZW */
                                 .keeps_dpi = true,
                                 .keeps_inks = true,
                                 .keeps_alpha = true};
