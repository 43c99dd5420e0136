/* Makes random scenes for the metamorphic tests. Half of the scenes get a special position: end-on,
 * touching, concentric, thin, thick, long, or far from the camera. Defects of renderers are more
 * frequent there than in random scenes. */
#include "metamorph/trial.h"

const char *const shape_kind_names[SHAPE_KINDS] = {
    [SHAPE_SPHERE] = "sphere",     [SHAPE_CYLINDER] = "cylinder", [SHAPE_CONE] = "cone",
    [SHAPE_TORUS] = "torus",       [SHAPE_BLOB] = "blob",         [SHAPE_ISOSURFACE] = "isosurface",
    [SHAPE_TRIANGLE] = "triangle", [SHAPE_NODE] = "vessel"};

int random_below(Random *random, int n)
{
    return (int)(random_uniform(random) * n);
}

/* Returns a multiple of 1/64 in [low, high]. */
static double random_grid(Random *random, double low, double high)
{
    return low + random_below(random, (int)((high - low) * 64) + 1) / 64.0;
}

/* Returns a point with coordinates in [-reach, reach]. */
static Vec3 random_point(Random *random, double reach)
{
    double x = random_grid(random, -reach, reach), y = random_grid(random, -reach, reach);
    return vec3(x, y, random_grid(random, -reach, reach));
}

static Vec3 axis_vector(int axis)
{
    return vec3(axis == 0, axis == 1, axis == 2);
}

/* ---- shapes ---------------------------------------------------------------------------------- */

static ShapeKind random_kind(Random *random, unsigned kinds)
{
    ShapeKind kind;
    do
        kind = (ShapeKind)random_below(random, SHAPE_KINDS);
    while (!(kinds >> kind & 1));
    return kind;
}

/* Returns a step from one end of a shape to the other: up to 4 along each axis, and not too short
 * for a cylinder. */
static Vec3 random_step(Random *random)
{
    Vec3 step = random_point(random, 4);
    if (fabs(step.x) < 1 && fabs(step.y) < 1 && fabs(step.z) < 1)
        step.x += 2;
    return step;
}

/* Makes a shape within 4 of the origin, where the camera sees it. */
static TrialShape random_shape(Random *random, ShapeKind kind)
{
    TrialShape shape = {.kind = kind, .color = random_below(random, TRIAL_COLORS)};
    shape.at[0] = random_point(random, 4);
    shape.at[1] = vec3_add(shape.at[0], random_step(random));
    shape.at[2] = vec3_add(shape.at[0], random_step(random));
    shape.radius[0] = random_grid(random, 0.25, 1.5);
    shape.radius[1] = random_grid(random, 0.25, 1.5);
    if (kind == SHAPE_TORUS) {
        shape.at[1] = axis_vector(random_below(random, 3));
        shape.radius[0] = random_grid(random, 1, 4);
        shape.radius[1] = random_grid(random, 0.125, 0.75);
    }
    if (kind == SHAPE_BLOB)
        shape.radius[0] = random_grid(random, 2, 4);
    return shape;
}

/* Makes the shape a node behind a random earlier one. */
static void attach(Random *random, TrialScene *scene, TrialShape *shape)
{
    shape->id = scene->n_shapes + 1;
    shape->parent = -1;
    if (scene->n_shapes == 0 || (scene->n_shapes > 2 && random_below(random, 12) == 0))
        return;
    const TrialShape *parent = &scene->shapes[random_below(random, scene->n_shapes)];
    shape->parent = parent->id;
    shape->at[0] = vec3_add(parent->at[0], random_step(random));
}

/* Adds 2 to 8 nodes of a tree, or 1 to 5 shapes. */
static void add_shapes(Random *random, const TrialLimits *limits, TrialScene *scene)
{
    const bool is_tree = limits->kinds >> SHAPE_NODE & 1;
    const int n = is_tree ? 2 + random_below(random, 7) : 1 + random_below(random, 5);
    while (scene->n_shapes < n) {
        TrialShape shape = random_shape(random, random_kind(random, limits->kinds));
        if (shape.kind == SHAPE_NODE)
            attach(random, scene, &shape);
        scene->shapes[scene->n_shapes++] = shape;
    }
}

/* Changes one shape, or the camera, to a special position. */
static void specialize(Random *random, TrialScene *scene)
{
    TrialShape *shape = &scene->shapes[scene->n_shapes - 1];
    const TrialShape *other = &scene->shapes[0];
    const Vec3 moved = vec3_sub(other->at[0], shape->at[0]);
    switch (random_below(random, 8)) {
    case 0: /* end-on */
        if (shape->kind != SHAPE_TORUS && shape->kind != SHAPE_NODE)
            shape->at[1] = vec3_add(shape->at[0], scene->direction);
        break;
    case 1: /* touching the first shape */
        shape->at[0] = vec3_add(other->at[0], vec3(other->radius[0] + shape->radius[0], 0, 0));
        break;
    case 2: /* concentric with the first shape */
        if (shape->kind != SHAPE_NODE && shape->kind != SHAPE_TORUS && shape != other)
            for (int i = 0; i < 3; i++)
                shape->at[i] = vec3_add(shape->at[i], moved);
        break;
    case 3: /* thin */
        if (shape->kind != SHAPE_NODE && shape->kind != SHAPE_TORUS)
            shape->radius[0] = shape->radius[1] = random_grid(random, 0.03125, 0.125);
        break;
    case 4: /* thick */
        if (shape->kind != SHAPE_TORUS)
            shape->radius[0] = 3;
        break;
    case 5: /* long */
        if (shape->kind == SHAPE_CYLINDER || shape->kind == SHAPE_CONE)
            shape->at[1] = vec3_add_scaled(shape->at[0], vec3_sub(shape->at[1], shape->at[0]), 16);
        break;
    case 6: /* far from the camera */
        if (!scene->perspective)
            scene->location = vec3_add_scaled(scene->location, scene->direction, -2048);
        break;
    default: /* alone */
        if (shape->kind != SHAPE_NODE)
            scene->n_shapes = 1;
    }
}

/* ---- camera and lights ----------------------------------------------------------------------- */

/* Directions whose length is an integer, so that the unit vector is as exact as possible; up
 * vectors perpendicular to them; and distances of the camera, in lengths of the direction. */
static const struct {
    Vec3 direction, up;
    double distance;
} frames[] = {{{0, 0, -1}, {0, 1, 0}, 24},
              {{3, 0, -4}, {0, 1, 0}, 8},
              {{0, -4, -3}, {0, 3, -4}, 8},
              {{2, -1, -2}, {1, 2, 0}, 8},
              {{-6, 2, -3}, {1, 3, 0}, 8}};

/* Returns an odd multiple of 2^-bits, below 2^-5. */
static double random_offset(Random *random, int bits)
{
    return (2 * random_below(random, 1 << (bits - 6)) + 1) / (double)(1 << bits);
}

/* Chooses a camera that looks almost at the origin. A view is 16 high, which holds all shapes; in
 * perspective 0.5 at distance 1, which is about as much at the distance of the shapes. */
static void aim(Random *random, const TrialLimits *limits, TrialScene *scene)
{
    const int frame = random_below(random, sizeof frames / sizeof *frames);
    const int bits = limits->camera_bits;
    const double x = random_offset(random, bits), y = random_offset(random, bits);
    const Vec3 center = vec3(x, y, random_offset(random, bits));
    scene->direction = frames[frame].direction;
    scene->up = frames[frame].up;
    scene->location = vec3_add_scaled(center, scene->direction, -frames[frame].distance);
    scene->perspective = random_below(random, 3) == 0;
    scene->height = scene->perspective ? 0.5 : 16;
    scene->width_px = scene->height_px = TRIAL_PIXELS;
}

/* Adds lights on the side of the camera, aside by multiples of its right and up vectors. The
 * brightnesses 0.75 and 0.25 are exact in binary and never exceed white together. */
static void add_lights(Random *random, TrialScene *scene)
{
    const Vec3 right = vec3_cross(scene->direction, scene->up);
    scene->n_lights = 1 + random_below(random, TRIAL_MAX_LIGHTS);
    for (int i = 0; i < scene->n_lights; i++) {
        TrialLight *light = &scene->lights[i];
        const double aside = random_below(random, 5) - 2, above = random_below(random, 5) - 2;
        light->at = vec3_add_scaled(vec3_scale(scene->direction, -16), right, 4 * aside);
        light->at = vec3_add_scaled(light->at, scene->up, 4 * above);
        light->parallel = random_below(random, 2) == 0;
        light->brightness = i == 0 ? 0.75 : 0.25;
    }
    scene->shadows = random_below(random, 2) == 0;
}

void trial_make(Random *random, const TrialLimits *limits, TrialScene *scene)
{
    *scene = (TrialScene){0};
    aim(random, limits, scene);
    add_lights(random, scene);
    add_shapes(random, limits, scene);
    if (random_below(random, 2) == 0)
        specialize(random, scene);
}

/* ---- changes --------------------------------------------------------------------------------- */

unsigned trial_kinds(const TrialScene *scene)
{
    unsigned kinds = 0;
    for (int i = 0; i < scene->n_shapes; i++)
        kinds |= 1U << scene->shapes[i].kind;
    return kinds;
}

void trial_remove(TrialScene *scene, int first, int end)
{
    for (; end > first; end--) {
        const TrialShape gone = scene->shapes[first];
        scene->n_shapes--;
        for (int i = first; i < scene->n_shapes; i++)
            scene->shapes[i] = scene->shapes[i + 1];
        for (int i = 0; i < scene->n_shapes; i++)
            if (gone.kind == SHAPE_NODE && scene->shapes[i].parent == gone.id)
                scene->shapes[i].parent = gone.parent;
    }
}

/* Returns the power of two that is at least as large as all coordinates. */
static double power_above(Vec3 v)
{
    int exponent;
    frexp(fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))), &exponent);
    return ldexp(1, exponent);
}

void trial_shift_camera(TrialScene *scene, double x, double y)
{
    const double pixel = scene->perspective ? 0.25 : scene->height / scene->height_px;
    const Vec3 right = vec3_cross(scene->direction, scene->up), up = scene->up;
    scene->location = vec3_add_scaled(scene->location, right, pixel * x / power_above(right));
    scene->location = vec3_add_scaled(scene->location, up, pixel * y / power_above(up));
}
