/* The operation `export`, called without the command line. */
#include "cli/commands.h"
#include "job/export/export.h"
#include "options/templates.h"
#include "scratch.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_WORDS = 24 };

/* The options of `export` for a tree of the tests. */
typedef struct Line {
    Parsed parsed;
    char words[512];
} Line;

static void parse(const char *options, Line *line)
{
    Err err = {{0}};
    char *argv[MOST_WORDS], *rest = NULL;
    int n = 0;
    snprintf(line->words, sizeof line->words, "tests/data/bifurcation.swc %s", options);
    for (char *word = strtok_r(line->words, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        argv[n++] = word;
    must(parsed_init(&line->parsed, command_find("export"), &err), &err);
    line->parsed.in_memory = true;
    must(options_parse(&line->parsed, n, argv, &err), &err);
}

static void expect_file(const char *path, const char *bytes, size_t n)
{
    static const FileForm form = {.name = "a result", .most_bytes = 1e8};
    char *found = NULL;
    size_t size;
    Err err = {{0}};
    must(file_read(path, &form, &found, &size, &err), &err);
    assert_int_equal(size, n);
    assert_memory_equal(found, bytes, n);
    free(found);
}

/* ---- results in memory ----------------------------------------------------------------------- */

static void test_a_mesh_in_memory_is_closed_and_knows_its_segments(void **state)
{
    (void)state;
    Line line;
    Err err = {{0}};
    MeshResult mesh;
    parse("--color-by radius", &line);
    must(mesh_make(line.parsed.options, &line.parsed, &mesh, &err), &err);
    assert_true(mesh.mesh.n_triangles > 100);
    assert_int_equal(mesh.report.open_edges, 0);
    for (size_t i = 0; i < mesh.mesh.n_triangles; i++)
        assert_true(mesh_segment(&mesh.mesh, i) < mesh.vessels.n_segments);
    assert_non_null(mesh.appearance.colors);
    assert_int_equal(mesh.ends.n, 0);
    meshing_release(&mesh);
    parsed_release(&line.parsed);
}

static void test_a_mesh_of_parts_names_its_ends(void **state)
{
    (void)state;
    Line line;
    Err err = {{0}};
    MeshResult mesh;
    parse("-o unused.vtp", &line);
    must(mesh_make(line.parsed.options, &line.parsed, &mesh, &err), &err);
    assert_true(mesh.ends.n >= 2);
    assert_string_equal(mesh.ends.ends[0].name, "inlet");
    meshing_release(&mesh);
    parsed_release(&line.parsed);
}

/* ---- files on a disk ------------------------------------------------------------------------- */

/* Writes the text to both files of a set that is open. */
static Status write_two(FileSet *files, const char *text, Err *err)
{
    text_puts(&files->at[0].text, text);
    text_puts(&files->at[1].text, text);
    return fileset_commit(files, err);
}

static void name_file(FileSet *files, size_t i, const char *name)
{
    Err err = {{0}};
    must(file_join(folder, name, &files->at[i].path, &err), &err);
}

/* The second cannot take its name, which a folder gets while the files are written. */
static void test_of_two_files_both_are_put_in_place_or_neither(void **state)
{
    (void)state;
    char first[64], second[64];
    snprintf(first, sizeof first, "%s/a", folder);
    snprintf(second, sizeof second, "%s/b", folder);
    for (int old = 0; old < 2; old++) {
        FileSet files = {0};
        Err err = {{0}};
        struct stat about;
        if (old)
            must(file_write(first, "old", 3, &err), &err);
        name_file(&files, 0, "a");
        name_file(&files, 1, "b");
        must(fileset_open(&files, &err), &err);
        must(file_make_folder(second, &err), &err);
        assert_int_equal(write_two(&files, "new", &err), STATUS_IO);
        assert_non_null(strstr(err.text, "/b"));
        fileset_release(&files);
        remove(second);
        if (old)
            expect_file(first, "old", 3);
        else
            assert_int_not_equal(stat(first, &about), 0);
    }
    remove(first);
}

static void test_an_unfinished_file_leaves_nothing(void **state)
{
    (void)state;
    FileSet files = {0};
    Err err = {{0}};
    name_file(&files, 0, "a");
    must(fileset_open(&files, &err), &err);
    fileset_release(&files);
}

static void test_a_full_disk_is_said_with_the_name_of_the_file(void **state)
{
    (void)state;
    FileSet files = {0};
    Err err = {{0}};
    name_file(&files, 0, "a");
    must(mem_strdup(&files.at[1].path, "/dev/full", &err), &err);
    must(fileset_open(&files, &err), &err);
    assert_int_equal(write_two(&files, "text", &err), STATUS_IO);
    assert_non_null(strstr(err.text, "/dev/full"));
    assert_non_null(strstr(err.text, "No space left on device"));
    fileset_release(&files);
}

static WorkCost cost_too_much(const void *job, const Talk *talk)
{
    (void)talk;
    return *(const WorkCost *)job;
}

static Status never_make(void *job, Progress *progress, Err *err)
{
    (void)job;
    (void)progress;
    (void)err;
    fail_msg("the work has begun");
    return STATUS_OK;
}

static void test_work_that_the_machine_cannot_hold_does_not_begin(void **state)
{
    (void)state;
    static const Work work = {"working", "the result", cost_too_much, never_make};
    WorkCost memory = {.memory = 1e30}, disk = {.disk = 1e30};
    FileSet files = {0};
    Err err = {{0}};
    name_file(&files, 0, "a");
    must(fileset_open(&files, &err), &err);
    assert_int_equal(work_make(&work, &memory, NULL, NULL, &err), STATUS_MEMORY);
    assert_non_null(strstr(err.text, "the result"));
    assert_int_equal(work_make(&work, &disk, &files, NULL, &err), STATUS_IO);
    assert_non_null(strstr(err.text, "disk"));
    fileset_release(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_mesh_in_memory_is_closed_and_knows_its_segments),
        cmocka_unit_test(test_a_mesh_of_parts_names_its_ends),
        cmocka_unit_test(test_of_two_files_both_are_put_in_place_or_neither),
        cmocka_unit_test(test_an_unfinished_file_leaves_nothing),
        cmocka_unit_test(test_a_full_disk_is_said_with_the_name_of_the_file),
        cmocka_unit_test(test_work_that_the_machine_cannot_hold_does_not_begin),
    };
    templates_set("templates");
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
