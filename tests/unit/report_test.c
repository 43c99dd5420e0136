/* Report pages: writing and merging. */
#include "any_file.h"
#include "compare/compare.h"
#include "compare/report/check.h"
#include "compare/rules/judge.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
                           .shown = {.picture = &scene->a, .ids = &scene->ids}},
                     .b = {.name = "corcast",
                           .key = "native",
                           .version = "0.1.0",
                           .seconds = 0.25,
                           .shown = {.picture = &scene->b, .ids = &scene->ids}},
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
    assert_int_equal(picture_read(&read, "build/report_test/b.png", ALPHA_REFUSED, &err),
                     STATUS_OK);
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
    assert_holds(xml, "of the pixels are off by more than 0 levels (allowed: ");
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
    assert_true(json_real_value(back) == scene.color.values[MEASURE_PSNR_DB]);
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
    assert_int_equal(report_merge(&(ReportMerge){&folder, 1, NULL, templates},
                                  "build/report_test/all.html", &agree, &err),
                     STATUS_OK);
    assert_false(agree);
    char *page = read_output("all.html");
    assert_holds(page, "1 of 1 cases <span class=\"bad\">differ</span>");
    free(page);
}

static const char *at_of(const char *page, const char *part)
{
    const char *at = strstr(page, part);
    if (!at)
        fail_msg("\"%s\" is missing", part);
    return at;
}

/* The first case agrees, the second differs by 31 levels; A's limit of 2 ppm is broken 4,630 fold.
 */
static void merges_cases_worst_first_under_numbers_of_their_own(void **state)
{
    (void)state;
    static const char *const folders[] = {"build/report_test/one", "build/report_test/two"};
    bool agree = true;
    for (int i = 0; i < 2; i++) {
        Scene scene;
        scene_init(&scene, i * 31);
        scene.report.name = i ? "second" : "first";
        assert_int_equal(file_make_folder(folders[i], &err), STATUS_OK);
        assert_int_equal(report_write(&scene.report, templates, folders[i], &err), STATUS_OK);
        assert_float_equal(report_severity(&scene.report), (i ? 4629.62963F : 0), 1e-3F);
        scene_release(&scene);
    }
    write_output("power.json",
                 "{\"faults\": [{\"fault\": \"<f>\", \"model\": \"blob\", \"A\": true,"
                 " \"B\": false}], \"limits\": [{\"parameter\": \"p\", \"A\": 0.0123}],"
                 " \"alarms\": [], \"clean_scenes\": 3, \"povray_scenes\": 4}");
    assert_int_equal(
        report_merge(&(ReportMerge){folders, 2, "build/report_test/power.json", templates},
                     "build/report_test/all.html", &agree, &err),
        STATUS_OK);
    assert_false(agree);
    char *page = read_output("all.html");
    assert_holds(page, "1 of 2 cases <span class=\"bad\">differ</span>");
    assert_true(at_of(page, "<tr data-case=\"case-2\">") <
                at_of(page, "<tr data-case=\"case-1\">"));
    assert_true(at_of(page, "id=\"case-2\"") < at_of(page, "id=\"case-1\""));
    assert_true(at_of(page, "<a href=\"#case-2\">second</a>") <
                at_of(page, "<a href=\"#case-1\">first</a>"));
    assert_holds(page, "<th>&lt;f&gt;</th><td>blob</td><td>✓</td><td>–</td><td></td>");
    assert_holds(page, "<td>p</td><td></td><td></td><td class=\"number\">0.012</td>");
    assert_holds(page, "0 false alarms about 7 clean scenes");
    free(page);
}

static void merges_no_page_of_another_program(void **state)
{
    (void)state;
    bool agree = true;
    assert_int_equal(file_make_folder(folder, &err), STATUS_OK);
    write_output("report.html", "<html></html>");
    write_output("report.json", "{\"severity\": 3}");
    assert_int_equal(report_merge(&(ReportMerge){&folder, 1, NULL, templates},
                                  "build/report_test/no.html", &agree, &err),
                     STATUS_INPUT);
    assert_holds(err.text, "report.html: is not a report written by this version of corcast");
    write_output("report.html", "<!-- row: begin -->\n<!-- row: end -->\n<!-- case: begin -->\n"
                                "<!-- case: end -->\n");
    write_output("report.json", "{\"severity\": \"3\"}");
    assert_int_equal(report_merge(&(ReportMerge){&folder, 1, NULL, templates},
                                  "build/report_test/no.html", &agree, &err),
                     STATUS_INPUT);
    assert_holds(err.text, "report.json: has no number \"severity\"");
}

/* ---- surface --------------------------------------------------------------------------------- */

/* Depths of 7 pixels in a row, how far they may be apart, and what is found. */
typedef struct Surface {
    float a[7], b[7], allowed[7];
    SurfaceCheck found;
} Surface;

static void check_surface_of(Surface *surface)
{
    const Plane a = {.width = 7, .height = 1, .channels = 1, .values = surface->a};
    const Plane b = {.width = 7, .height = 1, .channels = 1, .values = surface->b};
    const Plane allowed = {.width = 7, .height = 1, .channels = 1, .values = surface->allowed};
    assert_int_equal(surface_check(&a, &b, &allowed, &surface->found, &err), STATUS_OK);
}

#define OUT INFINITY

static void an_isosurface_is_where_the_search_saw_it_to_what_is_allowed(void **state)
{
    (void)state;
    Surface s = {.a = {3, 5.5f, 7, OUT, 9, OUT, 11},
                 .b = {3, 5.25f, 7.125f, OUT, OUT, 6, 11.5f},
                 .allowed = {1, 0.5f, 0.25f, 1, OUT, OUT, 0.5f}};
    check_surface_of(&s);
    assert_true(s.found.agrees);
    assert_string_equal(s.found.reason, "");
    assert_int_equal(s.found.pixels, 7);
    assert_int_equal(s.found.common, 4);
    assert_int_equal(s.found.grazing, 2); /* seen on one side only, as a grazing ray may be */
    assert_int_equal(s.found.missing + s.found.extra + s.found.beyond, 0);
    assert_float_equal(s.found.median_mm, 0.125, 0);
    assert_float_equal(s.found.p99_mm, 0.5, 0);
    assert_float_equal(s.found.max_mm, 0.5, 0);
    assert_float_equal(s.found.max_ratio, 1, 0);
    assert_int_equal(s.found.worst_x, 6);
}

static void a_surface_that_is_missing_extra_or_too_far_is_found_out(void **state)
{
    (void)state;
    static const struct {
        float a, b;
        size_t missing, extra, beyond;
        const char *reason;
    } cases[] = {{9, OUT, 1, 0, 0, "hits found only by POV-Ray: 1, only by proof: 0"},
                 {OUT, 9, 0, 1, 0, "hits found only by POV-Ray: 0, only by proof: 1"},
                 {9, 10, 0, 0, 1, "the worst by a factor of 4 at (4, 0)"},
                 {9, NAN, 1, 0, 0, "hits found only by POV-Ray: 1"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Surface s = {.a = {3, 5, 7, OUT, cases[i].a, OUT, OUT},
                     .b = {3, 5, 7, OUT, cases[i].b, OUT, OUT},
                     .allowed = {1, 1, 1, 1, 0.25f, 1, 1}};
        check_surface_of(&s);
        assert_false(s.found.agrees);
        assert_int_equal(s.found.missing, cases[i].missing);
        assert_int_equal(s.found.extra, cases[i].extra);
        assert_int_equal(s.found.beyond, cases[i].beyond);
        assert_holds(s.found.reason, cases[i].reason);
    }
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

static void rounds_what_a_rule_measures_but_not_to_what_is_allowed(void **state)
{
    (void)state;
    static const struct {
        double measured, allowed;
        const char *sentence;
    } cases[] = {{14577.083, 2, "1.46 % of the pixels are off (allowed: 0.0002 %)"},
                 {108.3333, 2, "0.0108 % of the pixels are off (allowed: 0.0002 %)"},
                 {0.0413667, 0.01, "4.14e-06 % of the pixels are off (allowed: 1e-06 %)"},
                 {0.15004, 0.15, "1.5004e-05 % of the pixels are off (allowed: 1.5e-05 %)"},
                 {3e38, 2, "3e+34 % of the pixels are off (allowed: 0.0002 %)"}};
    const CompareResult plane = {.kind = PLANE_COLOR};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const Rule rule = {.name = "pixels off",
                           .unit = "ppm",
                           .measured = cases[i].measured,
                           .allowed = cases[i].allowed,
                           .at = {.x = -1}};
        char sentence[200];
        rule_sentence(&plane, &rule, sentence, sizeof sentence);
        assert_holds(sentence, cases[i].sentence);
    }
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
        cmocka_unit_test(merges_cases_worst_first_under_numbers_of_their_own),
        cmocka_unit_test(merges_no_page_of_another_program),
        cmocka_unit_test(an_isosurface_is_where_the_search_saw_it_to_what_is_allowed),
        cmocka_unit_test(a_surface_that_is_missing_extra_or_too_far_is_found_out),
        cmocka_unit_test(writes_the_same_bytes_again),
        cmocka_unit_test(says_when_the_template_is_missing),
        cmocka_unit_test(rounds_what_a_rule_measures_but_not_to_what_is_allowed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
