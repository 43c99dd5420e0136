/* The keys of compare --json. Every kind of plane has all of them, null where a number has no
 * meaning or could not be measured, and its own beside them. */
#include "verify/report.h"

#include <math.h>

/* Whole numbers as integers, what is not finite as null. */
static json_t *number(double value)
{
    if (!isfinite(value))
        return json_null();
    if (value == floor(value) && fabs(value) < 1e15)
        return json_integer((json_int_t)value);
    return json_real(value);
}

static json_t *count(const CompareResult *result, size_t value)
{
    return result->has_mask ? json_integer((json_int_t)value) : json_null();
}

static json_t *place_json(const CompareResult *result, const PixelPlace *place)
{
    if (place->x < 0)
        return json_null();
    if (!result->has_ids)
        return json_pack("{s:i, s:i}", "x", place->x, "y", place->y);
    return json_pack("{s:i, s:i, s:I, s:I}", "x", place->x, "y", place->y, "id_a",
                     (json_int_t)place->id_a, "id_b", (json_int_t)place->id_b);
}

static json_t *rules_json(const CompareResult *result)
{
    json_t *rules = json_array();
    for (int i = 0; i < result->n_rules; i++) {
        const Rule *rule = &result->rules[i];
        json_array_append_new(rules,
                              json_pack("{s:s, s:s, s:o, s:o, s:b}", "name", rule->name, "unit",
                                        rule->unit, "measured", number(rule->measured), "allowed",
                                        number(rule->allowed), "met", (int)rule->met));
    }
    return rules;
}

static json_t *classes_json(const CompareResult *result)
{
    json_t *classes = json_object();
    for (PixelClass i = 0; i < PIXEL_CLASSES; i++)
        json_object_set_new(classes, pixel_class_name(i),
                            i <= PIXEL_EDGE ? count(result, result->classes[i])
                                            : json_integer((json_int_t)result->classes[i]));
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
        json_array_append_new(segments, segment_json(&result->worst_segments[i]));
    return segments;
}

static void set_color_keys(json_t *json, const CompareResult *result)
{
    const struct {
        const char *key;
        json_t *value;
    } members[] = {
        {"classes", classes_json(result)},
        {"bias_levels", number(result->bias_levels)},
        {"sign_sigma", number(result->sign_sigma)},
        {"silhouette_px", number(result->silhouette_px)},
        {"gain", number(result->gain)},
        {"offset_levels", number(result->offset_levels)},
        {"segments", result->has_ids ? number((double)result->segments) : json_null()},
        {"segments_missing",
         result->has_ids ? number((double)result->segments_missing) : json_null()},
        {"segment_levels", number(result->segment_levels)},
        {"segment_px", number(result->segment_px)},
        {"worst_segments", worst_segments_json(result)},
        {"flip_max", number(result->flip_max)},
        {"hdr_flip_mean", number(result->hdr_flip_mean)},
        {"de2000_mean", number(result->de2000_mean)},
        {"de2000_max", number(result->de2000_max)},
        {"pixelmatch_pixels", number(result->pixelmatch_pixels)},
    };
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        json_object_set_new(json, members[i].key, members[i].value);
}

static void set_kind_keys(json_t *json, const CompareResult *result)
{
    switch (result->kind) {
    case PLANE_COLOR:
        set_color_keys(json, result);
        break;
    case PLANE_DEPTH:
        json_object_set_new(json, "median_abs_mm", number(result->median));
        json_object_set_new(json, "p99_abs_mm", number(result->p99));
        json_object_set_new(json, "max_abs_mm", number(result->max));
        break;
    case PLANE_NORMAL:
        json_object_set_new(json, "median_deg", number(result->median));
        json_object_set_new(json, "p99_deg", number(result->p99));
        json_object_set_new(json, "max_deg", number(result->max));
        break;
    case PLANE_ID:
        json_object_set_new(json, "mismatches", number((double)result->differing_pixels));
        json_object_set_new(json, "mismatch_fraction",
                            number((double)result->differing_pixels / (double)result->pixels));
        json_object_set_new(json, "classes", classes_json(result));
        break;
    case PLANE_KINDS:
        break;
    }
}

json_t *compare_json(const CompareResult *result)
{
    const struct {
        const char *key;
        json_t *value;
    } members[] = {
        {"verdict", json_string(result->agrees ? "agree" : "differ")},
        {"reason", *result->reason ? json_string(result->reason) : json_null()},
        {"cause", *result->cause ? json_string(result->cause) : json_null()},
        {"tier", json_string(result->tolerance.tier)},
        {"pixels", number((double)result->pixels)},
        {"width", number(result->width)},
        {"height", number(result->height)},
        {"bits", number(result->bits)},
        {"differing_pixels", number((double)result->differing_pixels)},
        {"missing_pixels", count(result, result->missing_pixels)},
        {"extra_pixels", count(result, result->extra_pixels)},
        {"common_pixels", count(result, result->common_pixels)},
        {"largest_region", count(result, result->largest_region)},
        {"nan_pixels", number((double)(result->nan_pixels_a + result->nan_pixels_b))},
        {"max_abs", number(result->max_abs)},
        {"max_code", number(result->max_code)},
        {"mean_abs", number(result->mean_abs)},
        {"rmse", number(result->rmse)},
        {"psnr_db", number(result->psnr_db)},
        {"flip_mean", number(result->flip_mean)},
        {"ssim", number(result->ssim)},
        {"interior_max_abs", number(result->interior_max_abs)},
        {"edge_mismatch_fraction", number(result->edge_mismatch_fraction)},
        {"worst", place_json(result, &result->worst)},
        {"rules", rules_json(result)},
    };
    json_t *json = json_object();
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        json_object_set_new(json, members[i].key, members[i].value);
    set_kind_keys(json, result);
    return json;
}
