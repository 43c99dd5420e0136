/* Arrays of VTK's XML files as bytes: base64 or raw, compressed or not. */
#ifndef CORCAST_TREEIO_VTPBYTES_H
#define CORCAST_TREEIO_VTPBYTES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct VtpCoding {
    bool is_big_endian, is_compressed;
    size_t header_size; /* 4 or 8: of the numbers that say how many bytes follow */
} VtpCoding;

/* Decodes the array that begins at `from`, of which the file has `left` more bytes. Its `*size`
 * bytes are *bytes, borrowed from *decoded (owned) or, where this becomes NULL, from the file.
 * STATUS_INPUT, without the file, when there are fewer than announced, or they are not base64 or
 * zlib's. */
MUST_CHECK Status vtp_decode(const VtpCoding *coding, bool is_base64, const char *from, size_t left,
                             const char **bytes, size_t *size, char **decoded, Err *err);

#endif
