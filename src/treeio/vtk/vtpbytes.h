/* Decodes arrays of VTK's XML files: base64 or raw bytes, compressed or not. */
#ifndef CORCAST_TREEIO_VTK_VTPBYTES_H
#define CORCAST_TREEIO_VTK_VTPBYTES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

/* How the bytes of arrays are compressed. */
typedef enum VtpPacking { VTP_PLAIN, VTP_ZLIB, VTP_LZ4, VTP_PACKINGS } VtpPacking;

/* How all arrays of a file are coded. */
typedef struct VtpCoding {
    bool is_big_endian;
    VtpPacking packing;
    size_t header_size; /* bytes of the numbers that state sizes: 4 or 8 */
} VtpCoding;

/* The input of vtp_decode: the coded bytes of one array, and the limits of its size. All pointers
 * are borrowed. */
typedef struct VtpSource {
    const char *name; /* name of the file, for errors */
    size_t file_size; /* in bytes */
    VtpCoding coding;
    bool is_base64;
    const char *from, *end; /* from the array's first byte to the end of the file */
    double max_numbers;     /* maximum count of the array's numbers */
    size_t number_size;     /* bytes of each number */
    double taken;           /* bytes of memory for the numbers of all earlier arrays, which count
                             * against the limit of check_unpacked */
} VtpSource;

/* A decoded array. */
typedef struct VtpBytes {
    const char *bytes; /* borrowed from `decoded`, or from the file if `decoded` is NULL */
    size_t size;
    char *decoded; /* owned */
} VtpBytes;

/* Decodes an array.
 *
 * out      receives the bytes; free out->decoded.
 * Errors   STATUS_INPUT, without the file's name, if the file has fewer bytes than the array's
 *          header announces, if the bytes are not valid base64, zlib or LZ4 data, or if the array
 *          has more numbers than max_numbers or than check_unpacked [treeio/formats.h] allows.
 *          STATUS_MEMORY, with the file's name. */
MUST_CHECK Status vtp_decode(const VtpSource *source, VtpBytes *out, Err *err);

/* Decompresses `n` bytes of zlib data to exactly `size` bytes. Errors: STATUS_INPUT if the data is
 * not valid or has another size; STATUS_MEMORY. */
MUST_CHECK Status bytes_inflate(const char *packed, size_t n, char *out, size_t size, Err *err);

#endif
