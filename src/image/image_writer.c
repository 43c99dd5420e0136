/* What a writer adds to the format's encoder: the file, under a temporary name until it is whole,
 * and the number of the next row. Whole pictures and planes go the same way in one step. */
#include "image/formats.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct ImageWriter {
    const RowEncoder *encoder;
    void *state;
    OutFile file;
    char *path;      /* owned; for sentences */
    ImageForm form;  /* of what is handed over */
    int next;        /* row */
    void *inked_row; /* owned; NULL unless colours become inks */
};

const char *image_note(const ImageNotes *notes, const char *key)
{
    for (int i = 0; notes && i < notes->count; i++)
        if (strcmp(notes->notes[i].key, key) == 0)
            return notes->notes[i].text;
    return NULL;
}

Status image_description(const ImageNotes *notes, char **text, Err *err)
{
    Text lines = TEXT_INIT;
    for (int i = 0, n = 0; notes && i < notes->count; i++)
        if (strcmp(notes->notes[i].key, "Software") != 0 &&
            strcmp(notes->notes[i].key, "Shard") != 0)
            text_printf(&lines, "%s%s", n++ ? "\n" : "", notes->notes[i].text);
    Status status = text_take(&lines, text, err);
    text_release(&lines);
    return status;
}

/* NULL when the extension is none of theirs. */
static const RowEncoder *encoder_of(const char *path)
{
    static const struct {
        const char *extension;
        const RowEncoder *encoder;
    } formats[] = {{"ppm", &ppm_encoder},   {"pgm", &pgm_encoder},   {"png", &png_encoder},
                   {"tif", &tiff_encoder},  {"tiff", &tiff_encoder}, {"jpg", &jpeg_encoder},
                   {"jpeg", &jpeg_encoder}, {"pfm", &pfm_encoder},   {"exr", &exr_encoder}};
    const char *extension = strcmp(path, "-") ? file_extension(path) : "ppm";
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(formats[i].extension, extension) == 0)
            return formats[i].encoder;
    return NULL;
}

bool image_keeps_dpi(const char *path)
{
    const RowEncoder *encoder = encoder_of(path);
    return encoder && encoder->keeps_dpi;
}

bool image_keeps_inks(const char *path)
{
    const RowEncoder *encoder = encoder_of(path);
    return encoder && encoder->keeps_inks;
}

bool image_keeps_alpha(const char *path)
{
    const RowEncoder *encoder = encoder_of(path);
    return encoder && encoder->keeps_alpha;
}

bool image_is_floats(const char *path)
{
    const RowEncoder *encoder = encoder_of(path);
    return encoder && encoder->floats;
}

static Status check_inks(const char *path, const ImageForm *form, const RowEncoder *encoder,
                         Err *err)
{
    if (!form->packing.inks)
        return STATUS_OK;
    if (!encoder->keeps_inks)
        return err_set(err, STATUS_USAGE, "%s: only .tif and .jpg hold colours of a press", path);
    if (form->channels != 3)
        return err_set(err, STATUS_USAGE, "%s: only opaque pictures in colour go to a press", path);
    assert(inks_bits(form->packing.inks) == form->bits && form->encoding == ENCODING_SRGB);
    return STATUS_OK;
}

static Status choose_encoder(const char *path, const ImageForm *form, const RowEncoder **encoder,
                             Err *err)
{
    *encoder = encoder_of(path);
    if (form->bits == 32 && *encoder != &exr_encoder)
        *encoder = &pfm_encoder;
    if (!*encoder || (*encoder)->floats != (form->bits == 32))
        return err_set(err, STATUS_USAGE,
                       "%s: the extension of a picture must be .ppm, .pgm, .png, .tif or .jpg",
                       path);
    if (form->channels == 4 && !(*encoder)->keeps_alpha && !form->named)
        return err_set(err, STATUS_USAGE, "%s: a transparent picture must be .png, .tif or .exr",
                       path);
    if (*encoder == &pgm_encoder && form->channels != 1)
        return err_set(err, STATUS_USAGE,
                       "%s: a colour picture cannot be a .pgm; use .ppm, .png, .tif or .jpg", path);
    if (*encoder == &pfm_encoder && form->channels != 1 && form->channels != 3)
        return err_set(err, STATUS_USAGE, "%s: PFM holds 1 or 3 channels, not %d", path,
                       form->channels);
    return check_inks(path, form, *encoder, err);
}

static Status begin(ImageWriter *writer, Err *err)
{
    ImageForm form = writer->form; /* as the file has it */
    int channels = writer->encoder == &ppm_encoder ? 3 : form.channels;
    double bytes = (double)form.width * form.height * channels * form.bits / 8;
    if (writer->encoder->folds > 0)
        TRY(outfile_check_room(&writer->file, bytes / writer->encoder->folds, err));
    if (form.packing.inks) {
        form.channels = 4;
        TRY(mem_calloc(&writer->inked_row, (size_t)form.width, (size_t)form.bits / 2,
                       "bytes of a row", err));
    }
    Status status = writer->encoder->begin(writer->file.stream, &form, &writer->state, err);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", writer->path);
    return status;
}

Status imagewriter_open(ImageWriter **out, const char *path, const ImageForm *form, Err *err)
{
    const RowEncoder *encoder = NULL;
    TRY(choose_encoder(path, form, &encoder, err));
    ImageWriter *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *writer = (ImageWriter){.encoder = encoder, .form = *form};
    Status status = mem_strdup(&writer->path, path, err);
    if (status == STATUS_OK)
        status = outfile_open(&writer->file, path, err);
    if (status == STATUS_OK)
        status = begin(writer, err);
    if (status != STATUS_OK) {
        imagewriter_discard(writer);
        return status;
    }
    *out = writer;
    return STATUS_OK;
}

static void release(ImageWriter *writer)
{
    free(writer->inked_row);
    free(writer->path);
    free(writer);
}

/* Row by row, in the colours of the press. */
static Status write_inked(ImageWriter *writer, const uint8_t *values, int n, Err *err)
{
    const ImageForm *form = &writer->form;
    size_t row_bytes = (size_t)form->width * (size_t)form->channels * (size_t)form->bits / 8;
    for (int y = 0; y < n; y++) {
        inks_convert(form->packing.inks, values + (size_t)y * row_bytes, writer->inked_row,
                     (size_t)form->width);
        TRY(writer->encoder->rows(writer->state, writer->inked_row, writer->next + y, 1, err));
    }
    return STATUS_OK;
}

static Status write_rows(ImageWriter *writer, const void *values, int n, Err *err)
{
    assert(n >= 0 && writer->next + n <= writer->form.height);
    Status status = writer->inked_row
                        ? write_inked(writer, values, n, err)
                        : writer->encoder->rows(writer->state, values, writer->next, n, err);
    writer->next += n;
    if (status == STATUS_OK && ferror(writer->file.stream))
        status = err_set(err, STATUS_IO, "writing failed: %s", strerror(errno));
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", writer->path);
    return status;
}

Status imagewriter_codes(ImageWriter *writer, const Picture *rows, Err *err)
{
    assert(rows->width == writer->form.width && rows->channels == writer->form.channels &&
           rows->bits == writer->form.bits);
    const void *values = rows->bits == 8 ? (const void *)rows->codes8 : (const void *)rows->codes16;
    return write_rows(writer, values, rows->height, err);
}

Status imagewriter_floats(ImageWriter *writer, const Plane *rows, Err *err)
{
    assert(rows->width == writer->form.width && rows->channels == writer->form.channels &&
           writer->form.bits == 32);
    return write_rows(writer, rows->values, rows->height, err);
}

/* An encoder's last words go to the file, so it is released first. */
Status imagewriter_commit(ImageWriter *writer, Err *err)
{
    assert(writer->next == writer->form.height);
    const RowEncoder *encoder = writer->encoder;
    Status status = encoder->end ? encoder->end(writer->state, err) : STATUS_OK;
    encoder->release(writer->state);
    if (status == STATUS_OK) {
        status = outfile_commit(&writer->file, err);
    } else {
        err_prefix(err, "%s: ", writer->path);
        outfile_discard(&writer->file);
    }
    release(writer);
    return status;
}

void imagewriter_discard(ImageWriter *writer)
{
    if (!writer)
        return;
    writer->encoder->release(writer->state);
    outfile_discard(&writer->file);
    release(writer);
}

static ImageForm form_of(const Picture *picture, Encoding encoding, const ImageNotes *notes)
{
    return (ImageForm){.width = picture->width,
                       .height = picture->height,
                       .channels = picture->channels,
                       .bits = picture->bits,
                       .encoding = encoding,
                       .notes = notes};
}

/* The last step of writing a whole image. */
static Status finish(ImageWriter *writer, Status status, Err *err)
{
    if (status == STATUS_OK)
        return imagewriter_commit(writer, err);
    imagewriter_discard(writer);
    return status;
}

Status picture_write(const Picture *picture, const char *path, Encoding encoding,
                     const ImageNotes *notes, Err *err)
{
    return picture_write_packed(picture, path, encoding, notes, (ImagePacking){0}, err);
}

Status picture_write_packed(const Picture *picture, const char *path, Encoding encoding,
                            const ImageNotes *notes, ImagePacking packing, Err *err)
{
    ImageForm form = form_of(picture, encoding, notes);
    form.packing = packing;
    ImageWriter *writer;
    TRY(imagewriter_open(&writer, path, &form, err));
    return finish(writer, imagewriter_codes(writer, picture, err), err);
}

Status plane_write(const Plane *plane, const char *path, Err *err)
{
    return plane_write_packed(plane, path, (ImagePacking){0}, err);
}

Status plane_write_packed(const Plane *plane, const char *path, ImagePacking packing, Err *err)
{
    const ImageForm form = {.width = plane->width,
                            .height = plane->height,
                            .channels = plane->channels,
                            .bits = 32,
                            .packing = packing};
    ImageWriter *writer;
    TRY(imagewriter_open(&writer, path, &form, err));
    return finish(writer, imagewriter_floats(writer, plane, err), err);
}

Status picture_to_png(const Picture *picture, Encoding encoding, const ImageNotes *notes, Text *out,
                      Err *err)
{
    const ImageForm form = form_of(picture, encoding, notes);
    const void *codes =
        picture->bits == 8 ? (const void *)picture->codes8 : (const void *)picture->codes16;
    char *bytes = NULL;
    size_t size = 0;
    void *state = NULL;
    FILE *stream = open_memstream(&bytes, &size);
    if (!stream)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG: %s", strerror(errno));
    Status status = png_encoder.begin(stream, &form, &state, err);
    if (status == STATUS_OK)
        status = png_encoder.rows(state, codes, 0, picture->height, err);
    if (status == STATUS_OK)
        status = png_encoder.end(state, err);
    png_encoder.release(state);
    /* Closing gives the bytes a block of their own, and tells only by NULL that there was no
     * room. */
    if ((fclose(stream) != 0 || !bytes) && status == STATUS_OK)
        status = err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG of %zu bytes", size);
    if (status == STATUS_OK) {
        text_append(out, bytes, size);
        status = text_check(out, err);
    }
    free(bytes);
    return status;
}
