/* Outlines, halos and fading, compared with geometry. */
#include "render/effect/effect.h"
#include "unit.h"

#include "render/render.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_stage.h"

static Err err;

/* White vessels without light on a blue sheet, black lines. */
static Look plain_look(void)
{
    return (Look){.finish = {.ambient = 1, .brilliance = 1, .roughness = 0.05f},
                  .color = {1, 1, 1},
                  .background = {0, 0, 1},
                  .effects = {.outline_radii = 10,
                              .outline_deeper = 0.5,
                              .crease_deg = 180,
                              .halo_radii = 10,
                              .halo_deeper = 1.5}};
}

/* A segment from a to b in a tree whose next two nodes are `node`. */
static void set_segment(Tree *tree, int32_t node, Vec3 a, Vec3 b, double radius_mm)
{
    for (int32_t end = 0; end < 2; end++) {
        tree->parent[node + end] = end ? node : -1;
        tree->id[node + end] = node + end + 1;
        tree->radius_mm[node + end] = radius_mm;
        tree->position[node + end] = end ? b : a;
    }
}

/* A picture of 40 x 40 mm about the origin, seen along -z, `side` pixels a side. */
static Scene scene_of(const Tree *tree, const Look *look, int side)
{
    StageParams params = stage_defaults();
    Scene scene;
    params.geometry.model = SCENE_CYLINDERS;
    params.view.width = params.view.height = side;
    params.view.height_mm = 40;
    params.view.has_location = params.view.has_look_at = true;
    params.view.location = vec3(0, 0, 100);
    assert_int_equal(stage_all(tree, look, &params, &scene, NULL, &err), STATUS_OK);
    return scene;
}

static Frame draw(const Scene *scene, RenderMethod method, int antialias, int threads)
{
    const RenderParams params = {
        .method = method, .threads = threads, .antialias = antialias, .want_color = true};
    Frame frame;
    assert_int_equal(render(scene, &params, &frame, NULL, &err), STATUS_OK);
    return frame;
}

/* A tube of radius 4.77 through the whole picture, turned by so many degrees from the x axis. */
static Frame draw_tube(double degrees, const Look *look, int side)
{
    Tree tree;
    double angle = degrees * 3.14159265358979323846 / 180;
    Vec3 end = vec3(90 * cos(angle), 90 * sin(angle), 0);
    assert_int_equal(tree_init(&tree, 2, NULL), STATUS_OK);
    set_segment(&tree, 0, vec3_scale(end, -1), end, 4.77);
    Scene scene = scene_of(&tree, look, side);
    Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
    scene_release(&scene);
    tree_release(&tree);
    return frame;
}

/* How much of a column of pixels is black, in pixels: what is neither sheet nor vessel. */
static double black_in_column(const Frame *frame, int column)
{
    double black = 0;
    for (int y = 0; y < frame->color.height; y++)
        black += 1 - (double)frame->color.values[3 * (y * frame->color.width + column) + 2];
    return black;
}

/* To half a sample, of which a pixel has 4 x 4. */
static void an_outline_is_as_wide_as_asked_whatever_its_direction(void **state)
{
    (void)state;
    Look look = plain_look();
    for (double width = 0.6; width < 4; width += 0.77)
        for (double degrees = 0; degrees < 50; degrees += 11.3) {
            look.effects.outline_width = 1000 * width / 120;
            Frame frame = draw_tube(degrees, &look, 120);
            double cosine = cos(degrees * 3.14159265358979323846 / 180);
            double black = 0, across = 2 * width / cosine;
            for (int column = 40; column < 80; column++)
                black += black_in_column(&frame, column) / 40;
            if (fabs(black - across) > 2 * 0.5 / 4 / cosine)
                fail_msg("%g px at %g degrees: %g black, not %g", width, degrees, black, across);
            frame_release(&frame);
        }
}

static void a_picture_of_twice_the_pixels_looks_the_same(void **state)
{
    (void)state;
    Look look = plain_look();
    look.effects.outline_width = 21.7;
    Frame small = draw_tube(23.85, &look, 96), large = draw_tube(23.85, &look, 192);
    double off = 0;
    for (int column = 0; column < 96; column++) {
        double of_small = black_in_column(&small, column);
        double of_large =
            (black_in_column(&large, 2 * column) + black_in_column(&large, 2 * column + 1)) / 4;
        off = fmax(off, fabs(of_small - of_large));
    }
    assert_true(off < 0.15);
    frame_release(&small);
    frame_release(&large);
}

static void thin_vessels_have_thin_outlines(void **state)
{
    (void)state;
    Look look = plain_look();
    look.effects.outline_width = 200;
    look.effects.outline_radii = 0.25;
    Frame frame = draw_tube(0, &look, 120);
    assert_true(fabs(black_in_column(&frame, 60) - 2 * 0.25 * 4.77 * 3) < 0.2);
    frame_release(&frame);
}

/* A thin tube along x, `above` mm in front of a thick one along y. */
static void make_crossing(Tree *tree, double above)
{
    assert_int_equal(tree_init(tree, 4, NULL), STATUS_OK);
    set_segment(tree, 0, vec3(0, -90, 0), vec3(0, 90, 0), 6.1);
    set_segment(tree, 2, vec3(-90, 0, 6.1 + above), vec3(90, 0, 6.1 + above), 2.385);
}

/* Pixels of the sheet's color in the middle column. */
static double gap_in_middle(double above)
{
    Tree tree;
    Look look = plain_look();
    look.effects.halo_width = 1000 * 2.7 / 120;
    make_crossing(&tree, above);
    Scene scene = scene_of(&tree, &look, 120);
    Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
    double gap = 0;
    for (int y = 0; y < 120; y++)
        gap += 1 - (double)frame.color.values[3 * (y * 120 + 60)];
    frame_release(&frame);
    scene_release(&scene);
    tree_release(&tree);
    return gap;
}

static void a_halo_parts_a_vessel_from_those_far_behind_it_alone(void **state)
{
    (void)state;
    assert_true(fabs(gap_in_middle(9) - 2 * 2.7) < 0.25);
    /* the edge of the front one lies 1.4 of its radii before the crest of the other */
    assert_true(gap_in_middle(1.4 * 2.385) == 0);
}

/* Black pixels of the middle column, where a thin tube lies `above` mm in front of a thick one. */
static double line_in_middle(double above)
{
    Tree tree;
    Look look = plain_look();
    look.effects.outline_width = 1000 * 1.5 / 120;
    make_crossing(&tree, above);
    Scene scene = scene_of(&tree, &look, 120);
    Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
    double black = black_in_column(&frame, 60);
    frame_release(&frame);
    scene_release(&scene);
    tree_release(&tree);
    return black;
}

/* The limits are those of plain_look, in radii of the vessel in front; a tenth less is too little.
 */
static void lines_and_gaps_lie_on_what_is_deeper_by_as_many_radii_as_asked(void **state)
{
    (void)state;
    const double radius_mm = 2.385, line_at = 0.5 * radius_mm, gap_at = 1.5 * radius_mm;
    assert_true(line_in_middle(0.5 * line_at) < 0.1);
    assert_true(line_in_middle(1.1 * line_at) > 2.5);
    assert_true(gap_in_middle(0.8 * gap_at) < 0.1);
    assert_true(gap_in_middle(1.1 * gap_at) > 4);
}

static void vessels_that_touch_are_parted_where_their_walls_turn(void **state)
{
    (void)state;
    Tree tree;
    Look look = plain_look();
    make_crossing(&tree, 0);
    double black[2];
    for (int i = 0; i < 2; i++) {
        look.effects.outline_width = 1000 * 2.0 / 120;
        look.effects.crease_deg = i ? 30 : 180;
        Scene scene = scene_of(&tree, &look, 120);
        Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
        black[i] = black_in_column(&frame, 60);
        frame_release(&frame);
        scene_release(&scene);
    }
    assert_true(black[0] == 0 && black[1] > 2 * 2.0);
    tree_release(&tree);
}

static void vessels_fade_from_the_nearest_to_the_farthest(void **state)
{
    (void)state;
    Tree tree;
    Look look = plain_look();
    look.fade_nearest = 0.125;
    look.fade_farthest = 0.75;
    assert_int_equal(tree_init(&tree, 4, NULL), STATUS_OK);
    set_segment(&tree, 0, vec3(-10, -90, -60), vec3(-10, 90, -60), 2.385);
    set_segment(&tree, 2, vec3(10, -90, 60), vec3(10, 90, 60), 2.385);
    Scene scene = scene_of(&tree, &look, 120);
    Frame frame = draw(&scene, RENDER_TRACE, 1, 1);
    const float *row = &frame.color.values[3 * 60 * 120];
    /* crests: 2.385 mm nearer than the axes, of 120 mm */
    double far = 0.125 + 0.625 * (1 - 2.385 / 120);
    assert_true(fabs(1 - (double)row[3 * 30] - far) < 1e-3);
    assert_true(fabs(1 - (double)row[3 * 90] - 0.125) < 1e-6);
    frame_release(&frame);
    scene_release(&scene);
    tree_release(&tree);
}

/* Of all effects, by bands and threads. */
static void bands_and_threads_change_no_byte(void **state)
{
    (void)state;
    Tree tree;
    Look look = plain_look();
    look.effects.outline_width = 31;
    look.effects.halo_width = 47;
    look.fade_farthest = 0.5;
    make_crossing(&tree, 9);
    Scene scene = scene_of(&tree, &look, 83);
    Frame whole = draw(&scene, RENDER_RASTER, 3, 1);
    for (int rows = 8; rows < 30; rows += 8) {
        const RenderParams params = {
            .method = RENDER_RASTER, .threads = 3, .antialias = 3, .want_color = true};
        Renderer *renderer;
        assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
        for (int first = 0; first < 83; first += rows) {
            Frame band;
            int n = rows < 83 - first ? rows : 83 - first;
            assert_int_equal(
                renderer_rows(renderer, &scene.view, &scene.appearance, first, n, &band, &err),
                STATUS_OK);
            assert_memory_equal(band.color.values, whole.color.values + first * 3 * 83,
                                (size_t)n * 3 * 83 * sizeof *band.color.values);
            frame_release(&band);
        }
        renderer_free(renderer);
    }
    frame_release(&whole);
    scene_release(&scene);
    tree_release(&tree);
}

/* ---- numbers that METHODS 3.5 states --------------------------------------------------------- */

/* EffectSamples per millimetre of a picture of coins. */
enum { COIN_SIDE = 240, COIN_PX_PER_MM = COIN_SIDE / 40 };
static const double coin_mm = 2.385;

/* A disc across the line of sight, `above` mm before a larger one: what is black and what has the
 * sheet's color within 8 mm of its middle, along the row through it, in mm. */
static void draw_coins(const Look *look, double above, double *black, double *sheet)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, 4, NULL), STATUS_OK);
    set_segment(&tree, 0, vec3(0, 0, -9), vec3(0, 0, 0), 12);
    set_segment(&tree, 2, vec3(0, 0, -5), vec3(0, 0, above), coin_mm);
    Scene scene = scene_of(&tree, look, COIN_SIDE);
    Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
    *black = *sheet = 0;
    for (int x = COIN_SIDE / 2 - 8 * COIN_PX_PER_MM; x < COIN_SIDE / 2 + 8 * COIN_PX_PER_MM; x++) {
        const float *color = frame.color.values + 3 * (COIN_SIDE / 2 * COIN_SIDE + x);
        *black += (1 - (double)color[2]) / COIN_PX_PER_MM;
        *sheet += ((double)color[2] - (double)color[0]) / COIN_PX_PER_MM;
    }
    frame_release(&frame);
    scene_release(&scene);
    tree_release(&tree);
}

/* Widths of `mm` as looks have them: in thousandths of the picture's side. */
static double look_width(double mm)
{
    return 1000 * mm / 40;
}

/* A line and a gap begin where what is behind lies deeper by `deeper` radii of the vessel in front.
 */
static void what_is_deeper_by_so_many_radii_has_a_line_and_a_gap(void **state)
{
    double black, sheet;
    (void)state;
    for (int i = 0; i < 2; i++) {
        const double part = i ? 1.1 : 0.9;
        Look look = plain_look();
        look.effects.outline_width = look_width(0.8);
        draw_coins(&look, part * look.effects.outline_deeper * coin_mm, &black, &sheet);
        assert_true(fabs(black - (i ? 2 * 0.8 : 0)) < 0.1 && sheet < 1e-6);
        look.effects.outline_width = 0;
        look.effects.halo_width = look_width(0.8);
        draw_coins(&look, part * look.effects.halo_deeper * coin_mm, &black, &sheet);
        assert_true(fabs(sheet - (i ? 2 * 0.8 : 0)) < 0.1 && black < 1e-6);
    }
}

/* Lines and gaps are at most so many radii of the front vessel wide. */
static void lines_and_gaps_are_at_most_so_many_radii_wide(void **state)
{
    double black, sheet;
    (void)state;
    Look look = plain_look();
    look.effects.outline_width = look.effects.halo_width = look_width(4);
    look.effects.outline_radii = 0.5;
    look.effects.halo_radii = 0.3;
    draw_coins(&look, 3 * coin_mm, &black, &sheet);
    assert_true(fabs(black - 2 * 0.5 * coin_mm) < 0.1);
    assert_true(fabs(sheet - 2 * 0.3 * coin_mm) < 0.1);
}

/* A line covers what lies at most half of `deeper` radii behind its edge: of the wall of a tube
 * that falls away from a disc on it, the part from x = 6.364 mm, where it is sqrt(81 - x^2) mm
 * high, to where it is 0.9 mm lower. The tube's own edge, at 9 mm, has a line from 7.7 mm on. */
static void a_line_ends_where_its_wall_falls_away(void **state)
{
    const double rim = 9 * sqrt(0.5), reach = sqrt(81 - pow(rim - 0.1 * 9, 2)) - rim;
    const int first = (int)(rim * COIN_PX_PER_MM), last = (int)(7.6 * COIN_PX_PER_MM);
    Tree tree;
    Look look = plain_look();
    double black = 0;
    (void)state;
    look.effects.outline_width = look_width(1.3);
    look.effects.outline_deeper = 0.2;
    look.effects.crease_deg = 30;
    assert_int_equal(tree_init(&tree, 4, NULL), STATUS_OK);
    set_segment(&tree, 0, vec3(0, -90, 0), vec3(0, 90, 0), 9);
    set_segment(&tree, 2, vec3(rim - 1, 0, 0), vec3(rim - 1, 0, rim + 0.1), 1);
    Scene scene = scene_of(&tree, &look, COIN_SIDE);
    Frame frame = draw(&scene, RENDER_TRACE, 4, 1);
    const float *row = frame.color.values + 3 * (COIN_SIDE / 2 * COIN_SIDE + COIN_SIDE / 2);
    for (int x = first; x < last; x++)
        black += (1 - (double)row[3 * x + 2]) / COIN_PX_PER_MM;
    assert_true(fabs(black - reach) < 0.1);
    frame_release(&frame);
    scene_release(&scene);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_outline_is_as_wide_as_asked_whatever_its_direction),
        cmocka_unit_test(a_picture_of_twice_the_pixels_looks_the_same),
        cmocka_unit_test(thin_vessels_have_thin_outlines),
        cmocka_unit_test(a_halo_parts_a_vessel_from_those_far_behind_it_alone),
        cmocka_unit_test(lines_and_gaps_lie_on_what_is_deeper_by_as_many_radii_as_asked),
        cmocka_unit_test(vessels_that_touch_are_parted_where_their_walls_turn),
        cmocka_unit_test(vessels_fade_from_the_nearest_to_the_farthest),
        cmocka_unit_test(bands_and_threads_change_no_byte),
        cmocka_unit_test(what_is_deeper_by_so_many_radii_has_a_line_and_a_gap),
        cmocka_unit_test(lines_and_gaps_are_at_most_so_many_radii_wide),
        cmocka_unit_test(a_line_ends_where_its_wall_falls_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
