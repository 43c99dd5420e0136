/* Finds all roots of a quartic in an interval.
 *
 * The number of roots of a polynomial in Bernstein form in its interval is the number of sign
 * changes of its coefficients, or less by an even number (Descartes' rule). So no sign change
 * proves that there is no root, and one sign change proves that there is exactly one. With more
 * sign changes, the interval is halved [Lane & Riesenfeld 1981, Bounds on a polynomial, BIT 21,
 * 112]. Zero counts as positive, so that a root at the common end of two intervals belongs to
 * exactly one of them. */
#include "geom/quartic.h"

#include <math.h>
#include <stdbool.h>

/* Two roots that are not separated after MAX_HALVINGS, closer than 2^-32 of the interval, are those
 * of a grazing line, and are left out. NEWTON_STEPS suffices even if all steps are bisections,
 * which gain one bit each. */
enum { MAX_HALVINGS = 32, NEWTON_STEPS = 64 };

/* Returns the value at x in [0, 1] of a quartic in Bernstein form, and its slope, by de
 * Casteljau's scheme. */
static double quartic_at(const double b[5], double x, double *slope)
{
    double c[5] = {b[0], b[1], b[2], b[3], b[4]};
    for (int last = 4; last > 1; last--)
        for (int i = 0; i < last; i++)
            c[i] += (c[i + 1] - c[i]) * x;
    *slope = 4 * (c[1] - c[0]);
    return c[0] + (c[1] - c[0]) * x;
}

/* Returns the single root of a quartic whose values at 0 and 1 differ in sign. Uses Newton's
 * method; a step that leaves the bracket [low, high] is replaced by its middle. A value of 0 at an
 * end counts as positive, and is not the root. */
static double quartic_root(const double b[5])
{
    double low = 0, high = 1, x = 0.5;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        double slope, value = quartic_at(b, x, &slope);
        if ((value < 0) == (b[0] < 0))
            low = x;
        else
            high = x;
        double next = x - value / slope;
        if (fabs(next - x) <= 1e-16)
            return next;
        x = next > low && next < high ? next : (low + high) / 2;
    }
    return x;
}

static int sign_changes(const double b[5])
{
    int changes = 0;
    for (int i = 0; i < 4; i++)
        changes += (b[i] < 0) != (b[i + 1] < 0);
    return changes;
}

/* Splits the quartic at the middle of its interval: `b` becomes the first half, `second`
 * the second. */
static void quartic_halve(double b[5], double second[5])
{
    double first[5];
    for (int i = 0; i < 5; i++)
        second[i] = b[i];
    for (int k = 0; k < 5; k++) {
        first[k] = second[0];
        for (int i = 0; i < 4 - k; i++)
            second[i] = (second[i] + second[i + 1]) / 2;
    }
    for (int i = 0; i < 5; i++)
        b[i] = first[i];
}

/* Appends the roots in [low, high] of the quartic `b` to the `n` roots at `roots`. Returns the
 * new count. */
static int isolate_roots(double b[5], double low, double high, int halvings, double roots[4], int n)
{
    int changes = sign_changes(b);
    if (changes == 0 || n == 4)
        return n;
    if (changes == 1) {
        roots[n] = low + (high - low) * quartic_root(b);
        return n + 1;
    }
    if (halvings == MAX_HALVINGS)
        return n;
    double second[5], middle = (low + high) / 2;
    quartic_halve(b, second);
    n = isolate_roots(b, low, middle, halvings + 1, roots, n);
    return isolate_roots(second, middle, high, halvings + 1, roots, n);
}

int quartic_roots(const double b[5], double low, double high, double roots[4])
{
    double whole[5] = {b[0], b[1], b[2], b[3], b[4]};
    return isolate_roots(whole, low, high, 0, roots, 0);
}
