/* Measures how many planted faults a comparison rule detects, and how many the published rules of
 * other projects detect. Each case, one fault of one size, is
 * planted in a picture of its own, so threads compute the cases independently. A fault that changes
 * no code, such as a small shift of a flat picture, is not a case that exists, and is not counted.
 */
#include "compare/cause/power.h"

#include "compare/measures/perception.h"
#include "compare/measures/planes.h"
#include "compare/pixels.h"
#include "compare/rules/tolerance.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A rule that a project publishes for its own tests. The rule counts either the pixels that
 * pixelmatch marks, or the pixels whose difference exceeds `levels`. */
typedef struct PublishedRule {
    const char *name;   /* name of the project: "Blender" */
    const char *says;   /* a sentence that states the rule, for JSON */
    double pixelmatch;  /* threshold of pixelmatch, which may mark no pixel; NAN: the members below
                         * define the rule */
    double levels, ppm; /* at most `ppm` parts per million of the pixels may differ by more than
                         * `levels` (of 255) */
    double most_levels; /* no pixel may differ by more than this; INFINITY: no limit */
} PublishedRule;

static const PublishedRule published_rules[PUBLISHED_RULES] = {
    {.name = "pixelmatch",
     .says = "no pixel differs by pixelmatch 7.2.0 at its default threshold, 0.1",
     .pixelmatch = 0.1},
    {.name = "Playwright",
     .says = "no pixel differs by pixelmatch at Playwright's threshold, 0.2",
     .pixelmatch = 0.2},
    {.name = "Blender",
     .says = "1 % of the pixels may differ by more than 0.016 of the range",
     .pixelmatch = (double)NAN,
     .levels = 0.016 * 255,
     .ppm = 10000,
     .most_levels = (double)INFINITY},
    {.name = "OpenImageIO",
     .says = "0.02 % may differ by more than 0.004, none by more than 0.012",
     .pixelmatch = (double)NAN,
     .levels = 0.004 * 255,
     .ppm = 200,
     .most_levels = 0.012 * 255},
    {.name = "reg-suit",
     .says = "no pixel differs by pixelmatch at threshold 0, antialiased pixels included",
     .pixelmatch = (double)NAN,
     .levels = 0.5, /* it rounds 16 bits to 8 */
     .most_levels = (double)INFINITY},
};

/* Sets *differs to true if a published rule reports a difference. */
static Status published_differs(const PublishedRule *rule, const Picture *a, const Picture *b,
                                bool *differs, Err *err)
{
    if (!isnan(rule->pixelmatch)) {
        *differs = pixelmatch_count(a, b, rule->pixelmatch) > 0;
        return STATUS_OK;
    }
    CompareResult result;
    Tolerance tolerance = tolerance_none();
    tolerance.limits[LIMIT_COLOR_LEVELS] = rule->levels;
    const Rendering of_a = {.picture = a}, of_b = {.picture = b};
    TRY(compare_pictures(&of_a, &of_b, &tolerance, &result, NULL, err));
    *differs =
        result.values[MEASURE_BEYOND_PIXELS] > rule->ppm * 1e-6 * result.values[MEASURE_PIXELS] ||
        result.values[MEASURE_MAX_ABS] > rule->most_levels;
    return STATUS_OK;
}

/* ---- cases ----------------------------------------------------------------------------------- */

typedef struct Work {
    const PowerInput *input;
    Power *power;
} Work;

/* Compares a picture with the reference by all rules: found[0] is the verdict of the rule that is
 * measured, the others follow in the order of published_rules. */
static Status apply_rules(const PowerInput *input, const Picture *picture, bool found[POWER_RULES],
                          Err *err)
{
    const Picture *reference = input->reference;
    TRY(input->rule->differs(input->rule->context, reference, picture, &found[0], err));
    for (int i = 0; i < PUBLISHED_RULES; i++)
        TRY(published_differs(&published_rules[i], reference, picture, &found[1 + i], err));
    return STATUS_OK;
}

static bool same_codes(const Picture *a, const Picture *b)
{
    for (int y = 0; y < a->height; y++)
        if (!picture_rows_equal(a, b, y, 0, a->width))
            return false;
    return true;
}

/* Plants a fault in a copy of the picture, and applies all rules to it. A fault that changes no
 * code does not exist. */
static Status measure_case(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    const Work *work = context;
    const PowerInput *input = work->input;
    PowerCase *one = &work->power->cases[index];
    Picture planted;
    Status status = STATUS_OK;
    TRY(picture_fault_plant(one->fault, one->size, input->drawn, &planted, err));
    one->exists = !same_codes(input->drawn, &planted);
    if (one->exists)
        TRY_GOTO(apply_rules(input, &planted, one->found, err));
    if (one->exists && !one->found[0] && input->keep)
        status = input->keep(input->keep_context, one, &planted, err);
done:
    picture_release(&planted);
    return status;
}

Status powercases_list(PowerCase **cases, size_t *n, Err *err)
{
    *n = 0;
    TRY(mem_calloc(cases, n_picture_faults * FAULT_SIZES, sizeof **cases, "faults", err));
    for (size_t i = 0; i < n_picture_faults; i++) {
        const PictureFault *fault = &picture_faults[i];
        int k = 0;
        do
            (*cases)[(*n)++] = (PowerCase){.fault = fault, .size = fault->sizes[k]};
        while (fault->unit && ++k < FAULT_SIZES && fault->sizes[k] > 0);
    }
    return STATUS_OK;
}

static void count(Power *power)
{
    for (size_t i = 0; i < power->n; i++) {
        power->planted += power->cases[i].exists;
        for (int rule = 0; rule < POWER_RULES; rule++)
            power->missed[rule] += power->cases[i].exists && !power->cases[i].found[rule];
    }
}

Status power_measure(const PowerInput *input, int threads, Power *power, Err *err)
{
    const Picture *reference = input->reference, *drawn = input->drawn;
    Power made = {.name = input->rule->name,
                  .width = drawn->width,
                  .height = drawn->height,
                  .bits = drawn->bits};
    Work work = {input, &made};
    Status status = STATUS_OK;
    if (!pictures_have_same_form(reference, drawn))
        return err_set(err, STATUS_INPUT,
                       "the two drawings differ in format: %d x %d pixels of %d x %d bits, and %d "
                       "x %d pixels of %d x %d bits",
                       reference->width, reference->height, reference->channels, reference->bits,
                       drawn->width, drawn->height, drawn->channels, drawn->bits);
    TRY(powercases_list(&made.cases, &made.n, err));
    made.repeats = same_codes(reference, drawn);
    TRY_GOTO(apply_rules(input, drawn, made.alarm, err));
    TRY_GOTO(threads_try(made.n, threads, measure_case, &work, err));
    count(&made);
    *power = made;
    made.cases = NULL;
done:
    free(made.cases);
    return status;
}

void power_release(Power *power)
{
    free(power->cases);
    *power = (Power){0};
}

/* ---- output ---------------------------------------------------------------------------------- */

static const char *rule_name(const Power *power, int rule)
{
    return rule ? published_rules[rule - 1].name : power->name;
}

/* Returns the end of the cases of one fault, which are adjacent. */
static size_t end_of(const Power *power, size_t first)
{
    size_t end = first;
    while (end < power->n && power->cases[end].fault == power->cases[first].fault)
        end++;
    return end;
}

/* Appends the cell of power_text for a rule and a fault: the smallest size from which on the rule
 * finds the fault at every larger size. */
static void put_found(const Power *power, size_t first, size_t end, int rule, Text *out)
{
    char cell[32] = "-";
    bool all = true;
    for (size_t i = end; i-- > first && all;) {
        const PowerCase *one = &power->cases[i];
        all = !one->exists || one->found[rule];
        if (!one->exists)
            continue;
        if (!all && strcmp(cell, "-") == 0)
            snprintf(cell, sizeof cell, "%s", one->fault->unit ? "never" : "missed");
        else if (all && one->fault->unit)
            snprintf(cell, sizeof cell, "%g", one->size);
        else if (all)
            snprintf(cell, sizeof cell, "found");
    }
    text_printf(out, " %12s", cell);
}

static void put_fault(const Power *power, size_t first, size_t end, Text *out)
{
    const PictureFault *fault = power->cases[first].fault;
    char name[64];
    if (fault->unit)
        snprintf(name, sizeof name, "%s by %g to %g %s", fault->name, fault->sizes[0],
                 power->cases[end - 1].size, fault->unit);
    else
        snprintf(name, sizeof name, "%s", fault->name);
    text_printf(out, "%-42s", name);
    for (int rule = 0; rule < POWER_RULES; rule++)
        put_found(power, first, end, rule, out);
    text_puts(out, "\n");
}

static void put_sum(const Power *power, Text *out)
{
    text_printf(out, "%-42s", "faults missed, of all planted");
    for (int rule = 0; rule < POWER_RULES; rule++)
        text_printf(out, " %5zu of %3zu", power->missed[rule], power->planted);
    text_puts(out, "\n");
    for (int rule = 0; rule < POWER_RULES; rule++)
        if (power->alarm[rule])
            text_printf(
                out,
                "false alarm: %s reports a difference between two drawings of the same scene\n",
                rule_name(power, rule));
}

void power_text(const Power *power, Text *out)
{
    text_printf(out, "%d x %d pixels of %d bits; two drawings are %s\n", power->width,
                power->height, power->bits, power->repeats ? "identical" : "different");
    text_printf(out, "%-42s", "fault; smallest size found by");
    for (int rule = 0; rule < POWER_RULES; rule++)
        text_printf(out, " %12.12s", rule_name(power, rule));
    text_puts(out, "\n");
    for (size_t first = 0; first < power->n; first = end_of(power, first))
        put_fault(power, first, end_of(power, first), out);
    put_sum(power, out);
}

static json_t *case_json(const PowerCase *one)
{
    json_t *found = json_object();
    for (int rule = 0; rule < POWER_RULES; rule++)
        found = json_with(found, rule ? published_rules[rule - 1].name : "rule",
                          json_boolean(one->found[rule]));
    return JSON_OBJECT({"fault", json_text(one->fault->name)},
                       {"size", one->fault->unit ? json_number(one->size) : json_null()},
                       {"unit", json_text_or_null(one->fault->unit)}, {"found", found});
}

json_t *power_json(const Power *power)
{
    json_t *rules = json_array(), *cases = json_array();
    for (int rule = 0; rule < POWER_RULES; rule++)
        rules = json_with_item(
            rules,
            JSON_OBJECT({"name", json_text(rule_name(power, rule))},
                        {"says", json_text_or_null(rule ? published_rules[rule - 1].says : NULL)},
                        {"missed", json_count(power->missed[rule])},
                        {"false_alarm", json_boolean(power->alarm[rule])}));
    for (size_t i = 0; i < power->n; i++)
        if (power->cases[i].exists)
            cases = json_with_item(cases, case_json(&power->cases[i]));
    return JSON_OBJECT(
        {"width", json_integer(power->width)}, {"height", json_integer(power->height)},
        {"bits", json_integer(power->bits)}, {"repeats", json_boolean(power->repeats)},
        {"planted", json_count(power->planted)}, {"rules", rules}, {"faults", cases});
}
