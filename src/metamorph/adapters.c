/* Writes the random scenes of the metamorphic tests in the formats of the programs under test.
 *
 * Each format is a row of the table at the end of the file: its limits, and the function that
 * writes a scene. Numbers are written with enough digits to be read back exactly. */
#include "metamorph/adapters.h"

/* Multiples of 1/4: their products with the factors 0.25 and 0.75 of the finish are exact. */
static const double palette[TRIAL_COLORS][3] = {
    {1, 0.5, 0.25}, {0.25, 0.75, 1}, {0.5, 1, 0.5}, {0.75, 0.25, 0.75}};

/* Appends three coordinates. Adding 0 turns -0 into 0. */
static void put_point(Text *out, Vec3 v, const char *separator)
{
    text_number(out, v.x + 0);
    text_puts(out, separator);
    text_number(out, v.y + 0);
    text_puts(out, separator);
    text_number(out, v.z + 0);
}

static Vec3 right_of(const TrialScene *scene)
{
    return vec3_normalized(vec3_cross(scene->direction, scene->up));
}

static double picture_width(const TrialScene *scene)
{
    return scene->height * scene->width_px / scene->height_px;
}

/* ---- POV-Ray --------------------------------------------------------------------------------- */

static void pov_vector(Text *out, const char *name, Vec3 v)
{
    text_printf(out, "%s<", name);
    put_point(out, v, ", ");
    text_puts(out, ">");
}

static void pov_number(Text *out, const char *before, double value)
{
    text_puts(out, before);
    text_number(out, value);
}

static void pov_camera(const TrialScene *scene, Text *out)
{
    text_puts(out, scene->perspective ? "camera {" : "camera { orthographic");
    pov_vector(out, " location ", scene->location);
    pov_vector(out, " direction ", vec3_normalized(scene->direction));
    pov_vector(out, " up ", vec3_scale(vec3_normalized(scene->up), scene->height));
    pov_vector(out, " right ", vec3_scale(right_of(scene), picture_width(scene)));
    text_puts(out, " }\n");
}

static void pov_light(const TrialScene *scene, const TrialLight *light, Text *out)
{
    pov_vector(out, "light_source { ", light->at);
    pov_number(out, " color rgb ", light->brightness);
    if (light->parallel)
        pov_vector(out, " parallel point_at ", light->target);
    text_puts(out, scene->shadows ? " }\n" : " shadowless }\n");
}

/* The axis of a torus in POV-Ray is y. The rows of the matrix are the images of x, y and z, and the
 * center. `next` is perpendicular to the axis only because the axis of a trial is along x, y or z.
 */
static void pov_torus(const TrialShape *shape, Text *out)
{
    const Vec3 axis = shape->at[1], next = vec3(axis.z, axis.x, axis.y);
    const Vec3 rows[] = {next, axis, vec3_cross(next, axis), shape->at[0]};
    pov_number(out, "torus { ", shape->radius[0]);
    pov_number(out, ", ", shape->radius[1]);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        text_puts(out, i == 0 ? " matrix <" : ", ");
        put_point(out, rows[i], ", ");
    }
    text_puts(out, ">");
}

/* Two components of strength 1 at at[0] and at[1]. FORM_CANCELLED adds one of strength 1 and one of
 * strength -1, both at at[0]. At the threshold 0.25 a single component is a ball of radius[0] /
 * sqrt 2, because its density is (1 - d^2 / radius^2)^2. The threshold is exact in binary; a larger
 * one would leave smaller balls that merge less often. */
static void pov_blob(const TrialShape *shape, Text *out)
{
    const int n = shape->form & FORM_CANCELLED ? 4 : 2;
    text_puts(out, "blob { threshold 0.25");
    for (int i = 0; i < n; i++) {
        pov_vector(out, " sphere { ", i == 1 ? shape->at[1] : shape->at[0]);
        pov_number(out, ", ", shape->radius[0]);
        text_puts(out, i == 3 ? ", -1 }" : ", 1 }");
    }
}

/* A sphere as the isosurface of f = |x - at[0]|^2 - radius^2. All lengths are multiples of the
 * radius, so that they scale with the scene; the factors are exact in binary. The gradient of f is
 * at most 2 * 1.5625 radius within the container, below max_gradient. The accuracy is a thousandth
 * of a pixel or finer, so that a finer one must not change the picture. The container is wider than
 * the sphere, so that none of its own surface is visible. */
static void pov_isosurface(const TrialShape *shape, Text *out)
{
    static const char *const axes[] = {"x", "y", "z"};
    const double radius = shape->radius[0];
    text_puts(out, "isosurface { function {");
    for (int i = 0; i < 3; i++) {
        text_printf(out, " pow(%s - (", axes[i]);
        text_number(out, vec3_component(shape->at[0], i) + 0);
        text_puts(out, "), 2) +");
    }
    pov_number(out, " -", radius * radius);
    pov_number(out, " } max_gradient ", 4 * radius);
    pov_number(out, " accuracy ", radius * (shape->form & FORM_FINE ? 0x1p-16 : 0x1p-12));
    pov_vector(out, " contained_by { sphere { ", shape->at[0]);
    pov_number(out, ", ", radius * (shape->form & FORM_WIDE ? 1.5625 : 1.25));
    text_puts(out, " } }");
}

/* Begins a sphere, cylinder, cone or triangle: its points and radii. The caller adds the pigment
 * and the closing brace. */
static void pov_begin_simple(const TrialShape *shape, const char *name, int n, Text *out)
{
    text_printf(out, "%s {", name);
    for (int i = 0; i < n; i++) {
        pov_vector(out, i ? ", " : " ", shape->at[i]);
        if (shape->kind == SHAPE_CONE)
            pov_number(out, ", ", shape->radius[i]);
    }
    if (shape->kind == SHAPE_SPHERE || shape->kind == SHAPE_CYLINDER)
        pov_number(out, ", ", shape->radius[0]);
}

/* Returns the radius of a sphere about at[0] that contains the shape. It uses sums of absolute
 * values, not square roots, so that scaling by a power of two scales it exactly. */
static double bounding_radius(const TrialShape *shape)
{
    double reach = 2 * (shape->radius[0] + shape->radius[1]);
    for (int i = 1; i < 3 && shape->kind != SHAPE_TORUS && shape->kind != SHAPE_SPHERE; i++) {
        const Vec3 apart = vec3_sub(shape->at[i], shape->at[0]);
        reach += fabs(apart.x) + fabs(apart.y) + fabs(apart.z);
    }
    return reach;
}

static void pov_shape(const TrialShape *shape, Text *out)
{
    static const char *const names[SHAPE_KINDS] = {[SHAPE_SPHERE] = "sphere",
                                                   [SHAPE_CYLINDER] = "cylinder",
                                                   [SHAPE_CONE] = "cone",
                                                   [SHAPE_TRIANGLE] = "triangle"};
    const int points = shape->kind == SHAPE_SPHERE ? 1 : shape->kind == SHAPE_TRIANGLE ? 3 : 2;
    if (shape->kind == SHAPE_TORUS)
        pov_torus(shape, out);
    else if (shape->kind == SHAPE_BLOB)
        pov_blob(shape, out);
    else if (shape->kind == SHAPE_ISOSURFACE)
        pov_isosurface(shape, out);
    else
        pov_begin_simple(shape, names[shape->kind], points, out);
    if (shape->form & FORM_STURM)
        text_puts(out, " sturm");
    text_puts(out, " pigment { color rgb ");
    const double *color = palette[shape->color];
    pov_vector(out, "", vec3(color[0], color[1], color[2]));
    text_puts(out, " }");
    if (shape->form & FORM_BOUNDED) {
        pov_vector(out, " bounded_by { sphere { ", shape->at[0]);
        pov_number(out, ", ", bounding_radius(shape));
        text_puts(out, " } }");
    }
    text_puts(out, " }\n");
}

static void write_pov(const TrialScene *scene, Text *out)
{
    text_puts(out, "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
                   "#default { finish { ambient 0.25 diffuse 0.75 } }\n");
    pov_camera(scene, out);
    for (int i = 0; i < scene->n_lights; i++)
        pov_light(scene, &scene->lights[i], out);
    if (scene->is_union)
        text_puts(out, "union {\n");
    for (int i = 0; i < scene->n_shapes; i++)
        pov_shape(&scene->shapes[i], out);
    if (scene->is_union)
        text_puts(out, "}\n");
}

/* ---- Tachyon --------------------------------------------------------------------------------- */

static void tachyon_vector(Text *out, const char *name, Vec3 v)
{
    text_printf(out, "%s ", name);
    put_point(out, v, " ");
}

/* FRUSTUM has the left, right, lower and upper edge. Tachyon samples pixel i = 1, 2, ... n at
 * left + i (right - left) / n, from the lower left; the shift by half a pixel moves this position
 * to the center of the pixel. Left and right are exchanged, because Tachyon's x axis points to the
 * left of this camera. */
static void tachyon_camera(const TrialScene *scene, Text *out)
{
    const double wide = picture_width(scene), x = 0.5 / scene->width_px, y = 0.5 / scene->height_px;
    const double edges[] = {(0.5 + x) * wide, (x - 0.5) * wide, (-0.5 - y) * scene->height,
                            (0.5 - y) * scene->height};
    text_printf(out,
                "RESOLUTION %d %d\nSHADER_MODE %s END_SHADER_MODE\nCAMERA\n  PROJECTION %s\n"
                "  ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 1\n",
                scene->width_px, scene->height_px, scene->shadows ? "FULL" : "MEDIUM",
                scene->perspective ? "PERSPECTIVE" : "ORTHOGRAPHIC");
    tachyon_vector(out, "  CENTER", scene->location);
    tachyon_vector(out, "\n  VIEWDIR", vec3_normalized(scene->direction));
    tachyon_vector(out, "\n  UPDIR", vec3_normalized(scene->up));
    text_puts(out, "\n  FRUSTUM");
    for (int i = 0; i < 4; i++) {
        text_puts(out, " ");
        text_number(out, edges[i]);
    }
    text_puts(out, "\nEND_CAMERA\nBACKGROUND 0 0 0\n");
}

static void tachyon_light(const TrialLight *light, Text *out)
{
    if (light->parallel)
        tachyon_vector(out, "DIRECTIONAL_LIGHT DIRECTION",
                       vec3_normalized(vec3_sub(light->target, light->at)));
    else
        tachyon_vector(out, "LIGHT CENTER", light->at);
    text_puts(out, light->parallel ? " COLOR" : " RAD 0 COLOR");
    const double b = light->brightness;
    tachyon_vector(out, "", vec3(b, b, b));
    text_puts(out, "\n");
}

/* FCYLINDER is a cylinder without end discs. */
static void tachyon_shape(const TrialShape *shape, Text *out)
{
    static const char *const names[3] = {"TRI V0", " V1", " V2"};
    for (int i = 0; i < 3 && shape->kind == SHAPE_TRIANGLE; i++)
        tachyon_vector(out, names[i], shape->at[i]);
    if (shape->kind == SHAPE_SPHERE)
        tachyon_vector(out, "SPHERE CENTER", shape->at[0]);
    if (shape->kind == SHAPE_CYLINDER) {
        tachyon_vector(out, "FCYLINDER BASE", shape->at[0]);
        tachyon_vector(out, " APEX", shape->at[1]);
    }
    if (shape->kind != SHAPE_TRIANGLE) {
        text_puts(out, " RAD ");
        text_number(out, shape->radius[0]);
    }
    text_printf(out, " c%d\n", shape->color);
}

static void write_tachyon(const TrialScene *scene, Text *out)
{
    text_puts(out, "BEGIN_SCENE\n");
    tachyon_camera(scene, out);
    for (int i = 0; i < scene->n_lights; i++)
        tachyon_light(&scene->lights[i], out);
    for (int i = 0; i < TRIAL_COLORS; i++) {
        text_printf(out, "TEXDEF c%d AMBIENT 0.25 DIFFUSE 0.75 SPECULAR 0 OPACITY 1 COLOR", i);
        tachyon_vector(out, "", vec3(palette[i][0], palette[i][1], palette[i][2]));
        text_puts(out, " TEXFUNC 0\n");
    }
    for (int i = 0; i < scene->n_shapes; i++)
        tachyon_shape(&scene->shapes[i], out);
    text_puts(out, "END_SCENE\n");
}

/* ---- trees ----------------------------------------------------------------------------------- */

static void write_swc(const TrialScene *scene, Text *out)
{
    for (int i = 0; i < scene->n_shapes; i++) {
        const TrialShape *shape = &scene->shapes[i];
        text_printf(out, "%d 3 ", shape->id);
        put_point(out, shape->at[0], " ");
        text_puts(out, " ");
        text_number(out, shape->radius[0]);
        text_printf(out, " %d\n", shape->parent);
    }
}

/* Appends the camera as options of `corcast render`. The angle 30 need not match scene->height:
 * pictures of one format are compared with each other only. */
static void put_camera(const TrialScene *scene, Text *out)
{
    text_puts(out, "--location ");
    put_point(out, scene->location, ",");
    text_puts(out, " --look-at ");
    put_point(out, vec3_add(scene->location, scene->direction), ",");
    text_puts(out, " --up ");
    put_point(out, scene->up, ",");
    if (scene->perspective) {
        text_puts(out, " --projection perspective --angle 30");
    } else {
        text_puts(out, " --height ");
        text_number(out, scene->height);
    }
    text_printf(out, " --size %dx%d --shadows %s", scene->width_px, scene->height_px,
                scene->shadows ? "on" : "off");
}

/* ---- table and commands ---------------------------------------------------------------------- */

enum {
    KINDS_TACHYON = 1 << SHAPE_SPHERE | 1 << SHAPE_CYLINDER | 1 << SHAPE_TRIANGLE,
    KINDS_POV =
        KINDS_TACHYON | 1 << SHAPE_CONE | 1 << SHAPE_TORUS | 1 << SHAPE_BLOB | 1 << SHAPE_ISOSURFACE
};

const TrialAdapter trial_adapters[TRIAL_FORMATS] = {
    [TRIAL_POV] = {"pov", "png", {KINDS_POV, 20}, write_pov},
    /* 20 and 10: TrialLimits.camera_bits. Tachyon reads single precision, 24 binary digits; 10
     * behind the point leave 14 before it. */
    [TRIAL_TACHYON] = {"tachyon", "ppm", {KINDS_TACHYON, 10}, write_tachyon},
    [TRIAL_SWC] = {"swc", "png", {1 << SHAPE_NODE, 20}, write_swc},
};

void trial_command(const char *command, TrialFormat format, const TrialScene *scene,
                   const char *path, const char *picture, Text *out)
{
    Text camera = TEXT_INIT;
    put_camera(scene, &camera);
    const DrawingMarks marks = {.scene = path,
                                .picture = picture,
                                .camera = text_chars(&camera),
                                .width = scene->width_px,
                                .height = scene->height_px,
                                .needs_camera = format == TRIAL_SWC};
    if (marks.camera)
        drawing_command(command, &marks, out);
    else
        text_puts(out, NULL); /* memory ran out: `out` fails, too */
    text_release(&camera);
}
