/* Chooses the values of a color scale at which a legend has ticks. The values are round numbers: 1,
 * 2 and 5 times powers of ten. A logarithmic scale over two or more powers of ten has ticks at the
 * powers, or at every second, third, ... power. A shorter logarithmic scale has ticks at 1, 2 and 5
 * times the powers. If fewer than two such ticks are in the range, the ticks are equidistant, as on
 * a linear scale. */
#include "figure/figure.h"

#include <math.h>

/* Relative slack of comparisons: rounding must not drop a tick at an end of the range. Any value
 * would do that is well above 2^-52 and too small to be seen in a figure. */
#define SLACK 1e-9

/* Returns the smallest of 1, 2, 5, 10, 20, ... times a power of ten that is not below `least`. */
static double round_step(double least)
{
    double power = elementary_pow(10, floor(elementary_log10(least)));
    static const double digits[] = {1, 2, 5};
    for (size_t i = 0; i < sizeof digits / sizeof *digits; i++)
        if (digits[i] * power >= least * (1 - SLACK))
            return digits[i] * power;
    return 10 * power;
}

/* Stores the multiples of `step` in the range as ticks. Returns their number. */
static int ticks_at_steps(const double range[2], double step, double ticks[FIGURE_TICKS])
{
    const double slack = SLACK * (range[1] - range[0]);
    int n = 0;
    for (double k = ceil((range[0] - slack) / step); k * step <= range[1] + slack; k++)
        if (n < FIGURE_TICKS)
            ticks[n++] = k * step + 0; /* converts -0 to 0 */
    return n;
}

/* One number does not show how the scale runs. If the step has fewer than two multiples in the
 * range, the next smaller steps are tried. */
static int equidistant(const double range[2], int wanted, bool integers, double ticks[FIGURE_TICKS])
{
    int n = 0;
    for (double least = (range[1] - range[0]) / wanted; n < (wanted < 2 ? 1 : 2); least /= 2) {
        const double step = integers ? fmax(round_step(least), 1) : round_step(least);
        n = ticks_at_steps(range, step, ticks);
        if (integers && step <= 1)
            break;
    }
    return n;
}

/* Stores ticks at 1, 2 and 5 times every `apart`-th power of ten, or only at the first `n_factors`
 * of these multiples. Returns the number of ticks. */
static int ticks_at_powers(const double range[2], int apart, int n_factors,
                           double ticks[FIGURE_TICKS])
{
    static const double factors[] = {1, 2, 5};
    int n = 0;
    for (int k = (int)floor(elementary_log10(range[0])); k <= (int)ceil(elementary_log10(range[1]));
         k++)
        for (int i = 0; i < n_factors && k % apart == 0; i++) {
            /* Powers below 1 are divisors: 10^|k| is exact up to k = 22, 10^-|k| is not. */
            double value =
                k < 0 ? factors[i] / elementary_pow(10, -k) : factors[i] * elementary_pow(10, k);
            if (value >= range[0] * (1 - SLACK) && value <= range[1] * (1 + SLACK) &&
                n < FIGURE_TICKS)
                ticks[n++] = value;
        }
    return n;
}

int figure_ticks(const ColorScale *scale, int wanted, bool integers, double ticks[FIGURE_TICKS])
{
    const double *range = scale->range;
    if (!(range[0] < range[1])) {
        ticks[0] = range[0];
        return 1;
    }
    if (!scale->log)
        return equidistant(range, wanted, integers, ticks);
    double decades = elementary_log10(range[1] / range[0]);
    int n = decades >= 2 ? ticks_at_powers(range, (int)ceil(decades / wanted), 1, ticks)
                         : ticks_at_powers(range, 1, 3, ticks);
    return n >= 2 ? n : equidistant(range, wanted, integers, ticks);
}
