/* Writes a scene for Tachyon. Tachyon has no macros: each object is a line that names a texture. If
 * segments differ in color, each segment has a texture. Cylinders of Tachyon are open, so two rings
 * without a hole close them. Tachyon has no cones, so joints cannot be written.
 *
 * Tachyon numbers pixels from 1 at the lower left and traces a ray through the lower left corner of
 * each pixel. Its pictures are mirrored relative to corcast's. The frustum is therefore shifted by
 * half a pixel and mirrored, so that Tachyon traces the same rays as corcast. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"

#include <stdio.h>

/* Appends a vector in single precision, the precision that Tachyon reads. Adding 0 turns -0 into
 * 0. */
static void put_numbers(Text *text, Vec3 v)
{
    put_triple(text, "", (const float[3]){(float)v.x + 0, (float)v.y + 0, (float)v.z + 0}, " ", "");
}

static void put_colors(Text *text, Rgb color)
{
    put_triple(text, "", (const float[3]){color.r, color.g, color.b}, " ", "");
}

static void put_named(Text *text, const char *name, Vec3 v)
{
    text_puts(text, name);
    put_numbers(text, v);
}

/* ---- textures -------------------------------------------------------------------------------- */

/* Returns true if each segment has a texture of its own. */
static bool has_textures(const EmitParams *params)
{
    return params->planes || params->scene->appearance.colors;
}

static void put_texture_name(Text *text, const EmitParams *params, uint32_t segment)
{
    if (has_textures(params))
        text_printf(text, " v%u\n", params->scene->geometry.ids[segment]);
    else
        text_puts(text, " vessel\n");
}

static void put_texture(Text *text, const char *name, const Finish *finish, Rgb color)
{
    put_text(text, "TEXDEF %s AMBIENT %f DIFFUSE %f SPECULAR 0 OPACITY 1 PHONG PLASTIC %f", name,
             (double)finish->ambient, (double)finish->diffuse, (double)finish->phong);
    put_text(text, " PHONG_SIZE %f COLOR ", (double)finish->phong_size);
    put_colors(text, color);
    text_puts(text, " TEXFUNC 0\n");
}

/* Returns a color whose 8-bit codes are the bytes of an id. The 0.5 allows for truncation by
 * Tachyon. */
static Rgb id_color(uint32_t id)
{
    return (Rgb){((float)(id >> 16 & 255) + 0.5F) / 255, ((float)(id >> 8 & 255) + 0.5F) / 255,
                 ((float)(id & 255) + 0.5F) / 255};
}

/* Appends one texture for all segments, or one per segment. */
static Status put_textures(Text *out, const void *context, Err *err)
{
    const EmitParams *params = context;
    const Geometry *geometry = &params->scene->geometry;
    const Appearance *look = &params->scene->appearance;
    const Finish none = {.phong_size = 1};
    if (!has_textures(params))
        put_texture(out, "vessel", &look->finish, look->color);
    for (uint32_t i = 0; has_textures(params) && i < geometry->n_ids; i++) {
        char name[16];
        if (geometry->ids[i] == 0)
            continue;
        snprintf(name, sizeof name, "v%u", geometry->ids[i]);
        put_texture(out, name, params->planes ? &none : &look->finish,
                    params->planes ? id_color(geometry->ids[i]) : appearance_color(look, i));
    }
    return text_check(out, err);
}

/* ---- objects --------------------------------------------------------------------------------- */

static void put_radius(Text *text, const char *name, const EmitParams *params,
                       const Primitive *primitive)
{
    put_text(text, "%s%f", name, primitive->radius_mm);
    put_texture_name(text, params, primitive->segment);
}

/* Closes an end of a cylinder with a ring. The inner radius is -1, because Tachyon leaves out the
 * centre of a ring even if the inner radius is 0. */
static void put_cap(Text *text, const EmitParams *params, const Primitive *cylinder, Vec3 at)
{
    put_named(text, "RING CENTER ", at);
    put_named(text, " NORMAL ", vec3_normalized(vec3_sub(cylinder->b, cylinder->a)));
    put_radius(text, " INNER -1 OUTER ", params, cylinder);
}

static void put_primitive(Text *text, const EmitParams *params, const Primitive *primitive)
{
    if (primitive->kind == PRIMITIVE_SPHERE) {
        put_named(text, "SPHERE CENTER ", primitive->a);
        put_radius(text, " RAD ", params, primitive);
        return;
    }
    put_named(text, "FCYLINDER BASE ", primitive->a);
    put_named(text, " APEX ", primitive->b);
    put_radius(text, " RAD ", params, primitive);
    if (!primitive->round_a)
        put_cap(text, params, primitive, primitive->a);
    if (!primitive->round_b)
        put_cap(text, params, primitive, primitive->b);
}

static void put_triangle(Text *text, const EmitParams *params, size_t triangle)
{
    static const char *const corners[] = {" V0 ", " V1 ", " V2 "};
    static const char *const normals[] = {" N0 ", " N1 ", " N2 "};
    const Geometry *geometry = &params->scene->geometry;
    const VesselMesh *mesh = &geometry->mesh;
    const uint32_t *corner = mesh->triangles[triangle];
    bool cap = mesh_is_cap(mesh, triangle);
    text_puts(text, cap ? "TRI" : "STRI");
    for (int k = 0; k < 3; k++)
        put_triple(text, corners[k], mesh->points[corner[k]], " ", "");
    for (int k = 0; !cap && k < 3; k++)
        put_triple(text, normals[k], mesh->normals[corner[k]], " ", "");
    put_texture_name(text, params, geometry->segments[mesh_segment(mesh, triangle)].segment);
}

static Status put_vessels(Text *out, const void *context, Err *err)
{
    const EmitParams *params = context;
    const Geometry *geometry = &params->scene->geometry;
    for (size_t i = 0; i < geometry->n_primitives; i++)
        put_primitive(out, params, &geometry->primitives[i]);
    for (size_t i = 0; i < geometry->mesh.n_triangles; i++)
        put_triangle(out, params, i);
    return text_check(out, err);
}

/* ---- scene ----------------------------------------------------------------------------------- */

/* Appends left, right, bottom and top of the frustum, shifted and mirrored as described at the
 * beginning of this file. */
static void put_frustum(Text *text, const Camera *camera)
{
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    double x = 0.5 / camera->width, y = 0.5 / camera->height;
    put_text(text, "%f %f %f %f", (0.5 + x) * width, (x - 0.5) * width, (-0.5 - y) * height,
             (0.5 - y) * height);
}

static void add_camera(Values *values, const Camera *camera)
{
    add_count(values, "width", (size_t)camera->width);
    add_count(values, "height", (size_t)camera->height);
    text_puts(add_value(values, "projection"),
              camera->projection == PROJECTION_PERSPECTIVE ? "PERSPECTIVE" : "ORTHOGRAPHIC");
    put_numbers(add_value(values, "location"), camera->location);
    put_numbers(add_value(values, "direction"), camera->direction);
    put_numbers(add_value(values, "up"), vec3_normalized(camera->up));
    put_frustum(add_value(values, "frustum"), camera);
}

static void put_light(Text *text, const Light *light)
{
    if (light->parallel)
        put_named(text, "DIRECTIONAL_LIGHT DIRECTION ",
                  vec3_normalized(vec3_sub(light->target, light->location)));
    else
        put_named(text, "LIGHT CENTER ", light->location);
    text_puts(text, light->parallel ? " COLOR " : " RAD 0 COLOR ");
    put_colors(text, light->color);
    text_puts(text, "\n");
}

static void put_ground(Text *text, const Ground *ground)
{
    if (!ground->present)
        return;
    put_texture(text, "ground", &ground->finish, ground->color);
    put_named(text, "PLANE CENTER ", vec3_scale(ground->normal, ground->offset_mm));
    put_named(text, " NORMAL ", ground->normal);
    text_puts(text, " ground\n");
}

static Status put_lights(Text *out, const void *context, Err *err)
{
    const EmitParams *params = context;
    const View *view = &params->scene->view;
    for (size_t i = 0; i < view->n_lights; i++)
        put_light(out, &view->lights[i]);
    put_ground(out, &view->ground);
    return text_check(out, err);
}

Status tachyon_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    const Scene *scene = params->scene;
    const View *view = &scene->view;
    double near_mm, far_mm;
    Values values = {.digits = params->digits};
    camera_depth_range(&view->camera, scene->geometry.bounds, &near_mm, &far_mm);
    add_file(&values, params->file, ".ppm", "");
    add_about(&values, params, scene->geometry.bounds, scene->geometry.origin);
    add_camera(&values, &view->camera);
    add_part(&values, "textures", put_textures, params);
    add_part(&values, "vessels", put_vessels, params);
    if (params->planes) {
        add_number(&values, "depth_near", near_mm);
        add_number(&values, "depth_far", far_mm);
        return values_expand(&values, params, "tachyon/planes.tachyon", to->file, err);
    }
    text_puts(add_value(&values, "shader"), params->shadows ? "FULL" : "MEDIUM");
    text_printf(add_value(&values, "antialiasing"), "%d",
                params->antialias > 1 ? params->antialias * params->antialias - 1 : 0);
    put_colors(add_value(&values, "background"), view->background);
    add_part(&values, "lights", put_lights, params);
    return values_expand(&values, params, "tachyon/picture.tachyon", to->file, err);
}
