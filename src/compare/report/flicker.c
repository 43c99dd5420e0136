/* Writes an animated PNG that flickers between two pictures [APNG 1.0, now in PNG 3]. It is put
 * together from the two PNG files that the pictures make: the first with its animation chunks in
 * front of its data, then the data of the second as fdAT chunks, which are IDAT chunks behind a
 * sequence number. */
#include "compare/report/pictures.h"

#include <libdeflate.h>
#include <string.h>

/* SIGNATURE_SIZE and CHUNK_FRAME, bytes: the signature of a file; length, type and checksum of a
 * chunk. DELAY_MS: time that each picture is shown, long enough to see it and short enough to
 * remember it. */
enum { SIGNATURE_SIZE = 8, CHUNK_FRAME = 12, DELAY_MS = 500 };

static void put_u32(char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (char)(value >> (24 - 8 * i) & 255);
}

static uint32_t get_u32(const char *at)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value = value << 8 | (uint8_t)at[i];
    return value;
}

/* Appends a chunk whose data are `head` and then `data`. */
static void put_chunk(Text *out, const char *type, const char *head, size_t head_size,
                      const char *data, size_t size)
{
    char word[4];
    put_u32(word, (uint32_t)(head_size + size));
    text_append(out, word, 4);
    uint32_t crc = libdeflate_crc32(0, type, 4);
    crc = libdeflate_crc32(crc, head, head_size);
    crc = libdeflate_crc32(crc, data, size);
    text_append(out, type, 4);
    text_append(out, head, head_size);
    text_append(out, data, size);
    put_u32(word, crc);
    text_append(out, word, 4);
}

/* Appends the frame control chunk: sequence number, size, position, delay, no blending. */
static void put_frame_control(Text *out, uint32_t sequence, const Picture *picture)
{
    char data[26] = {0};
    put_u32(data, sequence);
    put_u32(data + 4, (uint32_t)picture->width);
    put_u32(data + 8, (uint32_t)picture->height);
    put_u32(data + 20, (uint32_t)DELAY_MS << 16 | 1000);
    put_chunk(out, "fcTL", data, sizeof data, "", 0);
}

/* Copies the first file up to its end chunk, with the animation chunks in front of its data. */
static void put_first(Text *out, const Text *png, const Picture *picture)
{
    bool announced = false;
    text_append(out, text_chars(png), SIGNATURE_SIZE);
    for (size_t at = SIGNATURE_SIZE; at + CHUNK_FRAME <= png->length;) {
        const char *chunk = text_chars(png) + at, *type = chunk + 4;
        size_t size = CHUNK_FRAME + get_u32(chunk);
        if (memcmp(type, "IEND", 4) == 0)
            return;
        if (memcmp(type, "IDAT", 4) == 0 && !announced) {
            char animation[8];
            put_u32(animation, 2);     /* frames */
            put_u32(animation + 4, 0); /* for ever */
            put_chunk(out, "acTL", animation, sizeof animation, "", 0);
            put_frame_control(out, 0, picture);
            announced = true;
        }
        text_append(out, chunk, size);
        at += size;
    }
}

/* Appends the data of the second file as the second frame, and the end of the file. */
static void put_second(Text *out, const Text *png, const Picture *picture)
{
    uint32_t sequence = 1;
    put_frame_control(out, sequence++, picture);
    for (size_t at = SIGNATURE_SIZE; at + CHUNK_FRAME <= png->length;) {
        const char *chunk = text_chars(png) + at;
        size_t size = get_u32(chunk);
        if (memcmp(chunk + 4, "IDAT", 4) == 0) {
            char number[4];
            put_u32(number, sequence++);
            put_chunk(out, "fdAT", number, sizeof number, chunk + 8, size);
        }
        at += CHUNK_FRAME + size;
    }
    put_chunk(out, "IEND", "", 0, "", 0);
}

Status flicker_png(const Picture *a, const Picture *b, Text *out, Err *err)
{
    Text first = TEXT_INIT, second = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(picture_to_png(a, ENCODING_SRGB, NULL, &first, err));
    TRY_GOTO(picture_to_png(b, ENCODING_SRGB, NULL, &second, err));
    put_first(out, &first, a);
    put_second(out, &second, b);
    status = text_check(out, err);
done:
    text_release(&first);
    text_release(&second);
    return status;
}
