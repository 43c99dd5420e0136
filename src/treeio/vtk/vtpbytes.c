/* Decodes the bytes of one array of VTK's XML: raw or in base64, plain or compressed.
 *
 * An array without compression is its number of bytes, followed by the bytes. A compressed array is
 * the number of blocks, the unpacked size of a block, the unpacked size of the last block, the
 * packed size of each block, and the blocks. In base64, padding may stand between these parts or
 * not. A padded group gives fewer bytes, and the next group starts again, so both forms are read
 * alike.
 *
 * A small file must not make the program allocate much memory. zlib compresses by at most 1032 and
 * LZ4 by at most 255. A file that announces a higher ratio is refused before memory is allocated.
 * So is a file that announces more numbers than its array can have, or more than check_unpacked
 * allows. */
#include "treeio/vtk/vtpbytes.h"

#include "treeio/formats.h"

#include <libdeflate.h>
#include <limits.h>
#include <lz4.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double max_ratio[VTP_PACKINGS] = {[VTP_PLAIN] = 1, [VTP_ZLIB] = 1032, [VTP_LZ4] = 255};

/* The decoder of one array. */
typedef struct ByteStream {
    const VtpSource *source;
    const char *at;
    unsigned char group[3]; /* the bytes of the last four letters of base64 */
    size_t n, used;         /* number of bytes in the group; number of them already read */
} ByteStream;

/* Returns the six bits of a letter of base64, or -1. */
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

static Status refuse_end(Err *err)
{
    return err_set(err, STATUS_INPUT, "it has fewer bytes than it announces");
}

/* Reads the next four letters of base64, and ignores blanks between them. */
static Status next_group(ByteStream *stream, Err *err)
{
    uint32_t bits = 0;
    int letters = 0, padding = 0;
    while (letters < 4) {
        if (stream->at == stream->source->end || *stream->at == '<')
            return refuse_end(err);
        char letter = *stream->at++;
        if (letter && strchr(" \t\r\n", letter))
            continue;
        int six = letter == '=' && letters >= 2 ? 0 : bits_of(letter);
        if (six < 0)
            return err_set(err, STATUS_INPUT,
                           "it has a byte of value %d, which is not a base64 character",
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

/* Copies the next n bytes of the stream. */
static Status take(ByteStream *stream, char *out, size_t n, Err *err)
{
    if (!stream->source->is_base64) {
        if (n > (size_t)(stream->source->end - stream->at))
            return refuse_end(err);
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

static Status take_number(ByteStream *stream, size_t *number, Err *err)
{
    char bytes[8];
    uint64_t made = 0;
    size_t size = stream->source->coding.header_size;
    TRY(take(stream, bytes, size, err));
    for (size_t k = 0; k < size; k++)
        made = made << 8 |
               (unsigned char)bytes[stream->source->coding.is_big_endian ? k : size - 1 - k];
    *number = (size_t)made;
    return STATUS_OK;
}

/* Returns an upper bound of the bytes that the stream can still give. */
static double bytes_left(const ByteStream *stream)
{
    double left = (double)(stream->source->end - stream->at);
    return (stream->source->is_base64 ? left * 0.75 : left) + 3;
}

/* Checks that the announced number of bytes is at most `most`. */
static Status check_claim(const ByteStream *stream, double claimed, double most, Err *err)
{
    char claim[BYTES_TEXT_SIZE], left[BYTES_TEXT_SIZE];
    if (claimed <= most)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "it announces %s, but only %s of the file are left",
                   bytes_text(claimed, claim), bytes_text(bytes_left(stream), left));
}

/* Raw bytes are borrowed from the file; bytes in base64 are decoded into new memory. */
static Status decode_plain(ByteStream *stream, VtpBytes *out, Err *err)
{
    size_t n = 0;
    TRY(take_number(stream, &n, err));
    TRY(check_claim(stream, (double)n, bytes_left(stream), err));
    *out = (VtpBytes){.bytes = stream->at, .size = n};
    if (!stream->source->is_base64 && n <= (size_t)(stream->source->end - stream->at))
        return STATUS_OK;
    TRY(mem_calloc(&out->decoded, n, 1, "bytes of an array", err));
    out->bytes = out->decoded;
    return take(stream, out->decoded, n, err);
}

/* ---- compressed arrays ----------------------------------------------------------------------- */

/* The header of a compressed array. */
typedef struct PackedBlocks {
    size_t n, size; /* number of blocks; bytes of each unpacked block except the last */
    size_t last;    /* bytes of the last unpacked block */
    size_t *packed; /* bytes of each packed block; owned */
    size_t largest; /* bytes of the largest packed block */
    double total;   /* bytes of all unpacked blocks */
} PackedBlocks;

/* Reads the header of a compressed array, and checks that its claims are possible. */
static Status read_blocks(ByteStream *stream, PackedBlocks *blocks, Err *err)
{
    const VtpCoding *coding = &stream->source->coding;
    double packed = 0;
    TRY(take_number(stream, &blocks->n, err));
    if (blocks->n == 0)
        return STATUS_OK;
    TRY(take_number(stream, &blocks->size, err));
    TRY(take_number(stream, &blocks->last, err));
    blocks->last = blocks->last ? blocks->last : blocks->size;
    TRY(check_claim(stream, (double)blocks->n * (double)coding->header_size, bytes_left(stream),
                    err));
    TRY(mem_calloc(&blocks->packed, blocks->n, sizeof *blocks->packed, "blocks", err));
    for (size_t i = 0; i < blocks->n; i++) {
        TRY(take_number(stream, &blocks->packed[i], err));
        packed += (double)blocks->packed[i];
        if (blocks->packed[i] > blocks->largest)
            blocks->largest = blocks->packed[i];
    }
    TRY(check_claim(stream, packed, bytes_left(stream), err));
    blocks->total = (double)(blocks->n - 1) * (double)blocks->size + (double)blocks->last;
    /* 64 allows for very small blocks, whose ratio is not limited. */
    return check_claim(stream, blocks->total, packed * max_ratio[coding->packing] + 64, err);
}

/* Checks that the unpacked bytes, `total`, do not exceed the limits of the array, of the file and
 * of the machine. */
static Status check_limits(const VtpSource *source, double total, Err *err)
{
    char claim[BYTES_TEXT_SIZE], allowed[BYTES_TEXT_SIZE];
    double size = (double)source->number_size, most = source->max_numbers * size;
    if (total > most)
        return err_set(err, STATUS_INPUT,
                       "it announces %s; the points and cells of its piece allow at most %s",
                       bytes_text(total, claim), bytes_text(most, allowed));
    TRY(check_unpacked(source->taken + total / size * sizeof(double), source->file_size, err));
    return mem_check(source->taken + total + total / size * sizeof(double), source->name, err);
}

Status bytes_inflate(const char *packed, size_t n, char *out, size_t size, Err *err)
{
    struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        return mem_out_of("to inflate", "an array", err);
    enum libdeflate_result result =
        libdeflate_zlib_decompress(inflater, packed, n, out, size, NULL);
    libdeflate_free_decompressor(inflater);
    return result == LIBDEFLATE_SUCCESS
               ? STATUS_OK
               : err_set(err, STATUS_INPUT, "not zlib data that unpacks to %zu bytes", size);
}

static Status unpack_lz4(const char *packed, size_t n, char *out, size_t size, Err *err)
{
    if (n <= INT_MAX && size <= INT_MAX &&
        LZ4_decompress_safe(packed, out, (int)n, (int)size) == (int)size)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "not LZ4 data that unpacks to %zu bytes", size);
}

/* Unpacks all blocks, one after the other. */
static Status unpack_blocks(ByteStream *stream, const PackedBlocks *blocks, char *packed, char *out,
                            Err *err)
{
    const bool is_lz4 = stream->source->coding.packing == VTP_LZ4;
    for (size_t i = 0; i < blocks->n; i++) {
        size_t size = i + 1 == blocks->n ? blocks->last : blocks->size;
        TRY(take(stream, packed, blocks->packed[i], err));
        Status status = is_lz4 ? unpack_lz4(packed, blocks->packed[i], out, size, err)
                               : bytes_inflate(packed, blocks->packed[i], out, size, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "block %zu is ", i);
        TRY(status);
        out += size;
    }
    return STATUS_OK;
}

/* Decodes a compressed array into new memory. */
static Status decode_blocks(ByteStream *stream, VtpBytes *out, Err *err)
{
    PackedBlocks blocks = {0};
    char *packed = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(read_blocks(stream, &blocks, err));
    TRY_GOTO(check_limits(stream->source, blocks.total, err));
    TRY_GOTO(mem_calloc(&out->decoded, (size_t)blocks.total, 1, "bytes of an array", err));
    TRY_GOTO(mem_calloc(&packed, blocks.largest, 1, "bytes of a block", err));
    status = unpack_blocks(stream, &blocks, packed, out->decoded, err);
    out->bytes = out->decoded;
    out->size = (size_t)blocks.total;
done:
    free(packed);
    free(blocks.packed);
    return status;
}

Status vtp_decode(const VtpSource *source, VtpBytes *out, Err *err)
{
    ByteStream stream = {.source = source, .at = source->from};
    VtpBytes made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(
        (source->coding.packing == VTP_PLAIN ? decode_plain : decode_blocks)(&stream, &made, err));
    *out = made;
    return STATUS_OK;
done:
    free(made.decoded);
    return status;
}
