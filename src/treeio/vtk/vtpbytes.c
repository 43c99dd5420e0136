/* An array is a number of bytes and these bytes; compressed, it is how many blocks there are, how
 * large each is and the last, how many bytes each has compressed, and these. In base64 the bytes go
 * on without padding behind the number, but behind those of blocks there may be some; a group that
 * is padded gives fewer bytes and the next begins anew, so that either is read. zlib makes nothing
 * 1032 times smaller and LZ4 nothing 255 times, so a file that announces more is refused before
 * room is made for it, and so is one that announces more than its array can have or than a file of
 * its size may [check_unpacked]: a megabyte could become a gigabyte of zeros. */
#include "treeio/vtk/vtpbytes.h"

#include "treeio/formats.h"

#include <libdeflate.h>
#include <limits.h>
#include <lz4.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double most_ratio[] = {[VTP_PLAIN] = 1, [VTP_ZLIB] = 1032, [VTP_LZ4] = 255};

typedef struct Stream {
    const char *at, *end;
    bool is_base64;
    unsigned char group[3];
    size_t n, used; /* bytes of the group */
} Stream;

/* The six bits of a letter of base64; -1 for none. */
static int bits_of(char letter)
{
    if (letter >= 'A' && letter <= 'Z')
        return letter - 'A';
    if (letter >= 'a' && letter <= 'z')
        return letter - 'a' + 26;
    if (letter >= '0' && letter <= '9')
        return letter - '0' + 52;
    return letter == '+' ? 62 : letter == '/' ? 63 : -1;
}

static Status no_more(Err *err)
{
    return err_set(err, STATUS_INPUT, "there are fewer bytes than it announces");
}

/* Reads the next four letters, blanks between them left out. */
static Status next_group(Stream *stream, Err *err)
{
    uint32_t bits = 0;
    int letters = 0, padding = 0;
    while (letters < 4) {
        if (stream->at == stream->end || *stream->at == '<')
            return no_more(err);
        char letter = *stream->at++;
        if (strchr(" \t\r\n", letter) && letter)
            continue;
        int six = letter == '=' && letters >= 2 ? 0 : bits_of(letter);
        if (six < 0)
            return err_set(err, STATUS_INPUT, "a byte of %d is no letter of base64",
                           (unsigned char)letter);
        padding += letter == '=';
        bits = bits << 6 | (uint32_t)six;
        letters++;
    }
    for (int k = 0; k < 3; k++)
        stream->group[k] = (unsigned char)(bits >> (16 - 8 * k));
    stream->n = (size_t)(3 - padding);
    stream->used = 0;
    return STATUS_OK;
}

static Status take(Stream *stream, char *out, size_t n, Err *err)
{
    if (!stream->is_base64) {
        if (n > (size_t)(stream->end - stream->at))
            return no_more(err);
        memcpy(out, stream->at, n);
        stream->at += n;
        return STATUS_OK;
    }
    for (size_t i = 0; i < n; i++) {
        while (stream->used == stream->n)
            TRY(next_group(stream, err));
        out[i] = (char)stream->group[stream->used++];
    }
    return STATUS_OK;
}

static Status take_number(Stream *stream, const VtpCoding *coding, size_t *number, Err *err)
{
    char bytes[8];
    uint64_t made = 0;
    size_t size = coding->header_size;
    TRY(take(stream, bytes, size, err));
    for (size_t k = 0; k < size; k++)
        made = made << 8 | (unsigned char)bytes[coding->is_big_endian ? k : size - 1 - k];
    *number = (size_t)made;
    return STATUS_OK;
}

/* How many bytes the stream can still give. */
static double bytes_left(const Stream *stream)
{
    double left = (double)(stream->end - stream->at);
    return (stream->is_base64 ? left * 0.75 : left) + 3;
}

static Status check_claim(const Stream *stream, double claimed, double most, Err *err)
{
    char claim[BYTES_TEXT_SIZE], left[BYTES_TEXT_SIZE];
    if (claimed <= most)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "it announces %s; there are %s more in the file",
                   bytes_text(claimed, claim), bytes_text(bytes_left(stream), left));
}

/* Raw bytes stay where they are. */
static Status decode_plain(Stream *stream, const VtpCoding *coding, const char **bytes,
                           size_t *size, char **decoded, Err *err)
{
    size_t n = 0;
    char *made = NULL;
    TRY(take_number(stream, coding, &n, err));
    TRY(check_claim(stream, (double)n, bytes_left(stream), err));
    if (!stream->is_base64 && n <= (size_t)(stream->end - stream->at)) {
        *bytes = stream->at;
        *size = n;
        return STATUS_OK;
    }
    TRY(mem_calloc(&made, n, 1, "bytes of an array", err));
    Status status = take(stream, made, n, err);
    if (status != STATUS_OK) {
        free(made);
        return status;
    }
    *bytes = *decoded = made;
    *size = n;
    return STATUS_OK;
}

/* Numbers before blocks. */
typedef struct Blocks {
    size_t n, size, last; /* last: of the last, where that is partial; 0: it is not */
    size_t *packed;       /* bytes of each; owned */
} Blocks;

static Status read_blocks(Stream *stream, const VtpCoding *coding, Blocks *blocks, double *total,
                          Err *err)
{
    TRY(take_number(stream, coding, &blocks->n, err));
    if (blocks->n == 0) {
        *total = 0;
        return STATUS_OK;
    }
    TRY(take_number(stream, coding, &blocks->size, err));
    TRY(take_number(stream, coding, &blocks->last, err));
    TRY(check_claim(stream, (double)blocks->n * (double)coding->header_size, bytes_left(stream),
                    err));
    TRY(mem_calloc(&blocks->packed, blocks->n, sizeof *blocks->packed, "blocks", err));
    double packed = 0;
    for (size_t i = 0; i < blocks->n; i++) {
        TRY(take_number(stream, coding, &blocks->packed[i], err));
        packed += (double)blocks->packed[i];
    }
    TRY(check_claim(stream, packed, bytes_left(stream), err));
    *total = (double)(blocks->n - 1) * (double)blocks->size +
             (double)(blocks->last ? blocks->last : blocks->size);
    return check_claim(stream, *total, packed * most_ratio[coding->packing] + 64, err);
}

/* Unpacks to exactly `size` bytes; false for data that are not so packed. */
static bool unpack(const VtpCoding *coding, struct libdeflate_decompressor *inflater,
                   const char *packed, size_t n, char *out, size_t size)
{
    if (coding->packing == VTP_LZ4)
        return n <= INT_MAX && size <= INT_MAX &&
               LZ4_decompress_safe(packed, out, (int)n, (int)size) == (int)size;
    return libdeflate_zlib_decompress(inflater, packed, n, out, size, NULL) == LIBDEFLATE_SUCCESS;
}

static Status inflate_blocks(Stream *stream, const VtpCoding *coding, const Blocks *blocks,
                             char *out, char *packed, struct libdeflate_decompressor *inflater,
                             Err *err)
{
    for (size_t i = 0; i < blocks->n; i++) {
        size_t size = i + 1 == blocks->n && blocks->last ? blocks->last : blocks->size;
        TRY(take(stream, packed, blocks->packed[i], err));
        if (!unpack(coding, inflater, packed, blocks->packed[i], out, size))
            return err_set(err, STATUS_INPUT, "block %zu is no %s data of %zu bytes", i,
                           coding->packing == VTP_LZ4 ? "LZ4" : "zlib", size);
        out += size;
    }
    return STATUS_OK;
}

static Status check_room(double total, const VtpRoom *room, Err *err)
{
    char claim[BYTES_TEXT_SIZE], allowed[BYTES_TEXT_SIZE];
    double size = (double)room->size, most = room->numbers * size;
    if (total > most)
        return err_set(err, STATUS_INPUT,
                       "it announces %s; by the numbers of points and cells of its piece it has at "
                       "most %s",
                       bytes_text(total, claim), bytes_text(most, allowed));
    TRY(check_unpacked(room->taken + total / size * sizeof(double), room->file_size, err));
    return mem_check(room->taken + total + total / size * sizeof(double), room->name, err);
}

static Status decode_blocks(Stream *stream, const VtpCoding *coding, const VtpRoom *room,
                            Blocks *blocks, char **decoded, size_t *size, Err *err)
{
    double total = 0;
    char *made = NULL, *packed = NULL;
    size_t largest = 0;
    struct libdeflate_decompressor *inflater = NULL;
    TRY(read_blocks(stream, coding, blocks, &total, err));
    TRY(check_room(total, room, err));
    for (size_t i = 0; i < blocks->n; i++)
        largest = blocks->packed[i] > largest ? blocks->packed[i] : largest;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made, (size_t)total, 1, "bytes of an array", err));
    TRY_GOTO(mem_calloc(&packed, largest, 1, "bytes of a block", err));
    inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        TRY_GOTO(mem_out_of("to inflate", "an array", err));
    TRY_GOTO(inflate_blocks(stream, coding, blocks, made, packed, inflater, err));
    *decoded = made;
    *size = (size_t)total;
    made = NULL;
done:
    if (inflater)
        libdeflate_free_decompressor(inflater);
    free(packed);
    free(made);
    return status;
}

Status vtp_decode(const VtpCoding *coding, bool is_base64, const char *from, size_t left,
                  const VtpRoom *room, const char **bytes, size_t *size, char **decoded, Err *err)
{
    Stream stream = {.at = from, .end = from + left, .is_base64 = is_base64};
    *decoded = NULL;
    if (coding->packing == VTP_PLAIN)
        return decode_plain(&stream, coding, bytes, size, decoded, err);
    Blocks blocks = {0};
    Status status = decode_blocks(&stream, coding, room, &blocks, decoded, size, err);
    *bytes = *decoded;
    free(blocks.packed);
    return status;
}
