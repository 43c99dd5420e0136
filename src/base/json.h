/* Builds and reads JSON, on top of the library jansson, so that no failed allocation is missed.
 *
 * A value that is built from NULL is NULL, except by json_text_or_null. A failed allocation
 * anywhere therefore makes the final value NULL. text_json, which is called last, turns NULL into a
 * failure of its Text, and text_check turns this failure into STATUS_MEMORY. Values are made by
 * these functions, by json_pack, and by other functions of jansson that return a new value.
 * Functions of jansson that set or append are not used, because they report failures in another
 * way.
 *
 *     json_t *object = json_with(json_object(), "nodes", json_count(n));
 *     text_json(&text, object, 2);
 *     TRY(text_check(&text, err));
 *
 * Each function that returns a json_t returns a new reference, or NULL if memory runs out.
 * Functions that take a json_t take over the reference, also on failure. */
#ifndef CORCAST_BASE_JSON_H
#define CORCAST_BASE_JSON_H

#include "base/text.h"
#include <jansson.h>
#include <stdint.h>

/* Returns a JSON number; JSON null if the value is not finite. */
json_t *json_number(double value);
/* Returns a JSON integer. */
json_t *json_count(uint64_t n);
/* Returns an array of `n` values, each as by json_number. */
json_t *json_numbers(const double *values, size_t n);
/* Returns a JSON string. Bytes that are not UTF-8 are replaced as text_utf8 does. Returns NULL if
 * `chars` is NULL, the result of text_chars for a failed Text. */
json_t *json_text(const char *chars);
/* Returns a JSON string, as json_text does, or JSON null if `chars` is NULL. */
json_t *json_text_or_null(const char *chars);

/* A member of an object; `key` is borrowed. */
typedef struct JsonMember {
    const char *key;
    json_t *value;
} JsonMember;

/* Adds a member to `object`, and returns `object`. If `object` or `value` is NULL, or memory runs
 * out, releases both and returns NULL. */
MUST_CHECK json_t *json_with(json_t *object, const char *key, json_t *value);
/* Adds `n` members to `object`, as json_with does. On failure releases `object` and all values. */
MUST_CHECK json_t *json_with_members(json_t *object, const JsonMember *members, size_t n);
/* JSON_WITH adds members, each {key, value}, to an object. JSON_OBJECT makes an object of members:
 * JSON_OBJECT({"nodes", json_count(n)}, {"file", json_text(path)}). */
#define JSON_WITH(object, ...)                                                                     \
    json_with_members(object, (const JsonMember[]){__VA_ARGS__},                                   \
                      sizeof((const JsonMember[]){__VA_ARGS__}) / sizeof(JsonMember))
#define JSON_OBJECT(...) JSON_WITH(json_object(), __VA_ARGS__)
/* Appends an item to `array`, and returns `array`. On failure releases both, and returns NULL. */
MUST_CHECK json_t *json_with_item(json_t *array, json_t *value);

/* Parses JSON text of `size` bytes, as json_loadb of jansson does; `flags` and `error` are those of
 * json_loadb. If memory runs out, json_loadb may return a value in which a string is silently cut
 * short; this function then returns NULL.
 *
 * no_memory  receives true if memory ran out, else false.
 * Returns    a new reference; NULL after an error. */
json_t *json_read(const char *text, size_t size, size_t flags, json_error_t *error,
                  bool *no_memory);

/* Appends `json` as text, and releases it. Each nesting level is indented by `indent` blanks; 0
 * writes a single line. A real is written as the shortest text that reads back to the same double.
 * The Text fails if `json` is NULL or memory runs out. */
void text_json(Text *text, json_t *json, int indent);

#endif
