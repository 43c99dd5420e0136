/* A folder that svOneDSolver has written, OUTPUT TEXT: a file for each segment and quantity,
 *
 *     MODEL SEGMENT _flow.dat
 *
 * a row for each of the segment's points from its inlet to its outlet, a column for each time step,
 * no header. A segment's value is that of the last row, its distal end. What the segment is called
 * ends in its id, as in the decks that corcast writes ("segment12"). */
#include "treeio/series/values.h"

#include "treeio/formats.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* What the quantities are in. */
static const struct {
    const char *name, *unit;
} quantities[] = {
    {"flow", "cm3/s"}, {"pressure", "dyn/cm2"}, {"area", "cm2"}, {"wss", "dyn/cm2"}, {"Re", ""}};

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

typedef struct StepsReader {
    Tree *tree;
    const char *folder, *quantity, *unit;
    char **name; /* of the files; owned */
    size_t n, capacity;
    int32_t *node; /* of each id, -1: none; owned */
    int32_t n_ids;
    size_t *file_of; /* of each node, from 1 on; 0: none yet; owned */
    double **column; /* the tree's, one for each step; owned */
    size_t steps;    /* 0 before the first file */
} StepsReader;

static void release(StepsReader *reader)
{
    for (size_t i = 0; i < reader->n; i++)
        free(reader->name[i]);
    free(reader->name);
    free(reader->node);
    free(reader->file_of);
    free(reader->column);
}

/* Where "_flow.dat" begins in the name of a file; 0: it is none. */
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

static Status list_files(StepsReader *reader, Err *err)
{
    DIR *folder = opendir(reader->folder);
    if (!folder)
        return err_set(err, STATUS_IO, "%s: cannot be read: %s", reader->folder, strerror(errno));
    Status status = STATUS_OK;
    for (struct dirent *entry; status == STATUS_OK && (entry = readdir(folder));) {
        if (!end_of_segment(reader, entry->d_name))
            continue;
        status = mem_reserve(&reader->name, &reader->capacity, reader->n + 1, sizeof *reader->name,
                             "names of files", err);
        if (status == STATUS_OK)
            status = mem_strdup(&reader->name[reader->n], entry->d_name, err);
        reader->n += status == STATUS_OK;
    }
    closedir(folder);
    TRY(status);
    if (reader->n == 0)
        return err_set(err, STATUS_INPUT, "%s: there is no file ..._%s.dat in it", reader->folder,
                       reader->quantity);
    qsort(reader->name, reader->n, sizeof *reader->name, by_name);
    return STATUS_OK;
}

static Status index_ids(StepsReader *reader, Err *err)
{
    const Tree *tree = reader->tree;
    for (size_t i = 0; i < tree->n; i++)
        if (tree->id[i] >= reader->n_ids)
            reader->n_ids = tree->id[i] + 1;
    TRY(mem_calloc(&reader->node, (size_t)reader->n_ids, sizeof *reader->node, "ids", err));
    TRY(mem_calloc(&reader->file_of, tree->n, sizeof *reader->file_of, "ids", err));
    for (int32_t id = 0; id < reader->n_ids; id++)
        reader->node[id] = -1;
    for (size_t i = 0; i < tree->n; i++)
        reader->node[tree->id[i]] = (int32_t)i;
    return STATUS_OK;
}

/* The node whose id the name of a file ends in, before the quantity. */
static Status find_node(StepsReader *reader, size_t file, size_t *node, Err *err)
{
    const char *name = reader->name[file];
    size_t end = end_of_segment(reader, name), start = end;
    char digits[16] = "";
    long long id;
    while (start > 0 && name[start - 1] >= '0' && name[start - 1] <= '9')
        start--;
    if (end - start < sizeof digits)
        memcpy(digits, name + start, end - start);
    if (!integer_parse(digits, 1, reader->n_ids - 1, &id) || reader->node[id] < 0)
        return err_set(err, STATUS_INPUT,
                       "the name of the segment, '%.*s', does not end in the id of one of the tree",
                       (int)(end < 60 ? end : 60), name);
    *node = (size_t)reader->node[id];
    if (reader->file_of[*node])
        return err_set(err, STATUS_INPUT, "segment %d has %s already", reader->tree->id[*node],
                       reader->name[reader->file_of[*node] - 1]);
    reader->file_of[*node] = file + 1;
    return STATUS_OK;
}

/* Makes one column for each step; a single one has no time. */
static Status open_columns(StepsReader *reader, size_t steps, Err *err)
{
    Tree *tree = reader->tree;
    if (steps > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are %zu time steps, of which at most %d are read",
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

/* Counts the numbers of a line. */
static size_t count_words(const char *line)
{
    size_t count = 0;
    for (line += strspn(line, TEXT_BLANKS); *line; count++) {
        line += strcspn(line, TEXT_BLANKS);
        line += strspn(line, TEXT_BLANKS);
    }
    return count;
}

static Status take_line(StepsReader *reader, size_t node, char *line, Err *err)
{
    size_t steps = count_words(line), k = 0;
    if (!reader->column)
        TRY(open_columns(reader, steps, err));
    if (steps != reader->steps)
        return err_set(err, STATUS_INPUT, "there are %zu time steps, and %zu in %s", steps,
                       reader->steps, reader->name[0]);
    for (char *word = line + strspn(line, TEXT_BLANKS); *word; k++) {
        char *end = word + strcspn(word, TEXT_BLANKS), *next = end + strspn(end, TEXT_BLANKS);
        *end = '\0';
        TRY(field_value(reader->quantity, word, &reader->column[k][node], err));
        word = next;
    }
    return STATUS_OK;
}

/* The last line that holds anything, and its number. */
static char *last_line(char *text, size_t *number)
{
    char *last = NULL;
    size_t count = 0;
    for (char *line; (line = text_line(&text));) {
        count++;
        if (!line[strspn(line, TEXT_BLANKS)])
            continue;
        last = line;
        *number = count;
    }
    return last;
}

static Status read_file(StepsReader *reader, size_t file, Err *err)
{
    static const FileForm form = {
        .name = "a file of time steps", .most_bytes = 4e9, .is_text = true};
    char *path = NULL, *bytes = NULL;
    size_t size, number = 1, node = 0;
    TRY(file_join(reader->folder, reader->name[file], &path, err));
    Status status = file_read(path, &form, &bytes, &size, err);
    char *line = status == STATUS_OK ? last_line(bytes, &number) : NULL;
    if (status == STATUS_OK) {
        status = find_node(reader, file, &node, err);
        if (status == STATUS_OK)
            status = line ? take_line(reader, node, line, err)
                          : err_set(err, STATUS_INPUT, "there are no values in it");
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%zu: ", path, number);
    }
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
                   "%s: of a folder of svOneDSolver one of flow, pressure, area, wss and Re is "
                   "shown, as in %s:flow",
                   reader->folder, reader->folder);
}

Status steps_read(Tree *tree, const char *folder, const char *quantity, Err *err)
{
    StepsReader reader = {.tree = tree, .folder = folder, .quantity = quantity};
    Status status = find_quantity(&reader, err);
    if (status == STATUS_OK)
        status = list_files(&reader, err);
    if (status == STATUS_OK)
        status = index_ids(&reader, err);
    for (size_t file = 0; file < reader.n && status == STATUS_OK; file++)
        status = read_file(&reader, file, err);
    release(&reader);
    return status;
}
