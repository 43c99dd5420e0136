/* Color scales of fields: ranges, logarithms, values that cannot be drawn. */
#include "stage/stage.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A root and four segments, the last without a radius: it cannot be drawn. */
static Tree make_tree(void)
{
    Tree tree;
    Err err = {{0}};
    must(tree_init(&tree, 5, &err), &err);
    for (int i = 0; i < 5; i++) {
        tree.id[i] = i + 1;
        tree.parent[i] = i - 1;
        tree.position[i] = vec3(i, 0, 0);
        tree.radius_mm[i] = i < 4 ? 1 : 0;
    }
    return tree;
}

/* Values of the nodes, frame after frame. */
static FieldSeries make_series(const double *values, size_t frames)
{
    FieldSeries series = {.field = {.name = "pressure", .unit = "mmHg", .n = 5 * frames},
                          .frames = frames};
    series.field.value = malloc(5 * frames * sizeof *values);
    memcpy(series.field.value, values, 5 * frames * sizeof *values);
    if (frames > 1) {
        series.time = malloc(frames * sizeof *series.time);
        for (size_t i = 0; i < frames; i++)
            series.time[i] = (double)i;
    }
    return series;
}

/* The colors of a map run from black to red. */
static Colormap make_map(bool separate)
{
    Colormap map = {.n = 2, .separate = separate};
    map.srgb = calloc(2, sizeof *map.srgb);
    map.srgb[1][0] = 1;
    return map;
}

static const double one_class[] = {1};
static const FieldScaleParams plain = {.classes = one_class, .n_classes = 1, .map_name = "map"};
static const double rising[] = {0, 10, 20, 40, 1000}; /* the last is of no segment */

/* Colors the values; with a sentence expects it as the error. */
static Appearance color(const FieldScaleParams *params, const double *values, size_t frames,
                        bool separate, const char *sentence)
{
    const Look look = {.color = {1, 1, 1}};
    FieldScaleParams shown = *params;
    shown.look = &look;
    Tree tree = make_tree();
    FieldSeries series = make_series(values, frames);
    FieldValues drawn;
    Appearance appearance = {0};
    Colormap map = make_map(separate);
    Err err = {{0}};
    must(fieldvalues_take(&tree, &series, NULL, &drawn, &err), &err);
    Status status = fieldscale_color(&shown, &map, &drawn, &drawn, &appearance, &err);
    assert_int_equal(status == STATUS_OK, sentence == NULL);
    if (sentence && !strstr(err.text, sentence))
        fail_msg("%s", err.text);
    assert_int_equal(map.srgb != NULL, sentence != NULL); /* moved only on success */
    colormap_release(&map);
    fieldvalues_release(&drawn);
    tree_release(&tree);
    return appearance;
}

static void ranges(const FieldScaleParams *params, double low, double high, const char *said)
{
    Appearance appearance = color(params, rising, 1, false, NULL);
    assert_true(fabs(appearance.scale.range[0] - low) < 1e-12 * fabs(high));
    assert_true(fabs(appearance.scale.range[1] - high) < 1e-12 * fabs(high));
    assert_string_equal(appearance.meaning, said);
    appearance_release(&appearance);
}

static void test_a_scale_spans_the_values_that_can_be_drawn(void **state)
{
    (void)state;
    FieldScaleParams params = plain;
    ranges(&params, 10, 40, "pressure 10 to 40 mmHg, of the 3 segments drawn");
    params.of_tree = true;
    ranges(&params, 10, 40, "pressure 10 to 40 mmHg, of all 3 segments of the tree");
}

static void test_ends_are_values_or_percentiles(void **state)
{
    (void)state;
    FieldScaleParams params = plain;
    params.has_ends = true;
    params.ends[0] = 15;
    params.ends[1] = 25;
    ranges(&params, 15, 25, "pressure 15 to 25 mmHg, as given; 1 below, 1 above");
    params.percent[1] = true;
    params.ends[1] = 50;
    ranges(&params, 15, 20,
           "pressure 15 to 20 mmHg, 15 to 50% of the 3 segments drawn; 1 below, 1 above");
}

static void test_classes_divide_the_scale(void **state)
{
    (void)state;
    static const double bounds[] = {15, 30};
    FieldScaleParams params = plain;
    params.classes = (const double[]){3};
    ranges(&params, 10, 40, "pressure 10 to 40 mmHg, of the 3 segments drawn; 3 classes");
    params.classes = bounds;
    params.n_classes = 2;
    ranges(&params, 10, 40, "pressure 10 to 40 mmHg, of the 3 segments drawn; classes at 15, 30");
}

static void test_each_segment_has_the_color_of_its_value(void **state)
{
    (void)state;
    Appearance appearance = color(&plain, rising, 1, false, NULL);
    assert_true(appearance.colors[1].r == 0);
    assert_true(appearance.colors[3].r == 1);
    assert_true(appearance.colors[2].r > 0 && appearance.colors[2].r < 1);
    assert_true(appearance.values[2] == 20);
    appearance_release(&appearance);
}

static void test_what_makes_no_scale_is_refused(void **state)
{
    (void)state;
    static const double none[] = {NAN, NAN, NAN, NAN, NAN}, below[] = {0, -1, -2, 0, 0},
                        halves[] = {0, 0.5, 1, 2, 0}, falling[] = {2, 1};
    FieldScaleParams params = plain;
    color(&params, none, 1, false, "`color_by`: the field pressure has no value");
    color(&params, halves, 1, true, "`colormap` map has separate colors, which suit integers");
    params.classes = falling;
    params.n_classes = 2;
    color(&params, rising, 1, false, "`classes`: bounds must ascend, but 2 comes before 1");
    params.classes = (const double[]){2.5};
    params.n_classes = 1;
    color(&params, rising, 1, false, "`classes`: '2.5' is not an integer from 1 to 256");
    params = plain;
    params.log = true;
    color(&params, below, 1, false, "has no value above 0");
    params.has_ends = true;
    params.ends[1] = 5;
    color(&params, rising, 1, false, "`range`: with `log` both ends must be positive, not 0");
    params.log = false;
    params.percent[0] = true;
    params.ends[0] = 100;
    color(&params, rising, 1, false,
          "`range`: the lower end 40 of the field pressure is above the upper end 5");
}

static void test_frames_share_one_scale(void **state)
{
    (void)state;
    static const double two[] = {0, 10, 20, 40, 0, 0, 20, 30, 50, 0};
    FieldScaleParams params = plain;
    Appearance all = color(&params, two, 2, false, NULL);
    assert_int_equal(all.n_frames, 2);
    assert_int_equal(all.n_segments, 5);
    assert_true(all.scale.range[0] == 10 && all.scale.range[1] == 50);
    appearance_release(&all);
    params.frame = 2;
    Appearance second = color(&params, two, 2, false, NULL);
    assert_int_equal(second.n_frames, 0);
    assert_true(second.values[1] == 20 && second.scale.range[0] == 10);
    appearance_release(&second);
    params.frame = 3;
    color(&params, two, 2, false, "`moment` 3: pressure has 2 time steps");
}

static void test_values_are_converted_to_a_unit_of_their_kind(void **state)
{
    (void)state;
    Tree tree = make_tree();
    FieldSeries series = make_series(rising, 1);
    FieldValues values;
    Err err = {{0}};
    must(fieldvalues_take(&tree, &series, "Pa", &values, &err), &err);
    assert_null(series.field.value);
    assert_int_equal(values.n_scale_values, 3);
    assert_string_equal(values.series.field.unit, "Pa");
    assert_true(fabs(values.scale_values[0] - 1333.22) < 0.01);
    fieldvalues_release(&values);
    series = make_series(rising, 1);
    assert_int_equal(fieldvalues_take(&tree, &series, "cm/s", &values, &err), STATUS_USAGE);
    assert_non_null(
        strstr(err.text, "`unit`: the field pressure is in mmHg, not in cm/s; it can be in"));
    fieldvalues_release(&values);
    tree_release(&tree);
}

static void test_decades_are_counted_where_a_logarithm_would_help(void **state)
{
    (void)state;
    static const double wide[] = {0, 0.01, 1, 100, 0};
    FieldScaleParams params = plain;
    Appearance appearance = color(&params, wide, 1, false, NULL);
    assert_true(fabs(fieldscale_decades(&appearance) - 4) < 1e-12);
    appearance_release(&appearance);
    params.log = true;
    appearance = color(&params, wide, 1, false, NULL);
    assert_true(fieldscale_decades(&appearance) == 0);
    appearance_release(&appearance);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_scale_spans_the_values_that_can_be_drawn),
        cmocka_unit_test(test_ends_are_values_or_percentiles),
        cmocka_unit_test(test_classes_divide_the_scale),
        cmocka_unit_test(test_each_segment_has_the_color_of_its_value),
        cmocka_unit_test(test_what_makes_no_scale_is_refused),
        cmocka_unit_test(test_frames_share_one_scale),
        cmocka_unit_test(test_values_are_converted_to_a_unit_of_their_kind),
        cmocka_unit_test(test_decades_are_counted_where_a_logarithm_would_help),
    };
    return cmocka_run_group_tests_name("fieldscale", tests, NULL, NULL);
}
