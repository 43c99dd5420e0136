/* Growable text and exact number text. */
#ifndef CORCAST_BASE_TEXT_H
#define CORCAST_BASE_TEXT_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

/* Text that grows. A failed append is remembered in `failed` and reported once by text_check, so
 * that writers of long files need no check a line. Initialise with TEXT_INIT, free with
 * text_release. `chars` is NULL or zero-terminated. */
typedef struct Text {
    char *chars;
    size_t length;
    size_t capacity;
    bool failed;
} Text;

#define TEXT_INIT ((Text){0})

void text_release(Text *text);
void text_append(Text *text, const char *chars, size_t length);
void text_puts(Text *text, const char *chars);
void text_printf(Text *text, const char *format, ...) PRINTF_LIKE(2, 3);
/* Appends text from outside, say a file's name, as part of one line of UTF-8: a control character becomes
 * a blank, and a byte that is no UTF-8 becomes U+FFFD. */
void text_put_line(Text *text, const char *chars);
/* STATUS_MEMORY when an append has failed, else STATUS_OK. */
MUST_CHECK Status text_check(const Text *text, Err *err);

enum { NUMBER_TEXT_SIZE = 32 };

/* The shortest decimal text that reads back to the same double, always with '.' as its decimal
 * point whatever the locale ("nan", "inf" and "-inf" for what is not finite). Writes to `out` and
 * returns it. */
const char *number_text(double value, char out[NUMBER_TEXT_SIZE]);
/* Likewise the shortest that reads back to the same float. */
const char *number_text_float(float value, char out[NUMBER_TEXT_SIZE]);
void text_number(Text *text, double value);

enum { BYTES_TEXT_SIZE = 32 };

/* A number of bytes as a reader says it, "312 bytes", "4.3 GB". Writes to `out` and returns it. */
const char *bytes_text(double bytes, char out[BYTES_TEXT_SIZE]);

/* Reads the whole of `chars` (zero-terminated; blanks at either end are not allowed) as a number
 * in decimal or exponent form. False when anything is left over or nothing is there; "nan" and
 * "inf" are read as such, so callers check with isfinite. */
bool number_parse(const char *chars, double *out);
/* Likewise `count` numbers parted by blanks, which may also stand at either end. */
bool numbers_parse(const char *chars, size_t count, double *out);
/* Likewise for a whole number in [minimum, maximum]. */
bool integer_parse(const char *chars, long long minimum, long long maximum, long long *out);

#endif
