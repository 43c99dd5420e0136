/* Writes the checks of a scene as JSON: surface, settled pixels and witness. */
#include "compare/report/check.h"
#include "compare/report/page.h"

json_t *surface_check_json(const SurfaceCheck *check)
{
    return json_pack(
        "{s:s, s:s?, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o}", "verdict",
        check->agrees ? "agree" : "differ", "reason", check->reason[0] ? check->reason : NULL,
        "pixels", (json_int_t)check->pixels, "common_pixels", (json_int_t)check->common,
        "grazing_pixels", (json_int_t)check->grazing, "missing_pixels", (json_int_t)check->missing,
        "extra_pixels", (json_int_t)check->extra, "beyond_pixels", (json_int_t)check->beyond,
        "median_abs_mm", json_number(check->median_mm), "p99_abs_mm", json_number(check->p99_mm),
        "max_abs_mm", json_number(check->max_mm), "max_ratio", json_number(check->max_ratio));
}

static json_t *pixels_json(const Settled *settled)
{
    json_t *pixels = json_array();
    for (int i = 0; i < settled->n_first; i++) {
        const SettledPixel *pixel = &settled->first[i];
        pixels = json_with_item(
            pixels,
            json_pack("{s:i, s:i, s:s, s:I, s:o, s:o, s:o, s:o, s:o}", "x", pixel->x, "y", pixel->y,
                      "cause", settled_cause_name(pixel->cause), "segment", (json_int_t)pixel->id,
                      "depth_a_mm", json_number(pixel->a_mm), "depth_b_mm",
                      json_number(pixel->b_mm), "root_mm", json_number(pixel->root_mm),
                      "blocked_mm", json_number(pixel->distance_mm), "cosine",
                      json_number(pixel->cosine)));
    }
    return pixels;
}

json_t *settled_json(const Settled *settled)
{
    const Check check = check_settled(settled);
    return json_pack("{s:s, s:s?, s:I, s:I, s:o, s:o}", "verdict",
                     settled->agrees ? "agree" : "differ", "reason",
                     settled->reason[0] ? settled->reason : NULL, "asked_pixels",
                     (json_int_t)settled->examined, "unexplained_pixels",
                     (json_int_t)(settled->count[SETTLED_NOT] + settled->unexamined), "rules",
                     rules_json(check.rules, check.n_rules), "pixels", pixels_json(settled));
}

json_t *witness_json(const Witness *witness)
{
    json_t *pairs = json_object();
    for (int pair = 0; pair < WITNESS_PAIRS; pair++)
        pairs = json_with(pairs, witness->pairs[pair].title,
                          json_pack("{s:o, s:o, s:o}", "verdict",
                                    json_text(witness->pairs[pair].agrees ? "agree" : "differ"),
                                    "id", compare_json(witness->pairs[pair].ids), "depth",
                                    compare_json(witness->pairs[pair].depth)));
    return JSON_OBJECT({"verdict", json_text(witness->agrees ? "agree" : "differ")},
                       {"sentence", json_text(witness->sentence)},
                       {"name", json_text(witness->name)}, {"version", json_text(witness->version)},
                       {"seconds", json_number(witness->seconds)}, {"pairs", pairs});
}
