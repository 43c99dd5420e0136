/* Writes TIFF with libtiff, strip by strip. Files are little-endian on every machine, compressed
 * with the horizontal predictor, and have no date, so that equal pictures give equal files. The
 * default compression is LZW, which every journal accepts and some require, though deflate is
 * smaller. BigTIFF is used where offsets could need more than 32 bits. libtiff returns to the
 * header at the end, so the file must be seekable. */
#include "image/tiff_stream.h"

/* Size of a strip before compression, in bytes. Each strip is compressed on its own: smaller strips
 * compress less, larger strips need more memory in every reader. */
enum { STRIP_BYTES = 1 << 18 };
static const double classic_bytes = 4.0e9; /* maximum size of pixels in a classic TIFF: 4 GiB less a
                                            * reserve for the rest of the file */
static const double worst_growth = 1.5;    /* maximum growth by LZW, which writes 8 bits as up to
                                            * 12 */

typedef struct TiffWriter {
    ImageOutput output;
    TiffStream tiff;
    uint32_t next; /* index of the next strip */
} TiffWriter;

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

static bool set_fields(const TiffWriter *self)
{
    const ImageForm *form = &self->output.form;
    const ImageProfile *icc = &self->output.profile;
    const bool press = form->packing.inks;
    const uint16_t photometric[] = {[1] = PHOTOMETRIC_MINISBLACK,
                                    [3] = PHOTOMETRIC_RGB,
                                    [4] = press ? PHOTOMETRIC_SEPARATED : PHOTOMETRIC_RGB};
    static const uint16_t compression[] = {[IMAGE_LZW] = COMPRESSION_LZW,
                                           [IMAGE_DEFLATE] = COMPRESSION_ADOBE_DEFLATE,
                                           [IMAGE_UNCOMPRESSED] = COMPRESSION_NONE};
    TIFF *handle = self->tiff.handle;
    bool set = TIFFSetField(handle, TIFFTAG_IMAGEWIDTH, (uint32_t)form->width) &&
               TIFFSetField(handle, TIFFTAG_IMAGELENGTH, (uint32_t)form->height) &&
               TIFFSetField(handle, TIFFTAG_SAMPLESPERPIXEL, form->channels) &&
               TIFFSetField(handle, TIFFTAG_BITSPERSAMPLE, form->bits) &&
               TIFFSetField(handle, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT) &&
               TIFFSetField(handle, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
               TIFFSetField(handle, TIFFTAG_PHOTOMETRIC, photometric[form->channels]) &&
               TIFFSetField(handle, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
               TIFFSetField(handle, TIFFTAG_ROWSPERSTRIP, (uint32_t)self->output.chunk_rows) &&
               TIFFSetField(handle, TIFFTAG_COMPRESSION, compression[form->packing.compression]);
    if (form->packing.compression != IMAGE_UNCOMPRESSED)
        set = set && TIFFSetField(handle, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    if (press)
        set = set && TIFFSetField(handle, TIFFTAG_INKSET, INKSET_CMYK);
    else if (form->channels == 4)
        set = set && TIFFSetField(handle, TIFFTAG_EXTRASAMPLES, 1,
                                  (const uint16_t[]){EXTRASAMPLE_UNASSALPHA});
    if (icc->size > 0)
        set = set && TIFFSetField(handle, TIFFTAG_ICCPROFILE, (uint32_t)icc->size, icc->bytes);
    return set && (!form->notes || set_notes(handle, form->notes, self->output.description));
}

static Status begin(void *work, Err *err)
{
    TiffWriter *self = work;
    ImageOutput *output = &self->output;
    const ImageForm *form = &output->form;
    double growth = form->packing.compression == IMAGE_LZW ? worst_growth : 1;
    bool big = (double)output->row_bytes * form->height * growth > classic_bytes;
    int rows = (int)(STRIP_BYTES / output->row_bytes);
    output->chunk_rows = rows < 1 ? 1 : rows < form->height ? rows : form->height;
    self->tiff.stream = output->stream;
    TRY(imageoutput_check_seekable(output, err));
    return tiff_open(&self->tiff, "picture", big ? "wl8" : "wl") && set_fields(self)
               ? STATUS_OK
               : guard_failure(err);
}

/* If libdeflate cannot allocate memory, libtiff falls back to zlib, whose output has other bytes.
 * The guard detects this by errno and reports STATUS_MEMORY. */
static Status write_strip(void *work, Err *err)
{
    TiffWriter *self = work;
    ImageOutput *output = &self->output;
    tmsize_t size = (tmsize_t)((size_t)output->n * output->row_bytes);
    return TIFFWriteEncodedStrip(self->tiff.handle, self->next++, output->chunk, size) == size
               ? STATUS_OK
               : guard_failure(err);
}

static Status end(void *work, Err *err)
{
    const TiffWriter *self = work;
    return TIFFWriteDirectory(self->tiff.handle) == 1 ? STATUS_OK : guard_failure(err);
}

/* TIFFCleanup also writes data that libtiff still buffers. */
static void release(void *work)
{
    TiffWriter *self = work;
    if (self->tiff.handle && !self->output.guard.failed)
        TIFFCleanup(self->tiff.handle);
}

const RowEncoder tiff_encoder = {
    .format = "TIFF",
    .state_size = sizeof(TiffWriter),
    .begin = begin,
    .rows = write_strip,
    .end = end,
    .release = release,
    .max_ratio = 1400, /* LZW */
    .traits = {.keeps_dpi = true, .has_profile = true, .keeps_alpha = true}};
