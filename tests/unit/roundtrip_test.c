/* Every format of trees that corcast writes, with every kind of tree. A file that is read again
 * has all data that tree_format_losses does not name. */
#include "scratch.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static char path[64];

typedef enum Kind {
    PLAIN,
    FOREST,
    TERRITORY,
    DEMAND,
    PAIRS,
    COLUMNS,
    SERIES,
    TYPES,
    FAR,
    ROOT_RADIUS,
    ROOT_VALUES,
    KEYS,
    REMARKS,
    IDS,
    KINDS
} Kind;

static const char *const kind_names[KINDS] = {
    [PLAIN] = "plain",
    [FOREST] = "forest",
    [TERRITORY] = "territory",
    [DEMAND] = "demand",
    [PAIRS] = "pairs",
    [COLUMNS] = "columns",
    [SERIES] = "series",
    [TYPES] = "types",
    [FAR] = "far from the origin",
    [ROOT_RADIUS] = "root of its own radius",
    [ROOT_VALUES] = "root with values",
    [KEYS] = "all header keys",
    [REMARKS] = "remarks that are keys elsewhere",
    [IDS] = "ids with gaps",
};

/* A tree of 8 nodes without symmetry, with a trifurcation and a bend; a second one of 3 nodes. */
static const struct {
    int32_t parent;
    Vec3 position;
    double radius;
} rows[] = {
    {-1, {0.5, 50, -3}, 1.26}, {0, {0.25, 20.125, 1}, 1.26}, {1, {-15, 5, 2}, 1},
    {1, {15, 5.5, 0}, 0.8},    {1, {1, 4, -7}, 0.3},         {2, {-20, -5, 0.1}, 0.7},
    {5, {-22, -9, 0.3}, 0.7},  {2, {-10, -6, 3}, 0.6},       {-1, {60, 40, 1}, 0.9},
    {8, {61, 20, 2}, 0.9},     {9, {63, 3, 2.5}, 0.5},
};
enum { ONE = 8, BOTH = sizeof rows / sizeof *rows };

static void set_key(Tree *tree, const char *name, const char *value)
{
    Err err;
    must(meta_parse(&tree->meta, meta_find(name, strlen(name)), value, &err), &err);
}

static void add_values(Tree *tree, const char *name, const char *unit, double first)
{
    Err err;
    double *value = NULL;
    must(tree_add_column(tree, name, unit, &value, &err), &err);
    for (size_t i = 0; i < tree->n; i++)
        value[i] = tree_is_segment(tree, i) && i != 4 ? first + (double)i / 7 : (double)NAN;
}

static void add_shares(Tree *tree, const char *rule)
{
    Err err;
    must(tree_add_flow_shares(tree, &err), &err);
    for (size_t i = 3; i < tree->n; i++)
        tree->flow_share[i] = i == 5 ? 0 : 10 * (double)i + 0.1;
    set_key(tree, "terminal_flow", rule);
}

static void add_pairs(Tree *tree)
{
    Err err;
    double *value = NULL;
    must(tree_set_column(tree, tree_pairs_name, "", &value, &err), &err);
    value[6] = value[10] = 1;
}

static void set_keys(Tree *tree)
{
    static const char *const keys[][2] = {
        {"generator", "corcast 9"},
        {"command", "corcast grow --seed 4 -o T.swc"},
        {"seed", "4"},
        {"dimension", "3"},
        {"domain", "ball:30"},
        {"lambda", "2"},
        {"p_perf_mmHg", "100"},
        {"p_term_mmHg", "60"},
        {"q_perf_ml_min", "120"},
        {"viscosity_law", "pries"},
        {"hematocrit", "0.45"},
        {"plasma_viscosity_cP", "1.1"},
        {"clearance_mm", "0.01"},
        {"gamma_by_radius", "0.1:2.5,1:3"},
        {"terminal_flow", "equal"},
        {"viscosity_cP", "3.5"},
    };
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        set_key(tree, keys[k][0], keys[k][1]);
}

static void add_remarks(Tree *tree)
{
    static const char *const remarks[] = {"flow_share: 77 1", "terminal_pair: 77 78",
                                          "id type x y z radius parent", "a remark, \"so\" <&>"};
    Err err;
    for (size_t k = 0; k < sizeof remarks / sizeof *remarks; k++)
        must(meta_add_text(&tree->meta, META_KEYS, remarks[k], &err), &err);
}

static Tree make_tree(Kind kind)
{
    Tree tree;
    Err err;
    must(tree_init(&tree, kind == FOREST || kind == PAIRS ? BOTH : ONE, &err), &err);
    for (size_t i = 0; i < tree.n; i++) {
        Vec3 far = kind == FAR ? (Vec3){123456.5, -98765.25, 1e6} : (Vec3){0, 0, 0};
        tree.id[i] = (int32_t)(kind == IDS ? 10 * i + 3 : i + 1);
        tree.type[i] = kind == TYPES ? (int32_t)(i % 5) - 1 : TREE_VESSEL_TYPE;
        tree.parent[i] = rows[i].parent;
        tree.position[i] = vec3_add(rows[i].position, far);
        tree.radius_mm[i] = rows[i].radius;
    }
    if (kind == TERRITORY || kind == DEMAND)
        add_shares(&tree, kind == DEMAND ? "demand" : "territory");
    if (kind == PAIRS)
        add_pairs(&tree);
    if (kind == COLUMNS || kind == ROOT_VALUES) {
        add_values(&tree, "age, \"true\" <&>", "a", 40);
        add_values(&tree, "radius", "", 1e-300);
        add_values(&tree, "length", "cm", 2);
        add_values(&tree, "x", "", -3);
    }
    if (kind == ROOT_VALUES)
        tree.column[0].value[0] = 17;
    for (int k = 0; kind == SERIES && k < 3; k++)
        add_values(&tree, (const char *[]){"p_0", "p_0.5", "p_1"}[k], "mmHg", k);
    if (kind == ROOT_RADIUS)
        tree.radius_mm[0] = 2.5;
    if (kind == KEYS)
        set_keys(&tree);
    if (kind == REMARKS)
        add_remarks(&tree);
    must(tree_check(&tree, &err), &err);
    return tree;
}

/* The node of `tree` that lies at a place. */
static size_t node_at(const Tree *tree, Vec3 place)
{
    size_t best = 0;
    for (size_t i = 0; i < tree->n; i++)
        if (vec3_distance(tree->position[i], place) < vec3_distance(tree->position[best], place))
            best = i;
    assert_true(vec3_distance(tree->position[best], place) <= 1e-15 * vec3_length(place));
    return best;
}

static void compare_node(const Tree *tree, size_t i, const Tree *back, size_t k,
                         const TreeLosses *lost)
{
    bool root = !tree_is_segment(tree, i);
    assert_int_equal(tree_is_segment(back, k), !root);
    if (!root)
        assert_int_equal(back->parent[k], node_at(back, tree->position[tree->parent[i]]));
    if (!root || !lost->root_radii)
        assert_true(fabs(back->radius_mm[k] - tree->radius_mm[i]) <= 4e-16 * tree->radius_mm[i]);
    assert_int_equal(back->type[k], lost->types ? TREE_VESSEL_TYPE : tree->type[i]);
    assert_int_equal(back->flow_share != NULL, tree->flow_share && !lost->flow_shares);
    if (back->flow_share)
        assert_true(back->flow_share[k] == tree->flow_share[i]);
}

static void compare_columns(const char *to, const Tree *tree, size_t i, const Tree *back, size_t k)
{
    for (size_t c = 0; c < tree->n_columns; c++) {
        const TreeColumn *column = &tree->column[c], *found = tree_column(back, column->name);
        if (!tree_format_stores(to, column))
            continue;
        assert_non_null(found);
        assert_string_equal(found->unit, column->unit);
        double a = column->value[i], b = found->value[k];
        bool fills = strcmp(file_extension(to), "in") == 0; /* a card has no missing values */
        if (tree_is_segment(tree, i))
            assert_true(a == b || (isnan(a) && (isnan(b) || fills)));
    }
}

static void compare_keys(const Tree *tree, const Tree *back, const TreeLosses *lost)
{
    Text a = TEXT_INIT, b = TEXT_INIT;
    for (int key = 0; key < META_KEYS; key++) {
        bool dropped = key == META_TERMINAL_FLOW && lost->terminal_flow;
        assert_int_equal(back->meta.known[key], tree->meta.known[key] && !dropped);
        if (!back->meta.known[key] || meta_rows[key].kind == META_LINES)
            continue;
        meta_put_value(&tree->meta, (MetaKey)key, &a);
        meta_put_value(&back->meta, (MetaKey)key, &b);
    }
    assert_string_equal(text_chars(&a), text_chars(&b));
    text_release(&a);
    text_release(&b);
}

/* A deck of svOneDSolver holds one tree alone, and refuses others with a sentence. */
static bool may_refuse(const char *extension, Kind kind)
{
    return strcmp(extension, "in") == 0 && (kind == FOREST || kind == PAIRS);
}

static void write_and_read(const char *extension, Kind kind)
{
    Tree tree = make_tree(kind), back = {0};
    TreeLosses lost;
    Err err;
    snprintf(path, sizeof path, "%s/tree.%s", folder, extension);
    must(tree_format_losses(path, &tree, &lost, &err), &err);
    Status status = tree_write(&tree, path, &err);
    if (may_refuse(extension, kind)) {
        assert_int_equal(status, STATUS_INPUT);
        tree_release(&tree);
        return;
    }
    must(status, &err);
    status = tree_read(&back, path, &err);
    unlink(path);
    must(status, &err);
    assert_int_equal(back.n, tree.n);
    assert_int_equal(lost.merged, 0);
    for (size_t i = 0; i < tree.n; i++) {
        size_t k = node_at(&back, tree.position[i]);
        compare_node(&tree, i, &back, k, &lost);
        compare_columns(path, &tree, i, &back, k);
    }
    compare_keys(&tree, &back, &lost);
    tree_release(&tree);
    tree_release(&back);
}

static void each_format_holds_each_kind_of_tree(void **state)
{
    (void)state;
    size_t written = 0;
    TreeFormat format;
    for (size_t i = 0; tree_format_at(i, &format); i++) {
        char name[64];
        snprintf(name, sizeof name, "tree.%s", format.extension);
        if (tree_format_check(name, NULL) != STATUS_OK)
            continue;
        written++;
        for (int kind = 0; kind < KINDS; kind++) {
            print_message("%s: %s\n", format.extension, kind_names[kind]);
            write_and_read(format.extension, (Kind)kind);
        }
    }
    assert_int_equal(written, 10); /* .xml is that of three formats */
}

/* An index of moments and its files. */
static void an_index_holds_series(void **state)
{
    (void)state;
    Tree tree = make_tree(SERIES), back = {0};
    Err err;
    snprintf(path, sizeof path, "%s/tree.pvd", folder);
    must(tree_write_time_steps(&tree, path, &err), &err);
    must(tree_read(&back, path, &err), &err);
    assert_int_equal(back.n_columns, 3);
    for (size_t i = 0; i < tree.n; i++)
        compare_columns("tree.csv", &tree, i, &back, node_at(&back, tree.position[i]));
    for (size_t k = 0; k < 3; k++) {
        char *moment = NULL;
        must(tree_time_step_path(path, k, &moment, &err), &err);
        unlink(moment);
        free(moment);
    }
    unlink(path);
    tree_release(&tree);
    tree_release(&back);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_format_holds_each_kind_of_tree),
                                       cmocka_unit_test(an_index_holds_series)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
