/* Reads and writes PFM: a header of three lines, then rows of floats from the bottom up. A negative
 * scale in the header means little-endian. */
#include "image/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

static bool pfm_is(const ImageBytes *file)
{
    return file->size >= 2 && file->bytes[0] == 'P' &&
           (file->bytes[1] == 'F' || file->bytes[1] == 'f');
}

static float read_float(const uint8_t *bytes, bool little)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)bytes[i] << 8 * (little ? i : 3 - i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void write_float(uint8_t *bytes, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(bits >> 8 * i & 255);
}

static Status decode(void *work, Err *err)
{
    ImageInput *input = work;
    const ImageBytes *file = &input->file;
    Plane *plane = &input->image.plane;
    HeaderCursor cursor = {.file = *file, .at = 2};
    long long width, height;
    double scale;
    char word[32];
    if (file->size > 2 && file->bytes[2] == '4')
        return err_set(err, STATUS_INPUT, "%s: is a PF4 file (four channels); it must be PF or Pf",
                       file->name);
    TRY(header_integer(&cursor, "width", 1, IMAGE_MAX_SIDE, &width, err));
    TRY(header_integer(&cursor, "height", 1, IMAGE_MAX_SIDE, &height, err));
    header_word(&cursor, word, sizeof word);
    if (!number_parse(word, &scale) || fabs(scale) != 1)
        return err_set(err, STATUS_INPUT,
                       "%s: the scale is \"%s\"; it must be 1 or -1, because programs disagree on "
                       "the meaning of others",
                       file->name, word);
    int channels = file->bytes[1] == 'F' ? 3 : 1;
    size_t row_values = (size_t)width * (size_t)channels;
    TRY(header_end(&cursor, row_values * (size_t)height * 4, err));
    TRY(plane_init(plane, (int)width, (int)height, channels, err));
    for (int y = 0; y < plane->height; y++) {
        const uint8_t *from =
            file->bytes + cursor.at + (size_t)(plane->height - 1 - y) * row_values * 4;
        float *to = plane->values + (size_t)y * row_values;
        for (size_t i = 0; i < row_values; i++)
            to[i] = read_float(from + 4 * i, scale < 0);
    }
    return STATUS_OK;
}

const ImageDecoder pfm_decoder = {
    .format = "PFM", .state_size = sizeof(ImageInput), .is = pfm_is, .decode = decode};

/* ---- writing --------------------------------------------------------------------------------- */

typedef struct PfmWriter {
    ImageOutput output;
    off_t start; /* offset of the pixels in the file */
} PfmWriter;

static Status begin(void *work, Err *err)
{
    PfmWriter *self = work;
    const ImageForm *form = &self->output.form;
    self->start = fprintf(self->output.stream, "%s\n%d %d\n-1.0\n",
                          form->channels == 3 ? "PF" : "Pf", form->width, form->height);
    return mem_calloc(&self->output.row, self->output.row_bytes, 1, "bytes of a row", err);
}

/* The file begins with the last row of the image. The file must therefore be seekable, unless all
 * rows are written in one call. */
static Status write_rows(void *work, Err *err)
{
    PfmWriter *self = work;
    const ImageOutput *output = &self->output;
    const int height = output->form.height;
    const size_t row_bytes = output->row_bytes, row_values = row_bytes / sizeof(float);
    off_t rows_below = height - output->first - output->n;
    if (output->n < height &&
        fseeko(output->stream, self->start + rows_below * (off_t)row_bytes, SEEK_SET) != 0)
        return err_set(err, STATUS_IO,
                       "a PFM begins with its last row; write to a file, not a pipe, if it does "
                       "not fit into memory");
    for (int y = output->n - 1; y >= 0; y--) {
        const float *from = (const float *)output->values + (size_t)y * row_values;
        for (size_t i = 0; i < row_values; i++)
            write_float(self->output.row + 4 * i, from[i]);
        fwrite(self->output.row, 1, row_bytes, output->stream);
    }
    return STATUS_OK;
}

const RowEncoder pfm_encoder = {.format = "PFM",
                                .state_size = sizeof(PfmWriter),
                                .begin = begin,
                                .rows = write_rows,
                                .max_ratio = 1,
                                .traits = {.floats = true}};
