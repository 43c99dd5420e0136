/* Slow: sums the potential by brute force along each ray. Checks that hits are first hits,
 * within the guaranteed error. */
/* The tile renderer against brute force: every ray's hit must be the exact first hit for a level
 * within EPSILON of e^-2. The brute force adds up every term above e^-32 in long double, straight
 * from the definition, and walks the ray in steps that the slope and a bound of the terms' second
 * derivatives allow, at least 2e-5 of the smallest radius present, to where the potential first
 * reaches level - EPSILON and then level + EPSILON. Without a hit at the lower one there must be
 * none; the hit must lie between the two, widened by the tolerance. Rays for which the two are
 * farther apart than the tolerance graze, and are counted. */
#include "render/field/fieldtiles.h"
#include "unit.h"

#include "stage/stage.h"
#include "treeio/treeio.h"
#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include "field_walk.h"
#include "test_grow.h"
#include <stdio.h>

typedef struct Tally {
    const char *name;
    int rays, hits, grazing, wrong;
    double worst, part, worst_degrees;
} Tally;

/* What one kernel says of the samples of an 8 x 8 picture. */
typedef struct Answer {
    bool hit[TILE_SAMPLES];
    double t[TILE_SAMPLES];
    Vec3 normal[TILE_SAMPLES];
    uint32_t segment[TILE_SAMPLES];
    Viewpoint eye;
} Answer;

static void keep_answer(const TracedTile *seen, Answer *answer)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        answer->hit[sample] = seen->hits && seen->hits->state[sample] == TILE_HIT;
        if (!answer->hit[sample])
            continue;
        const TileHits *hits = seen->hits;
        answer->t[sample] = tile_hit_distance(seen, sample);
        answer->segment[sample] = hits->segment[sample];
        answer->normal[sample] = viewpoint_world_direction(
            &answer->eye, vec3((double)hits->normal[0][sample], (double)hits->normal[1][sample],
                               (double)hits->normal[2][sample]));
    }
}

static void ask(const Geometry *geometry, const Camera *camera, int kernel, Answer *answer)
{
    const RenderParams params = {.threads = 1,
                                 .kernels = (RenderKernels)(KERNELS_PORTABLE + kernel)};
    const View view = {.camera = *camera};
    const Drawing drawing = {.geometry = geometry, .view = &view, .params = &params};
    const SampleGrid grid = {.side = 1, .n_columns = 8, .n_rows = 8};
    BatchTile tile = {.traced = {.n_columns = 8,
                                 .n_rows = 8,
                                 .perspective = camera->projection == PROJECTION_PERSPECTIVE}};
    void *bins;
    assert_int_equal(field_tiles.bin(&drawing, &grid, &bins, NULL), STATUS_OK);
    assert_int_equal(field_tiles.list(bins, 0, 0, NULL), STATUS_OK);
    assert_int_equal(field_tiles.trace(bins, 0, -1, &tile, NULL), STATUS_OK);
    *answer = (Answer){.eye = viewpoint_of_camera(camera)};
    keep_answer(&tile.traced, answer);
    field_tiles.release(bins);
}

/* The normal is the gradient's direction, and the segment that of the largest term. */
static bool describes_hit(const Walk *walk, const Geometry *geometry, const Answer *answer,
                          int sample, Tally *tally)
{
    LongVec3 x = point_at(walk, answer->t[sample]);
    Vec3 sum = vec3(0, 0, 0);
    long double largest = 0;
    for (size_t i = 0; i < walk->n; i++) {
        LongVec3 gradient;
        long double term = walk_term(walk->blob, walk->near[i].segment, x, &gradient);
        largest = term > largest ? term : largest;
        sum = vec3_add(sum, vec3((double)gradient.x, (double)gradient.y, (double)gradient.z));
    }
    const FieldSegment *named = &geometry->segments[answer->segment[sample]];
    double steepness = vec3_length(sum) * named->radius_mm;
    if (steepness > 0.1 * FIELD_LEVEL) {
        Vec3 difference = vec3_add_scaled(answer->normal[sample], sum, 1 / vec3_length(sum));
        /* What an error of the gradient turns a lone tube's normal by, whose steepness is 4 times
         * the level: where tubes meet, the gradient is less, and the same error turns it by
         * more. */
        double lone = fmin(1, steepness / (4 * FIELD_LEVEL));
        double degrees = vec3_length(difference) * 57.3 * lone;
        tally->worst_degrees = fmax(tally->worst_degrees, degrees);
    }
    return walk_term(walk->blob, named, x, NULL) >= largest - 1e-4L;
}

/* How far a hit may be from where it is, mm: by the radius of its vessel and single precision's
 * share of its depth, so at every scale alike. */
static double depth_within(double radius_mm, double depth_mm)
{
    return 1e-4 * radius_mm + 2 * (double)FLT_EPSILON * depth_mm;
}

/* Between which places the potential of a geometry reaches the level along a ray, to `epsilon`;
 * infinite where it does not. */
static void find_span(Walk *walk, long double epsilon, double *from, double *to)
{
    *from = *to = HUGE_VAL;
    if (walk_to(walk, (long double)FIELD_LEVEL - epsilon))
        *from = walk->t;
    if (*from < HUGE_VAL && walk_to(walk, (long double)FIELD_LEVEL + epsilon))
        *to = walk->t;
}

/* Of a union of sums the first hit is the first of all; one that reaches the level there says what
 * is hit. */
static void judge(const Geometry *geometry, const Camera *camera, const Answer *answer, int sample,
                  FieldSegment *members, Near *near, Tally *tally)
{
    Ray ray = camera_ray(camera, tile_sample_x(sample), tile_sample_y(sample));
    bool hit = answer->hit[sample];
    double t = answer->t[sample], from = HUGE_VAL, to = HUGE_VAL, degrees = HUGE_VAL;
    double radius = hit ? geometry->segments[answer->segment[sample]].radius_mm : 0;
    double tolerance = depth_within(radius, t);
    size_t number = 0;
    do {
        Tally described = {.name = tally->name};
        double first, last;
        Geometry sum = sum_of(geometry, number, members);
        Walk walk = walk_start(&sum, ray, near);
        find_span(&walk, epsilon_of(walk.n), &first, &last);
        from = fmin(from, first);
        to = fmin(to, last);
        if (hit && first <= t + tolerance &&
            describes_hit(&walk, geometry, answer, sample, &described))
            degrees = fmin(degrees, described.worst_degrees);
    } while (++number < geometry->blend.n_groups);
    bool earliest = from < HUGE_VAL, latest = to < HUGE_VAL;
    bool right = hit ? earliest && t >= from - tolerance && t <= to + tolerance : !latest;
    tally->rays++;
    tally->hits += hit;
    tally->grazing += earliest && to - from > tolerance;
    if (right && hit && to - from <= tolerance)
        tally->worst = fmax(tally->worst, fabs(t - (from + to) / 2) / tolerance),
        tally->part = fmax(tally->part, fabs(t - (from + to) / 2) / radius);
    if (degrees < HUGE_VAL)
        tally->worst_degrees = fmax(tally->worst_degrees, degrees);
    if (!right || (hit && degrees == HUGE_VAL)) {
        tally->wrong++;
        print_error("%s: %s at %.9g, exact between %.9g and %.9g, sample %d\n", tally->name,
                    hit ? "hit" : "none", t, from, to, sample);
    }
}

typedef enum Aim {
    AIM_ANY,     /* from anywhere at a vessel, from very near to very far */
    AIM_TANGENT, /* along the silhouette of a vessel */
    AIM_AXIAL,   /* along its axis, exactly or nearly */
    AIM_ALIGNED, /* along x, y or z */
    N_AIMS,
    AIM_FACING = N_AIMS /* along z, orthographic: scenes in a plane have a kernel of their own */
} Aim;

static Camera aim(Aim kind, const Geometry *geometry, double extent, Random *random)
{
    const FieldSegment *segment = &geometry->segments[random_bits(random) % geometry->n_segments];
    Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a)), d = random_direction(random);
    Vec3 target =
        vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), uniform(random, -0.05, 1.05));
    double r = segment->radius_mm, pixel = r * pow(10, uniform(random, -2.5, 0.8));
    if (kind == AIM_AXIAL) {
        double off = random_bits(random) % 3 ? pow(10, uniform(random, -9, -1)) : 0;
        d = vec3_normalized(vec3_add_scaled(axis, d, off));
    } else if (kind == AIM_ALIGNED) {
        int which = (int)(random_bits(random) % 6), sign = which % 2 ? -1 : 1;
        d = vec3(which / 2 == 0 ? sign : 0, which / 2 == 1 ? sign : 0, which / 2 == 2 ? sign : 0);
    } else if (kind == AIM_TANGENT) {
        Vec3 side = vec3_cross(axis, d);
        double off =
            r * (1 + pow(10, uniform(random, -7, -1)) * (random_bits(random) % 2 ? 1 : -1));
        target = vec3_add_scaled(target, vec3_normalized(side), off);
        pixel = r * pow(10, uniform(random, -6, -1));
    }
    if (kind == AIM_FACING) {
        d = vec3(0, 0, random_bits(random) % 2 ? 1 : -1);
        double off =
            r * (1 + pow(10, uniform(random, -7, -1)) * (random_bits(random) % 2 ? 1 : -1));
        bool tangent = random_bits(random) % 3 == 0;
        target = vec3_add_scaled(target, vec3_cross(axis, d), tangent ? off : 0);
    }
    Vec3 right = random_normal_to(random, d), up = vec3_cross(right, d);
    Camera camera = {.direction = d, .width = 8, .height = 8};
    double distance = extent * uniform(random, 2, 4);
    camera.location = vec3_add_scaled(target, d, -distance);
    if (kind != AIM_FACING && random_bits(random) % 2) {
        camera.projection = PROJECTION_PERSPECTIVE;
        pixel /= distance;
    }
    camera.right = vec3_scale(right, 8 * pixel);
    camera.up = vec3_scale(up, 8 * pixel);
    return camera;
}

static void try_cameras(const Geometry *geometry, int cameras, bool facing, Random *random,
                        Tally *tally)
{
    double extent = 0;
    for (size_t i = 0; i < geometry->n_segments; i++)
        extent = fmax(extent, vec3_distance(geometry->segments[0].a, geometry->segments[i].b) +
                                  4 * geometry->segments[i].radius_mm);
    Near *near = calloc(geometry->n_segments, sizeof *near);
    FieldSegment *members = calloc(geometry->n_segments, sizeof *members);
    assert_true(near && members);
    Answer answer;
    int n_kernels = kernels_usable();
    for (int i = 0; i < cameras; i++) {
        const Camera camera =
            aim(facing ? AIM_FACING : (Aim)(i % N_AIMS), geometry, extent, random);
        for (int k = i % 8 ? n_kernels - 1 : 0; k < n_kernels; k++) {
            ask(geometry, &camera, k, &answer);
            for (int sample = 0; sample < TILE_SAMPLES; sample++)
                judge(geometry, &camera, &answer, sample, members, near, tally);
        }
    }
    free(members);
    free(near);
}

static void finish(const Tally *tally)
{
    printf("  %-12s %6d rays, %5d hits, %4d grazing; off by %.2f of what is allowed (%.2g r), "
           "normals by %.1e degrees; %d "
           "wrong\n",
           tally->name, tally->rays, tally->hits, tally->grazing, tally->worst, tally->part,
           tally->worst_degrees, tally->wrong);
    assert_int_equal(tally->wrong, 0);
    assert_true(tally->hits > tally->rays / 8);
    assert_true(tally->worst_degrees < 0.2);
}

static void try_tree(const Tree *tree, SceneModel model, const char *name, bool facing,
                     uint64_t seed)
{
    Geometry geometry = {.model = model};
    geometry.segments = calloc(tree->n, sizeof *geometry.segments);
    assert_non_null(geometry.segments);
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && tree_segment_length(tree, i) > 0)
            geometry.segments[geometry.n_segments++] =
                (FieldSegment){.a = tree->position[tree->parent[i]],
                               .b = tree->position[i],
                               .radius_mm = tree->radius_mm[i]};
    Random random;
    random_seed(&random, seed);
    Tally tally = {.name = name};
    int cameras = facing ? 80 : model == SCENE_BLOB ? 48 : 240;
    try_cameras(&geometry, cameras / SHARE, facing, &random, &tally);
    finish(&tally);
    free(geometry.segments);
}

static void try_grown(const char *name, SceneModel model, const char *spec, double lambda,
                      bool facing)
{
    GrowParams params = grow_defaults();
    params.terminals = 400;
    params.lambda = lambda;
    Tree tree = test_grown_by(&params, spec);
    try_tree(&tree, model, name, facing, 61);
    tree_release(&tree);
}

static void holds_for_a_tree_of_least_volume(void **state)
{
    (void)state;
    try_grown("lambda 2", SCENE_ISOSURFACE, "disc:50", 2, false);
}

static void holds_for_a_tree_of_least_length(void **state)
{
    (void)state;
    try_grown("lambda 0", SCENE_ISOSURFACE, "disc:50", 0, false);
}

static void holds_for_a_tree_in_space(void **state)
{
    (void)state;
    try_grown("in space", SCENE_ISOSURFACE, "ball:28.794", 2, false);
}

static void holds_for_a_measured_tree(void **state)
{
    (void)state;
    const char *shared = getenv("CORCAST_SHARED");
    char path[4096];
    snprintf(path, sizeof path, "%s/data/brava/BG0002records.swc", shared ? shared : "../shared");
    if (access(path, R_OK) != 0) {
        fprintf(stderr, "  SKIPPED: %s is not here\n", path);
        skip();
    }
    Tree tree;
    assert_int_equal(tree_read(&tree, path, NULL), STATUS_OK);
    try_tree(&tree, SCENE_ISOSURFACE, "measured", false, 62);
    tree_release(&tree);
}

static void try_scenes(SceneModel model, int runs, uint64_t seed)
{
    Random random;
    random_seed(&random, seed);
    for (int kind = 0; kind < N_KINDS; kind++) {
        Tally tally = {.name = kind_names[kind]};
        for (int run = 0; run < (SHARE > 1 ? 3 : runs); run++) {
            TestScene test;
            make_test_scene((SceneKind)kind, &random, &test);
            test.geometry.model = model;
            try_cameras(&test.geometry, 8 / (SHARE > 1 ? 2 : 1), false, &random, &tally);
        }
        finish(&tally);
    }
}

/* Slow: of 22,000 rays, each is walked through by brute force, in long double. */
static void holds_for_adversarial_scenes(void **state)
{
    (void)state;
    try_scenes(SCENE_ISOSURFACE, 5, 63);
}

static void holds_for_blobs(void **state)
{
    (void)state;
    try_grown("lambda 2", SCENE_BLOB, "disc:50", 2, false);
    try_grown("in space", SCENE_BLOB, "ball:28.794", 2, false);
    try_scenes(SCENE_BLOB, 1, 68);
}

/* Square to a vessel just past its end a term all but attains the bounds of its peak and of its
 * window, half of what they are beside it. */
static void holds_for_rays_just_past_an_end(void **state)
{
    (void)state;
    TestScene test;
    Random random;
    random_seed(&random, 65);
    Tally tally = {.name = "past an end"};
    for (int run = 0; run < 6; run++) {
        memset(&test, 0, sizeof test);
        test.geometry.model = SCENE_ISOSURFACE;
        test.geometry.segments = test.segments;
        double radius = uniform(&random, 0.4, 1.7), per_k = radius / sqrt(2);
        Vec3 axis = random_direction(&random), side = random_normal_to(&random, axis);
        Vec3 end = random_point(&random, 3), d = vec3_cross(side, axis);
        put_segment(&test, end, vec3_add_scaled(end, axis, 30 * radius), radius);
        /* From the ridge of the bounds, E^2 = 2 - ln 2, inwards. */
        Vec3 target = vec3_add_scaled(end, axis, -0.012 * per_k);
        target = vec3_add_scaled(target, side, (sqrt(2 - log(2)) - 0.012) * per_k);
        const double distance = 40, width = 0.024 * per_k / distance;
        const Camera camera = {.projection = PROJECTION_PERSPECTIVE,
                               .location = vec3_add_scaled(target, d, -distance),
                               .direction = d,
                               .right = vec3_scale(axis, width),
                               .up = vec3_scale(side, width),
                               .width = 8,
                               .height = 8};
        Answer answer;
        Near near[1];
        for (int k = 0; k < kernels_usable(); k++) {
            ask(&test.geometry, &camera, k, &answer);
            for (int sample = 0; sample < TILE_SAMPLES; sample++)
                judge(&test.geometry, &camera, &answer, sample, NULL, near, &tally);
        }
    }
    finish(&tally);
}

/* The union over the nodes: of a chain of bends and steps from a tenth of its radius on, with
 * branches that leave it. */
static void holds_for_the_potential_of_the_graph(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 67);
    Tally tally = {.name = "graph"};
    for (int run = 0; run < (SHARE > 1 ? 1 : 4); run++) {
        Tree tree;
        Geometry geometry;
        const GeometryParams params = {.model = SCENE_ISOSURFACE, .graph = true};
        assert_int_equal(tree_init(&tree, 40, NULL), STATUS_OK);
        Vec3 direction = random_direction(&random);
        for (int i = 0; i < 40; i++) {
            int parent = i % 9 == 8 ? i / 2 : i - 1;
            tree.id[i] = i + 1;
            tree.parent[i] = parent;
            tree.radius_mm[i] = uniform(&random, 0.7, 1.3);
            direction = vec3_normalized(vec3_add_scaled(direction, random_direction(&random), 0.5));
            if (i > 0)
                tree.position[i] = vec3_add_scaled(tree.position[parent], direction,
                                                   pow(10, uniform(&random, -1, 0.7)));
        }
        assert_int_equal(stage_geometry(&tree, &params, &geometry, NULL, NULL), STATUS_OK);
        assert_true(geometry.blend.n_groups > 10);
        try_cameras(&geometry, 12 / (SHARE > 1 ? 2 : 1), false, &random, &tally);
        geometry_release(&geometry);
        tree_release(&tree);
    }
    finish(&tally);
}

static void holds_for_trees_in_a_disc_seen_face_on(void **state)
{
    (void)state;
    try_grown("lambda 2", SCENE_ISOSURFACE, "disc:50", 2, true);
    try_grown("lambda 0", SCENE_ISOSURFACE, "disc:50", 0, true);
}

/* The adversarial scenes pressed into a plane. */
static void holds_for_adversarial_scenes_in_a_plane(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 64);
    for (int kind = 0; kind < N_KINDS; kind++) {
        Tally tally = {.name = kind_names[kind]};
        for (int run = 0; run < (SHARE > 1 ? 3 : 5); run++) {
            TestScene test;
            make_test_scene((SceneKind)kind, &random, &test);
            double height = uniform(&random, -30, 30);
            for (size_t i = 0; i < test.geometry.n_segments; i++)
                test.segments[i].a.z = test.segments[i].b.z = height;
            try_cameras(&test.geometry, 8 / (SHARE > 1 ? 2 : 1), true, &random, &tally);
        }
        finish(&tally);
    }
}

static void scale_scene(TestScene *test, double scale)
{
    for (size_t i = 0; i < test->geometry.n_segments; i++) {
        FieldSegment *segment = &test->segments[i];
        segment->a = vec3_scale(segment->a, scale);
        segment->b = vec3_scale(segment->b, scale);
        segment->radius_mm *= scale;
    }
}

static void holds_at_every_scale(void **state)
{
    (void)state;
    const double scales[] = {1e-2, 1, 1e3};
    const char *const names[] = {"x 0.01", "x 1", "x 1000"};
    for (int i = 0; i < 3; i++) {
        Random random;
        random_seed(&random, 66);
        Tally tally = {.name = names[i]};
        for (int kind = 0; kind < N_KINDS; kind++) {
            TestScene test;
            make_test_scene((SceneKind)kind, &random, &test);
            scale_scene(&test, scales[i]);
            try_cameras(&test.geometry, 4, false, &random, &tally);
        }
        finish(&tally);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_for_a_tree_of_least_volume),
        cmocka_unit_test(holds_for_a_tree_of_least_length),
        cmocka_unit_test(holds_for_a_tree_in_space),
        cmocka_unit_test(holds_for_a_measured_tree),
        cmocka_unit_test(holds_for_adversarial_scenes),
        cmocka_unit_test(holds_for_blobs),
        cmocka_unit_test(holds_at_every_scale),
        cmocka_unit_test(holds_for_rays_just_past_an_end),
        cmocka_unit_test(holds_for_the_potential_of_the_graph),
        cmocka_unit_test(holds_for_trees_in_a_disc_seen_face_on),
        cmocka_unit_test(holds_for_adversarial_scenes_in_a_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
