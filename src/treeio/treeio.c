/* One table row a format. */
#include "treeio/treeio.h"

#include "treeio/swc.h"
#include <string.h>
#include <strings.h>

typedef struct Format {
    const char *extension;
    Status (*read)(Tree *tree, const char *path, Err *err);
    Status (*write)(const Tree *tree, const char *path, Err *err);
} Format;

static const Format formats[] = {
    {"swc", swc_read, swc_write},
};

/* NULL when the extension is unknown. */
static const Format *find_format(const char *path)
{
    const char *extension = strcmp(path, "-") == 0 ? "swc" : file_extension(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(extension, formats[i].extension) == 0)
            return &formats[i];
    return NULL;
}

static Status unknown_format(const char *path, Err *err)
{
    return err_set(err, STATUS_USAGE,
                   "%s: not the name of a tree file; known are .swc, and - for SWC on standard "
                   "input or output",
                   path);
}

bool tree_format_known(const char *path)
{
    return find_format(path) != NULL;
}

Status tree_read(Tree *tree, const char *path, Err *err)
{
    const Format *format = find_format(path);
    Tree read;
    TRY(format ? format->read(&read, path, err) : unknown_format(path, err));
    Status status = tree_check(&read, err);
    if (status != STATUS_OK) {
        err_prefix(err, "%s: ", path);
        tree_release(&read);
        return status;
    }
    *tree = read;
    return STATUS_OK;
}

Status tree_write(const Tree *tree, const char *path, Err *err)
{
    const Format *format = find_format(path);
    if (!format)
        return unknown_format(path, err);
    TRY(tree_check(tree, err));
    return format->write(tree, path, err);
}
