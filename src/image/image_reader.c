/* What a reader adds to the format's decoder: the file, and the number of the next row, so that the
 * end of the file is compared with its last row. */
#include "image/formats.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const RowDecoder *const decoders[] = {&png_rows_decoder, &tiff_rows_decoder};

struct ImageReader {
    const RowDecoder *decoder;
    void *state;
    FILE *stream;
    char *path; /* owned */
    ImageForm form;
    int next; /* row */
};

Status image_no_rows(const char *name, Err *err)
{
    return err_set(
        err, STATUS_INPUT,
        "%s: is not a picture as corcast writes them: a PNG, or a TIFF of one page, of 8 "
        "or 16 bits, opaque",
        name);
}

static Status choose_decoder(ImageReader *reader, Err *err)
{
    uint8_t start[8];
    const ImageBytes file = {.name = reader->path,
                             .bytes = start,
                             .size = fread(start, 1, sizeof start, reader->stream)};
    if (ferror(reader->stream))
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", reader->path, strerror(errno));
    rewind(reader->stream);
    for (size_t i = 0; i < sizeof decoders / sizeof *decoders && !reader->decoder; i++)
        if (decoders[i]->is(&file))
            reader->decoder = decoders[i];
    return reader->decoder ? STATUS_OK : image_no_rows(reader->path, err);
}

static Status begin(ImageReader *reader, const char *path, Err *err)
{
    TRY(mem_strdup(&reader->path, path, err));
    TRY(file_check_regular(path, err));
    reader->stream = fopen(path, "rb");
    if (!reader->stream && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    if (!reader->stream)
        return err_set(err, STATUS_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    TRY(choose_decoder(reader, err));
    return reader->decoder->begin(reader->stream, reader->path, &reader->form, &reader->state, err);
}

Status imagereader_open(ImageReader **out, const char *path, Err *err)
{
    ImageReader *reader;
    TRY(mem_calloc(&reader, 1, sizeof *reader, "readers", err));
    Status status = begin(reader, path, err);
    if (status == STATUS_OK)
        *out = reader;
    else
        imagereader_close(reader);
    return status;
}

const ImageForm *imagereader_form(const ImageReader *reader)
{
    return &reader->form;
}

const char *imagereader_note(const ImageReader *reader, const char *key)
{
    const ImageNotes *notes = reader->form.notes;
    for (int i = 0; i < notes->count; i++)
        if (strcmp(notes->notes[i].key, key) == 0)
            return notes->notes[i].text;
    return NULL;
}

Status imagereader_codes(ImageReader *reader, Picture *rows, Err *err)
{
    const ImageForm *form = &reader->form;
    void *values = rows->bits == 8 ? (void *)rows->codes8 : (void *)rows->codes16;
    assert(rows->width == form->width && rows->channels == form->channels &&
           rows->bits == form->bits && reader->next + rows->height <= form->height);
    TRY(reader->decoder->rows(reader->state, values, rows->height, err));
    reader->next += rows->height;
    return reader->next == form->height ? reader->decoder->end(reader->state, err) : STATUS_OK;
}

void imagereader_close(ImageReader *reader)
{
    if (!reader)
        return;
    if (reader->decoder)
        reader->decoder->release(reader->state);
    if (reader->stream)
        fclose(reader->stream);
    free(reader->path);
    free(reader);
}
