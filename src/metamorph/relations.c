/* Lists and applies the metamorphic relations: changes of a scene whose effect on the picture is
 * known. All motions are exact in double precision. Each change sets no more than its own relation
 * states, so that a report names the cause. */
#include "metamorph/relations.h"

#include <string.h>

enum {
    ON_POV = 1 << TRIAL_POV,
    ON_TACHYON = 1 << TRIAL_TACHYON,
    ON_SWC = 1 << TRIAL_SWC,
    ON_SHAPES = ON_POV | ON_TACHYON,
    ON_ALL = ON_SHAPES | ON_SWC
};

/* ---- motions --------------------------------------------------------------------------------- */

/* A motion of points or vectors. */
typedef Vec3 Motion(Vec3 v, const void *context);

/* Moves all points with `point`, and all vectors with `vector`; NULL: vectors stay. */
static void move_scene(TrialScene *scene, Motion *point, Motion *vector, const void *context)
{
    for (int i = 0; i < scene->n_shapes; i++) {
        TrialShape *shape = &scene->shapes[i];
        const int points = shape->kind == SHAPE_TORUS ? 1 : 3;
        for (int k = 0; k < points; k++)
            shape->at[k] = point(shape->at[k], context);
        if (shape->kind == SHAPE_TORUS && vector)
            shape->at[1] = vector(shape->at[1], context);
    }
    for (int i = 0; i < scene->n_lights; i++) {
        scene->lights[i].at = point(scene->lights[i].at, context);
        scene->lights[i].target = point(scene->lights[i].target, context);
    }
    scene->location = point(scene->location, context);
    if (!vector)
        return;
    scene->direction = vector(scene->direction, context);
    scene->up = vector(scene->up, context);
}

static Vec3 scaled(Vec3 v, const void *context)
{
    return vec3_scale(v, *(const double *)context);
}

static Vec3 translated(Vec3 v, const void *context)
{
    return vec3_add(v, *(const Vec3 *)context);
}

/* Turns by 90 degrees about z or x, or by 120 degrees about (1, 1, 1): integers stay integers. */
static Vec3 turned(Vec3 v, const void *context)
{
    const int axis = *(const int *)context;
    return axis == 0   ? vec3(v.y, v.z, v.x)
           : axis == 1 ? vec3(-v.y, v.x, v.z)
                       : vec3(v.x, -v.z, v.y);
}

static Vec3 mirrored(Vec3 v, const void *context)
{
    (void)context;
    return vec3(-v.x, v.y, v.z);
}

/* In perspective, scene->height is the height at distance 1, which scaling does not change. */
void scene_scale(TrialScene *scene, int k)
{
    const double by = ldexp(1, k);
    move_scene(scene, scaled, NULL, &by);
    for (int i = 0; i < scene->n_shapes; i++)
        for (int j = 0; j < 2; j++)
            scene->shapes[i].radius[j] *= by;
    if (!scene->perspective)
        scene->height *= by;
}

/* Renderers have a limit of coordinates: corcast and POV-Ray 10^7, which is above 2^22. */
static bool is_within_limits(const TrialScene *scene)
{
    return vec3_length(scene->location) < 0x1p22;
}

/* Each function below that has these parameters is a change of the table [Relation.apply]: it
 * changes the scene, and returns false if the relation makes no promise about the scene. Scaling
 * changes shadows of trees, because corcast starts shadow rays at a fixed distance. */
static bool scale_up(TrialScene *scene, TrialFormat format, Random *random)
{
    scene_scale(scene, 1 + random_below(random, format == TRIAL_SWC ? 17 : 10));
    return is_within_limits(scene) && (format != TRIAL_SWC || !scene->shadows);
}

static bool scale_down(TrialScene *scene, TrialFormat format, Random *random)
{
    scene_scale(scene, -1 - random_below(random, 8));
    return format != TRIAL_SWC || !scene->shadows;
}

/* Translates by a power of two along each axis: 2^4 to 2^6 for Tachyon, 2^4 to 2^11 for others.
 * Tachyon computes in single precision, which holds a sum with 2^6 and 10 binary digits behind the
 * point. */
static bool translate(TrialScene *scene, TrialFormat format, Random *random)
{
    const int steps = format == TRIAL_TACHYON ? 3 : 8;
    double by[3];
    for (int i = 0; i < 3; i++)
        by[i] = ldexp(random_below(random, 2) ? 1 : -1, 4 + random_below(random, steps));
    const Vec3 vector = vec3(by[0], by[1], by[2]);
    move_scene(scene, translated, NULL, &vector);
    return true;
}

static bool rotate(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format;
    const int axis = random_below(random, 3);
    move_scene(scene, turned, turned, &axis);
    return true;
}

static bool mirror(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    move_scene(scene, mirrored, mirrored, NULL);
    return true;
}

/* ---- pictures and files ---------------------------------------------------------------------- */

/* Changes nothing: two pictures of one scene must be equal. */
static bool repeat(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)scene, (void)format, (void)random;
    return true;
}

static bool crop(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)random;
    scene->height *= 2;
    scene->height_px *= 2;
    return !scene->perspective && (format != TRIAL_SWC || !scene->shadows);
}

static bool reverse_shapes(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    const TrialScene before = *scene;
    for (int i = 0; i < before.n_shapes; i++)
        scene->shapes[i] = before.shapes[before.n_shapes - 1 - i];
    return before.n_shapes > 1;
}

static bool reverse_lights(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    const TrialLight first = scene->lights[0];
    scene->lights[0] = scene->lights[1];
    scene->lights[1] = first;
    return scene->n_lights == 2;
}

/* Returns true if the parent of a row is written, or it has none. */
static bool is_ready(const TrialShape *row, const TrialShape *written, int n)
{
    bool ready = row->parent < 0;
    for (int i = 0; i < n; i++)
        ready = ready || written[i].id == row->parent;
    return ready;
}

static bool reorder_rows(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format;
    TrialScene left = *scene;
    int n = 0;
    while (left.n_shapes > 0) {
        const int i = random_below(random, left.n_shapes);
        if (!is_ready(&left.shapes[i], scene->shapes, n))
            continue;
        scene->shapes[n++] = left.shapes[i];
        left.shapes[i] = left.shapes[--left.n_shapes];
    }
    return n > 2;
}

static bool renumber(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format;
    const int offset = 1 + random_below(random, 100);
    for (int i = 0; i < scene->n_shapes; i++) {
        TrialShape *row = &scene->shapes[i];
        row->id = 3 * row->id + offset;
        row->parent = row->parent < 0 ? -1 : 3 * row->parent + offset;
    }
    return true;
}

/* ---- shapes that change nothing -------------------------------------------------------------- */

static int largest_id(const TrialScene *scene)
{
    int id = 0;
    for (int i = 0; i < scene->n_shapes; i++)
        id = scene->shapes[i].id > id ? scene->shapes[i].id : id;
    return id;
}

/* Adds a sphere or, to a tree, a vessel that starts at `at` and runs along `along`. */
static bool add_far(TrialScene *scene, TrialFormat format, Vec3 at, Vec3 along)
{
    TrialShape *shape = &scene->shapes[scene->n_shapes];
    if (scene->n_shapes + 2 > TRIAL_MAX_SHAPES)
        return false;
    *shape = (TrialShape){.kind = SHAPE_SPHERE, .at = {at, at, at}, .radius = {1, 1}};
    scene->n_shapes++;
    if (format != TRIAL_SWC)
        return true;
    shape->kind = SHAPE_NODE;
    shape->id = largest_id(scene) + 1;
    shape->parent = -1;
    shape[1] = shape[0];
    shape[1].id = shape->id + 1;
    shape[1].parent = shape->id;
    shape[1].at[0] = vec3_add(at, along);
    scene->n_shapes++;
    return true;
}

static bool add_behind(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)random;
    const Vec3 back = vec3_scale(scene->direction, -8), up = vec3_scale(scene->up, 2);
    return !scene->shadows && add_far(scene, format, vec3_add(scene->location, back), up);
}

static bool add_outside(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)random;
    const Vec3 right = vec3_cross(scene->direction, scene->up);
    const Vec3 at =
        vec3_add_scaled(vec3_add_scaled(scene->location, right, 64), scene->direction, 8);
    return !scene->perspective && !scene->shadows &&
           add_far(scene, format, at, vec3_scale(scene->up, 2));
}

/* A sphere inside the first sphere. */
static bool add_hidden(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    TrialShape *hidden = &scene->shapes[scene->n_shapes];
    if (scene->shapes[0].kind != SHAPE_SPHERE || scene->n_shapes == TRIAL_MAX_SHAPES)
        return false;
    *hidden = scene->shapes[0];
    hidden->radius[0] *= 0.5;
    hidden->color = (hidden->color + 1) % TRIAL_COLORS;
    scene->n_shapes++;
    return true;
}

/* Cuts a shape at the midpoint of its axis. The new piece is the last shape. A node is cut between
 * its parent, at `start`, and itself. */
static void cut(TrialScene *scene, TrialShape *shape, Vec3 start)
{
    TrialShape *piece = &scene->shapes[scene->n_shapes++];
    const bool is_node = shape->kind == SHAPE_NODE;
    const Vec3 end = is_node ? shape->at[0] : shape->at[1];
    const Vec3 middle = vec3_scale(vec3_add(start, end), 0.5);
    *piece = *shape;
    if (is_node) {
        piece->at[0] = middle;
        piece->id = largest_id(scene) + 1;
        shape->parent = piece->id;
        return;
    }
    piece->at[0] = middle;
    shape->at[1] = middle;
}

/* Cuts a random cylinder or segment. A radius below 0.25, a pixel, is refused, because renderers
 * draw thinner vessels in other ways. */
static bool split(TrialScene *scene, TrialFormat format, Random *random)
{
    TrialShape *shape = &scene->shapes[random_below(random, scene->n_shapes)];
    const TrialShape *parent = NULL;
    for (int i = 0; i < scene->n_shapes && format == TRIAL_SWC; i++)
        if (scene->shapes[i].id == shape->parent)
            parent = &scene->shapes[i];
    if (scene->n_shapes == TRIAL_MAX_SHAPES || shape->radius[0] < 0.25 ||
        (format == TRIAL_SWC ? !parent : shape->kind != SHAPE_CYLINDER))
        return false;
    cut(scene, shape, parent ? parent->at[0] : shape->at[0]);
    return true;
}

/* ---- other ways to write a shape ------------------------------------------------------------- */

/* Sets a form of all shapes of these kinds. Returns false if there is none. */
static bool set_form(TrialScene *scene, unsigned kinds, unsigned form)
{
    for (int i = 0; i < scene->n_shapes; i++)
        scene->shapes[i].form |= kinds >> scene->shapes[i].kind & 1 ? form : 0U;
    return (trial_kinds(scene) & kinds) != 0;
}

static bool use_union(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    scene->is_union = true;
    return scene->n_shapes > 1;
}

static bool use_cones(TrialScene *scene, TrialFormat format, Random *random)
{
    (void)format, (void)random;
    const bool any = trial_kinds(scene) >> SHAPE_CYLINDER & 1;
    for (int i = 0; i < scene->n_shapes; i++)
        if (scene->shapes[i].kind == SHAPE_CYLINDER) {
            scene->shapes[i].kind = SHAPE_CONE;
            scene->shapes[i].radius[1] = scene->shapes[i].radius[0];
        }
    return any;
}

/* ---- table ----------------------------------------------------------------------------------- */

const Relation relations[] = {
    {"repeat", "the scene is drawn a second time", ON_ALL, .codes = 0, .apply = repeat},
    {"scale-up",
     "all lengths are multiplied by a power of two above 1, to coordinates of at most 2^22; trees "
     "without shadows",
     ON_ALL, .codes = 1, .apply = scale_up},
    {"scale-down", "all lengths are multiplied by 2^-1 to 2^-8; trees without shadows", ON_ALL,
     .codes = 1, .apply = scale_down},
    {"translation", "scene and camera are translated by powers of two", ON_ALL, .codes = 1,
     .apply = translate},
    {"rotation", "scene and camera are rotated by 90 degrees", ON_ALL, .codes = 1, .apply = rotate},
    {"mirror", "scene, lights and camera are mirrored; the second picture is flipped", ON_SHAPES,
     .codes = 1, .flips = true, .apply = mirror},
    {"crop",
     "height and rows are doubled; only the middle rows are compared; orthographic; trees without "
     "shadows",
     ON_ALL, .codes = 1, .crops = true, .apply = crop},
    {"order", "the shapes are written in reverse order", ON_SHAPES, .codes = 1,
     .apply = reverse_shapes},
    {"rows", "the rows are written in another order, parents first", ON_SWC, .codes = 1,
     .apply = reorder_rows},
    {"ids", "the rows have other ids", ON_SWC, .codes = 0, .apply = renumber},
    {"lights", "the lights are written in reverse order", ON_SHAPES, .codes = 1,
     .apply = reverse_lights},
    {"behind", "a sphere or vessel is added behind the camera; without shadows", ON_ALL, .codes = 1,
     .apply = add_behind},
    {"outside", "a sphere or vessel is added beside the frame; orthographic, without shadows",
     ON_ALL, .codes = 1, .apply = add_outside},
    {"hidden", "a smaller sphere is added inside a sphere", ON_SHAPES, .codes = 1,
     .apply = add_hidden},
    {"split", "a cylinder or segment is cut in two at its midpoint; radius of 0.25 or more", ON_ALL,
     .codes = 1, .apply = split},
    {"cone", "cylinders are written as cones with equal radii", ON_POV, .codes = 1,
     .apply = use_cones},
    {"union", "all shapes are parts of a union", ON_POV, .codes = 1, .apply = use_union},
    {"bounds", "each shape gets a bounding sphere", ON_POV, .codes = 1, .kinds = ~0U,
     .form = FORM_BOUNDED},
    {"sturm", "tori and blobs are solved with sturm", ON_POV, .codes = 1,
     .kinds = 1U << SHAPE_TORUS | 1U << SHAPE_BLOB, .form = FORM_STURM},
    {"cancelled", "blobs get two components that cancel each other", ON_POV, .codes = 1,
     .kinds = 1U << SHAPE_BLOB, .form = FORM_CANCELLED},
    {"container", "the containers of isosurfaces are 1.25 times as wide", ON_POV, .codes = 2,
     .kinds = 1U << SHAPE_ISOSURFACE, .form = FORM_WIDE},
    {"accuracy", "the accuracy of isosurfaces is 16 times as fine", ON_POV, .codes = 2,
     .kinds = 1U << SHAPE_ISOSURFACE, .form = FORM_FINE},
    {0},
};

bool relation_scales(const Relation *relation)
{
    return relation->apply == scale_up || relation->apply == scale_down;
}

bool pair_second(const TrialPair *pair, TrialScene *second)
{
    Random random;
    random_seed(&random, pair->seed);
    const Relation *relation = pair->relation;
    *second = pair->first;
    return relation->form ? set_form(second, relation->kinds, relation->form)
                          : relation->apply(second, pair->format, &random);
}
