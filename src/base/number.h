/* Conversion of numbers to text, and of text to numbers. No function depends on the locale. */
#ifndef CORCAST_BASE_NUMBER_H
#define CORCAST_BASE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

enum { NUMBER_TEXT_SIZE = 32 };

/* Writes the shortest decimal text that converts back to the same double, with '.' as the decimal
 * point; "nan", "inf" or "-inf" if the number is not finite. Returns `out`. */
const char *number_text(double value, char out[NUMBER_TEXT_SIZE]);
/* Writes the number as number_text does, rounded to at most `digits` significant digits, 1 to 17;
 * with `digits` 0 it is not rounded. Returns `out`. */
const char *number_text_rounded(double value, int digits, char out[NUMBER_TEXT_SIZE]);
/* Writes the shortest decimal text that converts back to the same float. Returns `out`. */
const char *number_text_float(float value, char out[NUMBER_TEXT_SIZE]);

enum { BYTES_TEXT_SIZE = 32 };

/* Writes a size of memory or of a file for people: "312 bytes", "4.3 GB". Returns `out`. */
const char *bytes_text(double bytes, char out[BYTES_TEXT_SIZE]);

/* Parses the whole string `chars` as a number in decimal or exponent form. Returns false if the
 * string is empty or has other characters, such as blanks at its ends. Accepts "nan" and "inf", so
 * callers check with isfinite. */
bool number_parse(const char *chars, double *out);
/* Parses the finite number at the start of *at, and moves *at behind it; any characters may follow.
 * This is a fast path for common numbers. Returns false, and leaves *at unchanged, if there is no
 * number, or if it has many digits or a large exponent; number_parse may accept such a number. */
bool number_take(const char **at, double *out);
/* Parses the whole string as `count` numbers, separated by blanks; blanks at the ends are allowed.
 * Returns false for any other string. */
bool numbers_parse(const char *chars, size_t count, double *out);
/* Parses the whole string as an integer in [minimum, maximum]. Returns false for any other string.
 */
bool integer_parse(const char *chars, long long minimum, long long maximum, long long *out);

#endif
