/* Reads JSON objects as the rows of a table, and writes the table as CSV or JSON Lines. CSV is
 * written in two passes over copies of the rows without nested objects. The first pass collects the
 * columns, in the order of the objects' members. */
#include "study/study_table.h"

#include "options/files.h"
#include <stdlib.h>
#include <string.h>

void study_table_release(StudyTable *table)
{
    for (size_t i = 0; i < table->n; i++) {
        free(table->row[i].path);
        json_decref(table->row[i].json);
    }
    free(table->row);
    *table = (StudyTable){0};
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Returns a member as an integer; 0 if there is none. */
static long long member(const json_t *object, const char *key)
{
    return json_integer_value(json_object_get(object, key));
}

/* Returns true if the object is a run of a study: it states its number, the number of runs, and the
 * plan. */
static bool is_shard(const json_t *json)
{
    const json_t *shard = json_object_get(json, "shard");
    return member(json, "run") >= 1 && member(json, "run") <= member(shard, "runs") &&
           json_string_value(json_object_get(shard, "plan"));
}

/* Takes ownership of `json`, also on failure. */
static Status add_row(StudyTable *table, const char *path, json_t *json, Err *err)
{
    StudyRow row = {.json = json};
    Status status;
    TRY_GOTO(mem_strdup(&row.path, path, err));
    TRY_GOTO(
        mem_reserve(&table->row, &table->capacity, table->n + 1, sizeof *table->row, "rows", err));
    table->row[table->n++] = row;
    return STATUS_OK;
done:
    free(row.path);
    json_decref(json);
    return status;
}

/* Takes ownership of `json`, also on failure. */
static Status take_object(StudyTable *table, const char *path, bool named, json_t *json, Err *err)
{
    bool taken = json_is_object(json) && (!table->shards || is_shard(json));
    if (taken)
        return add_row(table, path, json, err);
    json_decref(json);
    return named ? err_set(err, STATUS_INPUT, "%s: contains no %s", path,
                           table->shards ? "run of a study" : "JSON object")
                 : STATUS_OK;
}

/* Adds the JSON objects of a text, one after the other. */
static Status add_objects(StudyTable *table, const char *path, bool named, const char *text,
                          size_t size, Err *err)
{
    const size_t form = JSON_REJECT_DUPLICATES | JSON_DISABLE_EOF_CHECK;
    do {
        json_error_t error;
        bool no_memory;
        json_t *json = json_read(text, size, form, &error, &no_memory);
        if (no_memory)
            return mem_out_of("to read", path, err);
        if (!json)
            return err_set(err, STATUS_INPUT, "%s: is not valid JSON: line %d: %s", path,
                           error.line, error.text);
        TRY(take_object(table, path, named, json, err));
        text += error.position;
        size -= (size_t)error.position;
        size_t blanks = strspn(text, " \t\n");
        text += blanks;
        size -= blanks;
    } while (size > 0);
    return STATUS_OK;
}

static Status add_file(void *user, const char *path, bool named, Err *err)
{
    static const FileForm form = {.name = "a JSON file", .most_bytes = 4e9, .is_text = true};
    char *text;
    size_t size;
    TRY(file_read(path, &form, &text, &size, err));
    Status status = add_objects(user, path, named, text, size, err);
    free(text);
    return status;
}

Status study_table_add(StudyTable *table, const char *path, Err *err)
{
    static const char *const extensions[] = {"json", NULL};
    return files_visit(path, extensions, add_file, table, err);
}

/* ---- order ----------------------------------------------------------------------------------- */

/* Compares rows for qsort by the number of the run. */
static int by_run(const void *a, const void *b)
{
    long long x = member(((const StudyRow *)a)->json, "run");
    long long y = member(((const StudyRow *)b)->json, "run");
    return (x > y) - (x < y);
}

static const char *plan_of(const StudyRow *row)
{
    return json_string_value(json_object_get(json_object_get(row->json, "shard"), "plan"));
}

Status study_table_check(StudyTable *table, Err *err)
{
    if (table->n == 0)
        return err_set(err, STATUS_INPUT, "no run to merge was found");
    const StudyRow *first = &table->row[0];
    for (size_t i = 1; i < table->n; i++)
        if (strcmp(plan_of(first), plan_of(&table->row[i])) != 0)
            return err_set(err, STATUS_INPUT,
                           "%s and %s are runs of different studies: their plans or "
                           "versions of corcast differ",
                           table->row[i].path, first->path);
    qsort(table->row, table->n, sizeof *table->row, by_run);
    const long long runs = member(json_object_get(table->row[0].json, "shard"), "runs");
    for (long long i = 0; i < runs; i++) {
        const StudyRow *row = &table->row[i];
        if (i > 0 && i < (long long)table->n && by_run(row - 1, row) == 0)
            return err_set(err, STATUS_INPUT, "%s and %s are both run %lld of %lld", row[-1].path,
                           row->path, i, runs);
        if (i >= (long long)table->n || member(row->json, "run") != i + 1)
            return err_set(err, STATUS_INPUT, "run %lld of %lld is missing; found %zu runs", i + 1,
                           runs, table->n);
    }
    return STATUS_OK;
}

/* ---- writing --------------------------------------------------------------------------------- */

/* Adds the members of an object, except arrays, to `flat`. `prefix` is put before their names.
 * Members of nested objects become "a.b". Returns `flat`, or NULL if memory runs out. */
static json_t *flatten(json_t *flat, const char *prefix, json_t *object)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        Text name = TEXT_INIT;
        text_printf(&name, "%s%s%s", prefix, *prefix ? "." : "", key);
        const char *chars = text_chars(&name);
        if (!chars)
            flat = json_with(flat, "", NULL);
        else if (json_is_object(value) && strcmp(chars, "shard") != 0)
            flat = flatten(flat, chars, value);
        else if (!json_is_object(value) && !json_is_array(value))
            flat = json_with(flat, chars, json_incref(value));
        text_release(&name);
    }
    return flat;
}

/* Makes a row without nested objects; their keys are joined by dots. */
static json_t *flat_row(const StudyRow *row)
{
    json_t *flat = json_object();
    if (!json_object_get(row->json, "run")) {
        const char *name = file_name(row->path);
        size_t length = strlen(name), extension = strlen(file_extension(name));
        length -= extension ? extension + 1 : 0;
        flat = json_with(flat, "file", json_stringn(name, length));
    }
    return flatten(flat, "", row->json);
}

/* Returns an object with all keys of all rows, in the order of their first appearance. */
static json_t *find_columns(const StudyTable *table)
{
    json_t *columns = json_object();
    for (size_t i = 0; i < table->n; i++) {
        const char *key;
        json_t *value, *flat = flat_row(&table->row[i]);
        json_object_foreach(flat, key, value)
        {
            if (!json_object_get(columns, key))
                columns = json_with(columns, key, json_null());
        }
        if (!flat)
            columns = json_with(columns, "", NULL);
        json_decref(flat);
    }
    return columns;
}

/* Appends a text, in quotes if it contains a comma, a quote or a line break [RFC 4180]. */
static void put_text(Text *text, const char *chars)
{
    if (!strpbrk(chars, ",\"\r\n")) {
        text_puts(text, chars);
        return;
    }
    text_puts(text, "\"");
    for (; *chars; chars++) {
        text_puts(text, *chars == '"' ? "\"" : "");
        text_append(text, chars, 1);
    }
    text_puts(text, "\"");
}

static void put_value(Text *text, const json_t *value)
{
    if (json_is_string(value))
        put_text(text, json_string_value(value));
    else if (json_is_integer(value))
        text_printf(text, "%lld", (long long)json_integer_value(value));
    else if (json_is_real(value))
        text_number(text, json_real_value(value));
    else if (json_is_boolean(value))
        text_puts(text, json_is_true(value) ? "true" : "false");
}

void study_table_csv(const StudyTable *table, Text *text)
{
    json_t *columns = find_columns(table), *none;
    const char *key, *comma = "";
    json_object_foreach(columns, key, none)
    {
        text_puts(text, comma);
        put_text(text, key);
        comma = ",";
    }
    for (size_t i = 0; i < table->n; i++) {
        json_t *flat = flat_row(&table->row[i]);
        comma = "\n";
        json_object_foreach(columns, key, none)
        {
            text_puts(text, flat ? comma : NULL);
            put_value(text, json_object_get(flat, key));
            comma = ",";
        }
        json_decref(flat);
    }
    text_puts(text, columns ? "\n" : NULL);
    json_decref(columns);
}

Status study_table_write(const StudyTable *table, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    if (strcmp(file_extension(path), "jsonl") != 0)
        study_table_csv(table, &text);
    else
        for (size_t i = 0; i < table->n; i++) {
            text_json(&text, json_incref(table->row[i].json), 0);
            text_puts(&text, "\n");
        }
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}
