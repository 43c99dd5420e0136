/* The operation `render`, called without the command line. */
#include "cli/commands.h"
#include "job/picture/render.h"
#include "options/templates.h"
#include "scratch.h"
#include "unit.h"

#include <stdio.h>

enum { MOST_WORDS = 24 };

/* Reads "--model blob --planes id" as options of `render` for a tree of the tests. */
static void parse(const char *options, Parsed *parsed, char words[512])
{
    Err err = {{0}};
    char *argv[MOST_WORDS], *rest = NULL;
    int n = 0;
    snprintf(words, 512, "tests/data/coronary.swc --size 90x70 %s", options);
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        argv[n++] = word;
    must(parsed_init(parsed, command_find("render"), &err), &err);
    must(options_parse(parsed, n, argv, &err), &err);
}

/* Draws one picture into memory, as the library does. */
static Status draw(Parsed *parsed, RenderResult *result, Err *err)
{
    Rendering rendering;
    *result = (RenderResult){0};
    ((RenderOptions *)parsed->options)->output = NULL;
    TRY(rendering_open(parsed->options, parsed, NULL, &rendering, err));
    Status status = rendering_describe(&rendering, err);
    if (status == STATUS_OK)
        status = rendering_draw_result(&rendering, result, err);
    rendering_close(&rendering);
    return status;
}

static void make(const char *options, RenderResult *result)
{
    Parsed parsed;
    Err err = {{0}};
    char words[512], with_output[400];
    snprintf(with_output, sizeof with_output, "%s -o unused.png", options);
    parse(with_output, &parsed, words);
    must(draw(&parsed, result, &err), &err);
    parsed_release(&parsed);
}

/* Draws the same into a file, whose path is in *path. */
static void run(const char *options, const char *name, char path[64])
{
    Parsed parsed;
    Err err = {{0}};
    char words[512], with_output[400];
    snprintf(path, 64, "%s/%s", folder, name);
    snprintf(with_output, sizeof with_output, "%s -o %s", options, path);
    parse(with_output, &parsed, words);
    must(render_run(parsed.options, &parsed, &err), &err);
    parsed_release(&parsed);
}

static void test_a_picture_in_memory_has_the_codes_of_the_file(void **state)
{
    (void)state;
    static const struct {
        const char *options;
        int channels, bits, height;
    } cases[] = {
        {"", 3, 8, 70},
        {"--model isosurface --bits 16 --look journal", 3, 16, 70},
        {"--background none", 4, 8, 70},
        {"--color-by radius --legend on --scale-bar 5 --letter a --text-size 2", 3, 8, 70},
        {"--memory 0.01 --antialias 2 --model blob --shadows on", 3, 8, 70},
        {"--tile 2/3", 3, 8, 24},
        {"--look xray", 3, 8, 70},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RenderResult result;
        Picture file;
        Err err = {{0}};
        char path[64];
        make(cases[i].options, &result);
        run(cases[i].options, "p.png", path);
        must(picture_read(&file, path, ALPHA_KEPT, &err), &err);
        const Picture *codes = &result.frame.codes;
        assert_int_equal(codes->bits, cases[i].bits);
        assert_int_equal(codes->channels, cases[i].channels);
        assert_int_equal(codes->width, 90);
        assert_int_equal(codes->height, cases[i].height);
        assert_int_equal(file.height, cases[i].height);
        for (int y = 0; y < file.height; y++)
            assert_true(picture_rows_equal(codes, &file, y, 0, file.width));
        assert_null(result.frame.color.values);
        picture_release(&file);
        renderresult_release(&result);
        remove(path);
    }
}

/* Planes in files are PFM and PPM; those in memory have the same values. */
static void test_planes_in_memory_have_the_values_of_the_files(void **state)
{
    (void)state;
    RenderResult result;
    Plane depth, normal, color;
    Picture id, codes;
    Err err = {{0}};
    static const char options[] = "--planes color,depth,normal,id --memory 0.001";
    static const char *const suffixes[] = {"png", "color.pfm", "depth.pfm", "normal.pfm", "id.ppm"};
    char path[64], names[5][64];
    make(options, &result);
    run(options, "p.png", path);
    for (int i = 0; i < 5; i++)
        snprintf(names[i], 64, "%s/p.%s", folder, suffixes[i]);
    must(plane_read(&color, names[1], ALPHA_REFUSED, &err), &err);
    must(plane_read(&depth, names[2], ALPHA_REFUSED, &err), &err);
    must(plane_read(&normal, names[3], ALPHA_REFUSED, &err), &err);
    must(picture_read(&id, names[4], ALPHA_REFUSED, &err), &err);
    must(picture_from_ids(&codes, &result.frame.id, &err), &err);
    const size_t n = (size_t)90 * 70;
    assert_memory_equal(result.frame.color.values, color.values, 3 * n * sizeof(float));
    assert_memory_equal(result.frame.depth.values, depth.values, n * sizeof(float));
    assert_memory_equal(result.frame.normal.values, normal.values, 3 * n * sizeof(float));
    assert_memory_equal(codes.codes8, id.codes8, 3 * n);
    plane_release(&color);
    plane_release(&depth);
    plane_release(&normal);
    picture_release(&id);
    picture_release(&codes);
    renderresult_release(&result);
    for (int i = 0; i < 5; i++)
        remove(names[i]);
}

static void test_32_bits_give_linear_floats_with_alpha(void **state)
{
    (void)state;
    RenderResult result;
    Plane file;
    Err err = {{0}};
    char path[64];
    make("--bits 32 --background none", &result);
    run("--background none", "p.exr", path);
    must(plane_read(&file, path, ALPHA_KEPT, &err), &err);
    assert_int_equal(file.channels, 4);
    assert_null(result.frame.codes.codes8);
    for (size_t i = 0; i < (size_t)90 * 70; i++) {
        for (size_t c = 0; c < 3; c++)
            assert_true(result.frame.color.values[3 * i + c] == file.values[4 * i + c]);
        assert_true(result.frame.alpha.values[i] == file.values[4 * i + 3]);
    }
    plane_release(&file);
    renderresult_release(&result);
    remove(path);
}

static void refused(const char *options, const char *sentence)
{
    Parsed parsed;
    RenderResult result;
    Err err = {{0}};
    char words[512], with_output[400];
    snprintf(with_output, sizeof with_output, "%s -o unused.png", options);
    parse(with_output, &parsed, words);
    assert_int_equal(draw(&parsed, &result, &err), STATUS_USAGE);
    if (!strstr(err.text, sentence))
        fail_msg("%s", err.text);
    parsed_release(&parsed);
}

static void test_what_needs_files_is_refused(void **state)
{
    (void)state;
    refused("--turntable 12",
            "--only K is missing: a picture in memory is one of the animation's 12");
    refused("--tile 1/2 --resume",
            "--resume needs files; it cannot be used with pictures in memory");
    refused("--turntable 3 --commands",
            "--commands needs files; it cannot be used with pictures in memory");
    refused("--ink 0.2", "--ink writes .svg, .pdf or .eps only");
    refused("--bits 12", "--bits: '12': this format stores 8 or 16 bits");
}

static void test_one_picture_of_an_animation_is_drawn(void **state)
{
    (void)state;
    RenderResult first, third;
    make("--turntable 4 --only 1", &first);
    make("--turntable 4 --only 3", &third);
    assert_memory_not_equal(first.frame.codes.codes8, third.frame.codes.codes8, 3 * 90 * 70);
    renderresult_release(&first);
    renderresult_release(&third);
}

/* A scene that is opened once draws several views, each as if it were drawn alone. */
static void test_a_scene_is_drawn_several_times(void **state)
{
    (void)state;
    Parsed parsed;
    Rendering rendering;
    Frame once = {0}, again = {0}, nearer = {0};
    Err err = {{0}};
    char words[512];
    parse("-o unused.png", &parsed, words);
    ((RenderOptions *)parsed.options)->output = NULL;
    must(rendering_open(parsed.options, &parsed, NULL, &rendering, &err), &err);
    View view = rendering.scene.view;
    view.camera.right = vec3_scale(view.camera.right, 0.5);
    view.camera.up = vec3_scale(view.camera.up, 0.5);
    must(rendering_draw(&rendering, 1, &once, &err), &err);
    must(rendering_draw_view(&rendering, &view, &nearer, &err), &err);
    must(rendering_draw(&rendering, 1, &again, &err), &err);
    assert_memory_equal(once.codes.codes8, again.codes.codes8, 3 * 90 * 70);
    assert_memory_not_equal(once.codes.codes8, nearer.codes.codes8, 3 * 90 * 70);
    rendering_close(&rendering);
    parsed_release(&parsed);
    frame_release(&once);
    frame_release(&again);
    frame_release(&nearer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_picture_in_memory_has_the_codes_of_the_file),
        cmocka_unit_test(test_planes_in_memory_have_the_values_of_the_files),
        cmocka_unit_test(test_32_bits_give_linear_floats_with_alpha),
        cmocka_unit_test(test_what_needs_files_is_refused),
        cmocka_unit_test(test_one_picture_of_an_animation_is_drawn),
        cmocka_unit_test(test_a_scene_is_drawn_several_times),
    };
    templates_set("templates");
    return cmocka_run_group_tests_name("render_job", tests, make_folder, remove_folder);
}
