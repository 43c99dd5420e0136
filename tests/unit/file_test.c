/* Files: complete or not written at all, permissions, links. */
#include "any_file.h"
#include "base/base.h"
#include "cli/interrupt.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Each test runs in one empty folder, which must be empty again afterwards. */

static char folder[] = "/tmp/corcast-file-XXXXXX";

static int enter_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return chdir("/") == 0 ? rmdir(folder) : -1;
}

static void write_file(const char *path, const char *text)
{
    Err err = {{0}};
    must(file_write(path, text, strlen(text), &err), &err);
}

static void expect_text(const char *path, const char *text)
{
    char *bytes = NULL;
    size_t size;
    assert_int_equal(file_read(path, &any_file, &bytes, &size, NULL), STATUS_OK);
    assert_string_equal(bytes, text);
    free(bytes);
}

static void what_is_written_over_keeps_its_permissions_and_owner(void **state)
{
    (void)state;
    struct stat about;
    write_file("tree.swc", "old");
    chmod("tree.swc", 0640);
    bool root = geteuid() == 0;
    if (root)
        assert_int_equal(chown("tree.swc", 12385, 12386), 0);
    write_file("tree.swc", "new");
    expect_text("tree.swc", "new");
    assert_int_equal(stat("tree.swc", &about), 0);
    assert_int_equal(about.st_mode & 07777, 0640);
    assert_int_equal(about.st_uid, root ? 12385 : geteuid());
    assert_int_equal(about.st_gid, root ? 12386 : getegid());
    unlink("tree.swc");
}

static void a_link_stays_and_its_target_is_written(void **state)
{
    (void)state;
    struct stat about;
    static const char *const targets[] = {"there.swc", "not-yet.swc"};
    write_file("there.swc", "old");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(symlink(targets[i], "first"), 0);
        assert_int_equal(symlink("first", "second"), 0);
        write_file("second", "new");
        expect_text(targets[i], "new");
        assert_int_equal(lstat("second", &about), 0);
        assert_true(S_ISLNK(about.st_mode));
        unlink("first");
        unlink("second");
        unlink(targets[i]);
    }
}

static void a_link_that_leads_to_itself_is_refused(void **state)
{
    (void)state;
    Err err;
    assert_int_equal(symlink("b", "a"), 0);
    assert_int_equal(symlink("a", "b"), 0);
    assert_int_equal(file_write("a", "x", 1, &err), STATUS_IO);
    assert_non_null(strstr(err.text, "a: cannot be written: Too many levels"));
    assert_int_equal(outfile_check("b", NULL), STATUS_IO);
    unlink("a");
    unlink("b");
}

static void another_hard_link_keeps_what_it_holds(void **state)
{
    (void)state;
    write_file("tree.swc", "old");
    assert_int_equal(link("tree.swc", "copy.swc"), 0);
    write_file("tree.swc", "new");
    expect_text("tree.swc", "new");
    expect_text("copy.swc", "old");
    unlink("tree.swc");
    unlink("copy.swc");
}

static void a_name_may_be_as_long_as_the_system_allows(void **state)
{
    (void)state;
    char name[NAME_MAX + 2];
    Err err;
    memset(name, 'n', sizeof name);
    name[NAME_MAX] = '\0';
    write_file(name, "x");
    unlink(name);
    name[NAME_MAX] = 'n';
    name[NAME_MAX + 1] = '\0';
    assert_int_equal(outfile_check(name, &err), STATUS_IO);
    assert_non_null(strstr(err.text, "too long"));
}

static void a_check_finds_what_opening_would(void **state)
{
    (void)state;
    static const char *const wrong[] = {"no/tree.swc", "folder", "folder/", "file/tree.swc"};
    Err err;
    mkdir("folder", 0755);
    write_file("file", "x");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(outfile_check(wrong[i], &err), STATUS_IO);
        assert_non_null(strstr(err.text, wrong[i]));
        assert_int_equal(file_write(wrong[i], "x", 1, NULL), STATUS_IO);
    }
    static const char *const right[] = {"-", "file", "new", "folder/new", "/dev/null"};
    for (size_t i = 0; i < sizeof right / sizeof *right; i++)
        assert_int_equal(outfile_check(right[i], &err), STATUS_OK);
    assert_int_equal(access("new", F_OK), -1);
    unlink("file");
    rmdir("folder");
}

static void only_regular_files_are_regular(void **state)
{
    (void)state;
    Err err;
    mkfifo("pipe", 0600);
    write_file("file", "x");
    assert_int_equal(file_check_regular("file", &err), STATUS_OK);
    assert_int_equal(file_check_regular("pipe", &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "pipe: is a pipe or a device"));
    assert_int_equal(file_check_regular(".", &err), STATUS_INPUT);
    assert_int_equal(file_check_regular("/dev/zero", &err), STATUS_INPUT);
    assert_int_equal(file_check_regular("missing", &err), STATUS_INPUT);
    unlink("pipe");
    unlink("file");
}

/* Opens temporaries in a child that `signal_number` then reaches; how the child ended. With
 * `ignored`, the child was started with the signal ignored and commits its file. */
static int signal_child(int signal_number, bool ignored)
{
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        const struct rlimit none = {0, 0};
        setrlimit(RLIMIT_CORE, &none);
        signal(signal_number,
               ignored ? SIG_IGN : SIG_DFL); /* whatever the caller of this test does */
        OutFile file;
        char *place = NULL;
        file_clean_up_on_signals();
        interrupt_catch();
        interrupt_release();
        if (outfile_open(&file, "half.swc", NULL) != STATUS_OK ||
            file_temporary_folder("half.png", &place, NULL) != STATUS_OK)
            _exit(9);
        raise(signal_number);
        file_discard_temporary(place);
        _exit(outfile_commit(&file, NULL) == STATUS_OK ? 7 : 8);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    return ended;
}

static void signals_leave_no_temporary_and_ignored_ones_stay_ignored(void **state)
{
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGXFSZ};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        int ended = signal_child(signals[i], false);
        assert_true(WIFSIGNALED(ended) && WTERMSIG(ended) == signals[i]);
        ended = signal_child(signals[i], true);
        assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 7);
        assert_int_equal(unlink("half.swc"), 0);
    }
}

/* Text from outside. */

static void a_line_is_utf8_without_control_characters(void **state)
{
    (void)state;
    static const struct {
        const char *from, *line;
    } cases[] = {
        {"tree of Jos\xc3\xa9 \xf0\x9f\x8c\xb3.swc", "tree of Jos\xc3\xa9 \xf0\x9f\x8c\xb3.swc"},
        {"a\nb\rc\td\x7f\x1b[31m", "a b c d  [31m"},
        {"\xff\xc3", "\xef\xbf\xbd\xef\xbf\xbd"},
        {"\xc0\xaf", "\xef\xbf\xbd\xef\xbf\xbd"},                 /* overlong */
        {"\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}, /* a surrogate */
        {"\xef\xbf\xbf", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"},
        {"\xc2\x85;\xe2\x82\xac", " ;\xe2\x82\xac"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Text text = TEXT_INIT;
        text_put_line(&text, cases[i].from);
        assert_string_equal(text.chars, cases[i].line);
        text_release(&text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_over_keeps_its_permissions_and_owner),
        cmocka_unit_test(a_link_stays_and_its_target_is_written),
        cmocka_unit_test(a_link_that_leads_to_itself_is_refused),
        cmocka_unit_test(another_hard_link_keeps_what_it_holds),
        cmocka_unit_test(a_name_may_be_as_long_as_the_system_allows),
        cmocka_unit_test(a_check_finds_what_opening_would),
        cmocka_unit_test(only_regular_files_are_regular),
        cmocka_unit_test(signals_leave_no_temporary_and_ignored_ones_stay_ignored),
        cmocka_unit_test(a_line_is_utf8_without_control_characters),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
