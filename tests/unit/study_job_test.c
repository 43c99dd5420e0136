/* The operation `study`, called without the command line. */
#include "study/study.h"

#include "unit.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/study_job_test.XXXXXX";
static char plan[64], output[64];

static int make_plan(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(plan, sizeof plan, "%s/plan.ini", folder);
    snprintf(output, sizeof output, "%s/runs", folder);
    FILE *file = fopen(plan, "w");
    if (!file)
        return -1;
    fputs("[grow]\nseed = 1..4\nterminals = 5\n", file);
    return fclose(file);
}

static size_t remove_runs(void)
{
    size_t n = 0;
    DIR *entries = opendir(output);
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", output, entry->d_name);
        n += unlink(path) == 0;
    }
    if (entries)
        closedir(entries);
    rmdir(output);
    return n;
}

static int remove_plan(void **state)
{
    (void)state;
    remove_runs();
    return unlink(plan) || rmdir(folder);
}

static Status run(StudyOptions options, const Talk *talk, Text *lines, Err *err)
{
    Parsed parsed;
    TRY(parsed_init(&parsed, &command_study, err));
    parsed.common.talk = talk;
    parsed.common.threads = 1;
    parsed.operands[parsed.n_operands++] = plan;
    options.output = output;
    Status status = study_run(&options, &parsed, lines, err);
    parsed_release(&parsed);
    return status;
}

static void commands_go_into_a_text(void **state)
{
    (void)state;
    Err err;
    Text lines = TEXT_INIT;
    assert_int_equal(run((StudyOptions){.commands = true}, NULL, &lines, &err), STATUS_OK);
    assert_non_null(strstr(text_chars(&lines), " --only 4\n"));
    assert_null(strstr(text_chars(&lines), " --only 5\n"));
    text_release(&lines);
    assert_int_equal(remove_runs(), 0);
}

static void all_runs_and_two_tables_are_written(void **state)
{
    (void)state;
    Err err;
    Text lines = TEXT_INIT;
    assert_int_equal(run((StudyOptions){0}, NULL, &lines, &err), STATUS_OK);
    assert_int_equal(lines.length, 0);
    assert_int_equal(remove_runs(), 6);
}

/* Stops after the first run: the step begins with the fraction 0. */
static bool stop_early(void *user, const char *what, double fraction)
{
    (void)user;
    return !what || fraction < 0.25;
}

static void a_study_is_stopped_by_its_caller(void **state)
{
    (void)state;
    Err err;
    Text lines = TEXT_INIT;
    const Talk talk = {.progress = stop_early};
    assert_int_equal(run((StudyOptions){0}, &talk, &lines, &err), STATUS_CANCELLED);
    assert_int_equal(remove_runs(), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_go_into_a_text),
        cmocka_unit_test(all_runs_and_two_tables_are_written),
        cmocka_unit_test(a_study_is_stopped_by_its_caller),
    };
    return cmocka_run_group_tests(tests, make_plan, remove_plan);
}
