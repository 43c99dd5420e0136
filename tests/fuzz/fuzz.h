/* Code shared by the fuzzing harnesses. A harness is one file that defines
 *
 *   int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);
 *
 * The function passes any bytes to a reader as a file and returns 0. Bytes for several files
 * are separated by the first zero bytes. `make fuzz` links a harness with libFuzzer, which
 * generates the bytes. The tests link it with replay.c, which reads the files of
 * tests/fuzz/corpus. Required properties are asserts; the sanitizers detect everything else. */
#ifndef CORCAST_TESTS_FUZZ_H
#define CORCAST_TESTS_FUZZ_H

#include "base/base.h"
#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* The path of a file of this name, which lies in a folder of this process and holds the bytes.
 * Borrowed until the next call. */
const char *fuzz_file(const char *name, const void *bytes, size_t size);

/* The next part of the bytes, up to a zero byte or their end, which *bytes and *size move past. */
typedef struct FuzzPart {
    const uint8_t *bytes;
    size_t size;
} FuzzPart;
FuzzPart fuzz_part(const uint8_t **bytes, size_t *size);

/* A refusal is one line of its own, and names the file. */
void fuzz_check_refusal(Status status, const Err *err, const char *path);

/* Reads the bytes as an image, whatever its format, whole and row by row. */
void fuzz_image(const uint8_t *bytes, size_t size);

#endif
