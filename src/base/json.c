/* On top of jansson, whose functions give NULL when memory runs out and take NULL for what failed
 * before. Values made here keep to that, so that a document is built without a test at each step
 * and tested once at the end. */
#include "base/json.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_count(uint64_t n)
{
    return json_integer((json_int_t)n);
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

/* `whole` when a part was taken; jansson has then let go of the part if it was not. */
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

static int append_dump(const char *chars, size_t size, void *text)
{
    text_append(text, chars, size);
    return 0;
}

void text_json(Text *text, json_t *json, int indent)
{
    /* A real is written with 17 digits, which is what reads back. */
    size_t form = (indent ? JSON_INDENT((size_t)indent) : JSON_COMPACT) | JSON_REAL_PRECISION(17);
    if (json_dump_callback(json, append_dump, text, form) != 0)
        text_puts(text, NULL);
    json_decref(json);
}

/* ---- reading --------------------------------------------------------------------------------- */

static _Thread_local bool refused; /* jansson was, memory */

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
