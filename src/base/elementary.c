/* Computes exp, log, pow, sin and other elementary functions, with the same bits on every machine
 * and with every C library.
 *
 * The functions are table-driven, in double precision [Tang, ACM TOMS 15 (1989) 144 and 16 (1990)
 * 378], with the logarithm of pow as a sum of two doubles whose parts are exact products [Dekker,
 * Numer. Math. 18 (1971) 224]. The arguments of the functions are first reduced to a small
 * interval, where a short polynomial suffices. No product relies on fused multiply-add.
 * docs/METHODS.md, section 3.10, proves the error bounds; tests/elementary/tables computes their
 * numbers. */
#include "base/elementary.h"

#include "base/elementary_tables.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

_Static_assert(FLT_EVAL_METHOD == 0,
               "elementary functions need doubles that are rounded to 53 bits at each operation");
#ifdef __FAST_MATH__
#error "-ffast-math and -Ofast change results; elementary functions need IEEE 754 arithmetic"
#endif

/* Adding and subtracting this number rounds a double to an integer, because doubles near 2^52 are
 * integers. */
static const double TO_INTEGER = 0x1.8p52;

__extension__ typedef unsigned __int128 Wide;

/* The number high + low, where |low| is far smaller than |high|. */
typedef struct Sum {
    double high, low;
} Sum;

static inline uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Returns the biased exponent; 0x7ff for infinities and NaN. */
static inline unsigned exponent_of(uint64_t bits)
{
    return (unsigned)(bits >> 52) & 0x7ff;
}

/* Returns x without its 27 last bits, which leaves 26. The product of two such numbers is exact. */
static inline double upper_half(double x)
{
    return of_bits(bits_of(x) & (UINT64_MAX << 27));
}

/* Returns a b with a relative error below 2^-100, unless it underflows. */
static inline Sum product(double a, double b)
{
    double a1 = upper_half(a), a2 = a - a1, b1 = upper_half(b), b2 = b - b1;
    double high = a * b;
    return (Sum){high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

/* Returns a + b exactly, |a| >= |b| or a = 0. */
static inline Sum fast_sum(double a, double b)
{
    double high = a + b;
    return (Sum){high, a - high + b};
}

/* Returns coefficient[0] + coefficient[1] x + ... with n coefficients, an even number: even and odd
 * powers are summed side by side, which takes half the time of one sum. */
static inline double polynomial(double x, const double *coefficient, int n)
{
    double square = x * x, even = coefficient[n - 2], odd = coefficient[n - 1];
    for (int i = n - 4; i >= 0; i -= 2) {
        even = even * square + coefficient[i];
        odd = odd * square + coefficient[i + 1];
    }
    return even + x * odd;
}

/* Returns the logarithm of the positive number x, given by its bits, as a sum whose relative error
 * is below 2^-69.7. |low| is at most 2^-18 |high|. */
static inline Sum log_of_bits(uint64_t x)
{
    /* x = 2^k z and z = c (1 + r): log x = k log 2 + log c + log(1 + r). */
    uint64_t offset = x - LOG_START;
    const LogEntry *at = &LOG_TABLE[(offset >> 44) % 256];
    uint64_t z_bits = x - (offset & (0xfffull << 52));
    double k = (double)((int64_t)offset >> 52), z = of_bits(z_bits);
    /* With 21 bits of z and 13 of 1 / c, these products and the square of r_high are exact. */
    double z_high = of_bits((z_bits + (1ull << 31)) & (UINT64_MAX << 32));
    double r_high = z_high * at->inverse - 1, r_low = (z - z_high) * at->inverse;
    double r = r_high + r_low, r_rest = r_low - (r - r_high);
    double constant = k * LOG_LN2_HIGH + at->log;
    double linear = constant + r,
           low = k * LOG_LN2_LOW + at->log_tail + r_rest + (constant - linear + r);
    double half_square = -0.5 * r_high * r_high;
    double high = linear + half_square;
    low += linear - high + half_square;
    low += -0.5 * r_low * (r + r_high);
    double square = r * r;
    double series = (1.0 / 3 - r * (1.0 / 4) + square * (1.0 / 5 - r * (1.0 / 6))) +
                    square * square * (1.0 / 7 - r * (1.0 / 8));
    return (Sum){high, low + r * square * series};
}

/* Returns scale (1 + part) near the bounds of the doubles. It is computed 2^1009 times too small or
 * 2^1022 times too large, and scaled by one multiplication. A result below the normal numbers is
 * rounded once, at its last bit: the addition of 1 gives the sum the same last bit. */
static double exp_at_the_bounds(uint64_t scale_bits, bool large, double part)
{
    if (large) {
        double scale = of_bits(scale_bits - (1009ull << 52));
        return 0x1p1009 * (scale + scale * part);
    }
    double scale = of_bits(scale_bits + (1022ull << 52)), y = scale + scale * part;
    if (y < 1) {
        double low = scale - y + scale * part, high = 1 + y;
        y = high + (1 - high + y + low) - 1;
    }
    return 0x1p-1022 * y;
}

/* exp(x + low) as scale (1 + part), |low| <= 0.001. `scale` holds the bits of a double, whose
 * exponent wraps around where the result is too large or too small for a double. */
typedef struct Exponential {
    uint64_t scale;
    double part;
} Exponential;

static inline Exponential exponential(double x, double low)
{
    /* x = k log 2 / 128 + r. The first product and difference are exact. */
    double shifted = x * EXP_PER_LN2 + TO_INTEGER, k = shifted - TO_INTEGER;
    uint64_t steps = bits_of(shifted);
    double r = (x - k * EXP_LN2_HIGH) + (low - k * EXP_LN2_LOW), square = r * r;
    const ExpEntry *at = &EXP_TABLE[steps % 128];
    double series = square * (1.0 / 2 + r * (1.0 / 6)) +
                    square * square * (1.0 / 24 + r * (1.0 / 120) + square * (1.0 / 720));
    return (Exponential){at->bits + (steps << 45), at->tail + series + r};
}

/* Returns exp(x + low), |low| <= 0.001; x is not NaN. */
static inline double exp_of_sum(double x, double low)
{
    if (!(fabs(x) <
          500)) { /* far enough from the bounds of the doubles, e^709.8 and e^-745.2, to be safe */
        if (x > 710)
            return (double)INFINITY;
        if (x < -746)
            return 0;
        Exponential e = exponential(x, low);
        return exp_at_the_bounds(e.scale, x > 0, e.part);
    }
    Exponential e = exponential(x, low);
    double scale = of_bits(e.scale);
    return scale + scale * e.part;
}

double elementary_exp(double x)
{
    return isnan(x) ? x + x : exp_of_sum(x, 0);
}

/* Returns the bits that a finite x > 0 would have if exponents had no lower bound. log_of_bits
 * accepts them although they are negative for subnormal numbers. */
static uint64_t normal_bits(double x)
{
    return x < DBL_MIN ? bits_of(x * 0x1p52) - (52ull << 52) : bits_of(x);
}

static bool is_positive_finite(double x)
{
    return x > 0 && x <= DBL_MAX;
}

/* Returns log(x) where x is not positive or not finite. */
static double log_of_bounds(double x)
{
    return x == 0 ? -(double)INFINITY : x > 0 ? x : x < 0 ? (double)NAN : x + x;
}

double elementary_log(double x)
{
    if (!is_positive_finite(x))
        return log_of_bounds(x);
    Sum log = log_of_bits(normal_bits(x));
    return log.high + log.low;
}

/* Returns log(x) times high + low. */
static double scaled_log(double x, double high, double low)
{
    if (!is_positive_finite(x))
        return log_of_bounds(x);
    Sum log = log_of_bits(normal_bits(x)), scaled = product(log.high, high);
    return scaled.high + (scaled.low + (log.low * high + log.high * low));
}

double elementary_log2(double x)
{
    return scaled_log(x, PER_LN2_HIGH, PER_LN2_LOW);
}

double elementary_log10(double x)
{
    return scaled_log(x, PER_LN10_HIGH, PER_LN10_LOW);
}

double elementary_log1p(double x)
{
    if (!is_positive_finite(1 + x))
        return log_of_bounds(1 + x);
    if (fabs(x) < 0x1p-20) /* the first term that is left out is below 2^-60 x */
        return x - x * x * (1.0 / 2 - x * (1.0 / 3));
    double sum = 1 + x, rest = x > 1 ? 1 - (sum - x) : x - (sum - 1);
    Sum log = log_of_bits(bits_of(sum));
    return log.high + (log.low + rest / sum);
}

double elementary_expm1(double x)
{
    static const double series[] = {1.0 / 2,   1.0 / 6,    1.0 / 24,    1.0 / 120,
                                    1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880};
    if (isnan(x) || x == 0)
        return x + x;
    if (fabs(x) < 0x1p-5) /* the first term that is left out is below 2^-62 x */
        return x + x * x * polynomial(x, series, 8);
    if (fabs(x) > 40) /* 1 is below half the last bit of e^40, and e^-40 of 1 */
        return x > 0 ? elementary_exp(x) : -1;
    Exponential e = exponential(x, 0);
    double scale = of_bits(e.scale);
    return scale - 1 + scale * e.part;
}

/* Returns 0 if y is no integer, 1 if it is odd, 2 if it is even; y is finite and not 0. */
static int parity(double y)
{
    double size = fabs(y);
    if (size >= 0x1p53)
        return 2;
    if (size != floor(size))
        return 0;
    return fmod(size, 2) == 1 ? 1 : 2;
}

/* Returns x^y where x or y is zero, infinite or NaN, x is 1, or y is so large or so small that it
 * decides alone. */
static double pow_of_bounds(double x, double y)
{
    if (y == 0 || x == 1)
        return 1;
    if (isnan(x) || isnan(y))
        return x + y;
    double size = fabs(x);
    if (isinf(y))
        return size == 1 ? 1 : (size > 1) == (y > 0) ? (double)INFINITY : 0;
    int whole = parity(y);
    if (size == 0 || isinf(x)) {
        double result = (size == 0) == (y < 0) ? (double)INFINITY : 0;
        return whole == 1 ? copysign(result, x) : result;
    }
    if (x < 0 && whole == 0)
        return (double)NAN;
    if (size == 1)
        return whole == 1 ? x : 1;
    if (fabs(y) < 0x1p-65) /* |log x| < 2^10 */
        return 1;
    double result =
        (size > 1) == (y > 0) ? (double)INFINITY : 0; /* |log x| >= 2^-53, |y| >= 2^64 */
    return x < 0 && whole == 1 ? -result : result;
}

/* Returns x^y, where `log` is the logarithm of x > 0 and 2^-65 <= |y| < 2^64. */
static inline double pow_of_log(Sum log, double y)
{
    double log1 = upper_half(log.high), log2 = log.high - log1 + log.low;
    double y1 = upper_half(y), y2 = y - y1;
    return exp_of_sum(y1 * log1, y2 * log1 + y * log2);
}

/* Returns true if |y| is below 2^-65, or 2^64 or more. */
static inline bool is_extreme(double y)
{
    return exponent_of(bits_of(y)) - (1023 - 65) >= 65 + 64;
}

/* Returns x^y where x is not a positive normal number, or y is extreme. */
static double pow_of_any(double x, double y)
{
    if (x == 0 || !isfinite(x) || is_extreme(y))
        return pow_of_bounds(x, y);
    int whole = x < 0 ? parity(y) : 2;
    if (whole == 0)
        return (double)NAN;
    double size = pow_of_log(log_of_bits(normal_bits(fabs(x))), y);
    return whole == 1 ? -size : size;
}

static inline bool is_positive_normal(double x)
{
    return bits_of(x) - bits_of(DBL_MIN) < bits_of((double)INFINITY) - bits_of(DBL_MIN);
}

double elementary_pow(double x, double y)
{
    if (!is_positive_normal(x) || is_extreme(y))
        return pow_of_any(x, y);
    return pow_of_log(log_of_bits(bits_of(x)), y);
}

Powers elementary_powers(double x, double a, double b)
{
    if (!is_positive_normal(x) || is_extreme(a) || is_extreme(b))
        return (Powers){elementary_pow(x, a), elementary_pow(x, b)};
    Sum log = log_of_bits(bits_of(x));
    return (Powers){pow_of_log(log, a), pow_of_log(log, b)};
}

double elementary_exp2(double x)
{
    return elementary_pow(2, x);
}

double elementary_cbrt(double x)
{
    if (x == 0 || !isfinite(x))
        return x + x;
    double size = fabs(x), y = elementary_pow(size, 1.0 / 3), scale = 1;
    if (size < 0x1p-900 || size > 0x1p900) {
        scale = size < 1 ? 0x1p-300 : 0x1p300;
        size = size < 1 ? size * 0x1p900 : size * 0x1p-900;
        y = elementary_pow(size, 1.0 / 3);
    }
    /* One step of Newton's method, whose residual is computed with twice the digits. */
    Sum square = product(y, y), cube = product(square.high, y);
    double residual = (size - cube.high) - (cube.low + square.low * y);
    return copysign(scale * (y + residual / (3 * square.high)), x);
}

double elementary_hypot(double x, double y)
{
    if (isinf(x) || isinf(y))
        return (double)INFINITY;
    double a = fabs(x), b = fabs(y), most = fmax(a, b), scale = 1;
    if (most > 0x1p500 || (most < 0x1p-450 && most > 0)) {
        scale = most > 1 ? 0x1p600 : 0x1p-600;
        a /= scale;
        b /= scale;
    }
    double root = sqrt(a * a + b * b);
    if (root == 0 || isnan(root))
        return root;
    /* One step of Newton's method, whose residual is computed with twice the digits. */
    Sum large = product(fmax(a, b), fmax(a, b)), small = product(fmin(a, b), fmin(a, b));
    Sum square = product(root, root);
    double residual =
        (large.high - square.high + small.high) + (large.low - square.low + small.low);
    return scale * (root + residual / (2 * root));
}

/* What is left of an angle when the nearest multiple of pi / 2 is subtracted, and the multiple
 * modulo 4. */
typedef struct Quadrant {
    Sum angle;
    unsigned turn;
} Quadrant;

/* Returns the 64 bits from bit `first` on, which counts from the highest bit of words[0]. */
static uint64_t bits_from(const uint64_t *words, int first)
{
    int word = first / 64, used = first % 64;
    return used > 0 ? words[word] << used | words[word + 1] >> (64 - used) : words[word];
}

/* Sets words[0..4] to the product of `mantissa` and 256 bits of 2 / pi, from bit `first` on. */
static void multiply_by_two_over_pi(uint64_t mantissa, int first, uint64_t *words)
{
    words[0] = 0;
    for (int i = 4; i > 0; i--) {
        Wide part = (Wide)bits_from(TWO_OVER_PI, first + 64 * (i - 1)) * mantissa + words[0];
        words[i] = (uint64_t)part;
        words[0] = (uint64_t)(part >> 64);
    }
}

/* Reduces a large angle by integers [Payne & Hanek, SIGNUM 18 (1983) 19]; 2^20 <= x < infinity. */
static Quadrant reduced_large(double x)
{
    /* x = mantissa 2^shift. Bits of 2 / pi that add multiples of 4 quarters are skipped. */
    uint64_t bits = bits_of(x), mantissa = (bits & ((1ull << 52) - 1)) | (1ull << 52), words[5];
    int shift = (int)exponent_of(bits) - 1075, skipped = shift > 2 ? shift - 2 : 0;
    multiply_by_two_over_pi(mantissa, skipped, words);
    int point = 64 + shift - skipped;
    uint64_t quarter = bits_from(words, point - 2) >> 62;
    uint64_t fraction = bits_from(words, point), next = bits_from(words, point + 64);
    /* From a half on, the next quarter is nearer: the fraction less 1, without its sign. */
    bool negative = fraction >> 63;
    if (negative) {
        quarter++;
        fraction = ~fraction;
        next = ~next;
    }
    double top = (double)(fraction >> 32) * 0x1p-32;
    double middle = (double)(fraction & 0xffffffff) * 0x1p-64;
    Sum turn = fast_sum(top, middle);
    turn = fast_sum(turn.high, turn.low + (double)next * 0x1p-128);
    Sum angle = product(turn.high, HALF_PI_HIGH);
    angle.low += turn.high * HALF_PI_LOW + turn.low * HALF_PI_HIGH;
    double sign = negative ? -1 : 1;
    return (Quadrant){fast_sum(sign * angle.high, sign * angle.low), quarter % 4};
}

/* Subtracts n pi / 2 from the finite x. pi / 2 is the sum of parts of 33, 33 and 53 bits. The
 * products of the first two and n < 2^20 are exact. */
static Quadrant reduced(double x)
{
    if (fabs(x) >= 0x1p20) {
        Quadrant large = reduced_large(fabs(x));
        if (x < 0)
            large = (Quadrant){{-large.angle.high, -large.angle.low}, (4 - large.turn) % 4};
        return large;
    }
    double shifted = x * TWO_PER_PI + TO_INTEGER, n = shifted - TO_INTEGER;
    double first = x - n * HALF_PI_1, second = n * HALF_PI_2;
    double high = first - second, part = high - first,
           low = (first - (high - part)) - (second + part);
    return (Quadrant){fast_sum(high, low - n * HALF_PI_3), (unsigned)bits_of(shifted) % 4};
}

/* Returns the sine of |x| <= pi / 4 by Taylor's series, whose next term is below 2^-62 of the
 * result. */
static double sine_of(Sum x)
{
    static const double series[] = {
        -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
        -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
    double square = x.high * x.high;
    return x.high + (x.low * (1 - square / 2) + x.high * square * polynomial(square, series, 8));
}

/* Returns the cosine of |x| <= pi / 4 by Taylor's series, whose next term is below 2^-62 of the
 * result. */
static double cosine_of(Sum x)
{
    static const double series[] = {
        1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
        1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
    Sum square = product(x.high, x.high);
    double half = square.high / 2, most = 1 - half;
    double rest = square.high * square.high * polynomial(square.high, series, 8) - square.low / 2 -
                  x.high * x.low;
    return most + (1 - most - half + rest);
}

/* Returns the sine of the angle plus `turn` times pi / 2. */
static double sine_in(Quadrant at, unsigned turn)
{
    turn = (at.turn + turn) % 4;
    double size = turn % 2 ? cosine_of(at.angle) : sine_of(at.angle);
    return turn >= 2 ? -size : size;
}

double elementary_sin(double x)
{
    if (!isfinite(x))
        return x - x;
    return x == 0 ? x : sine_in(reduced(x), 0);
}

double elementary_cos(double x)
{
    return isfinite(x) ? sine_in(reduced(x), 1) : x - x;
}

double elementary_tan(double x)
{
    if (!isfinite(x))
        return x - x;
    if (x == 0)
        return x;
    Quadrant at = reduced(x);
    return sine_in(at, 0) / sine_in(at, 1);
}

/* Returns atan(small / large), 0 <= small <= large, large > 0: the table's atan(i / 32) plus a
 * series for the rest. */
static Sum first_octant(double small, double large)
{
    static const double series[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13};
    int i = (int)(small / large * 32 + 0.5);
    double c = i / 32.0, large1 = upper_half(large);
    double u = (small - c * large1 - c * (large - large1)) / (large + c * small), square = u * u;
    return fast_sum(ATAN_TABLE[i][0],
                    ATAN_TABLE[i][1] + u * square * polynomial(square, series, 6) + u);
}

double elementary_atan2(double y, double x)
{
    if (isnan(x) || isnan(y))
        return x + y;
    double a = fabs(x), b = fabs(y), most = fmax(a, b);
    if (isinf(most)) {
        a = a == most;
        b = b == most;
    } else if (most > 0x1p500 || most < 0x1p-450) {
        double scale = most > 1 ? 0x1p-500 : 0x1p500;
        a *= scale;
        b *= scale;
    }
    Sum angle = b == 0 ? (Sum){0, 0} : b <= a ? first_octant(b, a) : first_octant(a, b);
    /* pi / 2 or pi less the angle, where the vector is not in the first octant. */
    double whole = b > a ? 1 : signbit(x) ? 2 : 0;
    if (whole == 2 || (whole == 1 && !signbit(x)))
        angle = (Sum){-angle.high, -angle.low};
    if (whole > 0) {
        Sum sum = fast_sum(whole * HALF_PI_HIGH, angle.high);
        angle = (Sum){sum.high, sum.low + (angle.low + whole * HALF_PI_LOW)};
    }
    return copysign(angle.high + angle.low, y);
}

double elementary_asin(double x)
{
    return elementary_atan2(x, sqrt((1 - x) * (1 + x)));
}

double elementary_acos(double x)
{
    return elementary_atan2(sqrt((1 - x) * (1 + x)), x);
}

/* Returns erf(x) for |x| <= 1/2. */
static double erf_near_0(double x)
{
    return x + x * polynomial(x * x, ERF_SERIES, 14);
}

/* Returns erfc(x) for x >= 1/2: exp(-x^2) / (1 + 2 x) times a function of x that lies between 1.1
 * and 1.3 and is approximated by a polynomial [Shepherd & Laframboise, Math. Comp. 36 (1981)
 * 249]. */
static double erfc_of_large(double x)
{
    if (x > 28) /* exp(-28^2) is below half the smallest double */
        return 0;
    Sum square = product(x, x);
    double slow = polynomial((x - 3.75) / (x + 3.75), ERFC_POLYNOMIAL, 22);
    return exp_of_sum(-square.high, -square.low) * (slow / (1 + 2 * x));
}

double elementary_erf(double x)
{
    if (isnan(x))
        return x + x;
    return fabs(x) <= 0.5 ? erf_near_0(x) : copysign(1 - erfc_of_large(fabs(x)), x);
}

double elementary_erfc(double x)
{
    if (isnan(x))
        return x + x;
    if (fabs(x) <= 0.5)
        return 1 - erf_near_0(x);
    return x > 0 ? erfc_of_large(x) : 2 - erfc_of_large(-x);
}
