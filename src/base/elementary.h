/* Elementary functions that return the same bits on every processor, compiler and C library.
 *
 * A C library may have several versions of pow, exp or log, which round differently, and choose one
 * by the processor: glibc does so if the processor has fused multiply-add. The functions here use
 * only integers and additions, multiplications, divisions and square roots of doubles, which IEEE
 * 754 defines to the last bit. Modules whose results reach a file call these functions. They call
 * no function of the C library that is not exactly rounded; tests/check-elementary checks this in
 * the object files.
 *
 * Special values (0, infinities, NaN, subnormal numbers) are those of C11, annex F. The rounding
 * mode must be to nearest. errno and the floating-point exception flags are not set.
 *
 * Errors are below these bounds, in units in the last place of the result, which docs/METHODS.md,
 * section 3.10, proves:
 *
 *     log, log2, log10      0.501     expm1        1.1     atan2        2.8
 *     exp                   0.508     sin          1.1     asin, acos   5.5
 *     pow, exp2             0.518     cos          0.65    erf          5
 *     cbrt, log1p, hypot    0.51      tan          4       erfc         9
 *
 * A subnormal result of hypot, tan, atan2 or erfc may be off by one more unit. */
#ifndef CORCAST_BASE_ELEMENTARY_H
#define CORCAST_BASE_ELEMENTARY_H

double elementary_exp(double x);
double elementary_exp2(double x);
/* Returns exp(x) - 1, accurately also near 0. */
double elementary_expm1(double x);
double elementary_log(double x);
double elementary_log2(double x);
double elementary_log10(double x);
/* Returns log(1 + x), accurately also near 0. */
double elementary_log1p(double x);
/* Returns x to the power y. A result that a double can represent exactly, such as 10^22 or an
 * integer power of 2, is returned exactly. */
double elementary_pow(double x, double y);
/* Two powers of one number, x^a and x^b. */
typedef struct Powers {
    double a, b;
} Powers;

/* Returns the bits of elementary_pow(x, a) and elementary_pow(x, b), at one and a half times the
 * cost of one. */
Powers elementary_powers(double x, double a, double b);
double elementary_cbrt(double x);
/* Returns sqrt(x^2 + y^2), without overflow or underflow of the squares. */
double elementary_hypot(double x, double y);
/* Arguments are in radians and may have any size. */
double elementary_sin(double x);
double elementary_cos(double x);
double elementary_tan(double x);
/* Returns the angle of the vector (x, y) to the x axis, in [-pi, pi]. */
double elementary_atan2(double y, double x);
/* elementary_asin and elementary_acos return NaN outside [-1, 1]. */
double elementary_asin(double x);
double elementary_acos(double x);
/* Returns the error function, 2 / sqrt(pi) times the integral of exp(-t^2) from 0 to x. */
double elementary_erf(double x);
/* Returns 1 - erf(x), accurately also where erf(x) is close to 1. */
double elementary_erfc(double x);

#endif
