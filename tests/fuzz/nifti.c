#include "tissue.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tissue("mask", "mask.nii", "", bytes, size);
    return 0;
}
