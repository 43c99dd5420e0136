/* A CSV whose first line names the columns. One of them, id or name, tells the segments; with a
 * column time, a row is of one segment at one time, else of one segment. Rows find their nodes by a
 * chain for each key: an id has one node, a branch of SimVascular's many.
 *
 * The columns of values get their names in the tree before any row is read, and the wanted ones
 * alone take memory. Rows with a time wait until all are read, as only then the frames are known;
 * sorted by segment and time, what is missing or stands twice is beside its neighbours. */
#include "treeio/series/values.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { NONE = -1 };

/* A column of values of the file. */
typedef struct ValueColumn {
    char *name;       /* in the tree; owned */
    const char *unit; /* borrowed from the text */
    bool wanted;
    double *value; /* the tree's; NULL before there is one */
} ValueColumn;

/* The values of a segment at a time stand in `held`, one for each wanted column. */
typedef struct TimedRow {
    int32_t key;
    double time;
    size_t line, values;
} TimedRow;

typedef struct ValuesReader {
    Tree *tree;
    const char *path, *wanted; /* NULL: all columns */
    bool one_thing;            /* all of them are one series or column */
    char *what;                /* what that is called; owned */
    int key, time;             /* numbers of these columns; NONE */
    int n_fields;
    ValueColumn *column; /* owned; of all fields, those of keys and times not wanted */
    size_t capacity, n_wanted;
    /* Nodes by key: the first of each, then from one to the next. Owned. */
    int32_t *first, *next, n_keys;
    bool of_branches; /* keys are numbers of branches */
    size_t *line_of;  /* of each key; 0: none yet; owned */
    TimedRow *row;    /* owned */
    size_t n_rows, rows_capacity;
    double *held; /* owned */
    size_t n_held, held_capacity;
} ValuesReader;

static void reader_release(ValuesReader *reader)
{
    for (int i = 0; i < reader->n_fields; i++)
        free(reader->column[i].name);
    free(reader->column);
    free(reader->first);
    free(reader->next);
    free(reader->line_of);
    free(reader->row);
    free(reader->held);
    free(reader->what);
}

/* ---- titles ---------------------------------------------------------------------------------- */

static Status add_field(ValuesReader *reader, char *title, Err *err)
{
    bool is_key = strcmp(title, "id") == 0 || strcmp(title, "name") == 0;
    bool is_time = strcmp(title, "time") == 0;
    if (reader->n_fields > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are more than %d columns of values",
                       BUILDER_MAX_COLUMNS);
    if ((is_key && reader->key != NONE) || (is_time && reader->time != NONE))
        return err_set(err, STATUS_INPUT, "two columns tell the %s",
                       is_key ? "segment" : "time of a row");
    ValueColumn made = {.wanted = !is_key && !is_time, .unit = csv_unit(title)};
    if (made.wanted && !*title)
        return err_set(err, STATUS_INPUT, "column %d has no name", reader->n_fields + 1);
    TRY(mem_reserve(&reader->column, &reader->capacity, (size_t)reader->n_fields + 1, sizeof made,
                    "columns", err));
    TRY(mem_strdup(&made.name, title, err));
    if (is_key)
        reader->key = reader->n_fields;
    if (is_time)
        reader->time = reader->n_fields;
    reader->column[reader->n_fields++] = made;
    return STATUS_OK;
}

/* The file's name without folders and extension. */
static Status stem(const char *path, Text *out, Err *err)
{
    const char *name = file_name(path), *dot = strrchr(name, '.');
    text_append(out, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
    return text_check(out, err);
}

static Status rename_column(ValueColumn *column, const char *base, const char *time, Err *err)
{
    Text name = TEXT_INIT;
    text_printf(&name, "%s_%s", base, time);
    char *taken;
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

/* Names that are times alone become those of a series named after the file; where each column is a
 * frame, so do names that tell no time, by their order from 0 on. */
static Status name_frames(ValuesReader *reader, const char *base, bool by_order, Err *err)
{
    int frame = 0;
    for (int i = 0; i < reader->n_fields; i++) {
        ValueColumn *column = &reader->column[i];
        char number[16];
        if (!column->wanted)
            continue;
        snprintf(number, sizeof number, "%d", frame++);
        if (by_order || is_number(column->name))
            TRY(rename_column(column, base, by_order ? number : column->name, err));
    }
    return STATUS_OK;
}

/* Whether a column's name is `name`, or of the series of this name. */
static bool is_of(const ValueColumn *column, const char *name, bool series)
{
    size_t length;
    double time;
    if (!series)
        return strcmp(column->name, name) == 0;
    return series_parse(column->name, &length, &time) && length == strlen(name) &&
           strncmp(column->name, name, length) == 0;
}

static int count_of(const ValuesReader *reader, const char *name, bool series)
{
    int count = 0;
    for (int i = 0; i < reader->n_fields; i++)
        count += reader->column[i].wanted && is_of(&reader->column[i], name, series);
    return count;
}

static Status no_column(const ValuesReader *reader, Err *err)
{
    enum { SHOWN = 8 };
    Text known = TEXT_INIT;
    int shown = 0;
    for (int i = 0; i < reader->n_fields && shown < SHOWN; i++)
        if (reader->column[i].wanted)
            text_printf(&known, "%s%.40s", shown++ ? ", " : "", reader->column[i].name);
    Status status = text_check(&known, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_INPUT, "there is no column '%.40s'; there are %s%s",
                         reader->wanted, text_chars(&known), shown == SHOWN ? ", ..." : "");
    text_release(&known);
    return status;
}

/* Only the column asked for, or its series, stays wanted. */
static Status choose_wanted(ValuesReader *reader, Err *err)
{
    bool series = count_of(reader, reader->wanted, false) == 0;
    if (series && count_of(reader, reader->wanted, true) == 0)
        return no_column(reader, err);
    for (int i = 0; i < reader->n_fields; i++)
        reader->column[i].wanted =
            reader->column[i].wanted && is_of(&reader->column[i], reader->wanted, series);
    return STATUS_OK;
}

static int first_wanted(const ValuesReader *reader)
{
    int first = 0;
    while (first < reader->n_fields && !reader->column[first].wanted)
        first++;
    return first;
}

/* What all columns are together, in reader->what. */
static Status name_whole(ValuesReader *reader, const char *base, int n, Err *err)
{
    const char *first = reader->column[first_wanted(reader)].name;
    size_t length;
    double time;
    if (n == 1)
        return mem_strdup(&reader->what, first, err);
    if (reader->time != NONE)
        return err_set(err, STATUS_INPUT,
                       "there are %d columns of values; say which, as in FILE.csv:%.40s", n, first);
    Text series = TEXT_INIT;
    if (series_parse(first, &length, &time))
        text_append(&series, first, length);
    Status status = text_take(&series, &reader->what, err);
    text_release(&series);
    TRY(status);
    if (*reader->what && count_of(reader, reader->what, true) == n)
        return STATUS_OK;
    free(reader->what);
    reader->what = NULL;
    TRY(name_frames(reader, base, true, err));
    return mem_strdup(&reader->what, base, err);
}

static int count_wanted(const ValuesReader *reader)
{
    int count = 0;
    for (int i = 0; i < reader->n_fields; i++)
        count += reader->column[i].wanted;
    return count;
}

/* Settles what the columns are called in the tree and which are read. */
static Status name_columns(ValuesReader *reader, const char *base, Err *err)
{
    if (reader->time == NONE)
        TRY(name_frames(reader, base, false, err));
    if (reader->wanted)
        return choose_wanted(reader, err);
    return reader->one_thing ? name_whole(reader, base, count_wanted(reader), err) : STATUS_OK;
}

/* The column of the tree, which no other of the file is. */
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
    for (int i = 0; i < reader->n_fields; i++) {
        ValueColumn *column = &reader->column[i];
        if (column->wanted)
            TRY(open_column(reader, column->name, column->unit, before, &column->value, err));
    }
    return STATUS_OK;
}

static Status read_titles(ValuesReader *reader, char *line, Err *err)
{
    for (char *at = line; at;) {
        char *title;
        TRY(csv_field(&at, ',', &title, err));
        TRY(add_field(reader, title, err));
    }
    if (reader->key == NONE || count_wanted(reader) == 0)
        return err_set(err, STATUS_INPUT,
                       reader->key == NONE ? "there is no column id or name, to tell the segments"
                                           : "there is no column of values");
    Text base = TEXT_INIT;
    Status status = stem(reader->path, &base, err);
    if (status == STATUS_OK)
        status = name_columns(reader, text_chars(&base), err);
    text_release(&base);
    TRY(status);
    reader->n_wanted = (size_t)count_wanted(reader);
    return reader->time == NONE ? open_columns(reader, err) : STATUS_OK;
}

/* ---- which segments a row is of -------------------------------------------------------------- */

/* The number in "branch12_seg0"; NONE in any other name. */
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

/* The key of a node, NONE without one. */
static int32_t key_of(const ValuesReader *reader, const TreeColumn *branches, size_t i)
{
    if (!branches)
        return reader->tree->id[i];
    double value = branches->value[i];
    return value >= 0 && value <= TREE_MAX_ID && value == floor(value) ? (int32_t)value : NONE;
}

/* Chains the nodes of each key: ids, or by the first row's name the numbers of branches. */
static Status index_nodes(ValuesReader *reader, const char *name, Err *err)
{
    const Tree *tree = reader->tree;
    const TreeColumn *branches = NULL;
    reader->of_branches = branch_of(name) != NONE;
    if (reader->of_branches && !(branches = tree_column(tree, "BranchId")))
        return err_set(err, STATUS_INPUT,
                       "'%.40s' is a branch of SimVascular's, and the tree has no column BranchId",
                       name);
    for (size_t i = 0; i < tree->n; i++)
        if (key_of(reader, branches, i) >= reader->n_keys)
            reader->n_keys = key_of(reader, branches, i) + 1;
    TRY(mem_calloc(&reader->first, (size_t)reader->n_keys, sizeof *reader->first, "keys", err));
    TRY(mem_calloc(&reader->line_of, (size_t)reader->n_keys, sizeof *reader->line_of, "keys", err));
    TRY(mem_calloc(&reader->next, tree->n, sizeof *reader->next, "keys", err));
    for (int32_t key = 0; key < reader->n_keys; key++)
        reader->first[key] = NONE;
    for (size_t i = tree->n; i-- > 0;) {
        int32_t key = key_of(reader, branches, i);
        if (key == NONE)
            continue;
        reader->next[i] = reader->first[key];
        reader->first[key] = (int32_t)i;
    }
    return STATUS_OK;
}

static Status find_key(ValuesReader *reader, const char *name, int32_t *key, Err *err)
{
    long long number = NONE;
    if (!reader->first)
        TRY(index_nodes(reader, name, err));
    if (reader->of_branches)
        number = branch_of(name);
    else if (!integer_parse(name, 0, INT32_MAX, &number))
        return err_set(err, STATUS_INPUT, "'%.40s' is not the id of a segment", name);
    if (number < 0 || number >= reader->n_keys || reader->first[number] == NONE)
        return err_set(err, STATUS_INPUT, "the tree has no segment %.40s", name);
    *key = (int32_t)number;
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static void put_value(const ValuesReader *reader, int32_t key, double *column, double value)
{
    for (int32_t i = reader->first[key]; i != NONE; i = reader->next[i])
        column[i] = value;
}

static Status hold_value(ValuesReader *reader, double value, Err *err)
{
    TRY(mem_reserve(&reader->held, &reader->held_capacity, reader->n_held + 1, sizeof value,
                    "values", err));
    reader->held[reader->n_held++] = value;
    return STATUS_OK;
}

/* Takes in the values of a row, whose fields are parted already. */
static Status take_values(ValuesReader *reader, char *const *field, int32_t key, Err *err)
{
    for (int i = 0; i < reader->n_fields; i++) {
        const ValueColumn *column = &reader->column[i];
        double value;
        if (!column->wanted)
            continue;
        TRY(field_value(column->name, field[i], &value, err));
        if (reader->time != NONE)
            TRY(hold_value(reader, value, err));
        else
            put_value(reader, key, column->value, value);
    }
    return STATUS_OK;
}

static Status take_row(ValuesReader *reader, size_t line, char *const *field, Err *err)
{
    TimedRow row = {.line = line, .values = reader->n_held};
    TRY(find_key(reader, field[reader->key], &row.key, err));
    if (reader->time == NONE && reader->line_of[row.key])
        return err_set(err, STATUS_INPUT, "segment %.40s stands on line %zu already",
                       field[reader->key], reader->line_of[row.key]);
    reader->line_of[row.key] = line;
    if (reader->time != NONE) {
        TRY(field_number("time", field[reader->time], -HUGE_VAL, &row.time, err));
        TRY(mem_reserve(&reader->row, &reader->rows_capacity, reader->n_rows + 1, sizeof row,
                        "rows", err));
        reader->row[reader->n_rows++] = row;
    }
    return take_values(reader, field, row.key, err);
}

static Status read_row(ValuesReader *reader, size_t line, char *text, Err *err)
{
    char **field = NULL;
    int n = 0;
    TRY(mem_calloc(&field, (size_t)reader->n_fields, sizeof *field, "fields", err));
    Status status = STATUS_OK;
    for (char *at = text; at && status == STATUS_OK; n++) {
        char *next;
        status = csv_field(&at, ',', &next, err);
        if (n < reader->n_fields)
            field[n] = next;
    }
    if (status == STATUS_OK && n != reader->n_fields)
        status = err_set(err, STATUS_INPUT, "the row has %d field%s; there are %d columns", n,
                         n == 1 ? "" : "s", reader->n_fields);
    if (status == STATUS_OK)
        status = take_row(reader, line, field, err);
    free(field);
    return status;
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    ValuesReader *reader = context;
    if (*line == '#' || !line[strspn(line, TEXT_BLANKS)])
        return STATUS_OK;
    return reader->n_fields ? read_row(reader, number, line, err) : read_titles(reader, line, err);
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
    TRY(mem_calloc(&made, reader->n_rows, sizeof *made, "times", err));
    for (size_t i = 0; i < reader->n_rows; i++)
        made[i] = reader->row[i].time;
    sort_numbers(made, reader->n_rows);
    *n = 0;
    for (size_t i = 0; i < reader->n_rows; i++)
        if (*n == 0 || made[i] != made[*n - 1])
            made[(*n)++] = made[i];
    *times = made;
    return STATUS_OK;
}

/* Whether the rows from `row` on are of one segment at all n times. */
static Status check_times(const ValuesReader *reader, const TimedRow *row, const double *times,
                          size_t n, Err *err)
{
    const TimedRow *end = reader->row + reader->n_rows;
    const char *kind = reader->of_branches ? "branch" : "segment";
    char time[NUMBER_TEXT_SIZE];
    for (size_t k = 0; k < n; k++) {
        bool is_next = row + k < end && row[k].key == row->key;
        if (is_next && k > 0 && row[k].time == row[k - 1].time)
            return err_set(err, STATUS_INPUT, "%s:%zu: %s %d at time %s stands on line %zu already",
                           reader->path, row[k].line, kind, row->key,
                           number_text(times[k - 1], time), row[k - 1].line);
        if (!is_next || row[k].time != times[k])
            return err_set(err, STATUS_INPUT, "%s: %s %d has no row for time %s, and others have",
                           reader->path, kind, row->key, number_text(times[k], time));
    }
    if (row + n < end && row[n].key == row->key)
        return err_set(err, STATUS_INPUT, "%s:%zu: %s %d at time %s stands twice", reader->path,
                       row[n].line, kind, row->key, number_text(row[n].time, time));
    return STATUS_OK;
}

static Status check_all_times(const ValuesReader *reader, const double *times, size_t n, Err *err)
{
    if (n * reader->n_wanted > BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "%s: there are %zu times, of which at most %zu are read",
                       reader->path, n, BUILDER_MAX_COLUMNS / reader->n_wanted);
    for (size_t i = 0; i < reader->n_rows; i += n)
        TRY(check_times(reader, reader->row + i, times, n, err));
    return check_room(reader, n * reader->n_wanted, err);
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
        Status status = text_check(&name, err);
        if (status == STATUS_OK)
            status = open_column(reader, text_chars(&name), column->unit, before, &value, err);
        text_release(&name);
        TRY(status);
        for (size_t i = k; i < reader->n_rows; i += n)
            put_value(reader, reader->row[i].key, value,
                      reader->held[reader->row[i].values + number]);
    }
    return STATUS_OK;
}

static Status fill_times(ValuesReader *reader, Err *err)
{
    double *times = NULL;
    size_t n = 0, number = 0;
    if (reader->time == NONE || reader->n_rows == 0)
        return STATUS_OK;
    TRY(list_times(reader, &times, &n, err));
    qsort(reader->row, reader->n_rows, sizeof *reader->row, by_key_and_time);
    Status status = check_all_times(reader, times, n, err);
    for (int i = 0; i < reader->n_fields && status == STATUS_OK; i++)
        if (reader->column[i].wanted)
            status = fill_frames(reader, &reader->column[i], number++, times, n, err);
    free(times);
    return status;
}

/* ---- files ----------------------------------------------------------------------------------- */

static const FileForm form = {.name = "a CSV file", .most_bytes = 4e9, .is_text = true};

static Status read_csv(ValuesReader *reader, Err *err)
{
    char *bytes = NULL;
    size_t size = 0;
    TRY(file_read(reader->path, &form, &bytes, &size, err));
    Status status = lines_read(reader->path, bytes, size, read_line, reader, err);
    if (status == STATUS_OK)
        status = fill_times(reader, err);
    if (status == STATUS_OK && !reader->first)
        status = err_set(err, STATUS_INPUT, "%s: there are no values in it", reader->path);
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
    if (status == STATUS_OK && name)
        status = mem_strdup(name, column ? column : reader.what, err);
    reader_release(&reader);
    return status;
}

/* ---- flows ----------------------------------------------------------------------------------- */

static Status sum_flows(const Tree *tree, const char *path, double *share, double *sum, Err *err)
{
    const TreeColumn *flow = &tree->column[0];
    *sum = 0;
    if (tree->n_columns != 1 || (*flow->unit && strcmp(flow->unit, "ml/min") != 0))
        return err_set(err, STATUS_INPUT, "%s: the column flow must be one, in ml/min", path);
    for (size_t i = 0; i < tree->n; i++) {
        share[i] = isnan(flow->value[i]) ? 0 : flow->value[i];
        if (share[i] < 0)
            return err_set(err, STATUS_INPUT, "%s: a flow is %g; it must not be below 0", path,
                           share[i]);
        *sum += share[i];
    }
    if (!(*sum > 0 && isfinite(*sum)))
        return err_set(err, STATUS_INPUT, "%s: no flow is above 0", path);
    return STATUS_OK;
}

/* Read as a column, which becomes the shares. */
Status tree_read_flows(Tree *tree, const char *path, Err *err)
{
    Tree only = {.n = tree->n, .id = tree->id};
    double *share = NULL, sum;
    Status status = tree_read_values(&only, path, "flow", NULL, err);
    if (status == STATUS_OK)
        status = mem_calloc(&share, tree->n, sizeof *share, "flow shares", err);
    if (status == STATUS_OK)
        status = sum_flows(&only, path, share, &sum, err);
    if (status == STATUS_OK) {
        tree_part_flow(tree, share);
        tree->meta.number[META_Q_PERF] = sum;
        tree->meta.known[META_Q_PERF] = true;
        share = NULL;
    }
    only.id = NULL; /* the tree's */
    tree_release(&only);
    free(share);
    return status;
}
