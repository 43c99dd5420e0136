/* Reads a result folder of svOneDSolver (OUTPUT TEXT). There is one file per segment and quantity,
 * called MODELSEGMENT_flow.dat. A file has one row per point of the segment, from its inlet to its
 * outlet, and one column per time step, without a header. The last row, at the distal end, gives
 * the values of the segment. The name of a segment ends in its id, "segment12", as in the decks
 * that corcast writes. */
#include "treeio/series/values.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The quantities of svOneDSolver and their units. */
static const struct {
    const char *name, *unit;
} quantities[] = {
    {"flow", "cm3/s"}, {"pressure", "dyn/cm2"}, {"area", "cm2"}, {"wss", "dyn/cm2"}, {"Re", ""}};

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

typedef struct StepsReader {
    Tree *tree;
    const char *folder, *quantity, *unit;
    ARRAY(char *) names; /* names of the files; owned */
    IdIndex ids;         /* the ids of the tree's nodes */
    size_t *file_of;     /* per node: index of its file + 1; 0: none yet; owned */
    double **column;     /* per time step: the values of the tree's column; owned */
    size_t steps;        /* 0 before the first file */
} StepsReader;

static void release(StepsReader *reader)
{
    for (size_t i = 0; i < reader->names.n; i++)
        free(reader->names.items[i]);
    ARRAY_RELEASE(&reader->names);
    idindex_release(&reader->ids);
    free(reader->file_of);
    free(reader->column);
}

/* Returns where "_flow.dat" begins in the name of a file, or 0 if it does not. */
static size_t end_of_segment(const StepsReader *reader, const char *name)
{
    char suffix[32];
    int length = snprintf(suffix, sizeof suffix, "_%s.dat", reader->quantity);
    size_t all = strlen(name);
    if (all <= (size_t)length || strcmp(name + all - (size_t)length, suffix) != 0)
        return 0;
    return all - (size_t)length;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Lists the files of the quantity in the folder, by name. */
static Status list_files(StepsReader *reader, Err *err)
{
    DIR *folder = opendir(reader->folder);
    Status status = STATUS_OK;
    if (!folder)
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", reader->folder, strerror(errno));
    for (struct dirent *entry; (entry = readdir(folder));) {
        char *name;
        if (!end_of_segment(reader, entry->d_name))
            continue;
        TRY_GOTO(ARRAY_RESERVE(&reader->names, 1, "names of files", err));
        TRY_GOTO(mem_strdup(&name, entry->d_name, err));
        reader->names.items[reader->names.n++] = name;
    }
    if (reader->names.n == 0)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: the folder has no file ..._%s.dat", reader->folder,
                         reader->quantity));
    qsort(reader->names.items, reader->names.n, sizeof *reader->names.items, by_name);
done:
    closedir(folder);
    return status;
}

/* Finds the node whose id ends the name of a file, before the quantity. */
static Status find_node(StepsReader *reader, size_t file, size_t *node, Err *err)
{
    const char *name = reader->names.items[file];
    size_t end = end_of_segment(reader, name), start = end, found = 0;
    char digits[16] = "";
    long long id;
    while (start > 0 && name[start - 1] >= '0' && name[start - 1] <= '9')
        start--;
    if (end - start < sizeof digits)
        memcpy(digits, name + start, end - start);
    if (integer_parse(digits, 1, TREE_MAX_ID, &id))
        found = idindex_find(&reader->ids, (int32_t)id);
    if (found == 0)
        return err_set(err, STATUS_INPUT,
                       "the segment's name, '%.*s', must end in the id of a segment of the tree",
                       (int)(end < 60 ? end : 60), name);
    *node = found - 1;
    size_t *file_of = &reader->file_of[*node];
    if (*file_of)
        return err_set(err, STATUS_INPUT, "segment %d already has %s from another file",
                       reader->tree->id[*node], reader->names.items[*file_of - 1]);
    *file_of = file + 1;
    return STATUS_OK;
}

/* Makes one column per time step. A single one has no time in its name. */
static Status open_columns(StepsReader *reader, size_t steps, Err *err)
{
    Tree *tree = reader->tree;
    if (steps > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "the file has %zu time steps; at most %d can be read",
                       steps, BUILDER_MAX_COLUMNS);
    TRY(mem_check((double)steps * (double)tree->n * sizeof(double), reader->folder, err));
    TRY(mem_calloc(&reader->column, steps, sizeof *reader->column, "time steps", err));
    for (size_t k = 0; k < steps; k++) {
        char name[64];
        snprintf(name, sizeof name, steps > 1 ? "%s_%zu" : "%s", reader->quantity, k);
        TRY(tree_set_column(tree, name, reader->unit, &reader->column[k], err));
    }
    reader->steps = steps;
    return STATUS_OK;
}

/* Reads the values of a node, one per time step. */
static Status read_values(StepsReader *reader, size_t node, char *line, Err *err)
{
    size_t steps = 0, k = 0;
    for (const char *at = line + strspn(line, TEXT_BLANKS); *at; steps++) {
        at += strcspn(at, TEXT_BLANKS);
        at += strspn(at, TEXT_BLANKS);
    }
    if (!reader->column)
        TRY(open_columns(reader, steps, err));
    if (steps != reader->steps)
        return err_set(err, STATUS_INPUT, "the file has %zu time steps, but there are %zu in %s",
                       steps, reader->steps, reader->names.items[0]);
    char *rest = NULL;
    for (char *word = strtok_r(line, TEXT_BLANKS, &rest); word;
         word = strtok_r(NULL, TEXT_BLANKS, &rest), k++)
        TRY(field_value(reader->quantity, word, &reader->column[k][node], err));
    return STATUS_OK;
}

/* Returns the last line that is not blank, or NULL. *number receives the line's number, or 1. */
static char *last_line(char *text, size_t size, size_t *number)
{
    Cursor cursor = cursor_of("", NULL, text, size);
    char *last = NULL;
    *number = 1;
    for (char *line; (line = cursor_line(&cursor));)
        if (line[strspn(line, TEXT_BLANKS)]) {
            last = line;
            *number = cursor.line;
        }
    return last;
}

static Status read_text(StepsReader *reader, size_t file, char *line, Err *err)
{
    size_t node = 0;
    TRY(find_node(reader, file, &node, err));
    return line ? read_values(reader, node, line, err)
                : err_set(err, STATUS_INPUT, "the file has no values");
}

/* Reads the file of one segment. */
static Status read_file(StepsReader *reader, size_t file, Err *err)
{
    static const FileForm form = {
        .name = "a file of time steps", .most_bytes = 4e9, .is_text = true};
    char *path = NULL, *bytes = NULL;
    size_t size, number;
    Status status = STATUS_OK;
    TRY_GOTO(file_join(reader->folder, reader->names.items[file], &path, err));
    TRY_GOTO(file_read(path, &form, &bytes, &size, err));
    char *line = last_line(bytes, size, &number);
    status = read_text(reader, file, line, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s:%zu: ", path, number);
done:
    free(bytes);
    free(path);
    return status;
}

static Status find_quantity(StepsReader *reader, Err *err)
{
    for (size_t i = 0; reader->quantity && i < QUANTITIES; i++)
        if (strcmp(quantities[i].name, reader->quantity) == 0) {
            reader->unit = quantities[i].unit;
            return STATUS_OK;
        }
    return err_set(err, STATUS_INPUT,
                   "%s: name the quantity of the result folder: flow, pressure, area, wss or Re, "
                   "as in %s:flow",
                   reader->folder, reader->folder);
}

Status steps_read(Tree *tree, const char *folder, const char *quantity, Err *err)
{
    StepsReader reader = {.tree = tree, .folder = folder, .quantity = quantity};
    Status status = STATUS_OK;
    TRY_GOTO(find_quantity(&reader, err));
    TRY_GOTO(list_files(&reader, err));
    TRY_GOTO(idindex_make(&reader.ids, tree->id, tree->n, err));
    TRY_GOTO(mem_calloc(&reader.file_of, tree->n, sizeof *reader.file_of, "ids", err));
    for (size_t file = 0; file < reader.names.n; file++)
        TRY_GOTO(read_file(&reader, file, err));
done:
    release(&reader);
    return status;
}
