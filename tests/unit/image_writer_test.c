/* Writing pictures row by row. */
#include "any_file.h"
#include "image/image.h"
#include "image/png_fast.h"
#include "unit.h"
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

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
static const ImageNotes notes = {&note, 1, 238.5};

static ImageForm form_of(const Picture *picture)
{
    return (ImageForm){.width = picture->width,
                       .height = picture->height,
                       .channels = picture->channels,
                       .bits = picture->bits,
                       .encoding = ENCODING_SRGB,
                       .notes = &notes};
}

static void write_packed(const Picture *picture, const char *path, ImagePacking packing)
{
    ImageForm form = form_of(picture);
    form.packing = packing;
    unlink(path);
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

static void write_in_parts(const Picture *picture, const char *path)
{
    write_packed(picture, path, (ImagePacking){0});
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

static void assert_reads_back(const char *path, const Picture *picture)
{
    Picture read;
    assert_int_equal(picture_read(&read, path, ALPHA_KEPT, &err), STATUS_OK);
    assert_int_equal(read.bits, picture->bits);
    bool grey = read.channels != picture->channels;
    for (size_t k = 0; k < (size_t)read.height * picture_stride(&read); k++)
        assert_int_equal(picture_code(&read, k), picture_code(picture, grey ? k / 3 : k));
    picture_release(&read);
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
        {"build/whole.png", "build/parts.png", 89, 6011, 3, 8},   /* filtered, several stripes */
        {"build/whole.png", "build/parts.png", 29001, 53, 3, 16}, /* more than is gathered */
        {"build/whole.tif", "build/parts.tif", 97, 71, 3, 8},
        {"build/whole.tiff", "build/parts.tiff", 29001, 13, 3, 16}, /* more than a strip */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Picture picture;
        make(&picture, cases[i].width, cases[i].height, cases[i].channels, cases[i].bits);
        assert_int_equal(picture_write(&picture, cases[i].whole, ENCODING_SRGB, &notes, NULL, &err),
                         STATUS_OK);
        write_in_parts(&picture, cases[i].parts);
        assert_same_files(cases[i].whole, cases[i].parts);
        assert_reads_back(cases[i].parts, &picture);
        unlink(cases[i].whole);
        unlink(cases[i].parts);
        picture_release(&picture);
    }
}

static void writes_a_png_of_the_same_bytes_on_any_number_of_threads(void **state)
{
    (void)state;
    static const int threads[] = {1, 2, 5};
    for (int channels = 1; channels <= 4; channels += channels == 1 ? 2 : 1) {
        Picture picture;
        make(&picture, 1193, 1307, channels, 8);
        for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
            write_packed(&picture, i ? "build/threads.png" : "build/thread.png",
                         (ImagePacking){.threads = threads[i]});
            if (i > 0)
                assert_same_files("build/thread.png", "build/threads.png");
        }
        assert_reads_back("build/threads.png", &picture);
        unlink("build/thread.png");
        unlink("build/threads.png");
        picture_release(&picture);
    }
}

enum { WIDE = 21, HIGH = 15 };

/* A stream as PngDeflater hands it over. */
typedef struct Deflated {
    uint8_t bytes[WIDE * HIGH * 2];
    size_t n;
} Deflated;

static void keep(void *context, const uint8_t *bytes, size_t n)
{
    Deflated *kept = context;
    assert_true(n <= sizeof kept->bytes - kept->n);
    memcpy(kept->bytes + kept->n, bytes, n);
    kept->n += n;
}

static void *deflate_runs(void *context)
{
    static const ImageForm form = {.width = WIDE, .height = HIGH, .channels = 1, .bits = 8};
    PngDeflater *deflater;
    uint8_t codes[WIDE * HIGH];
    for (size_t i = 0; i < sizeof codes; i++)
        codes[i] = i >= WIDE && i * i % 23 < 4 ? 4 : 9;
    assert_int_equal(pngdeflater_open(&deflater, &form, false, &err), STATUS_OK);
    pngdeflater_rows(deflater, codes, HIGH, keep, context);
    pngdeflater_free(deflater);
    return NULL;
}

/* On stacks all over 4 GB. */
static void deflates_a_png_to_the_same_bytes_wherever_memory_is(void **state)
{
    (void)state;
    enum { STACKS = 4096, STACK_BYTES = 1 << 19 };
    const size_t step = (size_t)1 << 20;
    static Deflated first, other;
    uint8_t *room = mmap(NULL, STACKS * step, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    assert_ptr_not_equal(room, MAP_FAILED);
    for (size_t i = 0; i < STACKS; i++) {
        pthread_t thread;
        pthread_attr_t attributes;
        other.n = 0;
        assert_int_equal(pthread_attr_init(&attributes), 0);
        assert_int_equal(pthread_attr_setstack(&attributes, room + i * step, STACK_BYTES), 0);
        assert_int_equal(pthread_create(&thread, &attributes, deflate_runs, i ? &other : &first),
                         0);
        assert_int_equal(pthread_join(thread, NULL), 0);
        assert_int_equal(pthread_attr_destroy(&attributes), 0);
        assert_int_equal(madvise(room + i * step, STACK_BYTES, MADV_DONTNEED), 0);
        if (i > 0) {
            assert_int_equal(other.n, first.n);
            assert_memory_equal(other.bytes, first.bytes, first.n);
        }
    }
    munmap(room, STACKS * step);
}

static unsigned one_value(size_t i, Random *random)
{
    (void)i;
    (void)random;
    return 238;
}

static unsigned longer_and_longer_runs(size_t i, Random *random)
{
    (void)random;
    return (unsigned)(sqrt((double)i) * 23.85);
}

static unsigned noise(size_t i, Random *random)
{
    (void)i;
    return (unsigned)(random_bits(random) & 65535);
}

/* Each value as often as the next two together: its best code would have more bits than deflate
 * allows. */
static unsigned rarer_and_rarer_values(size_t i, Random *random)
{
    (void)i;
    return (unsigned)(-log(1 - random_uniform(random)) / log(1.618));
}

static void reads_back_a_png_whatever_is_in_it(void **state)
{
    (void)state;
    static unsigned (*const values[])(size_t, Random *) = {one_value, longer_and_longer_runs, noise,
                                                           rarer_and_rarer_values};
    for (int form = 0; form < 6; form++) {
        for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
            int channels = (int[]){1, 3, 4}[form % 3], bits = form < 3 ? 8 : 16;
            Random random;
            random_seed(&random, 2385);
            Picture picture;
            make(&picture, 389, 571, channels, bits);
            for (size_t k = 0; k < 571 * picture_stride(&picture); k++)
                picture_set(&picture, k,
                            (uint16_t)(values[i](k, &random) & (bits == 8 ? 255 : 65535)));
            write_in_parts(&picture, "build/any.png");
            assert_reads_back("build/any.png", &picture);
            picture_release(&picture);
        }
    }
    unlink("build/any.png");
}

static void writes_a_tiff_of_the_same_codes_however_it_is_packed(void **state)
{
    (void)state;
    static const ImageCompression compressions[] = {IMAGE_LZW, IMAGE_DEFLATE, IMAGE_UNCOMPRESSED};
    size_t sizes[3];
    for (int bits = 8; bits <= 16; bits += 8) {
        Picture picture, read;
        make(&picture, 97, 71, 3, bits);
        for (int i = 0; i < 3; i++) {
            char *bytes;
            write_packed(&picture, "build/packed.tif",
                         (ImagePacking){.compression = compressions[i]});
            assert_int_equal(file_read("build/packed.tif", &any_file, &bytes, &sizes[i], &err),
                             STATUS_OK);
            assert_non_null(memmem(bytes, sizes[i], "acsp", 4)); /* in each ICC profile */
            assert_int_equal(picture_read(&read, "build/packed.tif", ALPHA_REFUSED, &err),
                             STATUS_OK);
            for (int y = 0; y < 71; y++)
                assert_true(picture_rows_equal(&picture, &read, y, 0, 97));
            free(bytes);
            picture_release(&read);
        }
        assert_true(sizes[0] != sizes[1] && sizes[0] != sizes[2] && sizes[1] != sizes[2]);
        picture_release(&picture);
    }
    unlink("build/packed.tif");
}

static void writes_a_jpeg_in_parts_the_smaller_the_worse(void **state)
{
    (void)state;
    static const int qualities[] = {100, 0, 60, 1};
    Picture picture;
    size_t size, last = SIZE_MAX;
    make(&picture, 97, 71, 3, 8);
    for (int i = 0; i < 4; i++) {
        const ImagePacking packing = {.quality = qualities[i]};
        char *bytes;
        write_packed(&picture, "build/parts.jpg", packing);
        assert_int_equal(
            picture_write(&picture, "build/whole.jpg", ENCODING_SRGB, &notes, &packing, &err),
            STATUS_OK);
        assert_same_files("build/whole.jpg", "build/parts.jpg");
        assert_int_equal(file_read("build/whole.jpg", &any_file, &bytes, &size, &err), STATUS_OK);
        static const uint8_t jfif[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I',
                                       'F',  0,    1,    1,    1, 0,  239, 0,   239};
        assert_memory_equal(bytes, jfif, sizeof jfif); /* 238.5 dots an inch, rounded */
        assert_true(size < last);
        last = size;
        free(bytes);
    }
    unlink("build/whole.jpg");
    unlink("build/parts.jpg");
    picture_release(&picture);
}

static void refuses_what_a_jpeg_cannot_hold(void **state)
{
    (void)state;
    Picture picture;
    ImageWriter *writer;
    const ImageForm wide = {.width = 65501, .height = 2, .channels = 3, .bits = 8};
    make(&picture, 5, 3, 3, 16);
    assert_int_equal(picture_write(&picture, "build/x.jpg", ENCODING_SRGB, NULL, NULL, &err),
                     STATUS_USAGE);
    assert_string_equal(err.text, "build/x.jpg: a JPEG has `bits` 8, not 16");
    assert_int_equal(imagewriter_open(&writer, "build/x.jpg", &wide, &err), STATUS_USAGE);
    assert_string_equal(err.text,
                        "build/x.jpg: a JPEG has at most 65500 x 65500 pixels, not 65501 x 2");
    assert_int_not_equal(access("build/x.jpg", F_OK), 0);
    picture_release(&picture);
}

/* More channels than a chunk of 16 rows ends with, infinities and ids included. */
static void writes_an_exr_of_channels_by_name_that_reads_back_exactly(void **state)
{
    (void)state;
    static const ImageChannel named[] = {{"R", false}, {"Z", true}, {"G", false}, {"B", false}};
    static const int order[] = {0, 2, 3};
    const ImageForm form = {.width = 13,
                            .height = 37,
                            .channels = 4,
                            .bits = 32,
                            .encoding = ENCODING_LINEAR,
                            .notes = &notes,
                            .named = named};
    Plane plane, rows, read;
    ImageWriter *writer;
    assert_int_equal(plane_init(&plane, 13, 37, 4, &err), STATUS_OK);
    for (int i = 0; i < 13 * 37 * 4; i++)
        plane.values[i] = i % 7 ? (float)i * 0.2385f : INFINITY;
    assert_int_equal(imagewriter_open(&writer, "build/parts.exr", &form, &err), STATUS_OK);
    for (int first = 0; first < 37; first += 5) {
        rows = plane;
        rows.values += first * 13 * 4;
        rows.height = first < 35 ? 5 : 2;
        assert_int_equal(imagewriter_floats(writer, &rows, &err), STATUS_OK);
    }
    assert_int_equal(imagewriter_commit(writer, &err), STATUS_OK);
    assert_int_equal(plane_read(&read, "build/parts.exr", ALPHA_REFUSED, &err), STATUS_OK);
    assert_int_equal(read.channels, 3);
    for (int i = 0; i < 13 * 37; i++)
        for (int c = 0; c < 3; c++)
            assert_true(read.values[3 * i + c] == plane.values[4 * i + order[c]]);
    unlink("build/parts.exr");
    plane_release(&plane);
    plane_release(&read);
}

static void rounds_the_floats_of_an_exr_to_half_when_it_is_to(void **state)
{
    (void)state;
    Plane plane, read;
    assert_int_equal(plane_init(&plane, 3, 2, 1, &err), STATUS_OK);
    for (int i = 0; i < 6; i++)
        plane.values[i] = 0.2385f * (float)i;
    assert_int_equal(plane_write(&plane, "build/half.exr", &(ImagePacking){.half = true}, &err),
                     STATUS_OK);
    assert_int_equal(plane_read(&read, "build/half.exr", ALPHA_REFUSED, &err), STATUS_OK);
    assert_int_equal(read.channels, 1);
    for (int i = 1; i < 6; i++) {
        assert_true(fabsf(read.values[i] - plane.values[i]) < plane.values[i] / 2048);
        assert_true(read.values[i] != plane.values[i]);
    }
    unlink("build/half.exr");
    plane_release(&plane);
    plane_release(&read);
}

static void writes_a_pfm_from_the_bottom_up_though_rows_come_from_the_top(void **state)
{
    (void)state;
    Plane plane, rows;
    assert_int_equal(plane_init(&plane, 13, 9, 3, &err), STATUS_OK);
    for (int i = 0; i < 13 * 9 * 3; i++)
        plane.values[i] = i % 7 ? (float)i * 0.2385f : INFINITY;
    assert_int_equal(plane_write(&plane, "build/whole.pfm", NULL, &err), STATUS_OK);
    const ImageForm form = {
        .width = 13, .height = 9, .channels = 3, .bits = 32, .encoding = ENCODING_LINEAR};
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
                                        "build/given_up.tif", "build/given_up.jpg"};
    Picture picture;
    make(&picture, 31, 17, 3, 8);
    const ImageForm form = form_of(&picture);
    const Picture rows = rows_of(&picture, 0, 9);
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
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
    const ImageForm form = {
        .width = IMAGE_MAX_SIDE, .height = IMAGE_MAX_SIDE, .channels = 3, .bits = 16};
    ImageWriter *writer;
    assert_int_equal(imagewriter_open(&writer, "build/vast.ppm", &form, &err), STATUS_IO);
    assert_non_null(strstr(err.text, "build/vast.ppm: needs at least 6.6 TB, and its disk has "));
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
        const ImageForm form = {.width = 3, .height = 4, .channels = 3, .bits = i ? 32 : 8};
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
        cmocka_unit_test(writes_a_png_of_the_same_bytes_on_any_number_of_threads),
        cmocka_unit_test(deflates_a_png_to_the_same_bytes_wherever_memory_is),
        cmocka_unit_test(reads_back_a_png_whatever_is_in_it),
        cmocka_unit_test(writes_a_tiff_of_the_same_codes_however_it_is_packed),
        cmocka_unit_test(writes_a_jpeg_in_parts_the_smaller_the_worse),
        cmocka_unit_test(refuses_what_a_jpeg_cannot_hold),
        cmocka_unit_test(writes_an_exr_of_channels_by_name_that_reads_back_exactly),
        cmocka_unit_test(rounds_the_floats_of_an_exr_to_half_when_it_is_to),
        cmocka_unit_test(writes_a_pfm_from_the_bottom_up_though_rows_come_from_the_top),
        cmocka_unit_test(leaves_nothing_of_what_is_given_up),
        cmocka_unit_test(refuses_what_the_disk_has_no_room_for),
        cmocka_unit_test(refuses_a_pipe_for_what_is_written_out_of_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
