/* Trees in memory: the builder, checks, pruning, metadata. */
#include "tree/tree.h"
#include "unit.h"

#include <stdlib.h>
#include <string.h>

/* 12 -> 7 -> { 30, 9 -> 41 }, and a root 5 of its own. */
static Tree small_tree(void)
{
    static const int32_t id[] = {12, 7, 30, 9, 41, 5};
    static const int32_t parent[] = {TREE_NO_PARENT, 0, 1, 1, 3, TREE_NO_PARENT};
    static const Vec3 position[] = {{0.5, 1.25, -2},  {3.5, 5.25, -2},  {9.5, 4.75, 1.5},
                                    {2.5, 11.5, 0.5}, {1.5, 14.25, -1}, {-20.5, 3.5, 7.75}};
    static const double radius[] = {2.385, 2.385, 1.655, 2.0625, 0.0875, 0.625};
    Tree tree;
    Err err;
    must(tree_init(&tree, 6, &err), &err);
    memcpy(tree.id, id, sizeof id);
    memcpy(tree.parent, parent, sizeof parent);
    memcpy(tree.position, position, sizeof position);
    memcpy(tree.radius_mm, radius, sizeof radius);
    return tree;
}

static void a_new_tree_is_all_roots_at_the_origin(void **state)
{
    (void)state;
    Tree tree;
    Err err;
    must(tree_init(&tree, 3, &err), &err);
    assert_int_equal(tree.n, 3);
    for (size_t i = 0; i < tree.n; i++) {
        assert_false(tree_is_segment(&tree, i));
        assert_true(tree.radius_mm[i] == 0 && vec3_length(tree.position[i]) == 0);
    }
    tree_release(&tree);
    assert_null(tree.id);
    tree_release(&tree);
}

static void more_nodes_than_ids_are_refused(void **state)
{
    (void)state;
    Tree tree = {.n = 77};
    Err err;
    assert_int_equal(tree_init(&tree, TREE_MAX_ID + (size_t)1, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "100000001"));
    assert_int_equal(tree.n, 77);
}

static void a_segment_is_as_long_as_its_ends_are_apart(void **state)
{
    (void)state;
    Tree tree = small_tree();
    assert_true(tree_segment_length(&tree, 0) == 0);
    assert_true(tree_segment_length(&tree, 1) == 5);
    assert_true(tree_segment_length(&tree, 5) == 0);
    tree_release(&tree);
}

static void children_are_counted(void **state)
{
    (void)state;
    static const int32_t expected[] = {1, 2, 0, 1, 0, 0};
    Tree tree = small_tree();
    int32_t *count = NULL;
    Err err;
    must(tree_child_counts(&tree, &count, &err), &err);
    assert_memory_equal(count, expected, sizeof expected);
    free(count);
    tree_release(&tree);
}

static void check_names_the_node_at_fault(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree();
    must(tree_check(&tree, &err), &err);

    tree.radius_mm[3] = -0.125;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 9: radius -0.125; it must be finite and not negative");
    tree.radius_mm[3] = (double)NAN;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.radius_mm[3] = 2.0625;

    tree.position[4].z = HUGE_VAL;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 41: the position is not finite");
    tree.position[4].z = -1;

    tree.parent[2] = 3;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 30: its parent does not come before it");
    tree.parent[2] = 1;

    tree.id[5] = 30;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 30: another node has the same id");
    tree.id[5] = 0;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.id[5] = TREE_MAX_ID + 1;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    tree.id[5] = TREE_MAX_ID;
    must(tree_check(&tree, &err), &err);
    tree_release(&tree);

    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
}

static void pruning_drops_thin_segments_and_what_hangs_on_them(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree();
    meta_set_number(&tree.meta, META_GAMMA, 2.7);
    must(meta_set_text(&tree.meta, META_DOMAIN, "disc:50", &err), &err);
    must(meta_add_text(&tree.meta, META_KEYS, "by hand", &err), &err);
    tree.radius_mm[4] = 3.5; /* thick, behind a thin one */

    Tree pruned;
    must(tree_prune_copy(&tree, 2.125, &pruned, &err), &err);
    static const int32_t id[] = {12, 7, 5};
    static const int32_t parent[] = {TREE_NO_PARENT, 0, TREE_NO_PARENT};
    assert_int_equal(pruned.n, 3);
    assert_memory_equal(pruned.id, id, sizeof id);
    assert_memory_equal(pruned.parent, parent, sizeof parent);
    assert_true(pruned.position[1].y == 5.25);
    assert_true(pruned.meta.known[META_GAMMA] && pruned.meta.number[META_GAMMA] == 2.7);
    assert_string_equal(pruned.meta.text[META_DOMAIN], "disc:50");
    assert_int_equal(pruned.meta.n_lines, 1);
    assert_string_equal(pruned.meta.line[0].text, "by hand");
    must(tree_check(&pruned, &err), &err);
    tree_release(&pruned);

    must(tree_prune_copy(&tree, 0, &pruned, &err), &err);
    assert_int_equal(pruned.n, tree.n);
    tree_release(&pruned);

    must(tree_prune_copy(&tree, 2.0625, &pruned, &err), &err); /* not thinner than itself */
    assert_int_equal(pruned.n, 5);
    tree_release(&pruned);
    tree_release(&tree);
}

static void pruning_leaves_the_flow_of_what_stays(void **state)
{
    (void)state;
    Err err;
    Tree tree = small_tree(), pruned;
    meta_set_number(&tree.meta, META_TERMINAL_FLOW,
                    TERMINAL_FLOW_EQUAL); /*: 30 and 41 are the terminals */
    must(tree_prune_copy(&tree, 0, &pruned, &err), &err);
    assert_null(pruned.flow_share);
    assert_true(pruned.meta.known[META_TERMINAL_FLOW]);
    tree_release(&pruned);

    must(tree_prune_copy(&tree, 1.75, &pruned, &err), &err); /* 12 -> 7 -> 9, and 5 */
    static const double counted[] = {0, 1, 1, 0};
    assert_int_equal(pruned.n, 4);
    assert_memory_equal(pruned.flow_share, counted, sizeof counted);
    assert_false(pruned.meta.known[META_TERMINAL_FLOW]);
    tree_release(&pruned);

    must(tree_add_flow_shares(&tree, &err), &err);
    tree.flow_share[2] = 0.375;
    tree.flow_share[3] = 0.125; /* leaks */
    tree.flow_share[4] = 2.25;
    must(tree_prune_copy(&tree, 2.125, &pruned, &err), &err); /* 12 -> 7, and 5 */
    static const double summed[] = {0, 2.75, 0};
    assert_int_equal(pruned.n, 3);
    assert_memory_equal(pruned.flow_share, summed, sizeof summed);
    assert_true(pruned.meta.known[META_TERMINAL_FLOW]);
    must(tree_check(&pruned, &err), &err);
    tree_release(&pruned);

    tree.flow_share[4] = -2.25;
    assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
    assert_string_equal(err.text, "node 41: flow share -2.25; it must be finite and not negative");
    tree_release(&tree);
}

static void give(TreeBuilder *builder, int64_t id, int64_t parent, double radius_mm)
{
    Err err;
    must(builder_node(builder,
                      &(BuilderNode){.id = id,
                                     .parent = parent,
                                     .position = {(double)id, 0.25, -1},
                                     .radius_mm = radius_mm,
                                     .record = builder->n},
                      &err),
         &err);
}

static void a_builder_takes_nodes_and_shares_in_any_order(void **state)
{
    (void)state;
    Err err;
    Tree tree;
    size_t late;
    TreeBuilder builder = {.name = "t", .record = "point"};
    must(builder_share(&builder, 5, 0.625, 0, &err), &err);
    give(&builder, 5, 3, 0.5); /* needs 3, which needs 9 */
    give(&builder, 4, 9, 0.75);
    must(builder_column(&builder, "age", "a", &late, &err), &err);
    give(&builder, 9, TREE_NO_PARENT, 1.5);
    must(builder_value(&builder, late, 41.5, &err), &err);
    give(&builder, 3, 9, 1.25);
    meta_set_number(&builder.meta, META_GAMMA, 2.7);
    must(builder_build(&builder, &tree, &err), &err);
    static const int32_t id[] = {9, 3, 5, 4}, parent[] = {TREE_NO_PARENT, 0, 1, 0};
    static const double share[] = {0, 0, 0.625, 0};
    assert_memory_equal(tree.id, id, sizeof id);
    assert_memory_equal(tree.parent, parent, sizeof parent);
    assert_memory_equal(tree.flow_share, share, sizeof share);
    assert_true(tree.position[1].x == 3 && tree.radius_mm[1] == 1.25);
    const double *age = tree_column(&tree, "age")->value;
    assert_true(age[0] == 41.5 && isnan(age[1]) && isnan(age[2]) && isnan(age[3]));
    assert_true(tree.meta.number[META_GAMMA] == 2.7);
    assert_null(tree_column(&tree, "a"));
    builder_release(&builder);
    tree_release(&tree);
}

static void a_builder_names_file_and_record(void **state)
{
    (void)state;
    static const struct {
        int64_t id, parent, share_of; /* share_of 0: none */
        const char *sentence;
    } bad[] = {
        {7, 4, 0, "t: point 1: the id 7 is already that of point 0; every node needs its own"},
        {1, 6, 0,
         "t: point 1: the parent is 6, which is not the id of a node; it must be the id of a "
         "node, or -1 for a root"},
        {8, 8, 0,
         "t: point 1: node 8 is its own parent; parents must lead to a root, whose parent "
         "is -1"},
        {8, 7, 9, "t: point 31: flow_share names the node 9, which is not the id of a node"},
    };
    Err err;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Tree tree = {.n = 77};
        TreeBuilder builder = {.name = "t", .record = "point"};
        give(&builder, 7, TREE_NO_PARENT, 0.5);
        give(&builder, bad[i].id, bad[i].parent, 0.25);
        if (bad[i].share_of)
            must(builder_share(&builder, bad[i].share_of, 0.5, 31, &err), &err);
        assert_int_equal(builder_build(&builder, &tree, &err), STATUS_INPUT);
        assert_string_equal(err.text, bad[i].sentence);
        assert_int_equal(tree.n, 77);
        builder_release(&builder);
    }
    TreeBuilder builder = {.name = "t"};
    BuilderNode node = {.id = TREE_MAX_ID + 1, .parent = TREE_NO_PARENT};
    assert_int_equal(builder_node(&builder, &node, &err), STATUS_INPUT);
    node = (BuilderNode){.id = 1, .parent = 4000000000};
    assert_int_equal(builder_node(&builder, &node, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "the parent is 4000000000, which is not the id of a node"));
    node = (BuilderNode){.id = 1, .parent = TREE_NO_PARENT, .position = {0, HUGE_VAL, 0}};
    assert_int_equal(builder_blame(&builder, 3, builder_node(&builder, &node, &err), &err),
                     STATUS_INPUT);
    assert_string_equal(err.text, "t:3: the position is not finite");
    assert_int_equal(builder_share(&builder, 1, -0.5, 3, &err), STATUS_INPUT);
    builder_release(&builder);
}

static void a_key_says_what_its_values_may_be(void **state)
{
    (void)state;
    static const struct {
        MetaKey key;
        double in;
        const char *out, *sentence;
    } expected[] = {
        {META_GAMMA, 10, "10.5", "gamma is '10.5'; it must be a number above 0 and at most 10"},
        {META_GAMMA, 5e-324, "0", "gamma is '0'; it must be a number above 0 and at most 10"},
        {META_LAMBDA, 0, "-0.125", "lambda is '-0.125'; it must be a number of at least 0"},
        {META_P_TERM, -3.25, "inf", "p_term_mmHg is 'inf'; it must be a finite number"},
        {META_HEMATOCRIT, 0.95, "nan", "hematocrit is 'nan'; it must be a number from 0 to 0.95"},
        {META_DIMENSION, 3, "2.5", "dimension is '2.5'; it must be an integer from 2 to 3"},
        {META_VISCOSITY_LAW, VISCOSITY_PRIES, "2",
         "viscosity_law is '2'; it must be constant or pries"}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        TreeMeta meta = {0};
        Err err;
        assert_true(meta_allows(expected[i].key, expected[i].in));
        assert_false(meta_allows(expected[i].key, (double)NAN));
        assert_int_equal(meta_parse(&meta, expected[i].key, expected[i].out, &err), STATUS_INPUT);
        assert_string_equal(err.text, expected[i].sentence);
        assert_false(meta.known[expected[i].key]);
    }
}

static void every_key_is_found_by_its_name(void **state)
{
    (void)state;
    for (int key = 0; key < META_KEYS; key++)
        assert_int_equal(meta_find(meta_rows[key].name, strlen(meta_rows[key].name)), key);
    assert_int_equal(meta_find("gamma rays", 10), META_KEYS);
    assert_int_equal(meta_find("gamma rays", 4), META_KEYS);
    assert_int_equal(meta_find("gamma rays", 5), META_GAMMA);
}

/* The keys and texts of a walk, one letter a key or the text. */
static void assert_walk(const TreeMeta *meta, const char *expected)
{
    Text seen = TEXT_INIT;
    MetaLine line;
    for (MetaWalk walk = {.meta = meta}; meta_walk(&walk, &line);)
        text_printf(&seen, "%s%s ", line.key == META_KEYS ? "#" : meta_rows[line.key].name,
                    line.text ? line.text : "");
    assert_string_equal(text_chars(&seen), expected);
    text_release(&seen);
}

static void what_is_known_keeps_the_order_of_its_lines(void **state)
{
    (void)state;
    Err err;
    TreeMeta meta = {0}, copy;
    meta_set_number(&meta, META_GAMMA, 2.7);
    must(meta_parse(&meta, META_LAMBDA, "\t1.5 ", &err), &err);
    must(meta_add_text(&meta, META_KEYS, "a", &err), &err);
    must(meta_parse(&meta, META_COMMAND, "x", &err), &err);
    must(meta_parse(&meta, META_LAMBDA, "1.50", &err), &err);
    assert_walk(&meta, "lambda #a commandx gamma ");
    must(meta_add_lines(&meta, &err), &err);
    must(meta_add_text(&meta, META_COMMAND, "y", &err), &err);
    must(meta_copy(&copy, &meta, &err), &err);
    assert_walk(&copy, "lambda #a commandx gamma commandy ");
    copy.known[META_COMMAND] = copy.known[META_LAMBDA] = false;
    assert_walk(&copy, "#a gamma ");
    meta_release(&copy);

    assert_int_equal(meta_parse(&meta, META_LAMBDA, "2", &err), STATUS_INPUT);
    assert_string_equal(err.text, "lambda is '2', but an earlier line has another value");
    assert_true(meta.number[META_LAMBDA] == 1.5);
    assert_int_equal(meta_add_text(&meta, META_KEYS, "a\rb", &err), STATUS_INPUT);
    assert_int_equal(meta_set_text(&meta, META_DOMAIN, "mesh:a\nb.stl", &err), STATUS_INPUT);
    assert_false(meta.known[META_DOMAIN]);
    meta_release(&meta);
}

static void cco_asks_for_what_it_rests_on(void **state)
{
    (void)state;
    Err err;
    TreeMeta meta = {.known = {[META_GAMMA] = true, [META_LAMBDA] = true, [META_P_PERF] = true},
                     .number = {[META_GAMMA] = 3, [META_P_PERF] = 97.5}};
    assert_int_equal(meta_check_cco(&meta, META_OF_FILE, &err), STATUS_INPUT);
    assert_string_equal(err.text,
                        "it has no header key p_term_mmHg, the pressure at every terminal");
    meta_set_number(&meta, META_P_TERM, 97.5);
    meta_set_number(&meta, META_Q_PERF, 312.5);
    assert_int_equal(meta_check_cco(&meta, META_OF_OPTIONS, &err), STATUS_USAGE);
    assert_string_equal(err.text,
                        "`p_term_mmHg` is 97.5; it must be below `p_perf_mmHg`, which is 97.5");
    meta_set_number(&meta, META_P_TERM, 60);
    meta_set_number(&meta, META_VISCOSITY, 3.6);
    must(meta_check_cco(&meta, META_OF_FILE, &err), &err);
    meta_set_number(&meta, META_VISCOSITY_LAW, VISCOSITY_PRIES);
    meta_set_number(&meta, META_HEMATOCRIT, 0.96);
    assert_int_equal(meta_check_cco(&meta, META_OF_FILE, &err), STATUS_INPUT);
    assert_string_equal(err.text, "hematocrit is 0.96; it must be a number from 0 to 0.95");
    meta_set_number(&meta, META_HEMATOCRIT, 0.4375);
    assert_int_equal(meta_check_cco(&meta, META_OF_FILE, &err), STATUS_INPUT);
    assert_string_equal(err.text,
                        "it has no header key plasma_viscosity_cP, the viscosity of the plasma");
}

static void renumbering_counts_from_one(void **state)
{
    (void)state;
    static const int32_t expected[] = {1, 2, 3, 4, 5, 6};
    Tree tree = small_tree();
    tree_renumber(&tree);
    assert_memory_equal(tree.id, expected, sizeof expected);
    tree_release(&tree);
}

static void the_bounds_hold_both_ends_with_the_segment_radius(void **state)
{
    (void)state;
    Tree tree = small_tree();
    tree.radius_mm[0] = 0.25;
    Box box = tree_bounds(&tree);
    assert_true(box.low.x == -20.5 - 0.625);
    assert_true(box.low.y == 1.25 - 2.385);
    assert_true(box.low.z == -2 - 2.385);
    assert_true(box.high.x == 9.5 + 1.655);
    assert_true(box.high.y == 14.25 + 0.0875);
    assert_true(box.high.z == 7.75 + 0.625);
    tree_release(&tree);
}

static void a_chain_of_a_million_segments_is_no_deeper_than_a_bush(void **state)
{
    (void)state;
    enum { N = 1000001 };
    Err err;
    Tree tree, pruned;
    must(tree_init(&tree, N, &err), &err);
    for (int32_t i = 0; i < N; i++) {
        tree.id[i] = i + 1;
        tree.parent[i] = i - 1;
        tree.position[i] = vec3(0.125 * i, 0, 0);
        tree.radius_mm[i] = 2.385 - 1e-6 * i;
    }
    must(tree_check(&tree, &err), &err);
    assert_true(tree_bounds(&tree).low.x < 0);
    must(tree_prune_copy(&tree, 1.885, &pruned, &err), &err);
    assert_in_range(pruned.n, 499999, 500002);
    tree_release(&pruned);
    tree_release(&tree);
}

/* A trunk of 2.5 mm that parts into 4.5 and 1.25 mm, and a second root with 0.75 mm. */
static void growth_cuts_vessels_at_the_same_way_from_their_roots(void **state)
{
    (void)state;
    static const int32_t parent[] = {-1, 0, 1, 1, -1, 4};
    static const double x[] = {0, 2.5, 7, 2.5, 10, 10.75}, y[] = {0, 0, 0, 1.25, 0, 0};
    Tree tree, part;
    Err err;
    must(tree_init(&tree, 6, &err), &err);
    for (size_t i = 0; i < 6; i++) {
        tree.id[i] = 10 * (int32_t)i + 3;
        tree.parent[i] = parent[i];
        tree.position[i] = vec3(x[i], y[i], 0.5);
        tree.radius_mm[i] = 1.375;
    }
    must(tree_proximal_part(&tree, 0.5, &part, &err), &err); /* 3.5 mm */
    must(tree_check(&part, &err), &err);
    assert_int_equal(part.n, 6);
    assert_true(part.position[2].x == 3.5 && part.position[3].y == 1);
    assert_true(part.position[5].x == 10.75);
    tree_release(&part);
    must(tree_proximal_part(&tree, 0.25, &part, &err), &err);
    assert_int_equal(part.n, 4);
    assert_true(part.position[1].x == 1.75 && part.id[3] == 53 && part.parent[3] == 2);
    tree_release(&part);
    must(tree_proximal_part(&tree, 1, &part, &err), &err);
    assert_memory_equal(part.position, tree.position, 6 * sizeof *part.position);
    tree_release(&part);
    tree_release(&tree);
}

/* A ring with a tail: 1 -> 2 -> { 3 -> 6, 4 -> 5 }, where 5 and 7, a daughter of 6, are the points
 * 3 and 2, so that 6 -> 7 closes a second loop. A root 8 -> 9 is apart. */
static Tree ring(void)
{
    static const int32_t parent[] = {TREE_NO_PARENT, 1, 2, 2, 4, 3, 6, TREE_NO_PARENT, 8};
    TreeBuilder builder = {.name = "ring", .record = "point"};
    Tree tree;
    Err err;
    must(builder_link(&builder, 5, 3, 4, &err), &err);
    must(builder_link(&builder, 7, 2, 5, &err), &err);
    for (int64_t id = 1; id <= 9; id++)
        give(&builder, id, parent[id - 1], id == 3 ? 0.25 : 1);
    must(builder_build(&builder, &tree, &err), &err);
    must(tree_check(&tree, &err), &err);
    builder_release(&builder);
    return tree;
}

static void links_close_loops(void **state)
{
    (void)state;
    static const int32_t others[] = {1, 3, 2, 1, 1, 1, 1, 1, 0};
    static const uint32_t components[] = {0, 0, 0, 0, 0, 0, 0, 1, 1};
    Tree tree = ring();
    Err err;
    int32_t *count;
    uint32_t *component;
    size_t n;
    assert_int_equal(tree_link_count(&tree), 2);
    assert_int_equal(tree_linked_node(&tree, 4), 2);
    assert_int_equal(tree_linked_node(&tree, 2), 2);
    assert_memory_equal(&tree.position[4], &tree.position[2], sizeof *tree.position);
    must(tree_child_counts(&tree, &count, &err), &err);
    assert_memory_equal(count, others, sizeof others);
    must(tree_components(&tree, &component, &n, &err), &err);
    assert_memory_equal(component, components, sizeof components);
    must(tree_loop_count(&tree, &n, &err), &err);
    assert_int_equal(n, 2);
    tree.link[6] = 8; /* joins the two trees, and closes no loop */
    must(tree_loop_count(&tree, &n, &err), &err);
    assert_int_equal(n, 1);
    free(count);
    free(component);
    tree_release(&tree);
}

/* Of the segments that end at links, the part drops one and shortens the other. */
static void a_part_whose_links_are_cut_off_is_a_tree(void **state)
{
    (void)state;
    Tree tree = ring(), part;
    Err err;
    must(tree_proximal_part(&tree, 0.35, &part, &err), &err);
    must(tree_check(&part, &err), &err);
    assert_null(part.link);
    tree_release(&part);
    tree_release(&tree);
}

static HashText hash_of(const Tree *tree)
{
    Hash hash;
    hash_begin(&hash);
    tree_hash(tree, &hash);
    return hash_finish(&hash);
}

static void bad_links_are_refused(void **state)
{
    (void)state;
    static const struct {
        size_t node;
        int32_t to;
        const char *text;
    } bad[] = {{6, 9, "node 7: its link does not name"}, {6, 6, "node 7: its link does not name"},
               {6, -2, "node 7: its link does not"},     {0, 2, "node 1: a root cannot have"},
               {3, 1, "node 4: a node with a link"},     {6, 4, "node 5: a node with a link"},
               {6, 0, "node 7: its position differs"}};
    Err err;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Tree tree = ring();
        HashText before = hash_of(&tree);
        tree.link[bad[k].node] = bad[k].to;
        HashText after = hash_of(&tree);
        assert_memory_not_equal(&before, &after, sizeof before);
        assert_int_equal(tree_check(&tree, &err), STATUS_INPUT);
        assert_non_null(strstr(err.text, bad[k].text));
        tree_release(&tree);
    }
}

static void a_link_to_a_pruned_node_ends_there(void **state)
{
    (void)state;
    Tree tree = ring(), pruned;
    Err err;
    must(tree_prune_copy(&tree, 0.5, &pruned, &err), &err); /* without 3, 6 and 7 */
    must(tree_check(&pruned, &err), &err);
    assert_int_equal(pruned.n, 6);
    assert_null(pruned.link);
    tree_release(&pruned);
    tree.radius_mm[2] = 1;
    tree.radius_mm[5] = 0.25;
    must(tree_prune_copy(&tree, 0.5, &pruned, &err), &err); /* without 6 and 7 */
    must(tree_check(&pruned, &err), &err);
    assert_int_equal(pruned.link[4], 2);
    tree_release(&pruned);
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_tree_is_all_roots_at_the_origin),
        cmocka_unit_test(more_nodes_than_ids_are_refused),
        cmocka_unit_test(a_segment_is_as_long_as_its_ends_are_apart),
        cmocka_unit_test(children_are_counted),
        cmocka_unit_test(check_names_the_node_at_fault),
        cmocka_unit_test(pruning_drops_thin_segments_and_what_hangs_on_them),
        cmocka_unit_test(pruning_leaves_the_flow_of_what_stays),
        cmocka_unit_test(a_builder_takes_nodes_and_shares_in_any_order),
        cmocka_unit_test(a_builder_names_file_and_record),
        cmocka_unit_test(a_key_says_what_its_values_may_be),
        cmocka_unit_test(every_key_is_found_by_its_name),
        cmocka_unit_test(what_is_known_keeps_the_order_of_its_lines),
        cmocka_unit_test(cco_asks_for_what_it_rests_on),
        cmocka_unit_test(renumbering_counts_from_one),
        cmocka_unit_test(the_bounds_hold_both_ends_with_the_segment_radius),
        cmocka_unit_test(a_chain_of_a_million_segments_is_no_deeper_than_a_bush),
        cmocka_unit_test(growth_cuts_vessels_at_the_same_way_from_their_roots),
        cmocka_unit_test(links_close_loops),
        cmocka_unit_test(a_part_whose_links_are_cut_off_is_a_tree),
        cmocka_unit_test(bad_links_are_refused),
        cmocka_unit_test(a_link_to_a_pruned_node_ends_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
