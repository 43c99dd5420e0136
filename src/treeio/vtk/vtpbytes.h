/* Arrays of VTK's XML files as bytes: base64 or raw, compressed or not. */
#ifndef CORCAST_TREEIO_VTPBYTES_H
#define CORCAST_TREEIO_VTPBYTES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum VtpPacking { VTP_PLAIN, VTP_ZLIB, VTP_LZ4 } VtpPacking;

typedef struct VtpCoding {
    bool is_big_endian;
    VtpPacking packing;
    size_t header_size; /* 4 or 8: of the numbers that say how many bytes follow */
} VtpCoding;

/* What a compressed array may become. */
typedef struct VtpRoom {
    const char *name; /* of the file */
    size_t file_size; /* in bytes */
    double numbers;   /* that it has at most */
    size_t size;      /* bytes of each */
    double taken;     /* bytes that the numbers before it take, which are doubles */
} VtpRoom;

/* Decodes the array that begins at `from`, of which the file has `left` more bytes. Its `*size`
 * bytes are *bytes, borrowed from *decoded (owned) or, where this becomes NULL, from the file.
 * STATUS_INPUT, without the file, when there are fewer than announced, they are not base64 or
 * zlib's or LZ4's, or compressed ones would become more numbers than there is room for or than
 * check_unpacked allows; STATUS_MEMORY, naming the file, when the machine has not the memory for
 * these. */
MUST_CHECK Status vtp_decode(const VtpCoding *coding, bool is_base64, const char *from, size_t left,
                             const VtpRoom *room, const char **bytes, size_t *size, char **decoded,
                             Err *err);

#endif
