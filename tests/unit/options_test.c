/* Options set by name have the effect of the command line, with the same error messages. */
#include "cli/commands.h"
#include "options/templates.h"
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

/* Writes a recipe into a file of a new name, whose last X are replaced. */
static void write_recipe(char *path, const char *recipe)
{
    int file = mkstemp(path);
    assert_int_equal(write(file, recipe, strlen(recipe)), strlen(recipe));
    close(file);
}

/* What is set by name wins over a recipe, as on the command line. */
static void a_recipe_is_read_at_the_end(void **state)
{
    (void)state;
    char path[] = "/tmp/options_test_XXXXXX";
    write_recipe(path, "terminals = 7\ngamma = 2.5\n[view]\nsize = 3x3\n");
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

/* Sets an option of `render` beside an output, and returns how that ends. */
static Status finish_render(const char *name, const char *value)
{
    begin(&command_render);
    must(options_set(&parsed, name, value, &err), &err);
    must(options_set(&parsed, "output", "/tmp/options_test.png", &err), &err);
    parsed.operands[parsed.n_operands++] = "/dev/null";
    Status status = options_finish(&parsed, &err);
    end();
    return status;
}

static void an_option_without_effect_is_refused_with_what_it_needs(void **state)
{
    (void)state;
    assert_int_equal(finish_render("tiles", "3"), STATUS_USAGE);
    assert_string_equal(err.text, "--tiles needs --commands");
    assert_int_equal(finish_render("text-size", "8"), STATUS_USAGE);
    assert_string_equal(err.text, "--text-size needs --legend, --scale-bar or --letter");
    assert_int_equal(finish_render("joints", "paper"), STATUS_USAGE);
    assert_string_equal(err.text, "--joints is for --model joined");
    must(finish_render("model", "joined"), &err);
}

static void an_option_that_is_excluded_is_refused(void **state)
{
    (void)state;
    begin(&command_power);
    must(options_set(&parsed, "verdict", "cmp {a} {b}", &err), &err);
    must(options_set(&parsed, "ppm", "8", &err), &err);
    assert_int_equal(options_finish(&parsed, &err), STATUS_USAGE);
    assert_string_equal(err.text, "--ppm and --verdict are two rules; use only one");
    end();
}

/* A recipe's options are defaults for many runs. */
static void an_option_of_a_recipe_may_have_no_effect(void **state)
{
    (void)state;
    char path[] = "/tmp/options_test_XXXXXX";
    write_recipe(path, "tiles = 3\njoints = paper\n");
    must(finish_render("recipe", path), &err);
    unlink(path);
}

/* Whether a command that has this very row has an option of the name, too. */
static bool is_known_beside(const Option *option, const char *name, size_t length)
{
    bool found = false;
    for (const CommandRow *row = command_rows; row->command && !found; row++) {
        Parsed plain;
        must(parsed_init(&plain, row->command, &err), &err);
        const Setting *same = parsed_find(&plain, option->name, strlen(option->name));
        found = same && same->option == option && parsed_find(&plain, name, length);
        parsed_release(&plain);
    }
    return found;
}

static void check_names(const Option *option, const char *names)
{
    while (names && *names) {
        size_t length = strcspn(names, " ");
        if (!is_known_beside(option, names, length))
            fail_msg("--%s names --%s, which no command has beside it", option->name, names);
        names += length + strspn(names + length, " ");
    }
}

static void rows_name_options_and_conditions_that_there_are(void **state)
{
    (void)state;
    ConditionSet used = 0;
    for (const CommandRow *row = command_rows; row->command; row++) {
        begin(row->command);
        for (size_t i = 0; i < parsed.n_settings; i++) {
            const Option *option = parsed.settings[i].option;
            used |= option->when | conditions_of_group((int)option->group);
            check_names(option, option->needs);
            check_names(option, option->excludes);
        }
        end();
    }
    for (int i = 0; i < CONDITIONS; i++) {
        Text sentence = TEXT_INIT;
        condition_put((Condition)i, &sentence);
        if (!(used >> i & 1) || sentence.length == 0)
            fail_msg("condition %d, '%s', is of no option", i, text_chars(&sentence));
        text_release(&sentence);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_that_is_set_is_got),
        cmocka_unit_test(values_of_a_list_are_appended),
        cmocka_unit_test(refusals_are_those_of_the_command_line),
        cmocka_unit_test(a_recipe_is_read_at_the_end),
        cmocka_unit_test(an_option_without_effect_is_refused_with_what_it_needs),
        cmocka_unit_test(an_option_that_is_excluded_is_refused),
        cmocka_unit_test(an_option_of_a_recipe_may_have_no_effect),
        cmocka_unit_test(rows_name_options_and_conditions_that_there_are),
    };
    templates_set("templates");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
