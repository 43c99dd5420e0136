/* The common PNG at the speed of memory: 8 or 16 bits, no palette, not interlaced. The compressed
 * chunks are put end to end and inflated at once by libdeflate, straight into the picture when its
 * rows have the form of the file's; undoing the filters then moves each row down over the filter
 * bytes before it, so that no second copy is held.
 *
 * Whatever is unusual or wrong is left to libpng, which knows all of PNG and has the words for what
 * is broken. */
#include "image/formats.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK_FRAME = 12, HEADER_SIZE = 13, SIGNATURE_SIZE = 8 };

typedef struct Plain {
    uint32_t width, height;
    int bits, samples;   /* of the file; samples 1 to 4 */
    size_t pixel, row;   /* bytes, the row without its filter byte */
    uint8_t *compressed; /* owned */
    size_t size;         /* of compressed */
} Plain;

static bool read_header(Plain *plain, const uint8_t *data, size_t file_size)
{
    static const int samples_of_type[] = {1, 0, 3, 0, 2, 0, 4};
    int bits = data[8], type = data[9];
    if ((bits != 8 && bits != 16) || type > 6 || samples_of_type[type] == 0)
        return false;
    if (data[10] != 0 || data[11] != 0 || data[12] != 0) /* compression, filter, interlace */
        return false;
    *plain = (Plain){.width = image_u32(data),
                     .height = image_u32(data + 4),
                     .bits = bits,
                     .samples = samples_of_type[type],
                     .compressed = plain->compressed};
    if (plain->width < 1 || plain->width > IMAGE_MAX_SIDE || plain->height < 1 ||
        plain->height > IMAGE_MAX_SIDE)
        return false;
    plain->pixel = (size_t)plain->samples * (size_t)bits / 8;
    plain->row = plain->width * plain->pixel;
    return plain->row <= file_size * DEFLATE_MAX_RATIO / plain->height;
}

static bool is_one_of(const uint8_t *type, const char *types)
{
    for (; strlen(types) >= 4; types += types[4] ? 5 : 4)
        if (memcmp(type, types, 4) == 0)
            return true;
    return false;
}

/* Walks the chunks; `compressed` has room for the whole file. False on what is not plain. */
static bool read_chunks(Plain *plain, const ImageBytes *file)
{
    size_t at = SIGNATURE_SIZE;
    bool is_srgb = false, may_differ = false; /* the colours */
    for (bool first = true;; first = false) {
        if (file->size - at < CHUNK_FRAME)
            return false;
        const uint8_t *chunk = file->bytes + at, *type = chunk + 4, *data = chunk + 8;
        size_t length = image_u32(chunk);
        if (length > file->size - at - CHUNK_FRAME ||
            libdeflate_crc32(0, type, length + 4) != image_u32(data + length))
            return false;
        bool header = memcmp(type, "IHDR", 4) == 0;
        if (header != first ||
            (header && (length != HEADER_SIZE || !read_header(plain, data, file->size))))
            return false;
        if (memcmp(type, "IDAT", 4) == 0) {
            memcpy(plain->compressed + plain->size, data, length);
            plain->size += length;
        } else if (memcmp(type, "IEND", 4) == 0) {
            return is_srgb || !may_differ;
        } else if (!header && memcmp(type, "PLTE", 4) != 0 &&
                   (!(type[0] & 32) || is_one_of(type, "tRNS acTL cICP iCCP"))) {
            return false; /* transparent, animated, or a critical chunk of some other kind */
        }
        is_srgb |= is_one_of(type, "sRGB");
        may_differ |= is_one_of(type, "gAMA cHRM");
        at += length + CHUNK_FRAME;
    }
}

/* ------------------------------------------------------------------------------------ filters */

static inline uint8_t paeth(int left, int up, int corner)
{
    int to_left = abs(up - corner), to_up = abs(left - corner);
    int to_corner = abs(left + up - 2 * corner);
    int nearest = to_up <= to_corner ? up : corner;
    return (uint8_t)(to_left <= to_up && to_left <= to_corner ? left : nearest);
}

/* `in` lies above `out` in one buffer or in another one; `up` is the row before, all 0 for the
 * first. `pixel` is a constant where this is inlined, so that the samples of a pixel are undone
 * side by side. */
static inline void unfilter(int filter, const uint8_t *in, const uint8_t *up, uint8_t *out,
                            size_t n, size_t pixel)
{
    switch (filter) {
    case 0:
        memmove(out, in, n);
        break;
    case 1:
        memmove(out, in, pixel);
        for (size_t i = pixel; i < n; i++)
            out[i] = (uint8_t)(in[i] + out[i - pixel]);
        break;
    case 2:
        for (size_t i = 0; i < n; i++)
            out[i] = (uint8_t)(in[i] + up[i]);
        break;
    case 3:
        for (size_t i = 0; i < pixel; i++)
            out[i] = (uint8_t)(in[i] + up[i] / 2);
        for (size_t i = pixel; i < n; i++)
            out[i] = (uint8_t)(in[i] + (out[i - pixel] + up[i]) / 2);
        break;
    default:
        for (size_t i = 0; i < pixel; i++)
            out[i] = (uint8_t)(in[i] + up[i]);
        for (size_t i = pixel; i < n; i += pixel)
            for (size_t c = i; c < i + pixel; c++)
                out[c] = (uint8_t)(in[c] + paeth(out[c - pixel], up[c], up[c - pixel]));
        break;
    }
}

static bool unfilter_row(const Plain *plain, const uint8_t *in, const uint8_t *up, uint8_t *out)
{
    int filter = in[0];
    in++;
    switch (filter > 4 ? 0 : plain->pixel) {
    case 1:
        unfilter(filter, in, up, out, plain->row, 1);
        return true;
    case 2:
        unfilter(filter, in, up, out, plain->row, 2);
        return true;
    case 3:
        unfilter(filter, in, up, out, plain->row, 3);
        return true;
    case 4:
        unfilter(filter, in, up, out, plain->row, 4);
        return true;
    case 6:
        unfilter(filter, in, up, out, plain->row, 6);
        return true;
    case 8:
        unfilter(filter, in, up, out, plain->row, 8);
        return true;
    default:
        return false;
    }
}

/* Inflates into `rows`, which has room for the rows with their filter bytes, and undoes the
 * filters; what remains begins at `rows`, without them. */
static bool inflate_rows(const Plain *plain, uint8_t *rows, const uint8_t *zeros)
{
    struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        return false;
    bool sound =
        libdeflate_zlib_decompress(inflater, plain->compressed, plain->size, rows,
                                   plain->height * (plain->row + 1), NULL) == LIBDEFLATE_SUCCESS;
    libdeflate_free_decompressor(inflater);
    for (size_t y = 0; y < plain->height && sound; y++) {
        uint8_t *out = rows + y * plain->row;
        sound = unfilter_row(plain, rows + y * (plain->row + 1), y ? out - plain->row : zeros, out);
    }
    return sound;
}

/* ------------------------------------------------------------------------------------- picture */

/* Takes samples of 8 or 16 bits into the picture, which has no alpha. False unless opaque. */
static bool take_samples(const Plain *plain, const uint8_t *at, Picture *picture)
{
    size_t pixels = (size_t)plain->width * plain->height, next = 0;
    bool deep = plain->bits == 16;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < plain->samples; c++) {
            uint16_t code = (uint16_t)(deep ? at[0] << 8 | at[1] : at[0]);
            at += deep ? 2 : 1;
            if (c < picture->channels)
                picture_set(picture, next++, code);
            else if (code != (deep ? 65535 : 255))
                return false;
        }
    return true;
}

static bool decode(const Plain *plain, Picture *picture, const uint8_t *zeros)
{
    int channels = plain->samples < 3 ? 1 : 3;
    size_t size = plain->height * (plain->row + 1);
    if (image_check_memory((int)plain->width, (int)plain->height, size, NULL) != STATUS_OK)
        return false;
    uint8_t *rows = malloc(size);
    if (!rows || !inflate_rows(plain, rows, zeros)) {
        free(rows);
        return false;
    }
    if (plain->bits == 8 && plain->samples == channels) {
        *picture = (Picture){.width = (int)plain->width,
                             .height = (int)plain->height,
                             .channels = channels,
                             .bits = 8,
                             .codes8 = rows};
        return true;
    }
    Picture made;
    bool sound = picture_init(&made, (int)plain->width, (int)plain->height, channels, plain->bits,
                              NULL) == STATUS_OK;
    if (sound && !take_samples(plain, rows, &made)) {
        picture_release(&made);
        sound = false;
    }
    free(rows);
    if (sound)
        *picture = made;
    return sound;
}

bool png_decode_plain(const ImageBytes *file, Picture *picture)
{
    Plain plain = {.compressed = malloc(file->size)};
    bool sound = plain.compressed && read_chunks(&plain, file);
    uint8_t *zeros = sound ? calloc(plain.row, 1) : NULL;
    sound = zeros && decode(&plain, picture, zeros);
    free(zeros);
    free(plain.compressed);
    return sound;
}
