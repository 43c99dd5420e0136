/* Operations of affine arithmetic against exact values. A value is an integer of 128 bits that
 * counts units of 2^-BITS, so that sums and products of forms whose numbers have 53 bits are exact.
 * Bounds that a form states are rounded outwards to such integers, by far less than 2^-53. */
#include "unit.h"

#include "answer/affine.h"

__extension__ typedef __int128 Wide;

/* `IN` bits after the point of numbers of a form; a product has twice as many. `ROOT` bits after
 * the point of bounds that are squared. */
enum { IN = 52, PRODUCT = 2 * IN, ROOT = 60, REPETITIONS = 8000 / SHARE };

static uint64_t state = 20261;

static uint64_t next_bits(int n)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return state >> (64 - n);
}

/* Returns a number in (-size, size) with up to 53 bits, a multiple of 2^-IN; often 0. */
static double number(double size)
{
    const double v = ldexp((double)next_bits(52), -52) * size;
    return next_bits(2) == 0 ? 0 : ldexp(rint(ldexp(next_bits(1) ? v : -v, IN)), -IN);
}

/* Returns a form with values in (low, low + 2). A quarter are constants, and a quarter have no e.
 */
static Form form_above(double low)
{
    const double varies = next_bits(2) ? ldexp(0.25, -(int)next_bits(3)) : 0;
    const double unknown = ldexp(0.25, -(int)next_bits(6));
    return (Form){low + 1 + number(0.25), number(varies), number(varies), fabs(number(unknown))};
}

static Wide rounded_down(double v, int bits)
{
    return (Wide)floor(ldexp(v, bits));
}

static Wide rounded_up(double v, int bits)
{
    return (Wide)ceil(ldexp(v, bits));
}

/* A point of the rectangle, and where in [-e, e] the two operands are: each is -1, 0 or 1. */
typedef struct Point {
    int ex, ey, ea, eb;
} Point;

static Wide low_at(Form f, Point p, int bits)
{
    return rounded_down(f.c, bits) + rounded_down(f.x * p.ex, bits) +
           rounded_down(f.y * p.ey, bits) - rounded_up(f.e, bits);
}

static Wide high_at(Form f, Point p, int bits)
{
    return rounded_up(f.c, bits) + rounded_up(f.x * p.ex, bits) + rounded_up(f.y * p.ey, bits) +
           rounded_up(f.e, bits);
}

/* Returns an exact value that a form encloses, in units of 2^-IN. */
static Wide value_at(Form f, Point p, int in_error)
{
    return rounded_down(f.c, IN) + rounded_down(f.x * p.ex, IN) + rounded_down(f.y * p.ey, IN) +
           in_error * rounded_down(f.e, IN);
}

static Wide fine(Wide value)
{
    return value * ((Wide)1 << (PRODUCT - IN));
}

/* `value` is in units of 2^-PRODUCT. */
static void expect_encloses(const char *what, Form f, Point p, Wide value)
{
    const int bits = PRODUCT;
    if (!isfinite(f.e) || low_at(f, p, bits) > value || high_at(f, p, bits) < value)
        fail_msg("%s: at (%d, %d) the form %a %a %a %a does not enclose %a", what, p.ex, p.ey, f.c,
                 f.x, f.y, f.e, ldexp((double)value, -bits));
}

static Point point_of(int k)
{
    return (Point){k % 3 - 1, k / 3 % 3 - 1, k / 9 % 3 - 1, k / 27 - 1};
}

/* Returns a form of either sign, or one of which nothing but e is known. */
static Form signed_form(void)
{
    const Form f = form_above(1.5), unknown = {0, 0, 0, fabs(number(2))};
    return next_bits(2) == 0 ? unknown : next_bits(1) ? f : form_neg(f);
}

static void sums_and_products_enclose_exact_values(void **unused)
{
    (void)unused;
    for (int i = 0; i < REPETITIONS; i++) {
        const Form a = signed_form(), b = signed_form(), hull = form_hull(a, b);
        const Form sum = form_add(a, b), difference = form_sub(a, b);
        const Form product = form_mul(a, b), scaled = form_scale(a, b.c);
        const Form positive = form_positive(form_sub(a, form_of(b.c, 0)));
        const Form constant = form_of(b.c, b.e);
        const Form3 constants = {constant, form_of(a.c, 0), constant};
        const Form dot = form3_dot((Form3){a, b, a}, constants);
        const Form turned = form3_dot(constants, (Form3){a, b, a});
        for (int k = 0; k < 81; k++) {
            const Point p = point_of(k);
            const Wide u = value_at(a, p, p.ea), v = value_at(b, p, p.eb);
            const Wide factor = rounded_down(b.c, IN), rest = u - factor;
            expect_encloses("sum", sum, p, fine(u + v));
            expect_encloses("difference", difference, p, fine(u - v));
            expect_encloses("product", product, p, u * v);
            expect_encloses("multiple", scaled, p, u * factor);
            const Wide known = factor + p.eb * rounded_down(b.e, IN);
            const Wide exact = 2 * u * known + v * rounded_down(a.c, IN);
            expect_encloses("dot product", dot, p, exact);
            expect_encloses("dot product", turned, p, exact);
            expect_encloses("hull", hull, p, fine(u));
            expect_encloses("hull", hull, p, fine(v));
            expect_encloses("positive part", positive, p, fine(rest > 0 ? rest : 0));
            assert_true(rounded_down(form_low(a), PRODUCT) <= fine(u));
            assert_true(rounded_up(form_high(a), PRODUCT) >= fine(u));
            assert_true(rounded_up(form_most(a), PRODUCT) >= fine(u < 0 ? -u : u));
        }
    }
}

/* A bound l of the root of v is proven by l^2 <= v, and a bound of 1 / v by l |v| <= the
 * sign of v. Inverses above 256 do not fit and are left out. */
static void roots_and_inverses_enclose_exact_values(void **unused)
{
    (void)unused;
    for (int i = 0; i < REPETITIONS; i++) {
        const Form a = form_above(next_bits(2) ? 0 : -0.875), root = form_sqrt(a);
        const Form inverse = form_inverse(a);
        for (int k = 0; k < 27; k++) {
            const Point p = point_of(k);
            const Wide v = value_at(a, p, p.ea), size = v < 0 ? -v : v;
            const Wide one = ((Wide)1 << (IN + ROOT)) * (v < 0 ? -1 : 1);
            const Wide low = low_at(root, p, ROOT), high = high_at(root, p, ROOT);
            const Wide square = v * ((Wide)1 << (2 * ROOT - IN));
            if (v >= 0 && ((low > 0 && low * low > square) || high < 0 || high * high < square))
                fail_msg("root of %a: %a..%a", ldexp((double)v, -IN), ldexp((double)low, -ROOT),
                         ldexp((double)high, -ROOT));
            if (form_low(a) <= 0 && form_high(a) >= 0)
                assert_true(isinf(inverse.e));
            else if (form_most(inverse) < 256 && (low_at(inverse, p, ROOT) * size > one ||
                                                  high_at(inverse, p, ROOT) * size < one))
                fail_msg("inverse of %a", ldexp((double)v, -IN));
        }
    }
}

/* Returns v^exponent in units of 2^-ROOT, rounded down or up at each product. */
static Wide power_of(Wide v, int exponent, bool up)
{
    Wide power = (Wide)1 << ROOT;
    for (int i = 0; i < exponent; i++) {
        const Wide product = power * v, unit = (Wide)1 << IN;
        power = product / unit + (up && product % unit != 0);
    }
    return power;
}

static void powers_enclose_exact_values(void **unused)
{
    (void)unused;
    static const int exponents[] = {1, 2, 3, 41};
    for (int i = 0; i < REPETITIONS; i++) {
        const int exponent = exponents[next_bits(2)];
        Form a = form_above(-1);
        a.c = 0.5 + number(0.5);
        const Form power = form_power(a, exponent);
        for (int k = 0; k < 27 && form_high(a) <= 1; k++) {
            const Point p = point_of(k);
            const Wide v = value_at(a, p, p.ea), base = v > 0 ? v : 0;
            if (low_at(power, p, ROOT) > power_of(base, exponent, true) ||
                high_at(power, p, ROOT) < power_of(base, exponent, false))
                fail_msg("power %d of %a", exponent, ldexp((double)v, -IN));
        }
    }
}

static void values_known_to_lie_in_a_range_stay_enclosed(void **unused)
{
    (void)unused;
    for (int i = 0; i < REPETITIONS; i++) {
        const Form a = form_above(next_bits(1) ? -0.5 : -1.75), cut = form_known(a, -1, 1);
        for (int k = 0; k < 27; k++) {
            const Point p = point_of(k);
            const Wide v = value_at(a, p, p.ea), one = (Wide)1 << IN;
            if (v >= -one && v <= one)
                expect_encloses("cut", cut, p, fine(v));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_and_products_enclose_exact_values),
        cmocka_unit_test(roots_and_inverses_enclose_exact_values),
        cmocka_unit_test(powers_enclose_exact_values),
        cmocka_unit_test(values_known_to_lie_in_a_range_stay_enclosed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
