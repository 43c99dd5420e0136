/* Smooth trees: curves through the nodes, their distance from the tree, and trees with odd nodes.
 */
#include "stage/stage.h"
#include "unit.h"

#include "field/blob.h"
#include "field/field.h"
#include "stage/coincidence.h"
#include <stdlib.h>

static double random_between(uint64_t *state, double low, double high)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return low + (high - low) * (double)(*state >> 11) / 9007199254740992.0;
}

static Tree tree_of(size_t n, const int32_t *parents, const double *radii, const Vec3 *places)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)(7 * i + 3);
        tree.parent[i] = parents[i];
        tree.radius_mm[i] = radii[i];
        tree.position[i] = places[i];
    }
    return tree;
}

/* A random tree of n nodes, one in `coincident` of which lies on its parent. */
static Tree random_tree(size_t n, uint64_t seed, int coincident)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, n, NULL), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        size_t parent =
            i == 0 ? 0 : (size_t)random_between(&seed, i > 5 ? (double)i - 5 : 0, (double)i);
        Vec3 step = {random_between(&seed, -5, 5), random_between(&seed, -5, 5),
                     random_between(&seed, -5, 5)};
        if (coincident && random_between(&seed, 0, coincident) < 1)
            step = vec3(0, 0, 0);
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = i == 0 || i == n / 2 ? TREE_NO_PARENT : (int32_t)parent;
        tree.position[i] = vec3_add(tree.position[parent], step);
        tree.radius_mm[i] = random_between(&seed, 0.1, 1.7);
    }
    return tree;
}

static SmoothTree smooth_of(const Tree *tree)
{
    SmoothTree smooth;
    assert_int_equal(stage_smooth(tree, SCENE_ROUNDED, &smooth, NULL), STATUS_OK);
    return smooth;
}

/* Returns the number of pieces of segment i, and sets *last to the node where the last one ends. */
static size_t pieces_of(const SmoothTree *smooth, size_t i, size_t *last)
{
    size_t n = 0;
    for (size_t node = 0; node < smooth->tree.n; node++)
        if (smooth->segment[node] == i) {
            n++;
            *last = node;
        }
    return n;
}

/* The centripetal Catmull-Rom spline through four points, by the pyramid of Barry and Goldman. */
static Vec3 pyramid(const Vec3 point[4], double t)
{
    double knot[4] = {0};
    Vec3 at[4];
    for (int i = 1; i < 4; i++)
        knot[i] = knot[i - 1] + sqrt(vec3_distance(point[i], point[i - 1]));
    double x = knot[1] + t * (knot[2] - knot[1]);
    for (int i = 0; i < 4; i++)
        at[i] = point[i];
    for (int level = 1; level < 4; level++)
        for (int i = 0; i < 4 - level; i++) {
            int left = level == 3 ? 1 : i, right = level == 3 ? 2 : i + level;
            double share = (x - knot[left]) / (knot[right] - knot[left]);
            at[i] = vec3_add(vec3_scale(at[i], 1 - share), vec3_scale(at[i + 1], share));
        }
    return at[0];
}

static const Vec3 chain[] = {{0, 20, 0}, {1, 14, 2}, {-3, 9, 5}, {-4.5, 1, 4}, {2, -7, 3}};

static Tree make_chain(void)
{
    static const int32_t parents[] = {-1, 0, 1, 2, 3};
    static const double radii[] = {1.3, 1.3, 1.1, 0.7, 0.65};
    return tree_of(5, parents, radii, chain);
}

static void pieces_lie_on_a_centripetal_spline(void **state)
{
    (void)state;
    Tree tree = make_chain();
    SmoothTree smooth = smooth_of(&tree);
    for (size_t i = 2; i < 4; i++) {
        size_t last = 0, n = pieces_of(&smooth, i, &last);
        assert_in_range(n, 4, SMOOTH_SEGMENT_PIECES);
        for (size_t k = 1; k <= n; k++) {
            Vec3 expected = pyramid(&chain[i - 2], (double)k / (double)n);
            assert_true(vec3_distance(smooth.tree.position[last - n + k], expected) < 1e-13 * 40);
        }
    }
    smoothtree_release(&smooth);
    tree_release(&tree);
}

static void curves_pass_through_all_nodes_and_keep_ids(void **state)
{
    (void)state;
    Tree tree = random_tree(400, 11, 9);
    SmoothTree smooth = smooth_of(&tree);
    for (size_t i = 0; i < tree.n; i++) {
        size_t last = 0, n = pieces_of(&smooth, i, &last);
        assert_in_range(n, 1, SMOOTH_SEGMENT_PIECES);
        assert_memory_equal(&smooth.tree.position[last], &tree.position[i], sizeof(Vec3));
        for (size_t k = 0; k < n; k++)
            assert_int_equal(smooth.tree.id[last - k], tree.id[i]);
    }
    smoothtree_release(&smooth);
    tree_release(&tree);
}

static Vec3 direction_of(const Tree *tree, size_t node)
{
    return vec3_normalized(vec3_sub(tree->position[node], tree->position[tree->parent[node]]));
}

/* Main segments go on in the direction of their parent to within the turn of one piece. A side
 * branch leaves its parent at an angle between that of the straight branch and 0. */
static void the_direction_is_continuous_along_the_main_path(void **state)
{
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 1};
    static const double radii[] = {2, 2, 1.7, 1.1};
    static const Vec3 places[] = {{0, 30, 0}, {0, 0, 0}, {14, -20, 3}, {-20, 0, 0}};
    Tree tree = tree_of(4, parents, radii, places);
    SmoothTree smooth = smooth_of(&tree);
    size_t last[4], n[4];
    for (size_t i = 0; i < 4; i++)
        n[i] = pieces_of(&smooth, i, &last[i]);
    Vec3 arrives = direction_of(&smooth.tree, last[1]);
    Vec3 main = direction_of(&smooth.tree, last[2] - n[2] + 1);
    Vec3 side = direction_of(&smooth.tree, last[3] - n[3] + 1);
    Vec3 straight = vec3_normalized(vec3_sub(places[2], places[1]));
    assert_true(vec3_dot(arrives, main) > 0.995);
    assert_true(vec3_dot(vec3(0, -1, 0), straight) < 0.82);
    /* (2 (-1, 0, 0) + (0, -1, 0)) / 3 is 26.6 degrees from the branch; one piece turns back some */
    assert_true(side.y < -0.3 && side.y > -0.447 && side.x < -0.88);
    smoothtree_release(&smooth);
    tree_release(&tree);
}

/* The largest angle between pieces that follow one another in segment i, and between its first
 * piece and the piece before it. */
static double largest_turn(const SmoothTree *smooth, size_t i)
{
    size_t last = 0;
    double cosine = 1;
    for (size_t k = pieces_of(smooth, i, &last); k-- > 0;) {
        const size_t node = last - k, before = (size_t)smooth->tree.parent[node];
        if (smooth->tree.parent[before] != TREE_NO_PARENT)
            cosine = fmin(cosine, vec3_dot(direction_of(&smooth->tree, before),
                                           direction_of(&smooth->tree, node)));
    }
    return acos(cosine);
}

/* The joint of a thin side branch needs short pieces of the main path, which hardly turns then:
 * pieces of 2.5 radii at the node would turn it by 11 degrees. The joints can be built. */
static void the_main_path_of_joined_vessels_has_no_kink(void **state)
{
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 1};
    static const double radii[] = {2, 2, 1.9, 0.5};
    static const Vec3 places[] = {{0, 30, 0}, {0, 0, 0}, {14, -20, 3}, {-20, 0, 0}};
    Tree tree = tree_of(4, parents, radii, places);
    SmoothTree smooth;
    StageReport report = {0};
    Geometry geometry;
    assert_int_equal(stage_smooth(&tree, SCENE_JOINED, &smooth, NULL), STATUS_OK);
    assert_true(largest_turn(&smooth, 1) < 4 * DEGREE && largest_turn(&smooth, 2) < 4 * DEGREE);
    const GeometryParams params = {.model = SCENE_JOINED, .smooth = &smooth};
    assert_int_equal(stage_geometry(&tree, &params, &geometry, &report, NULL), STATUS_OK);
    assert_int_equal(report.junctions_short + report.junctions_sharp, 0);
    geometry_release(&geometry);
    smoothtree_release(&smooth);
    tree_release(&tree);
}

static void radii_taper_from_node_to_node(void **state)
{
    (void)state;
    Tree tree = make_chain();
    SmoothTree smooth = smooth_of(&tree);
    double before = INFINITY, largest = 0;
    for (size_t node = 1; node < smooth.tree.n; node++) {
        size_t i = smooth.segment[node];
        double radius = smooth.tree.radius_mm[node];
        assert_true(radius <= before);
        if (node > 1)
            assert_true(before - radius <= 0.0201 * (tree.radius_mm[i] + tree.radius_mm[i - 1]));
        largest = fmax(largest, fabs(radius / tree.radius_mm[i] - 1));
        before = radius;
    }
    assert_true(largest > 0.1);
    assert_true(smooth.report.radius_change == largest);
    smoothtree_release(&smooth);
    tree_release(&tree);
}

static double distance_from_segment(const Tree *tree, size_t i, Vec3 point)
{
    Vec3 start = tree->position[tree->parent[i]];
    return sqrt(vec3_distance2_along(vec3_sub(point, start), vec3_sub(tree->position[i], start)));
}

/* Samples each piece densely: no point is farther from its segment than the report states, nor than
 * a quarter of the segment's length, and the stated distance is reached. */
static void the_stated_distance_is_the_maximum(void **state)
{
    (void)state;
    enum { SAMPLES = 50 };
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = random_tree(100, seed, seed % 2 ? 0 : 6);
        SmoothTree smooth = smooth_of(&tree);
        double farthest = 0;
        for (size_t node = 0; node < smooth.tree.n; node++) {
            size_t i = smooth.segment[node];
            if (smooth.twin[node] != NO_TWIN)
                continue;
            Vec3 a = smooth.tree.position[smooth.tree.parent[node]];
            Vec3 span = vec3_sub(smooth.tree.position[node], a);
            for (int k = 0; k <= SAMPLES; k++) {
                double distance =
                    distance_from_segment(&tree, i, vec3_add_scaled(a, span, (double)k / SAMPLES));
                assert_true(distance <= tree_segment_length(&tree, i) / 4 * (1 + 1e-12));
                farthest = fmax(farthest, distance);
            }
        }
        assert_true(farthest > 0.1);
        assert_true(fabs(farthest - smooth.report.distance_mm) < 1e-12);
        smoothtree_release(&smooth);
        tree_release(&tree);
    }
}

/* Points of the curve that are not ends of pieces are within the tolerance of the pieces. */
static void pieces_are_as_near_to_the_curve_as_stated(void **state)
{
    (void)state;
    Tree tree = make_chain();
    SmoothTree smooth;
    assert_int_equal(stage_smooth(&tree, SCENE_ISOSURFACE, &smooth, NULL), STATUS_OK);
    const double length = vec3_distance(chain[2], chain[1]), radius = tree.radius_mm[2];
    size_t last = 0, n = pieces_of(&smooth, 2, &last);
    double farthest = 0;
    for (int k = 0; k < 1000; k++) {
        double t = k / 1000.0;
        size_t node = last - n + 1 + (size_t)(t * (double)n);
        Vec3 a = smooth.tree.position[smooth.tree.parent[node]];
        Vec3 span = vec3_sub(smooth.tree.position[node], a);
        farthest = fmax(farthest, sqrt(vec3_distance2_along(vec3_sub(pyramid(chain, t), a), span)));
    }
    assert_true(length > 5);
    assert_true(farthest <= smooth.report.tolerance * radius);
    assert_true(farthest > 0.02 * smooth.report.tolerance * radius);
    smoothtree_release(&smooth);
    tree_release(&tree);
}

/* Every model draws the pieces, each with its own index and the id of its segment. */
static void stage_every_model(const Tree *tree)
{
    SmoothTree smooth = smooth_of(tree);
    for (size_t i = 0; i < smooth.tree.n; i++) {
        assert_true(vec3_finite(smooth.tree.position[i]) && isfinite(smooth.tree.radius_mm[i]));
        assert_true(smooth.twin[i] != NO_TWIN ||
                    tree_segment_length(&smooth.tree, i) > SHORTEST_MM);
    }
    for (SceneModel model = 0; model < SCENE_MODELS; model++) {
        const GeometryParams params = {
            .model = model, .smooth = &smooth, .mesh = {.tolerance = 0.1}};
        Geometry geometry;
        Err err = {{0}};
        if (model_has(model, MODEL_TRIANGLES))
            continue;
        must(stage_geometry(tree, &params, &geometry, NULL, &err), &err);
        assert_int_equal(geometry.n_ids, smooth.tree.n);
        for (size_t k = 0; k < geometry.n_primitives + geometry.n_segments; k++) {
            uint32_t piece = geometry_segment(&geometry, k);
            assert_true(piece < smooth.tree.n && smooth.twin[piece] != CANNOT_DRAW);
            assert_int_equal(geometry.ids[piece], tree->id[smooth.segment[piece]]);
        }
        geometry_release(&geometry);
    }
    smoothtree_release(&smooth);
}

static void odd_trees_are_smoothed(void **state)
{
    (void)state;
    /* a root with one child, a step of no length, a hairpin, a node on its grandparent, a step of
     * 1e-8 mm, a twin of a segment, a segment without a radius, and a second root */
    static const int32_t parents[] = {-1, 0, 1, 2, 3, 4, 3, 3, 7, -1, 9, 10};
    static const double radii[] = {1, 1, 1, 0.9, 0.9, 0.5, 0.8, 0.7, 0, 2, 2, 2};
    static const Vec3 places[] = {{0, 0, 0}, {0, 9, 0},    {0, 9, 0},  {0, 2, 0},
                                  {0, 9, 0}, {1e-8, 9, 0}, {5, 5, 5},  {5, 5, 5},
                                  {9, 9, 9}, {50, 0, 0},   {50, 1, 0}, {50, 1, 1e-7}};
    Tree tree = tree_of(12, parents, radii, places);
    stage_every_model(&tree);
    for (size_t i = 0; i < tree.n; i++)
        tree.position[i] = vec3_add(tree.position[i], vec3(3e6, -7e6, 2.5e6));
    stage_every_model(&tree);
    tree_release(&tree);
    tree = random_tree(300, 5, 2);
    stage_every_model(&tree);
    tree_release(&tree);
}

/* The curve of two straight segments is straight, also through a node that lies on another. */
static void a_straight_vessel_stays_straight(void **state)
{
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 2};
    static const double radii[] = {1, 1, 1, 1};
    static const Vec3 places[] = {{1, 0, 0}, {1, 9, 0}, {1, 9, 0}, {1, 25, 0}};
    Tree tree = tree_of(4, parents, radii, places);
    SmoothTree smooth = smooth_of(&tree);
    assert_true(smooth.report.distance_mm < 1e-15);
    assert_true(smooth.report.radius_change == 0);
    assert_int_equal(smooth.report.segments, 2);
    assert_int_equal(smooth.report.pieces, 2);
    smoothtree_release(&smooth);
    tree_release(&tree);
}

/* The spline passes a step of no length as if the step were not there. */
static void a_step_of_no_length_changes_nothing(void **state)
{
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 2, 3, 4};
    static const double radii[] = {1.3, 1.3, 1.3, 1.1, 0.7, 0.65};
    const Vec3 places[] = {chain[0], chain[1], chain[1], chain[2], chain[3], chain[4]};
    Tree with = tree_of(6, parents, radii, places), without = make_chain();
    SmoothTree a = smooth_of(&with), b = smooth_of(&without);
    assert_int_equal(a.tree.n, b.tree.n + 1);
    for (size_t i = 0, k = 0; i < a.tree.n; i++) {
        if (a.segment[i] == 2)
            continue;
        assert_memory_equal(&a.tree.position[i], &b.tree.position[k], sizeof(Vec3));
        assert_true(a.tree.radius_mm[i] == b.tree.radius_mm[k++]);
    }
    smoothtree_release(&a);
    smoothtree_release(&b);
    tree_release(&with);
    tree_release(&without);
}

/* A part of a smooth tree is cut from the curves of the whole tree. */
static void a_part_has_the_curves_of_the_whole(void **state)
{
    (void)state;
    Tree tree = make_chain();
    SmoothTree whole = smooth_of(&tree), part;
    assert_int_equal(smoothtree_part(&whole, 0.6, &part, NULL), STATUS_OK);
    assert_in_range(part.tree.n, 3, whole.tree.n - 1);
    for (size_t i = 0; i + 1 < part.tree.n; i++) {
        assert_memory_equal(&part.tree.position[i], &whole.tree.position[i], sizeof(Vec3));
        assert_int_equal(part.segment[i], whole.segment[i]);
        assert_int_equal(part.twin[i], whole.twin[i]);
    }
    smoothtree_release(&part);
    smoothtree_release(&whole);
    tree_release(&tree);
}

/* ---- colors ---------------------------------------------------------------------------------- */

/* A measured vessel: 20 nodes, 3 apart, whose radii jump by up to 35 % from segment to segment. */
static Tree make_measured(void)
{
    Tree tree;
    uint64_t seed = 8;
    assert_int_equal(tree_init(&tree, 20, NULL), STATUS_OK);
    for (size_t i = 0; i < tree.n; i++) {
        const double at = (double)i;
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = (int32_t)i - 1;
        tree.position[i] = vec3(3 * at, 2 * sin(at / 2), cos(at / 3));
        tree.radius_mm[i] = random_between(&seed, 0.85, 1.15) * (1.4 - 0.05 * at);
    }
    return tree;
}

/* Returns the color of a gray map at the values of a field, as 8-bit codes. */
static void color_codes(const Tree *tree, const SmoothTree *smooth, const char *name, double *codes)
{
    static const double classes = 1;
    const TreeMeta said = {.known = {[META_Q_PERF] = true, [META_VISCOSITY] = true},
                           .number = {[META_Q_PERF] = 100, [META_VISCOSITY] = 3.6}};
    const Look look = {.fade_nearest = 0};
    const FieldScaleParams params = {
        .look = &look, .log = true, .classes = &classes, .n_classes = 1};
    FieldSeries whole, pieces;
    FieldValues values;
    Appearance appearance;
    Colormap map = {.n = 2};
    Err err;
    map.srgb = calloc(2, sizeof *map.srgb);
    assert_non_null(map.srgb);
    for (int c = 0; c < 3; c++)
        map.srgb[1][c] = 1;
    must(derive_series(tree, &said, name, &whole, &err), &err);
    if (smooth)
        must(derive_pieces(&(DividedTree){tree, &smooth->tree, smooth->segment}, &said, &whole,
                           &pieces, &err),
             &err);
    must(fieldvalues_take(tree, &whole, NULL, &values, &err), &err);
    if (smooth)
        fieldvalues_show_pieces(&values, &pieces);
    must(fieldscale_color(&params, &map, &values, &values, &appearance, &err), &err);
    assert_true(appearance.outside.below == 0 && appearance.outside.above == 0);
    for (size_t i = 0; i < appearance.n_values; i++)
        codes[i] = 255 * (double)srgb_encode(appearance.colors[i].r);
    appearance_release(&appearance);
    fieldvalues_release(&values);
}

/* Returns the largest difference between the colors of a piece, or a segment, and the one before
 * it. */
static double largest_step(const Tree *tree, const double *codes)
{
    double largest = 0;
    for (size_t i = 2; i < tree->n; i++)
        largest = fmax(largest, fabs(codes[i] - codes[tree->parent[i]]));
    return largest;
}

/* Checks that colors change by at most `most` codes from piece to piece, and that they span most of
 * the scale. */
static void assert_running(const Tree *tree, SceneModel model, const char *name, double most)
{
    static double codes[20 * SMOOTH_SEGMENT_PIECES];
    SmoothTree smooth;
    double low = 255, high = 0;
    assert_int_equal(stage_smooth(tree, model, &smooth, NULL), STATUS_OK);
    color_codes(tree, &smooth, name, codes);
    assert_true(largest_step(&smooth.tree, codes) <= most);
    for (size_t i = 1; i < smooth.tree.n; i++) {
        low = fmin(low, codes[i]);
        high = fmax(high, codes[i]);
    }
    assert_true(high - low > 220);
    smoothtree_release(&smooth);
}

/* Along a measured vessel, colors by the radius and by fields that depend on the radius have no
 * steps at nodes. From segment to segment they change by up to 70 codes. */
static void colors_run_with_the_radius_along_a_vessel(void **state)
{
    (void)state;
    static const char *const names[] = {"radius", "velocity", "wss", "reynolds"};
    double codes[20];
    Tree tree = make_measured();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        color_codes(&tree, NULL, names[k], codes);
        assert_true(largest_step(&tree, codes) > 60);
        assert_running(&tree, SCENE_ROUNDED, names[k], 0.5);
        assert_running(&tree, SCENE_ISOSURFACE, names[k], 8);
    }
    tree_release(&tree);
}

/* ---- the radius of implicit surfaces along curves ------------------------------------------- */

/* Returns the field at a point over the level of the surface: the sum of all terms, or the largest
 * sum of a group. */
static double level_at(const Geometry *geometry, Vec3 point)
{
    const bool blob = model_has(geometry->model, MODEL_BLOB);
    const Blend *blend = &geometry->blend;
    double largest = 0;
    for (size_t group = 0; group < (blend->n_groups ? blend->n_groups : 1); group++) {
        double sum = 0;
        size_t first = blend->n_groups ? blend->members.first[group] : 0;
        size_t end = blend->n_groups ? blend->members.first[group + 1] : geometry->n_segments;
        for (size_t k = first; k < end; k++) {
            const FieldSegment *segment =
                &geometry->segments[blend->n_groups ? blend->members.items[k] : k];
            sum += blob ? blob_segment_value(segment, point)
                        : potential_term(segment, point) / FIELD_LEVEL;
        }
        largest = fmax(largest, sum);
    }
    return largest;
}

static double radius_towards(const Geometry *geometry, Vec3 center, Vec3 outwards)
{
    double low = 0, high = 4;
    for (int i = 0; i < 50; i++) {
        double middle = (low + high) / 2;
        bool inside = level_at(geometry, vec3_add_scaled(center, outwards, middle)) > 1;
        low = inside ? middle : low;
        high = inside ? high : middle;
    }
    return low;
}

/* The largest |radius of the surface / radius of the piece - 1|, across the pieces of the middle
 * segments of a chain. */
static double radius_error(const Tree *tree, SceneModel model, bool graph)
{
    SmoothTree smooth;
    Geometry geometry;
    double largest = 0;
    assert_int_equal(stage_smooth(tree, model, &smooth, NULL), STATUS_OK);
    const GeometryParams params = {.model = model, .smooth = &smooth, .graph = graph};
    assert_int_equal(stage_geometry(tree, &params, &geometry, NULL, NULL), STATUS_OK);
    for (size_t node = 1; node < smooth.tree.n; node++) {
        if (smooth.segment[node] < 3 || smooth.segment[node] + 2 >= tree->n)
            continue;
        Vec3 a = smooth.tree.position[smooth.tree.parent[node]], b = smooth.tree.position[node], u,
             v;
        vec3_perpendiculars(vec3_normalized(vec3_sub(b, a)), &u, &v);
        for (int k = 0; k < 12; k++) {
            double angle = 6.283185307179586 * k / 12;
            Vec3 outwards = vec3_add(vec3_scale(u, cos(angle)), vec3_scale(v, sin(angle)));
            double radius = radius_towards(
                &geometry, vec3_sub(vec3_scale(vec3_add(a, b), 0.5), geometry.origin), outwards);
            largest = fmax(largest, fabs(radius / smooth.tree.radius_mm[node] - 1));
        }
    }
    geometry_release(&geometry);
    smoothtree_release(&smooth);
    return largest;
}

/* Nodes on a circle of `bend` times the radius 1 of the vessel, 4 apart; each radius is `taper`
 * times the one before. */
static Tree make_arc(double bend, double taper)
{
    Tree tree;
    assert_int_equal(tree_init(&tree, 8, NULL), STATUS_OK);
    for (size_t i = 0; i < tree.n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = (int32_t)i - 1;
        tree.radius_mm[i] = i < 2 ? 1 : taper * tree.radius_mm[i - 1];
        tree.position[i] =
            vec3(bend * cos(4 / bend * (double)i), bend * sin(4 / bend * (double)i), 0);
    }
    return tree;
}

/* Pieces neither thicken nor thin a vessel: their terms add up to that of the curve, since the term
 * of a segment is an integral along it. A curve thickens its inner side a little. */
static void surfaces_keep_the_radius_along_curves(void **state)
{
    (void)state;
    static const struct {
        double bend, taper, potential, blob;
    } cases[] = {{1e4, 1, 2e-5, 1e-5}, {20, 1, 0.005, 0.006},    {10, 1, 0.012, 0.012},
                 {5, 1, 0.036, 0.028}, {1e4, 0.9, 7e-4, 1.3e-3}, {10, 0.9, 0.012, 0.012}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Tree tree = make_arc(cases[i].bend, cases[i].taper);
        double potential = radius_error(&tree, SCENE_ISOSURFACE, false);
        double graph = radius_error(&tree, SCENE_ISOSURFACE, true);
        double blob = radius_error(&tree, SCENE_BLOB, false);
        assert_true(potential < cases[i].potential && graph < cases[i].potential);
        assert_true(blob < cases[i].blob);
        tree_release(&tree);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_lie_on_a_centripetal_spline),
        cmocka_unit_test(curves_pass_through_all_nodes_and_keep_ids),
        cmocka_unit_test(the_direction_is_continuous_along_the_main_path),
        cmocka_unit_test(the_main_path_of_joined_vessels_has_no_kink),
        cmocka_unit_test(radii_taper_from_node_to_node),
        cmocka_unit_test(the_stated_distance_is_the_maximum),
        cmocka_unit_test(pieces_are_as_near_to_the_curve_as_stated),
        cmocka_unit_test(odd_trees_are_smoothed),
        cmocka_unit_test(a_straight_vessel_stays_straight),
        cmocka_unit_test(a_step_of_no_length_changes_nothing),
        cmocka_unit_test(a_part_has_the_curves_of_the_whole),
        cmocka_unit_test(colors_run_with_the_radius_along_a_vessel),
        cmocka_unit_test(surfaces_keep_the_radius_along_curves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
