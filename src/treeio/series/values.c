/* Reads a CSV of values whose first line names the columns. The column id or name identifies the
 * segments. If there is a column time, a row holds the values of one segment at one time; otherwise
 * the values of one segment. The key of a row leads to a list of nodes: an id has one node, the
 * number of a branch of SimVascular has many.
 *
 * The names of the tree's columns are decided before the first row is read, and only wanted columns
 * take memory. Rows with a time are stored until the end of the file, because the set of all times
 * is known only then. They are sorted by segment and time, so that a missing or repeated row is
 * found by a look at its neighbours. */
#include "treeio/series/values.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { NO_INDEX = -1 };

/* A column of the file. */
typedef struct ValueColumn {
    char *name;       /* the column's name in the tree; owned */
    const char *unit; /* borrowed from the text */
    bool wanted;      /* the column is read; false for keys and times */
    double *value;    /* the values of the tree's column, owned by the tree; NULL: none yet */
} ValueColumn;

/* The values of a segment at a time. */
typedef struct TimedRow {
    int32_t key;
    double time;
    size_t line, values; /* line of the file; index of the row's first value in `held` */
} TimedRow;

typedef struct ValuesReader {
    Tree *tree;
    const char *path, *wanted;  /* NULL: all columns are wanted */
    bool is_single;             /* all wanted columns must be one column or one series */
    char *single_name;          /* its name; owned */
    int key, time;              /* indices of these columns, or NONE */
    ARRAY(ValueColumn) columns; /* all columns of the file */
    size_t n_wanted;
    char **field;     /* the fields of one row; owned */
    IndexLists nodes; /* per key: its nodes */
    size_t *line_of;  /* per key: the line of its last row, 0: none yet; NULL: no row yet; owned */
    bool of_branches; /* keys are numbers of branches */
    ARRAY(TimedRow) rows;
    ARRAY(double) held; /* the wanted values of all rows with a time */
} ValuesReader;

static void reader_release(ValuesReader *reader)
{
    for (size_t i = 0; i < reader->columns.n; i++)
        free(reader->columns.items[i].name);
    ARRAY_RELEASE(&reader->columns);
    free(reader->field);
    indexlists_release(&reader->nodes);
    free(reader->line_of);
    ARRAY_RELEASE(&reader->rows);
    ARRAY_RELEASE(&reader->held);
    free(reader->single_name);
}

/* ---- titles ---------------------------------------------------------------------------------- */

/* Adds a column by its title. */
static Status add_field(ValuesReader *reader, char *title, Err *err)
{
    int index = (int)reader->columns.n;
    bool is_key = strcmp(title, "id") == 0 || strcmp(title, "name") == 0;
    bool is_time = strcmp(title, "time") == 0;
    if (index > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT,
                       "the file has more than %d columns of values, the maximum",
                       BUILDER_MAX_COLUMNS);
    if ((is_key && reader->key != NO_INDEX) || (is_time && reader->time != NO_INDEX))
        return err_set(err, STATUS_INPUT, "two columns state the %s; only one may",
                       is_key ? "segment" : "time of a row");
    ValueColumn made = {.wanted = !is_key && !is_time, .unit = csv_unit(title)};
    if (made.wanted && !*title)
        return err_set(err, STATUS_INPUT, "column %d has no name", index + 1);
    TRY(ARRAY_RESERVE(&reader->columns, 1, "columns", err));
    TRY(mem_strdup(&made.name, title, err));
    reader->key = is_key ? index : reader->key;
    reader->time = is_time ? index : reader->time;
    reader->columns.items[index] = made;
    reader->columns.n++;
    return STATUS_OK;
}

/* Renames a column to "BASE_TIME". */
static Status rename_column(ValueColumn *column, const char *base, const char *time, Err *err)
{
    char *name;
    TRY(mem_printf(&name, err, "%s_%s", base, time));
    free(column->name);
    column->name = name;
    return STATUS_OK;
}

static bool is_number(const char *text)
{
    double number;
    return number_parse(text, &number) && isfinite(number);
}

/* Renames the columns whose names are times, so that they form a series called `base`. With
 * `by_order`, all wanted columns form the series, and their times are 0, 1, ... */
static Status name_frames(ValuesReader *reader, const char *base, bool by_order, Err *err)
{
    int frame = 0;
    for (size_t i = 0; i < reader->columns.n; i++) {
        ValueColumn *column = &reader->columns.items[i];
        char number[16];
        if (!column->wanted)
            continue;
        snprintf(number, sizeof number, "%d", frame++);
        if (by_order || is_number(column->name))
            TRY(rename_column(column, base, by_order ? number : column->name, err));
    }
    return STATUS_OK;
}

/* How columns are selected: all, by their own name, or by the name of their series. */
typedef enum ColumnMatch { MATCH_ALL, MATCH_NAME, MATCH_SERIES } ColumnMatch;

/* Returns true if the column is wanted and is selected by `match` and `name`. */
static bool matches(const ValueColumn *column, ColumnMatch match, const char *name)
{
    size_t length;
    double time;
    if (!column->wanted || match == MATCH_ALL)
        return column->wanted;
    if (match == MATCH_NAME)
        return strcmp(column->name, name) == 0;
    return series_parse(column->name, &length, &time) && length == strlen(name) &&
           strncmp(column->name, name, length) == 0;
}

static size_t count_columns(const ValuesReader *reader, ColumnMatch match, const char *name)
{
    size_t count = 0;
    for (size_t i = 0; i < reader->columns.n; i++)
        count += matches(&reader->columns.items[i], match, name);
    return count;
}

static Status refuse_column(const ValuesReader *reader, Err *err)
{
    enum { SHOWN = 8 };
    Text sentence = TEXT_INIT;
    int shown = 0;
    text_printf(&sentence, "no column is called '%.40s'; the columns are ", reader->wanted);
    for (size_t i = 0; i < reader->columns.n && shown < SHOWN; i++)
        if (reader->columns.items[i].wanted)
            text_printf(&sentence, "%s%.40s", shown++ ? ", " : "", reader->columns.items[i].name);
    text_puts(&sentence, shown == SHOWN ? ", ..." : "");
    return text_to_error(&sentence, STATUS_INPUT, err);
}

/* Leaves only the column of the wanted name, or the columns of its series, wanted. */
static Status choose_wanted(ValuesReader *reader, Err *err)
{
    const char *name = reader->wanted;
    ColumnMatch match = count_columns(reader, MATCH_NAME, name) > 0 ? MATCH_NAME : MATCH_SERIES;
    if (count_columns(reader, match, name) == 0)
        return refuse_column(reader, err);
    for (size_t i = 0; i < reader->columns.n; i++)
        reader->columns.items[i].wanted = matches(&reader->columns.items[i], match, name);
    return STATUS_OK;
}

/* Checks that the wanted columns are one column or one series, and sets reader->single_name. */
static Status name_single(ValuesReader *reader, const char *base, Err *err)
{
    size_t n = count_columns(reader, MATCH_ALL, NULL), length;
    double time;
    const ValueColumn *column = reader->columns.items;
    while (!column->wanted)
        column++;
    TRY(mem_strdup(&reader->single_name, column->name, err));
    if (n == 1)
        return STATUS_OK;
    if (reader->time != NO_INDEX)
        return err_set(err, STATUS_INPUT,
                       "the file has %zu columns of values; name one, as in FILE.csv:%.40s", n,
                       column->name);
    if (series_parse(column->name, &length, &time)) {
        reader->single_name[length] = '\0';
        if (count_columns(reader, MATCH_SERIES, reader->single_name) == n)
            return STATUS_OK;
    }
    free(reader->single_name);
    reader->single_name = NULL;
    TRY(name_frames(reader, base, true, err));
    return mem_strdup(&reader->single_name, base, err);
}

/* Decides the names of the columns in the tree, and which columns are read. `base` is the file's
 * name without folders and extension. */
static Status name_columns(ValuesReader *reader, const char *base, Err *err)
{
    if (reader->time == NO_INDEX)
        TRY(name_frames(reader, base, false, err));
    if (reader->wanted)
        return choose_wanted(reader, err);
    return reader->is_single ? name_single(reader, base, err) : STATUS_OK;
}

/* Makes a column of the tree, or clears an old one. Columns of the tree from index `before` on come
 * from this file, and their names must differ. */
static Status open_column(ValuesReader *reader, const char *name, const char *unit, size_t before,
                          double **value, Err *err)
{
    const TreeColumn *there = tree_column(reader->tree, name);
    if (there && (size_t)(there - reader->tree->column) >= before)
        return err_set(err, STATUS_INPUT, "two columns are called '%.60s'", name);
    return tree_set_column(reader->tree, name, unit, value, err);
}

/* Checks that the machine has memory for the values of this many columns. */
static Status check_memory(const ValuesReader *reader, size_t columns, Err *err)
{
    return mem_check((double)columns * (double)reader->tree->n * sizeof(double), reader->path, err);
}

static Status open_columns(ValuesReader *reader, Err *err)
{
    size_t before = reader->tree->n_columns;
    TRY(check_memory(reader, reader->n_wanted, err));
    for (size_t i = 0; i < reader->columns.n; i++) {
        ValueColumn *column = &reader->columns.items[i];
        if (column->wanted)
            TRY(open_column(reader, column->name, column->unit, before, &column->value, err));
    }
    return STATUS_OK;
}

/* Reads the first line, and decides which columns are read. */
static Status read_titles(ValuesReader *reader, char *line, Err *err)
{
    const char *name = file_name(reader->path), *dot = strrchr(name, '.');
    char *base = NULL;
    for (char *at = line, *title; at;) {
        TRY(csv_field(&at, ',', &title, err));
        TRY(add_field(reader, title, err));
    }
    if (reader->key == NO_INDEX || count_columns(reader, MATCH_ALL, NULL) == 0)
        return err_set(err, STATUS_INPUT,
                       reader->key == NO_INDEX
                           ? "no column is called id or name, which must identify the segments"
                           : "the file has no column of values");
    TRY(mem_calloc(&reader->field, reader->columns.n, sizeof *reader->field, "fields", err));
    TRY(mem_strdup(&base, name, err));
    if (dot && dot > name)
        base[dot - name] = '\0';
    Status status = name_columns(reader, base, err);
    free(base);
    TRY(status);
    reader->n_wanted = count_columns(reader, MATCH_ALL, NULL);
    return reader->time == NO_INDEX ? open_columns(reader, err) : STATUS_OK;
}

/* ---- the segments of a row ------------------------------------------------------------------- */

/* Returns the number in "branch12_seg0", or NONE for any other name. */
static int32_t branch_of(const char *name)
{
    long long number;
    char digits[16];
    size_t length = strcspn(name + (strncmp(name, "branch", 6) == 0 ? 6 : 0), "_");
    if (strncmp(name, "branch", 6) != 0 || strcmp(name + 6 + length, "_seg0") != 0 ||
        length >= sizeof digits)
        return NO_INDEX;
    memcpy(digits, name + 6, length);
    digits[length] = '\0';
    return integer_parse(digits, 0, TREE_MAX_ID, &number) ? (int32_t)number : NO_INDEX;
}

/* Returns the key of node i, or NONE: its id, or its value in the column `branches`. */
static int32_t node_key(const ValuesReader *reader, const TreeColumn *branches, size_t i)
{
    if (!branches)
        return reader->tree->id[i];
    double value = branches->value[i];
    return value >= 0 && value <= TREE_MAX_ID && value == floor(value) ? (int32_t)value : NO_INDEX;
}

/* Lists the nodes of each key. Keys are ids or, by the name in the first row, numbers of branches.
 * In a tree without the column BranchId, the number of a branch is the id of its one segment. */
static Status index_nodes(ValuesReader *reader, const char *name, Err *err)
{
    const Tree *tree = reader->tree;
    IndexLists *nodes = &reader->nodes;
    int32_t n_keys = 0, key;
    reader->of_branches = branch_of(name) != NO_INDEX;
    const TreeColumn *branches = reader->of_branches ? tree_column(tree, "BranchId") : NULL;
    for (size_t i = 0; i < tree->n; i++)
        if (node_key(reader, branches, i) >= n_keys)
            n_keys = node_key(reader, branches, i) + 1;
    TRY(mem_calloc(&reader->line_of, (size_t)n_keys, sizeof *reader->line_of, "keys", err));
    TRY(indexlists_begin(nodes, (size_t)n_keys, "keys", err));
    for (size_t i = 0; i < tree->n; i++)
        if ((key = node_key(reader, branches, i)) != NO_INDEX)
            indexlists_count(nodes, (size_t)key);
    TRY(indexlists_allot(nodes, "keys", err));
    for (size_t i = 0; i < tree->n; i++)
        if ((key = node_key(reader, branches, i)) != NO_INDEX)
            indexlists_put(nodes, (size_t)key, (uint32_t)i);
    return STATUS_OK;
}

/* Finds the key that a row names. The first row decides what keys are. */
static Status find_key(ValuesReader *reader, const char *name, int32_t *key, Err *err)
{
    long long number = NO_INDEX;
    if (!reader->line_of)
        TRY(index_nodes(reader, name, err));
    if (reader->of_branches)
        number = branch_of(name);
    else if (!integer_parse(name, 0, INT32_MAX, &number))
        return err_set(err, STATUS_INPUT, "the segment id is '%.40s'; it must be an integer", name);
    if (number < 0 || (size_t)number >= reader->nodes.n ||
        indexlists_length(&reader->nodes, (size_t)number) == 0)
        return err_set(err, STATUS_INPUT, "the tree has no segment with the id %.40s", name);
    *key = (int32_t)number;
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Sets the value of all nodes of a key. */
static void put_value(const ValuesReader *reader, int32_t key, double *column, double value)
{
    const IndexLists *nodes = &reader->nodes;
    for (uint32_t i = nodes->first[key]; i < nodes->first[key + 1]; i++)
        column[nodes->items[i]] = value;
}

/* Stores the wanted values of a row: in the tree, or in `held` if the row has a time. */
static Status store_values(ValuesReader *reader, int32_t key, Err *err)
{
    for (size_t i = 0; i < reader->columns.n; i++) {
        const ValueColumn *column = &reader->columns.items[i];
        double value;
        if (!column->wanted)
            continue;
        TRY(field_value(column->name, reader->field[i], &value, err));
        if (reader->time != NO_INDEX)
            TRY(ARRAY_PUSH(&reader->held, "values", err, value));
        else
            put_value(reader, key, column->value, value);
    }
    return STATUS_OK;
}

static Status read_row(ValuesReader *reader, size_t line, char *text, Err *err)
{
    TimedRow row = {.line = line, .values = reader->held.n};
    TRY(csv_row(text, ',', reader->field, reader->columns.n, err));
    const char *name = reader->field[reader->key];
    TRY(find_key(reader, name, &row.key, err));
    if (reader->time == NO_INDEX && reader->line_of[row.key])
        return err_set(err, STATUS_INPUT, "segment %.40s already has a row, in line %zu", name,
                       reader->line_of[row.key]);
    reader->line_of[row.key] = line;
    if (reader->time != NO_INDEX) {
        TRY(field_number("time", reader->field[reader->time], -HUGE_VAL, &row.time, err));
        TRY(ARRAY_PUSH(&reader->rows, "rows", err, row));
    }
    return store_values(reader, row.key, err);
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    ValuesReader *reader = context;
    if (*line == '#' || !line[strspn(line, TEXT_BLANKS)])
        return STATUS_OK;
    return reader->columns.n > 0 ? read_row(reader, number, line, err)
                                 : read_titles(reader, line, err);
}

/* ---- rows with a time ------------------------------------------------------------------------ */

static int by_key_and_time(const void *a, const void *b)
{
    const TimedRow *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    int order = compare_numbers(x->time, y->time);
    return order ? order : (x->line > y->line) - (x->line < y->line);
}

/* Lists the times of all rows, each once, by rising time. The caller frees *times. */
static Status list_times(const ValuesReader *reader, double **times, size_t *n, Err *err)
{
    double *made;
    TRY(mem_calloc(&made, reader->rows.n, sizeof *made, "times", err));
    for (size_t i = 0; i < reader->rows.n; i++)
        made[i] = reader->rows.items[i].time;
    sort_numbers(made, reader->rows.n);
    *n = 0;
    for (size_t i = 0; i < reader->rows.n; i++)
        if (*n == 0 || made[i] != made[*n - 1])
            made[(*n)++] = made[i];
    *times = made;
    return STATUS_OK;
}

/* Checks that the n rows from `row` on are those of one segment at the n times. */
static Status check_times(const ValuesReader *reader, const TimedRow *row, const double *times,
                          size_t n, Err *err)
{
    const TimedRow *end = reader->rows.items + reader->rows.n;
    const char *kind = reader->of_branches ? "branch" : "segment";
    char time[NUMBER_TEXT_SIZE];
    for (size_t k = 0; k < n; k++) {
        bool is_next = row + k < end && row[k].key == row->key;
        if (is_next && k > 0 && row[k].time == row[k - 1].time)
            return err_set(err, STATUS_INPUT,
                           "%s:%zu: %s %d at time %s already has a row, in line %zu", reader->path,
                           row[k].line, kind, row->key, number_text(times[k - 1], time),
                           row[k - 1].line);
        if (!is_next || row[k].time != times[k])
            return err_set(err, STATUS_INPUT, "%s: %s %d has no row for time %s, which others have",
                           reader->path, kind, row->key, number_text(times[k], time));
    }
    if (row + n < end && row[n].key == row->key)
        return err_set(err, STATUS_INPUT, "%s:%zu: %s %d at time %s has two rows", reader->path,
                       row[n].line, kind, row->key, number_text(row[n].time, time));
    return STATUS_OK;
}

static Status check_all_times(const ValuesReader *reader, const double *times, size_t n, Err *err)
{
    if (n * reader->n_wanted > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "%s: the file has %zu times; at most %zu can be read",
                       reader->path, n, BUILDER_MAX_COLUMNS / reader->n_wanted);
    for (size_t i = 0; i < reader->rows.n; i += n)
        TRY(check_times(reader, reader->rows.items + i, times, n, err));
    return check_memory(reader, n * reader->n_wanted, err);
}

/* Makes one column of the tree per time for a wanted column, the `number`th from 0. If there is
 * only one time, the column's name stays without the time, because one column is no series. */
static Status fill_frames(ValuesReader *reader, const ValueColumn *column, size_t number,
                          const double *times, size_t n, Err *err)
{
    size_t before = reader->tree->n_columns;
    for (size_t k = 0; k < n; k++) {
        char time[NUMBER_TEXT_SIZE];
        char *name;
        double *value;
        TRY(mem_printf(&name, err, n > 1 ? "%s_%s" : "%s", column->name,
                       number_text(times[k], time)));
        Status status = open_column(reader, name, column->unit, before, &value, err);
        free(name);
        TRY(status);
        for (size_t i = k; i < reader->rows.n; i += n)
            put_value(reader, reader->rows.items[i].key, value,
                      reader->held.items[reader->rows.items[i].values + number]);
    }
    return STATUS_OK;
}

/* Moves the rows with a time to columns of the tree. */
static Status fill_times(ValuesReader *reader, Err *err)
{
    double *times = NULL;
    size_t n = 0, number = 0;
    if (reader->time == NO_INDEX || reader->rows.n == 0)
        return STATUS_OK;
    TRY(list_times(reader, &times, &n, err));
    qsort(reader->rows.items, reader->rows.n, sizeof *reader->rows.items, by_key_and_time);
    Status status = check_all_times(reader, times, n, err);
    for (size_t i = 0; i < reader->columns.n && status == STATUS_OK; i++)
        if (reader->columns.items[i].wanted)
            status = fill_frames(reader, &reader->columns.items[i], number++, times, n, err);
    free(times);
    return status;
}

/* ---- files ----------------------------------------------------------------------------------- */

static const FileForm form = {.name = "a CSV file", .most_bytes = 4e9, .is_text = true};

static Status read_csv(ValuesReader *reader, Err *err)
{
    char *bytes = NULL;
    size_t size = 0;
    Status status = STATUS_OK;
    TRY(file_read(reader->path, &form, &bytes, &size, err));
    TRY_GOTO(lines_read(reader->path, bytes, size, read_line, reader, err));
    TRY_GOTO(fill_times(reader, err));
    if (!reader->line_of)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: the file has no values", reader->path));
done:
    free(bytes);
    return status;
}

/* Returns true if the first `length` characters of `path` are the path of a folder. */
static bool is_folder(const char *path, size_t length)
{
    struct stat about;
    char copy[4096]; /* PATH_MAX of Linux */
    if (length >= sizeof copy)
        return false;
    memcpy(copy, path, length);
    copy[length] = '\0';
    return stat(copy, &about) == 0 && S_ISDIR(about.st_mode);
}

bool values_parse(const char *text, size_t *path_length, const char **column)
{
    size_t length = strcspn(text, ":");
    if (length > 0 && is_folder(text, length)) {
        *path_length = length;
        *column = text[length] ? text + length + 1 : NULL;
        return true;
    }
    for (const char *end = text; *end; end++) {
        bool is_end = strncasecmp(end, ".csv", 4) == 0 && (end[4] == '\0' || end[4] == ':');
        if (!is_end || end == text)
            continue;
        *path_length = (size_t)(end + 4 - text);
        *column = end[4] ? end + 5 : NULL;
        return true;
    }
    return false;
}

Status tree_read_values(Tree *tree, const char *path, const char *column, char **name, Err *err)
{
    ValuesReader reader = {.tree = tree,
                           .path = path,
                           .wanted = column,
                           .is_single = name != NULL,
                           .key = NO_INDEX,
                           .time = NO_INDEX};
    Status status = is_folder(path, strlen(path)) ? steps_read(tree, path, column, err)
                                                  : read_csv(&reader, err);
    TRY_GOTO(status);
    if (name)
        status = mem_strdup(name, column ? column : reader.single_name, err);
done:
    reader_release(&reader);
    return status;
}

/* ---- flows ----------------------------------------------------------------------------------- */

/* Checks the flows that were read, copies them to `share`, with 0 for missing ones, and adds them.
 */
static Status sum_flows(const Tree *tree, const char *path, double *share, double *sum, Err *err)
{
    const TreeColumn *flow = &tree->column[0];
    *sum = 0;
    if (tree->n_columns != 1 || (*flow->unit && strcmp(flow->unit, "ml/min") != 0))
        return err_set(err, STATUS_INPUT,
                       "%s: the file must have exactly one column called flow, in ml/min", path);
    for (size_t i = 0; i < tree->n; i++) {
        share[i] = isnan(flow->value[i]) ? 0 : flow->value[i];
        if (share[i] < 0)
            return err_set(err, STATUS_INPUT, "%s: a flow is %g; it must be 0 or more", path,
                           share[i]);
        *sum += share[i];
    }
    if (!(*sum > 0 && isfinite(*sum)))
        return err_set(err, STATUS_INPUT, "%s: all flows are 0; at least one must be above 0",
                       path);
    return STATUS_OK;
}

/* The flows are read into the only column of a shallow copy of the tree, so that the tree's own
 * columns stay unchanged. */
Status tree_read_flows(Tree *tree, const char *path, Err *err)
{
    Tree only = {.n = tree->n, .id = tree->id};
    double *share = NULL, sum;
    Status status = STATUS_OK;
    TRY_GOTO(tree_read_values(&only, path, "flow", NULL, err));
    TRY_GOTO(mem_calloc(&share, tree->n, sizeof *share, "flow shares", err));
    TRY_GOTO(sum_flows(&only, path, share, &sum, err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_has_link(tree, i)) { /* a node with a link has no share of its own */
            share[tree->link[i]] += share[i];
            share[i] = 0;
        }
    tree_set_flow_shares(tree, share);
    tree->meta.number[META_Q_PERF] = sum;
    tree->meta.known[META_Q_PERF] = true;
    share = NULL;
done:
    only.id = NULL; /* owned by `tree` */
    tree_release(&only);
    free(share);
    return status;
}
