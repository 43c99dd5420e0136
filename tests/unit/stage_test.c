/* How a tree and a look become geometry, appearance and view. */
#include "stage/stage.h"
#include "unit.h"

#include "stage/coincidence.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_stage.h"
#include <stdio.h>
#include <unistd.h>

static const Look look = {.color = {0.5f, 0.1f, 0.2f},
                          .background = {1, 1, 1},
                          .finish = {.ambient = 0.1f, .diffuse = 0.6f, .brilliance = 1},
                          .lights = {{.direction = {1, 2, 3}, .color = {1, 1, 1}}},
                          .n_lights = 1};

/* A parent along y that splits into a thick and a thin daughter, with a step of no length in the
 * thick one and a segment of no radius at the end of the thin one. */
static Tree make_tree(void)
{
    static const int32_t parents[] = {-1, 0, 1, 1, 2, 3};
    static const double radii[] = {2.385, 2.385, 1.9, 1.2, 1.9, 0};
    static const Vec3 places[] = {{0, 20, 0}, {0, 10, 1}, {-5, 4, 2},
                                  {6, 3, -1}, {-5, 4, 2}, {9, 1, -1}};
    Tree tree;
    assert_int_equal(tree_init(&tree, 6, NULL), STATUS_OK);
    for (int i = 0; i < 6; i++) {
        tree.id[i] = i + 11;
        tree.parent[i] = parents[i];
        tree.radius_mm[i] = radii[i];
        tree.position[i] = places[i];
    }
    return tree;
}

static void assert_near(Vec3 a, Vec3 b, double within)
{
    if (!(vec3_distance(a, b) <= within))
        fail_msg("%.12g %.12g %.12g is not %.12g %.12g %.12g", a.x, a.y, a.z, b.x, b.y, b.z);
}

static Scene stage(const StageParams *params, StageReport *report)
{
    Tree tree = make_tree();
    Scene scene;
    Err err = {{0}};
    must(stage_all(&tree, &look, params, &scene, report, &err), &err);
    tree_release(&tree);
    return scene;
}

/* Two trees whose rows are mixed: of the first a thick branch, with a step of no length, goes on
 * behind the thin one that comes before it; the second is a root alone. */
static Tree make_forest(void)
{
    static const int32_t parents[] = {-1, 0, -1, 0, 3, 4, 3};
    static const double radii[] = {2.385, 0.7, 1, 2.385, 1.9, 1.9, 1.2};
    static const Vec3 places[] = {{0, 20, 0}, {9, 9, 9},  {70, 0, 0}, {0, 10, 1},
                                  {0, 10, 1}, {-5, 4, 2}, {6, 3, -1}};
    Tree tree;
    assert_int_equal(tree_init(&tree, 7, NULL), STATUS_OK);
    for (int i = 0; i < 7; i++) {
        tree.id[i] = i + 1;
        tree.parent[i] = parents[i];
        tree.radius_mm[i] = radii[i];
        tree.position[i] = places[i];
    }
    return tree;
}

static void an_anatomy_tells_trees_orders_and_the_way_along_the_thickest_branch(void **state)
{
    (void)state;
    static const uint32_t trees[] = {0, 0, 1, 0, 0, 0, 0};
    static const int orders[] = {0, 1, 0, 2, 1, 1, 1};
    static const Vec3 path[] = {{-10, 19, 0.5}, {-10, 9, 1.5}, {-15, 3, 2.5}};
    Tree tree = make_forest();
    Anatomy anatomy = {0};
    assert_int_equal(stage_anatomy(&tree, NULL, vec3(10, 1, -0.5), &anatomy, NULL), STATUS_OK);
    assert_int_equal(anatomy.n_trees, 2);
    assert_near(anatomy.root[0], path[0], 0);
    assert_near(anatomy.root[1], vec3(60, -1, 0.5), 0);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(anatomy.component[i], trees[i]);
        assert_int_equal(anatomy.order[i], orders[i]);
    }
    assert_int_equal(anatomy.n_main_branch, 3);
    for (int i = 0; i < 3; i++)
        assert_near(anatomy.main_branch[i], path[i], 0);
    anatomy_release(&anatomy);
    assert_null(anatomy.component);
    tree_release(&tree);
}

/* A root alone has a path, which is where it stands. */
static void the_path_of_a_tree_without_segments_is_its_root(void **state)
{
    (void)state;
    Tree tree;
    Anatomy anatomy = {0};
    assert_int_equal(tree_init(&tree, 1, NULL), STATUS_OK);
    tree.id[0] = 1;
    tree.parent[0] = -1;
    tree.radius_mm[0] = 2.385;
    tree.position[0] = vec3(3, 4, 5);
    assert_int_equal(stage_anatomy(&tree, NULL, vec3(0, 0, 0), &anatomy, NULL), STATUS_OK);
    assert_int_equal(anatomy.n_main_branch, 1);
    assert_near(anatomy.main_branch[0], vec3(3, 4, 5), 0);
    anatomy_release(&anatomy);
    tree_release(&tree);
}

static void segments_without_length_or_radius_are_counted_not_drawn(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_CYLINDERS;
    StageReport report;
    Scene scene = stage(&params, &report);
    assert_int_equal(report.drawn, 3);
    assert_int_equal(report.dropped, 2);
    assert_int_equal(scene.geometry.n_primitives, 3);
    for (size_t i = 0; i < scene.geometry.n_primitives; i++)
        assert_int_equal(scene.geometry.ids[scene.geometry.primitives[i].segment], 12 + i);
    scene_release(&scene);
}

static void a_segment_inside_its_sister_is_left_out(void **state)
{
    (void)state;
    Tree tree = make_tree();
    tree.position[3] = tree.position[2]; /* the thin daughter runs within the thick one */
    StageParams params = stage_defaults();
    Scene scene;
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
    assert_int_equal(scene.geometry.n_primitives, 2 + 3);
    for (size_t i = 0; i < scene.geometry.n_primitives; i++)
        assert_int_not_equal(scene.geometry.ids[scene.geometry.primitives[i].segment], 14);
    scene_release(&scene);
    tree_release(&tree);
}

static void a_sphere_has_the_largest_radius_that_meets(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_ROUNDED;
    Scene scene = stage(&params, NULL);
    /* Spheres at the inlet, the bifurcation and the two ends; one only where the step has no
     * length. */
    assert_int_equal(scene.geometry.n_primitives, 3 + 4);
    static const struct {
        double radius;
        uint32_t id;
    } expected[] = {{2.385, 12}, {2.385, 12}, {1.9, 13}, {1.2, 14}};
    for (size_t i = 0; i < 4; i++) {
        const Primitive *sphere = &scene.geometry.primitives[3 + i];
        assert_int_equal(sphere->kind, PRIMITIVE_SPHERE);
        assert_true(sphere->radius_mm == expected[i].radius);
        assert_int_equal(scene.geometry.ids[sphere->segment], expected[i].id);
    }
    /* All of them end a cylinder of their own: the parent's both ends, and one of each daughter. */
    assert_int_equal(scene.geometry.n_ends, 4);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(scene.geometry.primitives[i].round_a, i == 0);
        assert_true(scene.geometry.primitives[i].round_b);
    }
    scene_release(&scene);
}

static void ends_that_are_implied_are_those_that_are_left_out(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_ROUNDED;
    Scene scene = stage(&params, NULL);
    params.geometry.implied_ends = true;
    Scene implied = stage(&params, NULL);
    Err err = {{0}};
    Primitive *all;
    size_t n;
    assert_true(implied.geometry.implied_ends);
    assert_int_equal(implied.geometry.n_primitives, 3);
    assert_int_equal(implied.geometry.n_ends, 0);
    must(geometry_with_ends(&implied.geometry, &all, &n, &err), &err);
    assert_int_equal(n, scene.geometry.n_primitives);
    for (size_t i = 0; i < n; i++) {
        const Primitive *whole = &scene.geometry.primitives[i];
        assert_int_equal(all[i].kind, whole->kind);
        assert_near(all[i].a, whole->a, 0);
        assert_near(all[i].b, whole->b, 0);
        assert_true(all[i].radius_mm == whole->radius_mm);
        assert_int_equal(all[i].segment, whole->segment);
    }
    free(all);
    scene_release(&implied);
    scene_release(&scene);
}

static void every_model_has_the_segments_at_their_radii(void **state)
{
    (void)state;
    static const double radii[] = {2.385, 1.9, 1.2};
    StageParams params = stage_defaults();
    for (int model = SCENE_CYLINDERS; model <= SCENE_BLOB; model++) {
        params.geometry.model = (SceneModel)model;
        Scene scene = stage(&params, NULL);
        for (size_t i = 0; i < 3; i++) {
            bool field = scene.geometry.n_segments > 0;
            assert_true((field ? scene.geometry.segments[i].radius_mm
                               : scene.geometry.primitives[i].radius_mm) == radii[i]);
            assert_int_equal(field ? scene.geometry.ids[scene.geometry.segments[i].segment]
                                   : scene.geometry.ids[scene.geometry.primitives[i].segment],
                             12 + i);
        }
        scene_release(&scene);
    }
}

/* Two vessels of one radius in a row: the sphere between them is that of the one that ends
 * there. */
static void of_equals_the_segment_that_ends_at_a_place_gives_its_sphere(void **state)
{
    (void)state;
    Tree tree = make_tree();
    tree.radius_mm[2] = tree.radius_mm[3] = 2.385;
    StageParams params = stage_defaults();
    Scene scene;
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
    assert_int_equal(scene.geometry.primitives[4].kind, PRIMITIVE_SPHERE);
    assert_true(scene.geometry.primitives[4].a.y == 10);
    assert_int_equal(scene.geometry.ids[scene.geometry.primitives[4].segment], 12);
    scene_release(&scene);
    tree_release(&tree);
}

/* Where a point of the world stands in the picture, in pixels from its middle. */
static void project(const Camera *camera, Vec3 x, double *i, double *j)
{
    Vec3 from = vec3_sub(x, camera->location);
    double depth =
        camera->projection == PROJECTION_PERSPECTIVE ? vec3_dot(from, camera->direction) : 1;
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    *i = vec3_dot(from, camera->right) / (width * width) / depth * camera->width;
    *j = vec3_dot(from, camera->up) / (height * height) / depth * camera->height;
}

static void every_view_frames_the_whole_tree(void **state)
{
    (void)state;
    for (int view = VIEW_FRONT; view <= VIEW_ISO; view++)
        for (int projection = 0; projection < 2; projection++) {
            StageParams params = stage_defaults();
            params.view.view = (NamedView)view;
            params.view.projection = (Projection)projection;
            params.view.width = 300;
            params.view.height = 170;
            Scene scene = stage(&params, NULL);
            const Camera *camera = &scene.view.camera;
            double widest = 0, highest = 0;
            for (size_t k = 0; k < scene.geometry.n_primitives; k++) {
                double i, j;
                project(camera, scene.geometry.primitives[k].b, &i, &j);
                widest = fmax(widest, fabs(i));
                highest = fmax(highest, fabs(j));
            }
            assert_true(widest < 0.45 * 300 && highest < 0.45 * 170);
            assert_true(widest > 0.2 * 300 || highest > 0.2 * 170);
            /* Right-handed: right x up points at the viewer. */
            Vec3 back = vec3_cross(camera->right, camera->up);
            assert_true(vec3_dot(back, camera->direction) < 0);
            scene_release(&scene);
        }
}

static void the_front_view_has_x_to_the_right_and_y_up(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    Scene scene = stage(&params, NULL);
    assert_true(scene.view.camera.right.x > 0 && scene.view.camera.right.y == 0 &&
                scene.view.camera.right.z == 0);
    assert_true(scene.view.camera.up.y > 0 && scene.view.camera.up.x == 0 &&
                scene.view.camera.up.z == 0);
    assert_true(scene.view.camera.direction.z == -1);
    scene_release(&scene);
}

/* The balls at the nodes reach from 1.8 to 22.385 in y and from -6.9 to 7.2 in x. */
static void a_framed_picture_has_its_margin_on_each_side(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    params.view.margin = 0.12;
    Scene scene = stage(&params, NULL);
    assert_true(fabs(scene.view.camera.up.y - 20.585 / 0.76) < 1e-12);
    assert_true(fabs(scene.view.camera.location.x - 0.15) < 1e-12);
    assert_true(fabs(scene.view.camera.location.y - 12.0925) < 1e-12);
    scene_release(&scene);
}

/* A vessel along the view, 11 mm long: its nearer ball, of radius 2.385, touches the sides of the
 * picture, upright or lying, that are nearer. Their half angle has the tangent 0.9 tan 15 degrees,
 * less by the aspect. */
static void tree_of_two(Tree *tree)
{
    assert_int_equal(tree_init(tree, 2, NULL), STATUS_OK);
    for (int i = 0; i < 2; i++) {
        tree->id[i] = i + 1;
        tree->parent[i] = i - 1;
        tree->radius_mm[i] = 2.385;
        tree->position[i] = vec3(3.5, -2, i ? 5.5 : -5.5);
    }
}

static void a_perspective_camera_stands_where_the_nearest_ball_just_fits(void **state)
{
    (void)state;
    Tree tree;
    tree_of_two(&tree);
    StageParams params = stage_defaults();
    params.view.projection = PROJECTION_PERSPECTIVE;
    for (int lying = 0; lying < 2; lying++) {
        params.view.width = lying ? 1000 : 400;
        params.view.height = lying ? 400 : 1000;
        Scene scene;
        assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
        Vec3 expected = vec3(3.5, -2, lying ? 30.33960084026736 : 15.67344740904526);
        assert_true(vec3_distance(scene.view.camera.location, expected) < 1e-12);
        scene_release(&scene);
    }
    tree_release(&tree);
}

static void a_view_is_the_same_where_the_box_is_known(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    for (int projection = 0; projection < 2; projection++) {
        Scene scene;
        Tree tree;
        View again;
        tree_of_two(&tree);
        params.view.tree = &tree;
        params.view.projection = (Projection)projection;
        params.view.box = NULL;
        assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
        Box box = stage_box(&params.view, &scene.geometry);
        params.view.box = &box;
        assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &again, NULL), STATUS_OK);
        assert_memory_equal(&again.camera, &scene.view.camera, sizeof again.camera);
        assert_memory_equal(again.lights, scene.view.lights, again.n_lights * sizeof *again.lights);
        scene_release(&scene);
        tree_release(&tree);
    }
}

static const double degrees = 3.14159265358979323846 / 180;

static void assert_axes(ViewParams params, Vec3 direction, Vec3 up)
{
    Vec3 along, upright;
    view_axes(&params, &along, &upright);
    assert_near(along, direction, 1e-15);
    assert_near(upright, up, 1e-15);
}

static void views_look_where_their_names_say(void **state)
{
    (void)state;
    const double third = 1 / sqrt(3);
    static const struct {
        NamedView view;
        Vec3 direction, up;
    } cases[] = {
        {VIEW_FRONT, {0, 0, -1}, {0, 1, 0}}, {VIEW_BACK, {0, 0, 1}, {0, 1, 0}},
        {VIEW_LEFT, {1, 0, 0}, {0, 1, 0}},   {VIEW_RIGHT, {-1, 0, 0}, {0, 1, 0}},
        {VIEW_TOP, {0, -1, 0}, {0, 0, -1}},  {VIEW_BOTTOM, {0, 1, 0}, {0, 0, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_axes((ViewParams){.view = cases[i].view}, cases[i].direction, cases[i].up);
    Vec3 direction, up;
    view_axes(&(const ViewParams){.view = VIEW_ISO}, &direction, &up);
    assert_near(direction, vec3(-third, -third, -third), 1e-15);
}

static void where_z_is_up_the_front_looks_along_y(void **state)
{
    (void)state;
    assert_axes((ViewParams){.up_axis = UP_Z}, vec3(0, 1, 0), vec3(0, 0, 1));
    assert_axes((ViewParams){.view = VIEW_RIGHT, .up_axis = UP_Z}, vec3(-1, 0, 0), vec3(0, 0, 1));
    assert_axes((ViewParams){.view = VIEW_TOP, .up_axis = UP_Z}, vec3(0, 0, -1), vec3(0, 1, 0));
    StageParams params = stage_defaults();
    params.view.up_axis = UP_Z;
    params.view.has_location = true;
    params.view.location = vec3(3, -70, 8);
    Scene scene = stage(&params, NULL);
    assert_true(scene.view.camera.right.z == 0 && scene.view.camera.up.z > 0);
    scene_release(&scene);
}

static void a_camera_turns_about_the_upright_and_then_rises(void **state)
{
    (void)state;
    const double rise = asin(1 / sqrt(3)) / degrees;
    assert_axes((ViewParams){.turn_deg = 90}, vec3(-1, 0, 0), vec3(0, 1, 0));
    assert_axes((ViewParams){.turn_deg = -90}, vec3(1, 0, 0), vec3(0, 1, 0));
    assert_axes((ViewParams){.rise_deg = 90}, vec3(0, -1, 0), vec3(0, 0, -1));
    assert_axes((ViewParams){.turn_deg = 90, .rise_deg = -90}, vec3(0, 1, 0), vec3(1, 0, 0));
    assert_axes((ViewParams){.turn_deg = 180, .up_axis = UP_Z}, vec3(0, -1, 0), vec3(0, 0, 1));
    for (int up_axis = UP_Y; up_axis <= UP_Z; up_axis++) {
        const ViewParams iso = {.view = VIEW_ISO, .up_axis = (UpAxis)up_axis};
        Vec3 expected, direction, up;
        view_axes(&iso, &expected, &up);
        view_axes(&(const ViewParams){.turn_deg = 45, .rise_deg = rise, .up_axis = iso.up_axis},
                  &direction, &up);
        assert_near(direction, expected, 1e-15);
    }
}

static void a_point_that_is_looked_at_moves_the_framed_camera(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        StageParams params = stage_defaults();
        params.view.view = VIEW_ISO;
        params.view.projection = (Projection)projection;
        Scene framed = stage(&params, NULL);
        params.view.has_look_at = true;
        params.view.look_at = vec3(-5, 4, 2);
        Scene moved = stage(&params, NULL);
        const Camera *camera = &moved.view.camera;
        double i, j;
        project(camera, params.view.look_at, &i, &j);
        assert_true(fabs(i) < 1e-9 && fabs(j) < 1e-9);
        assert_near(camera->direction, framed.view.camera.direction, 0);
        assert_near(camera->up, framed.view.camera.up, 0);
        scene_release(&framed);
        scene_release(&moved);
    }
}

/* The same lights and ground, too. */
static void all_models_of_a_tree_have_one_view(void **state)
{
    (void)state;
    static const SceneModel drawn[] = {SCENE_CYLINDERS, SCENE_JOINED, SCENE_BLOB, SCENE_ISOSURFACE};
    Tree tree = make_tree();
    Look grounded = look;
    grounded.ground = (LookGround){.present = true, .normal = {0.1, 0.2, 1}, .gap = 0.125};
    for (int projection = 0; projection < 2; projection++) {
        StageParams params = stage_defaults();
        params.view.projection = (Projection)projection;
        params.view.shadows = projection == 1;
        params.view.tree = &tree;
        Scene first;
        assert_int_equal(stage_all(&tree, &grounded, &params, &first, NULL, NULL), STATUS_OK);
        for (size_t i = 0; i < sizeof drawn / sizeof *drawn; i++) {
            Scene scene;
            params.geometry.model = drawn[i];
            assert_int_equal(stage_all(&tree, &grounded, &params, &scene, NULL, NULL), STATUS_OK);
            assert_near(scene.view.camera.location, first.view.camera.location, 0);
            assert_near(scene.view.camera.right, first.view.camera.right, 0);
            assert_near(scene.view.camera.direction, first.view.camera.direction, 0);
            assert_near(scene.view.lights[0].location, first.view.lights[0].location, 0);
            assert_true(scene.view.ground.offset_mm == first.view.ground.offset_mm);
            scene_release(&scene);
        }
        scene_release(&first);
    }
    tree_release(&tree);
}

static void a_domain_is_framed_about_the_tree(void **state)
{
    (void)state;
    Tree tree = make_tree();
    const Box domain = {{-30, -12.5, -40}, {30, 27.5, 40}};
    for (size_t i = 0; i < tree.n; i++)
        tree.position[i].x += 5e5;
    const Box far = {vec3_add(domain.low, vec3(5e5, 0, 0)), vec3_add(domain.high, vec3(5e5, 0, 0))};
    StageParams params = stage_defaults();
    params.view.tree = &tree;
    params.view.domain = &far;
    Scene scene;
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
    const Camera *camera = &scene.view.camera;
    assert_true(fabs(vec3_length(camera->right) - 60 / 0.9) < 1e-9);
    Vec3 middle = vec3_add(camera->location, scene.geometry.origin);
    assert_true(fabs(middle.x - 5e5) < 1e-9 && fabs(middle.y - 7.5) < 1e-9 && middle.z > 40);
    scene_release(&scene);
    tree_release(&tree);
}

/* Light from 45 degrees on the left casts a shadow on the sheet to the right of the tree. */
static void shadows_on_the_ground_do_not_move_the_camera(void **state)
{
    (void)state;
    Tree tree = make_tree();
    for (size_t i = 0; i < tree.n; i++)
        tree.position[i] = vec3(0, i ? 2 : -2, 0);
    Look grounded = look;
    grounded.lights[0].direction = vec3(-1, 0, 1);
    grounded.ground = (LookGround){.present = true, .normal = {0, 0, 1}};
    grounded.ground.gap = 1;
    StageParams params = stage_defaults();
    params.view.tree = &tree;
    params.view.margin = 0;
    for (int shadows = 0; shadows < 2; shadows++) {
        Scene scene;
        params.view.shadows = shadows;
        params.view.width = 2000; /* so that the height alone counts */
        assert_int_equal(stage_all(&tree, &grounded, &params, &scene, NULL, NULL), STATUS_OK);
        assert_true(fabs(scene.view.camera.location.x) < 1e-9);
        assert_true(fabs(scene.view.camera.up.y - 2 * (2 + 2.385)) < 1e-9);
        scene_release(&scene);
    }
    tree_release(&tree);
}

static void a_given_camera_is_taken_as_it_is(void **state)
{
    (void)state;
    StageParams params = stage_defaults();
    params.view.projection = PROJECTION_PERSPECTIVE;
    params.view.angle_deg = 90;
    params.view.width = 200;
    params.view.height = 100;
    params.view.has_location = params.view.has_look_at = params.view.has_up = true;
    params.view.location = vec3(0, 0, 40);
    params.view.look_at = vec3(0, 0, 0);
    params.view.up = vec3(1, 0, 0);
    Scene scene = stage(&params, NULL);
    const Camera *camera = &scene.view.camera;
    assert_true(fabs(vec3_length(camera->right) - 2) < 1e-12);
    assert_true(fabs(vec3_length(camera->up) - 1) < 1e-12);
    assert_true(fabs(camera->up.x - 1) < 1e-12);
    assert_true(camera->location.z == 40);
    scene_release(&scene);
}

static void cameras_that_cannot_be_are_refused(void **state)
{
    (void)state;
    Tree tree = make_tree();
    Scene scene;
    Err err;
    StageParams params = stage_defaults();
    params.view.has_location = params.view.has_look_at = true;
    params.view.location = params.view.look_at = vec3(1, 2, 3);
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, &err), STATUS_USAGE);
    assert_non_null(strstr(err.text, "`look_at`"));
    params.view.look_at = vec3(1, 2, 9);
    params.view.has_up = true;
    params.view.up = vec3(0, 0, -2);
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, &err), STATUS_USAGE);
    assert_non_null(strstr(err.text, "`up`"));
    tree_release(&tree);
}

static void a_tree_with_nothing_to_draw_is_refused(void **state)
{
    (void)state;
    Tree tree = make_tree();
    for (size_t i = 0; i < tree.n; i++)
        tree.radius_mm[i] = 0;
    Scene scene;
    Err err;
    StageParams params = stage_defaults();
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "nothing to draw"));
    tree_release(&tree);
}

static void lights_turn_with_the_camera(void **state)
{
    (void)state;
    for (int view = VIEW_FRONT; view <= VIEW_ISO; view++) {
        StageParams params = stage_defaults();
        params.view.view = (NamedView)view;
        Scene scene = stage(&params, NULL);
        Vec3 towards = vec3_sub(scene.view.lights[0].location, scene.view.lights[0].target);
        towards = vec3_normalized(towards);
        double length = sqrt(1 + 4 + 9);
        assert_true(fabs(vec3_dot(towards, vec3_normalized(scene.view.camera.right)) - 1 / length) <
                    1e-9);
        assert_true(fabs(vec3_dot(towards, vec3_normalized(scene.view.camera.up)) - 2 / length) <
                    1e-9);
        assert_true(fabs(vec3_dot(towards, scene.view.camera.direction) + 3 / length) < 1e-9);
        scene_release(&scene);
    }
}

static void the_rays_of_a_camera_go_through_pixel_centres(void **state)
{
    (void)state;
    const Camera camera = {.projection = PROJECTION_ORTHOGRAPHIC,
                           .location = {1, 2, 30},
                           .right = {8, 0, 0},
                           .up = {0, 4, 0},
                           .direction = {0, 0, -1},
                           .width = 4,
                           .height = 2};
    Ray ray = camera_ray(&camera, 0, 0);
    assert_true(ray.origin.x == 1 - 3 && ray.origin.y == 2 + 1 && ray.origin.z == 30);
    ray = camera_ray(&camera, 3, 1);
    assert_true(ray.origin.x == 1 + 3 && ray.origin.y == 2 - 1);
    assert_true(ray.direction.z == -1);
}

static void a_point_light_stands_in_half_diagonals_from_the_middle(void **state)
{
    (void)state;
    Tree tree = make_tree();
    Look soft = look;
    soft.lights[0] = (LookLight){
        .is_point = true, .direction = {0, 0, 3}, .size = 0.5, .samples = 4, .color = {1, 1, 1}};
    StageParams params = stage_defaults();
    Scene scene;
    assert_int_equal(stage_all(&tree, &soft, &params, &scene, NULL, NULL), STATUS_OK);
    const Light *light = &scene.view.lights[0];
    double half = vec3_distance(scene.geometry.bounds.low, scene.geometry.bounds.high) / 2;
    Vec3 center = box_center(scene.geometry.bounds);
    assert_false(light->parallel);
    assert_true(vec3_distance(light->location, vec3(center.x, center.y, center.z + 3 * half)) <
                1e-12);
    assert_int_equal(light->samples, 4);
    for (int side = 0; side < 2; side++) {
        assert_true(fabs(vec3_length(light->sides[side]) - half / 2) < 1e-12);
        assert_true(fabs(light->sides[side].z) < 1e-12);
    }
    scene_release(&scene);
    tree_release(&tree);
}

static void the_ground_lies_just_beyond_the_tree(void **state)
{
    (void)state;
    Tree tree = make_tree();
    for (int in_world = 0; in_world < 2; in_world++)
        for (int view = VIEW_FRONT; view <= VIEW_ISO; view++) {
            Look grounded = look;
            grounded.ground = (LookGround){.present = true,
                                           .in_world = in_world,
                                           .normal = {0, 0, 2.5},
                                           .gap = 0.25,
                                           .color = {0.5f, 0.25f, 1},
                                           .ambient = 0.375,
                                           .diffuse = 0.5};
            StageParams params = stage_defaults();
            params.view.view = (NamedView)view;
            Scene scene;
            assert_int_equal(stage_all(&tree, &grounded, &params, &scene, NULL, NULL), STATUS_OK);
            const Ground *ground = &scene.view.ground;
            Vec3 expected = in_world ? vec3(0, 0, 1) : vec3_scale(scene.view.camera.direction, -1);
            assert_true(vec3_distance(ground->normal, expected) < 1e-12);
            assert_true(ground->finish.ambient == 0.375f && ground->color.b == 1);
            double nearest = HUGE_VAL;
            for (size_t i = 0; i < scene.geometry.n_primitives; i++)
                for (int end = 0; end < 2; end++) {
                    const Primitive *primitive = &scene.geometry.primitives[i];
                    Vec3 place = end ? primitive->b : primitive->a;
                    nearest = fmin(nearest, vec3_dot(ground->normal, place) - primitive->radius_mm -
                                                ground->offset_mm);
                }
            double half = vec3_distance(scene.geometry.bounds.low, scene.geometry.bounds.high) / 2;
            assert_true(fabs(nearest - half / 4) < 1e-9);
            scene_release(&scene);
        }
    tree_release(&tree);
}

/* By whole millimetres, and so by the same bits where quarters are exact. */
static void a_tree_far_from_the_origin_is_staged_next_to_it(void **state)
{
    (void)state;
    Tree tree = make_tree();
    Look grounded = look;
    grounded.ground = (LookGround){.present = true, .normal = {0.6, 0, 0.8}};
    for (SceneModel model = SCENE_CYLINDERS; model <= SCENE_BLOB; model++) {
        StageParams params = stage_defaults();
        Scene near, far;
        Tree moved = make_tree();
        params.geometry.model = model;
        for (size_t i = 0; i < moved.n; i++)
            moved.position[i] = vec3_add(tree.position[i], vec3(1048576, -2097152, 3145728));
        assert_int_equal(stage_all(&tree, &grounded, &params, &near, NULL, NULL), STATUS_OK);
        assert_int_equal(stage_all(&moved, &grounded, &params, &far, NULL, NULL), STATUS_OK);
        Vec3 o = far.geometry.origin, by = vec3_sub(vec3(1048576, -2097152, 3145728), o);
        assert_near(near.geometry.origin, vec3(0, 0, 0), 0);
        assert_true(o.x == round(o.x) && o.y == round(o.y) && o.z == round(o.z));
        assert_true(vec3_length(by) < 30);
        for (size_t i = 0; model != SCENE_JOINED && i < near.geometry.n_primitives; i++)
            assert_near(far.geometry.primitives[i].b, vec3_add(near.geometry.primitives[i].b, by),
                        0);
        for (size_t i = 0; i < near.geometry.n_segments; i++)
            assert_near(far.geometry.segments[i].a, vec3_add(near.geometry.segments[i].a, by), 0);
        assert_near(far.geometry.bounds.low, vec3_add(near.geometry.bounds.low, by), 1e-8);
        assert_near(far.view.camera.location, vec3_add(near.view.camera.location, by), 1e-8);
        assert_near(far.view.lights[0].location, vec3_add(near.view.lights[0].location, by), 1e-7);
        assert_true(fabs(far.view.ground.offset_mm - near.view.ground.offset_mm -
                         vec3_dot(far.view.ground.normal, by)) < 1e-8);
        scene_release(&near);
        scene_release(&far);
        tree_release(&moved);
    }
    tree_release(&tree);
}

static void every_model_numbers_its_segments_alike(void **state)
{
    (void)state;
    Tree tree = make_tree();
    for (SceneModel model = SCENE_CYLINDERS; model <= SCENE_BLOB; model++) {
        StageParams params = stage_defaults();
        Geometry geometry;
        params.geometry.model = model;
        assert_int_equal(stage_geometry(&tree, &params.geometry, &geometry, NULL, NULL), STATUS_OK);
        assert_int_equal(geometry.n_ids, tree.n);
        for (size_t i = 0; i < tree.n; i++)
            assert_int_equal(geometry.ids[i], tree.id[i]);
        bool found[6] = {false};
        for (size_t i = 0; i < geometry.n_primitives; i++)
            found[geometry.primitives[i].segment] = true;
        for (size_t i = 0; i < geometry.n_segments; i++)
            found[geometry.segments[i].segment] = true;
        for (size_t i = 0; i < tree.n; i++) /* a root, three vessels, and two without extent */
            assert_int_equal(found[i], i >= 1 && i <= 3);
        geometry_release(&geometry);
    }
    tree_release(&tree);
}

static void an_appearance_has_the_colors_of_its_field(void **state)
{
    (void)state;
    double values[] = {(double)NAN, 2, 8, 32, 4};
    static float map[2][3] = {{0, 0, 0}, {1, 0, 1}};
    float(*owned)[3] = malloc(sizeof map);
    assert_non_null(owned);
    memcpy(owned, map, sizeof map);
    const Field field = {.name = "flow", .unit = "ml/min", .value = values, .n = 5};
    ColorScale scale = {
        .name = "flow", .unit = "ml/min", .log = true, .map = {.srgb = owned, .n = 2}};
    Appearance appearance;
    assert_true(colorscale_fit(&scale, values, 5));
    assert_int_equal(stage_appearance(&look, &field, &scale, &appearance, NULL), STATUS_OK);
    assert_true(appearance_color(&appearance, 1).r == 0);
    assert_true(appearance_color(&appearance, 3).r == 1);
    assert_true(fabs((double)(appearance_color(&appearance, 2).b - srgb_decode(0.5f))) < 1e-6);
    assert_true(appearance_color(&appearance, 0).g == srgb_decode(0.5f)); /* grey: no value */
    assert_true(appearance.finish.diffuse == look.finish.diffuse);
    assert_string_equal(appearance.scale.unit, "ml/min");
    appearance_release(&appearance);
    assert_int_equal(stage_appearance(&look, NULL, NULL, &appearance, NULL), STATUS_OK);
    assert_true(appearance_color(&appearance, 3).g == look.color.g);
    assert_null(appearance.scale.name);
    appearance_release(&appearance);
}

/* ---- cameras that move ----------------------------------------------------------------------- */

/* A scene of the tree, and the parameters that make its camera. */
static Scene orbit_about(Tree *tree, StageParams *params)
{
    Scene scene;
    *tree = make_tree();
    assert_int_equal(stage_all(tree, &look, params, &scene, NULL, NULL), STATUS_OK);
    orbit_begin(&params->view, &scene.view.camera, &scene.geometry);
    return scene;
}

static void a_camera_that_has_not_moved_is_what_it_was(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++)
        for (int view = VIEW_FRONT; view <= VIEW_ISO; view++) {
            Tree tree;
            StageParams params = stage_defaults();
            params.view.projection = (Projection)projection;
            params.view.view = (NamedView)view;
            params.view.width = 700;
            Scene scene = orbit_about(&tree, &params);
            const Camera before = scene.view.camera;
            const Light light = scene.view.lights[0];
            assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                             STATUS_OK);
            assert_near(scene.view.camera.location, before.location, 1e-9);
            assert_near(scene.view.camera.right, before.right, 1e-9);
            assert_near(scene.view.camera.up, before.up, 1e-9);
            assert_near(scene.view.camera.direction, before.direction, 1e-12);
            assert_near(scene.view.lights[0].location, light.location, 1e-6);
            scene_release(&scene);
            tree_release(&tree);
        }
}

static void what_is_turned_moves_with_the_hand(void **state)
{
    (void)state;
    Tree tree;
    StageParams params = stage_defaults();
    Scene scene = orbit_about(&tree, &params);
    const Camera before = scene.view.camera;
    const Vec3 target = params.view.look_at,
               in_front = vec3_add_scaled(target, before.direction, -3);
    const struct {
        double right, up;
    } cases[] = {{0.2, 0}, {0, 0.2}, {-0.3, 0.1}};
    for (size_t i = 0; i < 3; i++) {
        StageParams moved = params;
        orbit_turn(&moved.view, cases[i].right, cases[i].up);
        assert_true(fabs(vec3_distance(moved.view.location, target) -
                         vec3_distance(params.view.location, target)) < 1e-9);
        assert_int_equal(stage_view(&look, &moved.view, &scene.geometry, &scene.view, NULL),
                         STATUS_OK);
        Vec3 v = vec3_sub(in_front, scene.view.camera.location);
        double right = vec3_dot(v, vec3_normalized(scene.view.camera.right));
        double up = vec3_dot(v, vec3_normalized(scene.view.camera.up));
        assert_true(right * cases[i].right >= 0 && up * cases[i].up >= 0);
        assert_true(fabs(right) + fabs(up) > 0.1);
        assert_true(fabs(vec3_dot(moved.view.up, scene.view.camera.direction)) < 1e-9);
    }
    for (int step = 0; step < 1000; step++)
        orbit_turn(&params.view, 0.013, -0.007);
    assert_true(fabs(vec3_length(params.view.up) - 1) < 1e-12);
    scene_release(&scene);
    tree_release(&tree);
}

/* Height over half of what is shown, of a point beside the one that is looked at. */
static double seen_height(const Scene *scene, Vec3 point)
{
    const Camera *camera = &scene->view.camera;
    Vec3 v = vec3_sub(vec3_add(point, vec3_scale(scene->geometry.origin, -1)), camera->location);
    double up = vec3_dot(v, camera->up) / vec3_dot(camera->up, camera->up);
    if (camera->projection == PROJECTION_PERSPECTIVE)
        up /= vec3_dot(v, camera->direction);
    return up;
}

static void zooming_and_panning_are_by_what_is_looked_at(void **state)
{
    (void)state;
    for (int projection = 0; projection < 2; projection++) {
        Tree tree;
        StageParams params = stage_defaults();
        params.view.projection = (Projection)projection;
        Scene scene = orbit_about(&tree, &params);
        const Vec3 beside = vec3_add_scaled(params.view.look_at, params.view.up, 0.5);
        double before = seen_height(&scene, beside);
        orbit_zoom(&params.view, 1.5);
        assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                         STATUS_OK);
        assert_true(fabs(seen_height(&scene, beside) / before - 1.5) < 1e-9);
        orbit_pan(&params.view, 0, 0.125);
        assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                         STATUS_OK);
        assert_true(fabs(seen_height(&scene, beside) - 1.5 * before - 0.125) < 1e-9);
        scene_release(&scene);
        tree_release(&tree);
    }
}

static void another_projection_keeps_the_size_of_what_is_looked_at(void **state)
{
    (void)state;
    Tree tree;
    StageParams params = stage_defaults();
    params.view.width = 1500;
    Scene scene = orbit_about(&tree, &params);
    const Vec3 beside = vec3_add_scaled(params.view.look_at, params.view.up, 0.5);
    double before = seen_height(&scene, beside);
    for (int i = 0; i < 2; i++) {
        orbit_project(&params.view, i ? PROJECTION_ORTHOGRAPHIC : PROJECTION_PERSPECTIVE,
                      &scene.geometry);
        assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                         STATUS_OK);
        assert_true(fabs(seen_height(&scene, beside) / before - 1) < 1e-9);
    }
    scene_release(&scene);
    tree_release(&tree);
}

static void a_view_is_of_where_the_tree_was_moved_to(void **state)
{
    (void)state;
    Tree tree = make_tree();
    for (size_t i = 0; i < tree.n; i++)
        tree.position[i].x += 5e5;
    StageParams params = stage_defaults();
    Scene scene;
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, NULL), STATUS_OK);
    assert_true(scene.geometry.origin.x > 4e5);
    orbit_begin(&params.view, &scene.view.camera, &scene.geometry);
    assert_true(params.view.location.x > 4e5 && params.view.look_at.x > 4e5);
    const Camera before = scene.view.camera;
    assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                     STATUS_OK);
    assert_near(scene.view.camera.location, before.location, 1e-6);
    scene_release(&scene);
    tree_release(&tree);
}

static void a_camera_without_direction_leaves_the_view_as_it_is(void **state)
{
    (void)state;
    Tree tree;
    StageParams params = stage_defaults();
    Scene scene = orbit_about(&tree, &params);
    const Vec3 before = scene.view.camera.location;
    params.view.location = params.view.look_at;
    assert_int_equal(stage_view(&look, &params.view, &scene.geometry, &scene.view, NULL),
                     STATUS_USAGE);
    assert_near(scene.view.camera.location, before, 0);
    assert_int_equal(scene.view.n_lights, look.n_lights);
    scene_release(&scene);
    tree_release(&tree);
}

/* ---- looks ----------------------------------------------------------------------------------- */

static Status read_look_text(const char *text, Look *out, Err *err)
{
    char path[] = "/tmp/corcast-look-XXXXXX";
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    close(handle);
    assert_int_equal(file_write(path, text, strlen(text), NULL), STATUS_OK);
    Status status = look_read(out, path, err);
    unlink(path);
    return status;
}

static void a_look_is_read(void **state)
{
    (void)state;
    Look read;
    Err err = {{0}};
    Status status = read_look_text(
        "; a comment\n[vessel]\ncolor = 0.25 0.5 0.125\ntips = 0.5 0 1\n[background]\n"
        "color = 0.75 1 0.25\ncorners = 0 0.25 0.5\n[finish]\nphong = 0.375\nambient = "
        "0.125\ndiffuse = 0.6875\n"
        "brilliance = 1.5\nphong_size = 25\nspecular = 0.625\nroughness = 0.03125\n"
        "[light a]\ndirection = 0 1 2\n[light b]\ncolor = 0 0 1\n"
        "[light c]\nposition = 1 2 -3\nsize = 0.75\nround = on\nsamples = 8\n"
        "[ground]\naxis = 0 2 0\ngap = 0.5\ncolor = 1 0.5 0\ndiffuse = 0.25\n"
        "[look]\nabout = red, and shining\n[outline]\nwidth = 2.5\ncrease = 60\n"
        "color = 0 0.5 0\n[halo]\nradii = 3\n[fade]\nnearest = 0.25\n[xray]\nper_mm = 0.75\n"
        "[options]\nao = 24\nshadows = on\nprojection = perspective\n",
        &read, &err);
    assert_string_equal(err.text, "");
    assert_int_equal(status, STATUS_OK);
    assert_true(read.color.r == 0.25f && read.color.g == 0.5f && read.color.b == 0.125f);
    assert_true(read.background.r == 0.75f && read.background.b == 0.25f);
    assert_true(read.finish.ambient == 0.125f && read.finish.diffuse == 0.6875f);
    assert_true(read.finish.phong == 0.375f && read.finish.phong_size == 25);
    assert_true(read.finish.brilliance == 1.5f);
    assert_true(read.finish.specular == 0.625f && read.finish.roughness == 0.03125f);
    assert_int_equal(read.n_lights, 3);
    assert_true(read.lights[0].direction.z == 2 && read.lights[1].color.b == 1);
    assert_true(!read.lights[1].is_point && read.lights[2].is_point);
    assert_true(read.lights[2].direction.z == -3 && read.lights[2].size == 0.75);
    assert_int_equal(read.lights[2].samples, 8);
    assert_true(read.lights[2].round && !read.lights[1].round);
    assert_true(read.ground.present && read.ground.in_world && read.ground.normal.y == 2);
    assert_true(read.ground.gap == 0.5 && read.ground.color.g == 0.5f);
    assert_true(read.ground.ambient == 0.1 && read.ground.diffuse == 0.25);
    assert_true(read.tips.present && read.tips.color.b == 1);
    assert_true(read.corners.present && read.corners.color.g == 0.25f);
    assert_string_equal(read.about, "red, and shining");
    assert_int_equal(read.options.occlusion, 24);
    assert_true(read.options.shadows);
    assert_int_equal(read.options.projection, PROJECTION_PERSPECTIVE);
    const Effects effects = look_effects(&read, 2, 1);
    assert_true(effects.outline.width_px == 5 && effects.outline.color.g == 0.5f);
    assert_true(fabs(effects.outline.crease_cosine - 0.5) < 1e-15);
    assert_true(effects.halo.width_px == 4 && effects.halo.radii == 3);
    assert_true(read.fade_nearest == 0.25 && read.fade_farthest == 0.8);
    assert_true(effects.xray.per_mm == 0.75);
    assert_int_equal(read_look_text("[vessel]\ncolor = 1 1 1\n", &read, &err), STATUS_OK);
    const Effects none = look_effects(&read, 2, 1);
    assert_false(effects_present(&none));
    assert_false(read.ground.present);
    assert_false(read.tips.present || read.corners.present);
    assert_false(read.options.shadows);
    assert_int_equal(read.options.occlusion, 0);
    assert_int_equal(read.options.projection, PROJECTION_ORTHOGRAPHIC);
}

static void a_bad_look_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *line, *says;
    } cases[] = {
        {"[vessel]\ncolor = 1 2 3\n", ":2:", "from 0 to 1"},
        {"[vessel]\ncolor = 1 1\n", ":2:", "three numbers"},
        {"[finish]\nambient = 0.1\nshine = 3\n", ":3:", "ambient"},
        {"[finish]\ndifuse = 1\n", ":2:", "; did you mean diffuse?"},
        {"[backgrund]\n", ":1:", "; did you mean background?"},
        {"[options]\nao = 2.5\n", ":2:", "an integer from 0 to 4096"},
        {"[options]\nao = 5000\n", ":2:", "an integer from 0 to 4096"},
        {"[options]\nshadows = yes\n", ":2:", "on or off"},
        {"[options]\nprojection = fisheye\n", ":2:", "orthographic or perspective"},
        {"[options]\nshadow = on\n", ":2:", "; did you mean shadows?"},
        {"[finish]\ndiffuse = much\n", ":2:", "from 0 to 1"},
        {"[table]\ncolor = 1 1 1\n", ":1:", "sections"},
        {"[light a]\ndirection = 0 0 0\n", ":2:", "not all zero"},
        {"[light a]\ndirection = 0 0 1\nsize = -2\n", ":3:", "from 0 to 100"},
        {"[light a]\nposition = 0 0 1\nsamples = 3\n", ":3:", "2, 4, 8 or 16"},
        {"[light a]\nplace = 0 0 1\n", ":2:", "direction, position"},
        {"[finish]\nphong\n", ":2:", "name = value"},
        {"color = 1 1 1\n", ":1:", "section"},
        {"[ground]\nnormal = 0 0 0\n", ":2:", "not all zero"},
        {"[ground]\ngap = -1\n", ":2:", "from 0 to 100"},
        {"[ground]\nambient = 2\n", ":2:", "from 0 to 1"},
        {"[ground]\nphong = 1\n", ":2:", "normal, axis, gap"},
        {"[outline]\nwidth = 0\n", ":2:", "from 0.1 to 50"},
        {"[outline]\nthickness = 1\n", ":2:", "width, radii"},
        {"[outline]\ncolor = red\n", ":2:", "from 0 to 1"},
        {"[halo]\ndeeper = -1\n", ":2:", "from 0 to 1000"},
        {"[halo]\ncolor = 1 1 1\n", ":2:", "radii or deeper"},
        {"[fade]\nfarthest = 1.5\n", ":2:", "from 0 to 1"},
        {"[xray]\nper_mm = 0\n", ":2:", "from 1e-6 to 1e6"},
        {"[xray]\nlength = 1\n", ":2:", "per_diameter or per_mm"},
        {"[look]\nname = red\n", ":2:", "about"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Look read;
        Err err;
        assert_int_equal(read_look_text(cases[i].text, &read, &err), STATUS_INPUT);
        if (!strstr(err.text, cases[i].line) || !strstr(err.text, cases[i].says))
            fail_msg("case %zu: '%s' lacks '%s' or '%s'", i, err.text, cases[i].line,
                     cases[i].says);
    }
}

/* The latest uncovered elder sister that ends where segment i does, or -1, by looking at all. */
static int32_t sister_of(const Tree *tree, const int32_t *cover, int32_t i)
{
    for (int32_t other = i - 1; other >= 0; other--)
        if (cover[other] < 0 && tree->parent[other] == tree->parent[i] &&
            segment_can_be_drawn(tree, (size_t)other) &&
            vec3_distance(tree->position[other], tree->position[i]) <= 1e-9)
            return other;
    return -1;
}

static void the_thickest_of_the_sisters_that_end_together_is_drawn(void **state)
{
    (void)state;
    enum { N = 900, CLUSTERS = 70 };
    Tree tree;
    Coincidence coincidence;
    Random random;
    random_seed(&random, 2385);
    assert_int_equal(tree_init(&tree, N, NULL), STATUS_OK);
    int32_t cover[N];
    for (int32_t i = 0; i < N; i++) {
        double cluster = floor(CLUSTERS * random_uniform(&random));
        tree.parent[i] = i - 1 < 3 ? i - 1 : i % 3;
        tree.radius_mm[i] = 0.1 + random_uniform(&random);
        tree.position[i] = vec3(cluster * 7.3 - 200, cluster * 1.1, i < 4 ? i : 8);
        tree.position[i].x += 3e-9 * random_uniform(&random);
        tree.position[i].z -= 2e-9 * random_uniform(&random);
        cover[i] = -1;
        int32_t sister = i > 3 ? sister_of(&tree, cover, i) : -1;
        if (sister >= 0 && tree.radius_mm[i] > tree.radius_mm[sister])
            cover[sister] = i;
        else
            cover[i] = sister;
    }
    assert_int_equal(coincidence_find(&tree, &coincidence, NULL), STATUS_OK);
    int covered = 0;
    for (int32_t i = 0; i < N; i++) {
        int32_t place = i;
        while (cover[place] >= 0)
            place = cover[place];
        covered += cover[i] >= 0;
        assert_int_equal(coincidence.junction[i], place);
        assert_int_equal(coincidence.twin[i] >= 0, cover[i] >= 0);
    }
    assert_true(covered > 100 && covered < N - 2 * CLUSTERS);
    coincidence_release(&coincidence);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_anatomy_tells_trees_orders_and_the_way_along_the_thickest_branch),
        cmocka_unit_test(the_path_of_a_tree_without_segments_is_its_root),
        cmocka_unit_test(segments_without_length_or_radius_are_counted_not_drawn),
        cmocka_unit_test(the_thickest_of_the_sisters_that_end_together_is_drawn),
        cmocka_unit_test(a_segment_inside_its_sister_is_left_out),
        cmocka_unit_test(a_sphere_has_the_largest_radius_that_meets),
        cmocka_unit_test(ends_that_are_implied_are_those_that_are_left_out),
        cmocka_unit_test(every_model_has_the_segments_at_their_radii),
        cmocka_unit_test(of_equals_the_segment_that_ends_at_a_place_gives_its_sphere),
        cmocka_unit_test(every_view_frames_the_whole_tree),
        cmocka_unit_test(the_front_view_has_x_to_the_right_and_y_up),
        cmocka_unit_test(a_framed_picture_has_its_margin_on_each_side),
        cmocka_unit_test(a_perspective_camera_stands_where_the_nearest_ball_just_fits),
        cmocka_unit_test(a_view_is_the_same_where_the_box_is_known),
        cmocka_unit_test(views_look_where_their_names_say),
        cmocka_unit_test(where_z_is_up_the_front_looks_along_y),
        cmocka_unit_test(a_camera_turns_about_the_upright_and_then_rises),
        cmocka_unit_test(a_point_that_is_looked_at_moves_the_framed_camera),
        cmocka_unit_test(all_models_of_a_tree_have_one_view),
        cmocka_unit_test(a_domain_is_framed_about_the_tree),
        cmocka_unit_test(shadows_on_the_ground_do_not_move_the_camera),
        cmocka_unit_test(a_given_camera_is_taken_as_it_is),
        cmocka_unit_test(cameras_that_cannot_be_are_refused),
        cmocka_unit_test(a_tree_with_nothing_to_draw_is_refused),
        cmocka_unit_test(lights_turn_with_the_camera),
        cmocka_unit_test(the_rays_of_a_camera_go_through_pixel_centres),
        cmocka_unit_test(a_point_light_stands_in_half_diagonals_from_the_middle),
        cmocka_unit_test(the_ground_lies_just_beyond_the_tree),
        cmocka_unit_test(a_tree_far_from_the_origin_is_staged_next_to_it),
        cmocka_unit_test(every_model_numbers_its_segments_alike),
        cmocka_unit_test(an_appearance_has_the_colors_of_its_field),
        cmocka_unit_test(a_camera_that_has_not_moved_is_what_it_was),
        cmocka_unit_test(what_is_turned_moves_with_the_hand),
        cmocka_unit_test(zooming_and_panning_are_by_what_is_looked_at),
        cmocka_unit_test(another_projection_keeps_the_size_of_what_is_looked_at),
        cmocka_unit_test(a_view_is_of_where_the_tree_was_moved_to),
        cmocka_unit_test(a_camera_without_direction_leaves_the_view_as_it_is),
        cmocka_unit_test(a_look_is_read),
        cmocka_unit_test(a_bad_look_names_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
