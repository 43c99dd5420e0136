/* Fuzzes the readers of trees and networks of other programs. The first line of the bytes is
 * the extension of the file that contains the rest. Loops are cut. A tree that is read can be
 * written as CSV and in its own format, unless that format cannot store it. */
#include "fuzz.h"

#include "treeio/treeio.h"

/* Such a file is read. */
static void read_again(const char *path)
{
    Err err = {{0}};
    Tree tree;
    Status status = tree_read(&tree, path, &err);
    if (status != STATUS_OK)
        fprintf(stderr, "%s\n", err.text);
    assert(status == STATUS_OK);
    tree_release(&tree);
}

static void write_as(const Tree *tree, const char *extension)
{
    Err err = {{0}};
    char path[128], name[32];
    snprintf(name, sizeof name, "out.%s", extension);
    strcpy(path, fuzz_file(name, "", 0));
    if (tree_format_check(path, &err) != STATUS_OK)
        return;
    Status status = tree_write(tree, path, &err);
    assert(status == STATUS_OK || status == STATUS_INPUT);
    if (status == STATUS_OK && strcmp(extension, "csv") == 0)
        read_again(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ReadOptions options = {.break_loops = true};
    const uint8_t *end = memchr(bytes, '\n', size);
    char name[32], path[128];
    Tree tree;
    TreeReading reading;
    Err err = {{0}};
    if (!end || end - bytes > 10)
        return 0;
    size_t length = (size_t)(end - bytes);
    snprintf(name, sizeof name, "tree.%.*s", (int)length, (const char *)bytes);
    if (strchr(name, '/') || strlen(name) != length + 5 || !tree_format_known(name))
        return 0;
    strcpy(path, fuzz_file(name, end + 1, size - length - 1));
    Status status = tree_read_as(&tree, path, &options, &reading, &err);
    if (status == STATUS_USAGE) /* the format takes no such option */
        return 0;
    fuzz_check_refusal(status, &err, path);
    if (status != STATUS_OK)
        return 0;
    write_as(&tree, "csv");
    write_as(&tree, file_extension(path));
    tree_release(&tree);
    reading_release(&reading);
    return 0;
}
