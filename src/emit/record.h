/* Encodes the numbers of binary files, little-endian on any machine. put_word, put_float and
 * put_floats add numbers to a record of up to 64 bytes, more than the longest (a triangle of STL,
 * 50 bytes); flush_record then appends the record to a text in one call. Private to the module
 * emit. */
#ifndef CORCAST_EMIT_RECORD_H
#define CORCAST_EMIT_RECORD_H

#include "base/base.h"
#include <string.h>

/* A record. A zeroed record is empty. The caller must not add more than 64 bytes before
 * flush_record. */
typedef struct Record {
    char bytes[64];
    size_t length;
} Record;

/* Adds the lowest `bytes` bytes of `word`. */
static inline void put_word(Record *record, uint32_t word, int bytes)
{
    for (int i = 0; i < bytes; i++)
        record->bytes[record->length++] = (char)(word >> 8 * i & 0xff);
}

/* Adds a float: 4 bytes. */
static inline void put_float(Record *record, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_word(record, bits, 4);
}

/* Adds three floats. */
static inline void put_floats(Record *record, const float values[3])
{
    for (int axis = 0; axis < 3; axis++)
        put_float(record, values[axis]);
}

/* Appends the record to `out` and empties it. */
static inline void flush_record(Record *record, Text *out)
{
    text_append(out, record->bytes, record->length);
    record->length = 0;
}

#endif
