/* Judges the measures of a comparison by the limits of its tolerance. The rules of a result are the
 * rows of the table of measures that have a limit, in the order of the limits. The first broken one
 * gives the reason. */
#include "compare/rules/judge.h"

#include "compare/measure.h"
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double ppm(double count, double of)
{
    return of > 0 ? 1e6 * count / of : 0;
}

/* Returns a limit. Tolerance.spare_levels may raise it so that a single pixel passes. */
static double allowed_of(const CompareResult *result, Limit limit)
{
    const Tolerance *tolerance = &result->tolerance;
    const double allowed = tolerance->limits[limit], *values = result->values;
    bool spares = limit == LIMIT_COLOR_PPM && values[MEASURE_BEYOND_PIXELS] <= 1 &&
                  values[MEASURE_JUDGED_PIXELS] >= SPARE_OF &&
                  values[MEASURE_UNSETTLED_MAX_ABS] <= tolerance->spare_levels;
    return spares ? fmax(allowed, ppm(1, values[MEASURE_JUDGED_PIXELS])) : allowed;
}

/* "pixels off by more than 2 levels" */
static void name_rule(const CompareResult *result, const MeasureRule *row, Rule *rule)
{
    double threshold = result->tolerance.limits[row->threshold];
    if (row->threshold == LIMIT_COLOR_LEVELS && result->values[MEASURE_BITS] == 8)
        threshold = floor(threshold);
    if (row->threshold)
        snprintf(rule->name, sizeof rule->name, "%s %.*g%s", row->name, row->digits, threshold,
                 row->threshold_unit);
    else
        snprintf(rule->name, sizeof rule->name, "%s", row->name);
}

/* Adds the rule that judges a measure to the result, unless the tolerance has no limit for it. */
static void add_rule(CompareResult *result, const Measure *measure)
{
    static const char *const units[PLANE_KINDS] = {
        [PLANE_COLOR] = "levels", [PLANE_DEPTH] = "mm", [PLANE_NORMAL] = "deg"};
    const MeasureRule *row = &measure->rule;
    const double *values = result->values, value = fabs(values[measure->id]);
    double allowed = allowed_of(result, row->limit);
    if (isinf(allowed) || isnan(value))
        return;
    assert(result->n_rules < RULES_MAX);
    Rule *rule = &result->rules[result->n_rules++];
    *rule = (Rule){.unit = row->unit,
                   .measured = row->ppm_of ? ppm(value, values[row->ppm_of]) : value,
                   .allowed = allowed,
                   .of = row->ppm_of ? values[row->ppm_of] : 0,
                   .at = result->places[row->at]};
    rule->met = !(rule->measured > allowed);
    name_rule(result, row, rule);
    if (row->at_what)
        snprintf(rule->at_what, sizeof rule->at_what, "%s", row->at_what);
    else
        snprintf(rule->at_what, sizeof rule->at_what, "the worst, %.4g %s, is",
                 values[result->kind == PLANE_COLOR ? MEASURE_MAX_ABS : MEASURE_MAX],
                 units[result->kind]);
}

/* "segment 17" or "nothing" */
static const char *describe_id(uint32_t id, char out[24])
{
    if (id)
        snprintf(out, 24, "segment %u", id);
    else
        snprintf(out, 24, "nothing");
    return out;
}

/* "at (312, 140), segment 17 in A and nothing in B" */
static void describe_place(const CompareResult *result, const PixelPlace *place, char *out,
                           size_t size)
{
    char a[24], b[24];
    describe_id(place->id_a, a);
    describe_id(place->id_b, b);
    if (!result->has_ids)
        snprintf(out, size, "at (%d, %d)", place->x, place->y);
    else if (place->id_a != place->id_b)
        snprintf(out, size, "at (%d, %d), %s in A and %s in B", place->x, place->y, a, b);
    else
        snprintf(out, size, "at (%d, %d), %s", place->x, place->y, place->id_a ? a : "background");
}

/* Writes a number with three digits, or with six if three do not distinguish it from the limit. */
static void describe_measured(double value, double allowed, char out[32])
{
    bool whole = (value == floor(value) || fabs(value) >= 1000) && fabs(value) < 1e15;
    snprintf(out, 32, whole ? "%.0f" : "%.3g", value);
    if (strtod(out, NULL) <= allowed * (1 + 1e-12)) /* `allowed` may be a rounded quotient */
        snprintf(out, 32, "%.6g", value);
}

/* "21.3 % of the pixels are off by more than 0 levels (allowed: 0.0002 %, no pixel at this size)"
 */
static int describe_fraction(const Rule *rule, char *out, size_t size)
{
    static const char *const verbs[][2] = {
        {"off", "are off"},
        {"with ", "have "},
        {"seen ", "are seen "},
        {"that pixelmatch reports ", "are reported by pixelmatch "}};
    char measured[32];
    const char *rest = strstr(rule->name, "pixels ") + strlen("pixels "), *verb = "";
    const int subject = (int)(rest - rule->name) - 1;
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs && !*verb; i++)
        if (strncmp(rest, verbs[i][0], strlen(verbs[i][0])) == 0) {
            rest += strlen(verbs[i][0]);
            verb = verbs[i][1];
        }
    describe_measured(rule->measured / 1e4, rule->allowed / 1e4, measured);
    return snprintf(out, size, "%s %% of the %.*s %s%s (allowed: %.6g %%%s)", measured, subject,
                    rule->name, verb, rest, rule->allowed / 1e4,
                    rule->allowed > 0 && rule->of > 0 && rule->allowed * rule->of < 1e6
                        ? ", no pixel at this size"
                        : "");
}

void rule_sentence(const CompareResult *result, const Rule *rule, char *out, size_t size)
{
    char place[120], measured[32];
    const bool is_plain = result->kind == PLANE_COLOR && !result->tolerance.title;
    int length = is_plain ? 0 : snprintf(out, size, "%s: ", result_title(result));
    if (strcmp(rule->unit, "ppm") == 0) {
        length += describe_fraction(rule, out + length, size - (size_t)length);
    } else {
        describe_measured(rule->measured, rule->allowed, measured);
        length += snprintf(out + length, size - (size_t)length, "%s: %s%s%s (allowed: %.6g)",
                           rule->name, measured, *rule->unit ? " " : "", rule->unit, rule->allowed);
    }
    if (rule->at.x < 0)
        return;
    describe_place(result, &rule->at, place, sizeof place);
    snprintf(out + length, size - (size_t)length, "; %s %s", rule->at_what, place);
}

/* Adds the rules of a limit, in the order of the measures. */
static void add_rules(CompareResult *result, Limit limit)
{
    for (size_t i = 0; i < n_measures; i++)
        if (measures[i].rule.limit == limit && measure_is_for(&measures[i], result))
            add_rule(result, &measures[i]);
}

static void judge(CompareResult *result)
{
    add_rules(result, LIMIT_NAN);
    const int n_of_nan = result->n_rules;
    for (Limit limit = LIMIT_NAN + 1; limit < LIMITS; limit++)
        add_rules(result, limit);
    /* A file such as `color_levels = 2` alone would let any picture pass. */
    result->agrees = !result->tolerance.is_from_file || result->n_rules > n_of_nan ||
                     result->values[MEASURE_DIFFERING_PIXELS] == 0;
    if (!result->agrees)
        snprintf(result->reason, sizeof result->reason,
                 "the tolerance file sets no limit that applies to these two images");
    for (int i = 0; i < result->n_rules && result->agrees; i++) {
        if (result->rules[i].met)
            continue;
        result->agrees = false;
        rule_sentence(result, &result->rules[i], result->reason, sizeof result->reason);
    }
}

void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b)
{
    static const PlaceId found[] = {PLACE_WORST, PLACE_REGION, PLACE_NAN};
    for (size_t i = 0; a && i < sizeof found / sizeof *found; i++) {
        PixelPlace *place = &result->places[found[i]];
        if (place->x < 0)
            continue;
        size_t pixel = (size_t)place->y * (size_t)a->width + (size_t)place->x;
        place->id_a = a->ids[pixel];
        place->id_b = b->ids[pixel];
    }
    judge(result);
}
