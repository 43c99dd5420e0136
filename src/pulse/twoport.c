/* Computes the friction factor and the two-port of a vessel.
 *
 * The ratio of Bessel functions in Womersley's solution is a continued fraction. All its partial
 * quotients are positive, so it converges for every Womersley number and loses no digits. The last
 * RECURRENCE_TERMS terms are computed by the recurrence of numerators and denominators, which needs
 * no divisions, unless alpha is so large that it could overflow.
 *
 * cosh sqrt(t) and sinh sqrt(t) / sqrt(t) are power series in t, so no square root is needed. Where
 * t is not small, the vessel is halved until it is, and the functions are doubled again. */
#include "pulse/twoport.h"

#include <math.h>

/* More terms of the recurrence save more divisions, but its numbers grow with each term: 40 terms
 * with alpha below 100 stay far below the largest double. */
enum { RECURRENCE_TERMS = 40, SERIES_TERMS = 8 };
/* Up to this |t|, SERIES_TERMS terms are exact to 1e-16. A larger value would need more terms; a
 * smaller one, more doublings. */
static const double series_reach = 0.3;
/* A doubling rescales its results if they exceed this number, whose square is far below the largest
 * double. */
static const double rescale_above = 0x1p200;

PairFrequency pairfrequency(int first, double period_s, double wall_time_s)
{
    PairFrequency at = {0};
    for (int lane = 0; lane < PAIR; lane++) {
        double omega = FULL_TURN * (first + lane) / period_s, delayed = omega * wall_time_s;
        at.omega[lane] = omega;
        at.compliant.re[lane] = omega * delayed / (1 + delayed * delayed);
        at.compliant.im[lane] = omega / (1 + delayed * delayed);
    }
    return at;
}

/* Returns a number of terms that gives 14 digits for alpha up to 200. The maximum of 4000 terms,
 * for alpha = 370,000, bounds the time for senseless input. */
static int count_terms(double alpha2)
{
    const int most = 4000;
    double terms = 4 + 6.5 * sqrt(sqrt(alpha2));
    return terms < most ? (int)terms : most;
}

/* Evaluates the continued fraction from its last term to its first. v is the value of the fraction
 * from term m on. */
PairC pair_friction(PairR u)
{
    const double alpha2 = fmax(u[0], u[PAIR - 1]);
    const int n = count_terms(alpha2), recurrence = alpha2 < 1e4 ? RECURRENCE_TERMS : 0;
    PairC v = pairc(4 + 2 * n, 0), before = pairc(1, 0);
    int m = n - 1;
    for (; m >= recurrence; m--) {
        PairR s = u / (v.re * v.re + v.im * v.im);
        v = (PairC){4 + 2 * m + s * v.im, s * v.re};
    }
    for (; m >= 0; m--) {
        PairC next = {(4 + 2 * m) * v.re - u * before.im, (4 + 2 * m) * v.im + u * before.re};
        before = v;
        v = next;
    }
    v = pairc_mul(v, pairc_inverse(before));
    return pairc_scale(v, (PairR){0} + 0.25);
}

/* Sums the series of *a = cosh sqrt(t) - 1 and *s = sinh sqrt(t) / sqrt(t). */
static void sum_series(PairC t, PairC *a, PairC *s)
{
    PairC even = pairc(1, 0), odd = pairc(1, 0);
    for (int k = SERIES_TERMS; k > 1; k--) {
        even = pairc_scale(pairc_mul(t, even), (PairR){0} + 1.0 / (2 * k * (2 * k - 1)));
        odd = pairc_scale(pairc_mul(t, odd), (PairR){0} + 1.0 / (2 * k * (2 * k + 1)));
        even.re += 1;
        odd.re += 1;
    }
    *a = pairc_scale(pairc_mul(t, even), (PairR){0} + 0.5);
    *s = pairc_scale(pairc_mul(t, odd), (PairR){0} + 1.0 / 6);
    s->re += 1;
}

/* Doubles the argument: a(4 t) = 2 a (a + 2) for a = cosh - 1, s(4 t) = s(t) (1 + a(t)). Both are
 * multiplied by *scale, which becomes small where they grow. */
static void double_argument(PairC *a, PairC *s, PairR *scale)
{
    PairC beyond = {a->re + 2 * *scale, a->im}, cosh = {a->re + *scale, a->im};
    *s = pairc_mul(*s, cosh);
    *a = pairc_scale(pairc_mul(*a, beyond), (PairR){0} + 2);
    *scale *= *scale;
    for (int lane = 0; lane < PAIR; lane++) {
        double size = fmax(fabs(a->re[lane]), fabs(a->im[lane]));
        double factor = size > rescale_above ? 1 / size : 1;
        a->re[lane] *= factor;
        a->im[lane] *= factor;
        s->re[lane] *= factor;
        s->im[lane] *= factor;
        (*scale)[lane] *= factor;
    }
}

static double largest(PairC t)
{
    PairR size = t.re * t.re + t.im * t.im;
    return sqrt(fmax(size[0], size[PAIR - 1]));
}

/* z and y are the series impedance and the shunt admittance of the whole vessel, and t = z y. t is
 * divided by 4 per doubling. */
PairPort pair_port(const PulseVessel *vessel, const PairFrequency *at)
{
    PairPort port = {.scale = (PairR){0} + 1};
    PairC z = pairc_scale(pair_friction(at->omega * vessel->womersley_s),
                          (PairR){0} + vessel->resistance);
    z.im += at->omega * vessel->inertance;
    PairC y = pairc_scale(at->compliant, (PairR){0} + vessel->compliance), t = pairc_mul(z, y), s;
    int doublings = 0;
    for (double size = largest(t); size > series_reach && size < HUGE_VAL; size /= 4)
        doublings++;
    sum_series(pairc_scale(t, (PairR){0} + ldexp(1, -2 * doublings)), &port.a, &s);
    for (int k = 0; k < doublings; k++)
        double_argument(&port.a, &s, &port.scale);
    port.a.re += port.scale;
    port.b = pairc_mul(z, s);
    port.c = pairc_mul(y, s);
    return port;
}
