/* Makes the report of `info` as JSON. Other programs read the keys: keys may be added, but not
 * renamed. */
#include "job/tree/info.h"
#include "job/tree/summary_json.h"

/* ---- reading --------------------------------------------------------------------------------- */

static json_t *roots_json(const TreeReading *reading)
{
    json_t *rows_json = json_array();
    for (size_t i = 0; i < reading->n_roots; i++)
        rows_json = json_with_item(rows_json,
                                   json_pack("{s:i, s:s, s:I}", "id", reading->root[i].id, "reason",
                                             root_reason_texts[reading->root[i].reason], "nodes",
                                             (json_int_t)reading->root[i].nodes));
    return rows_json;
}

/* The lines of a network that were cut to open loops. */
static json_t *cuts_json(const NetworkReading *network)
{
    json_t *rows_json = json_array();
    for (size_t i = 0; i < network->n_cuts; i++) {
        const ReadCut *cut = &network->cut[i];
        rows_json = json_with_item(
            rows_json, json_pack("{s:I, s:[f,f,f], s:o}", "record", (json_int_t)cut->record,
                                 "position_mm", cut->position.x, cut->position.y, cut->position.z,
                                 "radius_mm", json_number(cut->radius_mm)));
    }
    return rows_json;
}

static json_t *degrees_json(const TreeReading *reading)
{
    json_t *list = json_array();
    for (int degree = 0; degree <= READ_MAX_DEGREE; degree++)
        list = json_with_item(list, json_count(reading->degree[degree]));
    return list;
}

static json_t *repaired_json(const TreeReading *reading)
{
    json_t *list = json_array();
    for (size_t i = 0; reading->repaired && i < reading->repaired_radii; i++)
        list = json_with_item(list, json_integer(reading->repaired[i]));
    return list;
}

static json_t *notes_json(const TreeReading *reading)
{
    json_t *list = json_array();
    for (size_t i = 0; i < reading->n_notes; i++)
        list = json_with_item(list, json_text(reading->note[i]));
    return list;
}

static json_t *network_json(const NetworkReading *network)
{
    return JSON_OBJECT(
        {"points", json_count(network->points)}, {"lines", json_count(network->lines)},
        {"lines_against", json_count(network->against)},
        {"merged_points", json_count(network->merged)},
        {"unused_points", json_count(network->unused)},
        {"lines_without_length", json_count(network->without_length)},
        {"repeated_lines", json_count(network->repeated)},
        {"loops", json_count(network->loops + network->links)}, {"cuts", cuts_json(network)});
}

static json_t *reading_json(const TreeReading *reading)
{
    return JSON_OBJECT(
        {"format", json_text(reading->format)},
        {"network", reading->is_network ? network_json(&reading->network) : json_null()},
        {"components", json_count(reading->n_roots)}, {"roots", roots_json(reading)},
        {"degrees", degrees_json(reading)},
        {"median_radius_mm", json_number(reading->median_radius_mm)},
        {"segments_without_radius", json_count(reading->without_radius)},
        {"given_radii", json_count(reading->given_radius)},
        {"repaired_radii", json_count(reading->repaired_radii)},
        {"repaired_ids", repaired_json(reading)},
        {"near_ends", json_count(reading->network.near_ends)},
        {"near_ends_mm", json_number(reading->network.near_mm)},
        {"unit", json_text(length_unit_names[reading->unit])},
        {"unit_said", json_boolean(reading->unit_is_stated)},
        {"believed_unit", reading->has_plausible_unit
                              ? json_text(length_unit_names[reading->plausible_unit])
                              : json_null()},
        {"looks_like_voxels", json_boolean(reading->looks_like_voxels)},
        {"assumed", notes_json(reading)});
}

/* ---- statistics ------------------------------------------------------------------------------ */

static json_t *spread_json(const Spread *spread)
{
    return json_pack("{s:o, s:o}", "mean", json_number(spread->mean), "sd",
                     json_number(spread->sd));
}

/* Makes a table by level or by order. `number` is the key of row->number. */
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

/* The matrix of the mean numbers of daughters, by order of the parent and of the daughter. */
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

static json_t *statistics_json(const TreeStatistics *statistics)
{
    const bool orders = statistics->has_orders;
    const OrderRatios none = {NAN, NAN, NAN};
    size_t branch_points = 0;
    for (int k = 3; k <= READ_MAX_DEGREE; k++)
        branch_points += statistics->nodes_of_degree[k];
    return JSON_OBJECT(
        {"vessels", json_count(statistics->vessels)},
        {"volume_mm3", json_number(statistics->volume_mm3)},
        {"by_level", table_json("level", &statistics->by_level)},
        {"by_strahler", table_json("order", &statistics->by_strahler)},
        {"strahler_ratios", ratios_json(orders ? &statistics->strahler_ratios : &none)},
        {"by_diameter_strahler", table_json("order", &statistics->by_diameter_strahler)},
        {"diameter_strahler_ratios",
         ratios_json(orders ? &statistics->diameter_strahler_ratios : &none)},
        {"connectivity", connectivity_json(statistics)},
        {"diameter_rounds", json_integer(statistics->diameter_rounds)},
        {"diameter_orders_converged", json_boolean(statistics->diameter_orders_converged)},
        {"symmetry", orders ? bifurcations_json(&statistics->symmetry) : json_null()},
        {"area_ratio", orders ? bifurcations_json(&statistics->area_ratio) : json_null()},
        {"branch_points", json_count(branch_points)});
}

/* ---- morphometry ----------------------------------------------------------------------------- */

/* A value of the tree beside the published one. Order 0 is a value of the whole tree. */
static json_t *pair_json(const MorphometryPair *pair)
{
    json_t *whole = pair->order > 0 ? json_integer(pair->order) : json_null();
    json_t *other = pair->order > 0 ? json_integer(pair->published_order) : json_null();
    return JSON_OBJECT({"measure", json_text(morphometry_names[pair->measure].name)},
                       {"unit", json_text(morphometry_names[pair->measure].unit)}, {"order", whole},
                       {"published_order", other}, {"value", json_number(pair->value)},
                       {"published_mean", json_number(pair->published.mean)},
                       {"published_sd", json_number(pair->published.sd)},
                       {"published_se", json_number(pair->se)},
                       {"room", json_number(pair->tolerance)}, {"pass", json_boolean(pair->agrees)},
                       {"pass_strict", json_boolean(pair->agrees_strictly)});
}

/* Adds the counts of a comparison to an object. */
static json_t *with_counts(json_t *object, const MorphometryComparison *comparison)
{
    return JSON_WITH(object, {"compared", json_count(comparison->n)},
                     {"passed", json_count(comparison->agreeing)},
                     {"passed_strict", json_count(comparison->agreeing_strictly)});
}

static json_t *morphometry_json(const InfoReport *report)
{
    const MorphometryComparison *chosen = &report->comparison[report->orders];
    json_t *pairs = json_array(), *counts = json_object();
    for (size_t i = 0; i < chosen->n; i++)
        pairs = json_with_item(pairs, pair_json(&chosen->pair[i]));
    for (int k = 0; k < MORPHOMETRY_ORDERS; k++)
        counts = json_with(counts, morphometry_orders_names[k],
                           with_counts(json_object(), &report->comparison[k]));
    json_t *json = JSON_OBJECT({"source", json_text(report->table.source)},
                               {"orders", json_text(morphometry_orders_names[report->orders])});
    return JSON_WITH(with_counts(json, chosen), {"counts", counts}, {"rows", pairs});
}

/* ---- the whole ------------------------------------------------------------------------------- */

static json_t *columns_json(const Tree *tree)
{
    json_t *rows = json_array();
    for (size_t k = 0; k < tree->n_columns; k++) {
        json_t *row = json_with(json_object(), "name", json_text(tree->column[k].name));
        rows = json_with_item(rows, json_with(row, "unit", json_text(tree->column[k].unit)));
    }
    return rows;
}

json_t *inforeport_json(const InfoReport *report)
{
    const Tree *tree = &report->tree;
    json_t *json = summary_json(&report->summary);
    if (tree_column(tree, tree_pairs_name))
        json = json_with(json, "terminal_pairs", pairs_json(tree));
    if (tree->n_columns > 0)
        json = json_with(json, "columns", columns_json(tree));
    if (report->has_statistics)
        json = json_with(json, "stats", statistics_json(&report->statistics));
    if (report->has_morphometry)
        json = json_with(json, "morphometry", morphometry_json(report));
    json = json_with(json, "reading", reading_json(&report->reading));
    return report->bound ? json_with(json, "bound", json_incref(report->bound)) : json;
}
