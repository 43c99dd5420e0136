/* Growth in domains that are not convex: every whole segment stays in the tissue, not only its
 * ends. */
#include "grow/grow.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Tree grow_in(const Domain *domain, size_t terminals, GrowReport *report)
{
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.seed = 2385;
    params.blood.q_perf_ml_min = 60;
    Tree tree;
    Err err = {{0}};
    must(grow_tree(&params, domain, &tree, report, &err), &err);
    return tree;
}

/* Samples along every segment, each inside or within the tolerance that growth has at the rim. */
static void expect_whole_segments_inside(const char *spec, size_t terminals)
{
    Domain domain = {0};
    Err err = {{0}};
    must(domain_parse(&domain, spec, &err), &err);
    assert_false(domain_is_convex(&domain));
    GrowReport report;
    Tree tree = grow_in(&domain, terminals, &report);
    assert_int_equal(report.terminals, terminals);
    Box box = domain.bounds;
    double tolerance = 2e-6 * vec3_distance(box.low, box.high);
    for (size_t i = 1; i < tree.n; i++) {
        Vec3 a = tree.position[tree.parent[i]], b = tree.position[i];
        for (int k = 0; k <= 40; k++) {
            Vec3 point = vec3_add_scaled(a, vec3_sub(b, a), k / 40.0);
            if (!domain_inside(&domain, point, tolerance))
                fail_msg("%s: segment %zu leaves the domain at %g, %g, %g", spec, i, point.x,
                         point.y, point.z);
        }
    }
    tree_release(&tree);
    domain_release(&domain);
}

static void segments_stay_in_a_bent_polygon_with_a_hole(void **state)
{
    (void)state;
    char path[] = "build/polygon-XXXXXX";
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    close(handle);
    static const char points[] =
        "0 0\n40 0\n40 14\n15 14\n15 45\n0 45\n\n5 20\n10 20\n10 28\n5 28\n";
    assert_int_equal(file_write(path, points, sizeof points - 1, NULL), STATUS_OK);
    char spec[64];
    snprintf(spec, sizeof spec, "polygon:%s", path);
    expect_whole_segments_inside(spec, 400);
    unlink(path);
}

static void segments_stay_in_the_wall_of_a_shell(void **state)
{
    (void)state;
    expect_whole_segments_inside("shell:30,45,30,10", 300);
}

static void segments_stay_in_a_heart(void **state)
{
    (void)state;
    const char *shared = getenv("CORCAST_SHARED");
    char path[512];
    snprintf(path, sizeof path, "%s/data/domains_stl/biventricle_tissue.stl",
             shared ? shared : "../shared");
    if (access(path, R_OK) != 0) {
        print_message("SKIPPED: %s is not here\n", path);
        skip();
    }
    char spec[600];
    snprintf(spec, sizeof spec, "mesh:%s,10", path);
    expect_whole_segments_inside(spec, 2000);
}

static void the_header_tells_the_file_of_a_domain_without_its_folder(void **state)
{
    (void)state;
    char path[] = "build/polygon-XXXXXX";
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    close(handle);
    assert_int_equal(file_write(path, "0 0\n9 0\n9 7\n", 12, NULL), STATUS_OK);
    char spec[64], expected[64];
    snprintf(spec, sizeof spec, "polygon:%s", path);
    snprintf(expected, sizeof expected, "polygon:%s", file_name(path));
    Domain domain = {0};
    assert_int_equal(domain_parse(&domain, spec, NULL), STATUS_OK);
    Tree tree = grow_in(&domain, 3, NULL);
    assert_string_equal(tree.meta.text[META_DOMAIN], expected);
    tree_release(&tree);
    domain_release(&domain);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(segments_stay_in_a_bent_polygon_with_a_hole),
        cmocka_unit_test(segments_stay_in_the_wall_of_a_shell),
        cmocka_unit_test(segments_stay_in_a_heart),
        cmocka_unit_test(the_header_tells_the_file_of_a_domain_without_its_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
