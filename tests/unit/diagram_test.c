/* The layout of diagrams of random forests. */
#include "diagram/diagram.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A forest of `roots` trees whose nodes hang on any earlier one of their own tree. */
static Tree random_forest(uint64_t seed, size_t n, size_t roots)
{
    Tree tree;
    Err err;
    Random random;
    random_seed(&random, seed);
    must(tree_init(&tree, n, &err), &err);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.radius_mm[i] = 0.1 + random_uniform(&random);
        tree.position[i] = vec3(30 * random_uniform(&random), 20 * random_uniform(&random),
                                10 * random_uniform(&random));
        if (i < roots)
            continue;
        size_t before = (size_t)(random_uniform(&random) * (double)(i / roots));
        tree.parent[i] = (int32_t)(before * roots + i % roots);
    }
    must(tree_check(&tree, &err), &err);
    return tree;
}

static bool overlap(const double a[2], const double b[2])
{
    return fmin(a[1], b[1]) - fmax(a[0], b[0]) > 1e-9;
}

static void check_bars(const Tree *tree, const Diagram *diagram)
{
    for (size_t i = 0; i < diagram->n; i++) {
        const FigureBar *bar = &diagram->bar[i];
        assert_true(bar->x[0] >= 0 && bar->y[0] >= -1e-9);
        assert_true(bar->y[1] <= diagram->height_mm + 1e-9);
        if (i < diagram->n_links)
            continue;
        double length = tree_segment_length(tree, (size_t)bar->index);
        assert_true(fabs(bar->x[1] - bar->x[0] - length) < 1e-9 * diagram->width_mm);
        assert_true(fabs(bar->y[1] - bar->y[0] - 2 * tree->radius_mm[bar->index]) < 1e-9);
        assert_true(bar->x[1] <= diagram->width_mm + 1e-9);
    }
}

/* What leaves one node on one side has links that lie on one another. */
static void check_apart(const Tree *tree, const Diagram *diagram)
{
    for (size_t i = 0; i < diagram->n; i++)
        for (size_t k = 0; k < i; k++) {
            const FigureBar *a = &diagram->bar[i], *b = &diagram->bar[k];
            bool one_place =
                k < diagram->n_links && tree->parent[a->index] == tree->parent[b->index];
            if (!one_place && overlap(a->x, b->x) && overlap(a->y, b->y))
                fail_msg("the bars of nodes %d and %d overlap", a->index, b->index);
        }
}

static void bars_are_true_to_size_and_none_lies_on_another(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Tree tree = random_forest(seed, 20 + 7 * seed, 1 + seed % 3);
        Diagram diagram;
        Err err;
        /* as thin as links, which are as wide as a quarter of a diameter, where they are in the way
         * of what leaves next */
        for (size_t i = 0; i < tree.n; i++)
            tree.radius_mm[i] *= 1e-7;
        must(diagram_lay_out(&tree, seed % 2 ? 0.37 : 0, &diagram, &err), &err);
        assert_int_equal(diagram.n - diagram.n_links, tree.n - (1 + seed % 3));
        check_bars(&tree, &diagram);
        check_apart(&tree, &diagram);
        diagram_release(&diagram);
        tree_release(&tree);
    }
}

static Tree fork_tree(void)
{
    Tree tree;
    Err err;
    must(tree_init(&tree, 4, &err), &err);
    static const int32_t parent[4] = {-1, 0, 1, 1};
    const Vec3 position[4] = {vec3(0, 0, 0), vec3(0, 10, 0), vec3(3, 14, 0), vec3(-6, 10, 8)};
    static const double radius[4] = {1.5, 1.5, 1.1, 0.7};
    for (int i = 0; i < 4; i++) {
        tree.id[i] = 3 * i + 2;
        tree.parent[i] = parent[i];
        tree.position[i] = position[i];
        tree.radius_mm[i] = radius[i];
    }
    return tree;
}

static void the_thickest_daughter_continues_the_row(void **state)
{
    (void)state;
    Tree tree = fork_tree();
    Diagram diagram;
    Err err;
    must(diagram_lay_out(&tree, 2.385, &diagram, &err), &err);
    assert_int_equal(diagram.n, 4);
    assert_int_equal(diagram.n_links, 1);
    const FigureBar *link = diagram.bar, *bar = diagram.bar + 1;
    assert_true(bar[0].x[0] == 0 && bar[0].x[1] == 10 && bar[1].x[1] == 15 && bar[2].x[1] == 20);
    assert_true(bar[0].y[0] + bar[0].y[1] == bar[1].y[0] + bar[1].y[1]);
    /* 0.7 mm and the gap above the thickest of the row */
    assert_true(fabs(bar[0].y[0] - bar[2].y[1] - 2.385) < 1e-12);
    assert_true(fabs(diagram.height_mm - (3 + 2.385 + 1.4)) < 1e-12);
    assert_true(diagram.width_mm == 20);
    assert_int_equal(link->index, 3);
    assert_true(link->y[0] == bar[2].y[1] && fabs(link->y[1] - bar[0].y[0]) < 1e-12);
    diagram_release(&diagram);
    tree_release(&tree);
}

static void pixels_add_up_to_the_area_of_the_bars(void **state)
{
    (void)state;
    Tree tree = random_forest(5, 150, 1);
    Diagram diagram;
    Plane color;
    Err err;
    for (size_t i = 0; i < tree.n; i++)
        tree.radius_mm[i] *= 0.01;
    must(diagram_lay_out(&tree, 0.2, &diagram, &err), &err);
    float(*white)[3] = calloc(tree.n, sizeof *white);
    for (size_t i = 0; i < tree.n; i++)
        for (int c = 0; c < 3; c++)
            white[i][c] = 1;
    const DiagramStyle style = {
        .diagram = &diagram, .tree = &tree, .color = (const float(*)[3])white, .margin = 0.05};
    const FigureBars bars = diagram_bars(&style);
    must(diagram_draw(&style, &bars, (const int[2]){211, 167}, (const int[2]){0, 0}, &color, &err),
         &err);
    double sum = 0, area = 0;
    for (size_t i = 0; i < 211 * 167; i++)
        sum += (double)color.values[3 * i + 1];
    for (size_t i = 0; i < diagram.n; i++)
        area += (diagram.bar[i].x[1] - diagram.bar[i].x[0]) *
                fmax(0, diagram.bar[i].y[1] - diagram.bar[i].y[0]);
    double scale = fmin(0.9 * 211 / diagram.width_mm, 0.9 * 167 / diagram.height_mm);
    assert_true(fabs(sum - scale * scale * area) < 1e-3 * sum);
    plane_release(&color);
    free(white);
    diagram_release(&diagram);
    tree_release(&tree);
}

/* The page covers as much as the bars, at its own resolution. */
static void a_page_shows_the_bars(void **state)
{
    (void)state;
    Tree tree = fork_tree();
    Diagram diagram;
    FigurePage page;
    FigureFonts *fonts;
    Picture picture;
    Err err;
    static const float black[4][3];
    must(diagram_lay_out(&tree, 2.5, &diagram, &err), &err);
    const DiagramStyle style = {
        .diagram = &diagram, .tree = &tree, .color = black, .background = {1, 1, 1}, .margin = 0.1};
    const FigureBars bars = diagram_bars(&style);
    diagram_make_page(&style, &bars, &page);
    must(figure_check(&page, &err), &err);
    assert_true(fabs(page.width_mm - 25) < 1e-12 && page.exact);
    page.dpi = 10 * MM_PER_INCH;
    must(figurefonts_load("templates", &fonts, &err), &err);
    page.fonts = fonts;
    must(picture_init(&picture, 250, figure_pixels(&page, page.height_mm), 3, 8, &err), &err);
    memset(picture.codes8, 255, picture_stride(&picture) * (size_t)picture.height);
    must(figure_draw(&page, 0, &picture, &err), &err);
    size_t covered = 0;
    for (size_t i = 0; i < (size_t)picture.width * (size_t)picture.height; i++)
        covered += picture.codes8[3 * i] < 128;
    assert_in_range(covered, 100 * (30 + 11 + 14 - 1), 100 * (30 + 11 + 14 + 2));
    picture_release(&picture);
    figure_release(&page);
    figurefonts_free(fonts);
    diagram_release(&diagram);
    tree_release(&tree);
}

static void rejects_a_tree_without_any_length(void **state)
{
    (void)state;
    Tree tree;
    Diagram diagram;
    Err err;
    must(tree_init(&tree, 1, &err), &err);
    tree.id[0] = 1;
    assert_int_equal(diagram_lay_out(&tree, 0, &diagram, &err), STATUS_INPUT);
    assert_string_equal(err.text,
                        "all segments have length 0; a diagram needs at least one with a length");
    tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bars_are_true_to_size_and_none_lies_on_another),
        cmocka_unit_test(the_thickest_daughter_continues_the_row),
        cmocka_unit_test(pixels_add_up_to_the_area_of_the_bars),
        cmocka_unit_test(a_page_shows_the_bars),
        cmocka_unit_test(rejects_a_tree_without_any_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
