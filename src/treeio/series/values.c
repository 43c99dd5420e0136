/* Reads a CSV whose first line names the columns. One of them, id or name, identifies the segments.
 * With a column time, a row is about one segment at one time; otherwise about one segment. A row
 * finds its nodes in the list of its key: an id has one node, a branch of SimVascular has many.
 *
 * The columns of values get their names in the tree before any row is read, and only wanted columns
 * take memory. Rows with a time are kept until all are read, because only then the frames are
 * known. They are sorted by segment and time, so that what is missing or given twice stands beside
 * its neighbours. */
#include "treeio/series/values.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { NONE = -1 };

/* A column of the file. */
typedef struct ValueColumn {
    char *name;       /* in the tree; owned */
    const char *unit; /* borrowed from the text */
    bool wanted;
    double *value; /* of the tree's column; NULL before there is one */
} ValueColumn;

/* The values of a segment at a time. */
typedef struct TimedRow {
    int32_t key;
    double time;
    size_t line, values; /* line of the file; index of the first value in `held` */
} TimedRow;

typedef struct ValuesReader {
    Tree *tree;
    const char *path, *wanted;  /* NULL: all columns are wanted */
    bool one_thing;             /* all columns are one series or one column */
    char *what;                 /* its name; owned */
    int key, time;              /* indices of these columns, or NONE */
    ARRAY(ValueColumn) columns; /* of all fields; keys and times are not wanted */
    size_t n_wanted;
    char **field;     /* of one row; owned */
    IndexLists nodes; /* the nodes of each key */
    size_t *line_of;  /* per key: its line; 0: none yet; NULL: there was no row; owned */
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
    free(reader->what);
}

/* ---- titles ---------------------------------------------------------------------------------- */

static Status add_field(ValuesReader *reader, char *title, Err *err)
{
    int index = (int)reader->columns.n;
    bool is_key = strcmp(title, "id") == 0 || strcmp(title, "name") == 0;
    bool is_time = strcmp(title, "time") == 0;
    if (index > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT,
                       "the file has more than %d columns of values, the maximum",
                       BUILDER_MAX_COLUMNS);
    if ((is_key && reader->key != NONE) || (is_time && reader->time != NONE))
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

/* Calls the column "BASE_TIME". */
static Status rename_column(ValueColumn *column, const char *base, const char *time, Err *err)
{
    Text name = TEXT_INIT;
    char *taken;
    text_printf(&name, "%s_%s", base, time);
    Status status = text_take(&name, &taken, err);
    text_release(&name);
    TRY(status);
    free(column->name);
    column->name = taken;
    return STATUS_OK;
}

static bool is_number(const char *text)
{
    double number;
    return number_parse(text, &number) && isfinite(number);
}

/* Names that are times become those of a series named after the file. If each column is a frame,
 * all names become those of the series, by their order from 0 on. */
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

/* What columns are counted or chosen by. */
typedef enum ColumnMatch { MATCH_ALL, MATCH_NAME, MATCH_SERIES } ColumnMatch;

/* Returns true if a wanted column has the name, or is of the series of this name. */
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
    Text known = TEXT_INIT;
    int shown = 0;
    for (size_t i = 0; i < reader->columns.n && shown < SHOWN; i++)
        if (reader->columns.items[i].wanted)
            text_printf(&known, "%s%.40s", shown++ ? ", " : "", reader->columns.items[i].name);
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&known, err));
    status = err_set(err, STATUS_INPUT, "no column is called '%.40s'; the columns are %s%s",
                     reader->wanted, text_chars(&known), shown == SHOWN ? ", ..." : "");
done:
    text_release(&known);
    return status;
}

/* Only the column of the wanted name, or its series, stays wanted. */
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

/* Finds what all columns are together, and sets reader->what. */
static Status name_whole(ValuesReader *reader, const char *base, Err *err)
{
    size_t n = count_columns(reader, MATCH_ALL, NULL), length;
    double time;
    const ValueColumn *column = reader->columns.items;
    while (!column->wanted)
        column++;
    TRY(mem_strdup(&reader->what, column->name, err));
    if (n == 1)
        return STATUS_OK;
    if (reader->time != NONE)
        return err_set(err, STATUS_INPUT,
                       "the file has %zu columns of values; name one, as in FILE.csv:%.40s", n,
                       column->name);
    if (series_parse(column->name, &length, &time)) {
        reader->what[length] = '\0';
        if (count_columns(reader, MATCH_SERIES, reader->what) == n)
            return STATUS_OK;
    }
    free(reader->what);
    reader->what = NULL;
    TRY(name_frames(reader, base, true, err));
    return mem_strdup(&reader->what, base, err);
}

/* Decides how the columns are called in the tree and which are read. `base` is the file's name
 * without folders and extension. */
static Status name_columns(ValuesReader *reader, const char *base, Err *err)
{
    if (reader->time == NONE)
        TRY(name_frames(reader, base, false, err));
    if (reader->wanted)
        return choose_wanted(reader, err);
    return reader->one_thing ? name_whole(reader, base, err) : STATUS_OK;
}

/* Makes a column of the tree. Columns from `before` on are the file's, which have other names. */
static Status open_column(ValuesReader *reader, const char *name, const char *unit, size_t before,
                          double **value, Err *err)
{
    const TreeColumn *there = tree_column(reader->tree, name);
    if (there && (size_t)(there - reader->tree->column) >= before)
        return err_set(err, STATUS_INPUT, "two columns are called '%.60s'", name);
    return tree_set_column(reader->tree, name, unit, value, err);
}

static Status check_room(const ValuesReader *reader, size_t columns, Err *err)
{
    return mem_check((double)columns * (double)reader->tree->n * sizeof(double), reader->path, err);
}

static Status open_columns(ValuesReader *reader, Err *err)
{
    size_t before = reader->tree->n_columns;
    TRY(check_room(reader, reader->n_wanted, err));
    for (size_t i = 0; i < reader->columns.n; i++) {
        ValueColumn *column = &reader->columns.items[i];
        if (column->wanted)
            TRY(open_column(reader, column->name, column->unit, before, &column->value, err));
    }
    return STATUS_OK;
}

static Status read_titles(ValuesReader *reader, char *line, Err *err)
{
    const char *name = file_name(reader->path), *dot = strrchr(name, '.');
    Text base = TEXT_INIT;
    for (char *at = line, *title; at;) {
        TRY(csv_field(&at, ',', &title, err));
        TRY(add_field(reader, title, err));
    }
    if (reader->key == NONE || count_columns(reader, MATCH_ALL, NULL) == 0)
        return err_set(err, STATUS_INPUT,
                       reader->key == NONE
                           ? "no column is called id or name, which must identify the segments"
                           : "the file has no column of values");
    TRY(mem_calloc(&reader->field, reader->columns.n, sizeof *reader->field, "fields", err));
    text_append(&base, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
    Status status = STATUS_OK;
    TRY_GOTO(text_check(&base, err));
    status = name_columns(reader, text_chars(&base), err);
done:
    text_release(&base);
    TRY(status);
    reader->n_wanted = count_columns(reader, MATCH_ALL, NULL);
    return reader->time == NONE ? open_columns(reader, err) : STATUS_OK;
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
        return NONE;
    memcpy(digits, name + 6, length);
    digits[length] = '\0';
    return integer_parse(digits, 0, TREE_MAX_ID, &number) ? (int32_t)number : NONE;
}

/* Returns the key of a node, or NONE. */
static int32_t key_of(const ValuesReader *reader, const TreeColumn *branches, size_t i)
{
    if (!branches)
        return reader->tree->id[i];
    double value = branches->value[i];
    return value >= 0 && value <= TREE_MAX_ID && value == floor(value) ? (int32_t)value : NONE;
}

/* Lists the nodes of each key. Keys are ids or, by the name in the first row, numbers of branches.
 * In a tree without the column BranchId, the number of a branch is the id of its one segment. */
static Status index_nodes(ValuesReader *reader, const char *name, Err *err)
{
    const Tree *tree = reader->tree;
    IndexLists *nodes = &reader->nodes;
    int32_t n_keys = 0, key;
    reader->of_branches = branch_of(name) != NONE;
    const TreeColumn *branches = reader->of_branches ? tree_column(tree, "BranchId") : NULL;
    for (size_t i = 0; i < tree->n; i++)
        if (key_of(reader, branches, i) >= n_keys)
            n_keys = key_of(reader, branches, i) + 1;
    TRY(mem_calloc(&reader->line_of, (size_t)n_keys, sizeof *reader->line_of, "keys", err));
    TRY(indexlists_begin(nodes, (size_t)n_keys, "keys", err));
    for (size_t i = 0; i < tree->n; i++)
        if ((key = key_of(reader, branches, i)) != NONE)
            indexlists_count(nodes, (size_t)key);
    TRY(indexlists_allot(nodes, "keys", err));
    for (size_t i = 0; i < tree->n; i++)
        if ((key = key_of(reader, branches, i)) != NONE)
            indexlists_put(nodes, (size_t)key, (uint32_t)i);
    return STATUS_OK;
}

static Status find_key(ValuesReader *reader, const char *name, int32_t *key, Err *err)
{
    long long number = NONE;
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

static void put_value(const ValuesReader *reader, int32_t key, double *column, double value)
{
    const IndexLists *nodes = &reader->nodes;
    for (uint32_t i = nodes->first[key]; i < nodes->first[key + 1]; i++)
        column[nodes->items[i]] = value;
}

static Status take_values(ValuesReader *reader, int32_t key, Err *err)
{
    for (size_t i = 0; i < reader->columns.n; i++) {
        const ValueColumn *column = &reader->columns.items[i];
        double value;
        if (!column->wanted)
            continue;
        TRY(field_value(column->name, reader->field[i], &value, err));
        if (reader->time != NONE)
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
    if (reader->time == NONE && reader->line_of[row.key])
        return err_set(err, STATUS_INPUT, "segment %.40s already has a row, in line %zu", name,
                       reader->line_of[row.key]);
    reader->line_of[row.key] = line;
    if (reader->time != NONE) {
        TRY(field_number("time", reader->field[reader->time], -HUGE_VAL, &row.time, err));
        TRY(ARRAY_PUSH(&reader->rows, "rows", err, row));
    }
    return take_values(reader, row.key, err);
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
    int order = number_order(x->time, y->time);
    return order ? order : (x->line > y->line) - (x->line < y->line);
}

/* All times, each once, upwards, in *times (owned). */
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

/* Whether the rows from `row` on are of one segment at all n times. */
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
    return check_room(reader, n * reader->n_wanted, err);
}

/* Opens a column by a name, which it releases. */
static Status open_named(ValuesReader *reader, Text *name, const char *unit, size_t before,
                         double **value, Err *err)
{
    Status status = STATUS_OK;
    TRY_GOTO(text_check(name, err));
    status = open_column(reader, text_chars(name), unit, before, value, err);
done:
    text_release(name);
    return status;
}

/* The frames of a wanted column, its `number`th. A value that does not change is no series. */
static Status fill_frames(ValuesReader *reader, const ValueColumn *column, size_t number,
                          const double *times, size_t n, Err *err)
{
    size_t before = reader->tree->n_columns;
    for (size_t k = 0; k < n; k++) {
        char time[NUMBER_TEXT_SIZE];
        double *value;
        Text name = TEXT_INIT;
        text_printf(&name, n > 1 ? "%s_%s" : "%s", column->name, number_text(times[k], time));
        TRY(open_named(reader, &name, column->unit, before, &value, err));
        for (size_t i = k; i < reader->rows.n; i += n)
            put_value(reader, reader->rows.items[i].key, value,
                      reader->held.items[reader->rows.items[i].values + number]);
    }
    return STATUS_OK;
}

static Status fill_times(ValuesReader *reader, Err *err)
{
    double *times = NULL;
    size_t n = 0, number = 0;
    if (reader->time == NONE || reader->rows.n == 0)
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

static bool is_folder(const char *path, size_t length)
{
    struct stat about;
    char copy[4096]; /* the system takes no longer path */
    if (length >= sizeof copy)
        return false;
    memcpy(copy, path, length);
    copy[length] = '\0';
    return stat(copy, &about) == 0 && S_ISDIR(about.st_mode);
}

bool values_parse(const char *text, size_t *path, const char **column)
{
    size_t length = strcspn(text, ":");
    if (length > 0 && is_folder(text, length)) {
        *path = length;
        *column = text[length] ? text + length + 1 : NULL;
        return true;
    }
    for (const char *end = text; *end; end++) {
        bool is_end = strncasecmp(end, ".csv", 4) == 0 && (end[4] == '\0' || end[4] == ':');
        if (!is_end || end == text)
            continue;
        *path = (size_t)(end + 4 - text);
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
                           .one_thing = name != NULL,
                           .key = NONE,
                           .time = NONE};
    Status status = is_folder(path, strlen(path)) ? steps_read(tree, path, column, err)
                                                  : read_csv(&reader, err);
    TRY_GOTO(status);
    if (name)
        status = mem_strdup(name, column ? column : reader.what, err);
done:
    reader_release(&reader);
    return status;
}

/* ---- flows ----------------------------------------------------------------------------------- */

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

/* The flows are read as a column, which becomes the shares. */
Status tree_read_flows(Tree *tree, const char *path, Err *err)
{
    Tree only = {.n = tree->n, .id = tree->id};
    double *share = NULL, sum;
    Status status = STATUS_OK;
    TRY_GOTO(tree_read_values(&only, path, "flow", NULL, err));
    TRY_GOTO(mem_calloc(&share, tree->n, sizeof *share, "flow shares", err));
    TRY_GOTO(sum_flows(&only, path, share, &sum, err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_link(tree, i)) { /* the flow leaves at the place of the node */
            share[tree->link[i]] += share[i];
            share[i] = 0;
        }
    tree_set_flow_shares(tree, share);
    tree->meta.number[META_Q_PERF] = sum;
    tree->meta.known[META_Q_PERF] = true;
    share = NULL;
done:
    only.id = NULL; /* the tree's */
    tree_release(&only);
    free(share);
    return status;
}
