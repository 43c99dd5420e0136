/* The proofs of meshes and prints, tested with false cases made by hand: for each condition a
 * case that no other condition refuses. */
#include "grow/cco/grid.h"
#include "mesh/precision.h"
#include "mesh/proof/meshcheck.h"
#include "mesh/regions/nearpairs.h"
#include "print/seams.h"
#include "unit.h"

#include <string.h>

enum { MOST_POINTS = 24, MOST_TRIANGLES = 40 };

/* A mesh that is put together; its points lie on whole numbers. */
typedef struct Sketch {
    float points[MOST_POINTS][3], normals[MOST_POINTS][3];
    uint32_t triangles[MOST_TRIANGLES][3], labels[MOST_TRIANGLES];
    VesselMesh mesh;
} Sketch;

static void sketch_begin(Sketch *sketch)
{
    *sketch = (Sketch){0};
    sketch->mesh = (VesselMesh){.points = sketch->points,
                                .normals = sketch->normals,
                                .triangles = sketch->triangles,
                                .labels = sketch->labels};
}

static uint32_t add_point(Sketch *sketch, float x, float y, float z)
{
    float *point = sketch->points[sketch->mesh.n_points];
    point[0] = x;
    point[1] = y;
    point[2] = z;
    return (uint32_t)sketch->mesh.n_points++;
}

static void add_triangle(Sketch *sketch, uint32_t a, uint32_t b, uint32_t c, uint32_t label)
{
    size_t n = sketch->mesh.n_triangles++;
    memcpy(sketch->triangles[n], (uint32_t[]){a, b, c}, sizeof sketch->triangles[n]);
    sketch->labels[n] = label;
}

static void add_tetrahedron(Sketch *sketch, const uint32_t at[4], uint32_t label)
{
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    for (int i = 0; i < 4; i++)
        add_triangle(sketch, at[faces[i][0]], at[faces[i][1]], at[faces[i][2]], label);
}

/* A tetrahedron of its own points, 4 wide, at x. */
static void add_sphere(Sketch *sketch, float x, uint32_t label)
{
    const uint32_t at[4] = {add_point(sketch, x, 0, 0), add_point(sketch, x + 4, 0, 0),
                            add_point(sketch, x, 4, 0), add_point(sketch, x, 0, 4)};
    add_tetrahedron(sketch, at, label);
}

/* A ring of three by three points about the z axis at x. */
static void add_torus(Sketch *sketch, float x, uint32_t label)
{
    static const float along[3][2] = {{1, 0}, {-1, 1}, {-1, -1}},
                       across[3][2] = {{8, 0}, {4, 2}, {4, -2}};
    uint32_t at[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            at[i][k] = add_point(sketch, x + across[k][0] * along[i][0], across[k][0] * along[i][1],
                                 across[k][1]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int j = (i + 1) % 3, l = (k + 1) % 3;
            add_triangle(sketch, at[i][k], at[j][k], at[j][l], label);
            add_triangle(sketch, at[i][k], at[j][l], at[i][l], label);
        }
}

/* What the proof says of a mesh whose segment i is of tree trees[i]. */
static MeshReport prove(const Sketch *sketch, const uint32_t *trees, size_t n_trees)
{
    MeshReport report = {.trees = n_trees, .expected_components = n_trees};
    Err err;
    must(meshcheck_topology(&sketch->mesh, trees, &report, &err), &err);
    must(meshcheck_crossings(&sketch->mesh, 1, 1, NULL, &report.crossings, &err), &err);
    return report;
}

static void expect_report(const MeshReport *report, size_t open, size_t crossings, size_t bridges,
                          size_t genus, size_t components)
{
    if (report->open_edges != open || report->crossings != crossings ||
        report->bridges != bridges || report->genus != genus || report->components != components)
        fail_msg("%zu open edges, %zu crossings, %zu bridges, genus %zu, %zu components",
                 report->open_edges, report->crossings, report->bridges, report->genus,
                 report->components);
}

static const uint32_t trees[] = {0, 1};

static void a_sound_mesh_is_proved(void **state)
{
    (void)state;
    Sketch sketch;
    sketch_begin(&sketch);
    add_sphere(&sketch, 0, 0);
    add_sphere(&sketch, 10, 1);
    MeshReport report = prove(&sketch, trees, 2);
    expect_report(&report, 0, 0, 0, 0, 2);
    assert_true(meshreport_is_valid(&report));
}

static void edges_that_two_triangles_do_not_share_one_each_way_are_open(void **state)
{
    (void)state;
    Sketch sketch;
    sketch_begin(&sketch);
    add_sphere(&sketch, 0, 0);
    for (int turned = 0; turned < 4;
         turned++) { /* each triangle in turn, the same way round as its neighbours */
        uint32_t *at = sketch.triangles[turned], last = at[2];
        at[2] = at[1];
        at[1] = last;
        MeshReport report = prove(&sketch, trees, 1);
        expect_report(&report, 3, 0, 0, 0, 1);
        assert_false(meshreport_is_valid(&report));
        at[1] = at[2];
        at[2] = last;
    }
    sketch.mesh.n_triangles--; /* a hole */
    MeshReport report = prove(&sketch, trees, 1);
    assert_int_equal(report.open_edges, 3);
    assert_false(meshreport_is_valid(&report));
    sketch_begin(&sketch); /* an edge of four triangles, two each way */
    add_sphere(&sketch, 0, 0);
    const uint32_t other[4] = {0, add_point(&sketch, -4, -1, 0), add_point(&sketch, -1, -4, 0), 3};
    add_tetrahedron(&sketch, other, 0);
    report = prove(&sketch, trees, 1);
    expect_report(&report, 1, 0, 0, 0, 1);
    assert_false(meshreport_is_valid(&report));
}

static void a_handle_is_found(void **state)
{
    (void)state;
    Sketch sketch;
    sketch_begin(&sketch);
    add_torus(&sketch, 0, 0);
    MeshReport report = prove(&sketch, trees, 1);
    expect_report(&report, 0, 0, 0, 1, 1);
    assert_false(meshreport_is_valid(&report));
}

static void parts_without_a_tree_and_trees_without_a_part_are_found(void **state)
{
    (void)state;
    Sketch sketch;
    sketch_begin(&sketch);
    add_sphere(&sketch, 0, 0);
    add_sphere(&sketch, 10, 0);
    MeshReport report = prove(&sketch, trees, 1);
    expect_report(&report, 0, 0, 0, 0, 2);
    assert_false(meshreport_is_valid(&report));
    sketch_begin(&sketch);
    add_sphere(&sketch, 0, 0);
    report = prove(&sketch, trees, 2);
    expect_report(&report, 0, 0, 0, 0, 1);
    assert_false(meshreport_is_valid(&report));
}

/* As many parts as trees, but one of them holds triangles of both. */
static void a_part_of_two_trees_is_a_bridge(void **state)
{
    (void)state;
    Sketch sketch;
    sketch_begin(&sketch);
    add_sphere(&sketch, 0, 0);
    add_sphere(&sketch, 10, 1);
    sketch.labels[6] = 0;
    MeshReport report = prove(&sketch, trees, 2);
    assert_true(report.bridges > 0);
    expect_report(&report, 0, 0, report.bridges, 0, 2);
    assert_false(meshreport_is_valid(&report));
}

/* Of two spheres that touch or cross, whatever they touch with. */
static void parts_that_meet_cross(void **state)
{
    (void)state;
    static const float others[][4][3] = {
        {{1, 1, 1}, {9, 1, 1}, {1, 9, 1}, {1, 1, 9}}, /* a corner within */
        {{4, 0, 0},
         {9, 0, 0},
         {4, 5, 0},
         {4, 0, 5}}, /* a corner on a corner, of points of its own */
        {{2, 2, 0}, {9, 9, 0}, {2, 9, 0}, {5, 5, 9}},    /* a corner on an edge */
        {{0, 1, 1}, {-4, 0, 0}, {-4, 4, 0}, {-4, 0, 4}}, /* a corner on a face */
        {{1, 1, 0}, {2, 1, 0}, {1, 2, 0}, {1, 1, -4}},   /* a face on a face */
        {{-2, 1, 1}, {6, 1, 1}, {-2, 2, 1}, {-2, 1, 2}}, /* a needle through it */
    };
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        Sketch sketch;
        sketch_begin(&sketch);
        add_sphere(&sketch, 0, 0);
        uint32_t at[4];
        for (int k = 0; k < 4; k++)
            at[k] = add_point(&sketch, others[i][k][0], others[i][k][1], others[i][k][2]);
        add_tetrahedron(&sketch, at, 1);
        MeshReport report = prove(&sketch, trees, 2);
        if (report.crossings == 0)
            fail_msg("case %zu: no crossing", i);
        expect_report(&report, 0, report.crossings, 0, 0, 2);
        assert_false(meshreport_is_valid(&report));
    }
}

static void each_number_of_a_report_alone_makes_it_unsound(void **state)
{
    (void)state;
    const MeshReport sound = {
        .expected_components = 3, .components = 3, .expected_genus = 2, .genus = 2};
    assert_true(meshreport_is_valid(&sound));
    for (int field = 0; field < 8; field++) {
        MeshReport report = sound;
        size_t *const fields[] = {&report.open_edges,     &report.crossings,
                                  &report.bridges,        &report.n_missing,
                                  &report.genus,          &report.components,
                                  &report.expected_genus, &report.expected_components};
        ++*fields[field];
        assert_false(meshreport_is_valid(&report));
        *fields[field] -= field < 4 ? 0 : 2;
        assert_false(meshreport_is_valid(&report));
    }
}

/* A tree of one segment, of which the solid is to have a sphere. */
static Status prove_solid(const Sketch *sketch, size_t rings, MeshReport *report, Err *err)
{
    FieldSegment segment = {.radius_mm = 1};
    uint32_t nodes[1][2] = {{0, 1}}, id = 7;
    const VesselTree tree = {
        .segments = &segment, .nodes = nodes, .ids = &id, .n_segments = 1, .n_nodes = 2};
    SeamGraph seams;
    must(seams_make(&tree, &seams, err), err);
    seams_add_surface(&seams, 0);
    for (size_t i = 0; i < rings; i++)
        seams_add_ring(&seams, 0, 0);
    Status status = seams_prove(&seams, &sketch->mesh, 1, 1, report, err);
    seams_release(&seams);
    return status;
}

/* Handles and parts that the graph of surfaces and rings does not have: an Euler number too low, or
 * too high. */
static void a_solid_has_the_handles_of_its_graph_no_fewer_and_no_more(void **state)
{
    (void)state;
    Err err = {""};
    MeshReport report = {0};
    Sketch sphere, torus, two;
    sketch_begin(&sphere);
    add_sphere(&sphere, 0, 0);
    sketch_begin(&torus);
    add_torus(&torus, 0, 0);
    sketch_begin(&two);
    add_sphere(&two, 0, 0);
    add_sphere(&two, 10, 0);
    assert_int_equal(prove_solid(&sphere, 0, &report, &err), STATUS_OK);
    assert_true(meshreport_is_valid(&report));
    assert_int_equal(prove_solid(&torus, 1, &report, &err), STATUS_OK);
    assert_true(meshreport_is_valid(&report));
    assert_int_equal(prove_solid(&torus, 0, &report, &err), STATUS_DIFFERS);
    assert_non_null(strstr(err.text, "differs by -2"));
    assert_int_equal(prove_solid(&sphere, 1, &report, &err), STATUS_DIFFERS);
    assert_non_null(strstr(err.text, "differs by +2"));
    assert_int_equal(prove_solid(&two, 0, &report, &err), STATUS_DIFFERS);
    assert_non_null(strstr(err.text, "differs by +2"));
    /* A sphere more and a handle more: the Euler number is right, and the parts are not. */
    add_torus(&sphere, 30, 0);
    assert_int_equal(prove_solid(&sphere, 0, &report, &err), STATUS_OK);
    assert_int_equal(report.components, 2);
    assert_false(meshreport_is_valid(&report));
}

/* Two segments that are 3 mm apart where the one is s of its way on and the other t, also close to
 * an end, by both of the functions that proofs take the distance from. */
static void segments_are_as_far_apart_as_where_they_cross(void **state)
{
    (void)state;
    static const double parts[] = {0, 0.01, 0.07, 0.13, 0.5, 0.86, 0.95, 0.99, 1};
    enum { PARTS = sizeof parts / sizeof *parts };
    for (int k = 0; k < 2 * PARTS * PARTS; k++) {
        double s = parts[k % PARTS], t = parts[k / PARTS % PARTS];
        Vec3 one = vec3(10, 0, 0), other = vec3_scale(vec3(4, 9, 0), k < PARTS * PARTS ? 1 : -1);
        Vec3 a = vec3_scale(one, -s), c = vec3_add_scaled(vec3(0, 0, 3), other, -t);
        const FieldSegment first = {.a = a, .b = vec3_add(a, one)};
        const FieldSegment second = {.a = c, .b = vec3_add(c, other)};
        assert_true(fabs(segments_distance(&first, &second) - 3) < 1e-12);
        assert_true(fabs(segments_distance(&second, &first) - 3) < 1e-12);
        assert_true(fabs(segment_distance2(first.a, first.b, second.a, second.b) - 9) < 1e-11);
    }
}

/* A vessel that ends at 2000 mm, where floats are 2^-13 mm apart; likewise with what its mesh is to
 * be joined with. */
static void a_radius_of_16_steps_of_the_mesh_is_enough(void **state)
{
    (void)state;
    const double least = 16.0 / (1 << 13);
    uint32_t ids[] = {7, 8};
    Err err;
    for (int far = 0; far < 2; far++)
        for (int thin = 0; thin < 2; thin++) {
            FieldSegment segments[] = {
                {.a = {1, 2, 3}, .b = {1, 2, far ? 5 : -2000}, .radius_mm = 1},
                {.a = {1, 2, 3}, .b = {4, 5, 6}, .radius_mm = least * (thin ? 0.99 : 1)}};
            const VesselTree tree = {.segments = segments, .n_segments = 2, .ids = ids};
            assert_int_equal(precision_check(&tree, far ? 2000 : 0, &err),
                             thin ? STATUS_INPUT : STATUS_OK);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_mesh_is_proved),
        cmocka_unit_test(edges_that_two_triangles_do_not_share_one_each_way_are_open),
        cmocka_unit_test(a_handle_is_found),
        cmocka_unit_test(parts_without_a_tree_and_trees_without_a_part_are_found),
        cmocka_unit_test(a_part_of_two_trees_is_a_bridge),
        cmocka_unit_test(parts_that_meet_cross),
        cmocka_unit_test(each_number_of_a_report_alone_makes_it_unsound),
        cmocka_unit_test(segments_are_as_far_apart_as_where_they_cross),
        cmocka_unit_test(a_solid_has_the_handles_of_its_graph_no_fewer_and_no_more),
        cmocka_unit_test(a_radius_of_16_steps_of_the_mesh_is_enough),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
