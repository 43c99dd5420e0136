/* Fuzzes the reader of networks in VTK's XML files. Loops are cut. */
#include "forest.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tree("tree.vtp", &(const ReadOptions){.break_loops = true}, 1, bytes, size);
    return 0;
}
