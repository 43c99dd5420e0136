/* Fuzzes the reader of networks in legacy VTK files. Loops are cut. */
#include "forest.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tree("tree.vtk", &(const ReadOptions){.break_loops = true}, 1, bytes, size);
    return 0;
}
