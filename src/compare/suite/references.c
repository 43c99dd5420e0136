/* Reads and changes the list of the accepted references of a case. The list is text that people
 * edit: a change cuts out the lines of one section and appends a new one, so that all comments
 * outside of this section stay. */
#include "compare/suite/references.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { DATE_SIZE = sizeof "2027-03-01" };

void references_release(References *references)
{
    free(references->items);
    free(references->text);
    *references = (References){0};
}

static Status add_reference(References *references, const char *name, Err *err)
{
    return ARRAY_PUSH(references, "references", err, (Reference){.name = name});
}

/* ---- dates ----------------------------------------------------------------------------------- */

/* Returns true for a date of the calendar. timegm changes a day that does not exist, such as
 * February 30, to one that does; then the text that is written differs. */
static bool is_date(const char *text)
{
    struct tm day = {0};
    char written[32];
    const char *end = strptime(text, "%Y-%m-%d", &day);
    if (!end || *end != '\0' || timegm(&day) == -1)
        return false;
    snprintf(written, sizeof written, "%04d-%02d-%02d", day.tm_year + 1900, day.tm_mon + 1,
             day.tm_mday);
    return strcmp(written, text) == 0;
}

Status reference_check_date(const char *date, Err *err)
{
    if (strcmp(date, "never") == 0 || is_date(date))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "expires is '%s'; it must be a date such as 2027-03-01, or never", date);
}

/* Compares the dates as texts: YYYY-MM-DD sorts by time. */
bool reference_is_expired(const char *expires)
{
    char today[DATE_SIZE] = "";
    struct tm utc;
    time_t now = time(NULL);
    if (!expires || strcmp(expires, "never") == 0)
        return false;
    if (gmtime_r(&now, &utc))
        strftime(today, sizeof today, "%Y-%m-%d", &utc);
    return strcmp(expires, today) < 0;
}

/* ---- reading --------------------------------------------------------------------------------- */

typedef struct ListReader {
    References *references;
    const char *case_name; /* file name of the case; references->items[0].name */
    Reference *current;    /* entry of the section; NULL before the first section */
} ListReader;

/* Returns true for the name of the case, and for its stem followed by REFERENCE_MARK. */
static bool is_of_case(const char *case_name, const char *name)
{
    const char *extension = file_extension(case_name);
    size_t stem = (size_t)(extension - case_name) - (*extension != '\0'),
           mark = strlen(REFERENCE_MARK);
    if (strcmp(name, case_name) == 0)
        return true;
    return !strchr(name, '/') && strncmp(name, case_name, stem) == 0 &&
           strncmp(name + stem, REFERENCE_MARK, mark) == 0 && name[stem + mark] != '\0';
}

static Status check_entry(const Reference *entry, Err *err)
{
    if (!entry || (entry->reason && entry->machine && entry->expires))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "[%s] needs reason, machine and expires", entry->name);
}

static Status begin_entry(ListReader *reader, const char *name, Err *err)
{
    References *references = reader->references;
    TRY(check_entry(reader->current, err));
    if (!is_of_case(reader->case_name, name))
        return err_set(err, STATUS_INPUT,
                       "'%s' is not a reference of %s; further references have names such as "
                       "NAME" REFERENCE_MARK "LABEL.png",
                       name, reader->case_name);
    size_t at = strcmp(name, reader->case_name) == 0 ? 0 : references->n;
    for (size_t i = 1; i < references->n; i++)
        if (strcmp(references->items[i].name, name) == 0)
            at = i;
    if (at == references->n)
        TRY(add_reference(references, name, err));
    reader->current = &references->items[at];
    if (reader->current->reason)
        return err_set(err, STATUS_INPUT, "the section [%s] occurs twice", name);
    return STATUS_OK;
}

static Status take_line(void *user, const char *section, const char *key, const char *value,
                        Err *err)
{
    ListReader *reader = user;
    if (!key)
        return begin_entry(reader, section, err);
    if (!reader->current)
        return err_set(err, STATUS_INPUT, "'%s' is outside of a section such as [%s]", key,
                       reader->case_name);
    if (strcmp(key, "reason") == 0 && *value)
        reader->current->reason = value;
    else if (strcmp(key, "machine") == 0 && *value)
        reader->current->machine = value;
    else if (strcmp(key, "expires") == 0)
        reader->current->expires = value;
    else
        return err_set(err, STATUS_INPUT, "'%s = %s': the keys are reason, machine and expires",
                       key, value);
    return reader->current->expires == value ? reference_check_date(value, err) : STATUS_OK;
}

Status references_read(References *references, const char *case_path, Err *err)
{
    char *path = NULL;
    ListReader reader = {.references = references, .case_name = file_name(case_path)};
    Status status = STATUS_OK;
    *references = (References){0};
    TRY_GOTO(add_reference(references, reader.case_name, err));
    TRY_GOTO(file_with_suffix(case_path, REFERENCES_SUFFIX, &path, err));
    if (access(path, F_OK) != 0)
        goto done;
    TRY_GOTO(file_check_regular(path, err));
    TRY_GOTO(ini_read(path, "a list of references", take_line, &reader, &references->text, err));
    status = check_entry(reader.current, err);
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", path);
done:
    free(path);
    return status;
}

/* ---- changing -------------------------------------------------------------------------------- */

/* Returns true if the line begins the section `name`. */
static bool begins_section(const char *line, const char *name)
{
    size_t length = strlen(name);
    line += strspn(line, TEXT_BLANKS);
    return *line == '[' && strncmp(line + 1, name, length) == 0 && line[1 + length] == ']';
}

/* Appends the lines of `old` outside of the section `name`. Returns true if a section is left. */
static bool keep_others(char *old, const char *name, Text *out)
{
    bool inside = false, any = false;
    for (char *rest = old, *line; (line = text_line(&rest));) {
        bool begins = line[strspn(line, TEXT_BLANKS)] == '[';
        if (begins)
            inside = begins_section(line, name);
        any = any || (begins && !inside);
        if (!inside && (*line || rest))
            text_printf(out, "%s\n", line);
    }
    return any;
}

/* A semicolon would begin a comment. */
static void put_value(const char *key, const char *value, Text *out)
{
    Text line = TEXT_INIT;
    text_put_line(&line, value);
    text_printf(out, "%s = ", key);
    for (const char *at = text_chars(&line); at && *at; at++)
        text_printf(out, "%c", *at == ';' ? ',' : *at);
    text_puts(out, "\n");
    text_release(&line);
}

static void put_entry(const Reference *entry, Text *out)
{
    text_printf(out, "[%s]\n", entry->name);
    put_value("reason", entry->reason, out);
    put_value("machine", entry->machine, out);
    put_value("expires", entry->expires, out);
}

Status references_store(const char *case_path, const char *name, const Reference *entry, Err *err)
{
    static const FileForm form = {.name = "a list", .most_bytes = 1e9, .is_text = true};
    char *path = NULL, *old = NULL;
    size_t size = 0;
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(file_with_suffix(case_path, REFERENCES_SUFFIX, &path, err));
    bool exists = access(path, F_OK) == 0;
    if (exists)
        TRY_GOTO(file_read(path, &form, &old, &size, err));
    bool any = old && keep_others(old, name, &text);
    if (entry)
        put_entry(entry, &text);
    if (any || entry)
        status = file_write_text(path, &text, err);
    else if (exists && unlink(path) != 0)
        status = err_set(err, STATUS_IO, "%s: cannot be removed", path);
done:
    text_release(&text);
    free(old);
    free(path);
    return status;
}
