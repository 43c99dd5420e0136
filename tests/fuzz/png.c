/* Fuzzes the reader of PNG, also as a mask. The harness corrects the checksums of the chunks
 * first; otherwise the code behind the check of the checksums would never be reached. */
#include "fuzz.h"

#include "tissue.h"
#include <libdeflate.h>

static uint32_t read_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static void mend_checksums(uint8_t *bytes, size_t size)
{
    for (size_t at = 8; size - at >= 12;) {
        size_t length = read_u32(bytes + at);
        if (length > size - at - 12)
            return;
        uint32_t sum = libdeflate_crc32(0, bytes + at + 4, length + 4);
        for (int i = 0; i < 4; i++)
            bytes[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
        at += length + 12;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    uint8_t *mended = malloc(size + 1);
    if (!mended)
        abort();
    if (size > 0)
        memcpy(mended, bytes, size);
    if (size > 8)
        mend_checksums(mended, size);
    fuzz_image(mended, size);
    fuzz_tissue("mask", "mask.png", ",0.25", mended, size);
    free(mended);
    return 0;
}
