/* Makes the summary of a tree and its pairs of terminals as JSON. Other programs read the keys of
 * these objects: keys may be added, but not renamed. */
#include "job/tree/summary_json.h"

#include <stdlib.h>

/* Makes a list of pairs of a radius, mm, and gamma at this radius. */
static json_t *curve_json(const LogCurve *curve)
{
    json_t *pairs = json_array();
    for (size_t k = 0; k < curve->n; k++)
        pairs = json_with_item(pairs, json_pack("[f,f]", curve->argument[k], curve->value[k]));
    return pairs;
}

json_t *summary_json(const TreeSummary *summary)
{
    const Box *box = &summary->bounds;
    const LogCurve *gamma = &summary->gamma;
    json_t *json = JSON_OBJECT(
        {"segments", json_count(summary->segments)}, {"terminals", json_count(summary->terminals)},
        {"bifurcations", json_count(summary->bifurcations)}, {"roots", json_count(summary->roots)},
        {"components", json_count(summary->components)}, {"loops", json_count(summary->loops)},
        {"total_length_mm", json_number(summary->total_length_mm)},
        {"volume_mm3", json_number(summary->volume_mm3)},
        {"target", summary->has.target ? json_number(summary->target) : json_null()},
        {"gamma", gamma->n == 1 ? json_number(gamma->value[0]) : json_null()},
        {"lambda", summary->has.lambda ? json_number(summary->lambda) : json_null()},
        {"root_radius_mm", json_number(summary->root_radius_mm)},
        {"min_radius_mm", json_number(summary->min_radius_mm)},
        {"max_level", json_integer(summary->max_level)},
        {"max_strahler", summary->has.orders ? json_integer(summary->max_strahler) : json_null()},
        {"bbox_mm", json_pack("[[f,f,f],[f,f,f]]", box->low.x, box->low.y, box->low.z, box->high.x,
                              box->high.y, box->high.z)});
    if (gamma->n > 1)
        json = json_with(json, "gamma_by_radius", curve_json(gamma));
    if (summary->has.terminal_pressure)
        json = json_with(json, "terminal_pressure_mmHg",
                         json_pack("{s:f, s:f, s:f}", "min", summary->terminal_pressure_min_mmhg,
                                   "mean", summary->terminal_pressure_mean_mmhg, "max",
                                   summary->terminal_pressure_max_mmhg));
    return json;
}

/* Each pair of terminals is its two ids and their distance, mm. */
json_t *pairs_json(const Tree *tree)
{
    TreePair *pair;
    size_t n;
    if (!tree_column(tree, tree_pairs_name))
        return json_null();
    if (tree_pairs(tree, &pair, &n, NULL) != STATUS_OK)
        return NULL;
    json_t *pairs = json_array();
    for (size_t k = 0; k < n; k++) {
        const int32_t *node = pair[k].node;
        double apart = vec3_distance(tree->position[node[0]], tree->position[node[1]]);
        pairs = json_with_item(pairs,
                               json_pack("[i,i,f]", tree->id[node[0]], tree->id[node[1]], apart));
    }
    free(pair);
    return pairs;
}
