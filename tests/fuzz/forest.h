/* Reads a tree from a file with these bytes and this name, with options (NULL: no options). A
 * tree that is read is written, and must read back to the same bytes. */
#ifndef CORCAST_TESTS_FUZZ_FOREST_H
#define CORCAST_TESTS_FUZZ_FOREST_H

#include "fuzz.h"

#include "treeio/treeio.h"

static const FileForm tree_form = {.name = "a tree", .most_bytes = 1e8};

static inline void read_whole(const char *path, char **bytes, size_t *size)
{
    Err err;
    Status status = file_read(path, &tree_form, bytes, size, &err);
    assert(status == STATUS_OK);
    (void)status;
}

/* Writes the tree and reads it again, in its place. */
static inline void there_and_back(Tree *tree, const char *path)
{
    Err err;
    Status status = tree_write(tree, path, &err);
    assert(status == STATUS_OK);
    tree_release(tree);
    status = tree_read(tree, path, &err);
    assert(status == STATUS_OK);
    (void)status;
}

/* `trips` there and back go before; after them the order of the nodes is that of the format. */
static inline void fuzz_tree(const char *name, const ReadOptions *options, int trips,
                             const uint8_t *bytes, size_t size)
{
    Tree tree;
    Err err = {{0}};
    char *first, *second, path[128];
    size_t first_size, second_size;
    strcpy(path, fuzz_file(name, bytes, size));
    Status status = tree_read_as(&tree, path, options, NULL, &err);
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return;
    for (int trip = 0; trip < trips; trip++)
        there_and_back(&tree, path);
    there_and_back(&tree, path);
    read_whole(path, &first, &first_size);
    status = tree_write(&tree, path, &err);
    assert(status == STATUS_OK);
    read_whole(path, &second, &second_size);
    assert(first_size == second_size && memcmp(first, second, first_size) == 0);
    free(first);
    free(second);
    tree_release(&tree);
}

#endif
