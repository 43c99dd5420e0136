/* A tree that is read is written so that it reads back to the same bytes. */
#include "fuzz.h"

#include "treeio/treeio.h"

static const FileForm form = {.name = "a tree", .most_bytes = 1e8};

static void read_whole(const char *path, char **bytes, size_t *size)
{
    Err err;
    Status status = file_read(path, &form, bytes, size, &err);
    assert(status == STATUS_OK);
    (void)status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Tree tree, again;
    Err err = {{0}};
    char *first, *second, path[128];
    size_t first_size, second_size;
    strcpy(path, fuzz_file("tree.swc", bytes, size));
    Status status = tree_read(&tree, path, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return 0;
    status = tree_write(&tree, path, &err);
    assert(status == STATUS_OK);
    read_whole(path, &first, &first_size);
    status = tree_read(&again, path, &err);
    assert(status == STATUS_OK);
    status = tree_write(&again, path, &err);
    assert(status == STATUS_OK);
    read_whole(path, &second, &second_size);
    assert(first_size == second_size && memcmp(first, second, first_size) == 0);
    free(first);
    free(second);
    tree_release(&tree);
    tree_release(&again);
    return 0;
}
