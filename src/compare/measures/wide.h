/* Lets the compiler turn loops over pixels into AVX2 instructions: attributes for functions, and
 * roots, logarithms and powers of floats without branches or calls. Private to the module compare.
 *
 *     FLAT static void do_row(...) { ... }
 *     WIDE static void do_row_wide(...) { do_row(...); }
 *     threads_for(rows, 0, wide_usable() ? do_row_wide : do_row, &context); */
#ifndef CORCAST_COMPARE_MEASURES_WIDE_H
#define CORCAST_COMPARE_MEASURES_WIDE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The compiler inlines all calls in a FLAT function, so that its loops over pixels have no calls. A
 * WIDE function is a FLAT function that is compiled for AVX2. It may be called only if wide_usable
 * returns true. The compiler neither reorders sums nor fuses a product with a sum, so both give the
 * same bits. */
#define FLAT __attribute__((flatten))
#ifdef __x86_64__
#define WIDE __attribute__((target("avx2"), flatten))
static inline bool wide_usable(void)
{
    return __builtin_cpu_supports("avx2") != 0;
}
#else
#define WIDE FLAT
static inline bool wide_usable(void)
{
    return false;
}
#endif

/* ---- roots and powers ------------------------------------------------------------------------
 * In the ranges that FLIP and CIEDE2000 use, the errors of these functions are a few units in the
 * last place. */

/* Returns the float with these bits. */
static inline float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns the bits of a float. */
static inline uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Returns the cube root of x > 0. The bits of x divided by 3 give a third of its logarithm, and so
 * a first value; 0x2a5137a0 restores the exponent's bias. Two steps of Halley's method correct it.
 */
static inline float cube_root(float x)
{
    float y = float_of(bits_of(x) / 3 + 0x2a5137a0u);
    for (int i = 0; i < 2; i++) {
        float cube = y * y * y;
        y = y * (cube + 2 * x) / (2 * cube + x);
    }
    return y;
}

/* Returns the binary logarithm of x > 0. With x = m 2^e and m in [sqrt(1/2), sqrt(2)), it is e + 2
 * artanh((m - 1) / (m + 1)) / ln 2. 0x3f3504f3 is sqrt(1/2) as bits. */
static inline float log_2(float x)
{
    uint32_t bits = bits_of(x) - 0x3f3504f3u;
    int exponent = (int)bits >> 23;
    float m = float_of((bits & 0x007fffffu) + 0x3f3504f3u);
    float s = (m - 1) / (m + 1), s2 = s * s;
    float series = 1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
    return (float)exponent + 2.88539008f * s * series;
}

/* Returns 2^x for x in [-126, 126]. The nearest integer to x sets the bits of the exponent. The
 * rest, at most 1/2, goes into the series. */
static inline float exp_2(float x)
{
    int n = (int)(x + (x < 0 ? -0.5f : 0.5f));
    float r = (x - (float)n) * 0.693147181f;
    float series =
        1 +
        r * (1 + r * (1.0f / 2 + r * (1.0f / 6 + r * (1.0f / 24 + r * (1.0f / 120 + r / 720)))));
    return series * float_of((uint32_t)(n + 127) << 23);
}

/* Returns x^y for x >= 0 and y in [0, 1]; 0 if x < 1e-30. */
static inline float power(float x, float y)
{
    float positive = x < 1e-30f ? 1e-30f : x;
    uint32_t kept = 0u - (uint32_t)(x >= 1e-30f); /* a mask: a branch prevents vectors */
    return float_of(bits_of(exp_2(y * log_2(positive))) & kept);
}

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float magnitude(float x)
{
    return x < 0 ? -x : x;
}

#endif
