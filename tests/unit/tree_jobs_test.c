/* Operations on trees without a command line: their results in memory equal the files of their
 * commands, and their messages go to the caller. */
#include "job/tree/certify.h"
#include "job/tree/info.h"
#include "job/tree/makers.h"
#include "options/output.h"
#include "treeio/treeio.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A command and its options, "NAME VALUE ..." in turn. */
typedef struct Asked {
    const char *command;
    const char *options[12]; /* NULL ends them */
} Asked;

static const Asked growth = {"grow", {"terminals", "12", "seed", "4", "json", "none.json", NULL}};
static const Asked refinement = {"refine", {"refine", "geometry", "json", "none.json", NULL}};

static void set_options(Parsed *parsed, const Asked *asked)
{
    Err err = {""};
    for (const char *const *option = asked->options; *option; option += 2)
        must(options_set(parsed, option[0], option[1], &err), &err);
}

/* Runs the operation in memory, on `given` if it is not NULL; the caller releases the result. */
static MadeTree made(const Asked *asked, const Tree *given, const char *name, const Talk *talk)
{
    const TreeMaker *maker = tree_maker_find(asked->command);
    Parsed parsed;
    MadeTree result = {.report = NULL};
    Err err = {""};
    must(parsed_init(&parsed, maker->command, &err), &err);
    parsed.in_memory = true;
    parsed.common.talk = talk;
    if (given)
        parsed_give(&parsed, given, name);
    set_options(&parsed, asked);
    must(options_finish(&parsed, &err), &err);
    must(maker->make(parsed.options, &parsed, &result, &err), &err);
    parsed_release(&parsed);
    return result;
}

/* Runs the command on words as a shell gives them, and reads what it wrote into *bytes. */
static void written(const char *command, const char *arguments, const char *path, Text *bytes)
{
    const TreeMaker *maker = tree_maker_find(command);
    char line[120], *words[20], *rest = line;
    int n = 0;
    snprintf(line, sizeof line, "%s", arguments);
    for (char *word; (word = strsep(&rest, " "));)
        words[n++] = word;
    Parsed parsed;
    MadeTree result = {.report = NULL};
    Tree tree = {0};
    Err err = {""};
    must(parsed_init(&parsed, maker->command, &err), &err);
    must(options_parse(&parsed, n, words, &err), &err);
    must(maker->make(parsed.options, &parsed, &result, &err), &err);
    must(madetree_write(&parsed, &result, &err), &err);
    must(tree_read(&tree, path, &err), &err);
    must(tree_write_bytes(&tree, path, bytes, &err), &err);
    tree_release(&tree);
    madetree_release(&result);
    parsed_release(&parsed);
}

static void assert_written_alike(const Tree *tree, const char *path, const Text *expected)
{
    Text text = TEXT_INIT;
    Err err = {""};
    must(tree_write_bytes(tree, path, &text, &err), &err);
    assert_string_equal(text_chars(&text), text_chars(expected));
    text_release(&text);
}

static void a_tree_in_memory_is_that_of_the_command_line(void **state)
{
    (void)state;
    Text grown = TEXT_INIT, refined = TEXT_INIT;
    written("grow", "--terminals 12 --seed 4 -o T.swc", "T.swc", &grown);
    written("refine", "T.swc --refine geometry -o R.swc", "R.swc", &refined);
    MadeTree first = made(&growth, NULL, NULL, NULL);
    assert_written_alike(&first.tree, "T.swc", &grown);
    MadeTree second = made(&refinement, &first.tree, NULL, NULL);
    assert_written_alike(&second.tree, "R.swc", &refined);
    madetree_release(&second);
    second = made(&refinement, &first.tree, "folder/T.swc", NULL);
    assert_written_alike(&second.tree, "R.swc", &refined);
    assert_written_alike(&first.tree, "T.swc", &grown); /* only borrowed */
    assert_int_equal(json_integer_value(json_object_get(first.report, "terminals")), 12);
    assert_non_null(json_object_get(second.report, "moves_kept"));
    madetree_release(&first);
    madetree_release(&second);
    text_release(&grown);
    text_release(&refined);
}

static void growth_goes_on_from_a_tree_in_memory(void **state)
{
    (void)state;
    const Asked larger = {"grow", {"terminals", "20", NULL}};
    Text grown = TEXT_INIT, skipped = TEXT_INIT;
    written("grow", "--terminals 12 --seed 4 -o T.swc", "T.swc", &skipped);
    written("grow", "--from T.swc --terminals 20 -o G.swc", "G.swc", &grown);
    MadeTree first = made(&growth, NULL, NULL, NULL);
    MadeTree second = made(&larger, &first.tree, NULL, NULL);
    assert_written_alike(&second.tree, "G.swc", &grown);
    madetree_release(&first);
    madetree_release(&second);
    text_release(&grown);
    text_release(&skipped);
}

/* What a caller hears. */
typedef struct Heard {
    Text notes;
    int steps, questions;
    bool has_enough;
} Heard;

static void hear(void *user, TalkKind kind, const char *sentence)
{
    (void)kind;
    text_printf(&((Heard *)user)->notes, "%s\n", sentence);
}

static bool hear_progress(void *user, const char *what, double fraction)
{
    ((Heard *)user)->steps += what && fraction == 0;
    return true;
}

static bool answer(void *user)
{
    Heard *heard = user;
    heard->questions++;
    return heard->has_enough;
}

static void a_caller_hears_notes_and_may_have_enough(void **state)
{
    (void)state;
    Heard heard = {.notes = TEXT_INIT, .has_enough = true};
    const Talk talk = {hear, hear_progress, answer, &heard};
    const Asked both = {"grow", {"terminals", "12", "refine", "topology", "threads", "1", NULL}};
    MadeTree tree = made(&both, NULL, NULL, &talk);
    assert_non_null(strstr(text_chars(&heard.notes), "grew 12 terminals in "));
    assert_non_null(strstr(text_chars(&heard.notes), ", stopped: target "));
    assert_int_equal(heard.steps, 2);
    assert_true(heard.questions > 1);
    madetree_release(&tree);
    text_release(&heard.notes);
}

static void a_tree_in_memory_is_measured_and_certified(void **state)
{
    (void)state;
    MadeTree tree = made(&growth, NULL, NULL, NULL);
    Parsed parsed;
    InfoReport report;
    Certified found;
    Err err = {""};
    must(parsed_init(&parsed, &command_info, &err), &err);
    parsed_give(&parsed, &tree.tree, NULL);
    must(info_make(parsed.options, &parsed, &report, &err), &err);
    json_t *json = inforeport_json(&report);
    assert_int_equal(json_integer_value(json_object_get(json, "terminals")), 12);
    assert_string_equal(report.name, "the tree");
    json_decref(json);
    inforeport_release(&report);
    parsed_release(&parsed);
    must(parsed_init(&parsed, &command_certify, &err), &err);
    parsed_give(&parsed, &tree.tree, NULL);
    must(certify_make(parsed.options, &parsed, &found, &err), &err);
    json = certified_json(&found);
    assert_true(json_number_value(json_object_get(json, "gap")) >= 0);
    assert_true(found.bound.bound <= found.bound.target);
    json_decref(json);
    certified_release(&found);
    parsed_release(&parsed);
    madetree_release(&tree);
}

static void options_of_reading_are_refused_of_a_tree_in_memory(void **state)
{
    (void)state;
    MadeTree tree = made(&growth, NULL, NULL, NULL);
    Parsed parsed;
    Err err = {""};
    must(parsed_init(&parsed, &command_info, &err), &err);
    parsed_give(&parsed, &tree.tree, NULL);
    must(options_set(&parsed, "input-unit", "um", &err), &err);
    assert_int_equal(options_finish(&parsed, &err), STATUS_USAGE);
    assert_string_equal(err.text, "--input-unit is for a tree in a file");
    parsed_release(&parsed);
    madetree_release(&tree);
}

static char folder[] = "/tmp/tree_jobs_test.XXXXXX";

static int enter_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return remove("T.swc") || remove("R.swc") || remove("G.swc") || chdir("/") || rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tree_in_memory_is_that_of_the_command_line),
        cmocka_unit_test(growth_goes_on_from_a_tree_in_memory),
        cmocka_unit_test(a_caller_hears_notes_and_may_have_enough),
        cmocka_unit_test(a_tree_in_memory_is_measured_and_certified),
        cmocka_unit_test(options_of_reading_are_refused_of_a_tree_in_memory),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
