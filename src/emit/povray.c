/* Two files: the scene (camera, lights) and the geometry, a union of one macro call a primitive or
 * of one isosurface a cell [docs/POVRAY.md]. Constants of a segment's function are printed with the
 * digits that read back exactly, so what POV-Ray evaluates is what `surface` defines up to its erf.
 */
#include "emit/emit.h"

#include "emit/povray_text.h"
#include "surface/surface.h"
#include "tmpl/tmpl.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void put_vector(Text *text, Vec3 v)
{
    /* Adding 0 turns -0 into 0. */
    text_puts(text, "<");
    text_number(text, v.x + 0);
    text_puts(text, ",");
    text_number(text, v.y + 0);
    text_puts(text, ",");
    text_number(text, v.z + 0);
    text_puts(text, ">");
}

static void put_float(Text *text, float value)
{
    char number[NUMBER_TEXT_SIZE];
    text_puts(text, number_text_float(value, number));
}

static void put_color(Text *text, Rgb color)
{
    char r[NUMBER_TEXT_SIZE], g[NUMBER_TEXT_SIZE], b[NUMBER_TEXT_SIZE];
    text_printf(text, "<%s,%s,%s>", number_text_float(color.r, r), number_text_float(color.g, g),
                number_text_float(color.b, b));
}

void put_paint(Text *text, const Scene *scene, uint32_t id, Rgb color)
{
    text_printf(text, "%u,", id);
    if (scene->uniform_color)
        text_puts(text, "Vessel_Color");
    else
        put_color(text, color);
}

static void put_primitive(Text *text, const Scene *scene, const Primitive *primitive)
{
    bool cylinder = primitive->kind == PRIMITIVE_CYLINDER;
    text_puts(text, cylinder ? "Vessel_Cylinder(" : "Vessel_Sphere(");
    put_vector(text, primitive->a);
    if (cylinder) {
        text_puts(text, ",");
        put_vector(text, primitive->b);
    }
    text_puts(text, ",");
    text_number(text, primitive->radius_mm);
    text_puts(text, ",");
    put_paint(text, scene, primitive->id, primitive->color);
    text_puts(text, ")\n");
}

static void put_primitives(Text *text, const Scene *scene)
{
    for (size_t i = 0; i < scene->n_primitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        if (primitive->kind == PRIMITIVE_JOINT)
            put_joint(text, scene, primitive);
        else
            put_primitive(text, scene, primitive);
    }
}

/* With s = r / 2 and c = 1 / (sqrt2 s): the arguments of the two erf are T = c t and L - T for L =
 * c l, and the exponent of the Gaussian is T^2 - Q for Q = c^2 |x - a|^2, since d^2 = |x - a|^2 -
 * t^2. */
static void put_segments(Text *text, const Scene *scene)
{
    for (size_t i = 0; i < scene->n_segments; i++) {
        const FieldSegment *segment = &scene->segments[i];
        Vec3 span = vec3_sub(segment->b, segment->a);
        double length = vec3_length(span);
        double c = sqrt(2) / segment->radius_mm;
        Vec3 axis = vec3_scale(span, c / length);
        const double numbers[] = {
            axis.x,       axis.y,       axis.z,       -vec3_dot(axis, segment->a),
            segment->a.x, segment->a.y, segment->a.z, c * c,
            c * length};
        text_printf(text, "#declare Fn_%zu = Segment(", i);
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            if (k)
                text_puts(text, ",");
            text_number(text, numbers[k]);
        }
        text_puts(text, ")\n");
    }
}

typedef struct CellText {
    Text low, terms, largest, pick, paints;
    char side[NUMBER_TEXT_SIZE], gradient[NUMBER_TEXT_SIZE], accuracy[NUMBER_TEXT_SIZE],
        scale[NUMBER_TEXT_SIZE], count[NUMBER_TEXT_SIZE];
} CellText;

static void clear(Text *text)
{
    text->length = 0;
    text_puts(text, "");
}

/* Fn_Max(T1,Fn_Max(T2,...)): the largest term. */
static void put_largest(Text *text, const uint32_t *terms, uint32_t count)
{
    for (uint32_t k = 0; k + 1 < count; k++)
        text_printf(text, "Fn_Max(Fn_%u(x,y,z),", terms[k]);
    text_printf(text, "Fn_%u(x,y,z)", terms[count - 1]);
    for (uint32_t k = 0; k + 1 < count; k++)
        text_puts(text, ")");
}

/* Fn_Choose(T1-Fn_Top,0,Fn_Choose(T2-Fn_Top,1,...)): the number of the first term that equals the
 * largest, Fn_Top. */
static void put_pick(Text *text, const uint32_t *terms, uint32_t count)
{
    for (uint32_t k = 0; k + 1 < count; k++)
        text_printf(text, "Fn_Choose(Fn_%u(x,y,z)-Fn_Top(x,y,z),%u,", terms[k], k);
    text_printf(text, "%u", count - 1);
    for (uint32_t k = 0; k + 1 < count; k++)
        text_puts(text, ")");
}

static Status put_cell(Text *text, const Tmpl *template, const Scene *scene, const CellTree *cells,
                       const Cell *cell, CellText *part, Err *err)
{
    const uint32_t *terms = cells->terms + cell->first;
    clear(&part->low);
    clear(&part->terms);
    clear(&part->largest);
    clear(&part->pick);
    clear(&part->paints);
    put_vector(&part->low, cell->low);
    for (uint32_t k = 0; k < cell->count; k++) {
        const FieldSegment *segment = &scene->segments[terms[k]];
        text_printf(&part->terms, "%sFn_%u(x,y,z)", k ? "+" : "", terms[k]);
        text_printf(&part->paints, "Cell_Paint(%u,%u,", k, cell->count);
        put_paint(&part->paints, scene, segment->id, segment->color);
        text_puts(&part->paints, ")");
    }
    put_largest(&part->largest, terms, cell->count);
    put_pick(&part->pick, terms, cell->count);
    snprintf(part->count, sizeof part->count, "%u", cell->count);
    const TmplValue values[] = {
        {"low", part->low.chars},
        {"terms", part->terms.chars},
        {"largest", part->largest.chars},
        {"pick", part->pick.chars},
        {"paints", part->paints.chars},
        {"count", part->count},
        {"side", number_text(cell->side, part->side)},
        {"max_gradient", number_text(cell->max_gradient, part->gradient)},
        {"accuracy", number_text(cell->accuracy, part->accuracy)},
        {"scale", number_text(cell->scale, part->scale)},
    };
    return tmpl_apply(template, values, sizeof values / sizeof *values, text, err);
}

static Status load_template(Tmpl *template, const PovrayParams *params, const char *name, Err *err)
{
    char *folder = NULL, *path = NULL;
    Status status = file_join(params->templates, "povray", &folder, err);
    if (status == STATUS_OK)
        status = file_join(folder, name, &path, err);
    if (status == STATUS_OK)
        status = tmpl_load(template, path, err);
    free(folder);
    free(path);
    return status;
}

/* Finer cells are traced faster but take longer to read; POVRAY.md has the measurements. */
static double chosen_beta(const Scene *scene, const PovrayParams *params)
{
    if (params->cell_beta > 0)
        return params->cell_beta;
    return scene->n_segments <= 3000 ? 3 : scene->n_segments <= 10000 ? 4 : 6;
}

static Status put_cells(Text *text, const Scene *scene, const PovrayParams *params, size_t *n_cells,
                        Err *err)
{
    Tmpl template = {0};
    CellTree cells = {0};
    CellText part = {0};
    Status status = load_template(&template, params, "cell.inc", err);
    if (status == STATUS_OK)
        status = celltree_build(scene, chosen_beta(scene, params), &cells, err);
    for (size_t i = 0; status == STATUS_OK && i < cells.n_cells; i++)
        status = put_cell(text, &template, scene, &cells, &cells.cells[i], &part, err);
    *n_cells = cells.n_cells;
    text_release(&part.low);
    text_release(&part.terms);
    text_release(&part.largest);
    text_release(&part.pick);
    text_release(&part.paints);
    celltree_release(&cells);
    tmpl_release(&template);
    return status;
}

/* An identifier made from a file name: capital first, as POV-Ray's own are lower case. */
static void put_guard(Text *text, const char *name)
{
    text_puts(text, "Inc_");
    for (; *name; name++)
        text_printf(text, "%c", isalnum((unsigned char)*name) ? *name : '_');
}

static void put_extent(Text *text, Box box)
{
    text_printf(text, "%.4g to %.4g, %.4g to %.4g, %.4g to %.4g mm", box.low.x, box.high.x,
                box.low.y, box.high.y, box.low.z, box.high.z);
}

enum { MAX_VALUES = 32 };

/* Values of a template, each with text of its own. */
typedef struct Values {
    TmplValue value[MAX_VALUES];
    Text text[MAX_VALUES];
    size_t n;
} Values;

static Text *add_value(Values *values, const char *name)
{
    Text *text = &values->text[values->n];
    values->value[values->n++].name = name;
    text_puts(text, "");
    return text;
}

static Status expand(Values *values, const PovrayParams *params, const char *name, Text *out,
                     Err *err)
{
    Tmpl template = {0};
    Status status = load_template(&template, params, name, err);
    for (size_t i = 0; i < values->n && status == STATUS_OK; i++) {
        values->value[i].text = values->text[i].chars;
        status = text_check(&values->text[i], err);
    }
    if (status == STATUS_OK)
        status = tmpl_apply(&template, values->value, values->n, out, err);
    tmpl_release(&template);
    for (size_t i = 0; i < values->n; i++)
        text_release(&values->text[i]);
    return status;
}

static Status put_macros(const Scene *scene, const PovrayParams *params, Text *out, Err *err)
{
    Values values = {0};
    if (scene->model != SCENE_ISOSURFACE) {
        TRY(expand(&values, params, "primitives.inc", out, err));
        return scene->model == SCENE_JOINED ? expand(&values, params, "joints.inc", out, err)
                                            : STATUS_OK;
    }
    text_puts(add_value(&values, "many_colors"), scene->uniform_color ? "0" : "1");
    text_number(add_value(&values, "log_floor"), LOG_FORM_FLOOR);
    text_number(add_value(&values, "log_ceiling"), LOG_FORM_CEILING);
    text_printf(add_value(&values, "cell_overlap"), "%d", CELL_OVERLAP);
    put_segments(add_value(&values, "segments"), scene);
    return expand(&values, params, "isosurface.inc", out, err);
}

static Status put_geometry(const Scene *scene, const PovrayParams *params, const char *file,
                           Text *out, PovrayReport *report, Err *err)
{
    Values values = {0};
    const Finish *finish = &scene->finish;
    text_puts(add_value(&values, "file"), file);
    text_puts(add_value(&values, "description"), params->description);
    text_puts(add_value(&values, "generator"), params->generator);
    put_extent(add_value(&values, "extent"), scene->bounds);
    put_guard(add_value(&values, "guard"), file);
    put_color(add_value(&values, "color"), scene->color);
    put_float(add_value(&values, "ambient"), finish->ambient);
    put_float(add_value(&values, "diffuse"), finish->diffuse);
    put_float(add_value(&values, "brilliance"), finish->brilliance);
    put_float(add_value(&values, "phong"), finish->phong);
    put_float(add_value(&values, "phong_size"), finish->phong_size);
    put_float(add_value(&values, "specular"), finish->specular);
    put_float(add_value(&values, "roughness"), finish->roughness);
    Status status = put_macros(scene, params, add_value(&values, "macros"), err);
    Text *body = add_value(&values, "body");
    if (status == STATUS_OK && scene->model == SCENE_ISOSURFACE)
        status = put_cells(body, scene, params, &report->cells, err);
    else if (status == STATUS_OK)
        put_primitives(body, scene);
    Status expanded = expand(&values, params, "vessels.inc", out, status == STATUS_OK ? err : NULL);
    return status == STATUS_OK ? expanded : status;
}

static void put_lights(Text *text, const Scene *scene)
{
    for (size_t i = 0; i < scene->n_lights; i++) {
        const Light *light = &scene->lights[i];
        bool area = light->samples > 1;
        text_printf(text, "  Light_%s(", light->parallel ? "Parallel" : area ? "Area" : "Point");
        put_vector(text, light->location);
        if (light->parallel) {
            text_puts(text, ", ");
            put_vector(text, light->target);
        }
        text_puts(text, ", ");
        put_color(text, light->color);
        for (int side = 0; area && side < 2; side++) {
            text_puts(text, ", ");
            put_vector(text, light->sides[side]);
        }
        if (area)
            text_printf(text, ", %d", light->samples);
        text_puts(text, ")\n");
    }
}

static Status put_scene(const Scene *scene, const PovrayParams *params, const Text *geometry,
                        Text *out, Err *err)
{
    Values values = {0};
    const Camera *camera = &scene->camera;
    double near_mm, far_mm;
    scene_depth_range(scene, &near_mm, &far_mm);
    const char *dot = strrchr(params->scene_file, '.');
    int stem = dot ? (int)(dot - params->scene_file) : (int)strlen(params->scene_file);
    text_puts(add_value(&values, "file"), params->scene_file);
    text_printf(add_value(&values, "stem"), "%.*s", stem, params->scene_file);
    text_puts(add_value(&values, "geometry_file"),
              params->geometry_file ? params->geometry_file : "the last part of this file");
    text_puts(add_value(&values, "description"), params->description);
    text_puts(add_value(&values, "generator"), params->generator);
    put_extent(add_value(&values, "extent"), scene->bounds);
    text_printf(add_value(&values, "width"), "%d", camera->width);
    text_printf(add_value(&values, "height"), "%d", camera->height);
    text_puts(add_value(&values, "perspective"),
              camera->projection == PROJECTION_PERSPECTIVE ? "1" : "0");
    put_vector(add_value(&values, "location"), camera->location);
    put_vector(add_value(&values, "right"), camera->right);
    put_vector(add_value(&values, "up"), camera->up);
    put_vector(add_value(&values, "direction"), camera->direction);
    text_puts(add_value(&values, "shadows"), params->shadows ? "1" : "0");
    put_color(add_value(&values, "background"), scene->background);
    put_lights(add_value(&values, "lights"), scene);
    text_number(add_value(&values, "depth_near"), near_mm);
    text_number(add_value(&values, "depth_far"), far_mm);
    Text *where = add_value(&values, "geometry");
    if (params->geometry_file)
        text_printf(where, "#include \"%s\"", params->geometry_file);
    else
        text_append(where, geometry->chars, geometry->length);
    return expand(&values, params, "scene.pov", out, err);
}

Status emit_povray(const Scene *scene, const PovrayParams *params, Text *scene_text,
                   Text *geometry_text, PovrayReport *report, Err *err)
{
    Text geometry = TEXT_INIT;
    PovrayReport counted = {0};
    const char *file = params->geometry_file ? params->geometry_file : params->scene_file;
    Status status = put_geometry(scene, params, file, &geometry, &counted, err);
    if (status == STATUS_OK)
        status = put_scene(scene, params, &geometry, scene_text, err);
    if (status == STATUS_OK && params->geometry_file)
        text_append(geometry_text, geometry.chars, geometry.length);
    text_release(&geometry);
    if (status == STATUS_OK && report)
        *report = counted;
    if (status == STATUS_OK)
        status = text_check(geometry_text, err);
    return status;
}
