/* Writes numbers and units as print does: with a minus sign, superscripts and a micro sign.
 * Rounding is left to printf, so that 9.9996 to 4 digits is 10. */
#include "base/readable.h"

#include "base/number.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MINUS "\xE2\x88\x92"
#define MICRO "\xC2\xB5"
#define TIMES "\xC3\x97"

/* The characters beyond ASCII, and their replacements in ASCII. The first 11 are superscripts. */
static const struct {
    const char *chars, *plain;
} signs[] = {{"\xE2\x81\xB0", "0"}, {"\xC2\xB9", "1"},     {"\xC2\xB2", "2"},
             {"\xC2\xB3", "3"},     {"\xE2\x81\xB4", "4"}, {"\xE2\x81\xB5", "5"},
             {"\xE2\x81\xB6", "6"}, {"\xE2\x81\xB7", "7"}, {"\xE2\x81\xB8", "8"},
             {"\xE2\x81\xB9", "9"}, {"\xE2\x81\xBB", "-"}, {MINUS, "-"},
             {MICRO, "u"},          {TIMES, "x"}};
enum { SIGNS = sizeof signs / sizeof *signs, SUPERSCRIPT_MINUS = 10 };

/* Returns the superscript of a digit or a minus sign. */
static const char *superscript(char digit)
{
    return signs[digit == '-' ? SUPERSCRIPT_MINUS : digit - '0'].chars;
}

static void put_power(int exponent, char *out)
{
    char digits[16];
    snprintf(digits, sizeof digits, "%d", exponent);
    memcpy(out, "10", sizeof "10");
    for (const char *digit = digits; *digit; digit++)
        strcat(out, superscript(*digit)); /* at most 4 of them for a double */
}

/* Cuts zeros at the end of a decimal fraction. */
static void cut_zeros(char *digits)
{
    size_t length = strlen(digits);
    if (!strchr(digits, '.'))
        return;
    while (digits[length - 1] == '0')
        digits[--length] = '\0';
    if (digits[length - 1] == '.')
        digits[length - 1] = '\0';
}

const char *number_readable(double value, int digits, char out[READABLE_SIZE])
{
    char rounded[READABLE_SIZE];
    if (!isfinite(value))
        return number_text(value, out);
    snprintf(rounded, sizeof rounded, "%.*e", digits - 1, fabs(value));
    char *mark = strchr(rounded, 'e');
    const int exponent = atoi(mark + 1), decimals = digits - 1 - exponent;
    char *at = out + snprintf(out, READABLE_SIZE, "%s", value < 0 ? MINUS : "");
    const size_t left = READABLE_SIZE - (size_t)(at - out);
    if (exponent >= -4 && exponent < 6) { /* 0.0001 to 999999; other numbers get a power of ten */
        snprintf(at, left, "%.*f", decimals > 0 ? decimals : 0, strtod(rounded, NULL));
        cut_zeros(at);
        return out;
    }
    *mark = '\0';
    cut_zeros(rounded);
    if (strcmp(rounded, "1") != 0)
        at += snprintf(at, left, "%s" TIMES, rounded);
    put_power(exponent, at);
    return out;
}

const char *power_readable(int exponent, char out[READABLE_SIZE])
{
    if (exponent == 0 || exponent == 1)
        snprintf(out, READABLE_SIZE, exponent ? "10" : "1");
    else
        put_power(exponent, out);
    return out;
}

/* Returns the length of an exponent, such as "-3" or "^2", at the end of a symbol; 0 if there is
 * none. */
static size_t exponent_length(const char *chars)
{
    size_t length = *chars == '^';
    length += chars[length] == '-';
    const size_t digits = strspn(chars + length, "0123456789");
    return digits && !isalpha((unsigned char)chars[length + digits]) ? length + digits : 0;
}

void text_unit(Text *text, const char *unit)
{
    for (const char *at = unit; *at;) {
        const bool begins = at == unit || !isalpha((unsigned char)at[-1]);
        const size_t length = strcspn(at, "0123456789-^/*. ");
        size_t power = begins ? 0 : exponent_length(at);
        if (begins && length == 2 && *at == 'u' && strchr("mlLsgNVAW", at[1])) {
            text_puts(text, MICRO);
            at++;
        } else if (power) {
            for (; power; power--, at++)
                text_puts(text, *at == '^' ? "" : superscript(*at));
        } else {
            text_append(text, at++, 1);
        }
    }
}

void text_plain(Text *text, const char *chars)
{
    for (bool raised = false; *chars;) {
        size_t i = 0;
        while (i < SIGNS && strncmp(chars, signs[i].chars, strlen(signs[i].chars)) != 0)
            i++;
        text_puts(text, i <= SUPERSCRIPT_MINUS && !raised ? "^" : "");
        raised = i <= SUPERSCRIPT_MINUS;
        text_append(text, i < SIGNS ? signs[i].plain : chars, 1);
        chars += i < SIGNS ? strlen(signs[i].chars) : 1;
    }
}
