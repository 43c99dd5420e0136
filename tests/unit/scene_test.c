/* Cameras, lights and grounds; parts and ends of meshes; the list of models. */
#include "scene/scene.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const Camera cameras[] = {
    {.projection = PROJECTION_ORTHOGRAPHIC,
     .location = {12, -3.5, 90},
     .right = {38.4, 0, 28.8},
     .up = {0, 30.5, 0},
     .direction = {0.6, 0, -0.8},
     .width = 203,
     .height = 141},
    {.projection = PROJECTION_PERSPECTIVE,
     .location = {12, -3.5, 90},
     .right = {0.4, 0, 0.3},
     .up = {0, 0.31, 0},
     .direction = {0.6, 0, -0.8},
     .width = 203,
     .height = 141},
};

/* The inverse of camera_ray, by another way than POV-Ray's: it solves point = location + z
 * direction
 * + x right + y up by cross products. False where a perspective camera sees nothing. */
static bool camera_project(const Camera *camera, Vec3 point, double *i, double *j, double *depth_mm)
{
    bool perspective = camera->projection == PROJECTION_PERSPECTIVE;
    Vec3 from = vec3_sub(point, camera->location), normal = vec3_cross(camera->right, camera->up);
    double z = vec3_dot(from, normal) / vec3_dot(camera->direction, normal);
    if (perspective && !(z > 0))
        return false;
    Vec3 offset = vec3_add_scaled(from, camera->direction, -z);
    double per_area = 1 / (vec3_dot(normal, normal) * (perspective ? z : 1));
    double x0 = vec3_dot(vec3_cross(offset, camera->up), normal) * per_area;
    double y0 = vec3_dot(vec3_cross(camera->right, offset), normal) * per_area;
    *i = (x0 + 0.5) * camera->width - 0.5;
    *j = (0.5 - y0) * camera->height - 0.5;
    *depth_mm = perspective ? vec3_length(from) : z * vec3_length(camera->direction);
    return true;
}

static void a_point_is_seen_where_the_ray_meets_it(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (int n = 0; n < 1000; n++) {
        const Camera *camera = &cameras[n % 2];
        double i = 203 * random_uniform(&random) - 0.5, j = 141 * random_uniform(&random) - 0.5;
        double t = 0.1 + 200 * random_uniform(&random), seen_i, seen_j, depth;
        Vec3 point = ray_at(camera_ray(camera, i, j), t);
        assert_true(camera_project(camera, point, &seen_i, &seen_j, &depth));
        assert_true(fabs(seen_i - i) < 1e-9 && fabs(seen_j - j) < 1e-9);
        assert_true(fabs(depth - t) < 1e-11 * t + 1e-11);
    }
}

static void a_perspective_camera_sees_nothing_behind_itself(void **state)
{
    (void)state;
    double i = 7, j = 8, depth = 9;
    Vec3 behind = vec3_add_scaled(cameras[1].location, cameras[1].direction, -2.385);
    assert_false(camera_project(&cameras[1], behind, &i, &j, &depth));
    assert_true(i == 7 && j == 8 && depth == 9);
    behind = vec3_add_scaled(cameras[0].location, cameras[0].direction, -2.385);
    assert_true(camera_project(&cameras[0], behind, &i, &j, &depth));
    assert_true(fabs(i - 101) < 1e-9 && fabs(j - 70) < 1e-9 && fabs(depth + 2.385) < 1e-12);
}

static void a_camera_of_one_pixel_sees_what_the_pixel_sees(void **state)
{
    (void)state;
    for (int n = 0; n < 2; n++) {
        const Camera one = camera_of_pixel(&cameras[n], 37, 101);
        const double places[][2] = {{0, 0}, {-0.25, 0.375}, {0.5, -0.5}};
        for (int k = 0; k < 3; k++) {
            Ray whole = camera_ray(&cameras[n], 37 + places[k][0], 101 + places[k][1]);
            Ray alone = camera_ray(&one, places[k][0], places[k][1]);
            assert_true(vec3_distance(whole.origin, alone.origin) < 1e-12);
            assert_true(vec3_distance(whole.direction, alone.direction) < 1e-14);
            double i, j, depth; /* of a camera whose vectors are not square to each other */
            assert_true(camera_project(&one, ray_at(whole, 23.85), &i, &j, &depth));
            assert_true(fabs(i - places[k][0]) < 1e-9 && fabs(j - places[k][1]) < 1e-9);
            assert_true(fabs(depth - 23.85) < 1e-12);
        }
    }
}

static void the_depth_range_holds_the_box(void **state)
{
    (void)state;
    const Box box = {{3, -9, 20}, {30.5, 7, 41}};
    for (int n = 0; n < 2; n++) {
        double near, far, i, j, depth;
        camera_depth_range(&cameras[n], box, &near, &far);
        for (int corner = 0; corner < 8; corner++) {
            Vec3 at = vec3(corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                           corner & 4 ? box.low.z : box.high.z);
            assert_true(camera_project(&cameras[n], at, &i, &j, &depth));
            assert_true(depth >= near && depth <= far);
        }
        assert_true(far - near < 40);
    }
}

static void the_way_to_a_light_is_straight(void **state)
{
    (void)state;
    const Light point = {.location = {3, 4, 12}};
    LightDirection way = light_direction(&point, vec3(0, 0, 0));
    assert_true(fabs(way.distance - 13) < 1e-14 && fabs(way.towards.y - 4.0 / 13) < 1e-15);
    const Light parallel = {.location = {3, 4, 12}, .target = {3, 4, 2}, .parallel = true};
    way = light_direction(&parallel, vec3(77, -5, 2.5));
    assert_true(way.towards.z == 1 && way.distance == 9.5);
}

/* Rows of four along the first side. */
static void the_points_of_an_area_light_span_its_sides(void **state)
{
    (void)state;
    const Light area = {.location = {0, 0, 5}, .samples = 4, .sides = {{3, 0, 0}, {0, 6, 0}}};
    assert_int_equal(light_points(&area), 16);
    const struct {
        int k;
        double x, y;
    } cases[] = {{0, -1.5, -3}, {3, 1.5, -3}, {5, -0.5, -1}, {15, 1.5, 3}};
    for (int i = 0; i < 4; i++) {
        LightDirection way = light_direction_to_point(&area, cases[i].k, vec3(0, 0, 0));
        Vec3 at = vec3_scale(way.towards, way.distance);
        assert_true(vec3_distance(at, vec3(cases[i].x, cases[i].y, 5)) < 1e-14);
    }
}

/* As POV-Ray's `circular`. The rows of the square become curves: of 100 heights at least 60 have a
 * point, and a level vessel casts that many shadows instead of 16. */
static void the_points_of_a_round_light_lie_on_circles(void **state)
{
    (void)state;
    const Light disc = {.round = true, .samples = 16, .sides = {{2, 0, 0}, {0, 2, 0}}};
    bool has[101] = {false};
    int n = 0;
    for (int k = 0; k < light_points(&disc); k++) {
        Vec3 at = light_at_point(&disc, k).location;
        double u = 2 * (k % 16 / 15.0 - 0.499), v = 2 * (k / 16 / 15.0 - 0.499);
        assert_true(fabs(vec3_length(at) - fmax(fabs(u), fabs(v))) < 1e-14);
        assert_true(fabs(at.x * v - at.y * u) < 1e-14 && at.x * u >= 0);
        has[(int)(50 + 49 * at.y)] = true;
    }
    for (int i = 0; i <= 100; i++)
        n += has[i];
    assert_true(n >= 60);
}

/* POV-Ray's limits [docs/POVRAY.md, section 4]. */
static void a_ground_is_not_seen_along_itself_nor_beyond_all_bounds(void **state)
{
    (void)state;
    const Ground ground = {.present = true, .normal = {0, 1, 0}, .offset_mm = -1e-4};
    double t;
    assert_false(ground_hit(&ground, (Ray){{0, 0, 0}, {1, -0.99e-10, 0}}, 0, HUGE_VAL, &t));
    assert_true(ground_hit(&ground, (Ray){{0, 0, 0}, {1, -1.01e-10, 0}}, 0, HUGE_VAL, &t));
    assert_true(fabs(t - 1e-4 / 1.01e-10) < 1);
    const Vec3 down = {0, -1, 0};
    assert_true(ground_hit(&ground, (Ray){{0, 0.999e7, 0}, down}, 0, HUGE_VAL, &t));
    assert_false(ground_hit(&ground, (Ray){{0, 1.001e7, 0}, down}, 0, HUGE_VAL, &t));
}

/* Two triangles of segments 3 and 5 with an edge in common. */
static void the_part_of_a_mesh_has_the_triangles_of_its_segments(void **state)
{
    (void)state;
    float at[4][3] = {{0, 0, 0}, {2.385F, 0, 0}, {0, 1.7F, 0}, {2.5F, 1.9F, 0}};
    uint32_t corners[2][3] = {{0, 1, 2}, {3, 2, 1}}, labels[2] = {3, 5 | MESH_CAP};
    const VesselMesh mesh = {at, at, 4, corners, labels, 2};
    const uint32_t segments[] = {1, 5, 8};
    VesselMesh part;
    assert_int_equal(vesselmesh_part(&mesh, segments, 3, &part, NULL), STATUS_OK);
    assert_int_equal(part.n_triangles, 1);
    assert_int_equal(part.n_points, 3);
    assert_int_equal(part.labels[0], 1 | MESH_CAP);
    for (int k = 0; k < 3; k++)
        assert_memory_equal(part.points[part.triangles[0][k]], at[corners[1][k]], sizeof at[0]);
    vesselmesh_release(&part);
}

/* Two segments along z, one behind the other's end, ids 1017 and 5; triangles of 1.5 x 2 / 2 mm^2
 * that face up or down. */
static FieldSegment along_z[] = {{{0, 0, 0}, {0, 0, 2.385}, 0.9, 0},
                                 {{0, 0, 4}, {0, 0, 3}, 0.7, 1}};
static uint32_t z_nodes[][2] = {{0, 1}, {2, 3}}, z_ids[] = {1017, 5};
static const VesselTree z_tree = {
    .segments = along_z, .nodes = z_nodes, .ids = z_ids, .n_segments = 2, .n_nodes = 4};
static float flat_points[][3] = {{0, 0, 0}, {1.5, 0, 0}, {0, 2, 0}};
static uint32_t up[] = {0, 1, 2}, down[] = {0, 2, 1};

static void expect_end(const MeshEnds *ends, size_t i, const char *name, uint32_t segment, double z)
{
    const MeshEnd *end = &ends->ends[i];
    assert_string_equal(end->name, name);
    assert_int_equal(end->segment, segment);
    assert_true(end->center.z == z);
    assert_true(end->radius_mm == (segment ? 0.7 : 0.9));
}

static void ends_are_named_by_ids_inlets_first(void **state)
{
    (void)state;
    uint32_t triangles[5][3],
        labels[] = {0 | MESH_CAP, 0, 1 | MESH_CAP, 0 | MESH_CAP, 1 | MESH_CAP};
    for (int i = 0; i < 5; i++)
        memcpy(triangles[i], i == 0 || i == 4 ? up : down, sizeof up);
    const VesselMesh mesh = {flat_points, flat_points, 3, triangles, labels, 5};
    MeshEnds ends;
    assert_int_equal(meshends_find(&mesh, &z_tree, &ends, NULL), STATUS_OK);
    assert_int_equal(meshends_parts(&ends), 5);
    assert_string_equal(meshends_part_name(&ends, 0), "wall");
    expect_end(&ends, 0, "inlet_0005", 1, 4);
    expect_end(&ends, 1, "inlet_1017", 0, 0);
    expect_end(&ends, 2, "outlet_0005", 1, 3);
    expect_end(&ends, 3, "outlet_1017", 0, 2.385);
    assert_true(fabs(ends.ends[0].normal.z - 1) < 1e-12);
    assert_true(fabs(ends.ends[3].area_mm2 - 1.5) < 1e-6);
    const uint32_t parts[] = {4, 0, 3, 2, 1};
    assert_memory_equal(ends.parts, parts, sizeof parts);
    meshends_release(&ends);
}

static void a_hollow_wall_has_discs_and_rings_and_a_frame_no_ends(void **state)
{
    (void)state;
    uint32_t triangles[5][3];
    uint32_t labels[] = {0, MESH_LUMEN, 0 | MESH_CAP, 0 | MESH_CAP | MESH_LUMEN,
                         1 | MESH_CAP | MESH_FRAME};
    for (int i = 0; i < 5; i++)
        memcpy(triangles[i], down, sizeof down);
    const VesselMesh mesh = {flat_points, flat_points, 3, triangles, labels, 5};
    MeshEnds ends;
    assert_int_equal(meshends_find(&mesh, &z_tree, &ends, NULL), STATUS_OK);
    static const char *const names[] = {"outer", "lumen", "frame", "inlet", "inlet_ring"};
    assert_int_equal(meshends_parts(&ends), 5);
    for (size_t i = 0; i < 5; i++)
        assert_string_equal(meshends_part_name(&ends, i), names[i]);
    const uint32_t parts[] = {0, 1, 4, 3, 2};
    assert_memory_equal(ends.parts, parts, sizeof parts);
    meshends_release(&ends);
}

static void models_are_listed_by_what_they_are_made_of(void **state)
{
    (void)state;
    assert_string_equal(models_of(MODEL_PRIMITIVES).text, "cylinders, joined and rounded");
    assert_string_equal(models_of(MODEL_CYLINDERS | MODEL_BALLS).text, "cylinders and rounded");
    assert_string_equal(models_with(MODEL_FIELD).text, "isosurface and blob");
    assert_string_equal(models_with(MODEL_JOINTS).text, "joined");
    assert_string_equal(models_of(MODEL_TRIANGLES).text, "mesh");
    assert_int_equal(model_with(MODEL_TRIANGLES), SCENE_MESH);
    for (int i = 0; i < SCENE_MODELS; i++) {
        assert_string_equal(models[i].name, model_names[i]);
        assert_true(model_has((SceneModel)i, MODEL_ELEMENTS) && *models[i].description);
    }
    assert_null(model_names[SCENE_MODELS]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_is_seen_where_the_ray_meets_it),
        cmocka_unit_test(a_perspective_camera_sees_nothing_behind_itself),
        cmocka_unit_test(a_camera_of_one_pixel_sees_what_the_pixel_sees),
        cmocka_unit_test(the_depth_range_holds_the_box),
        cmocka_unit_test(the_way_to_a_light_is_straight),
        cmocka_unit_test(the_points_of_an_area_light_span_its_sides),
        cmocka_unit_test(the_points_of_a_round_light_lie_on_circles),
        cmocka_unit_test(models_are_listed_by_what_they_are_made_of),
        cmocka_unit_test(the_part_of_a_mesh_has_the_triangles_of_its_segments),
        cmocka_unit_test(ends_are_named_by_ids_inlets_first),
        cmocka_unit_test(a_hollow_wall_has_discs_and_rings_and_a_frame_no_ends),
        cmocka_unit_test(a_ground_is_not_seen_along_itself_nor_beyond_all_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
