/* Expansion of templates, and their errors. */
#include "tmpl/tmpl.h"
#include "unit.h"
#include <stdint.h>
#include <string.h>
#include <unistd.h>

static const char *const path = "build/tmpl_test.txt", *const file = "tmpl_test.txt";

static Status expand(const char *source, const TmplValue *values, size_t n, Text *out, Err *err)
{
    assert_int_equal(file_make_folder("build", err), STATUS_OK);
    assert_int_equal(file_write(path, source, strlen(source), err), STATUS_OK);
    Tmpl template;
    assert_int_equal(tmpl_load(&template, "build", file, err), STATUS_OK);
    Status status = tmpl_apply(&template, values, n, out, err);
    tmpl_release(&template);
    unlink(path);
    return status;
}

static void puts_each_value_where_its_name_stands(void **state)
{
    (void)state;
    const TmplValue values[] = {{"model", "rounded"}, {"n_2", "401"}};
    Text out = TEXT_INIT;
    Err err = {0};
    text_puts(&out, "> ");
    assert_int_equal(
        expand("#declare M = \"${model}\"; union { ${n_2} ${model} }\n$$5", values, 2, &out, &err),
        STATUS_OK);
    assert_string_equal(out.chars, "> #declare M = \"rounded\"; union { 401 rounded }\n$5");
    text_release(&out);
}

static void does_not_expand_what_a_value_brings(void **state)
{
    (void)state;
    const TmplValue values[] = {{"a", "${b} $"}};
    Text out = TEXT_INIT;
    Err err = {0};
    assert_int_equal(expand("${a}", values, 1, &out, &err), STATUS_OK);
    assert_string_equal(out.chars, "${b} $");
    text_release(&out);
}

static void refuses(const char *source, const TmplValue *values, size_t n, const char *sentence)
{
    Text out = TEXT_INIT;
    Err err = {0};
    text_puts(&out, "before");
    assert_int_equal(expand(source, values, n, &out, &err), STATUS_INPUT);
    assert_string_equal(err.text, sentence);
    assert_string_equal(out.chars, "before");
    text_release(&out);
}

static void leaves_out_sections_by_their_values(void **state)
{
    (void)state;
    const TmplValue values[] = {{"colors", "1"}, {"blended", "0"}, {"note", ""}};
    Text out = TEXT_INIT;
    Err err = {0};
    assert_int_equal(
        expand("a\n${?colors}\nb\n${?blended}\nc\n${/blended}\n${!blended}d$$${/blended}"
               "${/colors}\ne\n${?note}${colors}${/note}${!colors}f${!blended}g"
               "${/blended}${/colors}",
               values, 3, &out, &err),
        STATUS_OK);
    assert_string_equal(out.chars, "a\nb\nd$e\n");
    text_release(&out);
}

static void refuses_sections_that_do_not_begin_or_end(void **state)
{
    (void)state;
    const TmplValue values[] = {{"a", "0"}, {"b", "1"}};
    refuses("${?a}${?b}\n${/a}${/b}", values, 2, "build/tmpl_test.txt:2: ${/a} ends no section");
    refuses("${a}${b}\n\n${/a}", values, 2, "build/tmpl_test.txt:3: ${/a} ends no section");
    refuses("${a}${!b}", values, 2, "build/tmpl_test.txt: the section of b has no end");
    refuses("${a}\n${?c}${b}${/c}", values, 2, "build/tmpl_test.txt:2: there is no value for ${c}");
}

static void names_the_line_of_a_name_without_a_value(void **state)
{
    (void)state;
    const TmplValue values[] = {{"seed", "7"}};
    refuses("one\n${seed}\n  ${sed}\n", values, 1,
            "build/tmpl_test.txt:3: there is no value for ${sed}");
}

static void names_a_value_the_template_never_uses(void **state)
{
    (void)state;
    const TmplValue values[] = {{"seed", "7"}, {"size", "9"}};
    refuses("${seed}", values, 2, "build/tmpl_test.txt: the template never uses ${size}");
}

static void refuses_a_dollar_that_starts_nothing(void **state)
{
    (void)state;
    static const char *const sources[] = {"\n$", "\n$5", "\n${}", "\n${a", "\n${9a}", "\n${a b}"};
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
        refuses(sources[i], NULL, 0,
                "build/tmpl_test.txt:2: '$' must begin ${name} or $$, which gives one '$'");
}

static Status put_count(Text *out, const void *context, Err *err)
{
    int *const *count = context;
    text_printf(out, "part %d", ++**count);
    return **count < 3 ? STATUS_OK : err_set(err, STATUS_IO, "the third fails");
}

static Status stream(const char *source, int *count, Text *out, Err *err)
{
    const TmplValue values[] = {{"a", "value"}};
    const TmplPart parts[] = {{"p", put_count, &count}};
    Tmpl template;
    assert_int_equal(file_write(path, source, strlen(source), err), STATUS_OK);
    assert_int_equal(tmpl_load(&template, "build", file, err), STATUS_OK);
    Status status = tmpl_stream(&template, values, 1, parts, 1, out, err);
    tmpl_release(&template);
    unlink(path);
    return status;
}

static void parts_are_made_when_the_template_comes_to_them(void **state)
{
    (void)state;
    Text out = TEXT_INIT;
    Err err = {0};
    int count = 0;
    assert_int_equal(stream("${p} ${a} ${p}", &count, &out, &err), STATUS_OK);
    assert_string_equal(out.chars, "part 1 value part 2");
    assert_int_equal(stream("${a}, ${p}", &count, &out, &err), STATUS_IO);
    assert_string_equal(err.text, "the third fails");
    text_release(&out);
}

/* A fault in the template is found before a part is made. */
static void of_a_template_with_a_fault_no_part_is_made(void **state)
{
    (void)state;
    Text out = TEXT_INIT;
    Err err = {0};
    int count = 0;
    assert_int_equal(stream("${p} ${a} ${b}", &count, &out, &err), STATUS_INPUT);
    assert_int_equal(stream("${a}", &count, &out, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "never uses ${p}"));
    assert_int_equal(count, 0);
    assert_null(out.chars);
}

static void says_when_the_template_is_missing(void **state)
{
    (void)state;
    Tmpl template;
    Err err = {0};
    assert_int_equal(tmpl_load(&template, "build", "no such template", &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "build/no such template"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(puts_each_value_where_its_name_stands),
        cmocka_unit_test(does_not_expand_what_a_value_brings),
        cmocka_unit_test(leaves_out_sections_by_their_values),
        cmocka_unit_test(refuses_sections_that_do_not_begin_or_end),
        cmocka_unit_test(names_the_line_of_a_name_without_a_value),
        cmocka_unit_test(names_a_value_the_template_never_uses),
        cmocka_unit_test(refuses_a_dollar_that_starts_nothing),
        cmocka_unit_test(parts_are_made_when_the_template_comes_to_them),
        cmocka_unit_test(of_a_template_with_a_fault_no_part_is_made),
        cmocka_unit_test(says_when_the_template_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
