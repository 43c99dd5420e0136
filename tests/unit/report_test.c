#include "any_file.h"
#include "verify/verify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Err err;
static const char *const folder = "build/report_test";
static const char *const templates = "templates/report";

/* A scene of 12 x 9 grey pixels; B has one pixel brighter by `fault` levels. */
typedef struct Scene {
    Picture a, b;
    IdPlane ids;
    CompareResult color, id;
    ReportCase report;
} Scene;

static const char *const commands[] = {"corcast verify 'a<b>.swc' & co"};

static void scene_init(Scene *scene, int fault)
{
    assert_int_equal(file_make_folder(folder, &err), STATUS_OK);
    assert_int_equal(picture_init(&scene->a, 12, 9, 3, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&scene->b, 12, 9, 3, 8, &err), STATUS_OK);
    assert_int_equal(idplane_init(&scene->ids, 12, 9, &err), STATUS_OK);
    scene->ids.ids[40] = 2385;
    scene->b.codes8[3 * 40] = (uint8_t)fault;
    Tolerance tolerance = tolerance_identity(0.002);
    const Rendering a = {.picture = &scene->a, .ids = &scene->ids};
    const Rendering b = {.picture = &scene->b, .ids = &scene->ids};
    assert_int_equal(compare_pictures(&a, &b, &tolerance, &scene->color, NULL, &err), STATUS_OK);
    assert_int_equal(compare_ids(&scene->ids, &scene->ids, &tolerance, &scene->id, &err),
                     STATUS_OK);
    scene->report =
        (ReportCase){.name = "tree <1> & \"co\"",
                     .model = "rounded",
                     .a = {.name = "POV-Ray",
                           .key = "povray",
                           .version = "3.7.0.10",
                           .seconds = 1.5,
                           .picture = &scene->a,
                           .ids = &scene->ids},
                     .b = {.name = "corcast",
                           .key = "native",
                           .version = "0.1.0",
                           .seconds = 0.25,
                           .picture = &scene->b,
                           .ids = &scene->ids},
                     .commands = commands,
                     .n_commands = 1,
                     .planes = {[PLANE_COLOR] = &scene->color, [PLANE_ID] = &scene->id}};
}

static void scene_release(Scene *scene)
{
    picture_release(&scene->a);
    picture_release(&scene->b);
    idplane_release(&scene->ids);
}

static char *read_output(const char *name)
{
    char *path, *bytes;
    size_t size;
    assert_int_equal(file_join(folder, name, &path, &err), STATUS_OK);
    assert_int_equal(file_read(path, &any_file, &bytes, &size, &err), STATUS_OK);
    free(path);
    return bytes;
}

static void assert_holds(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("\"%s\" is missing", part);
}

static void writes_json_with_the_keys_of_the_contract(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 0);
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    assert_true(report_agrees(&scene.report));
    char *text = read_output("report.json");
    json_t *json = json_loads(text, 0, NULL);
    assert_string_equal(json_string_value(json_object_get(json, "verdict")), "agree");
    assert_string_equal(json_string_value(json_object_get(json, "model")), "rounded");
    json_t *planes = json_object_get(json, "planes");
    assert_non_null(json_object_get(planes, "color"));
    assert_null(json_object_get(planes, "depth"));
    assert_int_equal(
        json_integer_value(json_object_get(json_object_get(planes, "id"), "mismatch_fraction")), 0);
    json_t *povray = json_object_get(json, "povray");
    assert_string_equal(json_string_value(json_object_get(povray, "version")), "3.7.0.10");
    assert_float_equal(json_real_value(json_object_get(povray, "seconds")), 1.5, 0);
    assert_float_equal(json_real_value(json_object_get(json_object_get(json, "native"), "seconds")),
                       0.25, 0);
    json_decref(json);
    free(text);
    scene_release(&scene);
}

static void writes_a_page_that_needs_nothing_else(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 31);
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    assert_false(report_agrees(&scene.report));
    char *page = read_output("report.html");
    assert_null(strstr(page, "http:"));
    assert_null(strstr(page, "https:"));
    assert_null(strstr(page, "${"));
    assert_null(strstr(page, "<1>"));
    assert_holds(page, "tree &lt;1&gt; &amp; &quot;co&quot;");
    assert_holds(page, "corcast verify &#39;a&lt;b&gt;.swc&#39; &amp; co");
    assert_holds(page, "the worst, 31 levels, is at (4, 3), segment 2385");
    assert_holds(page, "src=\"data:image/png;base64,iVBORw0KGgo");
    free(page);
    scene_release(&scene);
}

static void embeds_the_pictures_byte_for_byte(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 31);
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    char *page = read_output("report.html");
    const char *at =
        strstr(page, "data-role=\"b\" data-name=\"corcast\" src=\"data:image/png;base64,");
    assert_non_null(at);
    at = strchr(at, ',') + 1;
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    Text png = TEXT_INIT;
    for (uint32_t bits = 0, n = 1; *at != '"' && *at != '='; at++, n++) {
        bits = bits << 6 | (uint32_t)(strchr(digits, *at) - digits);
        if (n % 4 != 1) {
            char byte = (char)(bits >> (2 * ((4 - n % 4) % 4)) & 255);
            text_append(&png, &byte, 1);
        }
    }
    Picture read;
    assert_int_equal(file_write("build/report_test/b.png", png.chars, png.length, &err), STATUS_OK);
    assert_int_equal(picture_read(&read, "build/report_test/b.png", &err), STATUS_OK);
    assert_memory_equal(read.codes8, scene.b.codes8, 12 * 9 * 3);
    text_release(&png);
    picture_release(&read);
    free(page);
    scene_release(&scene);
}

static void writes_a_junit_case_for_each_plane(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 31);
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    char *xml = read_output("junit.xml");
    assert_holds(xml, "<testsuite name=\"tree &lt;1&gt; &amp; &quot;co&quot;\" tests=\"2\" "
                      "failures=\"1\" errors=\"0\" skipped=\"0\">");
    assert_holds(xml, "<testcase classname=\"rounded\" name=\"color\">");
    assert_holds(xml, "<testcase classname=\"rounded\" name=\"id\">");
    assert_holds(xml, "<failure message=\"color: pixels off by more than 0 levels");
    free(xml);
    scene_release(&scene);
}

static void writes_numbers_that_read_back_to_the_same_double(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 7);
    scene.report.b.seconds = 2.0 / 7;
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    char *text = read_output("report.json");
    json_t *json = json_loads(text, 0, NULL), *back;
    back = json_object_get(json_object_get(json, "native"), "seconds");
    assert_true(json_real_value(back) == 2.0 / 7);
    back = json_object_get(json_object_get(json_object_get(json, "planes"), "color"), "psnr_db");
    assert_true(json_real_value(back) == scene.color.psnr_db);
    json_decref(json);
    free(text);
    scene_release(&scene);
}

static void shows_names_that_are_not_utf8_with_replacement_characters(void **state)
{
    (void)state;
    static const char *const latin_1[] = {"corcast verify jos\xE9.swc"};
    static const char shown[] = "jos" UTF8_REPLACEMENT ".swc";
    Scene scene;
    scene_init(&scene, 0);
    scene.report.name = "jos\xE9.swc";
    scene.report.commands = latin_1;
    assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
    static const char *const names[] = {"report.html", "report.json", "junit.xml"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *text = read_output(names[i]);
        Text utf8 = TEXT_INIT;
        assert_holds(text, shown);
        text_utf8(&utf8, text);
        assert_string_equal(text_chars(&utf8), text);
        text_release(&utf8);
        free(text);
    }
    char *text = read_output("report.json");
    json_t *json = json_loads(text, 0, NULL);
    assert_string_equal(json_string_value(json_object_get(json, "name")), shown);
    json_decref(json);
    free(text);
    scene_release(&scene);
}

static void write_output(const char *name, const char *text)
{
    char *path;
    assert_int_equal(file_join(folder, name, &path, &err), STATUS_OK);
    assert_int_equal(file_write(path, text, strlen(text), &err), STATUS_OK);
    free(path);
}

static void merges_a_page_with_an_empty_part(void **state)
{
    (void)state;
    bool agree = true;
    assert_int_equal(file_make_folder(folder, &err), STATUS_OK);
    write_output("report.html", "<!-- row: begin -->\n<!-- row: end -->\n<!-- case: begin -->\n"
                                "<!-- case: end -->\n");
    write_output("report.json", "{\"severity\": 3}");
    assert_int_equal(
        report_merge(&folder, 1, NULL, templates, "build/report_test/all.html", &agree, &err),
        STATUS_OK);
    assert_false(agree);
    char *page = read_output("all.html");
    assert_holds(page, "1 of 1 cases <span class=\"bad\">differ</span>");
    free(page);
}

static void writes_the_same_bytes_again(void **state)
{
    (void)state;
    static const char *const names[] = {"report.html", "report.json", "junit.xml", "diff.png"};
    Scene scene;
    scene_init(&scene, 3);
    char *first[4];
    for (int run = 0; run < 2; run++) {
        assert_int_equal(report_write(&scene.report, templates, folder, &err), STATUS_OK);
        for (int i = 0; i < 4; i++) {
            char *again = read_output(names[i]);
            if (run == 0) {
                first[i] = again;
                continue;
            }
            assert_string_equal(first[i], again);
            free(first[i]);
            free(again);
        }
    }
    scene_release(&scene);
}

static void says_when_the_template_is_missing(void **state)
{
    (void)state;
    Scene scene;
    scene_init(&scene, 0);
    assert_int_equal(report_write(&scene.report, "templates/none", folder, &err), STATUS_INPUT);
    assert_holds(err.text, "templates/none");
    assert_int_equal(report_write(&scene.report, templates, "build/no/folder", &err), STATUS_IO);
    scene_release(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_json_with_the_keys_of_the_contract),
        cmocka_unit_test(writes_a_page_that_needs_nothing_else),
        cmocka_unit_test(embeds_the_pictures_byte_for_byte),
        cmocka_unit_test(writes_a_junit_case_for_each_plane),
        cmocka_unit_test(writes_numbers_that_read_back_to_the_same_double),
        cmocka_unit_test(shows_names_that_are_not_utf8_with_replacement_characters),
        cmocka_unit_test(merges_a_page_with_an_empty_part),
        cmocka_unit_test(writes_the_same_bytes_again),
        cmocka_unit_test(says_when_the_template_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
