/* PFM: a three-line header and floats, rows from the bottom up; a negative scale says
 * little-endian. */
#include "image/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool pfm_is(const ImageBytes *file)
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

Status pfm_decode(const ImageBytes *file, Plane *plane, Err *err)
{
    HeaderCursor cursor = {.file = *file, .at = 2};
    long long width, height;
    double scale;
    char word[32];
    TRY(header_integer(&cursor, "width", 1, IMAGE_MAX_SIDE, &width, err));
    TRY(header_integer(&cursor, "height", 1, IMAGE_MAX_SIDE, &height, err));
    header_word(&cursor, word, sizeof word);
    if (!number_parse(word, &scale) || !isfinite(scale) || scale == 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the scale is \"%s\"; it must be a number other than 0", file->name,
                       word);
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
    *plane = made;
    return STATUS_OK;
}

Status plane_write(const Plane *plane, const char *path, Err *err)
{
    if (plane->channels != 1 && plane->channels != 3)
        return err_set(err, STATUS_USAGE, "%s: PFM holds 1 or 3 channels, not %d", path,
                       plane->channels);
    size_t row_values = (size_t)plane->width * (size_t)plane->channels;
    uint8_t *row;
    TRY(mem_calloc(&row, row_values, 4, "bytes of a row", err));
    OutFile file;
    Status status = outfile_open(&file, path, err);
    if (status == STATUS_OK) {
        fprintf(file.stream, "%s\n%d %d\n-1.0\n", plane->channels == 3 ? "PF" : "Pf", plane->width,
                plane->height);
        for (int y = plane->height - 1; y >= 0; y--) {
            const float *from = plane->values + (size_t)y * row_values;
            for (size_t i = 0; i < row_values; i++)
                write_float(row + 4 * i, from[i]);
            fwrite(row, 4, row_values, file.stream);
        }
        status = outfile_commit(&file, err);
    }
    free(row);
    return status;
}
