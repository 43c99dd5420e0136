/* Numbers as text, and back. */
#ifndef CORCAST_BASE_NUMBER_H
#define CORCAST_BASE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

enum { NUMBER_TEXT_SIZE = 32 };

/* The shortest decimal text that reads back to the same double, always with '.' as its decimal
 * point whatever the locale ("nan", "inf" and "-inf" for what is not finite). Writes to `out` and
 * returns it. */
const char *number_text(double value, char out[NUMBER_TEXT_SIZE]);
/* Likewise the shortest that reads back to the same float. */
const char *number_text_float(float value, char out[NUMBER_TEXT_SIZE]);

enum { BYTES_TEXT_SIZE = 32 };

/* A number of bytes as a reader says it, "312 bytes", "4.3 GB". Writes to `out` and returns it. */
const char *bytes_text(double bytes, char out[BYTES_TEXT_SIZE]);

/* Reads the whole of `chars` (zero-terminated; blanks at either end are not allowed) as a number
 * in decimal or exponent form. False when anything is left over or nothing is there; "nan" and
 * "inf" are read as such, so callers check with isfinite. */
bool number_parse(const char *chars, double *out);
/* Takes the finite number that stands at *at off the text, whatever follows it, and moves *at
 * behind it. False, with *at where it was, when there is none, and for those of many digits or of a
 * large exponent, which number_parse may read. */
bool number_take(const char **at, double *out);
/* As number_parse, `count` numbers parted by blanks, which may also stand at either end. */
bool numbers_parse(const char *chars, size_t count, double *out);
/* As number_parse, a whole number in [minimum, maximum]. */
bool integer_parse(const char *chars, long long minimum, long long maximum, long long *out);

#endif
