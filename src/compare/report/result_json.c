/* The keys of compare --json. Every kind of plane has all of them, null where a number has no
 * meaning or could not be measured, and its own beside them. */
#include "compare/report/report.h"

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
    return result->has_mask ? json_count(value) : json_null();
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
        rules = json_with_item(rules,
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
        classes = json_with(classes, pixel_class_name(i),
                            i <= PIXEL_EDGE ? count(result, result->classes[i])
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

static json_t *with_color_keys(json_t *json, const CompareResult *result)
{
    const JsonMember members[] = {
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
    return json_with_members(json, members, sizeof members / sizeof *members);
}

static json_t *with_distances(json_t *json, const CompareResult *result, const char *median,
                              const char *p99, const char *max)
{
    const JsonMember members[] = {
        {median, number(result->median)}, {p99, number(result->p99)}, {max, number(result->max)}};
    return json_with_members(json, members, sizeof members / sizeof *members);
}

static json_t *with_id_keys(json_t *json, const CompareResult *result)
{
    double mismatches = (double)result->differing_pixels;
    const JsonMember members[] = {
        {"mismatches", number(mismatches)},
        {"mismatch_fraction", number(mismatches / (double)result->pixels)},
        {"classes", classes_json(result)}};
    return json_with_members(json, members, sizeof members / sizeof *members);
}

/* The keys that only this kind of plane has. */
static json_t *with_kind_keys(json_t *json, const CompareResult *result)
{
    switch (result->kind) {
    case PLANE_COLOR:
        return with_color_keys(json, result);
    case PLANE_DEPTH:
        json = with_distances(json, result, "median_abs_mm", "p99_abs_mm", "max_abs_mm");
        return json_with(json, "p99_part", number(result->p99_part));
    case PLANE_NORMAL:
        return with_distances(json, result, "median_deg", "p99_deg", "max_deg");
    case PLANE_ID:
        return with_id_keys(json, result);
    case PLANE_KINDS:
        break;
    }
    return json;
}

json_t *compare_json(const CompareResult *result)
{
    const JsonMember members[] = {
        {"verdict", json_text(result->agrees ? "agree" : "differ")},
        {"reason", json_text_or_null(*result->reason ? result->reason : NULL)},
        {"cause", json_text_or_null(*result->cause ? result->cause : NULL)},
        {"tier", json_text(result->tolerance.tier)},
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
    json_t *json = json_with_members(json_object(), members, sizeof members / sizeof *members);
    return with_kind_keys(json, result);
}
