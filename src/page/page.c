/* Writes the HTML page with the interactive viewer of a tree. The template is filled with three
 * parts: the properties of the tree as JSON; its numbers as blocks of base64, which are a fifth of
 * their size as JSON and faster to read; and the text of the viewer. In the JSON every '<' is
 * escaped, so that no name of a file or column can end the script element. */
#include "page/page.h"

#include "page/blocks.h"
#include "tmpl/tmpl.h"
#include <stdlib.h>

static json_t *vector_json(Vec3 v)
{
    return json_pack("[o,o,o]", json_number(v.x), json_number(v.y), json_number(v.z));
}

static json_t *color_json(Rgb color)
{
    return vector_json(vec3((double)color.r, (double)color.g, (double)color.b));
}

static json_t *lights_json(const Look *look)
{
    json_t *lights = json_array();
    for (int i = 0; i < look->n_lights; i++) {
        const LookLight *light = &look->lights[i];
        lights = json_with_item(lights, JSON_OBJECT({"point", json_boolean(light->is_point)},
                                                    {"direction", vector_json(light->direction)},
                                                    {"color", color_json(light->color)}));
    }
    return lights;
}

static json_t *look_json(const PageParams *params)
{
    const Look *look = params->look;
    const Finish *finish = &look->finish;
    return JSON_OBJECT(
        {"name", json_text(params->look_name)}, {"isChosen", json_boolean(params->is_look_chosen)},
        {"color", color_json(look->color)}, {"ambient", json_number((double)finish->ambient)},
        {"diffuse", json_number((double)finish->diffuse)},
        {"brilliance", json_number((double)finish->brilliance)},
        {"phong", json_number((double)finish->phong)},
        {"phongSize", json_number((double)finish->phong_size)},
        {"specular", json_number((double)finish->specular)},
        {"roughness", json_number((double)finish->roughness)}, {"lights", lights_json(look)});
}

static json_t *fields_json(const PageParams *params)
{
    json_t *fields = json_array();
    for (size_t i = 0; i < params->n_fields; i++) {
        const FieldSeries *series = &params->fields[i];
        json_t *times = json_array();
        for (size_t k = 0; series->time && k < series->frames; k++)
            times = json_with_item(times, json_number(series->time[k]));
        fields = json_with_item(
            fields, JSON_OBJECT({"name", json_text(series->field.name)},
                                {"title", json_text(derive_field_title(series->field.name))},
                                {"unit", json_text(series->field.unit)},
                                {"whole", json_boolean(field_is_whole(series))}, {"times", times}));
    }
    return fields;
}

static json_t *maps_json(const PageParams *params)
{
    json_t *maps = json_array();
    for (size_t i = 0; i < params->n_maps; i++) {
        const PageColormap *map = &params->maps[i];
        maps = json_with_item(maps, JSON_OBJECT({"name", json_text(map->name)},
                                                {"separate", json_boolean(map->map.separate)}));
    }
    return maps;
}

/* Describes the field that the page shows first; null: none. */
static json_t *start_json(const PageParams *params)
{
    const ColorScale *scale = params->scale;
    if (!scale)
        return json_null();
    return JSON_OBJECT(
        {"field", json_text(scale->name)}, {"map", json_text(params->map)},
        {"kind", params->is_scale_chosen ? json_text(scale->log ? "log" : "linear") : json_null()},
        {"low", json_number(scale->range[0])}, {"high", json_number(scale->range[1])});
}

static json_t *properties_json(const PageParams *params)
{
    return JSON_OBJECT(
        {"name", json_text(params->title)}, {"generator", json_text(params->generator)},
        {"command", json_text(params->command)}, {"origin", vector_json(params->origin)},
        {"look", look_json(params)}, {"fields", fields_json(params)}, {"maps", maps_json(params)},
        {"start", start_json(params)});
}

static void put_properties(const PageParams *params, Text *out)
{
    Text json = TEXT_INIT;
    text_json(&json, properties_json(params), 0);
    const char *chars = text_chars(&json);
    if (!chars)
        text_puts(out, NULL);
    for (; chars && *chars; chars++)
        if (*chars == '<')
            text_puts(out, "\\u003c");
        else
            text_append(out, chars, 1);
    text_release(&json);
}

static Status put_data(Text *out, const void *context, Err *err)
{
    const PageParams *params = context;
    put_blocks(params, out);
    return text_check(out, err);
}

/* Appends a text file. */
static Status put_file(const char *path, Text *out, Err *err)
{
    static const FileForm form = {.name = "a text", .most_bytes = 1e7, .is_text = true};
    char *chars;
    size_t size;
    TRY(file_read(path, &form, &chars, &size, err));
    text_puts(out, chars);
    free(chars);
    return STATUS_OK;
}

Status page_write(const PageParams *params, Text *out, Err *err)
{
    const TmplPart data = {"data", put_data, params};
    Markup page = {0};
    char *notices = NULL;
    Status status;
    text_puts(markup_text(&page, "title"), params->title);
    text_puts(markup_raw(&page, "generator"), params->generator);
    put_properties(params, markup_raw(&page, "properties"));
    TRY_GOTO(file_join(params->templates, "colormaps/NOTICES", &notices, err));
    TRY_GOTO(put_file(notices, markup_text(&page, "notices"), err));
    TRY_GOTO(put_file(params->viewer, markup_raw(&page, "viewer"), err));
    status = markup_stream(&page, params->templates, "page/page.html", &data, 1, out, err);
done:
    markup_release(&page);
    free(notices);
    return status;
}
