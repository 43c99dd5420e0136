/* Reads images row by row, so that pictures larger than memory can be read. An ImageReader adds two
 * things to the format's decoder: the file, and the index of the next row.
 * After the last row, the rest of the file is read as well, so that errors there are found. */
#include "image/formats.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct ImageReader {
    ImageInput *input; /* owned */
    FILE *stream;      /* owned */
    char *path;        /* owned */
    int next;          /* index of the next row */
};

Status image_fail_no_rows(const char *name, Err *err)
{
    return err_set(err, STATUS_INPUT,
                   "%s: is not a picture that can be read row by row; it must be an opaque PNG "
                   "file, or a TIFF file of one page, with 8 or 16 bits per channel",
                   name);
}

static Status choose_decoder(ImageReader *reader, const ImageDecoder **decoder, Err *err)
{
    uint8_t start[16];
    const ImageBytes file = {.bytes = start, .size = fread(start, 1, sizeof start, reader->stream)};
    if (ferror(reader->stream))
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", reader->path, strerror(errno));
    rewind(reader->stream);
    *decoder = imagedecoder_of(&file);
    return *decoder && (*decoder)->begin ? STATUS_OK : image_fail_no_rows(reader->path, err);
}

static Status begin(ImageReader *reader, const char *path, Err *err)
{
    const ImageDecoder *decoder = NULL;
    TRY(mem_strdup(&reader->path, path, err));
    TRY(file_check_regular(path, err));
    reader->stream = fopen(path, "rb");
    if (!reader->stream && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    if (!reader->stream)
        return err_set(err, STATUS_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    TRY(choose_decoder(reader, &decoder, err));
    const ImageBytes file = {.name = reader->path};
    TRY(imageinput_open(decoder, &file, reader->stream, &reader->input, err));
    return guard_run(&reader->input->guard, decoder->begin, reader->input, err);
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
    return &reader->input->form;
}

const char *imagereader_note(const ImageReader *reader, const char *key)
{
    return image_note(reader->input->form.notes, key);
}

Status imagereader_codes(ImageReader *reader, Picture *rows, Err *err)
{
    ImageInput *input = reader->input;
    const ImageForm *form = &input->form;
    assert(rows->width == form->width && rows->channels == form->channels &&
           rows->bits == form->bits && reader->next + rows->height <= form->height);
    input->rows = picture_codes(rows);
    input->n_rows = rows->height;
    TRY(guard_run(&input->guard, input->decoder->rows, input, err));
    reader->next += rows->height;
    return reader->next == form->height ? guard_run(&input->guard, input->decoder->end, input, err)
                                        : STATUS_OK;
}

void imagereader_close(ImageReader *reader)
{
    if (!reader)
        return;
    imageinput_close(reader->input);
    if (reader->stream)
        fclose(reader->stream);
    free(reader->path);
    free(reader);
}
