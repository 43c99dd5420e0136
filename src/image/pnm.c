/* Reads PBM, PGM, PPM and PAM, binary and plain (decimal digits), and writes binary PGM and PPM
 * [netpbm: pbm(5), pgm(5), ppm(5), pam(5)]. The size of a binary file must match its header
 * exactly. In a plain file every sample
 * takes at least two characters, in a plain PBM at least one. A header that states more samples is
 * refused before memory is allocated. */
#include "image/formats.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static bool pnm_is(const ImageBytes *file)
{
    return file->size >= 2 && file->bytes[0] == 'P' && memchr("1234567", file->bytes[1], 7);
}

typedef struct PnmHeader {
    int width, height, channels;
    unsigned maximum; /* maxval */
    bool plain;
    bool bits; /* PBM: a bit per pixel, 1 for black */
} PnmHeader;

static Status read_header(HeaderCursor *cursor, PnmHeader *header, Err *err)
{
    char kind = (char)cursor->file.bytes[1];
    cursor->at = 2;
    long long width, height, maximum = 1;
    const bool bits = kind == '1' || kind == '4';
    TRY(header_integer(cursor, "width", 1, IMAGE_MAX_SIDE, &width, err));
    TRY(header_integer(cursor, "height", 1, IMAGE_MAX_SIDE, &height, err));
    if (!bits)
        TRY(header_integer(cursor, "largest value", 1, 65535, &maximum, err));
    *header = (PnmHeader){.width = (int)width,
                          .height = (int)height,
                          .channels = kind == '3' || kind == '6' ? 3 : 1,
                          .maximum = (unsigned)maximum,
                          .plain = kind <= '3',
                          .bits = bits};
    return STATUS_OK;
}

/* Reads the number in a line of a PAM header that begins with `key`. */
static Status read_key(HeaderCursor *cursor, const char *key, PnmHeader *header, Err *err)
{
    static const char *const keys[] = {"WIDTH", "HEIGHT", "DEPTH", "MAXVAL"};
    long long value;
    size_t i = 0;
    while (i < 4 && strcmp(key, keys[i]) != 0)
        i++;
    if (i == 4)
        return err_set(err, STATUS_INPUT,
                       "%s: its header has the line \"%s\", which is not part of PAM",
                       cursor->file.name, key);
    TRY(header_integer(cursor, key, 1, i < 2 ? IMAGE_MAX_SIDE : i == 2 ? 4 : 65535, &value, err));
    if (i == 3)
        header->maximum = (unsigned)value;
    else
        *(int *[]){&header->width, &header->height, &header->channels}[i] = (int)value;
    return STATUS_OK;
}

/* Reads a PAM header. The type, TUPLTYPE, must fit the number of channels. BLACKANDWHITE is grey
 * with a maximum of 1; only the suffix, "" or "_ALPHA", is compared. */
static Status read_pam_header(HeaderCursor *cursor, PnmHeader *header, Err *err)
{
    char key[32], type[32] = "";
    cursor->at = 2;
    *header = (PnmHeader){0};
    for (header_word(cursor, key, sizeof key); *key && strcmp(key, "ENDHDR") != 0;
         header_word(cursor, key, sizeof key))
        if (strcmp(key, "TUPLTYPE") == 0)
            header_word(cursor, type, sizeof type);
        else
            TRY(read_key(cursor, key, header, err));
    if (!header->width || !header->height || !header->channels || !header->maximum)
        return err_set(err, STATUS_INPUT,
                       "%s: its header lacks WIDTH, HEIGHT, DEPTH, MAXVAL or ENDHDR",
                       cursor->file.name);
    static const char *const types[] = {NULL, "GRAYSCALE", "GRAYSCALE_ALPHA", "RGB", "RGB_ALPHA"};
    static const char black[] = "BLACKANDWHITE", grey[] = "GRAYSCALE";
    const bool is_black = strncmp(type, black, strlen(black)) == 0;
    const char *expected = types[header->channels];
    bool fits = *type ? strcmp(type, expected) == 0 : header->channels % 2 == 1;
    if (is_black)
        fits = header->channels <= 2 && strcmp(type + strlen(black), expected + strlen(grey)) == 0;
    if (fits)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: has %d samples per pixel of the kind \"%s\"; only GRAYSCALE, RGB, "
                   "BLACKANDWHITE and these with _ALPHA can be read",
                   cursor->file.name, header->channels, type);
}

static size_t sample_count(const PnmHeader *header)
{
    return (size_t)header->width * (size_t)header->height * (size_t)header->channels;
}

static size_t bytes_of_pixels(const PnmHeader *header)
{
    if (header->bits)
        return ((size_t)header->width + 7) / 8 * (size_t)header->height;
    return sample_count(header) * (header->maximum > 255 ? 2 : 1);
}

/* Reads packed bits (PBM), or big-endian samples of 1 or 2 bytes. */
static Status read_binary(HeaderCursor *cursor, const PnmHeader *header, Picture *picture, Err *err)
{
    const uint8_t *at = cursor->file.bytes + cursor->at;
    size_t n = sample_count(header), row_bytes = ((size_t)header->width + 7) / 8;
    if (header->bits) {
        for (size_t i = 0; i < n; i++) {
            size_t x = i % (size_t)header->width, y = i / (size_t)header->width;
            picture_set(picture, i, at[y * row_bytes + x / 8] >> (7 - x % 8) & 1 ? 0 : 1);
        }
        return STATUS_OK;
    }
    if (header->maximum == 255) {
        memcpy(picture->codes8, at, n);
        return STATUS_OK;
    }
    for (size_t i = 0; i < n; i++) {
        unsigned code = header->maximum > 255 ? at[2 * i] * 256u + at[2 * i + 1] : at[i];
        if (code > header->maximum)
            return err_set(err, STATUS_INPUT, "%s: holds the value %u, which is above MAXVAL, %u",
                           cursor->file.name, code, header->maximum);
        picture_set(picture, i, (uint16_t)code);
    }
    return STATUS_OK;
}

/* Reads the next digit of a plain PBM. Digits need not be separated by blanks. */
static Status read_digit(HeaderCursor *cursor, long long *code, Err *err)
{
    const ImageBytes *file = &cursor->file;
    while (cursor->at < file->size && isspace(file->bytes[cursor->at]))
        cursor->at++;
    if (cursor->at == file->size)
        return err_set(err, STATUS_INPUT, "%s: ends before the value of a pixel", file->name);
    char digit = (char)file->bytes[cursor->at++];
    if (digit != '0' && digit != '1')
        return err_set(err, STATUS_INPUT, "%s: the value of a pixel must be 0 or 1", file->name);
    *code = digit == '0';
    return STATUS_OK;
}

/* Reads the pixels of a file in which they are decimal numbers. */
static Status read_plain(HeaderCursor *cursor, const PnmHeader *header, Picture *picture, Err *err)
{
    size_t n = sample_count(header);
    for (size_t i = 0; i < n; i++) {
        long long code;
        TRY(header->bits
                ? read_digit(cursor, &code, err)
                : header_integer(cursor, "value of a pixel", 0, header->maximum, &code, err));
        picture_set(picture, i, (uint16_t)code);
    }
    char word[32];
    header_word(cursor, word, sizeof word);
    if (*word)
        return err_set(err, STATUS_INPUT, "%s: \"%s\" follows its last pixel", cursor->file.name,
                       word);
    return STATUS_OK;
}

/* Rescales codes of 0 to `maximum` to the bits of the picture. */
static void rescale(Picture *picture, unsigned maximum)
{
    unsigned max_code = picture->bits == 8 ? 255 : 65535;
    if (max_code == maximum)
        return;
    size_t n = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    for (size_t i = 0; i < n; i++)
        picture_set(picture, i,
                    (uint16_t)((picture_code(picture, i) * max_code + maximum / 2) / maximum));
}

static Status decode(void *work, Err *err)
{
    ImageInput *input = work;
    const ImageBytes *file = &input->file;
    Picture *picture = &input->image.picture;
    HeaderCursor cursor = {.file = *file};
    PnmHeader header;
    TRY(file->bytes[1] == '7' ? read_pam_header(&cursor, &header, err)
                              : read_header(&cursor, &header, err));
    size_t n = sample_count(&header);
    if (!header.plain)
        TRY(header_end(&cursor, bytes_of_pixels(&header), err));
    else if (file->size - cursor.at < (header.bits ? n : 2 * n))
        return err_set(err, STATUS_INPUT,
                       "%s: its header announces %zu values, more than its %zu bytes can hold",
                       file->name, n, file->size);
    TRY(picture_init(picture, header.width, header.height, header.channels,
                     header.maximum > 255 ? 16 : 8, err));
    TRY(header.plain ? read_plain(&cursor, &header, picture, err)
                     : read_binary(&cursor, &header, picture, err));
    rescale(picture, header.maximum);
    return STATUS_OK;
}

const ImageDecoder pnm_decoder = {
    .format = "PNM", .state_size = sizeof(ImageInput), .is = pnm_is, .decode = decode};

/* ---- writing --------------------------------------------------------------------------------- */

typedef struct PnmWriter {
    ImageOutput output;
    /* The workspace output.row is NULL if the rows in memory have the bytes of the file. */
    int copies; /* how often the file repeats each code: 3 if a grey picture becomes a PPM, else 1
                 */
} PnmWriter;

/* The header has no comment lines, because libvips cannot read them. */
static Status begin(void *work, Err *err)
{
    PnmWriter *self = work;
    const ImageForm *form = &self->output.form;
    const int channels = self->output.encoder->channels;
    self->copies = channels / form->channels;
    fprintf(self->output.stream, "P%c\n%d %d\n%d\n", channels == 1 ? '5' : '6', form->width,
            form->height, form->bits == 16 ? 65535 : 255);
    return form->bits == 8 && self->copies == 1
               ? STATUS_OK
               : mem_calloc(&self->output.row, self->output.row_bytes, (size_t)self->copies,
                            "bytes of a row", err);
}

static Status write_rows(void *work, Err *err)
{
    (void)err;
    PnmWriter *self = work;
    const ImageOutput *output = &self->output;
    const bool deep = output->form.bits == 16;
    const size_t samples = output->row_bytes / (deep ? 2 : 1);
    const uint8_t *codes8 = output->values;
    const uint16_t *codes16 = output->values;
    if (!output->row) {
        fwrite(codes8, output->row_bytes, (size_t)output->n, output->stream);
        return STATUS_OK;
    }
    for (int y = 0; y < output->n; y++) {
        uint8_t *at = output->row;
        for (size_t i = 0; i < samples; i++) {
            uint16_t code = deep ? *codes16++ : *codes8++;
            for (int copy = 0; copy < self->copies; copy++) {
                if (deep)
                    *at++ = (uint8_t)(code >> 8);
                *at++ = (uint8_t)(code & 255);
            }
        }
        fwrite(output->row, 1, (size_t)(at - output->row), output->stream);
    }
    return STATUS_OK;
}

#define PNM_ENCODER(file_channels)                                                                 \
    {                                                                                              \
        .format = "PNM", .state_size = sizeof(PnmWriter), .begin = begin, .rows = write_rows,      \
        .channels = (file_channels), .max_ratio = 1                                                \
    }
const RowEncoder ppm_encoder = PNM_ENCODER(3), pgm_encoder = PNM_ENCODER(1);
