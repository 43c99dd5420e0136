/* The tables of --stats: one function writes them as text, one as JSON. */
#include "job/tree/info_statistics.h"

#include <stdio.h>

static void print_table(const char *title, const char *number, const StatisticsTable *table)
{
    printf("\n%s\n  %5s %9s %9s  %-23s %-23s\n", title, number, "vessels", "elements", "radius, mm",
           "length, mm");
    for (size_t i = 0; i < table->n; i++) {
        const StatisticsRow *row = &table->row[i];
        printf("  %5d %9zu %9zu  %10.4g +- %-9.3g %10.4g +- %-9.3g\n", row->number, row->vessels,
               row->elements, row->radius_mm.mean, row->radius_mm.sd, row->length_mm.mean,
               row->length_mm.sd);
    }
}

static void print_ratios(const OrderRatios *ratios)
{
    printf("  from order to order: number / %.3f, diameter * %.3f, length * %.3f\n", ratios->number,
           ratios->diameter, ratios->length);
}

static void print_connectivity(const TreeStatistics *statistics)
{
    size_t n = statistics->by_diameter_strahler.n;
    printf("\nElements that spring from an element of each diameter-defined order\n  order");
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
    printf("  %-33s %.3f +- %.3f, median %.3f (%zu)\n", title, spread->mean, spread->sd,
           spread->median, spread->count);
}

void statistics_print(const TreeStatistics *statistics)
{
    print_table("By bifurcation level (mean +- standard deviation of the vessels)", "level",
                &statistics->by_level);
    print_table("By Strahler order (of the elements)", "order", &statistics->by_strahler);
    print_ratios(&statistics->strahler_ratios);
    print_table("By diameter-defined Strahler order (of the elements)", "order",
                &statistics->by_diameter_strahler);
    print_ratios(&statistics->diameter_strahler_ratios);
    print_connectivity(statistics);
    if (!statistics->diameter_orders_converged)
        printf("  the orders still changed after %d rounds\n", statistics->diameter_rounds);
    printf("\nBifurcations (mean +- standard deviation)\n");
    print_spread("symmetry, r_thinnest / r_thickest", &statistics->symmetry);
    print_spread("area ratio, sum of r^2 / r_parent^2", &statistics->area_ratio);
    printf("  total volume %.6g mm^3 in %zu vessels\n", statistics->volume_mm3,
           statistics->vessels);
}

static json_t *spread_json(const Spread *spread)
{
    return json_pack("{s:o, s:o}", "mean", json_number(spread->mean), "sd",
                     json_number(spread->sd));
}

/* `number` is the key of row->number. */
static json_t *table_json(const char *number, const StatisticsTable *table)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < table->n; i++) {
        const StatisticsRow *row = &table->row[i];
        rows = json_with_item(rows, json_pack("{s:i, s:I, s:I, s:o, s:o}", number, row->number,
                                              "vessels", (json_int_t)row->vessels, "elements",
                                              (json_int_t)row->elements, "radius_mm",
                                              spread_json(&row->radius_mm), "length_mm",
                                              spread_json(&row->length_mm)));
    }
    return rows;
}

static json_t *ratios_json(const OrderRatios *ratios)
{
    return json_pack("{s:o, s:o, s:o}", "number", json_number(ratios->number), "diameter",
                     json_number(ratios->diameter), "length", json_number(ratios->length));
}

static json_t *bifurcations_json(const BifurcationSpread *spread)
{
    return json_pack("{s:I, s:o, s:o, s:o}", "count", (json_int_t)spread->count, "mean",
                     json_number(spread->mean), "sd", json_number(spread->sd), "median",
                     json_number(spread->median));
}

static json_t *connectivity_json(const TreeStatistics *statistics)
{
    size_t n = statistics->by_diameter_strahler.n;
    json_t *rows = json_array();
    for (size_t i = 0; i < n; i++) {
        json_t *row = json_array();
        for (size_t k = 0; k < n; k++)
            row = json_with_item(row, json_number(statistics->daughters[i * n + k]));
        rows = json_with_item(rows, row);
    }
    return rows;
}

json_t *statistics_json(const TreeStatistics *statistics)
{
    const JsonMember members[] = {
        {"vessels", json_count(statistics->vessels)},
        {"volume_mm3", json_number(statistics->volume_mm3)},
        {"by_level", table_json("level", &statistics->by_level)},
        {"by_strahler", table_json("order", &statistics->by_strahler)},
        {"strahler_ratios", ratios_json(&statistics->strahler_ratios)},
        {"by_diameter_strahler", table_json("order", &statistics->by_diameter_strahler)},
        {"diameter_strahler_ratios", ratios_json(&statistics->diameter_strahler_ratios)},
        {"connectivity", connectivity_json(statistics)},
        {"diameter_rounds", json_integer(statistics->diameter_rounds)},
        {"diameter_orders_converged", json_boolean(statistics->diameter_orders_converged)},
        {"symmetry", bifurcations_json(&statistics->symmetry)},
        {"area_ratio", bifurcations_json(&statistics->area_ratio)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}
