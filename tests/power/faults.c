/* The faults to plant. Each fault changes the input or the drawn picture of one of the two
 * sides. It changes nothing in corcast itself, and the other side stays as it is. */
#include "subject.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------ geometry */

/* Whether a part is of the segment with this id. */
static bool is_of(const Scene *scene, uint32_t segment, uint32_t id)
{
    return scene->geometry.ids[segment] == id;
}

/* Changes the parts of a scene that stand for one segment, or for all (id 0). */
static void change_parts(Subject *subject, uint32_t id, double radius_factor, Vec3 shift)
{
    Scene *scene = &subject->scene;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        Primitive *p = &scene->geometry.primitives[i];
        if (id && !is_of(scene, p->segment, id))
            continue;
        p->radius_mm *= radius_factor;
        p->radius_b_mm *= radius_factor;
        p->a = vec3_add(p->a, shift);
        p->b = vec3_add(p->b, shift);
    }
    for (size_t i = 0; i < scene->geometry.n_segments; i++) {
        FieldSegment *s = &scene->geometry.segments[i];
        if (id && !is_of(scene, s->segment, id))
            continue;
        s->radius_mm *= radius_factor;
        s->a = vec3_add(s->a, shift);
        s->b = vec3_add(s->b, shift);
    }
}

static const Vec3 nowhere = {0, 0, 0};

/* Across the picture, `px` pixels wide. */
static Vec3 across(const Subject *subject, double px)
{
    return vec3_scale(vec3_normalized(subject->scene.view.camera.right), px * subject->pixel_mm);
}

static void all_radii(Subject *subject, double by)
{
    change_parts(subject, 0, 1 + by, nowhere);
}

static void one_radius(Subject *subject, double by)
{
    change_parts(subject, subject->target, 1 + by, nowhere);
}

static void shift_one(Subject *subject, double px)
{
    change_parts(subject, subject->target, 1, across(subject, px));
}

static void shift_image(Subject *subject, double px)
{
    Camera *camera = &subject->scene.view.camera;
    camera->location = vec3_sub(camera->location, across(subject, px));
}

/* Removes the parts for which `is_gone` holds. */
static void drop_primitives(Scene *scene, uint32_t id, int kind)
{
    size_t kept = 0;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++)
        if (!is_of(scene, scene->geometry.primitives[i].segment, id) ||
            (int)scene->geometry.primitives[i].kind != kind)
            scene->geometry.primitives[kept++] = scene->geometry.primitives[i];
    scene->geometry.n_primitives = kept;
}

static void drop_segment(Subject *subject, double unused)
{
    (void)unused;
    Scene *scene = &subject->scene;
    drop_primitives(scene, subject->target, PRIMITIVE_CYLINDER);
    size_t kept = 0;
    for (size_t i = 0; i < scene->geometry.n_segments; i++)
        if (!is_of(scene, scene->geometry.segments[i].segment, subject->target))
            scene->geometry.segments[kept++] = scene->geometry.segments[i];
    scene->geometry.n_segments = kept;
}

static void drop_joint(Subject *subject, double unused)
{
    (void)unused;
    drop_primitives(&subject->scene, subject->target, PRIMITIVE_SPHERE);
    drop_primitives(&subject->scene, subject->target, PRIMITIVE_JOINT);
}

/* The ruled surfaces of a segment with their ends confused. */
static void flip_joint(Subject *subject, double unused)
{
    (void)unused;
    Scene *scene = &subject->scene;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        Primitive *p = &scene->geometry.primitives[i];
        if (!is_of(scene, p->segment, subject->target) || p->kind != PRIMITIVE_JOINT)
            continue;
        double radius = p->radius_mm;
        p->radius_mm = p->radius_b_mm;
        p->radius_b_mm = radius;
    }
}

/* Wider by `by` at one end and thinner at the other, in two halves. */
static void taper(Subject *subject, double by)
{
    Scene *scene = &subject->scene;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        Primitive *whole = &scene->geometry.primitives[i];
        if (!is_of(scene, whole->segment, subject->target) || whole->kind != PRIMITIVE_CYLINDER)
            continue;
        Primitive half = *whole;
        half.a = whole->b = vec3_scale(vec3_add(whole->a, whole->b), 0.5);
        half.radius_mm *= 1 + by;
        whole->radius_mm *= 1 - by;
        size_t bytes = (scene->geometry.n_primitives + 1) * sizeof half;
        scene->geometry.primitives = realloc(scene->geometry.primitives, bytes);
        scene->geometry.primitives[scene->geometry.n_primitives++] = half;
        return;
    }
    for (size_t i = 0; i < scene->geometry.n_segments; i++) {
        FieldSegment *whole = &scene->geometry.segments[i];
        if (!is_of(scene, whole->segment, subject->target))
            continue;
        FieldSegment half = *whole;
        half.a = whole->b = vec3_scale(vec3_add(whole->a, whole->b), 0.5);
        half.radius_mm *= 1 + by;
        whole->radius_mm *= 1 - by;
        size_t bytes = (scene->geometry.n_segments + 1) * sizeof half;
        scene->geometry.segments = realloc(scene->geometry.segments, bytes);
        scene->geometry.segments[scene->geometry.n_segments++] = half;
        return;
    }
}

static double rounded_to(double x, double step)
{
    return step * floor(x / step + 0.5);
}

/* Coordinates and radii written with too few digits. */
static void few_digits(Subject *subject, double step)
{
    Scene *scene = &subject->scene;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        Primitive *p = &scene->geometry.primitives[i];
        p->a = (Vec3){rounded_to(p->a.x, step), rounded_to(p->a.y, step), rounded_to(p->a.z, step)};
        p->b = (Vec3){rounded_to(p->b.x, step), rounded_to(p->b.y, step), rounded_to(p->b.z, step)};
        p->radius_mm = fmax(rounded_to(p->radius_mm, step), step);
        p->radius_b_mm = fmax(rounded_to(p->radius_b_mm, step), step);
    }
    for (size_t i = 0; i < scene->geometry.n_segments; i++) {
        FieldSegment *s = &scene->geometry.segments[i];
        s->a = (Vec3){rounded_to(s->a.x, step), rounded_to(s->a.y, step), rounded_to(s->a.z, step)};
        s->b = (Vec3){rounded_to(s->b.x, step), rounded_to(s->b.y, step), rounded_to(s->b.z, step)};
        s->radius_mm = fmax(rounded_to(s->radius_mm, step), step);
    }
}

/* A threshold higher by a part `by`: a segment alone has the radius where exp(-2 (d / r)^2) is
 * (1 + by) e^-2. */
static void threshold(Subject *subject, double by)
{
    change_parts(subject, 0, sqrt(1 - log(1 + by) / 2), nowhere);
}

/* ---------------------------------------------------------------------------- light and camera */

static void phong(Subject *subject, double by)
{
    subject->scene.appearance.finish.phong *= (float)(1 + by);
}

static void phong_size(Subject *subject, double by)
{
    subject->scene.appearance.finish.phong_size *= (float)(1 + by);
}

static void diffuse(Subject *subject, double by)
{
    subject->scene.appearance.finish.diffuse *= (float)(1 + by);
}

static void ambient(Subject *subject, double by)
{
    subject->scene.appearance.finish.ambient *= (float)(1 + by);
}

static void brilliance(Subject *subject, double by)
{
    subject->scene.appearance.finish.brilliance *= (float)(1 + by);
}

static void light_color(Subject *subject, double by)
{
    Rgb *color = &subject->scene.view.lights[0].color;
    *color =
        (Rgb){color->r * (float)(1 + by), color->g * (float)(1 + by), color->b * (float)(1 + by)};
}

static void drop_light(Subject *subject, double unused)
{
    (void)unused;
    subject->scene.view.n_lights--;
}

/* Turned about the picture's vertical. */
static Vec3 turned(const Subject *subject, Vec3 v, double deg)
{
    Vec3 axis = vec3_normalized(subject->scene.view.camera.up);
    double angle = deg * 3.14159265358979323846 / 180;
    Vec3 along = vec3_scale(axis, vec3_dot(axis, v) * (1 - cos(angle)));
    return vec3_add(vec3_add(vec3_scale(v, cos(angle)), along),
                    vec3_scale(vec3_cross(axis, v), sin(angle)));
}

static void turn_light(Subject *subject, double deg)
{
    Light *light = &subject->scene.view.lights[0];
    light->location =
        vec3_add(light->target, turned(subject, vec3_sub(light->location, light->target), deg));
}

static void no_shadows(Subject *subject, double unused)
{
    (void)unused;
    subject->params.shadows = false;
    for (size_t i = 0; i < subject->scene.view.n_lights; i++)
        subject->scene.view.lights[i].casts_shadows = false;
}

/* A fill light that casts no shadow. */
static void one_shadow_less(Subject *subject, double unused)
{
    (void)unused;
    subject->scene.view.lights[subject->scene.view.n_lights - 1].casts_shadows = false;
}

static void field_of_view(Subject *subject, double by)
{
    Camera *camera = &subject->scene.view.camera;
    camera->right = vec3_scale(camera->right, 1 + by);
    camera->up = vec3_scale(camera->up, 1 + by);
}

static void roll(Subject *subject, double deg)
{
    Camera *camera = &subject->scene.view.camera;
    double angle = deg * 3.14159265358979323846 / 180,
           aspect = vec3_length(camera->right) / vec3_length(camera->up);
    Vec3 right = camera->right, up = camera->up;
    camera->right = vec3_add(vec3_scale(right, cos(angle)), vec3_scale(up, aspect * sin(angle)));
    camera->up = vec3_sub(vec3_scale(up, cos(angle)), vec3_scale(right, sin(angle) / aspect));
}

static void background(Subject *subject, double by)
{
    subject->scene.view.background.b -= (float)by;
}

static void one_color(Subject *subject, double by)
{
    Scene *scene = &subject->scene;
    Appearance *appearance = &scene->appearance;
    appearance->colors = malloc(scene->geometry.n_ids * sizeof *appearance->colors);
    for (uint32_t i = 0; i < scene->geometry.n_ids; i++) {
        appearance->colors[i] = appearance->color;
        if (is_of(scene, i, subject->target))
            appearance->colors[i].r *= (float)(1 + by);
    }
}

static void other_antialias(Subject *subject, double samples)
{
    subject->params.antialias = (int)samples;
}

/* -------------------------------------------------------------------------------- what is drawn */

static size_t pixels_of(const Subject *subject)
{
    return (size_t)subject->picture.width * (size_t)subject->picture.height;
}

/* Encodes the colors in another way. */
static void encode_again(Subject *subject, float (*curve)(float), float offset)
{
    const float *values = subject->frame.color.values;
    for (size_t i = 0; i < 3 * pixels_of(subject); i++) {
        float encoded = curve(values[i]) * 255 + offset;
        subject->picture.codes8[i] = (uint8_t)(encoded < 0 ? 0 : encoded > 255 ? 255 : encoded);
    }
}

static float power_22(float linear)
{
    return powf(linear < 0 ? 0 : linear, 1 / 2.2f);
}

static float unencoded(float linear)
{
    return linear;
}

static void truncate_codes(Subject *subject, double unused)
{
    (void)unused;
    encode_again(subject, srgb_encode, 0);
}

static void gamma_22(Subject *subject, double unused)
{
    (void)unused;
    encode_again(subject, power_22, 0.5f);
}

static void no_gamma(Subject *subject, double unused)
{
    (void)unused;
    encode_again(subject, unencoded, 0.5f);
}

/* The first pixel of the target, or the first at all. */
static size_t target_pixel(const Subject *subject)
{
    for (size_t i = 0; i < pixels_of(subject); i++)
        if (subject->frame.id.ids[i] == subject->target)
            return i;
    return 0;
}

static void lost_tile(Subject *subject, double side)
{
    size_t width = (size_t)subject->picture.width, at = target_pixel(subject);
    for (size_t y = 0; y < (size_t)side; y++)
        for (size_t x = 0; x < (size_t)side; x++)
            if (at + y * width + x < pixels_of(subject))
                memset(subject->picture.codes8 + 3 * (at + y * width + x), 0, 3);
}

static void nan_depth(Subject *subject, double unused)
{
    (void)unused;
    subject->frame.depth.values[target_pixel(subject)] = NAN;
}

static void nan_normal(Subject *subject, double unused)
{
    (void)unused;
    subject->frame.normal.values[3 * target_pixel(subject) + 1] = NAN;
}

/* A NaN among the colors ends as black. */
static void nan_color(Subject *subject, double unused)
{
    (void)unused;
    memset(subject->picture.codes8 + 3 * target_pixel(subject), 0, 3);
}

static void tilt_normals(Subject *subject, double deg)
{
    float *values = subject->frame.normal.values;
    for (size_t i = 0; i < pixels_of(subject); i++) {
        Vec3 normal = {(double)values[3 * i], (double)values[3 * i + 1], (double)values[3 * i + 2]};
        normal = turned(subject, normal, deg);
        values[3 * i] = (float)normal.x;
        values[3 * i + 1] = (float)normal.y;
        values[3 * i + 2] = (float)normal.z;
    }
}

static void turn_normals_inside_out(Subject *subject, double unused)
{
    (void)unused;
    float *values = subject->frame.normal.values;
    for (size_t i = 0; i < 3 * pixels_of(subject); i++)
        values[i] = -values[i];
}

static void scale_depth(Subject *subject, double by)
{
    for (size_t i = 0; i < pixels_of(subject); i++)
        subject->frame.depth.values[i] *= (float)(1 + by);
}

static void shift_ids(Subject *subject, double unused)
{
    (void)unused;
    uint32_t *ids = subject->frame.id.ids;
    for (size_t i = 0; i < pixels_of(subject); i++)
        ids[i] += ids[i] != 0;
}

static void swap_ids(Subject *subject, double unused)
{
    (void)unused;
    uint32_t *ids = subject->frame.id.ids;
    for (size_t i = 0; i < pixels_of(subject); i++)
        ids[i] = ids[i] == subject->target   ? subject->beside
                 : ids[i] == subject->beside ? subject->target
                                             : ids[i];
}

void reverse_order(Subject *subject, double unused)
{
    (void)unused;
    Scene *scene = &subject->scene;
    for (size_t i = 0, j = scene->geometry.n_primitives; i + 1 < j; i++) {
        Primitive kept = scene->geometry.primitives[i];
        scene->geometry.primitives[i] = scene->geometry.primitives[--j];
        scene->geometry.primitives[j] = kept;
    }
    for (size_t i = 0, j = scene->geometry.n_segments; i + 1 < j; i++) {
        FieldSegment kept = scene->geometry.segments[i];
        scene->geometry.segments[i] = scene->geometry.segments[--j];
        scene->geometry.segments[j] = kept;
    }
}

/* --------------------------------------------------------------------------------------- tables */

const Fault faults[] = {
    {"all radii + 0.1 %", OF_ALL, 1, all_radii, NULL, 0.001},
    {"radius of one segment + 1 %", OF_ALL, 1, one_radius, NULL, 0.01},
    {"a segment dropped", OF_ALL, 1, drop_segment, NULL, 0},
    {"a joint dropped", OF_ROUNDED | OF_JOINED, 1, drop_joint, NULL, 0},
    {"a joint's ends swapped", OF_JOINED, 1, flip_joint, NULL, 0},
    {"one segment shifted by 0.05 px", OF_ALL, 1, shift_one, NULL, 0.05},
    {"picture shifted by 0.01 px", OF_ALL, 1, shift_image, NULL, 0.01},
    {"pixel corners instead of centres", OF_ALL, 1, shift_image, NULL, 0.5},
    {"one segment tapered by 1 %", OF_ALL, 1, taper, NULL, 0.01},
    {"coordinates to 0.01 mm", OF_ALL, 1, few_digits, NULL, 0.01},
    {"threshold + 1 %", OF_FIELDS, 1, threshold, NULL, 0.01},
    {"phong 1 % stronger", OF_ALL, 1, phong, NULL, 0.01},
    {"phong_size 32 to 33", OF_ALL, 1, phong_size, NULL, 1 / 32.0},
    {"diffuse + 1 %", OF_ALL, 1, diffuse, NULL, 0.01},
    {"ambient 0.12 to 0.125", OF_ALL, 1, ambient, NULL, 0.005 / 0.12},
    {"brilliance 1 to 1.02", OF_ALL, 1, brilliance, NULL, 0.02},
    {"a light 1 % dimmer", OF_ALL, 1, light_color, NULL, -0.01},
    {"a light dropped", OF_ALL, 1, drop_light, NULL, 0},
    {"a light turned by 0.1 deg", OF_ALL, 1, turn_light, NULL, 0.1},
    {"no shadows", OF_ALL, 1, no_shadows, NULL, 0},
    {"one light without shadows", OF_ALL, 1, one_shadow_less, NULL, 0},
    {"field of view + 0.05 %", OF_ALL, 1, field_of_view, NULL, 0.0005},
    {"camera rolled by 0.01 deg", OF_ALL, 1, roll, NULL, 0.01},
    {"background one code darker", OF_ALL, 1, background, NULL, 0.009},
    {"one segment 1 % redder", OF_ALL, 1, one_color, NULL, 0.01},
    {"antialiasing 4 x 4 instead of 3 x 3", OF_ALL, 3, other_antialias, NULL, 4},
    {"no antialiasing", OF_ALL, 3, other_antialias, NULL, 1},
    {"codes truncated, not rounded", OF_ALL, 1, NULL, truncate_codes, 0},
    {"gamma 2.2 instead of sRGB", OF_ALL, 1, NULL, gamma_22, 0},
    {"linear values as codes", OF_ALL, 1, NULL, no_gamma, 0},
    {"red and blue swapped", OF_ALL, 1, NULL, NULL, 0},
    {"rows upside down", OF_ALL, 1, NULL, NULL, 0},
    {"mirrored", OF_ALL, 1, NULL, NULL, 0},
    {"rows one pixel too long", OF_ALL, 1, NULL, NULL, 0},
    {"stride is the height", OF_ALL, 1, NULL, NULL, 0},
    {"a row repeated", OF_ALL, 1, NULL, NULL, 0},
    {"a tile of 8 x 8 pixels lost", OF_ALL, 1, NULL, lost_tile, 8},
    {"one color is NaN", OF_ALL, 1, NULL, nan_color, 0},
    {"one depth is NaN", OF_ALL, 1, NULL, nan_depth, 0},
    {"one normal is NaN", OF_ALL, 1, NULL, nan_normal, 0},
    {"normals tilted by 0.2 deg", OF_ALL, 1, NULL, tilt_normals, 0.2},
    {"normals inside out", OF_ALL, 1, NULL, turn_normals_inside_out, 0},
    {"depth 0.1 % too far", OF_ALL, 1, NULL, scale_depth, 0.001},
    {"ids off by one", OF_ALL, 1, NULL, shift_ids, 0},
    {"two segments' ids swapped", OF_ALL, 1, NULL, swap_ids, 0},
};
const size_t n_faults = sizeof faults / sizeof *faults;

const Sweep sweeps[] = {
    {"all radii", "relative", all_radii, 1},
    {"radius of one segment", "relative", one_radius, 1},
    {"shift of one segment", "px", shift_one, 10},
    {"shift of the picture", "px", shift_image, 10},
    {"a light turned", "deg", turn_light, 30},
    {"phong_size", "relative", phong_size, 1},
    {"phong", "relative", phong, 1},
    {"diffuse", "relative", diffuse, 1},
    {"ambient", "relative", ambient, 1},
    {"color of one segment", "relative", one_color, 1},
};
const size_t n_sweeps = sizeof sweeps / sizeof *sweeps;
