/* Vessels thinner than a pixel cover their exact area. */
#include "render/render.h"
#include "render/thin/thinvessels.h"
#include "unit.h"

#include "test_grow.h"
#include "test_scene.h"
#include "test_stage.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, FINER = 16 };
/* One pixel is so wide: the picture is 16 mm. */
#define PIXEL_MM (16.0 / SIDE)

static Err err;

/* Parallel to the picture, looked at along -z, from white paper; vessels are black, and alike from
 * all sides. */
static void look_at_paper(Scene *scene, Primitive *primitives, size_t n, int side)
{
    *scene = (Scene){.geometry = {.model = SCENE_CYLINDERS,
                                  .primitives = primitives,
                                  .n_primitives = n,
                                  .ids = test_ids(),
                                  .n_ids = MOST_TEST_IDS,
                                  .drawn = n,
                                  .bounds = {{-9, -9, -9}, {9, 9, 9}}},
                     .view = {.camera = {.location = {0, 0, 20},
                                         .right = {16, 0, 0},
                                         .up = {0, 16, 0},
                                         .direction = {0, 0, -1},
                                         .width = side,
                                         .height = side},
                              .background = {1, 1, 1}},
                     .appearance = {.finish = {.ambient = 1, .brilliance = 1, .roughness = 0.05f}}};
}

static Primitive vessel(Vec3 a, Vec3 b, double radius_mm, uint32_t segment)
{
    return (Primitive){PRIMITIVE_CYLINDER, .a = a,         .b = b,        .radius_mm = radius_mm,
                       .segment = segment, .free_a = true, .free_b = true};
}

static Frame drawn(Scene *scene, bool cover, double min_width_px, int antialias, int threads)
{
    Frame frame;
    const RenderParams params = {.method = RENDER_FASTEST,
                                 .threads = threads,
                                 .antialias = antialias,
                                 .cover_thin = cover,
                                 .min_width_px = min_width_px,
                                 .want_color = true};
    assert_int_equal(render(scene, &params, &frame, NULL, &err), STATUS_OK);
    return frame;
}

/* How many pixels are black, in parts of pixels. */
static double ink(const Frame *frame)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
        sum += 1 - (double)frame->color.values[3 * i];
    return sum;
}

static double ink_of(Primitive *primitives, size_t n, double min_width_px)
{
    Scene scene;
    look_at_paper(&scene, primitives, n, SIDE);
    Frame frame = drawn(&scene, true, min_width_px, 1, 1);
    double sum = ink(&frame);
    frame_release(&frame);
    return sum;
}

/* A wide vessel beyond the right edge of the picture. */
static Primitive trunk(void)
{
    return vessel(vec3(12, -3, 0), vec3(12, 3, 0), 1.5, 0);
}

static void covers_the_area_of_its_projection_wherever_it_lies(void **state)
{
    (void)state;
    for (int k = 0; k < 23; k++) {
        double turn = 0.277 * k, width_px = 0.05 + 0.04 * k;
        Vec3 a = vec3(0.17 * k - 2, 1.3 - 0.11 * k, 2);
        Vec3 b = vec3_add(a, vec3(3.7 * cos(turn), 3.7 * sin(turn), 1));
        Primitive vessels[] = {trunk(), vessel(a, b, width_px * PIXEL_MM / 2, 1)};
        double ends = 0.785398 * width_px * width_px / hypot(3.7, 1);
        assert_true(fabs(ink_of(vessels, 2, 0) - 3.7 / PIXEL_MM * width_px - ends) < 2e-3);
    }
}

static void covers_as_much_in_pieces_as_in_one(void **state)
{
    (void)state;
    enum { PIECES = 97 };
    Primitive vessels[1 + PIECES] = {trunk()};
    Vec3 a = vec3(-4.1, -2.3, 0), step = vec3(0.07, 0.03, 0);
    for (uint32_t k = 0; k < PIECES; k++)
        vessels[1 + k] = vessel(vec3_add_scaled(a, step, k), vec3_add_scaled(a, step, k + 1.0),
                                0.45 * PIXEL_MM, k + 1);
    double length = PIECES * vec3_length(step) / PIXEL_MM;
    assert_true(fabs(ink_of(vessels, 1 + PIECES, 0) - 0.9 * length) < 0.01 * length);
}

/* One run of 50,000 vessels behind the trunk, and a vessel apart from it. */
static void vessels_end_to_end_are_one_run_however_many_they_are(void **state)
{
    (void)state;
    enum { PIECES = 50000, N = PIECES + 2 };
    Primitive *vessels = calloc(N, sizeof *vessels);
    assert_non_null(vessels);
    vessels[0] = trunk();
    for (uint32_t k = 0; k < PIECES; k++)
        vessels[1 + k] =
            vessel(vec3(k * 1e-4, 0, 0), vec3((k + 1) * 1e-4, 0, 0), 0.1 * PIXEL_MM, k + 1);
    vessels[N - 1] = vessel(vec3(-2, -3, 0), vec3(-1, -3, 0), 0.1 * PIXEL_MM, N - 1);
    Scene scene;
    look_at_paper(&scene, vessels, N, SIDE);
    for (int threads = 1; threads <= 3; threads += 2) {
        ThinVessels thin;
        assert_int_equal(thinvessels_find(&scene.geometry, &scene.view.camera, (ThinWidths){1, 0},
                                          threads, &thin, &err),
                         STATUS_OK);
        const ThinStrip *strips = thin.layer.strips;
        assert_int_equal(thin.layer.n, PIECES + 1);
        for (size_t i = 0; i < PIECES; i++) {
            assert_int_equal(strips[i].vessel, i + 1);
            assert_int_equal(strips[i].run, 1);
        }
        assert_int_equal(strips[PIECES].run, N - 1);
        assert_false(thin.layer.is_thin[0]);
        thinvessels_release(&thin);
    }
    free(vessels);
}

/* At a bend both vessels of a run lie in one cell, and more than fills it. */
static void covers_no_more_than_a_cell_at_a_bend(void **state)
{
    (void)state;
    for (int k = 0; k < 60; k++) {
        const double turn = 0.04 * k;
        const Vec3 bend = vec3(0.013 * k, 0.031 * k - 1, 0);
        Primitive vessels[] = {vessel(vec3_add(bend, vec3(-3, 0, 0)), bend, 0.49 * PIXEL_MM, 1),
                               vessel(bend, vec3_add(bend, vec3(3 * cos(turn), 3 * sin(turn), 0)),
                                      0.49 * PIXEL_MM, 2)};
        Scene scene;
        look_at_paper(&scene, vessels, 2, SIDE);
        Frame frame = drawn(&scene, true, 0, 1, 1);
        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
            assert_true(frame.color.values[3 * i] > -1e-5F);
        frame_release(&frame);
    }
}

static void hides_behind_what_is_thicker(void **state)
{
    (void)state;
    Primitive wall = vessel(vec3(-3, 0, 0), vec3(3, 0, 0), 2, 0);
    Primitive before[] = {wall, vessel(vec3(-2, 1, 3), vec3(2, 1, 3), 0.2 * PIXEL_MM, 1)};
    Primitive behind[] = {wall, vessel(vec3(-2, 1, -3), vec3(2, 1, -3), 0.2 * PIXEL_MM, 1)};
    Rgb colors[] = {{0.5f, 0.5f, 0.5f}, {0, 0, 0}};
    double sums[3];
    for (int k = 0; k < 3; k++) {
        Scene scene;
        look_at_paper(&scene, k == 1 ? before : behind, k ? 2 : 1, SIDE);
        scene.appearance.colors = colors;
        Frame frame = drawn(&scene, true, 0, 1, 1);
        sums[k] = ink(&frame);
        frame_release(&frame);
    }
    assert_true(sums[1] > sums[0] + 0.19 * 4 / PIXEL_MM);
    assert_true(sums[2] == sums[0]);
}

static void is_drawn_as_wide_as_is_asked_for(void **state)
{
    (void)state;
    Primitive vessels[] = {trunk(), vessel(vec3(-4, -1, 0), vec3(3, 2, 0), 0.1 * PIXEL_MM, 1)};
    double length = sqrt(58) / PIXEL_MM;
    assert_true(fabs(ink_of(vessels, 2, 0.75) - 0.75 * length) < 1e-3 * length);
    assert_true(fabs(ink_of(vessels, 2, 2.25) - 2.25 * length) < 0.02 * length);
}

/* The light stands behind the viewer. A highlight as narrow as this is at the middle one of the
 * normals alone, and the color is the mean of all. */
static void is_shaded_at_five_normals(void **state)
{
    (void)state;
    Primitive one = vessel(vec3(-9, 0.1, 0), vec3(9, 0.1, 0), 0.2 * PIXEL_MM, 1);
    Scene scene;
    look_at_paper(&scene, &one, 1, SIDE);
    scene.appearance.color = (Rgb){1, 1, 1};
    scene.appearance.finish = (Finish){.phong = 1, .phong_size = 5000, .brilliance = 1};
    scene.view.n_lights = 1;
    scene.view.lights[0] = (Light){.location = {0, 0, 1e7}, .color = {1, 1, 1}};
    Frame frame = drawn(&scene, true, 0, 1, 1);
    assert_true(fabs(ink(&frame) - 0.4 * SIDE * (1 - 1.0 / 5)) < 1e-3 * SIDE);
    frame_release(&frame);
}

static void has_a_color_of_its_own_each_pixel_and_a_half(void **state)
{
    (void)state;
    for (int pieces = 1; pieces <= 30; pieces++)
        for (int more = 0; more < 2; more++) {
            const double length = (1.5 * pieces + (more ? 0.01 : -0.01)) * PIXEL_MM;
            Primitive one = vessel(vec3(-5, 1, 0), vec3(length - 5, 1, 0), 0.2 * PIXEL_MM, 1);
            Scene scene;
            ThinVessels thin;
            look_at_paper(&scene, &one, 1, SIDE);
            assert_int_equal(thinvessels_find(&scene.geometry, &scene.view.camera,
                                              (ThinWidths){1, 0}, 1, &thin, &err),
                             STATUS_OK);
            assert_int_equal(thin.layer.n, 1);
            assert_int_equal(thin.layer.strips[0].n_pieces, pieces + more);
            thinvessels_release(&thin);
        }
}

/* Returns which part of a vessel's ink a wall leaves. The wall is white, and its front at y = 0 is
 * at z = `front`. */
static double part_before_a_wall(Primitive one, double front, Projection projection)
{
    Primitive vessels[] = {one, vessel(vec3(-200, 0, front - 60), vec3(200, 0, front - 60), 60, 2)};
    Rgb colors[3] = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}};
    double sums[2];
    for (size_t walls = 0; walls < 2; walls++) {
        Scene scene;
        look_at_paper(&scene, vessels, 1 + walls, SIDE);
        scene.geometry.bounds = (Box){{-200, -60, -120}, {200, 60, 20}};
        scene.appearance.colors = colors;
        if (projection == PROJECTION_PERSPECTIVE) {
            scene.view.camera.projection = projection;
            scene.view.camera.right = vec3(1, 0, 0);
            scene.view.camera.up = vec3(0, 1, 0);
        }
        Frame frame = drawn(&scene, true, 0, 1, 1);
        sums[walls] = ink(&frame);
        frame_release(&frame);
    }
    return sums[1] / sums[0];
}

/* Each vessel goes through a wall, seen from its near end to its far one and the other way round.
 * The expected parts are those of its length in the picture, by the ratio of x to depth: the camera
 * is at z = 20. Vessels end in the picture, or beyond both of its edges. */
static void goes_into_a_wall_where_it_is_as_deep(void **state)
{
    (void)state;
    static const struct {
        Projection projection;
        double radius, front, part;
        Vec3 near, far;
    } cases[] = {
        {PROJECTION_ORTHOGRAPHIC, 0.05, 0, 0.25, {-4, 0, 1}, {4, 0, -3}},
        {PROJECTION_ORTHOGRAPHIC, 0.05, 0, 0.75, {-16, 0, 5}, {16, 0, -3}},
        {PROJECTION_PERSPECTIVE, 0.01, 0, 0.857, {-2, 0, 15}, {16, 0, -20}},
        {PROJECTION_PERSPECTIVE, 0.01, 8.257, 0.75, {-4, 0, 15}, {32, 0, -20}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turned = 0; turned < 2; turned++) {
            Primitive one = vessel(turned ? cases[i].far : cases[i].near,
                                   turned ? cases[i].near : cases[i].far, cases[i].radius, 1);
            double part = part_before_a_wall(one, cases[i].front, cases[i].projection);
            if (fabs(part - cases[i].part) > 0.02)
                fail_msg("case %zu, turned %d: %g is before the wall, not %g", i, turned, part,
                         cases[i].part);
        }
}

enum { CROWD = 250 };

static void throw_vessels(Primitive vessels[CROWD])
{
    Random random;
    random_seed(&random, 2385);
    for (uint32_t i = 0; i < CROWD; i++) {
        Vec3 a = vec3(14 * random_uniform(&random) - 7, 14 * random_uniform(&random) - 7,
                      6 * random_uniform(&random));
        double turn = 6.283 * random_uniform(&random);
        vessels[i] = vessel(a, vec3_add(a, vec3(1.1 * cos(turn), 1.1 * sin(turn), 0.3)),
                            PIXEL_MM * (0.04 + 0.3 * random_uniform(&random)), i);
    }
    vessels[0].radius_mm = 2 * PIXEL_MM;
}

/* The root mean square distance of a picture from the mean of the pixels that a finer one has in
 * its place. */
static double distance_from(const Frame *frame, const Frame *fine)
{
    double sum = 0;
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            double mean = 0;
            for (size_t k = 0; k < FINER * FINER; k++)
                mean += (double)fine->color.values[3 * ((y * FINER + k / FINER) * SIDE * FINER +
                                                        x * FINER + k % FINER)];
            mean /= FINER * FINER;
            double off = (double)frame->color.values[3 * (y * SIDE + x)] - mean;
            sum += off * off;
        }
    return sqrt(sum / (SIDE * SIDE));
}

static void is_nearer_to_the_mean_of_many_samples_than_ten_samples_are(void **state)
{
    (void)state;
    Primitive vessels[CROWD];
    Scene scene, fine_scene;
    throw_vessels(vessels);
    look_at_paper(&scene, vessels, CROWD, SIDE);
    look_at_paper(&fine_scene, vessels, CROWD, SIDE * FINER);
    Frame fine = drawn(&fine_scene, false, 0, 1, 2);
    Frame covered = drawn(&scene, true, 0, 3, 2), sampled = drawn(&scene, false, 0, 3, 2);
    double by_cover = distance_from(&covered, &fine), by_samples = distance_from(&sampled, &fine);
    print_message("off by %.4f, samples by %.4f\n", by_cover, by_samples);
    assert_true(by_cover < 0.02 && by_samples > 2.5 * by_cover);
    frame_release(&fine);
    frame_release(&covered);
    frame_release(&sampled);
}

static void has_the_same_bytes_whatever_threads_and_bands(void **state)
{
    (void)state;
    Primitive vessels[CROWD];
    Scene scene;
    Renderer *renderer;
    throw_vessels(vessels);
    look_at_paper(&scene, vessels, CROWD, SIDE);
    light_test_scene(&scene);
    scene.appearance.color = (Rgb){0.6f, 0.3f, 0.2f};
    Frame whole = drawn(&scene, true, 0, 2, 1);
    const RenderParams params = {.method = RENDER_FASTEST,
                                 .threads = 3,
                                 .antialias = 2,
                                 .cover_thin = true,
                                 .want_color = true,
                                 .want_id = true};
    assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
    for (int first = 0; first < SIDE; first += 24) {
        Frame band;
        int rows = SIDE - first < 24 ? SIDE - first : 24;
        assert_int_equal(
            renderer_rows(renderer, &scene.view, &scene.appearance, first, rows, &band, &err),
            STATUS_OK);
        assert_memory_equal(whole.color.values + (size_t)(3 * first * SIDE), band.color.values,
                            (size_t)(3 * rows * SIDE) * sizeof(float));
        assert_non_null(band.id.ids);
        frame_release(&band);
    }
    renderer_free(renderer);
    frame_release(&whole);
}

/* ---- where others are wrong easily ------------------------------------------------------------
 */

static void ends_at_the_plane_of_an_orthographic_camera(void **state)
{
    (void)state;
    /* The camera is at z = 20. Half of the first vessel is in front of it, nothing of the second.
     */
    Primitive vessels[] = {vessel(vec3(-4, 0, 15), vec3(4, 1, 25), 0.2 * PIXEL_MM, 1),
                           vessel(vec3(-4, -3, 21), vec3(4, -3, 22), 0.2 * PIXEL_MM, 2)};
    double half = hypot(8, 1) / PIXEL_MM / 2;
    assert_true(fabs(ink_of(vessels, 2, 0) - 0.4 * half) < 0.02 * half);
    assert_true(ink_of(vessels + 1, 1, 0) == 0);
    assert_true(ink_of(vessels + 1, 1, 3) == 0);
}

static void is_the_same_whatever_lies_outside_the_picture(void **state)
{
    (void)state;
    Primitive vessels[] = {vessel(vec3(-5, -1, 0), vec3(4, 2.6, 0), 0.4 * PIXEL_MM, 1), trunk()};
    Scene scene;
    Frame frames[2];
    for (size_t k = 0; k < 2; k++) {
        look_at_paper(&scene, vessels, 1 + k, SIDE);
        frames[k] = drawn(&scene, true, 0, 3, 1);
    }
    assert_memory_equal(frames[0].color.values, frames[1].color.values,
                        3 * SIDE * SIDE * sizeof(float));
    frame_release(&frames[0]);
    frame_release(&frames[1]);
}

/* Each column of pixels that a vessel crosses has as much ink as the others. */
static void of_equal_width_are_smooth(void **state)
{
    (void)state;
    for (int antialias = 1; antialias <= 3; antialias++)
        for (double width_px = 0.02; width_px < 1; width_px += 0.13) {
            Primitive one = vessel(vec3(-9, -2, 0), vec3(9, 1.7, 0), width_px * PIXEL_MM / 2, 1);
            Scene scene;
            look_at_paper(&scene, &one, 1, SIDE);
            Frame frame = drawn(&scene, true, 0, antialias, 1);
            for (size_t x = 0; x < SIDE; x++) {
                double sum = 0;
                for (size_t y = 0; y < SIDE; y++)
                    sum += 1 - (double)frame.color.values[3 * (y * SIDE + x)];
                assert_true(fabs(sum - width_px * hypot(18, 3.7) / 18) < 0.003 * width_px);
            }
            frame_release(&frame);
        }
}

/* A black vessel lies right behind a white one of the same width. */
static void hides_what_lies_behind_it(void **state)
{
    (void)state;
    Rgb colors[] = {{0, 0, 0}, {1, 1, 1}};
    for (uint32_t nearer = 0; nearer < 2; nearer++) {
        Primitive vessels[] = {
            trunk(), vessel(vec3(-4, 0.3, 0), vec3(4, 1, 0), 0.45 * PIXEL_MM, nearer),
            vessel(vec3(-4, 0.3, -2), vec3(4, 1, -2), 0.45 * PIXEL_MM, 1 - nearer)};
        Scene scene;
        look_at_paper(&scene, vessels, 3, SIDE);
        scene.appearance.colors = colors;
        Frame frame = drawn(&scene, true, 0, 3, 1);
        double area = 0.9 * hypot(8, 0.7) / PIXEL_MM, black = ink(&frame);
        assert_true(nearer == 0 ? fabs(black - area) < 0.02 * area : black < 0.35 * area);
        frame_release(&frame);
    }
}

/* A black vessel runs along the outline of a wide white one, half behind it. */
static void are_hidden_sample_by_sample(void **state)
{
    (void)state;
    Rgb colors[] = {{1, 1, 1}, {0, 0, 0}};
    Vec3 a = vec3(-7, -3, 0), b = vec3(7, -1.1, 0);
    Vec3 axis = vec3_normalized(vec3_sub(b, a));
    Vec3 up = vec3(-2 * axis.y, 2 * axis.x, -3);
    Primitive vessels[] = {vessel(a, b, 2, 0),
                           vessel(vec3_add(a, up), vec3_add(b, up), 0.45 * PIXEL_MM, 1)};
    Scene scene, fine_scene;
    look_at_paper(&scene, vessels, 2, SIDE);
    look_at_paper(&fine_scene, vessels, 2, SIDE * FINER);
    scene.appearance.colors = fine_scene.appearance.colors = colors;
    Frame fine = drawn(&fine_scene, false, 0, 1, 2);
    Frame covered = drawn(&scene, true, 0, 3, 2), sampled = drawn(&scene, false, 0, 3, 2);
    double by_cover = distance_from(&covered, &fine), by_samples = distance_from(&sampled, &fine);
    print_message("off by %.4f, samples by %.4f\n", by_cover, by_samples);
    assert_true(by_cover <= by_samples);
    frame_release(&fine);
    frame_release(&covered);
    frame_release(&sampled);
}

/* ---- grown trees ------------------------------------------------------------------------------
 */

enum { GROWN = 64, GROWN_FINER = 6 };

static const Look grown_look = {.color = {0.8f, 0.4f, 0.3f},
                                .finish = {.ambient = 0.3f, .diffuse = 0.7f, .brilliance = 1}};

static double code(double value)
{
    return 255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055);
}

static Frame draw_grown(const Tree *tree, int finer, bool cover, bool shadows, int occlusion)
{
    StageParams stage = stage_square(SCENE_ROUNDED, GROWN * finer);
    RenderParams params = {.method = RENDER_FASTEST,
                           .threads = 2,
                           .antialias = 3,
                           .cover_thin = cover,
                           .shadows = shadows,
                           .occlusion = occlusion,
                           .want_color = true};
    Scene scene;
    Frame frame;
    stage.view.shadows = shadows;
    must(stage_all(tree, &grown_look, &stage, &scene, NULL, &err), &err);
    Vec3 middle = box_center(scene.geometry.bounds);
    scene.view.background = (Rgb){1, 1, 1};
    scene.view.n_lights = 1;
    scene.view.lights[0] = (Light){.location = vec3_add(middle, vec3(33, 57, 71)),
                                   .target = middle,
                                   .color = {1, 1, 1},
                                   .parallel = true,
                                   .casts_shadows = shadows};
    must(render(&scene, &params, &frame, NULL, &err), &err);
    scene_release(&scene);
    return frame;
}

/* How far a picture is off from the mean of a finer one's pixels, in 8-bit levels. */
typedef struct Off {
    double bias, rms;
} Off;

static Off off_from(const Frame *frame, const Frame *fine)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < 3 * GROWN * GROWN; i++) {
        size_t x = i / 3 % GROWN, y = i / 3 / GROWN;
        double mean = 0;
        for (size_t k = 0; k < GROWN_FINER * GROWN_FINER; k++)
            mean += (double)fine->color
                        .values[3 * ((y * GROWN_FINER + k / GROWN_FINER) * GROWN * GROWN_FINER +
                                     x * GROWN_FINER + k % GROWN_FINER) +
                                i % 3];
        double off =
            code((double)frame->color.values[i]) - code(mean / (GROWN_FINER * GROWN_FINER));
        sum += off;
        squares += off * off;
    }
    return (Off){sum / (3 * GROWN * GROWN), sqrt(squares / (3 * GROWN * GROWN))};
}

/* Beside 360 samples a pixel. */
static void looks_right(const Tree *tree, bool shadows, int occlusion)
{
    Frame fine = draw_grown(tree, GROWN_FINER, false, shadows, occlusion);
    Frame covered = draw_grown(tree, 1, true, shadows, occlusion);
    Frame sampled = draw_grown(tree, 1, false, shadows, occlusion);
    Off off = off_from(&covered, &fine), of_samples = off_from(&sampled, &fine);
    print_message("bias %.2f, rms %.2f; ten samples: bias %.2f, rms %.2f\n", off.bias, off.rms,
                  of_samples.bias, of_samples.rms);
    assert_true(fabs(off.bias) < 0.6 && off.rms < of_samples.rms);
    frame_release(&fine);
    frame_release(&covered);
    frame_release(&sampled);
}

static void of_trees_look_as_by_many_samples(void **state)
{
    (void)state;
    const char *domains[] = {"disc:20", "ball:20"};
    for (int k = 0; k < 2; k++) {
        Tree tree = test_grown(domains[k], k ? 1200 : 500, 11);
        looks_right(&tree, false, 0);
        looks_right(&tree, true, 0);
        looks_right(&tree, true, 16);
        tree_release(&tree);
    }
}

/* Draws a tree lit along the camera's direction. */
static Frame draw_lit_from_camera(const Tree *tree, SceneModel model, bool shadows)
{
    StageParams stage = stage_square(model, 4 * SIDE);
    const RenderParams params = {.method = RENDER_FASTEST,
                                 .threads = 1,
                                 .antialias = 3,
                                 .cover_thin = true,
                                 .shadows = shadows,
                                 .want_color = true};
    Scene scene;
    Frame frame;
    must(stage_all(tree, &grown_look, &stage, &scene, NULL, &err), &err);
    Vec3 middle = box_center(scene.geometry.bounds);
    scene.view.n_lights = 1;
    scene.view.lights[0] =
        (Light){.location = vec3_add_scaled(middle, scene.view.camera.direction, -100),
                .target = middle,
                .color = {1, 1, 1},
                .parallel = true,
                .casts_shadows = true};
    must(render(&scene, &params, &frame, NULL, &err), &err);
    scene_release(&scene);
    return frame;
}

/* Where a thin vessel begins on a wide one, the wide one's surface without the thin one lies inside
 * the surface of both. Light from the camera casts no shadow on what the camera sees of wide
 * vessels. The pixels that are counted yet show pieces of thin vessels inside other vessels. */
static void cast_no_shadow_where_they_begin(void **state)
{
    (void)state;
    const SceneModel of_fields[] = {SCENE_ISOSURFACE, SCENE_BLOB};
    const size_t most[] = {100, 45};
    Tree tree = test_grown("disc:20", 500, 11);
    for (int k = 0; k < 2; k++) {
        Frame shaded = draw_lit_from_camera(&tree, of_fields[k], true);
        Frame lit = draw_lit_from_camera(&tree, of_fields[k], false);
        size_t n_darker = 0;
        for (size_t i = 0; i < 16 * SIDE * SIDE; i++)
            n_darker += fabsf(shaded.color.values[3 * i] - lit.color.values[3 * i]) > 0.02f;
        print_message("%zu pixels in shadow\n", n_darker);
        assert_true(n_darker < most[k]);
        frame_release(&shaded);
        frame_release(&lit);
    }
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(covers_the_area_of_its_projection_wherever_it_lies),
        cmocka_unit_test(covers_as_much_in_pieces_as_in_one),
        cmocka_unit_test(vessels_end_to_end_are_one_run_however_many_they_are),
        cmocka_unit_test(covers_no_more_than_a_cell_at_a_bend),
        cmocka_unit_test(hides_behind_what_is_thicker),
        cmocka_unit_test(is_drawn_as_wide_as_is_asked_for),
        cmocka_unit_test(is_shaded_at_five_normals),
        cmocka_unit_test(goes_into_a_wall_where_it_is_as_deep),
        cmocka_unit_test(has_a_color_of_its_own_each_pixel_and_a_half),
        cmocka_unit_test(is_nearer_to_the_mean_of_many_samples_than_ten_samples_are),
        cmocka_unit_test(has_the_same_bytes_whatever_threads_and_bands),
        cmocka_unit_test(ends_at_the_plane_of_an_orthographic_camera),
        cmocka_unit_test(is_the_same_whatever_lies_outside_the_picture),
        cmocka_unit_test(of_equal_width_are_smooth),
        cmocka_unit_test(hides_what_lies_behind_it),
        cmocka_unit_test(are_hidden_sample_by_sample),
        cmocka_unit_test(of_trees_look_as_by_many_samples),
        cmocka_unit_test(cast_no_shadow_where_they_begin),
    };
    return cmocka_run_group_tests_name("thin", tests, NULL, NULL);
}
