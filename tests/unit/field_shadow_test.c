/* Slow: sums the potential by brute force along each ray. Checks shadows of isosurfaces and
 * blobs. */
/* Shadows of the potential by views of lights against brute force, in long double, of rays from
 * what a camera sees to a light. With C the level, such a ray must be dark if, once the potential
 * has fallen below 0.998 C - e, it reaches C + e, and lit if from there on it does not reach C - e,
 * and before did not reach 1.002 C + e; of others, which are counted, nothing is said. e is what
 * single precision and the terms left out amount to. */
#include "render/light/shadowqueue.h"
#include "unit.h"

#include "render/cast/caster.h"
#include "render/field/fieldtiles.h"
#include "stage/stage.h"
#include <stdint.h>
#include <stdio.h>

#include "field_walk.h"
#include "test_grow.h"

/* Nothing nearer shadows a place, in radii of the smallest vessel. */
static const double from_radii = 1e-3;

typedef struct Tally {
    const char *name;
    int rays, dark, near, wrong;
} Tally;

/* What a camera sees in 8 x 8 pixels, and which of that lies in the shadow of a light. */
typedef struct Sight {
    uint64_t seen;
    HitPoints places;
    Vec3 normal[TILE_SAMPLES];
    uint8_t shadowed[TILE_SAMPLES];
} Sight;

static void keep_sight(const TracedTile *tile, Sight *sight)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        if (!tile->hits || tile->hits->state[sample] != TILE_HIT)
            continue;
        Vec3 place = tile_hit_point(tile, sample);
        const float(*normal)[TILE_SAMPLES] = tile->hits->normal;
        sight->seen |= (uint64_t)1 << sample;
        sight->places.x[sample] = place.x;
        sight->places.y[sample] = place.y;
        sight->places.z[sample] = place.z;
        sight->normal[sample] =
            vec3((double)normal[0][sample], (double)normal[1][sample], (double)normal[2][sample]);
    }
}

static void look(const Geometry *geometry, const Camera *camera, Sight *sight)
{
    const RenderParams params = {.threads = 1};
    const View view = {.camera = *camera};
    const Drawing drawing = {.geometry = geometry, .view = &view, .params = &params};
    const SampleGrid grid = {.side = 1, .n_columns = 8, .n_rows = 8};
    BatchTile tile = {.traced = {.n_columns = 8,
                                 .n_rows = 8,
                                 .perspective = camera->projection == PROJECTION_PERSPECTIVE}};
    void *bins;
    *sight = (Sight){.seen = 0};
    assert_int_equal(field_tiles.bin(&drawing, &grid, &bins, NULL), STATUS_OK);
    assert_int_equal(field_tiles.list(bins, 0, 0, NULL), STATUS_OK);
    assert_int_equal(field_tiles.trace(bins, 0, -1, &tile, NULL), STATUS_OK);
    keep_sight(&tile.traced, sight);
    field_tiles.release(bins);
}

/* Of what is seen, as bits, that which faces the light. */
static uint64_t facing(const Sight *sight, const Viewpoint *eye, const Light *light)
{
    uint64_t bits = 0;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        Vec3 at = {sight->places.x[sample], sight->places.y[sample], sight->places.z[sample]};
        Vec3 towards = light_direction(light, viewpoint_world_point(eye, at)).towards;
        if (sight->seen >> sample & 1 &&
            vec3_dot(viewpoint_frame_direction(eye, towards), sight->normal[sample]) > 1e-6)
            bits |= (uint64_t)1 << sample;
    }
    return bits;
}

static void ask(const Geometry *geometry, const Light *light, const Viewpoint *eye, double from_mm,
                int kind, uint64_t wanted, Sight *sight)
{
    const View view = {.camera = {.width = 8, .height = 8}};
    const RenderParams params = {.threads = 1, .shadow_from_mm = from_mm};
    const Drawing drawing = {.geometry = geometry, .view = &view, .params = &params};
    const LightBinsParams of = {.engine = &field_shadows, .drawing = &drawing, .frame = *eye};
    LightBins *bins;
    ShadowQueue *queue;
    assert_true(field_shadows.supports(geometry, &view, light));
    assert_int_equal(lightbins_new(&of, light, 1, &bins, NULL), STATUS_OK);
    RenderKernels kernels = (RenderKernels)(KERNELS_PORTABLE + kind);
    assert_int_equal(shadowqueue_new(bins, kernels, NULL, &queue, NULL), STATUS_OK);
    memset(sight->shadowed, 0, sizeof sight->shadowed);
    shadowqueue_add(queue, &sight->places, NULL, wanted, 0);
    assert_int_equal(shadowqueue_answer(queue, sight->shadowed, NULL), STATUS_OK);
    shadowqueue_free(queue);
    lightbins_free(bins);
}

/* The potential at t. */
static long double potential_at(const Walk *walk, double t)
{
    long double sum = 0;
    for (size_t i = 0; i < walk->n; i++)
        if (walk->near[i].on <= t && walk->near[i].off >= t)
            sum += walk_term(walk->blob, walk->near[i].segment, point_at(walk, t), NULL);
    return sum;
}

typedef enum Verdict { LIT, DARK, EITHER } Verdict;

/* What one sum makes of a ray from its origin on. */
static Verdict judge_sum(const Geometry *sum, Ray ray, double from_mm, double radius, Near *near)
{
    const long double level = (long double)FIELD_LEVEL;
    Walk walk = walk_start(sum, ray, near);
    const long double e = epsilon_of(walk.n) + 2e-5L;
    long double highest = 0, phi;
    double t = from_mm;
    for (; (phi = potential_at(&walk, t)) > 0.998L * level - e; t += 1e-3 * radius) {
        highest = phi > highest ? phi : highest;
        if (t > from_mm + 100 * radius)
            return EITHER;
    }
    walk.t = fmax(walk.t, t);
    bool may = walk.t < HUGE_VAL && walk_to(&walk, level - e);
    bool must = may && walk_to(&walk, level + e);
    if (highest > 1.002L * level - e)
        return EITHER;
    return must ? DARK : may ? EITHER : LIT;
}

static Verdict judge(const Geometry *geometry, Ray ray, double from_mm, double radius,
                     FieldSegment *members, Near *near)
{
    Verdict verdict = LIT;
    size_t number = 0;
    do {
        Geometry sum = sum_of(geometry, number, members);
        Verdict of_sum = judge_sum(&sum, ray, from_mm, radius, near);
        if (of_sum == DARK)
            return DARK;
        verdict = of_sum == EITHER ? EITHER : verdict;
    } while (++number < geometry->blend.n_groups);
    return verdict;
}

typedef struct Trial {
    const Geometry *geometry;
    double from_mm, radius; /* of the smallest vessel */
    Camera camera;
    Light light;
    FieldSegment *members;
    Near *near;
} Trial;

static void judge_all(const Trial *trial, const Viewpoint *eye, const Sight *sight, uint64_t wanted,
                      Tally *tally)
{
    for (; wanted; wanted &= wanted - 1) {
        int sample = __builtin_ctzll(wanted);
        Vec3 at = {sight->places.x[sample], sight->places.y[sample], sight->places.z[sample]};
        Vec3 point = viewpoint_world_point(eye, at);
        Ray ray = {point, light_direction(&trial->light, point).towards};
        Verdict verdict =
            judge(trial->geometry, ray, trial->from_mm, trial->radius, trial->members, trial->near);
        bool dark = sight->shadowed[sample];
        tally->rays++;
        tally->dark += dark;
        tally->near += verdict == EITHER;
        if (verdict != EITHER && dark != (verdict == DARK)) {
            tally->wrong++;
            print_error("%s: %s at %.9g %.9g %.9g, sample %d\n", tally->name, dark ? "dark" : "lit",
                        point.x, point.y, point.z, sample);
        }
    }
}

/* At a vessel, from two to four times as far as the scene is wide. */
static Camera aim_camera(const Geometry *geometry, double extent, Random *random)
{
    const FieldSegment *segment = &geometry->segments[random_bits(random) % geometry->n_segments];
    Vec3 d = random_direction(random), right = random_normal_to(random, d);
    Vec3 target = vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), 0.5);
    double pixel = segment->radius_mm * pow(10, uniform(random, -1, 1));
    double distance = extent * uniform(random, 2, 4);
    Camera camera = {.direction = d, .width = 8, .height = 8};
    camera.location = vec3_add_scaled(target, d, -distance);
    if (random_bits(random) % 2) {
        camera.projection = PROJECTION_PERSPECTIVE;
        pixel /= distance;
    }
    camera.right = vec3_scale(right, 8 * pixel);
    camera.up = vec3_scale(vec3_cross(right, d), 8 * pixel);
    return camera;
}

/* A parallel one, or one as near as a view allows, or farther; one in four along an axis. */
static Light aim_light(const Geometry *geometry, Random *random)
{
    Vec3 center = box_center(geometry->bounds), d = random_direction(random);
    if (random_bits(random) % 4 == 0)
        d = vec3(0, random_bits(random) % 2 ? 1 : 0, 0), d.x = 1 - d.y;
    double distance = lightview_radius(geometry) * (1.2 + pow(10, uniform(random, -1, 1)));
    return (Light){.location = vec3_add_scaled(center, d, distance),
                   .target = center,
                   .parallel = random_bits(random) % 2,
                   .casts_shadows = true};
}

/* Tries so many cameras, each with a light, by the fastest kernel, and now and then by all. */
static void try_lights(Geometry *geometry, int cameras, Random *random, Tally *tally)
{
    Trial trial = {.geometry = geometry, .radius = HUGE_VAL};
    geometry->bounds = box_empty();
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        geometry->bounds = box_with_ball(geometry->bounds, segment->a, 2 * segment->radius_mm);
        geometry->bounds = box_with_ball(geometry->bounds, segment->b, 2 * segment->radius_mm);
        trial.radius = fmin(trial.radius, segment->radius_mm);
    }
    trial.from_mm = geometry->model == SCENE_BLOB ? BLOB_NEAREST_MM : from_radii * trial.radius;
    trial.members = calloc(geometry->n_segments, sizeof *trial.members);
    trial.near = calloc(geometry->n_segments, sizeof *trial.near);
    assert_true(trial.members && trial.near);
    for (int i = 0; i < cameras; i++) {
        Sight sight;
        trial.camera = aim_camera(geometry, lightview_radius(geometry), random);
        trial.light = aim_light(geometry, random);
        const Viewpoint eye = viewpoint_of_camera(&trial.camera);
        look(geometry, &trial.camera, &sight);
        uint64_t wanted = facing(&sight, &eye, &trial.light);
        for (int k = i % 8 ? kernels_usable() - 1 : 0; k < kernels_usable(); k++) {
            ask(geometry, &trial.light, &eye, trial.from_mm, k, wanted, &sight);
            judge_all(&trial, &eye, &sight, wanted, tally);
        }
    }
    free(trial.members);
    free(trial.near);
}

static void finish(const Tally *tally)
{
    printf("  %-12s %6d rays, %5d dark, %4d near; %d wrong\n", tally->name, tally->rays,
           tally->dark, tally->near, tally->wrong);
    assert_int_equal(tally->wrong, 0);
    assert_true(tally->dark > 30 / SHARE);
    assert_true(tally->near < tally->rays / 50 + 5);
}

static void try_scenes(SceneModel model, int cameras, uint64_t seed)
{
    Random random;
    random_seed(&random, seed);
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        Tally tally = {.name = kind_names[kind]};
        int runs =
            kind == KIND_STAR || kind == KIND_SHORT ? 2 : 24; /* brute force is slow on these */
        for (int run = 0; run < (runs + SHARE - 1) / SHARE; run++) {
            TestScene test;
            make_test_scene((SceneKind)kind, &random, &test);
            test.geometry.model = model;
            try_lights(&test.geometry, cameras, &random, &tally);
        }
        finish(&tally);
    }
}

static void shadows_of_adversarial_scenes_are_right(void **state)
{
    (void)state;
    try_scenes(SCENE_ISOSURFACE, 16, 71);
}

static void try_grown(const char *name, SceneModel model, const char *spec, bool graph,
                      uint64_t seed)
{
    Geometry geometry;
    Random random;
    Tally tally = {.name = name};
    GrowParams params = grow_defaults();
    const GeometryParams shape = {.model = model, .graph = graph};
    params.terminals = graph ? 12 : 300;
    Tree tree = test_grown_by(&params, spec);
    assert_int_equal(stage_geometry(&tree, &shape, &geometry, NULL, NULL), STATUS_OK);
    random_seed(&random, seed);
    int cameras = graph ? 100 : model == SCENE_BLOB ? 400 : 1400;
    try_lights(&geometry, cameras / SHARE, &random, &tally);
    finish(&tally);
    geometry_release(&geometry);
    tree_release(&tree);
}

static void shadows_of_trees_are_right(void **state)
{
    (void)state;
    try_grown("disc", SCENE_ISOSURFACE, "disc:50", false, 72);
    try_grown("ball", SCENE_ISOSURFACE, "ball:9.2", false, 73);
}

static void shadows_of_the_potential_of_the_graph_are_right(void **state)
{
    (void)state;
    try_grown("graph", SCENE_ISOSURFACE, "ball:3.1", true, 74);
}

static void shadows_of_blobs_are_right(void **state)
{
    (void)state;
    try_scenes(SCENE_BLOB, 16, 75);
    try_grown("disc", SCENE_BLOB, "disc:50", false, 76);
    try_grown("ball", SCENE_BLOB, "ball:9.2", false, 77);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadows_of_adversarial_scenes_are_right),
        cmocka_unit_test(shadows_of_trees_are_right),
        cmocka_unit_test(shadows_of_the_potential_of_the_graph_are_right),
        cmocka_unit_test(shadows_of_blobs_are_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
