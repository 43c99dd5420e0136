/* Writes comparisons, reports and suites as JUnit XML for build servers, which read every dialect
 * of it that keeps to testsuite, testcase, properties and failure. A comparison has a test case for
 * each rule, a report has one for each check with its rules as properties, a suite one for each
 * case. */
#include "compare/report/check.h"
#include "compare/report/page.h"
#include "compare/rules/judge.h"
#include "compare/suite/suite.h"

#include <math.h>
#include <stdio.h>

static void put_attribute(Text *out, const char *name, const char *value)
{
    text_printf(out, " %s=\"", name);
    text_escaped(out, value);
    text_puts(out, "\"");
}

static void put_property(Text *out, const char *name, const char *value)
{
    text_puts(out, "        <property");
    put_attribute(out, "name", name);
    put_attribute(out, "value", value);
    text_puts(out, "/>\n");
}

static void put_number(Text *out, const char *name, double value)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.9g", value);
    put_property(out, name, digits);
}

static void put_seconds(Text *out, double seconds)
{
    if (!isnan(seconds))
        text_printf(out, " time=\"%.6f\"", seconds);
}

static void begin_suite(Text *out, const char *name, int tests, int failures, double seconds)
{
    text_puts(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite");
    put_attribute(out, "name", name);
    text_printf(out, " tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\"", tests, failures);
    put_seconds(out, seconds);
    text_puts(out, ">\n");
}

static void end_suite(Text *out)
{
    text_puts(out, "  </testsuite>\n</testsuites>\n");
}

static void begin_case(Text *out, const char *class_name, const char *name, double seconds)
{
    text_puts(out, "    <testcase");
    put_attribute(out, "classname", class_name);
    put_attribute(out, "name", name);
    put_seconds(out, seconds);
    text_puts(out, ">\n      <properties>\n");
}

/* `failure` is a sentence, or NULL for a case that passed. */
static void end_case(Text *out, const char *failure)
{
    text_puts(out, "      </properties>\n");
    if (failure) {
        text_puts(out, "      <failure");
        put_attribute(out, "message", failure);
        text_puts(out, "/>\n");
    }
    text_puts(out, "    </testcase>\n");
}

void compare_junit(const CompareResult *result, const char *name, double seconds, Text *out)
{
    char sentence[sizeof result->reason];
    Text class_name = TEXT_INIT;
    int failures = 0;
    for (int i = 0; i < result->n_rules; i++)
        failures += !result->rules[i].met;
    text_printf(&class_name, "%s.%s", name, plane_kind_name(result->kind));
    begin_suite(out, name, result->n_rules, failures, seconds);
    for (int i = 0; i < result->n_rules; i++) {
        const Rule *rule = &result->rules[i];
        begin_case(out, text_chars(&class_name), rule->name, seconds / result->n_rules);
        put_property(out, "tier", result->tolerance.tier);
        put_number(out, "measured", rule->measured);
        put_number(out, "allowed", rule->allowed);
        put_property(out, "unit", rule->unit);
        rule_sentence(result, rule, sentence, sizeof sentence);
        end_case(out, rule->met ? NULL : sentence);
    }
    end_suite(out);
    text_release(&class_name);
}

static void put_check(Text *out, const ReportCase *report, const Check *check)
{
    Text value = TEXT_INIT;
    begin_case(out, report->model, check->title, (double)NAN);
    for (int i = 0; i < check->n_rules; i++) {
        const Rule *rule = &check->rules[i];
        text_clear(&value);
        text_printf(&value, "%.6g %s (at most %.6g)", rule->measured, rule->unit, rule->allowed);
        put_property(out, rule->name, text_chars(&value));
    }
    for (int i = 0; check->settled && i < check->settled->n_first; i++) {
        const SettledPixel *pixel = &check->settled->first[i];
        text_clear(&value);
        settled_describe(pixel, report->a.name, report->b.name, &value);
        put_property(out, settled_cause_name(pixel->cause), text_chars(&value));
    }
    end_case(out, check->agrees ? NULL : check->reason);
    text_release(&value);
}

void report_junit(const ReportCase *report, Text *out)
{
    Check checks[CHECKS_MAX];
    int tests = report_checks(report, checks), failures = 0;
    for (int i = 0; i < tests; i++)
        failures += !checks[i].agrees;
    begin_suite(out, report->name, tests, failures, (double)NAN);
    for (int i = 0; i < tests; i++)
        put_check(out, report, &checks[i]);
    end_suite(out);
}

void suite_junit(const Suite *suite, const char *name, double seconds, Text *out)
{
    size_t passed = suite->count[SUITE_SAME] + suite->count[SUITE_WITHIN];
    begin_suite(out, name, (int)suite->n, (int)(suite->n - passed), seconds);
    for (size_t i = 0; i < suite->n; i++) {
        const SuiteCase *entry = &suite->cases[i];
        begin_case(out, name, entry->name, entry->seconds);
        put_property(out, "state", suite_state_name(entry->state));
        put_number(out, "differing pixels", (double)entry->differing);
        put_number(out, "masked pixels", (double)entry->masked);
        end_case(out, *entry->sentence ? entry->sentence : NULL);
    }
    end_suite(out);
}
