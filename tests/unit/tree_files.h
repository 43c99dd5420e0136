/* Files of a few lines in a folder of their own, for tests of tree formats. */
#ifndef CORCAST_TESTS_TREE_FILES_H
#define CORCAST_TESTS_TREE_FILES_H

#include "any_file.h"
#include "scratch.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <string.h>

static char path[64];

/* Writes the bytes to a file with this extension, whose name is then in `path`. */
static void put_file(const char *extension, const void *bytes, size_t size)
{
    Err err;
    snprintf(path, sizeof path, "%s/tree.%s", folder, extension);
    must(file_write(path, bytes, size, &err), &err);
}

static Tree read_as(const char *extension, const char *text, const ReadOptions *options)
{
    Tree tree = {0};
    Err err;
    put_file(extension, text, strlen(text));
    Status status = tree_read_as(&tree, path, options, NULL, &err);
    unlink(path);
    must(status, &err);
    return tree;
}

static Tree read_text(const char *extension, const char *text)
{
    return read_as(extension, text, NULL);
}

/* What the tree is written as in a file with this extension (owned). */
static char *written(const Tree *tree, const char *extension)
{
    char *bytes = NULL;
    size_t size = 0;
    Err err;
    snprintf(path, sizeof path, "%s/out.%s", folder, extension);
    must(tree_write(tree, path, &err), &err);
    must(file_read(path, &any_file, &bytes, &size, &err), &err);
    unlink(path);
    return bytes;
}

static void assert_written(const Tree *tree, const char *extension, const char *expected)
{
    char *bytes = written(tree, extension);
    assert_string_equal(bytes, expected);
    free(bytes);
}

/* The nodes as SWC. */
static void assert_nodes(const Tree *tree, const char *expected)
{
    char *bytes = written(tree, "swc"), *rows = bytes;
    while (*rows == '#')
        rows = strchr(rows, '\n') + 1;
    assert_string_equal(rows, expected);
    free(bytes);
}

/* `expected` goes on from the file's name. */
static void assert_refused(const char *extension, const char *text, const char *expected)
{
    Tree tree = {.n = 77};
    Err err;
    put_file(extension, text, strlen(text));
    Status status = tree_read(&tree, path, &err);
    unlink(path);
    assert_int_equal(status, STATUS_INPUT);
    assert_memory_equal(err.text, path, strlen(path));
    assert_string_equal(err.text + strlen(path), expected);
    assert_int_equal(tree.n, 77);
}

static double value_of(const Tree *tree, const char *column, size_t i)
{
    const TreeColumn *found = tree_column(tree, column);
    assert_non_null(found);
    return found->value[i];
}

#endif
