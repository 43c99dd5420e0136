/* Elementary functions against exact values of tests/elementary/values, against the special values
 * of C11, annex F, and against the bits recorded here. */
#include "unit.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef double (*OneArgument)(double);
typedef double (*TwoArguments)(double, double);

/* `bound` is the proven error in units in the last place [base/elementary.h]. */
typedef struct Function {
    const char *name;
    double bound;
    OneArgument one, libm_one;
    TwoArguments two, libm_two;
} Function;

static const Function functions[] = {
    {"exp", 0.508, elementary_exp, exp, NULL, NULL},
    {"log", 0.501, elementary_log, log, NULL, NULL},
    {"pow", 0.518, NULL, NULL, elementary_pow, pow},
    {"exp2", 0.518, elementary_exp2, exp2, NULL, NULL},
    {"log2", 0.501, elementary_log2, log2, NULL, NULL},
    {"log10", 0.501, elementary_log10, log10, NULL, NULL},
    {"log1p", 0.51, elementary_log1p, log1p, NULL, NULL},
    {"expm1", 1.1, elementary_expm1, expm1, NULL, NULL},
    {"cbrt", 0.51, elementary_cbrt, cbrt, NULL, NULL},
    {"hypot", 0.51, NULL, NULL, elementary_hypot, hypot},
    {"sin", 1.1, elementary_sin, sin, NULL, NULL},
    {"cos", 0.65, elementary_cos, cos, NULL, NULL},
    {"tan", 4, elementary_tan, tan, NULL, NULL},
    {"atan2", 2.8, NULL, NULL, elementary_atan2, atan2},
    {"asin", 5.5, elementary_asin, asin, NULL, NULL},
    {"acos", 5.5, elementary_acos, acos, NULL, NULL},
    {"erf", 5, elementary_erf, erf, NULL, NULL},
    {"erfc", 9, elementary_erfc, erfc, NULL, NULL},
};
enum { N_FUNCTIONS = sizeof functions / sizeof *functions };

static double of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Returns the distance from |x| to the next larger double. */
static double last_place(double x)
{
    return nextafter(fabs(x), (double)INFINITY) - fabs(x);
}

static double call(const Function *function, double x, double y)
{
    return function->one ? function->one(x) : function->two(x, y);
}

/* Reads a row of the file of values; returns NULL at its end. */
static const Function *next_value(FILE *file, double *x, double *y, double *nearest, double *above)
{
    char name[16];
    uint64_t bits[3] = {0};
    int hundred_thousandths;
    if (fscanf(file, "%15s", name) != 1)
        return NULL;
    const Function *function = functions;
    while (strcmp(function->name, name) != 0)
        function++;
    for (int i = function->one ? 1 : 0; i < 3; i++)
        assert_int_equal(fscanf(file, "%" SCNx64, &bits[i]), 1);
    assert_int_equal(fscanf(file, "%d", &hundred_thousandths), 1);
    *x = of_bits(bits[function->one ? 1 : 0]);
    *y = of_bits(bits[1]);
    *nearest = of_bits(bits[2]);
    *above = hundred_thousandths / 1e5;
    return function;
}

static void errors_are_within_the_proven_bounds(void **state)
{
    (void)state;
    FILE *file = fopen("tests/elementary/values.txt", "r");
    assert_non_null(file);
    double x, y, nearest, above, worst[N_FUNCTIONS] = {0};
    size_t n = 0;
    for (const Function *function; (function = next_value(file, &x, &y, &nearest, &above)); n++) {
        double result = call(function, x, y);
        if (isinf(nearest) || nearest == 0) {
            assert_true(result == nearest);
            continue;
        }
        double error = fabs((result - nearest) / last_place(nearest) - above);
        if (!(error <= function->bound + 1e-5))
            fail_msg("%s(%a, %a) is %a, %.4f units in the last place off", function->name, x, y,
                     result, error);
        worst[function - functions] = fmax(worst[function - functions], error);
    }
    fclose(file);
    assert_true(n > 2900);
    for (int i = 0; i < N_FUNCTIONS; i++)
        print_message("# %s: %.4f units in the last place at most\n", functions[i].name, worst[i]);
}

/* The C library defines the same values where C11, annex F, does. */
static void special_values_are_those_of_annex_f(void **state)
{
    (void)state;
    const double special[] = {
        0,      0.5,     1,       1 - DBL_EPSILON,  2,          2.5, 3, 0x1p53, 1e17, 1e20, 1e-300,
        5e-324, DBL_MAX, 0x1p-70, (double)INFINITY, (double)NAN};
    enum { N = 2 * sizeof special / sizeof *special };
    for (int f = 0; f < N_FUNCTIONS; f++)
        for (int i = 0; i < N; i++)
            for (int j = 0; j < (functions[f].one ? 1 : N); j++) {
                double x = copysign(special[i / 2], i % 2 ? -1 : 1),
                       y = copysign(special[j / 2], j % 2 ? -1 : 1);
                double result = call(&functions[f], x, y);
                double expected =
                    functions[f].one ? functions[f].libm_one(x) : functions[f].libm_two(x, y);
                bool right = isnan(expected) ? isnan(result)
                             : isinf(expected) || expected == 0
                                 ? result == expected && !signbit(result) == !signbit(expected)
                                 : fabs(result - expected) <= 6 * last_place(expected);
                if (!right)
                    fail_msg("%s(%a, %a) is %a, not %a", functions[f].name, x, y, result, expected);
            }
}

/* Arguments of all sizes and of the usual ones, from the program's own generator. */
static void bits_are_those_recorded(void **state)
{
    (void)state;
    Random random;
    Hash hash;
    random_seed(&random, 1);
    hash_begin(&hash);
    for (int i = 0; i < 20000; i++)
        for (int f = 0; f < N_FUNCTIONS; f++) {
            double x = of_bits(random_bits(&random)), y = 20 * random_uniform(&random) - 10;
            double result = call(&functions[f], i % 2 ? x : fabs(y) / 8, y);
            if (isnan(result))
                result = 0;
            hash_add(&hash, &result, sizeof result);
        }
    assert_string_equal(hash_finish(&hash).hex,
                        "50d0491df62d9ff3b58a56cc39510ca5707cabc2408c5d03d4c7ffb575c64ea5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_within_the_proven_bounds),
        cmocka_unit_test(special_values_are_those_of_annex_f),
        cmocka_unit_test(bits_are_those_recorded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
