/* The least that a ZIP archive takes [PKWARE, APPNOTE.TXT 6.3, sections 4.3.7, 4.3.9, 4.3.12,
 * 4.3.16]: each entry behind its header, then the headers once more, as the central directory, and
 * where that begins. How long an entry is and its checksum stand behind it, in a data descriptor,
 * and in the directory: it is deflated as it is made, so that memory does not grow with it, and the
 * archive may go to a pipe. That takes zlib; libdeflate deflates only what is there whole. */
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
    DESCRIBED_BEHIND = 8,
    METHOD_DEFLATE = 8,
    DATE_1980 = 1 << 5 | 1,
    LEVEL = 6,
};

/* What both headers say of an entry; the first does not know numbers yet. */
typedef struct Stored {
    const char *name;
    uint32_t crc, packed, plain, offset;
} Stored;

/* A number of a header and its size in bytes. */
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

/* Adds the numbers that both headers have: from the version to the lengths of the name and of the
 * extra field. */
static void put_common(Record *record, const Stored *stored)
{
    PUT_WORDS(record, {VERSION, 2}, {DESCRIBED_BEHIND, 2}, {METHOD_DEFLATE, 2}, {0, 2} /* time */,
              {DATE_1980, 2}, {stored->crc, 4}, {stored->packed, 4}, {stored->plain, 4},
              {(uint32_t)strlen(stored->name), 2}, {0, 2});
}

static void put_local(const char *name, Text *out)
{
    const Stored unknown = {.name = name};
    Record record = {.length = 0};
    put_word(&record, LOCAL_HEADER, 4);
    put_common(&record, &unknown);
    flush_record(&record, out);
    text_puts(out, name);
}

static void put_descriptor(const Stored *stored, Text *out)
{
    Record record = {.length = 0};
    PUT_WORDS(&record, {DESCRIPTOR, 4}, {stored->crc, 4}, {stored->packed, 4}, {stored->plain, 4});
    flush_record(&record, out);
}

static void put_central(const Stored *stored, Text *out)
{
    Record record = {.length = 0};
    PUT_WORDS(&record, {CENTRAL_HEADER, 4}, {VERSION, 2});
    put_common(&record, stored);
    /* Length of the comment, number of the disk, internal and external attributes. */
    PUT_WORDS(&record, {0, 2}, {0, 2}, {0, 2}, {0, 4}, {stored->offset, 4});
    flush_record(&record, out);
    text_puts(out, stored->name);
}

static void put_end(size_t n, uint32_t bytes, uint32_t offset, Text *out)
{
    Record record = {.length = 0};
    /* The numbers of disks, and the length of the comment, are 0. */
    PUT_WORDS(&record, {CENTRAL_END, 4}, {0, 4}, {(uint32_t)n, 2}, {(uint32_t)n, 2}, {bytes, 4},
              {offset, 4}, {0, 2});
    flush_record(&record, out);
}

/* An entry on its way into the archive. */
typedef struct Packing {
    z_stream zlib;
    uLong crc;
    Text *out;
} Packing;

static void deflate_on(Packing *packing, const char *chars, size_t n, int flush)
{
    Bytef room[1 << 14];
    packing->zlib.next_in = (const Bytef *)chars;
    packing->zlib.avail_in = (uInt)n;
    packing->crc = crc32(packing->crc, packing->zlib.next_in, packing->zlib.avail_in);
    do {
        packing->zlib.next_out = room;
        packing->zlib.avail_out = sizeof room;
        (void)deflate(&packing->zlib, flush);
        text_append(packing->out, (const char *)room, sizeof room - packing->zlib.avail_out);
    } while (packing->zlib.avail_out == 0);
}

/* The archive's text keeps its own failures. */
static ssize_t take_bytes(void *cookie, const char *chars, size_t n)
{
    deflate_on(cookie, chars, n, Z_NO_FLUSH);
    return (ssize_t)n;
}

/* Has the entry made, and deflated piece by piece. */
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

/* Appends an entry, of which *stored knows name and offset and learns the rest. */
static Status put_entry(const ZipEntry *entry, Stored *stored, Text *out, Err *err)
{
    enum { RAW = -15, MEMORY_LEVEL = 8 }; /* no header of zlib's own; what zlib takes by default */
    Packing packing = {.out = out, .crc = crc32(0, NULL, 0)};
    put_local(entry->name, out);
    if (deflateInit2(&packing.zlib, LEVEL, Z_DEFLATED, RAW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) !=
        Z_OK)
        return mem_out_of("to compress", "the mesh", err);
    Status status = pack(entry, &packing, err);
    uLong plain = packing.zlib.total_in, packed = packing.zlib.total_out;
    deflateEnd(&packing.zlib);
    TRY(status);
    if (plain > UINT32_MAX || packed > UINT32_MAX - stored->offset)
        return err_set(err, STATUS_INFEASIBLE,
                       "the 3MF would have %.1f GB; the format allows at most 4 GB",
                       (double)plain * 1e-9);
    stored->crc = (uint32_t)packing.crc;
    stored->packed = (uint32_t)packed;
    stored->plain = (uint32_t)plain;
    put_descriptor(stored, out);
    return STATUS_OK;
}

Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err)
{
    Stored stored[ZIP_MAX_ENTRIES];
    uint32_t offset = 0, central = 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t name = (uint32_t)strlen(entries[i].name);
        stored[i] = (Stored){.name = entries[i].name, .offset = offset};
        TRY(put_entry(&entries[i], &stored[i], out, err));
        offset += LOCAL_BYTES + name + stored[i].packed + DESCRIPTOR_BYTES;
        central += CENTRAL_BYTES + name;
    }
    for (size_t i = 0; i < n; i++)
        put_central(&stored[i], out);
    put_end(n, central, offset, out);
    return STATUS_OK;
}
