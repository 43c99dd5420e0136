/* JSON, made with jansson so that no failed allocation is forgotten: whatever is made of NULL is
 * NULL, and the NULL that comes out at the end is a Status. Values are made by these functions, by
 * json_pack and by those of jansson that return a new value; what sets or appends without saying so
 * is not used. */
#ifndef CORCAST_BASE_JSON_H
#define CORCAST_BASE_JSON_H

#include "base/text.h"
#include <jansson.h>
#include <stdint.h>

/* A JSON real, or null where the value is not finite. New reference, as of all below. */
json_t *json_number(double value);
/* A number of things. */
json_t *json_count(uint64_t n);
/* An array of json_number, of `n` values. */
json_t *json_numbers(const double *values, size_t n);
/* A JSON string; what of `chars` is not UTF-8 is replaced as text_utf8 does. NULL when `chars` is
 * NULL, as the characters of a text that failed are. */
json_t *json_text(const char *chars);
/* As json_text, but null when `chars` is NULL. */
json_t *json_text_or_null(const char *chars);

typedef struct JsonMember {
    const char *key;
    json_t *value;
} JsonMember;

/* Adds a member to `object`, taking over `value`, and returns `object`. NULL when either is NULL or
 * memory runs out; both are then released. */
MUST_CHECK json_t *json_with(json_t *object, const char *key, json_t *value);
/* As json_with, for `n` members. */
MUST_CHECK json_t *json_with_members(json_t *object, const JsonMember *members, size_t n);
/* As json_with, for an item appended to `array`. */
MUST_CHECK json_t *json_with_item(json_t *array, json_t *value);

/* json_loadb of jansson, which may go on without a character that it has no room for: NULL then,
 * and *no_memory is set, as it is when there was no room for the whole. */
json_t *json_read(const char *text, size_t size, size_t flags, json_error_t *error,
                  bool *no_memory);

/* Appends `json` as text, in lines with `indent` blanks a level or, with 0, in one, and lets go of
 * it. A real is the shortest text that reads back to the same double. The text fails when `json` is
 * NULL or memory runs out. */
void text_json(Text *text, json_t *json, int indent);

#endif
