/* Reading pictures row by row. */
#include "image/image.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Err err;

static const ImageNote note_list[] = {
    {"Software", "corcast 0.1"}, {"Comment", "a command"}, {"Shard", "tile 2 of 3"}};
static const ImageNotes notes = {.notes = note_list, .count = 3, .dpi = 254};

static const struct {
    const char *path;
    int channels, bits;
} files[] = {{"build/rows.png", 3, 8},
             {"build/rows16.png", 3, 16},
             {"build/grey.png", 1, 8},
             {"build/rows.tif", 3, 8},
             {"build/rows16.tif", 1, 16}};
enum { FILES = sizeof files / sizeof *files, WIDTH = 23, HEIGHT = 57 };

static void make(Picture *picture, int channels, int bits)
{
    assert_int_equal(picture_init(picture, WIDTH, HEIGHT, channels, bits, &err), STATUS_OK);
    for (size_t i = 0; i < HEIGHT * picture_stride(picture); i++)
        picture_set(picture, i, (uint16_t)(i * i * 2385 % (bits == 8 ? 251 : 65521)));
}

static bool has_notes(const ImageReader *reader)
{
    for (int i = 0; i < notes.count; i++)
        if (!imagereader_note(reader, note_list[i].key))
            return false;
    return true;
}

/* Reads all rows of a file, `n` at a time; false, with a sentence that names it, when it is
 * refused, and without when it has lost a note, as a TIFF may whose last bytes they were. */
static bool read_rows(const char *path, int n, const Picture *expected)
{
    ImageReader *reader;
    if (imagereader_open(&reader, path, &err) != STATUS_OK)
        return false;
    const ImageForm *form = imagereader_form(reader);
    Picture rows;
    assert_int_equal(picture_init(&rows, form->width, HEIGHT, form->channels, form->bits, &err),
                     STATUS_OK);
    Status status = STATUS_OK;
    for (int y = 0; y < form->height && status == STATUS_OK; y += n) {
        Picture here = *expected;
        here.height = rows.height = n < form->height - y ? n : form->height - y;
        status = imagereader_codes(reader, &rows, &err);
        for (int row = 0; row < rows.height && status == STATUS_OK; row++)
            for (size_t i = 0; i < picture_stride(&rows); i++)
                assert_int_equal(
                    picture_code(&rows, (size_t)row * picture_stride(&rows) + i),
                    picture_code(&here, (size_t)(y + row) * picture_stride(&here) + i));
    }
    bool whole = status == STATUS_OK && has_notes(reader);
    picture_release(&rows);
    imagereader_close(reader);
    return whole;
}

static void write_file(int i, Picture *picture)
{
    make(picture, files[i].channels, files[i].bits);
    assert_int_equal(picture_write(picture, files[i].path, ENCODING_SRGB, &notes, NULL, &err),
                     STATUS_OK);
}

static void reads_a_few_rows_at_a_time_what_was_written(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++) {
        Picture picture;
        write_file(i, &picture);
        for (int n = 1; n <= HEIGHT; n += 7)
            assert_true(read_rows(files[i].path, n, &picture));
        picture_release(&picture);
        unlink(files[i].path);
    }
}

static void tells_notes_form_and_resolution(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++) {
        Picture picture;
        ImageReader *reader;
        write_file(i, &picture);
        picture_release(&picture);
        assert_int_equal(imagereader_open(&reader, files[i].path, &err), STATUS_OK);
        const ImageForm *form = imagereader_form(reader);
        assert_int_equal(form->width, WIDTH);
        assert_int_equal(form->height, HEIGHT);
        assert_int_equal(form->channels, files[i].channels);
        assert_int_equal(form->bits, files[i].bits);
        assert_float_equal(form->notes->dpi, 254, 1e-9);
        assert_string_equal(imagereader_note(reader, "Software"), "corcast 0.1");
        assert_string_equal(imagereader_note(reader, "Shard"), "tile 2 of 3");
        assert_non_null(imagereader_note(reader, "Comment"));
        assert_null(imagereader_note(reader, "Colors"));
        imagereader_close(reader);
        unlink(files[i].path);
    }
}

static void knows_files_that_are_cut_off(void **state)
{
    (void)state;
    static const FileForm any = {.name = "a file", .most_bytes = 1e6};
    for (int i = 0; i < FILES; i++) {
        Picture picture;
        char *bytes;
        size_t size;
        write_file(i, &picture);
        assert_int_equal(file_read(files[i].path, &any, &bytes, &size, &err), STATUS_OK);
        for (size_t length = 0; length < size; length += 1 + length / 9) {
            assert_int_equal(file_write(files[i].path, bytes, length, &err), STATUS_OK);
            err.text[0] = '\0';
            assert_false(read_rows(files[i].path, 8, &picture));
            assert_true(!err.text[0] || strstr(err.text, files[i].path));
        }
        free(bytes);
        picture_release(&picture);
        unlink(files[i].path);
    }
}

static void refuses_what_is_no_picture(void **state)
{
    (void)state;
    ImageReader *reader;
    assert_int_equal(imagereader_open(&reader, "build/nothing.png", &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "build/nothing.png"));
    assert_int_equal(file_write("build/text.png", "P6 1 1 255\nabc", 14, &err), STATUS_OK);
    assert_int_equal(imagereader_open(&reader, "build/text.png", &err), STATUS_INPUT);
    assert_non_null(
        strstr(err.text, "build/text.png: is not a picture that can be read row by row"));
    unlink("build/text.png");
    assert_int_equal(imagereader_open(&reader, "build", &err), STATUS_INPUT);
}

int main(void)
{
    if (file_make_folder("build", &err) != STATUS_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_few_rows_at_a_time_what_was_written),
        cmocka_unit_test(tells_notes_form_and_resolution),
        cmocka_unit_test(knows_files_that_are_cut_off),
        cmocka_unit_test(refuses_what_is_no_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
