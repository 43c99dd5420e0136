/* Converts the results of a report to a list of checks. Each kind of check lists its rules and
 * measures once, here; text, JUnit XML and page only print the lists. A measure that is NAN has no
 * meaning for the images compared, and is left out. */
#include "compare/report/check.h"

#include "compare/measure.h"
#include <assert.h>
#include <math.h>
#include <stdio.h>

static void add(Check *check, const char *table, const char *name, double value, const char *unit)
{
    if (isnan(value))
        return;
    assert(check->n_measures < CHECK_MEASURES_MAX);
    check->measures[check->n_measures++] =
        (CheckMeasure){.table = table, .name = name, .value = value, .unit = unit};
}

static void add_classes(Check *check, const char *table, const CompareResult *plane)
{
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        if (plane->classes[i])
            add(check, table, i == PIXEL_WRONG_SEGMENT ? "wrong segment" : pixel_class_name(i),
                (double)plane->classes[i], "");
}

/* Adds the measures of one table, under `heading`, in the order of their ranks. */
static void add_table(Check *check, const char *heading, MeasureTable table,
                      const CompareResult *plane)
{
    enum { RANKS = 3 }; /* the ranks in the table of measures are 0, 1 and 2 */
    for (int rank = 0; rank < RANKS; rank++)
        for (size_t i = 0; i < n_measures; i++) {
            const Measure *row = &measures[i];
            if (row->table != table || row->rank != rank || !measure_is_for(row, plane))
                continue;
            if (row->part == PART_CLASSES)
                add_classes(check, heading, plane);
            else
                add(check, heading, row->label, plane->values[row->id], row->unit);
        }
}

static Check start_plane(const CompareResult *plane)
{
    Check check = {.title = result_title(plane),
                   .agrees = plane->agrees,
                   .reason = plane->reason,
                   .n_rules = plane->n_rules};
    for (int i = 0; i < plane->n_rules; i++)
        check.rules[i] = plane->rules[i];
    return check;
}

Check check_plane(const CompareResult *plane)
{
    Check check = start_plane(plane);
    for (MeasureTable table = TABLE_NONE + 1; table < MEASURE_TABLES; table++)
        add_table(&check, measure_heading(plane->kind, table), table, plane);
    return check;
}

/* The check of a second pair of pictures: its rules, and the sizes of its differences. */
static Check check_pictures(const CompareResult *pictures, const char *heading)
{
    Check check = start_plane(pictures);
    add_table(&check, heading, TABLE_SIZES, pictures);
    add_table(&check, heading, TABLE_SIGNS, pictures);
    return check;
}

/* Adds a rule about a number of pixels. */
static void add_pixel_rule(Check *check, const char *name, size_t measured, size_t allowed)
{
    Rule *rule = &check->rules[check->n_rules++];
    *rule = (Rule){.unit = "pixels",
                   .measured = (double)measured,
                   .allowed = (double)allowed,
                   .met = measured <= allowed,
                   .at = {.x = -1, .y = -1}};
    snprintf(rule->name, sizeof rule->name, "%s", name);
}

static Check check_surface(const SurfaceCheck *surface)
{
    const char *table = "Surface found by POV-Ray";
    Check check = {.title = "surface", .agrees = surface->agrees, .reason = surface->reason};
    add_pixel_rule(&check, "missing or extra pixels, except at grazing rays",
                   surface->missing + surface->extra, 0);
    add_pixel_rule(&check, "pixels farther from the surface than the accuracy allows",
                   surface->beyond, 0);
    add(&check, table, "pixels judged", (double)surface->common, "");
    add(&check, table, "grazing pixels", (double)surface->grazing, "");
    add(&check, table, "median distance from the surface", surface->median_mm, "mm");
    add(&check, table, "99th percentile", surface->p99_mm, "mm");
    add(&check, table, "largest distance", surface->max_mm, "mm");
    add(&check, table, "largest distance / allowed distance", surface->max_ratio, "");
    return check;
}

Check check_settled(const Settled *settled)
{
    Check check = {.title = "settled",
                   .agrees = settled->agrees,
                   .reason = settled->reason,
                   .settled = settled};
    for (SettledCause cause = settled->from; cause <= settled->to; cause++)
        add_pixel_rule(&check, settled_cause_sentence(cause), settled->count[cause],
                       settled_allowed(settled, cause));
    return check;
}

/* Makes the check of two of the three programs of a witness: all rules of their ids and depths. */
static Check check_pair(const Witness *witness, WitnessPair pair)
{
    const CompareResult *planes[] = {witness->pairs[pair].ids, witness->pairs[pair].depth};
    Check check = {.title = witness->pairs[pair].title,
                   .agrees = witness->pairs[pair].agrees,
                   .reason = witness->sentence};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < planes[i]->n_rules; k++)
            check.rules[check.n_rules++] = planes[i]->rules[k];
    add(&check, check.title, "pixels with different ids",
        planes[0]->values[MEASURE_DIFFERING_PIXELS], "");
    add(&check, check.title, "largest difference of depths", planes[1]->values[MEASURE_MAX], "mm");
    add_table(&check, check.title, TABLE_OUTLINES, planes[1]);
    return check;
}

int report_checks(const ReportCase *report, Check checks[CHECKS_MAX])
{
    int n = 0;
    for (PlaneKind kind = 0; kind < PLANE_KINDS; kind++)
        if (report->planes[kind])
            checks[n++] = check_plane(report->planes[kind]);
    if (report->alpha)
        checks[n++] = check_pictures(report->alpha, "Alpha");
    if (report->settled)
        checks[n++] = check_settled(report->settled);
    if (report->exact)
        checks[n++] = check_pictures(report->exact, "Colors on the exact surface");
    if (report->surface)
        checks[n++] = check_surface(report->surface);
    for (int pair = 0; report->witness && pair < WITNESS_PAIRS; pair++)
        checks[n++] = check_pair(report->witness, (WitnessPair)pair);
    return n;
}

const char *report_reason(const ReportCase *report)
{
    Check checks[CHECKS_MAX];
    int n = report_checks(report, checks);
    for (int i = 0; i < n; i++)
        if (!checks[i].agrees)
            return checks[i].reason;
    return NULL;
}

bool report_agrees(const ReportCase *report)
{
    return report_reason(report) == NULL;
}

double report_severity(const ReportCase *report)
{
    Check checks[CHECKS_MAX];
    int n = report_checks(report, checks);
    double worst = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < checks[i].n_rules; k++) {
            const Rule *rule = &checks[i].rules[k];
            double ratio = rule->allowed > 0 ? rule->measured / rule->allowed : rule->measured;
            /* A broken rule has a severity of at least 1. JSON has no infinity, hence the maximum.
             */
            if (!rule->met)
                worst = fmax(worst, fmin(fmax(ratio, 1), 1e12));
        }
    return worst;
}
