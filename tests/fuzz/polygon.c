#include "tissue.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tissue("polygon", "rings.txt", "", bytes, size);
    return 0;
}
