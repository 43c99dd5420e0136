/* Writes the JSON of `compare --json`. Its keys are those of the table of measures. A number that
 * is not defined or was not measured is null. */
#include "compare/measure.h"
#include "compare/report/page.h"

#include <math.h>

/* Returns an integer for an integral value, and null for one that is not finite. */
static json_t *number(double value)
{
    if (!isfinite(value))
        return json_null();
    if (value == floor(value) && fabs(value) < 1e15)
        return json_integer((json_int_t)value);
    return json_real(value);
}

static json_t *worst_json(const CompareResult *result)
{
    const PixelPlace *place = &result->places[PLACE_WORST];
    if (place->x < 0)
        return json_null();
    if (!result->has_ids)
        return json_pack("{s:i, s:i}", "x", place->x, "y", place->y);
    return json_pack("{s:i, s:i, s:I, s:I}", "x", place->x, "y", place->y, "id_a",
                     (json_int_t)place->id_a, "id_b", (json_int_t)place->id_b);
}

json_t *rules_json(const Rule *rules, int n)
{
    json_t *json = json_array();
    for (const Rule *rule = rules; rule < rules + n; rule++)
        json = json_with_item(json,
                              json_pack("{s:s, s:s, s:o, s:o, s:b}", "name", rule->name, "unit",
                                        rule->unit, "measured", number(rule->measured), "allowed",
                                        number(rule->allowed), "met", (int)rule->met));
    return json;
}

static json_t *classes_json(const CompareResult *result)
{
    json_t *classes = json_object();
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        classes = json_with(classes, pixel_class_name(i),
                            i <= PIXEL_EDGE && !result->has_mask ? json_null()
                                                                 : json_count(result->classes[i]));
    return classes;
}

static json_t *segment_json(const LedgerEntry *entry)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:[i, i, i, i]}", "id",
                     (json_int_t)entry->id, "area_a", (json_int_t)entry->area_a, "area_b",
                     (json_int_t)entry->area_b, "differing", (json_int_t)entry->differing,
                     "signed_levels", number(ledger_entry_levels(entry)), "moved_px",
                     number(entry->moved_px), "gain", number(entry->gain), "box", entry->left,
                     entry->top, entry->right, entry->bottom);
}

json_t *worst_segments_json(const CompareResult *result)
{
    json_t *segments = json_array();
    for (int i = 0; i < result->n_worst_segments; i++)
        segments = json_with_item(segments, segment_json(&result->worst_segments[i]));
    return segments;
}

static json_t *value_json(const CompareResult *result, const Measure *measure)
{
    switch (measure->part) {
    case PART_WORST:
        return worst_json(result);
    case PART_RULES:
        return rules_json(result->rules, result->n_rules);
    case PART_CLASSES:
        return classes_json(result);
    case PART_SEGMENTS:
        return worst_segments_json(result);
    case PART_NUMBER:
        break;
    }
    return number(result->values[measure->id]);
}

json_t *compare_json(const CompareResult *result)
{
    const PixelRect *box = &result->box;
    json_t *json =
        JSON_OBJECT({"verdict", json_text(result->agrees ? "agree" : "differ")},
                    {"reason", json_text_or_null(*result->reason ? result->reason : NULL)},
                    {"cause", json_text_or_null(*result->cause ? result->cause : NULL)},
                    {"box", box->width > 0 ? json_pack("[i, i, i, i]", box->left, box->top,
                                                       box->width, box->height)
                                           : json_null()},
                    {"tier", json_text(result->tolerance.tier)});
    for (size_t i = 0; i < n_measures; i++)
        if (measures[i].key && measure_is_for(&measures[i], result))
            json = json_with(json, measures[i].key, value_json(result, &measures[i]));
    return json;
}
