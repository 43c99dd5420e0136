/* Options set by name say what the command line says, in the same sentences. */
#include "cli/commands.h"
#include "unit.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Parsed parsed, typed;
static Err err;

static void begin(const Command *command)
{
    must(parsed_init(&parsed, command, &err), &err);
    must(parsed_init(&typed, command, &err), &err);
}

static void end(void)
{
    parsed_release(&parsed);
    parsed_release(&typed);
}

static void check_value(const char *name, const char *expected)
{
    Text text = TEXT_INIT;
    must(options_get(&parsed, name, &text, &err), &err);
    assert_string_equal(text_chars(&text), expected);
    text_release(&text);
}

static void a_value_that_is_set_is_got(void **state)
{
    (void)state;
    begin(&command_render);
    char value[] = "2.50";
    must(options_set(&parsed, "prune-radius", value, &err), &err);
    value[0] = '9';
    must(options_set(&parsed, "model", "blob", &err), &err);
    must(options_set(&parsed, "color-by", "wss", &err), &err);
    must(options_set(&parsed, "color-by", "flow", &err), &err);
    must(options_set(&parsed, "exact", "on", &err), &err);
    check_value("prune-radius", "2.5");
    check_value("model", "blob");
    check_value("color-by", "flow");
    check_value("exact", "on");
    check_value("log", "");
    check_value("seed", "1");
    end();
}

static void values_of_a_list_are_appended(void **state)
{
    (void)state;
    begin(&command_grow);
    must(options_set(&parsed, "inlet", "0,50", &err), &err);
    must(options_set(&parsed, "inlet", "30,-40", &err), &err);
    check_value("inlet", "0,50,0\n30,-40,0");
    end();
}

/* `name` and `value` are refused as they are on the command line. */
static void check_refused(const Command *command, const char *name, char *value)
{
    char option[64], *arguments[] = {option, value};
    Err by_name = {{0}}, by_line = {{0}};
    begin(command);
    snprintf(option, sizeof option, "--%s", name);
    assert_true(options_set(&parsed, name, value, &by_name) == STATUS_USAGE);
    assert_true(options_parse(&typed, 2, arguments, &by_line) == STATUS_USAGE);
    assert_string_equal(by_name.text, by_line.text);
    assert_string_not_equal(by_name.text, "");
    end();
}

static void refusals_are_those_of_the_command_line(void **state)
{
    (void)state;
    char three[] = "3", letters[] = "many", low[] = "-1", shape[] = "blobb";
    check_refused(&command_grow, "lamda", three);
    check_refused(&command_grow, "model", shape);
    check_refused(&command_grow, "terminals", letters);
    check_refused(&command_grow, "gamma", low);
    check_refused(&command_render, "model", shape);
    Text text = TEXT_INIT;
    begin(&command_grow);
    assert_true(options_get(&parsed, "lamda", &text, &err) == STATUS_USAGE);
    assert_true(strstr(err.text, "did you mean --lambda?"));
    text_release(&text);
    end();
}

/* What is set by name wins over a recipe, as on the command line. */
static void a_recipe_is_read_at_the_end(void **state)
{
    (void)state;
    char path[] = "/tmp/options_test_XXXXXX";
    int file = mkstemp(path);
    static const char recipe[] = "terminals = 7\ngamma = 2.5\n[view]\nsize = 3x3\n";
    assert_true(write(file, recipe, sizeof recipe - 1) == sizeof recipe - 1);
    close(file);
    begin(&command_grow);
    must(options_set(&parsed, "recipe", path, &err), &err);
    must(options_set(&parsed, "terminals", "9", &err), &err);
    must(options_set(&parsed, "output", "/tmp/options_test.swc", &err), &err);
    must(options_finish(&parsed, &err), &err);
    check_value("terminals", "9");
    check_value("gamma", "2.5");
    end();
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_that_is_set_is_got),
        cmocka_unit_test(values_of_a_list_are_appended),
        cmocka_unit_test(refusals_are_those_of_the_command_line),
        cmocka_unit_test(a_recipe_is_read_at_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
