#include "any_file.h"
#include "image/image.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static Err err;

static void make(Picture *picture, int width, int height, int channels, int bits)
{
    assert_int_equal(picture_init(picture, width, height, channels, bits, &err), STATUS_OK);
    size_t n = (size_t)height * picture_stride(picture);
    for (size_t i = 0; i < n; i++)
        picture_set(picture, i, (uint16_t)(i * i * 2385 % (bits == 8 ? 251 : 65521)));
}

/* Rows first .. first + n - 1, borrowed. */
static Picture rows_of(const Picture *picture, int first, int n)
{
    Picture rows = *picture;
    size_t start = (size_t)first * picture_stride(picture);
    rows.height = n;
    if (rows.bits == 8)
        rows.codes8 += start;
    else
        rows.codes16 += start;
    return rows;
}

static const ImageNote note = {"Software", "corcast 0.1"};
static const ImageNotes notes = {&note, 1, 0};

static ImageForm form_of(const Picture *picture)
{
    return (ImageForm){picture->width, picture->height, picture->channels,
                       picture->bits,  ENCODING_SRGB,   &notes};
}

static void write_in_parts(const Picture *picture, const char *path)
{
    const ImageForm form = form_of(picture);
    ImageWriter *writer;
    assert_int_equal(imagewriter_open(&writer, path, &form, &err), STATUS_OK);
    for (int first = 0, n = 1; first < picture->height; first += n, n = 1 + n * 2 % 5) {
        if (n > picture->height - first)
            n = picture->height - first;
        const Picture rows = rows_of(picture, first, n);
        assert_int_equal(imagewriter_codes(writer, &rows, &err), STATUS_OK);
        assert_int_not_equal(access(path, F_OK), 0);
    }
    assert_int_equal(imagewriter_commit(writer, &err), STATUS_OK);
}

static void assert_same_files(const char *a, const char *b)
{
    char *bytes_a, *bytes_b;
    size_t size_a, size_b;
    assert_int_equal(file_read(a, &any_file, &bytes_a, &size_a, &err), STATUS_OK);
    assert_int_equal(file_read(b, &any_file, &bytes_b, &size_b, &err), STATUS_OK);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(bytes_a, bytes_b, size_a);
    free(bytes_a);
    free(bytes_b);
}

static void writes_in_parts_the_bytes_of_the_whole(void **state)
{
    (void)state;
    static const struct {
        const char *whole, *parts;
        int width, height, channels, bits;
    } cases[] = {
        {"build/whole.ppm", "build/parts.ppm", 31, 17, 3, 8},
        {"build/whole.ppm", "build/parts.ppm", 5, 23, 1, 16},
        {"build/whole.pgm", "build/parts.pgm", 19, 11, 1, 16},
        {"build/whole.png", "build/parts.png", 31, 17, 3, 16},
        {"build/whole.png", "build/parts.png", 131, 57, 1, 8},
        {"build/whole.tif", "build/parts.tif", 97, 71, 3, 8},
        {"build/whole.tiff", "build/parts.tiff", 29001, 13, 3, 16}, /* more than a strip */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Picture picture, read;
        make(&picture, cases[i].width, cases[i].height, cases[i].channels, cases[i].bits);
        unlink(cases[i].parts);
        assert_int_equal(picture_write(&picture, cases[i].whole, ENCODING_SRGB, &notes, &err),
                         STATUS_OK);
        write_in_parts(&picture, cases[i].parts);
        assert_same_files(cases[i].whole, cases[i].parts);
        assert_int_equal(picture_read(&read, cases[i].parts, &err), STATUS_OK);
        assert_int_equal(read.bits, cases[i].bits);
        for (size_t k = 0; k < (size_t)read.height * picture_stride(&read); k++)
            assert_int_equal(picture_code(&read, k),
                             picture_code(&picture, read.channels == picture.channels ? k : k / 3));
        unlink(cases[i].whole);
        unlink(cases[i].parts);
        picture_release(&picture);
        picture_release(&read);
    }
}

static void writes_a_pfm_from_the_bottom_up_though_rows_come_from_the_top(void **state)
{
    (void)state;
    Plane plane, rows;
    assert_int_equal(plane_init(&plane, 13, 9, 3, &err), STATUS_OK);
    for (int i = 0; i < 13 * 9 * 3; i++)
        plane.values[i] = i % 7 ? (float)i * 0.2385f : INFINITY;
    assert_int_equal(plane_write(&plane, "build/whole.pfm", &err), STATUS_OK);
    const ImageForm form = {13, 9, 3, 32, ENCODING_LINEAR, NULL};
    ImageWriter *writer;
    assert_int_equal(imagewriter_open(&writer, "build/parts.pfm", &form, &err), STATUS_OK);
    for (int first = 0; first < 9; first += 4) {
        rows = plane;
        rows.values += first * 13 * 3;
        rows.height = first < 8 ? 4 : 1;
        assert_int_equal(imagewriter_floats(writer, &rows, &err), STATUS_OK);
    }
    assert_int_equal(imagewriter_commit(writer, &err), STATUS_OK);
    assert_same_files("build/whole.pfm", "build/parts.pfm");
    unlink("build/whole.pfm");
    unlink("build/parts.pfm");
    plane_release(&plane);
}

static void leaves_nothing_of_what_is_given_up(void **state)
{
    (void)state;
    static const char *const paths[] = {"build/given_up.ppm", "build/given_up.png",
                                        "build/given_up.tif"};
    Picture picture;
    make(&picture, 31, 17, 3, 8);
    const ImageForm form = form_of(&picture);
    const Picture rows = rows_of(&picture, 0, 9);
    for (size_t i = 0; i < 3; i++) {
        ImageWriter *writer;
        assert_int_equal(imagewriter_open(&writer, paths[i], &form, &err), STATUS_OK);
        assert_int_equal(imagewriter_codes(writer, &rows, &err), STATUS_OK);
        imagewriter_discard(writer);
        assert_int_not_equal(access(paths[i], F_OK), 0);
    }
    picture_release(&picture);
}

static void refuses_what_the_disk_has_no_room_for(void **state)
{
    (void)state;
    const ImageForm form = {IMAGE_MAX_SIDE, IMAGE_MAX_SIDE, 3, 16, ENCODING_SRGB, NULL};
    ImageWriter *writer;
    assert_int_equal(imagewriter_open(&writer, "build/vast.ppm", &form, &err), STATUS_IO);
    assert_non_null(strstr(err.text, "build/vast.ppm: needs 6.6 TB, and its disk has "));
    assert_int_not_equal(access("build/vast.ppm", F_OK), 0);
}

/* Where places cannot be gone back to. */
static void refuses_a_pipe_for_what_is_written_out_of_order(void **state)
{
    (void)state;
    static const char *const paths[] = {"build/pipe.tif", "build/pipe.pfm"};
    for (int i = 0; i < 2; i++) {
        int ends[2];
        char target[64];
        assert_int_equal(pipe(ends), 0);
        snprintf(target, sizeof target, "/dev/fd/%d", ends[1]);
        unlink(paths[i]);
        assert_int_equal(symlink(target, paths[i]), 0);
        const ImageForm form = {3, 4, 3, i ? 32 : 8, ENCODING_SRGB, NULL};
        ImageWriter *writer;
        Status status = imagewriter_open(&writer, paths[i], &form, &err);
        if (i) {
            assert_int_equal(status, STATUS_OK);
            float values[2 * 3 * 3] = {0};
            const Plane rows = {3, 2, 3, values};
            status = imagewriter_floats(writer, &rows, &err);
            imagewriter_discard(writer);
        }
        assert_int_equal(status, STATUS_IO);
        assert_non_null(strstr(err.text, "a file, not a pipe"));
        unlink(paths[i]);
        close(ends[0]);
        close(ends[1]);
    }
}

int main(void)
{
    if (file_make_folder("build", &err) != STATUS_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_in_parts_the_bytes_of_the_whole),
        cmocka_unit_test(writes_a_pfm_from_the_bottom_up_though_rows_come_from_the_top),
        cmocka_unit_test(leaves_nothing_of_what_is_given_up),
        cmocka_unit_test(refuses_what_the_disk_has_no_room_for),
        cmocka_unit_test(refuses_a_pipe_for_what_is_written_out_of_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
