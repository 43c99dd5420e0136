/* Prints the report of `info` as text. */
#include "cli/commands.h"
#include "job/tree/info.h"
#include "options/output.h"
#include <stdio.h>
#include <stdlib.h>

/* Prints a number in readable form, right-aligned in a column of `width` characters, or
 * left-aligned if the width is negative. */
static void print_number(int width, double value, int digits)
{
    char text[READABLE_SIZE];
    int blanks = abs(width);
    for (const char *at = number_readable(value, digits, text); *at; at++)
        blanks -= (*at & 0xC0) != 0x80; /* the first byte of a character */
    blanks = blanks > 0 ? blanks : 0;
    printf("%*s%s%*s", width > 0 ? blanks : 0, "", text, width < 0 ? blanks : 0, "");
}

/* Prints a mean and its standard deviation in 22 columns. */
static void print_mean(double mean, double deviation)
{
    print_number(10, mean, 4);
    printf(" ± ");
    print_number(-9, deviation, 3);
}

/* Prints `before` and a unit in readable form. */
static Status print_unit(const char *before, const char *unit, Err *err)
{
    Text text = TEXT_INIT;
    text_unit(&text, unit);
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        printf("%s%s", before, text_chars(&text));
    text_release(&text);
    return status;
}

/* ---- summary --------------------------------------------------------------------------------- */

static void print_gamma(const LogCurve *gamma)
{
    if (gamma->n == 1)
        printf("  gamma         %g\n", gamma->value[0]);
    for (size_t k = 0; gamma->n > 1 && k < gamma->n; k++)
        printf("  %-13s %g at a parent radius of %g mm\n", k == 0 ? "gamma" : "", gamma->value[k],
               gamma->argument[k]);
}

static void print_summary(const char *path, const TreeSummary *summary)
{
    const Box *box = &summary->bounds;
    printf("%s\n", path);
    printf("  segments      %zu (%zu terminal%s, %zu bifurcation%s, %zu root%s)\n",
           summary->segments, summary->terminals, summary->terminals == 1 ? "" : "s",
           summary->bifurcations, summary->bifurcations == 1 ? "" : "s", summary->roots,
           summary->roots == 1 ? "" : "s");
    printf("  total length  %s mm\n", READABLE(summary->total_length_mm, 6));
    printf("  volume        %s mm³\n", READABLE(summary->volume_mm3, 6));
    if (summary->has.target)
        printf("  target        %s (sum of length × radius^%g)\n", READABLE(summary->target, 6),
               summary->lambda);
    print_gamma(&summary->gamma);
    printf("  radius        %s mm at the root", READABLE(summary->root_radius_mm, 6));
    if (summary->segments > 0)
        printf(", %s mm at the thinnest", READABLE(summary->min_radius_mm, 6));
    printf("\n");
    if (summary->has.orders)
        printf("  orders        maximum bifurcation level %d, maximum Strahler order %d\n",
               summary->max_level, summary->max_strahler);
    else
        printf("  loops         %zu; maximum bifurcation level %d; loops have no Strahler orders\n",
               summary->loops, summary->max_level);
    if (summary->has.terminal_pressure)
        printf("  terminals at  %.9g to %.9g mmHg\n", summary->terminal_pressure_min_mmhg,
               summary->terminal_pressure_max_mmhg);
    printf("  extent        x %s to %s, y %s to %s, z %s to %s mm\n", READABLE(box->low.x, 4),
           READABLE(box->high.x, 4), READABLE(box->low.y, 4), READABLE(box->high.y, 4),
           READABLE(box->low.z, 4), READABLE(box->high.z, 4));
}

/* Prints column `k`. If the column belongs to a series, prints the series once, such as "pressure
 * (mmHg): 24 frames, 0 to 0.8", and sets *printed of all its columns. */
static Status print_column(const Tree *tree, size_t k, bool *printed, Err *err)
{
    const TreeColumn *column = &tree->column[k];
    size_t length = 0;
    double time;
    char *name = NULL;
    Series series = {0};
    if (series_parse(column->name, &length, &time)) {
        TRY(mem_strdup(&name, column->name, err));
        name[length] = '\0';
        Status status = tree_series(tree, name, &series, NULL);
        free(name);
        if (status == STATUS_MEMORY)
            return err_set(err, status, "out of memory: no room for a series");
    }
    printf("%.*s", series.n ? (int)(length < 40 ? length : 40) : 40, column->name);
    if (*column->unit) {
        TRY(print_unit(" (", column->unit, err));
        printf(")");
    }
    if (series.n)
        printf(": %zu frames, %g to %g", series.n, series.frame[0].time,
               series.frame[series.n - 1].time);
    for (size_t i = 0; i < series.n; i++)
        printed[series.frame[i].column] = true;
    series_release(&series);
    return STATUS_OK;
}

static Status print_columns(const Tree *tree, Err *err)
{
    bool *printed = NULL;
    Status status = mem_calloc(&printed, tree->n_columns, sizeof *printed, "columns", err);
    for (size_t k = 0; k < tree->n_columns && status == STATUS_OK; k++) {
        if (printed[k])
            continue;
        printf("%s", k ? ", " : "  columns       ");
        status = print_column(tree, k, printed, err);
    }
    if (tree->n_columns > 0)
        printf("\n");
    free(printed);
    return status;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Returns the ending of the word behind a count. */
static const char *ending(size_t count)
{
    return count == 1 ? "" : "s";
}

/* Prints which points and lines of a network did not become part of the tree. */
static void print_left_out(const NetworkReading *network)
{
    const struct {
        size_t count;
        const char *one, *more;
    } rows[] = {
        {network->merged, "point merged into another", "points merged into others"},
        {network->unused, "point that no line uses", "points that no line uses"},
        {network->without_length, "line without length", "lines without length"},
        {network->repeated, "repeated line", "repeated lines"},
        {network->loops, "line cut where a loop closed", "lines cut where loops closed"},
    };
    const char *title = "left out     ";
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].count == 0)
            continue;
        printf("  %s %zu %s\n", title, rows[i].count,
               rows[i].count == 1 ? rows[i].one : rows[i].more);
        title = "             ";
    }
}

static void print_network(const TreeReading *reading)
{
    printf("  read as       %s, %zu point%s and %zu line%s\n", reading->format,
           reading->network.points, ending(reading->network.points), reading->network.lines,
           ending(reading->network.lines));
    print_left_out(&reading->network);
    for (size_t i = 0; i < reading->network.n_cuts && i < 3; i++)
        printf("  cut at        %g, %g, %g mm, radius %g mm\n", reading->network.cut[i].position.x,
               reading->network.cut[i].position.y, reading->network.cut[i].position.z,
               reading->network.cut[i].radius_mm);
    if (reading->network.n_cuts > 3)
        printf("                and %zu more place%s\n", reading->network.loops - 3,
               ending(reading->network.loops - 3));
    if (reading->network.against > 0)
        printf("  directions    %zu line%s towards the root in the file\n",
               reading->network.against, reading->network.against == 1 ? " points" : "s point");
}

static void print_roots(const TreeReading *reading, size_t components)
{
    enum { SHOWN = 5 }; /* roots with a line of their own; --json lists all */
    printf("  components    %zu\n", components);
    for (size_t i = 0; i < reading->n_roots && i < SHOWN; i++)
        printf("  root          %d, %s; %zu node%s\n", reading->root[i].id,
               root_reason_texts[reading->root[i].reason], reading->root[i].nodes,
               ending(reading->root[i].nodes));
    if (reading->n_roots > SHOWN)
        printf("                and %zu more\n", reading->n_roots - SHOWN);
}

static void print_degrees(const TreeReading *reading)
{
    const char *before = "  degrees       ";
    for (int degree = 0; degree <= READ_MAX_DEGREE; degree++)
        if (reading->degree[degree] > 0) {
            printf("%s%d%s: %zu", before, degree, degree == READ_MAX_DEGREE ? "+" : "",
                   reading->degree[degree]);
            before = ", ";
        }
    printf("\n");
}

static Status print_read_unit(const TreeReading *reading, Err *err)
{
    if (reading->median_radius_mm > 0)
        printf("  median radius %s mm\n", READABLE(reading->median_radius_mm, 6));
    TRY(print_unit("  unit          ", length_unit_names[reading->unit], err));
    printf(", %s", reading->unit_is_stated ? "stated" : "assumed");
    if (reading->median_radius_mm > 0 && reading->has_plausible_unit)
        TRY(print_unit("; radii suggest ", length_unit_names[reading->plausible_unit], err));
    else if (reading->median_radius_mm > 0)
        printf("; radii are not plausible for vessels in any unit");
    printf("%s\n", reading->looks_like_voxels ? "; coordinates suggest voxels" : "");
    if (reading->without_radius > 0)
        printf("  no radius     %zu segment%s\n", reading->without_radius,
               ending(reading->without_radius));
    return STATUS_OK;
}

static Status print_reading(const TreeReading *reading, size_t components, Err *err)
{
    if (reading->is_network)
        print_network(reading);
    print_roots(reading, components);
    print_degrees(reading);
    TRY(print_read_unit(reading, err));
    for (size_t i = 0; i < reading->n_notes; i++)
        printf("  %s %s\n", i ? "             " : "assumed      ", reading->note[i]);
    return STATUS_OK;
}

/* ---- statistics ------------------------------------------------------------------------------ */

static void print_table(const char *title, const char *number, const StatisticsTable *table)
{
    printf("\n%s\n  %5s %9s %9s  %-22s %-22s\n", title, number, "vessels", "elements", "radius, mm",
           "length, mm");
    for (size_t i = 0; i < table->n; i++) {
        const StatisticsRow *row = &table->row[i];
        printf("  %5d %9zu %9zu  ", row->number, row->vessels, row->elements);
        print_mean(row->radius_mm.mean, row->radius_mm.sd);
        printf(" ");
        print_mean(row->length_mm.mean, row->length_mm.sd);
        printf("\n");
    }
}

static void print_ratios(const OrderRatios *ratios)
{
    printf("  ratios from order to order: number ÷ %.3f, diameter × %.3f, length × %.3f\n",
           ratios->number, ratios->diameter, ratios->length);
}

static void print_connectivity(const TreeStatistics *statistics)
{
    size_t n = statistics->by_diameter_strahler.n;
    printf("\nMean number of daughter elements of each order (columns) per element of each order "
           "(rows),\n"
           "by diameter-defined Strahler order\n  order");
    for (size_t k = 0; k < n; k++)
        printf(" %8zu", k + 1);
    for (size_t i = 0; i < n; i++) {
        printf("\n  %5zu", i + 1);
        for (size_t k = 0; k <= i; k++)
            printf(" %8.3f", statistics->daughters[i * n + k]);
    }
    printf("\n");
}

static void print_spread(const char *title, const BifurcationSpread *spread)
{
    printf("  %-33s %.3f ± %.3f, median %.3f (%zu)\n", title, spread->mean, spread->sd,
           spread->median, spread->count);
}

static void print_orders(const TreeStatistics *statistics)
{
    print_table("By Strahler order (of the elements)", "order", &statistics->by_strahler);
    print_ratios(&statistics->strahler_ratios);
    print_table("By diameter-defined Strahler order (of the elements)", "order",
                &statistics->by_diameter_strahler);
    print_ratios(&statistics->diameter_strahler_ratios);
    print_connectivity(statistics);
    if (!statistics->diameter_orders_converged)
        printf("  the diameter-defined orders have not converged after %d iterations\n",
               statistics->diameter_rounds);
    printf("\nBifurcations (mean ± standard deviation)\n");
    print_spread("symmetry, r_thinnest / r_thickest", &statistics->symmetry);
    print_spread("area ratio, sum of r² / r_parent²", &statistics->area_ratio);
}

static void print_statistics(const TreeStatistics *statistics)
{
    print_table("By bifurcation level (mean ± standard deviation of the vessels)", "level",
                &statistics->by_level);
    if (statistics->has_orders)
        print_orders(statistics);
    printf("  total volume %s mm³ in %zu vessels\n", READABLE(statistics->volume_mm3, 6),
           statistics->vessels);
}

/* ---- morphometry ----------------------------------------------------------------------------- */

static void print_pair(const MorphometryPair *pair)
{
    const char *name = morphometry_names[pair->measure].name;
    if (pair->order > 0)
        printf("  %-27s %5d %9d", name, pair->order, pair->published_order);
    else
        printf("  %-27s %5s %9s", name, "all", "all");
    printf("  ");
    print_number(10, pair->value, 4);
    printf("  ");
    print_mean(pair->published.mean, pair->tolerance);
    printf(" %s\n", pair->agrees_strictly ? "pass" : pair->agrees ? "pass by 2 SE" : "fail");
}

static void print_morphometry(const InfoReport *report)
{
    const MorphometryComparison *comparison = &report->comparison[report->orders];
    printf("\nCompared with %s, by %s orders\n", report->table.source,
           morphometry_orders_names[report->orders]);
    printf("  (± the published standard deviation or, without one, the larger of %g %% and %d "
           "published\n"
           "  standard errors (SE); lengths in mm)\n",
           100 * MORPHOMETRY_TOLERANCE, MORPHOMETRY_STANDARD_ERRORS);
    printf("  %-27s %5s %9s  %10s  %s\n", "of the elements", "order", "published", "this tree",
           "published");
    for (size_t i = 0; i < comparison->n; i++)
        print_pair(&comparison->pair[i]);
    for (int k = 0; k < MORPHOMETRY_ORDERS; k++)
        printf("  by %s orders: %zu of %zu pass (%zu without standard errors)\n",
               morphometry_orders_names[k], report->comparison[k].agreeing, report->comparison[k].n,
               report->comparison[k].agreeing_strictly);
}

/* ---- the command ----------------------------------------------------------------------------- */

static Status print(const InfoReport *report, Err *err)
{
    print_summary(report->name, &report->summary);
    TRY(print_columns(&report->tree, err));
    TRY(print_reading(&report->reading, report->summary.components, err));
    if (report->has_statistics)
        print_statistics(&report->statistics);
    if (report->has_morphometry)
        print_morphometry(report);
    return STATUS_OK;
}

Status run_info(void *options, Parsed *parsed, Err *err)
{
    InfoReport report;
    Status status = STATUS_OK;
    TRY_GOTO(info_make(options, parsed, &report, err));
    status = options_specified(parsed, "json") ? json_write(inforeport_json(&report), "-", err)
                                               : print(&report, err);
done:
    inforeport_release(&report);
    return status;
}
