/* The nearest and farthest hits that rays report, for every kind of geometry: POV-Ray's limits
 * [docs/POVRAY.md, sections 3, 4 and 9]. */
#include "render/cast/caster.h"
#include "unit.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Something so thin, square to the ray (0, 0, 1) from the origin, that it is met at about `at` mm
 * only. */
typedef struct Wire {
    Primitive primitive;
    FieldSegment segment;
    float points[3][3], normals[3][3];
    uint32_t triangle[1][3], label;
    Geometry geometry;
} Wire;

static const double thickness = 2e-6;

static void make_triangle(Wire *wire, double at)
{
    const float x[3] = {-0.01F, 0.01F, 0}, y[3] = {-0.01F, -0.01F, 0.01F};
    for (uint32_t i = 0; i < 3; i++) {
        memcpy(wire->points[i], (float[]){x[i], y[i], (float)at}, sizeof wire->points[i]);
        memcpy(wire->normals[i], (float[]){0, 0, 1}, sizeof wire->normals[i]);
        wire->triangle[0][i] = i;
    }
    wire->label = 0;
    wire->geometry.mesh = (VesselMesh){.points = wire->points,
                                       .normals = wire->normals,
                                       .n_points = 3,
                                       .triangles = wire->triangle,
                                       .labels = &wire->label,
                                       .n_triangles = 1};
}

static void make_wire(Wire *wire, SceneModel model, double at)
{
    Vec3 a = vec3(-0.01, 0, at), b = vec3(0.01, 0, at);
    wire->primitive = (Primitive){
        .kind = PRIMITIVE_CYLINDER, .a = a, .b = b, .radius_mm = thickness / 2, .segment = 23};
    wire->segment = (FieldSegment){.a = a, .b = b, .radius_mm = thickness / 2, .segment = 23};
    wire->geometry = (Geometry){.model = model};
    if (model == SCENE_MESH)
        make_triangle(wire, at);
    if (model_has(model, MODEL_FIELD | MODEL_TRIANGLES)) {
        wire->geometry.segments = &wire->segment;
        wire->geometry.n_segments = 1;
    } else {
        wire->geometry.primitives = &wire->primitive;
        wire->geometry.n_primitives = 1;
    }
}

static bool is_seen(SceneModel model, double at)
{
    Wire wire;
    Caster *caster;
    Surfel surfel;
    make_wire(&wire, model, at);
    assert_int_equal(caster_new(&wire.geometry, NULL, 1, &caster, NULL), STATUS_OK);
    bool seen = caster_first(caster, 0, (Ray){{0, 0, 0}, {0, 0, 1}}, &surfel);
    assert_true(!seen || (surfel.segment == 23 && fabs(surfel.t - at) <= thickness));
    caster_free(caster);
    return seen;
}

static bool casts_shadow(SceneModel model, double at, double light)
{
    Wire wire;
    Caster *caster;
    make_wire(&wire, model, at);
    assert_int_equal(caster_new(&wire.geometry, NULL, 1, &caster, NULL), STATUS_OK);
    const Ground no_ground = {0};
    bool dark = caster_shadow(caster, 0, &no_ground, vec3(0, 0, 0), vec3(0, 0, 1), light);
    caster_free(caster);
    return dark;
}

static void nothing_nearer_than_a_ten_thousandth_is_seen(void **state)
{
    (void)state;
    const SceneModel either[] = {SCENE_CYLINDERS, SCENE_ISOSURFACE, SCENE_MESH};
    for (int i = 0; i < 3; i++) {
        assert_false(is_seen(either[i], 1e-4 - 1.01 * thickness));
        assert_true(is_seen(either[i], 1e-4 + 1.01 * thickness));
    }
}

static void nothing_within_a_thousandth_of_point_or_light_casts_a_shadow(void **state)
{
    (void)state;
    const SceneModel either[] = {SCENE_CYLINDERS, SCENE_ISOSURFACE, SCENE_MESH};
    for (int i = 0; i < 3; i++) {
        assert_false(casts_shadow(either[i], 1e-3 - 1.01 * thickness, 3));
        assert_true(casts_shadow(either[i], 1e-3 + 1.01 * thickness, 3));
        assert_true(casts_shadow(either[i], 3 - 1e-3 - 1.01 * thickness, 3));
        assert_false(casts_shadow(either[i], 3 - 1e-3 + 1.01 * thickness, 3));
    }
}

static void nothing_of_a_blob_nearer_than_a_hundredth_is_seen_or_casts_a_shadow(void **state)
{
    (void)state;
    assert_false(is_seen(SCENE_BLOB, 1e-2 - 1.01 * thickness));
    assert_true(is_seen(SCENE_BLOB, 1e-2 + 1.01 * thickness));
    assert_false(casts_shadow(SCENE_BLOB, 1e-2 - 1.01 * thickness, 3));
    assert_true(casts_shadow(SCENE_BLOB, 1e-2 + 1.01 * thickness, 3));
    assert_true(casts_shadow(SCENE_BLOB, 3 - 1e-3 - 1.01 * thickness, 3));
    assert_false(casts_shadow(SCENE_BLOB, 3 - 1e-3 + 1.01 * thickness, 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_nearer_than_a_ten_thousandth_is_seen),
        cmocka_unit_test(nothing_within_a_thousandth_of_point_or_light_casts_a_shadow),
        cmocka_unit_test(nothing_of_a_blob_nearer_than_a_hundredth_is_seen_or_casts_a_shadow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
