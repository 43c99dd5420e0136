/* Builds, writes and reads JSON documents with jansson.
 *
 * The functions of jansson return NULL when memory runs out, and accept NULL from a step that
 * failed before. The functions here do the same, so a document is built without a test at each
 * step, and tested once at the end. */
#include "base/json.h"

#include "base/number.h"
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_count(uint64_t n)
{
    return json_integer((json_int_t)n);
}

json_t *json_numbers(const double *values, size_t n)
{
    json_t *all = json_array();
    for (size_t i = 0; i < n; i++)
        all = json_with_item(all, json_number(values[i]));
    return all;
}

json_t *json_text(const char *chars)
{
    if (!chars)
        return NULL;
    Text text = TEXT_INIT;
    text_utf8(&text, chars);
    json_t *made = json_string(text_chars(&text));
    text_release(&text);
    return made;
}

json_t *json_text_or_null(const char *chars)
{
    return chars ? json_text(chars) : json_null();
}

/* Returns `whole` if a part was added to it. Otherwise releases `whole`; jansson has released the
 * part already. */
static json_t *whole_or_nothing(json_t *whole, bool taken)
{
    if (taken)
        return whole;
    json_decref(whole);
    return NULL;
}

json_t *json_with(json_t *object, const char *key, json_t *value)
{
    return whole_or_nothing(object, json_object_set_new(object, key, value) == 0);
}

json_t *json_with_members(json_t *object, const JsonMember *members, size_t n)
{
    for (size_t i = 0; i < n; i++)
        object = json_with(object, members[i].key, members[i].value);
    return object;
}

json_t *json_with_item(json_t *array, json_t *value)
{
    return whole_or_nothing(array, json_array_append_new(array, value) == 0);
}

/* The position of a value in the text that is written. */
typedef struct JsonPlace {
    int indent, depth;
} JsonPlace;

static void put_line(Text *text, JsonPlace place)
{
    if (place.indent > 0)
        text_printf(text, "\n%*s", place.indent * place.depth, "");
}

static int append_dump(const char *chars, size_t size, void *text)
{
    text_append(text, chars, size);
    return 0;
}

/* Appends what is neither an array nor an object. A real is the shortest text that reads back to
 * the same double, and keeps a decimal point or an exponent. */
static void put_plain(Text *text, const json_t *json)
{
    char number[NUMBER_TEXT_SIZE];
    if (json_is_real(json)) {
        number_text(json_real_value(json), number);
        text_puts(text, number);
        if (!strpbrk(number, ".e"))
            text_puts(text, ".0");
    } else if (json_dump_callback(json, append_dump, text, JSON_ENCODE_ANY) != 0) {
        text_puts(text, NULL);
    }
}

static void put_value(Text *text, json_t *json, JsonPlace place);

static void put_array(Text *text, json_t *json, JsonPlace place)
{
    const JsonPlace inner = {place.indent, place.depth + 1};
    size_t i;
    json_t *item;
    text_puts(text, "[");
    json_array_foreach(json, i, item)
    {
        text_puts(text, i ? "," : "");
        put_line(text, inner);
        put_value(text, item, inner);
    }
    if (json_array_size(json) > 0)
        put_line(text, place);
    text_puts(text, "]");
}

static void put_object(Text *text, json_t *json, JsonPlace place)
{
    const JsonPlace inner = {place.indent, place.depth + 1};
    const char *key, *before = "";
    json_t *value;
    text_puts(text, "{");
    json_object_foreach(json, key, value)
    {
        json_t *name = json_string(key);
        text_puts(text, before);
        put_line(text, inner);
        put_value(text, name, inner);
        text_puts(text, place.indent > 0 ? ": " : ":");
        put_value(text, value, inner);
        json_decref(name);
        before = ",";
    }
    if (json_object_size(json) > 0)
        put_line(text, place);
    text_puts(text, "}");
}

static void put_value(Text *text, json_t *json, JsonPlace place)
{
    if (json_is_array(json))
        put_array(text, json, place);
    else if (json_is_object(json))
        put_object(text, json, place);
    else
        put_plain(text, json);
}

void text_json(Text *text, json_t *json, int indent)
{
    put_value(text, json, (JsonPlace){indent, 0});
    json_decref(json);
}

/* ---- reading --------------------------------------------------------------------------------- */

static _Thread_local bool refused; /* an allocation by jansson failed in this thread */

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    refused = refused || !memory;
    return memory;
}

static void set_allocator(void)
{
    json_set_alloc_funcs(allocate, free);
}

json_t *json_read(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, set_allocator);
    refused = false;
    json_t *json = json_loadb(text, size, flags, error);
    *no_memory = refused;
    if (!refused)
        return json;
    json_decref(json);
    return NULL;
}
