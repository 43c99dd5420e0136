/* Writes scenes and surfaces for POV-Ray.
 *
 * A scene consists of the scene itself (camera, lights) and a geometry, the declaration of Tree
 * [docs/POVRAY.md]. They are two files, or the geometry is a part of the scene's file. An exported
 * surface is only a geometry. Both are made from templates. The long parts of the geometry, its
 * macros and members, are appended when the template reaches them. The elements of the model select
 * a row of `geometries`. */
#include "emit/meshparts.h"
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/rows.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* The functions that write the geometry of a model. The first row whose element the model has is
 * used. */
static const struct PovrayRow {
    unsigned element;
    Status (*find)(PovrayGeometry *geometry, Err *err); /* finds the pieces; NULL: the pieces are
                                                         * the items */
    TmplPut *put_macros;
    PovrayPutObject *put_object;
    double pieces; /* number of pieces that POV-Ray reads in about ten seconds (measured; fields
                    * with ids): a load of 1 [povray_load] */
} geometries[] = {
    {MODEL_POTENTIAL, find_cells, put_cell_macros, put_cells, 100000},
    {MODEL_BLOB, find_visible_segments, put_blob_macros, put_blob, 32768},
    {MODEL_TRIANGLES, NULL, put_mesh_macros, put_mesh, 4000},
    {MODEL_JOINTS, NULL, put_primitive_and_joint_macros, put_primitives, 200000},
    {MODEL_CYLINDERS, NULL, put_primitive_macros, put_primitives, 400000},
};

static const struct PovrayRow *row_of(const Scene *scene)
{
    size_t row = 0;
    while (!model_has(scene->geometry.model, geometries[row].element))
        row++;
    return &geometries[row];
}

/* Finds the objects of the geometry, their items, and the pieces that are written. */
static Status find_geometry(PovrayGeometry *geometry, Err *err)
{
    const struct PovrayRow *row = row_of(geometry->scene);
    TRY(povray_objects_find(geometry, err));
    return row->find ? row->find(geometry, err) : STATUS_OK;
}

Status povray_check_name(const char *geometry_file, Err *err)
{
    if (is_ascii_name(geometry_file, "\""))
        return STATUS_OK;
    return err_set(
        err, STATUS_USAGE,
        "POV-Ray cannot include a file called '%s'; use only printable ASCII without '\"'",
        geometry_file);
}

/* Appends an identifier made from a file name, for an include guard. It begins with a capital,
 * because POV-Ray's keywords are lower case. POV-Ray's limit is 255 characters, so a long name is
 * cut and gets a hash of the whole name (FNV-1a) at its end. */
static void put_guard(Text *text, const char *name)
{
    enum { LONGEST = 200 }; /* leaves 55 characters for "Inc_", the hash and what a template adds */
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

/* ---- geometry -------------------------------------------------------------------------------- */

static Status put_tree(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    return put_objects(out, geometry, row_of(geometry->scene)->put_object, err);
}

static void put_vectors(Text *text, const Vec3 *v, size_t n)
{
    for (size_t i = 0; i < n; i++)
        put_text(text, i ? ",<%v>" : "<%v>", v[i]);
}

/* Adds the values for the position of the tree: bounds, roots and path. Without an anatomy, the
 * root is the centre of the bounds. */
static void add_tree_position(Values *values, const EmitParams *params)
{
    const Geometry *geometry = &params->scene->geometry;
    const Vec3 middle = box_center(geometry->bounds);
    const Anatomy none = {.root = (Vec3[]){middle},
                          .n_trees = 1,
                          .main_branch = (Vec3[]){middle},
                          .n_main_branch = 1};
    const Anatomy *anatomy = params->anatomy ? params->anatomy : &none;
    put_text(add_value(values, "low"), "<%v>", geometry->bounds.low);
    put_text(add_value(values, "high"), "<%v>", geometry->bounds.high);
    add_count(values, "segments", geometry->drawn);
    add_count(values, "n_roots", anatomy->n_trees);
    put_vectors(add_value(values, "roots"), anatomy->root, anatomy->n_trees);
    add_count(values, "n_path", anatomy->n_main_branch);
    put_vectors(add_value(values, "path"), anatomy->main_branch, anatomy->n_main_branch);
}

/* A color map of POV-Ray has at most 256 entries. A class of one color takes two entries. */
static void put_color_map(Text *text, const ColorScale *scale)
{
    enum { ENTRIES = COLORRAMP_ENTRIES };
    int steps = colorscale_steps(scale);
    bool stepped = steps > 0 && steps <= ENTRIES / 2;
    int n = stepped ? steps : ENTRIES;
    for (int i = 0; i < n; i++) {
        float rgb[3];
        if (stepped)
            colorscale_step_color(scale, i, rgb);
        else
            colormap_linear(&scale->map, (double)i / (n - 1), rgb);
        for (int side = 0; side < (stepped ? 2 : 1); side++) {
            float position = (float)((double)(i + side) / (stepped ? n : n - 1));
            put_text(text, "[%f rgb <%c>]", (double)position, (Rgb){rgb[0], rgb[1], rgb[2]});
        }
    }
}

/* Appends the text of a string of POV-Ray, reduced to printable ASCII. */
static void put_quoted(Text *text, const char *name)
{
    Text plain = TEXT_INIT;
    text_plain(&plain, name ? name : "");
    text_puts(text, text_chars(&plain) ? "" : NULL);
    for (const char *at = text_chars(&plain); at && *at; at++)
        text_printf(text, "%c", *at >= ' ' && *at <= '~' && !strchr("\"\\", *at) ? *at : '_');
    text_release(&plain);
}

/* Adds the values of the section about the color scale. */
static void add_scale(Values *values, const Appearance *appearance)
{
    const ColorScale *scale = &appearance->scale;
    put_quoted(add_value(values, "value_name"), scale->name);
    put_quoted(add_value(values, "value_unit"), scale->unit);
    put_quoted(add_value(values, "value_said"), appearance->meaning);
    add_number(values, "value_low", scale->range[0]);
    add_number(values, "value_high", scale->range[1]);
    add_flag(values, "value_log", scale->log);
    put_color_map(add_value(values, "color_map"), scale);
    add_count(values, "n_bounds", (size_t)scale->n_bounds);
    Text *bounds = add_value(values, "bounds");
    for (int i = 0; i < scale->n_bounds; i++)
        put_text(bounds, "%n, ", scale->bounds[i]);
    put_scale_position(add_value(values, "value_part"), scale);
    put_value_map(add_value(values, "value_map"), scale);
    text_printf(add_value(values, "count"), "%d",
                colorscale_selects_by_integer(scale) ? colorscale_steps(scale) : 0);
}

/* Appends the meaning of the colors, if values color the segments. */
static Status put_values(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const Appearance *appearance = &geometry->scene->appearance;
    Values values = {.digits = out->digits};
    if (!appearance->meaning)
        return text_check(out, err);
    add_scale(&values, appearance);
    return values_expand(&values, geometry->params, "povray/values.inc", out, err);
}

/* Appends a frame as a case of a #switch, so that POV-Ray parses only one frame. */
static void put_case(Text *out, const void *appearance, size_t frame)
{
    const Appearance shown = appearance_frame(appearance, frame);
    put_text(out, "#case (%z)\n", frame + 1);
    put_frame(out, &shown);
    text_puts(out, "#break\n");
}

/* Adds the values of the section for colors that change with time. */
static void add_frames(Values *values, const Appearance *appearance)
{
    add_count(values, "n_frames", appearance->n_frames);
    add_flag(values, "beats", appearance->radius_factors != NULL);
    Text *times = add_value(values, "times");
    for (size_t k = 0; k < appearance->n_frames; k++)
        put_text(times, k ? ",%n" : "%n", appearance->time[k]);
    add_list(values, "frames", put_case, appearance, appearance->n_frames);
}

/* Appends the declaration of Tree, with all that it needs. */
static Status put_geometry(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const EmitParams *params = geometry->params;
    const Scene *scene = geometry->scene;
    const char *file = params->second_file ? params->second_file : params->file;
    Values values = {.digits = params->digits};
    text_put_line(add_value(&values, "file"), file);
    add_about(&values, params, scene->geometry.bounds, scene->geometry.origin);
    put_guard(add_value(&values, "guard"), file);
    add_float(&values, "red", scene->appearance.color.r);
    add_float(&values, "green", scene->appearance.color.g);
    add_float(&values, "blue", scene->appearance.color.b);
    add_finish(&values, &scene->appearance.finish);
    add_tree_position(&values, params);
    add_part(&values, "values", put_values, geometry);
    add_flag(&values, "colors", scene->appearance.meaning != NULL);
    add_frames(&values, &scene->appearance);
    add_part(&values, "blend", put_blend_macros, geometry);
    add_part(&values, "macros", row_of(scene)->put_macros, geometry);
    add_part(&values, "tree", put_tree, geometry);
    return values_expand(&values, params, "povray/vessels.inc", out, err);
}

/* ---- scene ----------------------------------------------------------------------------------- */

/* Per kind of light: the name of the template's flag, and the name of the macro. */
enum { LIGHT_PARALLEL, LIGHT_POINT, LIGHT_AREA, LIGHT_DISC, LIGHT_KINDS };
static const char *const light_names[LIGHT_KINDS][2] = {{"parallel", "Light_Parallel"},
                                                        {"point", "Light_Point"},
                                                        {"area", "Light_Area"},
                                                        {"disc", "Light_Disc"}};

static int light_kind(const Light *light)
{
    if (light->parallel)
        return LIGHT_PARALLEL;
    if (light->samples <= 1)
        return LIGHT_POINT;
    return light->round ? LIGHT_DISC : LIGHT_AREA;
}

static void put_light(Text *text, const Light *light)
{
    const bool area = light->samples > 1;
    put_text(text, "  %s(<%v>, ", light_names[light_kind(light)][1], light->location);
    if (light->parallel)
        put_text(text, "<%v>, ", light->target);
    put_text(text, "<%c>", light->color);
    if (area)
        put_text(text, ", <%v>, <%v>, %d", light->sides[0], light->sides[1], light->samples);
    text_puts(text, ")\n");
}

/* Adds the lights, and flags for the macros that they call. */
static void add_lights(Values *values, const View *view)
{
    bool has[LIGHT_KINDS] = {false};
    Text *lights = add_value(values, "lights");
    for (size_t i = 0; i < view->n_lights; i++) {
        has[light_kind(&view->lights[i])] = true;
        put_light(lights, &view->lights[i]);
    }
    for (int kind = 0; kind < LIGHT_KINDS; kind++)
        add_flag(values, light_names[kind][0], has[kind]);
}

/* The next functions add the values of a section of the scene. The section is left out if the scene
 * lacks what it describes. */
static void add_ground(Values *values, const Ground *ground)
{
    add_flag(values, "ground", ground->present);
    put_text(add_value(values, "ground_normal"), "<%v>", ground->normal);
    add_number(values, "ground_offset", ground->offset_mm);
    put_text(add_value(values, "ground_color"), "<%c>", ground->color);
    add_float(values, "ground_ambient", ground->finish.ambient);
    add_float(values, "ground_diffuse", ground->finish.diffuse);
}

/* The graded background is a plane at twice the depth of the farthest vessel. */
static void add_graded(Values *values, const Scene *scene)
{
    double near_mm, far_mm;
    camera_depth_range(&scene->view.camera, scene->geometry.bounds, &near_mm, &far_mm);
    add_flag(values, "graded", scene->view.effects.grade.present);
    put_text(add_value(values, "corners"), "<%c>", scene->view.effects.grade.corners);
    add_number(values, "distance", 2 * far_mm);
}

static void add_fade(Values *values, const Fade *fade)
{
    add_flag(values, "fade", fade_is_on(fade));
    add_number(values, "fade_nearest", fade->nearest);
    add_number(values, "fade_farthest", fade->farthest);
    add_number(values, "fade_near", fade->near_mm);
    add_number(values, "fade_far", fade->far_mm);
}

/* Returns the point on the camera's axis at the depth of the centre of the vessels. */
static Vec3 look_at_point(const Scene *scene)
{
    const Camera *camera = &scene->view.camera;
    const Box *box = &scene->geometry.bounds;
    double depth = vec3_dot(vec3_sub(box_center(*box), camera->location), camera->direction);
    depth = depth > 0 ? depth : vec3_distance(box->low, box->high);
    return vec3_add_scaled(camera->location, camera->direction, depth);
}

/* Appends the camera, by its template. */
static Status put_camera(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const Camera *camera = &geometry->scene->view.camera;
    Values values = {.digits = geometry->params->digits};
    add_flag(&values, "perspective", camera->projection == PROJECTION_PERSPECTIVE);
    put_text(add_value(&values, "location"), "<%v>", camera->location);
    put_text(add_value(&values, "look_at"), "<%v>", look_at_point(geometry->scene));
    values.digits = 0; /* all digits: POV-Ray warns if vectors are not perpendicular to 10 digits */
    put_text(add_value(&values, "right"), "<%v>", camera->right);
    put_text(add_value(&values, "up"), "<%v>", camera->up);
    put_text(add_value(&values, "direction"), "<%v>", camera->direction);
    /* relative to the distance of the look-at point, for an orthographic camera */
    const char *over = camera->projection == PROJECTION_PERSPECTIVE ? "" : " / Camera_Distance";
    put_text(add_value(&values, "width"), "%n%s", vec3_length(camera->right), over);
    put_text(add_value(&values, "height"), "%n%s", vec3_length(camera->up), over);
    return values_expand(&values, geometry->params, "povray/camera.inc", out, err);
}

/* Appends a comment that names the effects of `render` that POV-Ray does not draw. */
static void put_effects(Text *text, const EmitParams *params)
{
    Text names = TEXT_INIT;
    Effects omitted = params->scene->view.effects;
    omitted.grade.present = false;
    effects_list(&omitted, params->occlusion, &names);
    if (names.length || names.failed) {
        text_puts(text, "// Not in this scene, but in what corcast render draws: ");
        text_add(text, &names);
        text_puts(text, "\n");
    }
    text_release(&names);
}

/* Appends the scene, by its template. */
static Status put_scene(Text *out, const PovrayGeometry *geometry, Err *err)
{
    const EmitParams *params = geometry->params;
    const Scene *scene = geometry->scene;
    Values values = {.digits = params->digits};
    add_file(&values, params->file, ".png", "\"");
    text_put_line(add_value(&values, "geometry_file"),
                  params->second_file ? params->second_file : "the last part of this file");
    add_about(&values, params, scene->geometry.bounds, scene->geometry.origin);
    put_effects(add_value(&values, "effects"), params);
    add_count(&values, "width", (size_t)scene->view.camera.width);
    add_count(&values, "height", (size_t)scene->view.camera.height);
    add_part(&values, "camera", put_camera, geometry);
    add_flag(&values, "shadows", params->shadows);
    add_float(&values, "background_red", scene->view.background.r);
    add_float(&values, "background_green", scene->view.background.g);
    add_float(&values, "background_blue", scene->view.background.b);
    text_puts(add_value(&values, "background_transmit"), scene->view.transparent ? "1" : "0");
    add_graded(&values, scene);
    add_fade(&values, &scene->view.fade);
    /* This section lets a color or a texture that the user declares replace the vessels' colors. It
     * is left out if the colors represent values. */
    add_flag(&values, "tips", scene->appearance.colors && !scene->appearance.meaning);
    text_puts(add_value(&values, "include"), params->second_file ? params->second_file : "");
    add_part(&values, "geometry", put_geometry, geometry);
    add_lights(&values, &scene->view);
    add_ground(&values, &scene->view.ground);
    return values_expand(&values, params, "povray/scene.pov", out, err);
}

Status povray_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    PovrayGeometry geometry = {.params = params, .scene = params->scene, .report = to->report};
    Status status;
    TRY_GOTO(find_geometry(&geometry, err));
    to->report->cells = geometry.cells ? geometry.cells[0].n_cells : 0;
    if (params->second_file)
        TRY_GOTO(put_geometry(to->second, &geometry, err));
    TRY_GOTO(put_scene(to->file, &geometry, err));
done:
    povray_objects_release(&geometry);
    return status;
}

/* Returns the number of pieces of the whole geometry: cells, segments of a blob, or items. */
static size_t count_pieces(const PovrayGeometry *geometry)
{
    if (geometry->cells)
        return geometry->cells[0].n_cells;
    return geometry->visible_segments.n ? geometry->visible_segments.n : geometry->objects[0].n;
}

Status povray_load(const EmitParams *params, double *load, Err *err)
{
    PovrayGeometry geometry = {.params = params, .scene = params->scene};
    Status status;
    TRY_GOTO(find_geometry(&geometry, err));
    *load = (double)count_pieces(&geometry) / row_of(params->scene)->pieces;
done:
    povray_objects_release(&geometry);
    return status;
}

/* ---- a surface ------------------------------------------------------------------------------- */

/* Makes the geometry of an exported surface. The caller frees its ids; everything else is
 * borrowed. */
static Status take_surface(const EmitParams *params, Geometry *geometry, Err *err)
{
    const VesselTree *vessels = params->vessels;
    *geometry = (Geometry){.model = model_with(MODEL_TRIANGLES),
                           .segments = vessels->segments,
                           .n_segments = vessels->n_segments,
                           .mesh = *params->mesh,
                           .drawn = vessels->n_segments,
                           .bounds = mesh_box(params->mesh)};
    for (size_t i = 0; i < vessels->n_segments; i++)
        if (vessels->segments[i].segment >= geometry->n_ids)
            geometry->n_ids = vessels->segments[i].segment + 1;
    TRY(mem_calloc(&geometry->ids, geometry->n_ids, sizeof *geometry->ids, "ids", err));
    for (size_t i = 0; i < vessels->n_segments; i++)
        geometry->ids[vessels->segments[i].segment] = vessels->ids[i];
    return STATUS_OK;
}

/* Writes only the geometry of a scene of triangles. */
Status povray_write_mesh(const EmitParams *params, EmitOutput *to, Err *err)
{
    Scene scene = {.appearance = *params->appearance};
    EmitParams all = *params;
    PovrayGeometry geometry = {.params = &all, .scene = &scene, .report = to->report};
    Status status;
    all.scene = &scene;
    TRY_GOTO(take_surface(params, &scene.geometry, err));
    TRY_GOTO(find_geometry(&geometry, err));
    TRY_GOTO(put_geometry(to->file, &geometry, err));
done:
    povray_objects_release(&geometry);
    free(scene.geometry.ids);
    return status;
}

Status povray_write_planes(const EmitParams *params, Text *out, Err *err)
{
    return put_template(params, "povray/planes.inc", out, err);
}

/* ---- settings -------------------------------------------------------------------------------- */

/* POV-Ray reads the name "a.ini[b]" as section b of a.ini, so a name must not contain '['. */
static Status check_settings_name(const char *name, Err *err)
{
    if (!strchr(name, '['))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "POV-Ray cannot read an INI file called '%s'; leave out the '['", name);
}

static void add_names(Values *values, const EmitParams *params)
{
    const char *dot = strrchr(params->file, '.');
    const bool like_switch = strchr("+-", *params->settings) != NULL;
    Text *picture = add_value(values, "picture");
    text_append(picture, params->file, dot ? (size_t)(dot - params->file) : strlen(params->file));
    text_puts(picture, ".png");
    text_puts(add_value(values, "scene"), params->file);
    text_puts(add_value(values, "folder"), like_switch ? "./" : "");
    add_word(values, "settings", params->settings, "\"");
}

Status povray_write_settings(const EmitParams *params, Text *out, Err *err)
{
    const Camera *camera = &params->scene->view.camera;
    const bool adaptive = params->antialias <= 1;
    Values values = {.digits = params->digits};
    TRY(check_settings_name(params->settings, err));
    add_names(&values, params);
    add_source(&values, params);
    add_count(&values, "width", (size_t)camera->width);
    add_count(&values, "height", (size_t)camera->height);
    text_puts(add_value(&values, "method"), adaptive ? "2" : "1");
    text_puts(add_value(&values, "threshold"), adaptive ? "0.1" : "0");
    text_printf(add_value(&values, "depth"), "%d", adaptive ? 3 : params->antialias);
    add_flag(&values, "alpha", params->scene->view.transparent);
    add_count(&values, "frames", params->scene->appearance.n_frames);
    return values_expand(&values, params, "povray/scene.ini", out, err);
}
