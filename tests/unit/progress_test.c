/* Progress messages on standard error. */
#include "cli/screen.h"
#include "unit.h"

#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

/* Begins to collect standard error in *log; returns the descriptor that collect_end restores. */
static int collect_begin(FILE **log)
{
    int kept = dup(STDERR_FILENO);
    *log = tmpfile();
    assert_non_null(*log);
    dup2(fileno(*log), STDERR_FILENO);
    return kept;
}

static void collect_end(FILE *log, int kept, char out[80])
{
    dup2(kept, STDERR_FILENO);
    close(kept);
    rewind(log);
    out[fread(out, 1, 79, log)] = '\0';
    fclose(log);
}

static void told(bool quiet, bool failed, char out[80])
{
    Screen screen;
    Talk talk = screen_talk(&screen, quiet);
    FILE *log;
    int kept = collect_begin(&log);
    talk_note(&talk, "%d segments", 2);
    talk_warn(&talk, "no %s", "room");
    (failed ? screen_drop_held : screen_print_held)(&screen);
    screen_print_held(&screen);
    collect_end(log, kept, out);
}

/* What is said in a log of something that began so many seconds ago. */
static void said_at(double fraction, double seconds_ago, double since_last_s, bool quiet,
                    char out[80])
{
    Screen screen;
    Talk talk = screen_talk(&screen, quiet);
    Progress progress;
    FILE *log;
    int kept = collect_begin(&log);
    progress_start(&progress, "growing", &talk);
    screen.start_s -= seconds_ago;
    screen.last_s -= since_last_s;
    progress_show(&progress, fraction);
    progress_show(&progress, fraction + 0.01);
    progress_end(&progress);
    collect_end(log, kept, out);
}

static void said_in_a_log(double seconds_ago, double since_last_s, bool quiet, char out[80])
{
    said_at(0.3, seconds_ago, since_last_s, quiet, out);
}

static void a_log_gets_a_line_of_progress_every_ten_seconds(void **state)
{
    (void)state;
    char said[80];
    said_in_a_log(0, 0, false, said);
    assert_string_equal(said, "");
    said_in_a_log(9.5, 9.5, false, said);
    assert_string_equal(said, "");
    said_in_a_log(12, 10.5, false, said);
    assert_string_equal(said, "growing: 30 %, 28 s left\n");
    said_in_a_log(600, 10.5, false, said);
    assert_string_equal(said, "growing: 30 %, 23 min left\n");
    said_in_a_log(36000, 10.5, false, said);
    assert_string_equal(said, "growing: 30 %, 23 h left\n");
    said_in_a_log(600, 10.5, true, said);
    assert_string_equal(said, "");
}

static void a_note_is_said_unless_quiet_and_a_warning_always(void **state)
{
    (void)state;
    char said[80];
    told(false, false, said);
    assert_string_equal(said, "corcast: 2 segments\ncorcast: no room\n");
    told(true, false, said);
    assert_string_equal(said, "corcast: no room\n");
}

static void a_command_that_fails_prints_no_sentence(void **state)
{
    (void)state;
    char said[80];
    told(false, true, said);
    assert_string_equal(said, "");
}

static void sentences_are_printed_before_progress_is(void **state)
{
    (void)state;
    char said[80];
    Screen screen;
    Talk talk = screen_talk(&screen, false);
    Progress progress;
    FILE *log;
    int kept = collect_begin(&log);
    talk_note(&talk, "%d segments", 2);
    progress_start(&progress, "growing", &talk);
    screen.start_s -= 12;
    screen.last_s -= 12;
    progress_show(&progress, 0.3);
    screen_drop_held(&screen);
    collect_end(log, kept, said);
    assert_string_equal(said, "corcast: 2 segments\ngrowing: 30 %, 28 s left\n");
}

static void work_of_days_says_so_after_ten_seconds(void **state)
{
    (void)state;
    char said[80];
    said_at(0.0001, 12, 10.5, false, said);
    assert_string_equal(said, "growing: 0 %, 33 h left\n");
    said_at(0, 12, 10.5, false, said);
    assert_string_equal(said, "growing: 0 %\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_log_gets_a_line_of_progress_every_ten_seconds),
        cmocka_unit_test(a_note_is_said_unless_quiet_and_a_warning_always),
        cmocka_unit_test(a_command_that_fails_prints_no_sentence),
        cmocka_unit_test(sentences_are_printed_before_progress_is),
        cmocka_unit_test(work_of_days_says_so_after_ten_seconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
