/* The triangulation of vessels, stage by stage and as a whole. The guaranteed search gives the
 * distances. */
#include "base/random.h"
#include "mesh/lattice/octree.h"
#include "mesh/proof/boxpairs.h"
#include "mesh/proof/meshcheck.h"
#include "mesh/regions/junctionfield.h"
#include "mesh/regions/nearpairs.h"
#include "stage/stage.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <stdint.h>

#include "mesh_distance.h"

enum { MOST = 128 };

/* A tree that is made segment by segment. */
typedef struct Sketch {
    FieldSegment segments[MOST];
    uint32_t nodes[MOST][2], ids[MOST];
    Vec3 places[MOST];
    VesselTree tree;
} Sketch;

static void sketch_begin(Sketch *sketch, Vec3 root)
{
    *sketch = (Sketch){.tree = {.n_nodes = 1}};
    sketch->places[0] = root;
}

/* Adds a vessel from a node to a new one, whose number it returns. */
static uint32_t sketch_to(Sketch *sketch, uint32_t from, Vec3 to, double radius)
{
    size_t n = sketch->tree.n_segments++;
    uint32_t node = (uint32_t)sketch->tree.n_nodes++;
    sketch->places[node] = to;
    sketch->segments[n] = (FieldSegment){
        .a = sketch->places[from], .b = to, .radius_mm = radius, .segment = (uint32_t)n};
    sketch->nodes[n][0] = from;
    sketch->nodes[n][1] = node;
    sketch->ids[n] = (uint32_t)n + 2;
    sketch->tree.segments = sketch->segments;
    sketch->tree.nodes = sketch->nodes;
    sketch->tree.ids = sketch->ids;
    return node;
}

typedef struct Made {
    VesselMesh mesh;
    MeshReport report;
} Made;

static void make(const VesselTree *tree, Made *made)
{
    const MeshParams params = {.tolerance = 0.02, .threads = 1};
    Err err = {""};
    Status status = vesselmesh_build(tree, &params, &made->mesh, &made->report, &err);
    must(status, &err);
}

static void release(Made *made)
{
    vesselmesh_release(&made->mesh);
    meshreport_release(&made->report);
}

static void expect_sound(const Made *made, size_t trees)
{
    assert_true(meshreport_is_valid(&made->report));
    assert_int_equal(made->report.components, trees);
    assert_int_equal(made->report.euler, 2 * trees);
}

/* Mean and worst distance, in local radii, both ways, and what the report says of the worst. That
 * is of triangles; the surface is farther at the bottom of a groove alone. */
static void expect_near(const VesselTree *tree, const Made *made, double mean, double worst)
{
    Ruler ruler;
    Random random;
    random_seed(&random, 2385);
    assert_int_equal(ruler_make(&ruler, tree, &made->mesh, &made->report), STATUS_OK);
    for (int way = 0; way < 2; way++) {
        Distances found =
            way ? surface_to_mesh(&ruler, &random, 3000) : mesh_to_surface(&ruler, &random, 3000);
        assert_true(found.n > 1500);
        if (found.mean > mean || found.worst > worst || found.beyond > found.n / 1000)
            fail_msg("%s: mean %g, worst %g, %zu of %zu beyond 0.02",
                     way ? "surface to mesh" : "mesh to surface", found.mean, found.worst,
                     found.beyond, found.n);
        if (found.worst > (way ? 1.5 : 1.05) * made->report.deviation.ratio + 1e-4)
            fail_msg("%s: worst %g, reported %g", way ? "surface to mesh" : "mesh to surface",
                     found.worst, made->report.deviation.ratio);
    }
    ruler_release(&ruler);
}

static void a_straight_vessel_is_a_polygonal_cylinder(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(1.3, -2.1, 0.7));
    sketch_to(&sketch, 0, vec3(4.9, 3.3, -6.1), 0.83);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    double length = vec3_distance(sketch.segments[0].a, sketch.segments[0].b);
    size_t sides = made.mesh.n_triangles / 4;
    assert_int_equal(made.mesh.n_triangles, 4 * sides);
    double area = 0.5 * (double)sides * sin(6.283185307179586 / (double)sides) * 0.83 * 0.83;
    assert_true(fabs(made.report.volume_mm3 / (area * length) - 1) < 1e-5);
    expect_near(&sketch.tree, &made, 0.003, 0.02);
    release(&made);
}

static void a_bifurcation_is_one_sphere_near_its_surface(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(11.3, 0.4, -0.7), 1.31);
    sketch_to(&sketch, fork, vec3(17.9, 5.2, 1.1), 1.07);
    sketch_to(&sketch, fork, vec3(18.4, -4.1, -1.9), 0.94);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_round_ends, 0);
    expect_near(&sketch.tree, &made, 0.003, 0.05);
    release(&made);
}

static void a_measured_tree_is_one_sphere_near_its_surface(void **state)
{
    (void)state;
    Err err = {""};
    Tree tree;
    VesselTree vessels;
    Made made;
    assert_int_equal(tree_read(&tree, "tests/data/coronary.swc", &err), STATUS_OK);
    assert_int_equal(stage_vessels(&tree, NULL, &vessels, NULL, &err), STATUS_OK);
    make(&vessels, &made);
    expect_sound(&made, 1);
    expect_near(&vessels, &made, 0.003, 0.05);
    release(&made);
    vesseltree_release(&vessels);
    tree_release(&tree);
}

/* Rounding carries a point of a rim over the angle that rims begin at. */
static void a_tree_far_from_the_origin_is_as_near_its_surface(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    const Vec3 root = vec3(9000, 7000, -3000);
    sketch_begin(&sketch, root);
    uint32_t fork = sketch_to(&sketch, 0, vec3_add(root, vec3(2.3, 0.4, 0.6)), 0.31);
    sketch_to(&sketch, fork, vec3_add(root, vec3(4.3, 2.6, -0.6)), 0.24);
    sketch_to(&sketch, fork, vec3_add(root, vec3(4.7, -2.5, 0.5)), 0.26);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    expect_near(&sketch.tree, &made, 0.003, 0.03);
    assert_true(made.report.deviation.ratio < 0.03);
    release(&made);
}

/* Two crotches close together, whose triangles would be 0.035 and 0.045 off. */
static void triangles_that_are_too_far_off_are_split(void **state)
{
    (void)state;
    static const double at[2][4][2] = {{{2.75, -0.09}, {3.62, 1.52}, {4.47, 0.75}, {4.47, -1.18}},
                                       {{2.63, -0.05}, {3.73, 1.36}, {5.29, 0.72}, {3.62, -1.48}}};
    static const double radii[2][4] = {{0.27, 0.12, 0.22, 0.13}, {0.27, 0.22, 0.22, 0.12}};
    for (int i = 0; i < 2; i++) {
        Sketch sketch;
        Made made;
        sketch_begin(&sketch, vec3(0, 0, 0));
        uint32_t one = sketch_to(&sketch, 0, vec3(2.31, 0, 0), 0.31), other = 0;
        for (int k = 0; k < 4; k++) {
            uint32_t node = sketch_to(&sketch, k == 0 || k == 1 ? one : other,
                                      vec3(at[i][k][0], at[i][k][1], 0), radii[i][k]);
            other = k == 0 ? node : other;
        }
        make(&sketch.tree, &made);
        expect_sound(&made, 1);
        assert_int_equal(made.report.refined, 0);
        expect_near(&sketch.tree, &made, 0.003, 0.025);
        assert_true(made.report.deviation.ratio < 0.0225);
        release(&made);
    }
}

static void cut(const VesselTree *tree, Junctions *junctions)
{
    const MeshParams params = {.tolerance = 0.02, .threads = 1};
    assert_int_equal(junctions_find(tree, &params, junctions, NULL), STATUS_OK);
}

/* A trunk with twigs 2.18 radii apart, whose segments are clear of both ends nowhere. */
static void sketch_trunk(Sketch *sketch)
{
    sketch_begin(sketch, vec3(0, 0, 0));
    uint32_t node = sketch_to(sketch, 0, vec3(4.1, 0, 0), 0.83);
    for (int i = 1; i <= 4; i++) {
        double x = 4.1 + 1.81 * i, up = i % 2 ? 3.1 : -3.1;
        sketch_to(sketch, node, vec3(x - 1.2, up, 0.2 * i), 0.14);
        node = sketch_to(sketch, node, vec3(x, 0.03 * up, 0), 0.83 - 0.002 * i);
    }
    sketch_to(sketch, node, vec3(15.1, 1.9, 0), 0.61);
    sketch_to(sketch, node, vec3(15.3, -1.4, 0), 0.58);
}

static void a_trunk_is_cut_between_its_twigs(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    Junctions junctions;
    sketch_trunk(&sketch);
    cut(&sketch.tree, &junctions);
    assert_int_equal(junctions.n_junctions, 5);
    int n_close = 0;
    for (size_t i = 0; i < sketch.tree.n_segments; i++)
        n_close += junctions.is_close[i];
    assert_int_equal(n_close, 4);
    junctions_release(&junctions);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    expect_near(&sketch.tree, &made, 0.003, 0.025);
    release(&made);
}

static void a_zone_of_too_many_cells_is_refused(void **state)
{
    (void)state;
    Sketch sketch;
    Junctions junctions;
    JunctionPlan plan;
    Octree tree = {0};
    Err err;
    CellSize size = {.ratio = 0.5, .bending = 0.2, .max_cells = 2385};
    sketch_trunk(&sketch);
    cut(&sketch.tree, &junctions);
    assert_int_equal(junctionplan_make(&sketch.tree, &junctions, 0, &plan, NULL), STATUS_OK);
    assert_int_equal(octree_build(&tree, &plan, &size, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "their surface needs more than 2385 cells"));
    size.max_cells = 100000;
    assert_int_equal(octree_build(&tree, &plan, &size, NULL), STATUS_OK);
    octree_release(&tree);
    junctionplan_release(&plan);
    junctions_release(&junctions);
}

static void a_trifurcation_of_unlike_radii_is_one_sphere(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(13, 0, 0), 1.7);
    sketch_to(&sketch, fork, vec3(21, 6, 1), 1.3);
    sketch_to(&sketch, fork, vec3(20, -5, 3), 0.6);
    sketch_to(&sketch, fork, vec3(14, 2, -9), 0.11);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    expect_near(&sketch.tree, &made, 0.003, 0.05);
    release(&made);
}

/* A bent vessel of 1 mm in steps of `step`, about 16 mm long. */
static void sketch_chain(Sketch *sketch, double step)
{
    uint32_t at = 0;
    sketch_begin(sketch, vec3(0, 0, 0));
    for (int i = 1; i * step < 16; i++)
        at = sketch_to(sketch, at,
                       vec3(i * step, 1.5 * sin(0.3 * i * step), 0.8 * cos(0.2 * i * step)), 1);
}

/* The twig leaves the trunk at 31 degrees and comes out of its wall where the trunk's next segment,
 * with which it does not blend, has begun: the groove between them is narrower than any cell. */
static void a_twig_in_a_groove_is_one_sphere(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(0.817, -1.793, 0), 0.848);
    uint32_t next = sketch_to(&sketch, fork, vec3(1.718, -3.54, 0), 0.847);
    sketch_to(&sketch, next, vec3(2.766, -5.81, 0), 0.843);
    sketch_to(&sketch, fork, vec3(0.445, -7.605, 0), 0.13);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_enclosed, 0);
    expect_near(&sketch.tree, &made, 0.003, 0.05);
    release(&made);
}

static void fine_steps_keep_the_radius(void **state)
{
    (void)state;
    double volumes[2];
    for (int i = 0; i < 2; i++) {
        Sketch sketch;
        Made made;
        sketch_chain(&sketch, i ? 0.2 : 1.1);
        make(&sketch.tree, &made);
        expect_sound(&made, 1);
        assert_int_equal(made.report.n_missing, 0);
        const FieldSegment *last = &sketch.segments[sketch.tree.n_segments - 1];
        volumes[i] = made.report.volume_mm3 / last->b.x;
        release(&made);
    }
    assert_true(fabs(volumes[1] / volumes[0] - 1) < 0.03);
}

/* Two long vessels side by side. */
static void sketch_strangers(Sketch *sketch, double gap)
{
    sketch_begin(sketch, vec3(0, 0, 0));
    sketch_to(sketch, 0, vec3(9.1, 0, 0), 0.7);
    sketch->places[sketch->tree.n_nodes] = vec3(0, 1.2 + gap, 0.3);
    uint32_t other = (uint32_t)sketch->tree.n_nodes++;
    sketch_to(sketch, other, vec3(9.3, 1.2 + gap, -0.3), 0.5);
}

static void near_strangers_stay_apart_and_are_listed(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_strangers(&sketch, 0.025);
    make(&sketch.tree, &made);
    expect_sound(&made, 2);
    assert_int_equal(made.report.n_near, 1);
    assert_true(fabs(made.report.near[0].gap_mm - 0.025) < 1e-9);
    release(&made);
}

static void overlapping_strangers_are_refused_by_name(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    Err err;
    const MeshParams params = {.tolerance = 0.02, .threads = 1};
    sketch_strangers(&sketch, -0.14);
    assert_int_equal(vesselmesh_build(&sketch.tree, &params, &made.mesh, &made.report, &err),
                     STATUS_INPUT);
    assert_non_null(strstr(err.text, "segments 2 and 3"));
}

static void vessels_at_both_ends_of_a_short_one_do_not_blend(void **state)
{
    (void)state;
    Sketch sketch;
    IndexLists incident, blending;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t one = sketch_to(&sketch, 0, vec3(5, 0, 0), 0.5);
    uint32_t two = sketch_to(&sketch, one, vec3(6.4, 0, 0), 0.5);
    sketch_to(&sketch, two, vec3(6.4, 4, 0), 0.5);
    assert_int_equal(vesseltree_incident(&sketch.tree, &incident, NULL), STATUS_OK);
    assert_int_equal(vesseltree_blending(&sketch.tree, &incident, &blending, NULL), STATUS_OK);
    assert_true(indexlists_hold(&blending, one, 0) && indexlists_hold(&blending, one, 1));
    assert_false(indexlists_hold(&blending, one, 2));
    assert_false(indexlists_hold(&blending, two, 0));
    indexlists_release(&incident);
    indexlists_release(&blending);
}

static void a_twig_within_a_trunk_is_swallowed_not_missing(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(10, 0, 0), 2);
    sketch_to(&sketch, fork, vec3(20, 1, 0), 2);
    sketch_to(&sketch, fork, vec3(10.2, 1.1, 0), 0.1);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_enclosed, 1);
    assert_int_equal(made.report.enclosed[0], 2);
    release(&made);
}

/* It reaches five radii into the tube that is cut off behind the junction. */
static void a_twig_along_the_axis_of_a_trunk_is_swallowed_not_missing(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(0.866, -0.618, 0), 0.258);
    sketch_to(&sketch, fork, vec3(1.59, -1.732, 0), 0.108);
    sketch_to(&sketch, fork, vec3(3.055, -3.894, 0), 0.249);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_enclosed, 1);
    assert_int_equal(made.report.enclosed[0], 1);
    release(&made);
}

/* It is so thin that it is not felt at the trunk's wall. */
static void a_twig_that_ends_deep_in_a_trunk_does_not_come_out_behind_a_plane(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0.247, -0.003, 0.097));
    uint32_t fork = sketch_to(&sketch, 0, vec3(0, 0, 0), 0.065);
    sketch_to(&sketch, fork, vec3(-1.613, -0.114, -0.516), 0.063);
    sketch_to(&sketch, fork, vec3(-0.66, -0.044, -0.21), 0.03);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_enclosed, 1);
    assert_int_equal(made.report.enclosed[0], 2);
    release(&made);
}

/* Two vessels leave each other at a small angle: with cells of the usual size triangles were
 * 6.5 % of the radius above the bottom of the groove between them. */
static void no_triangle_lies_far_above_the_bottom_of_a_narrow_groove(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(1.76, 1.118, 0.314));
    uint32_t trunk = sketch_to(&sketch, 0, vec3(0, 0, 0), 0.3424);
    sketch_to(&sketch, trunk, vec3(-3.79, -7.894, 1.035), 0.2985);
    uint32_t fork = sketch_to(&sketch, trunk, vec3(-0.819, -0.086, 0.318), 0.2384);
    sketch_to(&sketch, fork, vec3(-16.358, -1.292, 5.895), 0.2138);
    sketch_to(&sketch, fork, vec3(-4.537, -1.422, 2.795), 0.1557);
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_true(made.report.deviation.ratio < 0.045);
    release(&made);
}

/* A mesh of loose triangles. */
static size_t crossings_of(float (*points)[3], uint32_t (*triangles)[3], size_t n)
{
    uint32_t labels[4] = {0};
    const VesselMesh mesh = {.points = points,
                             .n_points = 3 * n,
                             .triangles = triangles,
                             .labels = labels,
                             .n_triangles = n};
    size_t found = 99;
    assert_int_equal(meshcheck_crossings(&mesh, 0x1p-10, 1, NULL, &found, NULL), STATUS_OK);
    return found;
}

/* How far x is outside the vessels, over the radius of the one that it is nearest to. */
static double outside_round(const VesselTree *tree, Vec3 x)
{
    double least = HUGE_VAL, radius = 1;
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *segment = &tree->segments[i];
        double outside = segment_distance_to(segment, x) - segment->radius_mm;
        if (outside < least) {
            least = outside;
            radius = segment->radius_mm;
        }
    }
    return least / radius;
}

/* On a grid of 0.001 mm, and so after rounding, triangles on the rim of a tube cross. */
static void zones_in_which_triangles_cross_are_made_again(void **state)
{
    (void)state;
    const MeshParams params = {.tolerance = 0.02, .threads = 1, .max_coordinate_mm = 14745.6};
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(2.3, 0.4, 0.6), 0.31);
    sketch_to(&sketch, fork, vec3(4.3, 1.2, -0.32), 0.24);
    sketch_to(&sketch, fork, vec3(4.7, -2.5, 1.34), 0.26);
    assert_int_equal(vesselmesh_build(&sketch.tree, &params, &made.mesh, &made.report, NULL),
                     STATUS_OK);
    expect_sound(&made, 1);
    assert_int_equal(made.report.refined, 1);
    double volume = made.report.volume_mm3;
    release(&made);
    make(&sketch.tree, &made);
    assert_int_equal(made.report.refined, 0);
    assert_true(fabs(volume / made.report.volume_mm3 - 1) < 0.004);
    release(&made);
}

/* Points all over the triangles, as many for each as its area asks for. */
static void expect_round_wall(const VesselTree *tree, const VesselMesh *mesh)
{
    Random random;
    size_t n = 0, beyond = 0;
    double sum = 0, worst = 0;
    random_seed(&random, 2385);
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        Vec3 a = mesh_point(mesh, mesh->triangles[i][0]);
        Vec3 u = vec3_sub(mesh_point(mesh, mesh->triangles[i][1]), a);
        Vec3 v = vec3_sub(mesh_point(mesh, mesh->triangles[i][2]), a);
        double wanted = 40 * vec3_length(vec3_cross(u, v)) + random_uniform(&random);
        for (int k = 1; k <= wanted; k++) {
            double s = random_uniform(&random), t = random_uniform(&random);
            bool over = s + t > 1;
            Vec3 x = vec3_add_scaled(vec3_add_scaled(a, u, over ? 1 - s : s), v, over ? 1 - t : t);
            double off = fabs(outside_round(tree, x));
            n++;
            sum += off;
            beyond += off > 0.02;
            worst = fmax(worst, off);
        }
    }
    if (n < 3000 || sum / (double)n > 0.003 || beyond > n / 500 || worst > 0.05)
        fail_msg("mean %g, worst %g, %zu of %zu beyond 0.02", sum / (double)n, worst, beyond, n);
}

/* A fork, a bend and a branch at a right angle. */
static void the_wall_of_a_round_body_is_that_of_cylinders_and_balls(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    sketch_begin(&sketch, vec3(0, 0, 0));
    uint32_t fork = sketch_to(&sketch, 0, vec3(11.3, 0.4, -0.7), 1.31);
    uint32_t bend = sketch_to(&sketch, fork, vec3(17.9, 5.2, 1.1), 1.07);
    sketch_to(&sketch, fork, vec3(18.4, -4.1, -1.9), 0.94);
    uint32_t side = sketch_to(&sketch, bend, vec3(18.3, 14.6, 1.9), 1.07);
    sketch_to(&sketch, side, vec3(18.7, 24.1, 2.3), 1.07);
    sketch_to(&sketch, side, vec3(26.3, 14.2, 1.7), 0.61);
    sketch.tree.body = BODY_ROUND;
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    assert_int_equal(made.report.n_round_ends, 0);
    for (size_t i = 0; i < made.mesh.n_triangles; i++)
        assert_false(mesh_is_cap(&made.mesh, i));
    for (uint32_t i = 0; i < made.mesh.n_points; i++)
        assert_true(fabs(outside_round(&sketch.tree, mesh_point(&made.mesh, i))) < 1e-4);
    expect_round_wall(&sketch.tree, &made.mesh);
    release(&made);
}

static void fine_steps_of_a_round_body_keep_its_volume(void **state)
{
    (void)state;
    Sketch sketch;
    Made made;
    uint32_t node = 0;
    sketch_begin(&sketch, vec3(0, 0, 0));
    for (int i = 1; i <= 40; i++)
        node = sketch_to(&sketch, node, vec3(0.27 * i, 0.04 * i, 0), 1.31);
    sketch.tree.body = BODY_ROUND;
    make(&sketch.tree, &made);
    expect_sound(&made, 1);
    double length = 40 * sqrt(0.27 * 0.27 + 0.04 * 0.04), r = 1.31;
    double volume = 3.141592653589793 * r * r * (length + 4 * r / 3);
    /* A wall that is 0.003 of the radius too far inside takes twice that of the volume. */
    assert_true(fabs(made.report.volume_mm3 / volume - 1) < 0.006);
    release(&made);
}

/* Returns the largest difference of normals in a ball of 0.45 mm at (0.05, 0, 1.3), on the wall of
 * capsules from a[i] to b[i]. */
static double crease_at_the_wall(const Vec3 *a, const Vec3 *b, const double *radius_mm, uint32_t n)
{
    PotentialTerm terms[MOST];
    uint32_t first[MOST + 1] = {0}, members[MOST];
    LocalFieldPool pool = {0};
    LocalField all;
    NarrowField near;
    Err err = {0};
    for (uint32_t i = 0; i < n; i++) {
        terms[i] = potentialterm_make(a[i], b[i], radius_mm[i], i, BODY_ROUND);
        members[i] = i;
        first[i + 1] = i + 1;
    }
    const JunctionField field = {terms, n, first, members, n};
    const FieldBalls balls = {vec3(0.05, 0, 1.3), 1.2, 0.45};
    assert_int_equal(localfield_from_field(&field, &pool, &all, &err), STATUS_OK);
    assert_int_equal(localfield_narrow(&field, &pool, &all, &balls, &near, &err), STATUS_OK);
    localfieldpool_release(&pool);
    return near.bounds.max_normal_difference;
}

/* The cap between two pieces of a chain is inside them; that of a free end and a side branch make
 * creases. */
static void caps_that_other_vessels_cover_make_no_crease(void **state)
{
    (void)state;
    const Vec3 a[] = {{-1.7, 0, 0}, {-0.9, 0, 0}, {-0.3, 0, 0}, {0.4, 0, 0}, {1.1, 0, 0}};
    const Vec3 b[] = {{-0.9, 0, 0}, {-0.3, 0, 0}, {0.4, 0, 0}, {1.1, 0, 0}, {1.9, 0, 0}};
    const double even[] = {1.3, 1.3, 1.3, 1.3, 1.3}, tapered[] = {1.3, 1.299, 1.298, 1.297, 1.296};
    assert_true(crease_at_the_wall(a, b, even, 5) < 1e-3);
    const double taper = crease_at_the_wall(a, b, tapered, 5);
    assert_true(taper > 0.03 &&
                taper < 0.12); /* the step's ring turns by 2 sqrt(2 / 1300) at most */
    const Vec3 branch_a[] = {{-1.7, 0, 0}, {0, 0, 0}}, branch_b[] = {{1.9, 0, 0}, {0, 0.3, 4.1}};
    assert_true(crease_at_the_wall(branch_a, branch_b, (double[]){1.3, 0.4}, 2) > 0.9);
}

static void triangles_that_pierce_touch_or_fold_are_found(void **state)
{
    (void)state;
    float points[6][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {5, 5, 0.5f}};
    uint32_t apart[2][3] = {{0, 1, 2}, {3, 4, 5}};
    assert_int_equal(crossings_of(points, apart, 2), 1); /* pierced */
    points[3][2] = 0x1p-10f;
    assert_int_equal(crossings_of(points, apart, 2), 0); /* one step of the grid above */
    points[3][2] = 0;
    assert_int_equal(crossings_of(points, apart, 2), 1); /* touched */
    uint32_t at_corner[2][3] = {{0, 1, 2}, {0, 4, 5}};
    assert_int_equal(crossings_of(points, at_corner, 2), 0);
    float flat[4][3] = {{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, 2, 0}};
    uint32_t folded[2][3] = {{0, 1, 2}, {1, 0, 3}};
    assert_int_equal(crossings_of(flat, folded, 2), 1);
    flat[3][1] = -2;
    assert_int_equal(crossings_of(flat, folded, 2), 0);
}

typedef struct Boxes {
    FloatBox at[300];
    size_t found;
} Boxes;

static FloatBox box_at(uint32_t item, const void *context)
{
    return ((const Boxes *)context)->at[item];
}

static void count_pair(uint32_t a, uint32_t b, int worker, void *context)
{
    (void)worker;
    Boxes *boxes = context;
    assert_true(a < b);
    assert_true(floatbox_meets(&boxes->at[a], &boxes->at[b]));
    boxes->found++;
}

/* Crossings of the triangles between a point and each two of six about it that follow each other,
 * these angles in degrees apart and so high above it, and from the last to the first. */
static size_t crossings_about(const double turns[6], const double heights[6])
{
    float points[18][3] = {{0}};
    uint32_t triangles[6][3];
    double angle = 0;
    for (int i = 0; i < 6; i++) {
        points[i + 1][0] = (float)(round(1024 * cos(angle)) / 1024);
        points[i + 1][1] = (float)(round(1024 * sin(angle)) / 1024);
        points[i + 1][2] = (float)heights[i];
        angle += turns[i] / 57.29577951308232;
        triangles[i][0] = 0;
        triangles[i][1] = (uint32_t)i + 1;
        triangles[i][2] = (uint32_t)(i + 1) % 6 + 1;
    }
    return crossings_of(points, triangles, 6);
}

static void triangles_about_a_point_may_cross_or_not(void **state)
{
    (void)state;
    const double once[6] = {70, 50, 60, 65, 55, 60}, back[6] = {110, -70, 80, 110, 65, 65},
                 twice[6] = {118, 122, 120, 119, 121, 120};
    const double flat[6] = {0}, cone[6] = {0.375, 0.5, 0.25, 0.375, 0.25, 0.5},
                 winding[6] = {-0.5, -0.25, 0, 0.5, 0.25, 0};
    assert_int_equal(crossings_about(once, cone), 0);
    assert_true(crossings_about(back, flat) > 0);
    assert_true(crossings_about(twice, winding) > 0);
}

static void all_pairs_of_boxes_that_meet_are_found_once(void **state)
{
    (void)state;
    static Boxes boxes;
    Random random;
    size_t expected = 0;
    random_seed(&random, 71);
    for (int i = 0; i < 300; i++)
        for (int axis = 0; axis < 3; axis++) {
            float low = (float)(10 * random_uniform(&random));
            boxes.at[i].low[axis] = low;
            boxes.at[i].high[axis] = low + (float)(2 * random_uniform(&random));
        }
    for (int i = 0; i < 300; i++)
        for (int j = i + 1; j < 300; j++)
            expected += floatbox_meets(&boxes.at[i], &boxes.at[j]);
    const BoxPairs pairs = {300, box_at, count_pair, &boxes, 1};
    assert_int_equal(boxpairs_find(&pairs, NULL), STATUS_OK);
    assert_true(expected > 100);
    assert_int_equal(boxes.found, expected);
}

/* A tetrahedron with one face inside out, at whose points no direction leads away from all faces.
 */
static void layers_of_a_wall_without_an_inner_side_are_refused(void **state)
{
    (void)state;
    float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, normals[4][3] = {{0}};
    uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, labels[4] = {0};
    VesselMesh mesh = {points, normals, 4, triangles, labels, 4};
    const LayerParams params = {.n_layers = 2, .thickness = 0.1, .growth = 1};
    PrismLayers layers;
    Sketch sketch;
    Err err = {""};
    sketch_begin(&sketch, vec3(0, 0, 0));
    sketch_to(&sketch, 0, vec3(1, 1, 1), 0.5);
    must(prismlayers_sweep(&mesh, &sketch.tree, &params, 1, &layers, &err), &err);
    assert_int_equal(layers.n_prisms, 8);
    assert_true(fabs(layers.volume_mm3 + layers.core_volume_mm3 - 1.0 / 6) < 1e-9);
    prismlayers_release(&layers);
    memcpy(triangles[1], (const uint32_t[3]){0, 1, 2}, sizeof triangles[1]);
    mesh.n_triangles = 2;
    assert_int_equal(prismlayers_sweep(&mesh, &sketch.tree, &params, 1, &layers, &err),
                     STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "inverted prisms"));
    assert_non_null(strstr(err.text, "segment 2"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_vessel_is_a_polygonal_cylinder),
        cmocka_unit_test(a_bifurcation_is_one_sphere_near_its_surface),
        cmocka_unit_test(a_measured_tree_is_one_sphere_near_its_surface),
        cmocka_unit_test(a_tree_far_from_the_origin_is_as_near_its_surface),
        cmocka_unit_test(triangles_that_are_too_far_off_are_split),
        cmocka_unit_test(a_trunk_is_cut_between_its_twigs),
        cmocka_unit_test(a_zone_of_too_many_cells_is_refused),
        cmocka_unit_test(a_trifurcation_of_unlike_radii_is_one_sphere),
        cmocka_unit_test(a_twig_in_a_groove_is_one_sphere),
        cmocka_unit_test(fine_steps_keep_the_radius),
        cmocka_unit_test(near_strangers_stay_apart_and_are_listed),
        cmocka_unit_test(overlapping_strangers_are_refused_by_name),
        cmocka_unit_test(vessels_at_both_ends_of_a_short_one_do_not_blend),
        cmocka_unit_test(a_twig_within_a_trunk_is_swallowed_not_missing),
        cmocka_unit_test(a_twig_along_the_axis_of_a_trunk_is_swallowed_not_missing),
        cmocka_unit_test(a_twig_that_ends_deep_in_a_trunk_does_not_come_out_behind_a_plane),
        cmocka_unit_test(no_triangle_lies_far_above_the_bottom_of_a_narrow_groove),
        cmocka_unit_test(the_wall_of_a_round_body_is_that_of_cylinders_and_balls),
        cmocka_unit_test(fine_steps_of_a_round_body_keep_its_volume),
        cmocka_unit_test(caps_that_other_vessels_cover_make_no_crease),
        cmocka_unit_test(triangles_that_pierce_touch_or_fold_are_found),
        cmocka_unit_test(triangles_about_a_point_may_cross_or_not),
        cmocka_unit_test(zones_in_which_triangles_cross_are_made_again),
        cmocka_unit_test(all_pairs_of_boxes_that_meet_are_found_once),
        cmocka_unit_test(layers_of_a_wall_without_an_inner_side_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
