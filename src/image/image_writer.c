/* Writes images row by row, in any format.
 *
 * An ImageWriter adds two things to the format's encoder: the file, which has a temporary name
 * until it is complete, and the index of the next row. Whole pictures and planes are written in one
 * step. */
#include "image/formats.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct ImageWriter {
    const RowEncoder *encoder;
    ImageOutput *output; /* owned */
    OutFile file;
    char *path;     /* owned; for errors */
    ImageForm form; /* form of the rows that the caller passes */
    int next;       /* index of the next row */
    Picture inked;  /* owned; a row of inks; empty unless colors are converted to inks */
    Picture colors; /* owned; the colors of a row that has black ink as its fourth channel */
};

const char *image_note(const ImageNotes *notes, const char *key)
{
    for (int i = 0; notes && i < notes->count; i++)
        if (strcmp(notes->notes[i].key, key) == 0)
            return notes->notes[i].text;
    return NULL;
}

/* ---- encoders -------------------------------------------------------------------------------- */

/* Sets output->description to the texts of all notes, one per line, except Software and Shard,
 * which formats store in fields of their own. */
static Status describe(ImageOutput *output, Err *err)
{
    const ImageNotes *notes = output->form.notes;
    Text lines = TEXT_INIT;
    for (int i = 0, n = 0; notes && i < notes->count; i++)
        if (strcmp(notes->notes[i].key, "Software") != 0 &&
            strcmp(notes->notes[i].key, "Shard") != 0)
            text_printf(&lines, "%s%s", n++ ? "\n" : "", notes->notes[i].text);
    Status status = text_take(&lines, &output->description, err);
    text_release(&lines);
    return status;
}

/* A GuardedWork. */
static Status release_encoder(void *self, Err *err)
{
    (void)err;
    ImageOutput *output = self;
    output->encoder->release(output);
    return STATUS_OK;
}

static void free_output(ImageOutput *output)
{
    if (!output)
        return;
    if (output->encoder->release)
        (void)!guard_run(&output->guard, release_encoder, output, NULL);
    free(output->profile.bytes);
    free(output->description);
    free(output->chunk);
    free(output->row);
    free(output);
}

static Status begin_output(ImageOutput *output, Err *err)
{
    const ImageForm *form = &output->form;
    output->row_bytes = (size_t)form->width * (size_t)form->channels * (size_t)form->bits / 8;
    if (output->encoder->traits.has_profile) {
        TRY(image_profile(form, &output->profile, err));
        TRY(describe(output, err));
    }
    TRY(guard_run(&output->guard, output->encoder->begin, output, err));
    return output->chunk_rows ? mem_calloc(&output->chunk, (size_t)output->chunk_rows,
                                           output->row_bytes, "rows of a file", err)
                              : STATUS_OK;
}

/* Creates the state of an encoder and writes the part of the file before the rows. *out is set on
 * success only; free it with free_output. */
static Status open_output(const RowEncoder *encoder, FILE *stream, const ImageForm *form,
                          ImageOutput **out, Err *err)
{
    ImageOutput *output;
    TRY(mem_calloc(&output, 1, encoder->state_size, "writers", err));
    output->guard.format = encoder->format;
    output->guard.stream = stream;
    output->encoder = encoder;
    output->stream = stream;
    output->form = *form;
    Status status;
    TRY_GOTO(begin_output(output, err));
    *out = output;
    return STATUS_OK;
done:
    free_output(output);
    return status;
}

static Status encode(ImageOutput *output, const void *values, int n, Err *err)
{
    output->values = values;
    output->n = n;
    TRY(guard_run(&output->guard, output->encoder->rows, output, err));
    output->first += n;
    return STATUS_OK;
}

/* Writes the next `n` rows, or gathers them until a chunk is full. */
static Status put_rows(ImageOutput *output, const void *values, int n, Err *err)
{
    if (!output->chunk)
        return encode(output, values, n, err);
    for (int y = 0; y < n; y++) {
        memcpy(output->chunk + (size_t)output->n_gathered++ * output->row_bytes,
               (const uint8_t *)values + (size_t)y * output->row_bytes, output->row_bytes);
        if (output->n_gathered < output->chunk_rows &&
            output->first + output->n_gathered < output->form.height)
            continue;
        TRY(encode(output, output->chunk, output->n_gathered, err));
        output->n_gathered = 0;
    }
    return STATUS_OK;
}

static Status end_output(ImageOutput *output, Err *err)
{
    return output->encoder->end ? guard_run(&output->guard, output->encoder->end, output, err)
                                : STATUS_OK;
}

Status imageoutput_check_seekable(const ImageOutput *output, Err *err)
{
    if (fseeko(output->stream, 0, SEEK_CUR) == 0)
        return STATUS_OK;
    return err_set(err, STATUS_IO, "the format %s needs a file, not a pipe",
                   output->encoder->format);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Returns the encoder for the extension of a path; NULL if no encoder has the extension. */
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

ImageTraits image_traits(const char *path)
{
    const RowEncoder *encoder = encoder_of(path);
    return encoder ? encoder->traits : (ImageTraits){0};
}

static Status check_inks(const char *path, const ImageForm *form, const RowEncoder *encoder,
                         Err *err)
{
    if (!form->packing.inks)
        return STATUS_OK;
    if (!encoder->traits.has_profile)
        return err_set(err, STATUS_USAGE, "%s: an output profile (CMYK) needs a .tif or .jpg",
                       path);
    if (form->channels < 3)
        return err_set(err, STATUS_USAGE,
                       "%s: an output profile (CMYK) needs an opaque picture in color", path);
    assert(inks_bits(form->packing.inks) == form->bits && form->encoding == ENCODING_SRGB);
    return STATUS_OK;
}

static Status choose_encoder(const char *path, const ImageForm *form, const RowEncoder **encoder,
                             Err *err)
{
    *encoder = encoder_of(path);
    if (form->bits == 32 && *encoder != &exr_encoder)
        *encoder = &pfm_encoder;
    if (!*encoder || (*encoder)->traits.floats != (form->bits == 32))
        return err_set(err, STATUS_USAGE,
                       "%s: the extension of a picture must be .ppm, .pgm, .png, .tif or .jpg",
                       path);
    if (form->channels == 4 && !(*encoder)->traits.keeps_alpha && !form->named &&
        !form->packing.inks)
        return err_set(err, STATUS_USAGE, "%s: a transparent picture must be .png, .tif or .exr",
                       path);
    if (*encoder == &pgm_encoder && form->channels != 1)
        return err_set(err, STATUS_USAGE,
                       "%s: a color picture cannot be a .pgm; use .ppm, .png, .tif or .jpg", path);
    if (*encoder == &pfm_encoder && form->channels != 1 && form->channels != 3)
        return err_set(err, STATUS_USAGE, "%s: PFM holds 1 or 3 channels, not %d", path,
                       form->channels);
    return check_inks(path, form, *encoder, err);
}

/* Checks that the disk has space for the file at the best compression, and starts the encoder. */
static Status begin(ImageWriter *writer, Err *err)
{
    const RowEncoder *encoder = writer->encoder;
    ImageForm form = writer->form; /* of the file */
    int channels = encoder->channels ? encoder->channels : form.channels;
    double bytes = (double)form.width * form.height * channels * form.bits / 8;
    if (encoder->max_ratio > 0)
        TRY(outfile_check_space(&writer->file, bytes / encoder->max_ratio, err));
    if (form.packing.inks) {
        form.channels = 4;
        TRY(picture_init(&writer->inked, form.width, 1, 4, form.bits, err));
        TRY(picture_init(&writer->colors, form.width, 1, 3, form.bits, err));
    }
    Status status = open_output(encoder, writer->file.stream, &form, &writer->output, err);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", writer->path);
    return status;
}

Status imagewriter_open(ImageWriter **out, const char *path, const ImageForm *form, Err *err)
{
    const RowEncoder *encoder = NULL;
    ImageWriter *writer = NULL;
    Status status;
    TRY(choose_encoder(path, form, &encoder, err));
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *writer = (ImageWriter){.encoder = encoder, .form = *form};
    TRY_GOTO(mem_strdup(&writer->path, path, err));
    TRY_GOTO(outfile_open(&writer->file, path, err));
    TRY_GOTO(begin(writer, err));
    *out = writer;
    return STATUS_OK;
done:
    imagewriter_discard(writer);
    return status;
}

/* Frees the writer and its buffers, but not its encoder's state and its file. */
static void release(ImageWriter *writer)
{
    picture_release(&writer->inked);
    picture_release(&writer->colors);
    free(writer->path);
    free(writer);
}

/* Copies the three colors of a row whose fourth channel is black ink. `first` is the index of the
 * row's first code. */
static const void *without_black(ImageWriter *writer, const Picture *rows, size_t first)
{
    for (size_t i = 0; i < 3 * (size_t)rows->width; i++)
        picture_set(&writer->colors, i, picture_code(rows, first + i / 3 * 4 + i % 3));
    return picture_codes(&writer->colors);
}

/* Adds the separate black channel to the inks of a row. Where black is 100 %, the other inks become
 * 0. */
static void print_black(ImageWriter *writer, const Picture *rows, size_t first)
{
    const uint64_t full = (1u << rows->bits) - 1;
    for (size_t i = 0; i < 4 * (size_t)rows->width; i++) {
        const uint64_t black = picture_code(rows, first + i / 4 * 4 + 3);
        const uint64_t ink = picture_code(&writer->inked, i) * (full - black);
        const uint64_t own = i % 4 == 3 ? black * full : 0;
        if (black > 0)
            picture_set(&writer->inked, i, (uint16_t)((ink + own + full / 2) / full));
    }
}

/* Converts the colors of rows to inks, and writes the rows one by one. */
static Status write_inked(ImageWriter *writer, const Picture *rows, Err *err)
{
    const bool black = rows->channels == 4;
    for (int y = 0; y < rows->height; y++) {
        const size_t first = (size_t)y * picture_stride(rows);
        const void *row = (const uint8_t *)picture_codes(rows) + first * (size_t)rows->bits / 8;
        inks_convert(writer->form.packing.inks, black ? without_black(writer, rows, first) : row,
                     picture_codes(&writer->inked), (size_t)rows->width);
        if (black)
            print_black(writer, rows, first);
        TRY(put_rows(writer->output, picture_codes(&writer->inked), 1, err));
    }
    return STATUS_OK;
}

/* Ends the writing of `n` rows with this status. Adds the path to the message of an error. */
static Status end_rows(ImageWriter *writer, int n, Status status, Err *err)
{
    const bool failed = status == STATUS_OK && ferror(writer->file.stream);
    writer->next += n;
    if (failed)
        status = err_set(err, STATUS_IO, "writing failed: %s", strerror(errno));
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", writer->path);
    return status;
}

Status imagewriter_codes(ImageWriter *writer, const Picture *rows, Err *err)
{
    assert(rows->width == writer->form.width && rows->channels == writer->form.channels &&
           rows->bits == writer->form.bits && writer->next + rows->height <= writer->form.height);
    return end_rows(writer, rows->height,
                    writer->form.packing.inks
                        ? write_inked(writer, rows, err)
                        : put_rows(writer->output, picture_codes(rows), rows->height, err),
                    err);
}

Status imagewriter_floats(ImageWriter *writer, const Plane *rows, Err *err)
{
    assert(rows->width == writer->form.width && rows->channels == writer->form.channels &&
           writer->form.bits == 32 && writer->next + rows->height <= writer->form.height);
    return end_rows(writer, rows->height, put_rows(writer->output, rows->values, rows->height, err),
                    err);
}

/* An encoder may still write to the file when it is released, so the file is closed last. */
Status imagewriter_commit(ImageWriter *writer, Err *err)
{
    assert(writer->next == writer->form.height);
    Status status = end_output(writer->output, err);
    free_output(writer->output);
    if (status != STATUS_OK) {
        err_prefix(err, "%s: ", writer->path);
        outfile_discard(&writer->file);
    } else {
        status = outfile_commit(&writer->file, err);
    }
    release(writer);
    return status;
}

void imagewriter_discard(ImageWriter *writer)
{
    if (!writer)
        return;
    free_output(writer->output);
    outfile_discard(&writer->file);
    release(writer);
}

/* ---- whole images ---------------------------------------------------------------------------- */

static ImageForm form_of(const Picture *picture, Encoding encoding, const ImageNotes *notes)
{
    return (ImageForm){.width = picture->width,
                       .height = picture->height,
                       .channels = picture->channels,
                       .bits = picture->bits,
                       .encoding = encoding,
                       .notes = notes};
}

/* Commits the file of a whole image if `status` is STATUS_OK; otherwise discards the file. */
static Status finish(ImageWriter *writer, Status status, Err *err)
{
    if (status != STATUS_OK) {
        imagewriter_discard(writer);
        return status;
    }
    return imagewriter_commit(writer, err);
}

Status picture_write(const Picture *picture, const char *path, Encoding encoding,
                     const ImageNotes *notes, const ImagePacking *packing, Err *err)
{
    ImageForm form = form_of(picture, encoding, notes);
    ImageWriter *writer;
    if (packing)
        form.packing = *packing;
    TRY(imagewriter_open(&writer, path, &form, err));
    return finish(writer, imagewriter_codes(writer, picture, err), err);
}

Status plane_write(const Plane *plane, const char *path, const ImagePacking *packing, Err *err)
{
    ImageForm form = {
        .width = plane->width, .height = plane->height, .channels = plane->channels, .bits = 32};
    ImageWriter *writer;
    if (packing)
        form.packing = *packing;
    TRY(imagewriter_open(&writer, path, &form, err));
    return finish(writer, imagewriter_floats(writer, plane, err), err);
}

/* Writes the PNG file to a stream. */
static Status stream_png(const Picture *picture, const ImageForm *form, FILE *stream, Err *err)
{
    ImageOutput *output = NULL;
    Status status;
    TRY_GOTO(open_output(&png_encoder, stream, form, &output, err));
    TRY_GOTO(put_rows(output, picture_codes(picture), picture->height, err));
    status = end_output(output, err);
done:
    free_output(output);
    return status;
}

Status picture_to_png(const Picture *picture, Encoding encoding, const ImageNotes *notes, Text *out,
                      Err *err)
{
    const ImageForm form = form_of(picture, encoding, notes);
    char *bytes = NULL;
    size_t size = 0;
    Status status;
    FILE *stream = open_memstream(&bytes, &size);
    if (!stream)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG: %s", strerror(errno));
    status = stream_png(picture, &form, stream, err);
    /* fclose moves the bytes to a block of their own. If that fails, `bytes` is NULL. */
    bool closed = fclose(stream) == 0 && bytes;
    TRY_GOTO(status);
    if (closed)
        text_append(out, bytes, size);
    status =
        closed ? text_check(out, err)
               : err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG of %zu bytes", size);
done:
    free(bytes);
    return status;
}

Status picture_put_uri(const Picture *picture, Text *out, Err *err)
{
    Text png = TEXT_INIT;
    Status status;
    TRY_GOTO(picture_to_png(picture, ENCODING_SRGB, NULL, &png, err));
    text_puts(out, "data:image/png;base64,");
    text_base64(out, text_chars(&png), png.length);
done:
    text_release(&png);
    return status;
}
