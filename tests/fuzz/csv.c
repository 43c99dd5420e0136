/* Fuzzes the reader of trees in CSV. */
#include "forest.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tree("tree.csv", NULL, 0, bytes, size);
    return 0;
}
