/* Pictures drawn tile by tile in single precision. They equal the pictures of single rays in
 * double precision except for rounding, for any kernel and any number of threads, also where
 * single precision is not sufficient. */
#include "render/render.h"
#include "unit.h"

#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test_scene.h"

enum { WIDTH = 203, HEIGHT = 141, PIXELS = WIDTH * HEIGHT, N_TUBES = 60 };

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Vec3 point(Random *random, double size)
{
    double x = number(random, -size, size), y = number(random, -size, size);
    return vec3(x, y, number(random, -size, size));
}

enum { MOST_PRIMITIVES = 6 * N_TUBES + 8 };

typedef struct Staged {
    Primitive primitives[MOST_PRIMITIVES];
    Vec3 axes[2 * MOST_PRIMITIVES];
    Rgb colors[MOST_PRIMITIVES];
    Scene scene;
} Staged;

static Primitive *add(Staged *staged, PrimitiveKind kind, Vec3 a, Vec3 b, double radius)
{
    Scene *scene = &staged->scene;
    size_t number = scene->geometry.n_primitives++;
    Primitive *primitive = &staged->primitives[number];
    float shade = (float)(number + 1) / (3 * N_TUBES);
    staged->colors[number] = (Rgb){shade, 0.5f, 1 - shade};
    *primitive =
        (Primitive){.kind = kind, .a = a, .b = b, .radius_mm = radius, .segment = (uint32_t)number};
    return primitive;
}

/* Two cylinders and the joint between them, by the cut that makes their inner edges meet. */
static void add_elbow(Staged *staged, Random *random)
{
    Vec3 middle = point(random, 8), in = vec3_normalized(point(random, 1));
    Vec3 out = vec3_normalized(vec3_add_scaled(in, vec3_normalized(point(random, 1)), 1.1));
    double r_in = number(random, 0.1, 0.7), r_out = number(random, 0.1, r_in);
    double cosine = vec3_dot(in, out), sine = sqrt(1 - cosine * cosine);
    /* In terms of the axes that lead away from the place, of which the first is -in. */
    double cut_in = fmax(0, (r_out - r_in * cosine) / sine);
    double cut_out = fmax(0, (r_in - r_out * cosine) / sine);
    if (cut_in == 0)
        cut_out = r_in * sine;
    if (cut_out == 0)
        cut_in = r_out * sine;
    Vec3 a = vec3_add_scaled(middle, in, -cut_in * 1.0001);
    Vec3 b = vec3_add_scaled(middle, out, cut_out * 1.0001);
    add(staged, PRIMITIVE_CYLINDER, vec3_add_scaled(a, in, -number(random, 0.5, 4)), a, r_in);
    add(staged, PRIMITIVE_CYLINDER, b, vec3_add_scaled(b, out, number(random, 0.5, 4)), r_out);
    Primitive *joint = add(staged, PRIMITIVE_JOINT, a, b, r_in);
    Vec3 *axes = &staged->axes[2 * joint->segment];
    joint->radius_b_mm = r_out;
    joint->axes = axes;
    axes[0] = in;
    axes[1] = out;
}

static void set_camera(Scene *scene, Projection projection, Vec3 direction)
{
    Vec3 right = vec3_normalized(vec3_cross(direction, vec3(0.1, 1, 0)));
    Vec3 up = vec3_cross(right, direction);
    double height = 22, distance = 40;
    scene->view.camera = (Camera){.projection = projection,
                                  .direction = direction,
                                  .location = vec3_scale(direction, -distance),
                                  .width = WIDTH,
                                  .height = HEIGHT};
    if (projection == PROJECTION_PERSPECTIVE)
        height /= distance;
    scene->view.camera.right = vec3_scale(right, height * WIDTH / HEIGHT);
    scene->view.camera.up = vec3_scale(up, height);
}

static void bound(Scene *scene)
{
    scene->geometry.bounds = box_empty();
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &scene->geometry.primitives[i];
        scene->geometry.bounds =
            box_with_ball(scene->geometry.bounds, primitive->a, primitive->radius_mm);
        scene->geometry.bounds =
            box_with_ball(scene->geometry.bounds, primitive->b, primitive->radius_mm);
    }
}

/* Rounds one end, the other, both or none of the cylinders, in turn. */
static void round_ends(Staged *staged)
{
    Scene *scene = &staged->scene;
    size_t n = scene->geometry.n_primitives;
    for (size_t i = 0; i < n; i++) {
        Primitive *cylinder = &staged->primitives[i];
        if (cylinder->kind != PRIMITIVE_CYLINDER)
            continue;
        cylinder->round_a = i % 2;
        cylinder->round_b = i / 2 % 2;
        for (int end = 0; end < 2; end++) {
            if (!(end ? cylinder->round_b : cylinder->round_a))
                continue;
            Vec3 at = end ? cylinder->b : cylinder->a;
            Primitive *ball = add(staged, PRIMITIVE_SPHERE, at, at, cylinder->radius_mm);
            ball->segment = cylinder->segment;
            scene->geometry.n_ends++;
        }
    }
}

/* Elbows, spheres and cylinders thrown into a cube, of a fixed seed, under two lights. */
static void stage(Staged *staged, Projection projection)
{
    Random random;
    random_seed(&random, 2385);
    memset(staged, 0, sizeof *staged);
    Scene *scene = &staged->scene;
    scene->geometry.model = SCENE_JOINED;
    scene->geometry.primitives = staged->primitives;
    scene->geometry.ids = test_ids();
    scene->appearance.colors = staged->colors;
    for (int i = 0; i < N_TUBES / 2; i++) {
        add_elbow(staged, &random);
        Vec3 a = point(&random, 10);
        Vec3 b = vec3_add(a, point(&random, 2.5));
        add(staged, PRIMITIVE_SPHERE, a, a, number(&random, 0.05, 0.8));
        add(staged, PRIMITIVE_CYLINDER, a, b, number(&random, 0.02, 0.5));
    }
    round_ends(staged);
    light_test_scene(scene);
    set_camera(scene, projection, vec3_normalized(vec3(-0.3, -0.4, -1)));
    bound(scene);
}

typedef struct Settings {
    RenderMethod method;
    int threads, antialias;
    double threshold;
    bool shadows;
    RenderKernels kernels;
} Settings;

static Frame drawn(const Scene *scene, Settings settings)
{
    const RenderParams params = {.method = settings.method,
                                 .threads = settings.threads,
                                 .antialias = settings.antialias,
                                 .antialias_threshold = settings.threshold,
                                 .shadows = settings.shadows,
                                 .kernels = settings.kernels,
                                 .want_color = true,
                                 .want_depth = true,
                                 .want_normal = true,
                                 .want_id = true};
    Frame frame;
    assert_int_equal(render(scene, &params, &frame, NULL, NULL), STATUS_OK);
    return frame;
}

/* Of two frames: pixels that show other segments, and among the rest the largest differences. */
typedef struct Gap {
    int seen, ids;
    double depth, normal, color;
} Gap;

static Gap gap_of(const Frame *a, const Frame *b)
{
    Gap gap = {0};
    for (size_t i = 0; i < PIXELS; i++) {
        gap.seen += a->id.ids[i] != 0;
        if (a->id.ids[i] != b->id.ids[i]) {
            gap.ids++;
            continue;
        }
        for (size_t c = 0; c < 3; c++) {
            gap.normal =
                fmax(gap.normal,
                     fabs((double)(a->normal.values[3 * i + c] - b->normal.values[3 * i + c])));
            gap.color = fmax(
                gap.color, fabs((double)(a->color.values[3 * i + c] - b->color.values[3 * i + c])));
        }
        if (a->id.ids[i] != 0)
            gap.depth = fmax(gap.depth, fabs((double)(a->depth.values[i] - b->depth.values[i])));
        else
            assert_true(a->depth.values[i] == b->depth.values[i]);
    }
    return gap;
}

static Gap gap_to_trace(const Scene *scene)
{
    Frame traced = drawn(scene, (Settings){.method = RENDER_TRACE, .threads = 2, .antialias = 1});
    Frame tiles = drawn(scene, (Settings){.method = RENDER_RASTER, .threads = 2, .antialias = 1});
    Gap gap = gap_of(&traced, &tiles);
    frame_release(&traced);
    frame_release(&tiles);
    return gap;
}

static void tiles_show_what_rays_show(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        Gap gap = gap_to_trace(&staged.scene);
        printf("  %d seen, %d of other segments; depth %.1e mm, normal %.1e, color %.1e\n",
               gap.seen, gap.ids, gap.depth, gap.normal, gap.color);
        assert_true(gap.seen > 4000);
        assert_true(gap.ids <= 1);
        assert_true(gap.depth < 1e-4);
        assert_true(gap.normal < 5e-3);
        assert_true(gap.color < 2e-3);
    }
}

static void a_camera_among_the_vessels_sees_what_rays_see(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        staged.scene.view.camera.location = vec3(0.1, 0.2, 0.3);
        Gap gap = gap_to_trace(&staged.scene);
        assert_true(gap.seen > 1000);
        assert_true(gap.ids <= 2);
        assert_true(gap.depth < 1e-4);
    }
}

/* An empty scene of the usual look. */
static Scene *empty(Staged *staged, Projection projection)
{
    stage(staged, projection);
    staged->scene.geometry.n_primitives = staged->scene.geometry.n_ends = 0;
    return &staged->scene;
}

static void of_primitives_in_one_place_the_first_is_seen(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++)
        for (RenderMethod method = RENDER_TRACE; method <= RENDER_ZBUFFER; method++) {
            Staged staged;
            Scene *scene = empty(&staged, (Projection)projection);
            for (int i = 0; i < 3; i++) {
                add(&staged, PRIMITIVE_SPHERE, vec3(-4, 1, 2), vec3(-4, 1, 2), 2.385);
                add(&staged, PRIMITIVE_CYLINDER, vec3(2, -5, 1), vec3(5, 6, -3), 1.37);
            }
            bound(scene);
            Frame frame = drawn(scene, (Settings){.method = method, .threads = 2, .antialias = 1});
            int seen = 0;
            for (int i = 0; i < PIXELS; i++) {
                seen += frame.id.ids[i] != 0;
                assert_true(frame.id.ids[i] <= 2);
            }
            assert_true(seen > 1000);
            frame_release(&frame);
        }
}

static void joints_that_bound_no_solid_are_seen_from_both_sides(void **state)
{
    (void)state;
    Staged staged;
    stage(&staged, PROJECTION_ORTHOGRAPHIC);
    staged.scene.geometry.open_joints = true;
    size_t n = 0;
    for (size_t i = 0; i < staged.scene.geometry.n_primitives; i++)
        if (staged.primitives[i].kind == PRIMITIVE_JOINT)
            staged.primitives[n++] = staged.primitives[i];
    staged.scene.geometry.n_primitives = n;
    staged.scene.geometry.n_ends = 0;
    Gap gap = gap_to_trace(&staged.scene);
    assert_true(gap.seen > 300);
    assert_int_equal(gap.ids, 0);
    assert_true(gap.depth < 1e-5);
}

static void vessels_along_the_view_are_seen_end_on(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        Scene *scene = &staged.scene;
        scene->geometry.n_primitives = scene->geometry.n_ends = 0;
        for (int i = 0; i < 20; i++) {
            Vec3 a =
                vec3_add_scaled(vec3(i - 10, 0.3 * i - 3, 0), scene->view.camera.direction, -3);
            Vec3 lean = vec3(i % 4 ? pow(10, -i / 3.0) : 0, 0, 0);
            Vec3 along = vec3_normalized(vec3_add(scene->view.camera.direction, lean));
            add(&staged, PRIMITIVE_CYLINDER, a, vec3_add_scaled(a, along, 9), 0.43);
        }
        round_ends(&staged);
        bound(scene);
        Gap gap = gap_to_trace(scene);
        assert_true(gap.seen > 200);
        assert_true(gap.ids <= 1);
        assert_true(gap.depth < 1e-4);
    }
}

static void assert_same_frames(const Frame *a, const Frame *b)
{
    assert_memory_equal(a->color.values, b->color.values, 3 * PIXELS * sizeof(float));
    assert_memory_equal(a->depth.values, b->depth.values, PIXELS * sizeof(float));
    assert_memory_equal(a->normal.values, b->normal.values, 3 * PIXELS * sizeof(float));
    assert_memory_equal(a->id.ids, b->id.ids, PIXELS * sizeof(uint32_t));
}

static void tiles_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    const Settings cases[] = {
        {.method = RENDER_RASTER, .threads = 1, .antialias = 1},
        {.method = RENDER_RASTER, .threads = 1, .antialias = 2, .shadows = true},
        {.method = RENDER_RASTER, .threads = 1, .antialias = 3, .threshold = 0.05}};
    for (int projection = 0; projection < 2; projection++)
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            Staged staged;
            stage(&staged, (Projection)projection);
            Frame one = drawn(&staged.scene, cases[i]);
            for (int threads = 2; threads <= 7; threads += 5) {
                Settings settings = cases[i];
                settings.threads = threads;
                Frame many = drawn(&staged.scene, settings);
                assert_same_frames(&one, &many);
                frame_release(&many);
            }
            frame_release(&one);
        }
}

static void bands_are_the_rows_of_the_whole(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        Frame whole = drawn(
            &staged.scene,
            (Settings){.method = RENDER_RASTER, .threads = 2, .antialias = 2, .threshold = 0.05});
        const RenderParams params = {.method = RENDER_RASTER,
                                     .threads = 2,
                                     .antialias = 2,
                                     .antialias_threshold = 0.05,
                                     .want_color = true,
                                     .want_depth = true};
        Renderer *renderer;
        assert_int_equal(renderer_new(&staged.scene.geometry, &params, &renderer, NULL), STATUS_OK);
        for (int first = 0, rows; first < HEIGHT; first += rows) {
            Frame band;
            rows = first + 24 < HEIGHT ? 24 : HEIGHT - first;
            assert_int_equal(renderer_rows(renderer, &staged.scene.view, &staged.scene.appearance,
                                           first, rows, &band, NULL),
                             STATUS_OK);
            size_t start = (size_t)first * WIDTH, n = (size_t)rows * WIDTH;
            assert_memory_equal(band.color.values, whole.color.values + 3 * start,
                                3 * n * sizeof(float));
            assert_memory_equal(band.depth.values, whole.depth.values + start, n * sizeof(float));
            frame_release(&band);
        }
        renderer_free(renderer);
        frame_release(&whole);
    }
}

static void antialiased_tiles_are_what_antialiased_rays_are(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++)
        for (int n = 2; n <= 3; n++) {
            Staged staged;
            stage(&staged, (Projection)projection);
            double threshold = n == 3 ? 0.05 : 0;
            Frame traced = drawn(&staged.scene, (Settings){.method = RENDER_TRACE,
                                                           .threads = 2,
                                                           .antialias = n,
                                                           .threshold = threshold});
            Frame tiles = drawn(&staged.scene, (Settings){.method = RENDER_RASTER,
                                                          .threads = 2,
                                                          .antialias = n,
                                                          .threshold = threshold});
            int different = 0;
            for (size_t i = 0; i < 3 * (size_t)PIXELS; i++)
                different += fabs((double)(traced.color.values[i] - tiles.color.values[i])) > 2e-3;
            assert_true(different <= 9);
            frame_release(&traced);
            frame_release(&tiles);
        }
}

static void codes_of_tiles_are_those_of_their_colors(void **state)
{
    (void)state;
    Staged staged;
    stage(&staged, PROJECTION_PERSPECTIVE);
    for (int kind = 0; kind < kernels_usable(); kind++) {
        const Settings settings = {.method = RENDER_RASTER,
                                   .threads = 2,
                                   .antialias = 1,
                                   .shadows = true,
                                   .kernels = (RenderKernels)(KERNELS_PORTABLE + kind)};
        Frame colors = drawn(&staged.scene, settings), codes;
        const RenderParams params = {.method = settings.method,
                                     .threads = settings.threads,
                                     .antialias = settings.antialias,
                                     .shadows = settings.shadows,
                                     .kernels = settings.kernels,
                                     .codes_suffice = true,
                                     .want_color = true};
        assert_int_equal(render(&staged.scene, &params, &codes, NULL, NULL), STATUS_OK);
        assert_non_null(codes.codes.codes8);
        for (size_t i = 0; i < 3 * (size_t)PIXELS; i++)
            assert_int_equal(codes.codes.codes8[i],
                             image_code(colors.color.values[i], ENCODING_SRGB, 8));
        frame_release(&colors);
        frame_release(&codes);
    }
}

static void shadows_of_tiles_are_shadows_of_rays(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++)
        for (int near = 0; near < 2; near++) {
            Staged staged;
            stage(&staged, (Projection)projection);
            if (near) /* too near for a view of its own */
                staged.scene.view.lights[1].location = vec3(1, 2, 11);
            Frame lit = drawn(&staged.scene,
                              (Settings){.method = RENDER_TRACE, .threads = 2, .antialias = 1});
            Frame traced = drawn(
                &staged.scene,
                (Settings){.method = RENDER_TRACE, .threads = 2, .antialias = 1, .shadows = true});
            Frame tiles = drawn(
                &staged.scene,
                (Settings){.method = RENDER_RASTER, .threads = 2, .antialias = 1, .shadows = true});
            int dark = 0, different = 0;
            for (size_t i = 0; i < 3 * (size_t)PIXELS; i++) {
                dark += lit.color.values[i] - traced.color.values[i] > 0.01f;
                different += fabs((double)(traced.color.values[i] - tiles.color.values[i])) > 2e-3;
            }
            printf("  %d in shadow, %d different\n", dark, different);
            assert_true(dark > 400);
            assert_true(different <= 9);
            frame_release(&lit);
            frame_release(&traced);
            frame_release(&tiles);
        }
}

/* Whether the pixel and its neighbours show the same. */
static bool inside(const IdPlane *ids, int pixel)
{
    int x = pixel % WIDTH, y = pixel / WIDTH;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < HEIGHT; j++)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < WIDTH; i++)
            if (ids->ids[j * WIDTH + i] != ids->ids[pixel])
                return false;
    return true;
}

/* 0.177 pixels, within which a pixel's point lies, are this much in space. */
static double caught_mm(const Scene *scene)
{
    double pixel = vec3_length(scene->view.camera.up) / HEIGHT;
    return 0.177 * pixel * (scene->view.camera.projection == PROJECTION_PERSPECTIVE ? 55 : 1);
}

static void a_depth_buffer_of_points_has_no_holes(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        Frame points = drawn(&staged.scene,
                             (Settings){.method = RENDER_ZBUFFER, .threads = 2, .antialias = 1});
        Frame tiles =
            drawn(&staged.scene, (Settings){.method = RENDER_RASTER, .threads = 2, .antialias = 1});
        double caught = caught_mm(&staged.scene);
        int seen = 0, more = 0, others = 0;
        for (int i = 0; i < PIXELS; i++) {
            seen += tiles.id.ids[i] != 0;
            /* What tiles see at the middle of the pixel has a point in it that is not much
             * farther. */
            if (tiles.id.ids[i] != 0)
                assert_true((double)points.depth.values[i] <=
                            (double)tiles.depth.values[i] + caught);
            more += tiles.id.ids[i] == 0 && points.id.ids[i] != 0;
            others += points.id.ids[i] != tiles.id.ids[i] && inside(&tiles.id, i);
        }
        printf("  %d seen by tiles, %d more by points; inside %d other ids\n", seen, more, others);
        assert_true(seen > 4000);
        assert_true(more < seen / 10); /* outlines are 0.177 pixels farther out */
        assert_true(others <= seen / 500);
        frame_release(&points);
        frame_release(&tiles);
    }
}

/* What a hair along a row shows of the pixel in whose middle's column it begins, from `off` pixels
 * beside that middle. */
static bool is_caught(double off)
{
    Staged staged;
    Scene *scene = empty(&staged, PROJECTION_ORTHOGRAPHIC);
    set_camera(scene, PROJECTION_ORTHOGRAPHIC, vec3(0, 0, -1));
    const Camera *camera = &scene->view.camera;
    double pixel = vec3_length(camera->up) / HEIGHT;
    Ray ray = camera_ray(camera, 100, 70);
    Vec3 along = vec3_normalized(camera->right), down = vec3_scale(camera->up, -off / HEIGHT);
    Vec3 a = vec3_add(vec3_add_scaled(ray.origin, ray.direction, 20), down);
    add(&staged, PRIMITIVE_CYLINDER, a, vec3_add_scaled(a, along, 30.2 * pixel), 1e-7);
    bound(scene);
    Frame frame = drawn(scene, (Settings){.method = RENDER_ZBUFFER, .threads = 2, .antialias = 1});
    bool caught = frame.id.ids[70 * WIDTH + 100] != 0;
    frame_release(&frame);
    return caught;
}

static void a_point_counts_within_0177_pixels_of_the_middle(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        assert_true(is_caught(side * 0.1765));
        assert_false(is_caught(side * 0.1775));
    }
}

static void a_depth_buffer_does_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    Staged staged;
    stage(&staged, PROJECTION_PERSPECTIVE);
    Frame one =
        drawn(&staged.scene, (Settings){.method = RENDER_ZBUFFER, .threads = 1, .antialias = 1});
    Frame three =
        drawn(&staged.scene, (Settings){.method = RENDER_ZBUFFER, .threads = 3, .antialias = 1});
    assert_same_frames(&one, &three);
    frame_release(&one);
    frame_release(&three);
    staged.scene.view.camera.location = vec3(0.1, 0.2, 0.3);
    const RenderParams params = {.method = RENDER_ZBUFFER, .antialias = 1, .want_color = true};
    Err err;
    assert_int_equal(render(&staged.scene, &params, &one, NULL, &err), STATUS_USAGE);
}

/* Also those of lesser processors than this one. */
static void every_kind_of_kernels_draws_what_rays_draw(void **state)
{
    (void)state;
    const int kinds = kernels_usable();
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        Frame traced = drawn(
            &staged.scene,
            (Settings){.method = RENDER_TRACE, .threads = 2, .antialias = 1, .shadows = true});
        for (int kind = 0; kind < kinds; kind++) {
            Frame tiles = drawn(&staged.scene,
                                (Settings){.method = RENDER_RASTER,
                                           .threads = 2,
                                           .antialias = 1,
                                           .shadows = true,
                                           .kernels = (RenderKernels)(KERNELS_PORTABLE + kind)});
            Gap gap = gap_of(&traced, &tiles);
            int different = 0;
            for (size_t i = 0; i < 3 * (size_t)PIXELS; i++)
                different += fabs((double)(traced.color.values[i] - tiles.color.values[i])) > 2e-3;
            assert_true(gap.seen > 4000);
            assert_true(gap.ids <= 1);
            assert_true(gap.depth < 1e-4);
            assert_true(gap.normal < 5e-3);
            assert_true(different <= 9);
            frame_release(&tiles);
        }
        frame_release(&traced);
    }
}

/* Whether the row's entry of an item has the column, and there a box that holds the place, in parts
 * of the tile from the left and the top, and a depth before it. */
static bool entry_holds(const RasterBins *bins, int row, uint32_t item, int column,
                        const double part[2], double z)
{
    for (size_t i = bins->row_offsets[row]; i < bins->row_offsets[row + 1]; i++) {
        const RasterTiles span = bins->row_columns[i];
        const RasterBox *box = &bins->row_boxes[i];
        if (bins->row_items[i] != item)
            continue;
        double high[2] = {box->box & 127, box->box >> 16 & 127};
        double low[2] = {127 - (box->box >> 8 & 127), 127 - (box->box >> 24 & 127)};
        return span.first <= column && column <= span.last && box->near <= (float)z &&
               (column > span.first || low[0] <= part[0]) &&
               (column < span.last || part[0] < high[0] + 1) && low[1] <= part[1] &&
               part[1] < high[1] + 1;
    }
    return false;
}

static void boxes_hold_the_axes_of_vessels(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Staged staged;
        stage(&staged, (Projection)projection);
        RasterView view =
            rasterview_of_camera(&staged.scene.view.camera, staged.scene.geometry.bounds, 2);
        view.light = true;
        view.listed_columns = (TileSpan){0, (WIDTH - 1) / TILE_SIDE};
        view.listed_rows = (TileSpan){0, (HEIGHT - 1) / TILE_SIDE};
        RasterBins *bins;
        assert_int_equal(rasterbins_new(&staged.scene.geometry, &view, 2, &bins, NULL), STATUS_OK);
        int held = 0;
        for (uint32_t i = 0; i < rasterbins_items(bins->geometry); i++)
            for (int step = 0; step <= 8; step++) {
                const Primitive *primitive = &staged.scene.geometry.primitives[i];
                Vec3 span = vec3_sub(primitive->b, primitive->a);
                Vec3 at = vec3_add_scaled(primitive->a, span, step / 8.0);
                at = viewpoint_frame_point(&view.eye, at);
                double depth = view.eye.perspective ? at.z : 1;
                double x = ((at.x / depth - view.left) / view.step_x + 0.5) / TILE_SIDE;
                double y = ((at.y / depth - view.top) / view.step_y + 0.5) / TILE_SIDE;
                if (at.z <= 0 || x < 0 || x >= WIDTH / TILE_SIDE || y < 0 ||
                    y >= HEIGHT / TILE_SIDE)
                    continue;
                double part[2] = {(x - (int)x) * RASTERBOX_PARTS, (y - (int)y) * RASTERBOX_PARTS};
                assert_true(entry_holds(bins, (int)y, i, (int)x, part, at.z - view.z_middle));
                held++;
            }
        assert_true(held > 500);
        rasterbins_free(bins);
    }
}

/* Whether a sample of a picture of 40 x 30 pixels of 0.1 mm, the first at the origin, is within a
 * capsule. */
static bool sees_capsule(Vec3 middle, Vec3 span, double radius)
{
    double length2 = span.x * span.x + span.y * span.y;
    for (int j = 0; j < 30; j++)
        for (int i = 0; i < 40; i++) {
            double dx = 0.1 * i - middle.x, dy = -0.1 * j - middle.y;
            double part = length2 > 0 ? (dx * span.x + dy * span.y) / length2 : 0;
            part = fmin(fmax(part, -0.5), 0.5);
            if (hypot(dx - part * span.x, dy - part * span.y) <= radius)
                return true;
        }
    return false;
}

static void of_many_thin_capsules_those_that_no_sample_sees_are_left_out(void **state)
{
    (void)state;
    RasterView view = {.step_x = 0.1,
                       .step_y = -0.1,
                       .per_x = 1 / 0.1,
                       .per_y = 1 / -0.1,
                       .columns = 40,
                       .rows = 30,
                       .many = true};
    Random random;
    random_seed(&random, 51);
    int missed = 0, found = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3 middle = {number(&random, -0.3, 4.3), number(&random, -3.3, 0.3), 7.1};
        Vec3 span = vec3_scale(point(&random, 0.09), i % 20 ? 1 : 0);
        double radius = number(&random, 0.003, 0.06);
        bool misses = rasterreach_misses(&view, middle, span, radius);
        bool seen = sees_capsule(middle, span, radius);
        assert_false(misses && seen);
        missed += !seen;
        found += misses;
    }
    assert_true(missed > 5000 && found > 0.98 * missed);
    view.max_offset = 0.5;
    assert_false(rasterreach_misses(&view, vec3(1.05, -1.05, 0), vec3(0, 0, 1), 0.01));
    view.max_offset = 0;
    assert_true(rasterreach_misses(&view, vec3(1.05, -1.05, 0), vec3(0, 0, 1), 0.01));
}

/* Points of a capsule's axis, moved by its radius whichever way, that lie before the eye in the
 * tiles of a perspective view. */
static bool tiles_see_capsule(const RasterView *view, Random *random, Vec3 middle, Vec3 span,
                              double radius)
{
    for (int i = 0; i < 64; i++) {
        Vec3 at = vec3_add_scaled(middle, span, number(random, -0.5, 0.5));
        at = vec3_add_scaled(at, vec3_normalized(point(random, 1)), radius);
        double i_at = (at.x / at.z - view->left) / view->step_x;
        double j_at = (at.y / at.z - view->top) / view->step_y;
        if (at.z > 0 && i_at >= view->listed_columns.first * TILE_SIDE - 0.5 &&
            i_at < (view->listed_columns.last + 1) * TILE_SIDE - 0.5 &&
            j_at >= view->listed_rows.first * TILE_SIDE - 0.5 &&
            j_at < (view->listed_rows.last + 1) * TILE_SIDE - 0.5)
            return true;
    }
    return false;
}

static void in_perspective_capsules_beside_the_tiles_are_left_out(void **state)
{
    (void)state;
    const RasterView view = {.eye.perspective = true,
                             .left = -0.7,
                             .top = 0.6,
                             .step_x = 0.017,
                             .step_y = -0.019,
                             .columns = 80,
                             .rows = 80,
                             .listed_columns = {2, 5},
                             .listed_rows = {3, 9}};
    Random random;
    random_seed(&random, 57);
    int left_out = 0;
    for (int i = 0; i < 20000; i++) {
        double z = number(&random, -1, 9);
        Vec3 middle = {number(&random, -1.3, 1.3) * z, number(&random, -1.3, 1.3) * z, z};
        Vec3 span = point(&random, 0.9);
        double radius = number(&random, 0.003, 0.3);
        bool misses = rasterreach_misses(&view, middle, span, radius);
        assert_false(misses && tiles_see_capsule(&view, &random, middle, span, radius));
        left_out += misses;
    }
    assert_true(left_out > 8000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_show_what_rays_show),
        cmocka_unit_test(a_camera_among_the_vessels_sees_what_rays_see),
        cmocka_unit_test(of_primitives_in_one_place_the_first_is_seen),
        cmocka_unit_test(joints_that_bound_no_solid_are_seen_from_both_sides),
        cmocka_unit_test(vessels_along_the_view_are_seen_end_on),
        cmocka_unit_test(tiles_do_not_depend_on_the_number_of_threads),
        cmocka_unit_test(bands_are_the_rows_of_the_whole),
        cmocka_unit_test(antialiased_tiles_are_what_antialiased_rays_are),
        cmocka_unit_test(codes_of_tiles_are_those_of_their_colors),
        cmocka_unit_test(shadows_of_tiles_are_shadows_of_rays),
        cmocka_unit_test(a_depth_buffer_of_points_has_no_holes),
        cmocka_unit_test(a_point_counts_within_0177_pixels_of_the_middle),
        cmocka_unit_test(a_depth_buffer_does_not_depend_on_the_number_of_threads),
        cmocka_unit_test(every_kind_of_kernels_draws_what_rays_draw),
        cmocka_unit_test(boxes_hold_the_axes_of_vessels),
        cmocka_unit_test(of_many_thin_capsules_those_that_no_sample_sees_are_left_out),
        cmocka_unit_test(in_perspective_capsules_beside_the_tiles_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
