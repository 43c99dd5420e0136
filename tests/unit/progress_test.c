#include "app/run/progress.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

#include <cmocka.h>

/* What is said in a log at 30 % of something that began so many seconds ago. */
static void said_in_a_log(double seconds_ago, double since_last_s, bool quiet, char out[80])
{
    Progress progress;
    FILE *log = tmpfile();
    int kept = dup(STDERR_FILENO);
    assert_non_null(log);
    dup2(fileno(log), STDERR_FILENO);
    progress_start(&progress, "growing", quiet);
    progress.start_s -= seconds_ago;
    progress.last_s -= since_last_s;
    progress_show(&progress, 0.3);
    progress_show(&progress, 0.31);
    progress_end(&progress);
    dup2(kept, STDERR_FILENO);
    close(kept);
    rewind(log);
    out[fread(out, 1, 79, log)] = '\0';
    fclose(log);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_log_gets_a_line_of_progress_every_ten_seconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
