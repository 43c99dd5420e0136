/* The operations `scene` and `export`, called without the command line. */
#include "cli/commands.h"
#include "job/export/export.h"
#include "job/export/scene.h"
#include "options/templates.h"
#include "scratch.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_WORDS = 24, MOST_TAKEN = 8 };

/* The options of a command for a tree of the tests. */
typedef struct Line {
    Parsed parsed;
    char words[512];
} Line;

static void parse(const char *command, const char *options, Line *line)
{
    Err err = {{0}};
    char *argv[MOST_WORDS], *rest = NULL;
    int n = 0;
    snprintf(line->words, sizeof line->words, "tests/data/bifurcation.swc %s", options);
    for (char *word = strtok_r(line->words, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        argv[n++] = word;
    must(parsed_init(&line->parsed, command_find(command), &err), &err);
    line->parsed.in_memory = true;
    must(options_parse(&line->parsed, n, argv, &err), &err);
}

/* ---- files that a program takes -------------------------------------------------------------- */

/* What a FileTaker has received. */
typedef struct Taken {
    char names[MOST_TAKEN][128];
    char *bytes[MOST_TAKEN];
    size_t sizes[MOST_TAKEN];
    size_t n, most; /* the file after the first `most` is refused */
} Taken;

static bool take(void *user, const char *name, const void *bytes, size_t size)
{
    Taken *taken = user;
    if (taken->n >= taken->most)
        return false;
    assert_true(strlen(name) < sizeof taken->names[0]);
    strcpy(taken->names[taken->n], name);
    assert_non_null(taken->bytes[taken->n] = malloc(size + 1));
    memcpy(taken->bytes[taken->n], bytes, size);
    taken->sizes[taken->n++] = size;
    return true;
}

static void release_taken(Taken *taken)
{
    for (size_t i = 0; i < taken->n; i++)
        free(taken->bytes[i]);
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

static Status write_scene(Line *line, const FileTaker *taker, Err *err)
{
    SceneResult scene;
    TRY(scene_make(line->parsed.options, &line->parsed, taker, &scene, err));
    Status status = scene_write(line->parsed.options, &line->parsed, &scene, err);
    sceneresult_release(&scene);
    return status;
}

static Status write_to(const char *command, Line *line, const FileTaker *taker, Err *err)
{
    return strcmp(command, "scene") == 0
               ? write_scene(line, taker, err)
               : export_write(line->parsed.options, &line->parsed, taker, err);
}

static void test_a_program_takes_the_bytes_of_the_files(void **state)
{
    (void)state;
    static const struct {
        const char *command, *options, *name;
        size_t n; /* files */
    } cases[] = {
        {"export", "--parts", "t.stl", 5},
        {"export", "--color-by radius", "t.obj", 3},
        {"export", "--lattice", "t.3mf", 1},
        {"export", "", "t.usda", 1},
        {"export", "--spacing 2 --labels segment", "t.nii.gz", 4},
        {"export", "--spacing 2", "t.df3", 4},
        {"scene", "--ini on", "t.pov", 3},
        {"scene", "--scad polyhedron", "t.scad", 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Line line;
        Err err = {{0}};
        char options[256];
        struct stat about;
        Taken taken = {.most = MOST_TAKEN};
        const FileTaker taker = {take, &taken};
        snprintf(options, sizeof options, "%s -o %s/%s", cases[i].options, folder, cases[i].name);
        parse(cases[i].command, options, &line);
        must(write_to(cases[i].command, &line, &taker, &err), &err);
        assert_int_equal(taken.n, cases[i].n);
        for (size_t k = 0; k < taken.n; k++)
            assert_int_not_equal(stat(taken.names[k], &about), 0);
        must(write_to(cases[i].command, &line, NULL, &err), &err);
        for (size_t k = 0; k < taken.n; k++) {
            expect_file(taken.names[k], taken.bytes[k], taken.sizes[k]);
            remove(taken.names[k]);
        }
        release_taken(&taken);
        parsed_release(&line.parsed);
    }
}

static void test_a_program_that_refuses_a_file_ends_the_operation(void **state)
{
    (void)state;
    static const char *const names[] = {"/t.ply", "/t.mha"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        Line line;
        Err err = {{0}};
        char options[256];
        Taken taken = {.most = 1};
        const FileTaker taker = {take, &taken};
        snprintf(options, sizeof options, "-o %s%s", folder, names[i]);
        parse("export", options, &line);
        assert_int_equal(export_write(line.parsed.options, &line.parsed, &taker, &err), STATUS_IO);
        assert_non_null(strstr(err.text, "refused by the caller"));
        assert_int_equal(taken.n, 1);
        release_taken(&taken);
        parsed_release(&line.parsed);
    }
}

/* ---- results in memory ----------------------------------------------------------------------- */

static void test_a_mesh_in_memory_is_closed_and_knows_its_segments(void **state)
{
    (void)state;
    Line line;
    Err err = {{0}};
    MeshResult mesh;
    parse("export", "--color-by radius", &line);
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
    parse("export", "-o unused.vtp", &line);
    must(mesh_make(line.parsed.options, &line.parsed, &mesh, &err), &err);
    assert_true(mesh.ends.n >= 2);
    assert_string_equal(mesh.ends.ends[0].name, "inlet");
    meshing_release(&mesh);
    parsed_release(&line.parsed);
}

static void test_a_scene_in_memory_shows_all_segments(void **state)
{
    (void)state;
    Line line;
    Err err = {{0}};
    SceneResult scene;
    parse("scene", "--model isosurface", &line);
    must(scene_make(line.parsed.options, &line.parsed, NULL, &scene, &err), &err);
    size_t segments = 0;
    for (size_t i = 0; i < scene.source.of.tree.n; i++)
        segments += tree_is_segment(&scene.source.of.tree, i);
    assert_int_equal(scene.scene.geometry.drawn, segments);
    assert_string_equal(scene.emitter->name, "povray");
    assert_null(scene.files.at[0].path);
    sceneresult_release(&scene);
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
        cmocka_unit_test(test_a_program_takes_the_bytes_of_the_files),
        cmocka_unit_test(test_a_program_that_refuses_a_file_ends_the_operation),
        cmocka_unit_test(test_a_mesh_in_memory_is_closed_and_knows_its_segments),
        cmocka_unit_test(test_a_mesh_of_parts_names_its_ends),
        cmocka_unit_test(test_a_scene_in_memory_shows_all_segments),
        cmocka_unit_test(test_of_two_files_both_are_put_in_place_or_neither),
        cmocka_unit_test(test_an_unfinished_file_leaves_nothing),
        cmocka_unit_test(test_a_full_disk_is_said_with_the_name_of_the_file),
        cmocka_unit_test(test_work_that_the_machine_cannot_hold_does_not_begin),
    };
    templates_set("templates");
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
