/* Converts numbers to text that reads back to the same double, and text to numbers.
 *
 * number_text tries 15, 16 and 17 digits. A double needs at most 17. The first text that reads back
 * is the shortest, except in rare cases of even fewer digits, whose trailing zeros are cut. For
 * values in [1e-4, 1e14) the conversion is exact integer arithmetic, ten times as fast as printing
 * and reading. The value m 2^e, scaled to a number of digits before the point, is N / 2^shift. The
 * integer N = m 5^k fits in 128 bits, and the spacing of doubles there is 5^k in units of N.
 *
 * number_take reads numbers of at most 19 digits that equal an integer times 10^k, with k from -26
 * to 26. It uses the same arithmetic, five times as fast as strtod: the product with 5^k, or the
 * quotient to at least 64 bits with a flag for a remainder, is rounded once. number_parse leaves
 * all other numbers to strtod. The program never calls setlocale, and the library gives its threads
 * the locale "C", so that printf and strtod use '.'. */
#include "base/number.h"

#include "base/text.h"
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 Wide;

typedef struct Decimal {
    uint64_t digits; /* without a point */
    int count;       /* number of digits */
    int exponent;    /* power of ten of the first digit */
} Decimal;

/* 5^k for k from 0 to 26. */
static uint64_t power_of_5(int k)
{
    static const uint32_t low[] = {1,       5,        25,        125,       625,
                                   3125,    15625,    78125,     390625,    1953125,
                                   9765625, 48828125, 244140625, 1220703125};
    return (uint64_t)low[k / 2] * low[k - k / 2];
}

/* Rounds m 2^e to `count` digits, whose first digit has the power 10^exponent. Returns true if the
 * digits read back as the same double. */
static bool round_decimal(uint64_t m, int e, int count, int exponent, Decimal *out)
{
    int k = count - 1 - exponent, shift = -(e + k);
    uint64_t spacing = power_of_5(k);
    Wide exact = (Wide)m * spacing, unit = (Wide)1 << shift;
    uint64_t digits = (uint64_t)(exact >> shift);
    Wide rest = exact & (unit - 1);
    bool up = 2 * rest > unit || (2 * rest == unit && digits % 2);
    Wide error = up ? unit - rest : rest;
    *out = (Decimal){digits + up, count, exponent};
    /* Below a power of two, the spacing of doubles is half as wide. */
    Wide room = m == (uint64_t)1 << 52 && !up ? 4 * error : 2 * error;
    return room < spacing || (room == spacing && m % 2 == 0);
}

/* Writes a decimal without exponent, and without zeros at its end. */
static void print_decimal(Decimal d, bool negative, char *out)
{
    if (d.digits == power_of_5(d.count) << d.count) { /* 10^count: rounded up to one digit more */
        d.digits /= 10;
        d.exponent++;
    }
    while (d.digits % 10 == 0) {
        d.digits /= 10;
        d.count--;
    }
    char text[24];
    for (int i = d.count; i-- > 0; d.digits /= 10)
        text[i] = (char)('0' + d.digits % 10);
    if (negative)
        *out++ = '-';
    if (d.exponent < 0) {
        *out++ = '0';
        *out++ = '.';
        for (int i = -1; i > d.exponent; i--)
            *out++ = '0';
    }
    for (int i = 0; i < d.count || i <= d.exponent; i++) {
        if (i > 0 && i == d.exponent + 1)
            *out++ = '.';
        *out++ = i < d.count ? text[i] : '0';
    }
    *out = '\0';
}

/* number_text for magnitudes in [1e-4, 1e14). */
static void print_common(double value, char *out)
{
    int e;
    double magnitude = fabs(value);
    uint64_t m = (uint64_t)ldexp(frexp(magnitude, &e), 53);
    e -= 53;
    /* negative powers of ten round up to doubles, so that the comparisons are exact */
    static const double limits[] = {1e-3, 1e-2, 1e-1, 1,   1e1,  1e2,  1e3,  1e4, 1e5,
                                    1e6,  1e7,  1e8,  1e9, 1e10, 1e11, 1e12, 1e13};
    int exponent = -4;
    for (size_t i = 0; i < sizeof limits / sizeof *limits && magnitude >= limits[i]; i++)
        exponent++;
    Decimal decimal;
    for (int count = 15; count <= 17; count++)
        if (round_decimal(m, e, count, exponent, &decimal))
            break;
    print_decimal(decimal, value < 0, out);
}

const char *number_text(double value, char out[NUMBER_TEXT_SIZE])
{
    if (fabs(value) >= 1e-4 && fabs(value) < 1e14) {
        print_common(value, out);
        return out;
    }
    if (value == 0) {
        strcpy(out, signbit(value) ? "-0" : "0");
        return out;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(out, NUMBER_TEXT_SIZE, "%.*g", digits, value);
        if (strtod(out, NULL) == value || !isfinite(value))
            break;
    }
    return out;
}

const char *number_text_rounded(double value, int digits, char out[NUMBER_TEXT_SIZE])
{
    if (digits > 0 && isfinite(value)) {
        snprintf(out, NUMBER_TEXT_SIZE, "%.*e", digits - 1, value);
        value = strtod(out, NULL);
    }
    return number_text(value, out);
}

const char *number_text_float(float value, char out[NUMBER_TEXT_SIZE])
{
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(out, NUMBER_TEXT_SIZE, "%.*g", digits, (double)value);
        if (strtof(out, NULL) == value || !isfinite(value))
            break;
    }
    return out;
}

const char *bytes_text(double bytes, char out[BYTES_TEXT_SIZE])
{
    static const char *const units[] = {"kB", "MB", "GB", "TB"};
    if (bytes < 1000) {
        snprintf(out, BYTES_TEXT_SIZE, "%.0f byte%s", bytes, bytes == 1 ? "" : "s");
        return out;
    }
    size_t unit = 0;
    for (bytes /= 1000; bytes >= 999.95 && unit < 3; unit++)
        bytes /= 1000;
    snprintf(out, BYTES_TEXT_SIZE, "%.1f %s", bytes, units[unit]);
    return out;
}

/* A decimal number as text states it: sign, digits, power of ten. */
typedef struct Written {
    bool negative;
    uint64_t digits;
    int exponent;
} Written;

/* Reads the digits at *at and appends them to *digits. Returns false if these are more than 19
 * digits, not counting zeros at the front. */
static bool scan_digits(const char **at, uint64_t *digits)
{
    const uint64_t most = UINT64_C(999999999999999999);
    for (; **at >= '0' && **at <= '9'; (*at)++) {
        if (*digits > most)
            return false;
        *digits = 10 * *digits + (uint64_t)(**at - '0');
    }
    return true;
}

/* Reads an exponent of up to three digits at *at; 0 if there is none. Returns false for a longer or
 * incomplete one. */
static bool scan_exponent(const char **at, int *exponent)
{
    uint64_t digits = 0;
    *exponent = 0;
    if (**at != 'e' && **at != 'E')
        return true;
    bool negative = *++*at == '-';
    *at += negative || **at == '+';
    const char *start = *at;
    if (!scan_digits(at, &digits) || *at == start || *at > start + 3)
        return false;
    *exponent = negative ? -(int)digits : (int)digits;
    return true;
}

/* Reads a number at *at. Returns false if there is no number, or it has too many digits. */
static bool scan_number(const char **at, Written *out)
{
    int exponent;
    *out = (Written){.negative = **at == '-'};
    *at += out->negative || **at == '+';
    const char *start = *at;
    if (!scan_digits(at, &out->digits))
        return false;
    bool point = **at == '.';
    *at += point;
    const char *fraction = *at;
    if (!scan_digits(at, &out->digits) || *at - start == point)
        return false;
    out->exponent = -(int)(*at - fraction);
    if (!scan_exponent(at, &exponent))
        return false;
    out->exponent += exponent;
    return true;
}

static int bits_of(Wide n)
{
    uint64_t high = (uint64_t)(n >> 64);
    return high ? 128 - __builtin_clzll(high) : 64 - __builtin_clzll((uint64_t)n);
}

/* Returns 2^e, which must be a normal double. */
static double power_of_2(int e)
{
    uint64_t bits = (uint64_t)(e + DBL_MAX_EXP - 1) << (DBL_MANT_DIG - 1);
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* Returns the double nearest to n 2^e or, with `rest`, to (n + r) 2^e for an r between 0 and 1; on
 * a tie, the double whose last bit is 0. With `rest`, n must be above 2^54. */
static double nearest_double(Wide n, bool rest, int e)
{
    int spare = bits_of(n) - DBL_MANT_DIG;
    if (spare <= 0)
        return (double)(uint64_t)n * power_of_2(e);
    uint64_t kept = (uint64_t)(n >> spare);
    Wide half = (Wide)1 << (spare - 1), dropped = n & (2 * half - 1);
    kept += dropped > half || (dropped == half && (rest || kept % 2));
    return (double)kept * power_of_2(e + spare);
}

enum { MOST_FIVES = 26 };

/* Sets *out to the magnitude of the number. Returns false if its exponent is out of the range of
 * power_of_5. */
static bool written_value(const Written *written, double *out)
{
    uint64_t m = written->digits;
    int k = written->exponent;
    if (m == 0 || k < -MOST_FIVES || k > MOST_FIVES) {
        *out = 0;
        return m == 0;
    }
    if (k >= 0) {
        *out = nearest_double((Wide)m * power_of_5(k), false, k);
        return true;
    }
    int shift = __builtin_clzll(m);
    Wide scaled = (Wide)(m << shift) << 64, divisor = power_of_5(-k), quotient = scaled / divisor;
    *out = nearest_double(quotient, quotient * divisor != scaled, k - 64 - shift);
    return true;
}

bool number_take(const char **at, double *out)
{
    Written written;
    double magnitude;
    const char *end = *at;
    if (!scan_number(&end, &written) || !written_value(&written, &magnitude))
        return false;
    *out = written.negative ? -magnitude : magnitude;
    *at = end;
    return true;
}

bool number_parse(const char *chars, double *out)
{
    const char *behind = chars;
    double taken;
    if (number_take(&behind, &taken) && !*behind) {
        *out = taken;
        return true;
    }
    if (!*chars || isspace((unsigned char)*chars))
        return false;
    /* strtod accepts hexadecimal numbers of C, which files and options must not have. */
    if (strpbrk(chars, "xX"))
        return false;
    char *end;
    double value = strtod(chars, &end);
    if (*end)
        return false;
    *out = value;
    return true;
}

bool numbers_parse(const char *chars, size_t count, double *out)
{
    for (size_t i = 0; i < count; i++) {
        char number[400]; /* longer than any number that printf writes: the largest double has 309
                             digits */
        chars += strspn(chars, TEXT_BLANKS);
        size_t length = strcspn(chars, TEXT_BLANKS);
        if (length >= sizeof number)
            return false;
        memcpy(number, chars, length);
        number[length] = '\0';
        if (!number_parse(number, &out[i]))
            return false;
        chars += length;
    }
    return chars[strspn(chars, TEXT_BLANKS)] == '\0';
}

bool integer_parse(const char *chars, long long minimum, long long maximum, long long *out)
{
    if (!*chars || isspace((unsigned char)*chars))
        return false;
    char *end;
    errno = 0;
    long long value = strtoll(chars, &end, 10);
    if (*end || errno || value < minimum || value > maximum)
        return false;
    *out = value;
    return true;
}
