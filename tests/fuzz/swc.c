/* Fuzzes the reader of trees in SWC. */
#include "forest.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tree("tree.swc", NULL, 0, bytes, size);
    return 0;
}
