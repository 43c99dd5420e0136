/* When corcast ends a POV-Ray that has finished its picture. This program stands in for POV-Ray
 * when it is called under that name. */
#include "oracle/povray.h"

#include "unit.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Draws a picture of 2 x 2 pixels, says so, and fails after `seconds`. */
static int draw_and_fail(int argc, char **argv, unsigned seconds)
{
    static const char begin[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x02\0\0\0\x02\x08\x02";
    static const char end[] = "\0\0\0\0IEND\xae\x42\x60\x82";
    for (int i = 1; i < argc; i++) {
        FILE *file = strncmp(argv[i], "+O", 2) == 0 ? fopen(argv[i] + 2, "wb") : NULL;
        if (!file)
            continue;
        fwrite(begin, sizeof begin - 1, 1, file);
        fwrite(end, sizeof end - 1, 1, file);
        fclose(file);
    }
    fputs("  Trace Time:       0 hours  0 minutes  0 seconds (0.003 seconds)\n", stderr);
    sleep(seconds);
    return 7;
}

/* Copies this program to "folder/name". */
static void copy_self(const char *folder, const char *name, char *path, size_t size)
{
    char block[1 << 16];
    snprintf(path, size, "%s/%s", folder, name);
    FILE *from = fopen("/proc/self/exe", "rb"), *to = fopen(path, "wb");
    assert_non_null(from);
    assert_non_null(to);
    for (size_t n; (n = fread(block, 1, sizeof block, from)) > 0;)
        assert_int_equal(fwrite(block, 1, n, to), n);
    fclose(from);
    assert_int_equal(fclose(to), 0);
    assert_int_equal(chmod(path, 0700), 0);
}

/* What a program of that name comes to that has drawn the picture and would fail a little later. */
static Status run_as(const char *name, Err *err)
{
    char folder[] = "/tmp/oracle_test.XXXXXX", program[80], scene[80], output[80];
    assert_non_null(mkdtemp(folder));
    copy_self(folder, name, program, sizeof program);
    snprintf(scene, sizeof scene, "%s/scene.pov", folder);
    snprintf(output, sizeof output, "%s/picture.png", folder);
    FILE *file = fopen(scene, "w");
    assert_non_null(file);
    fclose(file);
    const PovrayParams params = {.program = {.path = program},
                                 .scene = scene,
                                 .output = output,
                                 .width = 2,
                                 .height = 2,
                                 .bits = 8};
    Status status = povray_draw(&params, NULL, err);
    unlink(program);
    unlink(scene);
    unlink(output);
    rmdir(folder);
    return status;
}

static void povray_is_ended_when_it_has_its_picture(void **state)
{
    (void)state;
    Err err;
    assert_int_equal(run_as("povray", &err), STATUS_OK);
}

static void a_program_that_stands_for_it_is_waited_for(void **state)
{
    (void)state;
    Err err;
    assert_int_equal(run_as("script", &err), STATUS_TOOL);
    assert_non_null(strstr(err.text, "exit status 7"));
}

int main(int argc, char **argv)
{
    if (argc > 1 && strncmp(argv[1], "+I", 2) == 0)
        return draw_and_fail(argc, argv, strstr(argv[0], "povray") ? 60 : 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(povray_is_ended_when_it_has_its_picture),
        cmocka_unit_test(a_program_that_stands_for_it_is_waited_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
