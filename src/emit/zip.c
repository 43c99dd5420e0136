/* Writes a minimal ZIP archive [PKWARE, APPNOTE.TXT 6.3, sections 4.3.7, 4.3.9, 4.3.12, 4.3.16]: a
 * local header and the data of each entry, the central directory, and the end record. An entry is
 * deflated while it is produced, so that memory does not grow with its size and the archive may be
 * written to a pipe. The sizes and the checksum of an entry are therefore not in its local header,
 * but in a data descriptor after the entry and in the central directory. zlib is used because
 * libdeflate can only deflate data that is complete in memory. */
#define ZLIB_CONST
#include "emit/zip.h"

#include "emit/record.h"
#include <stdio.h>
#include <zlib.h>

enum {
    LOCAL_HEADER = 0x04034b50,
    DESCRIPTOR = 0x08074b50,
    CENTRAL_HEADER = 0x02014b50,
    CENTRAL_END = 0x06054b50,
    LOCAL_BYTES = 30,
    DESCRIPTOR_BYTES = 16,
    CENTRAL_BYTES = 46,
    VERSION = 20, /* 2.0: deflated */
    HAS_DESCRIPTOR = 8,
    METHOD_DEFLATE = 8,
    DATE_1980 = 1 << 5 | 1,
    LEVEL = 6, /* zlib's default: higher levels take far longer and save little */
};

/* The fields that the local and the central header of an entry share. In the local header the
 * numbers are 0. */
typedef struct ZipHeader {
    const char *name;
    uint32_t crc, packed, plain, offset;
} ZipHeader;

/* A number in a header, and the number of bytes that it takes. */
typedef struct ZipWord {
    uint32_t value;
    int bytes;
} ZipWord;

static void put_words(Record *record, const ZipWord *words, size_t n)
{
    for (size_t i = 0; i < n; i++)
        put_word(record, words[i].value, words[i].bytes);
}
#define PUT_WORDS(record, ...)                                                                     \
    put_words(record, (const ZipWord[]){__VA_ARGS__},                                              \
              sizeof((const ZipWord[]){__VA_ARGS__}) / sizeof(ZipWord))

/* Adds the fields that both headers share: from the version to the lengths of the name and of the
 * extra field. */
static void put_common(Record *record, const ZipHeader *header)
{
    PUT_WORDS(record, {VERSION, 2}, {HAS_DESCRIPTOR, 2}, {METHOD_DEFLATE, 2}, {0, 2} /* time */,
              {DATE_1980, 2}, {header->crc, 4}, {header->packed, 4}, {header->plain, 4},
              {(uint32_t)strlen(header->name), 2}, {0, 2});
}

static void put_local(const char *name, Text *out)
{
    const ZipHeader unknown = {.name = name};
    Record record = {.length = 0};
    put_word(&record, LOCAL_HEADER, 4);
    put_common(&record, &unknown);
    flush_record(&record, out);
    text_puts(out, name);
}

static void put_descriptor(const ZipHeader *header, Text *out)
{
    Record record = {.length = 0};
    PUT_WORDS(&record, {DESCRIPTOR, 4}, {header->crc, 4}, {header->packed, 4}, {header->plain, 4});
    flush_record(&record, out);
}

static void put_central(const ZipHeader *header, Text *out)
{
    Record record = {.length = 0};
    PUT_WORDS(&record, {CENTRAL_HEADER, 4}, {VERSION, 2});
    put_common(&record, header);
    /* Length of the comment, number of the disk, internal and external attributes, offset. */
    PUT_WORDS(&record, {0, 2}, {0, 2}, {0, 2}, {0, 4}, {header->offset, 4});
    flush_record(&record, out);
    text_puts(out, header->name);
}

static void put_end(size_t n, uint32_t bytes, uint32_t offset, Text *out)
{
    Record record = {.length = 0};
    /* The disk numbers and the length of the comment are 0. */
    PUT_WORDS(&record, {CENTRAL_END, 4}, {0, 4}, {(uint32_t)n, 2}, {(uint32_t)n, 2}, {bytes, 4},
              {offset, 4}, {0, 2});
    flush_record(&record, out);
}

/* The state of compressing one entry. */
typedef struct Packing {
    z_stream zlib;
    uLong crc;
    Text *out;
} Packing;

static void deflate_on(Packing *packing, const char *chars, size_t n, int flush)
{
    Bytef buffer[1 << 14];
    packing->zlib.next_in = (const Bytef *)chars;
    packing->zlib.avail_in = (uInt)n;
    packing->crc = crc32(packing->crc, packing->zlib.next_in, packing->zlib.avail_in);
    do {
        packing->zlib.next_out = buffer;
        packing->zlib.avail_out = sizeof buffer;
        (void)deflate(&packing->zlib, flush);
        text_append(packing->out, (const char *)buffer, sizeof buffer - packing->zlib.avail_out);
    } while (packing->zlib.avail_out == 0);
}

/* Compresses the bytes that the entry's callback produced. Returns `n`: a failure is recorded in
 * packing->out. */
static ssize_t take_bytes(void *cookie, const char *chars, size_t n)
{
    deflate_on(cookie, chars, n, Z_NO_FLUSH);
    return (ssize_t)n;
}

/* Calls the entry's callback, and deflates its output piece by piece. */
static Status pack(const ZipEntry *entry, Packing *packing, Err *err)
{
    FILE *stream = system_stream(packing, take_bytes);
    if (!stream)
        return mem_out_of("to compress", "the mesh", err);
    Text plain = TEXT_TO(stream);
    Status status = entry->put(&plain, entry->context, err);
    if (status == STATUS_OK)
        status = text_flush(&plain, err);
    text_release(&plain);
    fclose(stream);
    deflate_on(packing, "", 0, Z_FINISH);
    return status;
}

/* Appends an entry. The caller sets name and offset of *header; the other members are set here. */
static Status put_entry(const ZipEntry *entry, ZipHeader *header, Text *out, Err *err)
{
    enum { RAW = -15, MEMORY_LEVEL = 8 }; /* RAW: no zlib header; MEMORY_LEVEL: zlib's default */
    Packing packing = {.out = out, .crc = crc32(0, NULL, 0)};
    put_local(entry->name, out);
    if (deflateInit2(&packing.zlib, LEVEL, Z_DEFLATED, RAW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) !=
        Z_OK)
        return mem_out_of("to compress", "the mesh", err);
    Status status = pack(entry, &packing, err);
    uLong plain = packing.zlib.total_in, packed = packing.zlib.total_out;
    deflateEnd(&packing.zlib);
    TRY(status);
    if (plain > UINT32_MAX || packed > UINT32_MAX - header->offset)
        return err_set(err, STATUS_INFEASIBLE,
                       "the 3MF would have %.1f GB; the format allows at most 4 GB",
                       (double)plain * 1e-9);
    header->crc = (uint32_t)packing.crc;
    header->packed = (uint32_t)packed;
    header->plain = (uint32_t)plain;
    put_descriptor(header, out);
    return STATUS_OK;
}

Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err)
{
    ZipHeader header[ZIP_MAX_ENTRIES];
    uint32_t offset = 0, central = 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t name = (uint32_t)strlen(entries[i].name);
        header[i] = (ZipHeader){.name = entries[i].name, .offset = offset};
        TRY(put_entry(&entries[i], &header[i], out, err));
        offset += LOCAL_BYTES + name + header[i].packed + DESCRIPTOR_BYTES;
        central += CENTRAL_BYTES + name;
    }
    for (size_t i = 0; i < n; i++)
        put_central(&header[i], out);
    put_end(n, central, offset, out);
    return STATUS_OK;
}
