/* Fuzzes the readers of domains in meshes: the same bytes as STL and as OBJ. */
#include "tissue.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    fuzz_tissue("mesh", "body.stl", "", bytes, size);
    fuzz_tissue("mesh", "body.obj", "", bytes, size);
    return 0;
}
