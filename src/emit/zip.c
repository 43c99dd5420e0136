/* The least that a ZIP archive takes [PKWARE, APPNOTE.TXT 6.3, sections 4.3.7, 4.3.12, 4.3.16]:
 * each entry behind its header, then the headers once more, as the central directory, and where
 * that begins. An entry is deflated whole by libdeflate, which is here for PNG already, so that its
 * header can say beforehand how long it is, and nothing needs to be written twice: the archive may
 * go to a pipe. */
#include "emit/zip.h"

#include "emit/record.h"
#include <libdeflate.h>
#include <stdlib.h>

enum {
    LOCAL_HEADER = 0x04034b50,
    CENTRAL_HEADER = 0x02014b50,
    CENTRAL_END = 0x06054b50,
    LOCAL_BYTES = 30,
    CENTRAL_BYTES = 46,
    VERSION = 20, /* 2.0: deflated */
    METHOD_DEFLATE = 8,
    DATE_1980 = 1 << 5 | 1,
    LEVEL = 6,
};

/* What both headers say of an entry. */
typedef struct Stored {
    const char *name;
    uint32_t crc, packed, plain, offset;
} Stored;

/* From the version on to the lengths of the name and of what is extra. */
static void put_common(Record *record, const Stored *stored)
{
    put_word(record, VERSION, 2);
    put_word(record, 0, 2); /* flags */
    put_word(record, METHOD_DEFLATE, 2);
    put_word(record, 0, 2); /* time */
    put_word(record, DATE_1980, 2);
    put_word(record, stored->crc, 4);
    put_word(record, stored->packed, 4);
    put_word(record, stored->plain, 4);
    put_word(record, (uint32_t)strlen(stored->name), 2);
    put_word(record, 0, 2);
}

static void put_local(const Stored *stored, Text *out)
{
    Record record = {.length = 0};
    put_word(&record, LOCAL_HEADER, 4);
    put_common(&record, stored);
    flush_record(&record, out);
    text_puts(out, stored->name);
}

static void put_central(const Stored *stored, Text *out)
{
    Record record = {.length = 0};
    put_word(&record, CENTRAL_HEADER, 4);
    put_word(&record, VERSION, 2);
    put_common(&record, stored);
    put_word(&record, 0, 2); /* length of the comment */
    put_word(&record, 0, 2); /* number of the disk */
    put_word(&record, 0, 2); /* attributes, internal */
    put_word(&record, 0, 4); /* and external */
    put_word(&record, stored->offset, 4);
    flush_record(&record, out);
    text_puts(out, stored->name);
}

static void put_end(size_t n, uint32_t bytes, uint32_t offset, Text *out)
{
    Record record = {.length = 0};
    put_word(&record, CENTRAL_END, 4);
    put_word(&record, 0, 4); /* disks */
    put_word(&record, (uint32_t)n, 2);
    put_word(&record, (uint32_t)n, 2);
    put_word(&record, bytes, 4);
    put_word(&record, offset, 4);
    put_word(&record, 0, 2); /* length of the comment */
    flush_record(&record, out);
}

/* Appends an entry, of which *stored knows name and offset and learns the rest. */
static Status put_entry(struct libdeflate_compressor *compressor, const char *chars, size_t length,
                        Stored *stored, Text *out, Err *err)
{
    size_t room = libdeflate_deflate_compress_bound(compressor, length);
    if (room > UINT32_MAX - stored->offset)
        return err_set(err, STATUS_INFEASIBLE, "a 3MF holds 4 GB; this one would have %.1f",
                       (double)length * 1e-9);
    char *packed;
    TRY(mem_calloc(&packed, room, 1, "a compressed file", err));
    stored->packed = (uint32_t)libdeflate_deflate_compress(compressor, chars, length, packed, room);
    stored->plain = (uint32_t)length;
    stored->crc = libdeflate_crc32(0, chars, length);
    put_local(stored, out);
    text_append(out, packed, stored->packed);
    free(packed);
    return STATUS_OK;
}

static Status put_entries(struct libdeflate_compressor *compressor, const ZipEntry *entries,
                          size_t n, Text *out, Err *err)
{
    Stored stored[ZIP_MOST_ENTRIES];
    uint32_t offset = 0, central = 0;
    for (size_t i = 0; i < n; i++) {
        const char *chars = text_chars(entries[i].text);
        TRY(text_check(entries[i].text, err));
        stored[i] = (Stored){.name = entries[i].name, .offset = offset};
        TRY(put_entry(compressor, chars, strlen(chars), &stored[i], out, err));
        offset += LOCAL_BYTES + (uint32_t)strlen(entries[i].name) + stored[i].packed;
        central += CENTRAL_BYTES + (uint32_t)strlen(entries[i].name);
    }
    for (size_t i = 0; i < n; i++)
        put_central(&stored[i], out);
    put_end(n, central, offset, out);
    return STATUS_OK;
}

Status zip_put(const ZipEntry *entries, size_t n, Text *out, Err *err)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    if (!compressor)
        return mem_out_of("to compress", "the mesh", err);
    Status status = put_entries(compressor, entries, n, out, err);
    libdeflate_free_compressor(compressor);
    return status;
}
