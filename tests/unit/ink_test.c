/* Vessels as lines on paper. */
#include "render/ink/inkjoint.h"
#include "render/render.h"
#include "unit.h"

#include "test_scene.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A millimetre of the tree is so many on paper. */
#define SCALE 5.0
#define LINE_MM 0.2

enum { SIDE = 400, MOST = 64 };

static Err err;

typedef struct Sketch {
    Primitive primitives[3 * MOST];
    size_t n;
    uint32_t n_vessels;
    Geometry geometry;
    View view;
} Sketch;

/* 16 mm x 16 mm about the origin, seen along -z. */
static void begin(Sketch *sketch)
{
    *sketch = (Sketch){.view = {.camera = {.location = {0, 0, 20},
                                           .right = {16, 0, 0},
                                           .up = {0, 16, 0},
                                           .direction = {0, 0, -1},
                                           .width = SIDE,
                                           .height = SIDE},
                                .background = {1, 1, 1}}};
}

/* A cylinder with round ends. */
static void add(Sketch *sketch, Vec3 a, Vec3 b, double radius_mm)
{
    const Vec3 ends[] = {a, b};
    sketch->primitives[sketch->n++] = (Primitive){.kind = PRIMITIVE_CYLINDER,
                                                  .a = a,
                                                  .b = b,
                                                  .radius_mm = radius_mm,
                                                  .segment = sketch->n_vessels};
    for (int k = 0; k < 2; k++)
        sketch->primitives[sketch->n++] = (Primitive){.kind = PRIMITIVE_SPHERE,
                                                      .a = ends[k],
                                                      .b = ends[k],
                                                      .radius_mm = radius_mm,
                                                      .segment = sketch->n_vessels};
    sketch->n_vessels++;
}

static void end(Sketch *sketch)
{
    sketch->geometry = (Geometry){.model = SCENE_ROUNDED,
                                  .primitives = sketch->primitives,
                                  .n_primitives = sketch->n,
                                  .ids = test_ids(),
                                  .n_ids = MOST_TEST_IDS,
                                  .drawn = sketch->n_vessels,
                                  .bounds = {{-9, -9, -9}, {9, 9, 9}}};
}

static Strokes drawn(Sketch *sketch, int threads)
{
    const InkParams params = {16 * SCALE, LINE_MM, threads};
    Strokes strokes;
    end(sketch);
    assert_int_equal(ink_strokes(&sketch->geometry, &sketch->view, &params, &strokes, &err),
                     STATUS_OK);
    return strokes;
}

static double length_of(const Strokes *all)
{
    double sum = 0;
    for (size_t i = 0; i < all->n; i++)
        for (size_t k = 1; k < all->strokes[i].n; k++) {
            const double *a = all->points[all->strokes[i].first + k - 1], *b = a + 2;
            sum += hypot(b[0] - a[0], b[1] - a[1]);
        }
    return sum;
}

static void a_vessel_is_one_line_about_it_whose_outer_edge_is_its_own(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-4, 1, 2), vec3(3, -2, 2), 0.7);
    Strokes strokes = drawn(&sketch, 1);
    double radius = 0.7 * SCALE - LINE_MM / 2;
    double expected = 2 * sqrt(58) * SCALE + 2 * PI * radius;
    assert_int_equal(strokes.n, 1);
    assert_true(strokes.strokes[0].width_mm == LINE_MM);
    assert_true(fabs(length_of(&strokes) - expected) < 0.002 * expected);
    assert_true(strokes.width_mm == 16 * SCALE && strokes.height_mm == 16 * SCALE);
    strokes_release(&strokes);
}

/* At 60 degrees to the paper. */
static void a_thin_vessel_towards_the_viewer_is_a_line_too(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-2, 1, -2 * sqrt(3)), vec3(2, 1, 2 * sqrt(3)), 0.031);
    Strokes strokes = drawn(&sketch, 1);
    assert_int_equal(strokes.n, 1);
    assert_true(fabs(length_of(&strokes) - 4 * SCALE) < 1e-9);
    strokes_release(&strokes);
}

/* The edge of the nearer disc is seen whole, half of the other one's. */
static void a_closed_cylinder_has_the_edges_of_its_discs(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-2, 1, -2), vec3(2, 1, 2), 0.7);
    sketch.n = 1; /* without its balls */
    end(&sketch);
    sketch.geometry.model = SCENE_CYLINDERS;
    const InkParams params = {16 * SCALE, LINE_MM, 1};
    Strokes strokes;
    assert_int_equal(ink_strokes(&sketch.geometry, &sketch.view, &params, &strokes, &err),
                     STATUS_OK);
    const double large = 0.7 * SCALE - LINE_MM / 2, small = large / sqrt(2);
    const double ellipse =
        PI * (3 * (large + small) - sqrt((3 * large + small) * (large + 3 * small)));
    assert_true(fabs(length_of(&strokes) - 1.5 * ellipse - 8 * SCALE) < 0.02 * ellipse);
    strokes_release(&strokes);
}

static void what_lies_beside_the_paper_is_left_out(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-12, 1, 0), vec3(3, 1, 0), 0.031);
    add(&sketch, vec3(-12, 9, 0), vec3(3, 9, 0), 0.031);
    Strokes strokes = drawn(&sketch, 1);
    assert_int_equal(strokes.n, 1);
    assert_true(fabs(strokes.points[0][0]) < 1e-9);
    assert_true(fabs(length_of(&strokes) - 11 * SCALE) < 1e-9);
    strokes_release(&strokes);
}

static void a_vessel_thinner_than_two_lines_is_one_as_wide_as_it(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-4, 1, 0), vec3(3, 1, 0), 0.031);
    Strokes strokes = drawn(&sketch, 1);
    const double *from = strokes.points[0], *to = strokes.points[1];
    assert_int_equal(strokes.n, 1);
    assert_int_equal(strokes.n_points, 2);
    assert_true(fabs(strokes.strokes[0].width_mm - 2 * 0.031 * SCALE) < 1e-12);
    assert_true(fabs(from[0] - 4 * SCALE) < 1e-9 && fabs(to[0] - 11 * SCALE) < 1e-9);
    assert_true(fabs(from[1] - 7 * SCALE) < 1e-9 && fabs(to[1] - 7 * SCALE) < 1e-9);
    strokes_release(&strokes);
}

/* The length of lines that lie in a rectangle of the tree's plane. */
static double length_within(const Strokes *all, double left, double right, double low, double high)
{
    enum { PARTS = 64 };
    double sum = 0;
    for (size_t i = 0; i < all->n; i++)
        for (size_t k = 1; k < all->strokes[i].n; k++) {
            const double *a = all->points[all->strokes[i].first + k - 1], *b = a + 2;
            for (int p = 0; p < PARTS; p++) {
                double t = (p + 0.5) / PARTS;
                double x = (a[0] + t * (b[0] - a[0])) / SCALE - 8;
                double y = 8 - (a[1] + t * (b[1] - a[1])) / SCALE;
                if (x > left && x < right && y > low && y < high)
                    sum += hypot(b[0] - a[0], b[1] - a[1]) / PARTS;
            }
        }
    return sum;
}

static void a_vessel_behind_another_is_broken_where_it_is_hidden(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(0, -5, 3), vec3(0, 5, 3), 0.9);
    add(&sketch, vec3(-6, 0.5, -2), vec3(6, 0.5, -2), 0.4);
    Strokes strokes = drawn(&sketch, 1);
    double behind = length_within(&strokes, -5.5, 5.5, 0.01, 0.99) - 2 * 0.98 * SCALE;
    assert_true(length_within(&strokes, -0.85, 0.85, -4, 4) == 0);
    assert_true(fabs(behind - 2 * (11 - 1.8) * SCALE) < 0.01 * behind);
    strokes_release(&strokes);
}

static void nothing_is_drawn_inside_where_vessels_meet(void **state)
{
    (void)state;
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(0, -5, 0), vec3(0, 0, 0), 1.1);
    add(&sketch, vec3(0, 0, 0), vec3(3, 4, 1), 0.8);
    add(&sketch, vec3(0, 0, 0), vec3(-4, 3, -1), 0.6);
    Strokes strokes = drawn(&sketch, 2);
    assert_true(length_within(&strokes, -0.5, 0.5, -4, 0.3) == 0);
    assert_true(length_of(&strokes) > 60);
    strokes_release(&strokes);
}

/* Vessels thrown into the picture. */
static void throw_vessels(Sketch *sketch)
{
    Random random;
    random_seed(&random, 2385);
    begin(sketch);
    for (int i = 0; i < MOST; i++) {
        double number[7];
        for (int k = 0; k < 7; k++)
            number[k] = random_uniform(&random);
        Vec3 a = vec3(12 * number[0] - 6, 12 * number[1] - 6, 8 * number[2] - 4);
        Vec3 along = vec3(5 * number[3] - 2.5, 5 * number[4] - 2.5, 4 * number[5] - 2);
        add(sketch, a, vec3_add(a, along), 0.05 + 0.4 * number[6]);
    }
}

static void look_in_perspective(Sketch *sketch)
{
    sketch->view.camera.projection = PROJECTION_PERSPECTIVE;
    sketch->view.camera.right = vec3(0.8, 0, 0);
    sketch->view.camera.up = vec3(0, 0.8, 0);
}

static bool differs_about(const IdPlane *ids, double x, double y)
{
    enum { REACH = 2 };
    uint32_t first =
        ids->ids[(size_t)fmin(fmax(y, 0), SIDE - 1) * SIDE + (size_t)fmin(fmax(x, 0), SIDE - 1)];
    for (int v = -REACH; v <= REACH; v++)
        for (int u = -REACH; u <= REACH; u++) {
            int column = (int)x + u, row = (int)y + v;
            if (column >= 0 && column < SIDE && row >= 0 && row < SIDE &&
                ids->ids[(size_t)row * SIDE + (size_t)column] != first)
                return true;
        }
    return false;
}

/* The part of the lines' points about which the picture shows one vessel alone. */
static double part_astray(Sketch *sketch)
{
    const double pixel = 16 * SCALE / SIDE;
    const RenderParams params = {.antialias = 1, .want_id = true};
    Strokes strokes = drawn(sketch, 2);
    const Scene scene = {.geometry = sketch->geometry, .view = sketch->view};
    Frame frame;
    size_t astray = 0, n = 0;
    assert_int_equal(render(&scene, &params, &frame, NULL, &err), STATUS_OK);
    for (size_t i = 0; i < strokes.n; i++)
        for (size_t k = 1; k < strokes.strokes[i].n; k++) {
            const double *a = strokes.points[strokes.strokes[i].first + k - 1], *b = a + 2;
            if (fabs(a[0] + b[0] - 16 * SCALE) > 15 * SCALE ||
                fabs(a[1] + b[1] - 16 * SCALE) > 15 * SCALE)
                continue;
            n++;
            astray +=
                !differs_about(&frame.id, (a[0] + b[0]) / 2 / pixel, (a[1] + b[1]) / 2 / pixel);
        }
    frame_release(&frame);
    strokes_release(&strokes);
    assert_true(n > 300);
    return (double)astray / (double)n;
}

static void lines_lie_where_pictures_change_from_vessel_to_vessel(void **state)
{
    (void)state;
    Sketch sketch;
    throw_vessels(&sketch);
    double parallel = part_astray(&sketch);
    look_in_perspective(&sketch);
    double perspective = part_astray(&sketch);
    print_message("astray: %.4f, in perspective %.4f\n", parallel, perspective);
    assert_true(parallel < 0.01 && perspective < 0.01);
}

static void the_number_of_threads_does_not_change_the_strokes(void **state)
{
    (void)state;
    Sketch sketch;
    throw_vessels(&sketch);
    Strokes one = drawn(&sketch, 1), three = drawn(&sketch, 3);
    assert_int_equal(one.n, three.n);
    assert_int_equal(one.n_points, three.n_points);
    assert_memory_equal(one.points, three.points, one.n_points * sizeof *one.points);
    strokes_release(&one);
    strokes_release(&three);
}

static void what_is_behind_the_camera_is_refused(void **state)
{
    (void)state;
    Sketch sketch;
    Strokes strokes;
    const InkParams params = {80, LINE_MM, 1};
    throw_vessels(&sketch);
    look_in_perspective(&sketch);
    sketch.view.camera.location = vec3(0, 0, 1);
    end(&sketch);
    assert_int_equal(ink_strokes(&sketch.geometry, &sketch.view, &params, &strokes, &err),
                     STATUS_USAGE);
    assert_non_null(strstr(err.text, "is not in front of the camera"));
}

/* ---- numbers that METHODS 3.4 states --------------------------------------------------------- */

/* A thin vessel across the picture behind an upright one, whose middle is at x. */
static Strokes crossing(double x, double radius_mm)
{
    Sketch sketch;
    begin(&sketch);
    add(&sketch, vec3(-6, 0.5, -2), vec3(6, 0.5, -2), 0.031);
    add(&sketch, vec3(x, -5, 3), vec3(x, 5, 3), radius_mm);
    return drawn(&sketch, 1);
}

/* How far the nearest end of a thin vessel's line is from a place, mm of paper. */
static double off_nearest_end(const Strokes *all, double x)
{
    double off = HUGE_VAL;
    for (size_t i = 0; i < all->n; i++) {
        const double *from = all->points[all->strokes[i].first];
        const double *to = all->points[all->strokes[i].first + all->strokes[i].n - 1];
        if (all->strokes[i].width_mm > LINE_MM)
            off = fmin(off, fmin(fabs(from[0] - (x + 8) * SCALE), fabs(to[0] - (x + 8) * SCALE)));
    }
    return off;
}

/* A line ends within half of a hundredth of a line of where it is hidden: fewer halvings do not do.
 */
static void a_line_ends_within_a_hundredth_of_a_line(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 24; i++) {
        const double x = -3 + 0.2537 * i;
        Strokes strokes = crossing(x, 0.9);
        worst = fmax(worst,
                     fmax(off_nearest_end(&strokes, x - 0.9), off_nearest_end(&strokes, x + 0.9)));
        strokes_release(&strokes);
    }
    assert_true(worst > 0 && worst <= LINE_MM / 100 / 2);
}

/* Curves are followed in steps of half a line: no gap wider than that is stepped over. */
static void no_gap_wider_than_half_a_line_is_missed(void **state)
{
    (void)state;
    for (int i = 0; i < 24; i++) {
        const double x = -3 + 0.2537 * i, radius_mm = 0.55 * LINE_MM / SCALE / 2;
        Strokes strokes = crossing(x, radius_mm);
        assert_true(off_nearest_end(&strokes, x - radius_mm) < LINE_MM / 100);
        assert_true(off_nearest_end(&strokes, x + radius_mm) < LINE_MM / 100);
        strokes_release(&strokes);
    }
}

/* Lines are looked at from 1e-6 radii beside a wall: the right line of a vessel is hidden by one
 * before it that reaches farther than that. */
static void a_wall_is_looked_at_a_millionth_of_its_radius_beside_it(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const double beyond = i ? 1.2e-6 : 0.8e-6;
        Sketch sketch;
        begin(&sketch);
        add(&sketch, vec3(0, -5, 0), vec3(0, 5, 0), 1);
        add(&sketch, vec3(0.5 + beyond, -5, 3), vec3(0.5 + beyond, 5, 3), 0.5);
        Strokes strokes = drawn(&sketch, 1);
        double right = length_within(&strokes, 0.9, 1.1, -4, 4), each = 8 * SCALE;
        assert_true(fabs(right - (i ? each : 2 * each)) < 0.05 * each);
        strokes_release(&strokes);
    }
}

/* A vessel no wider on paper than two lines is one line of its own width. */
static void a_vessel_of_two_lines_is_the_limit(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const double lines = i ? 2.1 : 1.9;
        Sketch sketch;
        begin(&sketch);
        add(&sketch, vec3(-4, 1, 0), vec3(3, 1, 0), lines / 2 * LINE_MM / SCALE);
        Strokes strokes = drawn(&sketch, 1);
        assert_int_equal(strokes.n == 1, !i);
        assert_true(fabs(strokes.strokes[0].width_mm - (i ? 1 : lines) * LINE_MM) < 1e-9);
        strokes_release(&strokes);
    }
}

/* The outline of a joint is followed over 16 of its ellipses: 15 points lie on each side between
 * its ends. */
static void a_joint_is_followed_over_16_ellipses(void **state)
{
    static const Vec3 axes[] = {{1, 0, 0}, {1, 0, 0}};
    const Primitive joint = {.kind = PRIMITIVE_JOINT,
                             .a = vec3(-2, 0, 0),
                             .b = vec3(2, 0, 0),
                             .radius_mm = 1,
                             .radius_b_mm = 1,
                             .axes = axes};
    const InkParams params = {16 * SCALE, LINE_MM, 1};
    Sketch sketch;
    Strokes strokes;
    int n = 0;
    (void)state;
    begin(&sketch);
    sketch.primitives[0] = joint;
    sketch.n = sketch.n_vessels = 1;
    end(&sketch);
    sketch.geometry.model = SCENE_JOINED;
    assert_int_equal(ink_strokes(&sketch.geometry, &sketch.view, &params, &strokes, &err),
                     STATUS_OK);
    for (size_t i = 0; i < strokes.n_points; i++) {
        double step = (strokes.points[i][0] / SCALE - 6) / 4 * 16;
        n += step > 0.01 && step < 15.99;
        assert_true(fabs(step - round(step)) < 1e-6);
    }
    assert_int_equal(n, 2 * 15);
    strokes_release(&strokes);
}

/* The walls of joints are seen edge-on where they are drawn: Newton's iteration ends there. */
static void outlines_of_joints_are_seen_edge_on(void **state)
{
    const Vec3 center[] = {{0, 0, 0}, {0.4, 0.2, 2}};
    const Vec3 axis[] = {{0, 0, 1}, vec3_normalized(vec3(0.5, 0.2, 1))};
    const double radius[] = {1, 0.6};
    const JointFrame joint = joint_frame(center, axis, radius);
    int found = 0;
    (void)state;
    for (double turn = 0; turn < 3; turn += 0.37)
        for (double way = 0; way <= 1; way += 0.25) {
            const Camera camera = {.location = {20 * cos(turn), 20 * sin(turn), 5},
                                   .direction = {0, 0, -1},
                                   .projection = PROJECTION_PERSPECTIVE};
            double angles[JOINT_OUTLINES], distance;
            int n = joint_outline(&camera, &joint, way, angles);
            for (int i = 0; i < n; i++, found++) {
                Vec3 point = joint_point(&joint, cos(angles[i]), sin(angles[i]), way);
                Vec3 towards = towards_viewer(&camera, point, &distance);
                assert_true(fabs(vec3_dot(joint_normal(&joint, angles[i], way), towards)) < 1e-11);
            }
        }
    assert_true(found >= 80);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vessel_is_one_line_about_it_whose_outer_edge_is_its_own),
        cmocka_unit_test(a_vessel_thinner_than_two_lines_is_one_as_wide_as_it),
        cmocka_unit_test(a_thin_vessel_towards_the_viewer_is_a_line_too),
        cmocka_unit_test(a_closed_cylinder_has_the_edges_of_its_discs),
        cmocka_unit_test(what_lies_beside_the_paper_is_left_out),
        cmocka_unit_test(a_vessel_behind_another_is_broken_where_it_is_hidden),
        cmocka_unit_test(nothing_is_drawn_inside_where_vessels_meet),
        cmocka_unit_test(lines_lie_where_pictures_change_from_vessel_to_vessel),
        cmocka_unit_test(the_number_of_threads_does_not_change_the_strokes),
        cmocka_unit_test(what_is_behind_the_camera_is_refused),
        cmocka_unit_test(a_line_ends_within_a_hundredth_of_a_line),
        cmocka_unit_test(no_gap_wider_than_half_a_line_is_missed),
        cmocka_unit_test(a_wall_is_looked_at_a_millionth_of_its_radius_beside_it),
        cmocka_unit_test(a_vessel_of_two_lines_is_the_limit),
        cmocka_unit_test(a_joint_is_followed_over_16_ellipses),
        cmocka_unit_test(outlines_of_joints_are_seen_edge_on),
    };
    return cmocka_run_group_tests_name("ink", tests, NULL, NULL);
}
