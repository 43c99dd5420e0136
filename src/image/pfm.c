/* PFM: a three-line header and floats, rows from the bottom up; a negative scale says
 * little-endian. */
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

static Status pfm_decode(const ImageBytes *file, Image *image, Err *err)
{
    HeaderCursor cursor = {.file = *file, .at = 2};
    long long width, height;
    double scale;
    char word[32];
    if (file->size > 2 && file->bytes[2] == '4')
        return err_set(err, STATUS_INPUT,
                       "%s: is a PF4 file, of four channels; only PF and Pf can be read",
                       file->name);
    TRY(header_integer(&cursor, "width", 1, IMAGE_MAX_SIDE, &width, err));
    TRY(header_integer(&cursor, "height", 1, IMAGE_MAX_SIDE, &height, err));
    header_word(&cursor, word, sizeof word);
    if (!number_parse(word, &scale) || fabs(scale) != 1)
        return err_set(
            err, STATUS_INPUT,
            "%s: the scale is \"%s\", by which some programs multiply and others divide; "
            "only 1 and -1 can be read",
            file->name, word);
    int channels = file->bytes[1] == 'F' ? 3 : 1;
    size_t row_values = (size_t)width * (size_t)channels;
    TRY(header_end(&cursor, row_values * (size_t)height * 4, err));
    Plane made;
    TRY(plane_init(&made, (int)width, (int)height, channels, err));
    for (int y = 0; y < made.height; y++) {
        const uint8_t *from =
            file->bytes + cursor.at + (size_t)(made.height - 1 - y) * row_values * 4;
        float *to = made.values + (size_t)y * row_values;
        for (size_t i = 0; i < row_values; i++)
            to[i] = read_float(from + 4 * i, scale < 0);
    }
    image->plane = made;
    return STATUS_OK;
}

const ImageDecoder pfm_decoder = {.is = pfm_is, .decode = pfm_decode};

/* ------------------------------------------------------------------------------------ writing */

typedef struct PfmWriter {
    FILE *stream;
    int height;
    size_t row_values;
    off_t start;  /* of the pixels */
    uint8_t *row; /* owned */
} PfmWriter;

static void release_writer(void *self)
{
    PfmWriter *writer = self;
    if (writer)
        free(writer->row);
    free(writer);
}

static Status begin(FILE *stream, const ImageForm *form, void **self, Err *err)
{
    PfmWriter *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *self = writer;
    *writer = (PfmWriter){.stream = stream,
                          .height = form->height,
                          .row_values = (size_t)form->width * (size_t)form->channels};
    writer->start = fprintf(stream, "%s\n%d %d\n-1.0\n", form->channels == 3 ? "PF" : "Pf",
                            form->width, form->height);
    return mem_calloc(&writer->row, writer->row_values, 4, "bytes of a row", err);
}

/* The file begins with the last row, so all but whole planes need a file with places. */
static Status write_rows(void *self, const void *values, int first, int n, Err *err)
{
    PfmWriter *writer = self;
    off_t rows_below = writer->height - first - n;
    if (n < writer->height &&
        fseeko(writer->stream, writer->start + rows_below * (off_t)writer->row_values * 4,
               SEEK_SET) != 0)
        return err_set(err, STATUS_IO,
                       "a PFM begins with its last row, so one that does not fit into memory needs "
                       "a file, not a pipe");
    for (int y = n - 1; y >= 0; y--) {
        const float *from = (const float *)values + (size_t)y * writer->row_values;
        for (size_t i = 0; i < writer->row_values; i++)
            write_float(writer->row + 4 * i, from[i]);
        fwrite(writer->row, 4, writer->row_values, writer->stream);
    }
    return STATUS_OK;
}

const RowEncoder pfm_encoder = {
    .begin = begin, .rows = write_rows, .release = release_writer, .folds = 1, .floats = true};
