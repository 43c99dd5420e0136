/* One table row a format. What a path's extension names is read as that; standard input, and what
 * several formats share an extension of, as what its first bytes tell, and else as the first row of
 * the table. Files are opened, built into trees, checked and committed here alone. */
#include "treeio/treeio.h"

#include "treeio/formats.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_EXTENSIONS = 3 };

typedef struct Format {
    const char *name, *description;
    const char *extensions[MAX_EXTENSIONS + 1]; /* without the '.'; ends with NULL */
    bool no_columns;                            /* there is no place for a tree's columns */
    FileForm form;
    TreeDetect *detect; /* NULL: nothing tells */
    TreeRead *read;
    TreeWrite *write;
} Format;

/* As many rows of SWC as there are ids, of the longest numbers, have 3 GB. */
#define MOST_BYTES 4e9

static const Format formats[] = {
    {.name = "SWC",
     .no_columns = true,
     .description = "id type x y z radius parent, a node a line, in mm",
     .extensions = {"swc"},
     .form = {.name = "an SWC file", .most_bytes = MOST_BYTES, .is_text = true},
     .read = swc_read,
     .write = swc_write},
    {.name = "CSV",
     .description = "a node a line, columns by name, any columns of values beside them",
     .extensions = {"csv"},
     .form = {.name = "a CSV file", .most_bytes = MOST_BYTES, .is_text = true},
     .detect = csv_detect,
     .read = csv_read,
     .write = csv_write},
};

enum { N_FORMATS = sizeof formats / sizeof *formats };

static const FileForm any_form = {.name = "a tree file", .most_bytes = MOST_BYTES, .is_text = true};

static bool is_standard(const char *path)
{
    return strcmp(path, "-") == 0;
}

/* Whether a file of this name may be of the format. */
static bool may_be(const Format *format, const char *path)
{
    if (is_standard(path))
        return true;
    for (const char *const *extension = format->extensions; *extension; extension++)
        if (strcasecmp(file_extension(path), *extension) == 0)
            return true;
    return false;
}

static size_t count_formats(const char *path)
{
    size_t count = 0;
    for (size_t i = 0; i < N_FORMATS; i++)
        count += may_be(&formats[i], path);
    return count;
}

/* Of the formats that a file of this name may be, the one that its first bytes tell, or else the
 * first; NULL when there is none. Without bytes, the first. */
static const Format *find_format(const char *path, const char *start)
{
    const Format *first = NULL;
    for (size_t i = 0; i < N_FORMATS; i++) {
        if (!may_be(&formats[i], path))
            continue;
        if (start && formats[i].detect && formats[i].detect(start))
            return &formats[i];
        if (!first)
            first = &formats[i];
    }
    return first;
}

const char *tree_format_name(size_t i)
{
    return i < N_FORMATS ? formats[i].name : NULL;
}

const char *tree_format_extension(size_t i)
{
    return i < N_FORMATS ? formats[i].extensions[0] : NULL;
}

const char *tree_format_description(size_t i)
{
    return i < N_FORMATS ? formats[i].description : NULL;
}

bool tree_format_has_columns(const char *path)
{
    const Format *format = find_format(path, NULL);
    return format && !format->no_columns;
}

bool tree_format_known(const char *path)
{
    return find_format(path, NULL) != NULL;
}

void tree_format_list(Text *text)
{
    for (size_t i = 0; i < N_FORMATS; i++) {
        const char *between = i + 1 < N_FORMATS ? ", " : " or ";
        text_printf(text, "%s.%s", i ? between : "", formats[i].extensions[0]);
    }
}

static void suggest_extension(const char *path, Err *err)
{
    const char *given = file_extension(path);
    Suggestion suggestion = suggestion_for(given, strlen(given));
    for (size_t i = 0; i < N_FORMATS; i++)
        for (const char *const *extension = formats[i].extensions; *extension; extension++)
            suggestion_offer(&suggestion, *extension);
    suggestion_add(&suggestion, ".", err);
}

Status tree_format_check(const char *path, Err *err)
{
    if (tree_format_known(path))
        return STATUS_OK;
    Text known = TEXT_INIT;
    tree_format_list(&known);
    Status status = text_check(&known, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE,
                         "%s: not the name of a tree file, which ends in %s, or is - for standard "
                         "input or output",
                         path, text_chars(&known));
    text_release(&known);
    if (status == STATUS_USAGE)
        suggest_extension(path, err);
    return status;
}

Status tree_read(Tree *tree, const char *path, Err *err)
{
    size_t size = 0;
    char *bytes = NULL;
    TRY(tree_format_check(path, err));
    bool one = count_formats(path) == 1;
    TRY(file_read(path, one ? &find_format(path, NULL)->form : &any_form, &bytes, &size, err));
    const Format *format = find_format(path, bytes);
    TreeBuilder builder = {.name = is_standard(path) ? "standard input" : path};
    Status status = format->read(&builder, bytes, size, err);
    if (status == STATUS_OK)
        status = builder_build(&builder, tree, err);
    builder_release(&builder);
    free(bytes);
    return status;
}

Status tree_write(const Tree *tree, const char *path, Err *err)
{
    OutFile file;
    TRY(tree_format_check(path, err));
    TRY(tree_check(tree, err));
    TRY(outfile_open(&file, path, err));
    Status status = find_format(path, NULL)->write(tree, file.stream, err);
    if (status == STATUS_OK)
        return outfile_commit(&file, err);
    outfile_discard(&file);
    return status;
}
