/* Implements the reports of the library. A report holds a JSON document and its text; a caller
 * reads the text, or single members by their keys. */
#include "api/reports.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct corcast_report {
    Handle handle;
    json_t *json; /* owned */
    Text text;    /* `json` as text */
};

Status report_new(json_t *json, corcast_report **out, Err *err)
{
    corcast_report *made = NULL;
    Status status = json ? handle_new(&made, HANDLE_REPORT, sizeof *made, err)
                         : err_set(err, STATUS_MEMORY, "out of memory: no room for a report");
    if (status != STATUS_OK) {
        json_decref(json);
        return status;
    }
    made->json = json;
    text_json(&made->text, json_incref(json), 2);
    text_puts(&made->text, "\n");
    status = text_check(&made->text, err);
    if (status != STATUS_OK) {
        corcast_report_free(made);
        return status;
    }
    *out = made;
    return STATUS_OK;
}

const char *corcast_report_json(const corcast_report *report)
{
    return handle_is(report, HANDLE_REPORT) ? text_chars(&report->text) : "";
}

/* ---- members --------------------------------------------------------------------------------- */

/* Returns the item of an array whose decimal index is the `length` characters at `name`; NULL if
 * there is none. */
static const json_t *item_of(const json_t *array, const char *name, size_t length)
{
    size_t index = 0;
    if (length == 0 || length > 9 || strspn(name, "0123456789") < length) /* no overflow below */
        return NULL;
    for (size_t i = 0; i < length; i++)
        index = 10 * index + (size_t)(name[i] - '0');
    return json_array_get(array, index);
}

/* Returns the member of an object whose name is the `length` characters at `name`; NULL if there is
 * none. */
static const json_t *member_of(const json_t *object, const char *name, size_t length)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, key, value)
    {
        if (strlen(key) == length && strncmp(key, name, length) == 0)
            return value;
    }
    return NULL;
}

/* Finds the value at a key: names of members and indices of items, separated by dots. Errors:
 * STATUS_USAGE if there is none. */
static Status find(const corcast_report *report, const char *key, const json_t **out, Err *err)
{
    TRY(handle_check(report, HANDLE_REPORT, "report", err));
    TRY(argument_check(key, "key", err));
    const json_t *at = report->json;
    for (const char *name = key; at && *name;) {
        const size_t length = strcspn(name, ".");
        at = json_is_array(at) ? item_of(at, name, length) : member_of(at, name, length);
        name += length + (name[length] == '.');
    }
    if (!at || !*key)
        return err_set(err, STATUS_USAGE, "the report has no member '%s'", key);
    *out = at;
    return STATUS_OK;
}

static Status find_number(const corcast_report *report, const char *key, double *value, Err *err)
{
    const json_t *at = NULL;
    TRY(argument_check(value, "value", err));
    TRY(find(report, key, &at, err));
    if (json_is_number(at))
        *value = json_number_value(at);
    else if (json_is_boolean(at))
        *value = json_is_true(at);
    else if (json_is_null(at))
        *value = (double)NAN;
    else
        return err_set(err, STATUS_USAGE, "the member '%s' of the report is not a number", key);
    return STATUS_OK;
}

int corcast_report_number(const corcast_report *report, const char *key, double *value,
                          corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, find_number(report, key, value, &call.err));
}

static Status find_text(const corcast_report *report, const char *key, const char **value, Err *err)
{
    const json_t *at = NULL;
    TRY(argument_check(value, "value", err));
    TRY(find(report, key, &at, err));
    if (!json_is_string(at) && !json_is_null(at))
        return err_set(err, STATUS_USAGE, "the member '%s' of the report is not a text", key);
    *value = json_string_value(at);
    return STATUS_OK;
}

int corcast_report_text(const corcast_report *report, const char *key, const char **value,
                        corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, find_text(report, key, value, &call.err));
}

void corcast_report_free(corcast_report *report)
{
    if (!handle_is(report, HANDLE_REPORT))
        return;
    json_decref(report->json);
    text_release(&report->text);
    handle_free(report);
}
