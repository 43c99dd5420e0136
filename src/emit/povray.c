/* Two files: the scene (camera, lights) and the geometry, a union of one macro call a primitive, of
 * one isosurface a cell, or of a blob [docs/POVRAY.md]. */
#include "emit/povray_text.h"

#include "surface/surface.h"
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

void put_linear(Text *text, const Linear *linear)
{
    static const char *const factors[] = {"x*", "y*", "z*", ""};
    bool first = true;
    for (int i = 0; i < 4; i++) {
        double k = linear->k[i];
        if (k == 0)
            continue;
        text_puts(text, k < 0 ? "-" : first ? "" : "+");
        text_puts(text, factors[i]);
        text_number(text, fabs(k));
        first = false;
    }
}

static void put_float(Text *text, float value)
{
    char number[NUMBER_TEXT_SIZE];
    text_puts(text, number_text_float(value, number));
}

void put_color(Text *text, Rgb color)
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

Status load_template(Tmpl *template, const PovrayParams *params, const char *name, Err *err)
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

Status povray_check_name(const char *geometry_file, Err *err)
{
    const char *at = geometry_file;
    while (*at >= ' ' && *at <= '~' && *at != '"')
        at++;
    if (*at == '\0')
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "POV-Ray cannot include a file named '%s': it takes only printable ASCII, "
                   "without '\"'",
                   geometry_file);
}

/* An identifier made from a file name: capital first, as POV-Ray's own are lower case, which take
 * at most 255 characters. The end of a long name is a hash of the whole (FNV-1a). */
static void put_guard(Text *text, const char *name)
{
    enum { LONGEST = 200 };
    uint32_t hash = 2166136261u;
    text_puts(text, "Inc_");
    for (size_t i = 0; name[i]; i++) {
        hash = (hash ^ (unsigned char)name[i]) * 16777619u;
        if (i < LONGEST)
            text_printf(text, "%c", isalnum((unsigned char)name[i]) ? name[i] : '_');
    }
    if (strlen(name) > LONGEST)
        text_printf(text, "_%08x", hash);
}

/* The box, and where its origin lies in the tree when that was moved. */
static void put_extent(Text *text, Box box, Vec3 origin)
{
    text_printf(text, "%.4g to %.4g, %.4g to %.4g, %.4g to %.4g mm", box.low.x, box.high.x,
                box.low.y, box.high.y, box.low.z, box.high.z);
    if (origin.x != 0 || origin.y != 0 || origin.z != 0)
        text_printf(text, ", about <%.15g,%.15g,%.15g> of the tree", origin.x, origin.y, origin.z);
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
    return text;
}

static Status expand(Values *values, const PovrayParams *params, const char *name, Text *out,
                     Err *err)
{
    Tmpl template = {0};
    Status status = load_template(&template, params, name, err);
    for (size_t i = 0; i < values->n; i++)
        values->value[i].text = text_chars(&values->text[i]);
    if (status == STATUS_OK)
        status = tmpl_apply(&template, values->value, values->n, out, err);
    tmpl_release(&template);
    for (size_t i = 0; i < values->n; i++)
        text_release(&values->text[i]);
    return status;
}

static Status put_cell_macros(const Scene *scene, const PovrayParams *params, const CellTree *cells,
                              Text *out, Err *err)
{
    Values values = {0};
    static const char *const names[ERF_TERMS] = {"erf1", "erf3", "erf5", "erf7", "erf9"};
    for (int i = 0; i < ERF_TERMS; i++)
        text_number(add_value(&values, names[i]), erf_forms[cells->erf][i]);
    text_puts(add_value(&values, "exact_erf"), cells->erf == ERF_EXACT ? "1" : "0");
    text_puts(add_value(&values, "painted"), scene->uniform_color && !params->ids ? "0" : "1");
    text_puts(add_value(&values, "many_colors"), scene->uniform_color ? "0" : "1");
    Status status = put_scales(add_value(&values, "scales"), params, cells, err);
    Text *terms = add_value(&values, "terms");
    if (status == STATUS_OK)
        status = put_terms(terms, scene, params, cells, err);
    Status expanded =
        expand(&values, params, "isosurface.inc", out, status == STATUS_OK ? err : NULL);
    return status == STATUS_OK ? expanded : status;
}

static Status put_blob_macros(const Scene *scene, const PovrayParams *params, Text *out, Err *err)
{
    Values values = {0};
    const BlobTube *tube = blob_shape.tube;
    const BlobBead *bead = blob_shape.bead;
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"r1", tube[0].radius},   {"s1", tube[0].strength}, {"r2", tube[1].radius},
                   {"s2", tube[1].strength}, {"h1", bead[0].offset},   {"q1", bead[0].radius},
                   {"c1", bead[0].strength}, {"h2", bead[1].offset},   {"q2", bead[1].radius},
                   {"c2", bead[1].strength}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        text_number(add_value(&values, numbers[i].name), numbers[i].value);
    bool painted = !scene->uniform_color || params->ids;
    text_puts(add_value(&values, "painted"), painted ? "1" : "0");
    text_puts(add_value(&values, "many_colors"), scene->uniform_color ? "0" : "1");
    Text *paint = add_value(&values, "paint"), *top = add_value(&values, "top");
    Text *groups = add_value(&values, "groups"), *n_groups = add_value(&values, "n_groups");
    Status status = STATUS_OK;
    if (painted)
        status = put_blob_paint(scene, paint, top, groups, n_groups, err);
    Status expanded = expand(&values, params, "blob.inc", out, status == STATUS_OK ? err : NULL);
    return status == STATUS_OK ? expanded : status;
}

static Status put_primitive_macros(const Scene *scene, const PovrayParams *params, Text *out,
                                   PovrayReport *report, Err *err)
{
    Values values = {0};
    TRY(expand(&values, params, "primitives.inc", out, err));
    if (scene->model != SCENE_JOINED)
        return STATUS_OK;
    report->joint_sides = joint_sides(scene);
    text_printf(add_value(&values, "sides"), "%d", report->joint_sides);
    return expand(&values, params, "joints.inc", out, err);
}

static Status put_cell_members(const Scene *scene, const PovrayParams *params, Text *macros,
                               Text *body, PovrayReport *report, Err *err)
{
    CellTree cells = {0};
    Status status = celltree_build(scene, &params->cells, &cells, err);
    if (status == STATUS_OK)
        status = put_cell_macros(scene, params, &cells, macros, err);
    if (status == STATUS_OK)
        status = put_cells(body, scene, params, &cells, err);
    report->cells = cells.n_cells;
    celltree_release(&cells);
    return status;
}

/* The macros, and the members of the union that they make. */
static Status put_members(const Scene *scene, const PovrayParams *params, Text *macros, Text *body,
                          PovrayReport *report, Err *err)
{
    if (scene->model == SCENE_ISOSURFACE)
        return put_cell_members(scene, params, macros, body, report, err);
    if (scene->model == SCENE_BLOB) {
        TRY(put_blob(body, scene, &report->cells, err));
        return put_blob_macros(scene, params, macros, err);
    }
    put_primitives(body, scene);
    return put_primitive_macros(scene, params, macros, report, err);
}

static Status put_geometry(const Scene *scene, const PovrayParams *params, const char *file,
                           Text *out, PovrayReport *report, Err *err)
{
    Values values = {0};
    const Finish *finish = &scene->finish;
    text_put_line(add_value(&values, "file"), file);
    text_put_line(add_value(&values, "description"), params->description);
    text_puts(add_value(&values, "generator"), params->generator);
    put_extent(add_value(&values, "extent"), scene->bounds, scene->origin);
    put_guard(add_value(&values, "guard"), file);
    put_float(add_value(&values, "red"), scene->color.r);
    put_float(add_value(&values, "green"), scene->color.g);
    put_float(add_value(&values, "blue"), scene->color.b);
    put_float(add_value(&values, "ambient"), finish->ambient);
    put_float(add_value(&values, "diffuse"), finish->diffuse);
    put_float(add_value(&values, "brilliance"), finish->brilliance);
    put_float(add_value(&values, "phong"), finish->phong);
    put_float(add_value(&values, "phong_size"), finish->phong_size);
    put_float(add_value(&values, "specular"), finish->specular);
    put_float(add_value(&values, "roughness"), finish->roughness);
    Text *macros = add_value(&values, "macros"), *body = add_value(&values, "body");
    Text *kind = add_value(&values, "kind");
    Status status = put_members(scene, params, macros, body, report, err);
    text_puts(kind, scene->model == SCENE_BLOB && report->cells == 0 ? "blob" : "union");
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

static Status put_ground(Text *text, const Scene *scene, const PovrayParams *params, Err *err)
{
    const Ground *ground = &scene->ground;
    if (!ground->present)
        return STATUS_OK;
    Values values = {0};
    put_vector(add_value(&values, "normal"), ground->normal);
    text_number(add_value(&values, "offset"), ground->offset_mm);
    put_color(add_value(&values, "color"), ground->color);
    put_float(add_value(&values, "ambient"), ground->finish.ambient);
    put_float(add_value(&values, "diffuse"), ground->finish.diffuse);
    return expand(&values, params, "ground.inc", text, err);
}

static void put_stem(Text *text, const char *name)
{
    const char *dot = strrchr(name, '.');
    Text stem = TEXT_INIT;
    text_append(&stem, name, dot ? (size_t)(dot - name) : strlen(name));
    text_put_line(text, text_chars(&stem));
    text_release(&stem);
}

static Status put_scene(const Scene *scene, const PovrayParams *params, const Text *geometry,
                        Text *out, Err *err)
{
    Values values = {0};
    const Camera *camera = &scene->camera;
    double near_mm, far_mm;
    scene_depth_range(scene, &near_mm, &far_mm);
    text_put_line(add_value(&values, "file"), params->scene_file);
    put_stem(add_value(&values, "stem"), params->scene_file);
    text_put_line(add_value(&values, "geometry_file"),
                  params->geometry_file ? params->geometry_file : "the last part of this file");
    text_put_line(add_value(&values, "description"), params->description);
    text_puts(add_value(&values, "generator"), params->generator);
    put_extent(add_value(&values, "extent"), scene->bounds, scene->origin);
    text_printf(add_value(&values, "width"), "%d", camera->width);
    text_printf(add_value(&values, "height"), "%d", camera->height);
    text_puts(add_value(&values, "perspective"),
              camera->projection == PROJECTION_PERSPECTIVE ? "1" : "0");
    put_vector(add_value(&values, "location"), camera->location);
    put_vector(add_value(&values, "right"), camera->right);
    put_vector(add_value(&values, "up"), camera->up);
    put_vector(add_value(&values, "direction"), camera->direction);
    text_puts(add_value(&values, "shadows"), params->shadows ? "1" : "0");
    put_float(add_value(&values, "background_red"), scene->background.r);
    put_float(add_value(&values, "background_green"), scene->background.g);
    put_float(add_value(&values, "background_blue"), scene->background.b);
    Text *lights = add_value(&values, "lights");
    put_lights(lights, scene);
    Status status = put_ground(lights, scene, params, err);
    text_number(add_value(&values, "depth_near"), near_mm);
    text_number(add_value(&values, "depth_far"), far_mm);
    Text *where = add_value(&values, "geometry");
    if (params->geometry_file)
        text_printf(where, "#include \"%s\"", params->geometry_file);
    else
        text_add(where, geometry);
    Status expanded = expand(&values, params, "scene.pov", out, status == STATUS_OK ? err : NULL);
    return status == STATUS_OK ? expanded : status;
}

Status emit_povray(const Scene *scene, const PovrayParams *params, Text *scene_text,
                   Text *geometry_text, PovrayReport *report, Err *err)
{
    Text geometry = TEXT_INIT;
    PovrayReport counted = {0};
    const char *file = params->geometry_file ? params->geometry_file : params->scene_file;
    if (params->geometry_file)
        TRY(povray_check_name(params->geometry_file, err));
    Status status = put_geometry(scene, params, file, &geometry, &counted, err);
    if (status == STATUS_OK)
        status = put_scene(scene, params, &geometry, scene_text, err);
    if (status == STATUS_OK && params->geometry_file)
        text_add(geometry_text, &geometry);
    text_release(&geometry);
    if (status == STATUS_OK && report)
        *report = counted;
    if (status == STATUS_OK)
        status = text_check(geometry_text, err);
    return status;
}
