/* A line, or an object, for each number compared. */
#include "job/tree/info_morphometry.h"

#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>

Status morphometry_beside(const TreeStatistics *statistics, const char *name, Morphometry *table,
                          MorphometryComparison *comparison, Err *err)
{
    char *path = NULL;
    TRY(template_file("morphometry", "morphometry", name, ".txt", &path, err));
    Status status = morphometry_read(table, path, err);
    free(path);
    TRY(status);
    return morphometry_compare(statistics, table, comparison, err);
}

static void print_pair(const MorphometryPair *pair)
{
    const char *name = morphometry_names[pair->measure].name;
    if (pair->order > 0)
        printf("  %-27s %5d %9d", name, pair->order, pair->published_order);
    else
        printf("  %-27s %5s %9s", name, "all", "all");
    printf("  %10.4g  %10.4g +- %-9.3g %s\n", pair->value, pair->published.mean, pair->room,
           pair->agrees ? "pass" : "fail");
}

void morphometry_print(const Morphometry *table, const MorphometryComparison *comparison)
{
    printf("\nBeside %s\n", table->source);
    printf(
        "  (+- the published standard deviation or, where there is none, %g %%; lengths in mm)\n",
        100 * MORPHOMETRY_ROOM);
    printf("  %-27s %5s %9s  %10s  %s\n", "of the elements", "order", "published", "this tree",
           "published");
    for (size_t i = 0; i < comparison->n; i++)
        print_pair(&comparison->pair[i]);
    printf("  %zu of %zu pass\n", comparison->agreeing, comparison->n);
}

static json_t *pair_json(const MorphometryPair *pair)
{
    json_t *whole = pair->order > 0 ? json_integer(pair->order) : json_null();
    json_t *other = pair->order > 0 ? json_integer(pair->published_order) : json_null();
    const JsonMember members[] = {
        {"measure", json_text(morphometry_names[pair->measure].name)},
        {"unit", json_text(morphometry_names[pair->measure].unit)},
        {"order", whole},
        {"published_order", other},
        {"value", json_number(pair->value)},
        {"published_mean", json_number(pair->published.mean)},
        {"published_sd", json_number(pair->published.sd)},
        {"room", json_number(pair->room)},
        {"pass", json_boolean(pair->agrees)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}

json_t *morphometry_json(const Morphometry *table, const MorphometryComparison *comparison)
{
    json_t *pairs = json_array();
    for (size_t i = 0; i < comparison->n; i++)
        pairs = json_with_item(pairs, pair_json(&comparison->pair[i]));
    const JsonMember members[] = {
        {"source", json_text(table->source)},
        {"compared", json_count(comparison->n)},
        {"passed", json_count(comparison->agreeing)},
        {"rows", pairs},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}
