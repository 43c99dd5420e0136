/* Writes certificates as JSON. The scene is written first, then the pixels one by one, so that
 * memory holds one pixel as JSON. */
#include "answer/certificate.h"

void certificate_begin(const AnswerPlan *plan, Text *out)
{
    text_printf(out, "{\"pattern\":%d,\"scene\":", plan->params.pattern);
    text_json(out, answer_scene_json(plan->scene, plan->params.shadows), 0);
    text_puts(out, ",\"pixels\":[");
}

static json_t *polygon_json(const LeafPolygon *polygon)
{
    json_t *corners = json_array();
    for (int i = 0; i < polygon->n; i++)
        corners = json_with_item(corners,
                                 json_numbers((const double[]){polygon->x[i], polygon->y[i]}, 2));
    return corners;
}

void certificate_add_form(json_t **parts, const LeafPolygon *polygon, const FormColor *color,
                          double weight)
{
    if (!parts)
        return;
    json_t *forms = json_array();
    for (int c = 0; c < 3; c++) {
        const Form f = color->channels[c];
        forms = json_with_item(forms, json_numbers((const double[]){f.c, f.x, f.y, f.e}, 4));
    }
    *parts =
        json_with_item(*parts, JSON_OBJECT({"weight", json_number(weight)},
                                           {"polygon", polygon_json(polygon)}, {"form", forms}));
}

void certificate_add_interval(json_t **parts, double area, const ColorInterval *interval)
{
    if (parts)
        *parts = json_with_item(*parts, JSON_OBJECT({"area", json_number(area)},
                                                    {"low", json_numbers(interval->low, 3)},
                                                    {"high", json_numbers(interval->high, 3)}));
}

static json_t *leaf_json(AnswerWorkspace *work, int i, int j, AreaLeaf *leaf)
{
    const LeafPolygon polygon = arealeaf_polygon(leaf);
    const double at[] = {i + 0.5 + leaf->x, j + 0.5 + leaf->y};
    json_t *parts = json_array();
    work->record = &parts;
    arealeaf_measure(work, i, j, leaf);
    work->record = NULL;
    return JSON_OBJECT({"at", json_numbers(at, 2)}, {"along", json_numbers(leaf->along, 2)},
                       {"across", json_numbers(leaf->across, 2)},
                       {"polygon", polygon_json(&polygon)}, {"parts", parts},
                       {"low", json_numbers(leaf->low, 3)}, {"high", json_numbers(leaf->high, 3)});
}

void certificate_put_pixel(AnswerWorkspace *work, int i, int j, const ColorInterval *interval,
                           bool is_first, Text *out)
{
    json_t *leaves = json_array();
    for (size_t k = 0; k < work->heap.n && work->plan->params.pattern == 0; k++)
        leaves = json_with_item(
            leaves, leaf_json(work, i, j, &work->leaves.items[work->heap.items[k].value]));
    text_puts(out, is_first ? "\n" : ",\n");
    text_json(out,
              JSON_OBJECT({"pixel", json_pack("[i, i]", i, j)},
                          {"low", json_numbers(interval->low, 3)},
                          {"high", json_numbers(interval->high, 3)}, {"leaves", leaves}),
              0);
}
