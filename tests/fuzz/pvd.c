/* Fuzzes the reader of ParaView's index of moments. Beside the index is a tree, tree.vtp: the
 * bytes up to the first zero byte. */
#include "fuzz.h"

#include "treeio/treeio.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Tree tree;
    Err err = {{0}};
    FuzzPart beside = fuzz_part(&bytes, &size);
    fuzz_file("tree.vtp", beside.bytes, beside.size);
    char path[128];
    strcpy(path, fuzz_file("run.pvd", bytes, size));
    Status status = tree_read(&tree, path, &err);
    fuzz_check_refusal(status, &err, path);
    if (status == STATUS_OK)
        tree_release(&tree);
    return 0;
}
