/* Pictures made by other programs, tests/data/images, most of 7 x 5 pixels, and damaged files
 * of every format. */
#include "any_file.h"
#include "image/image.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static Err err;

enum { W = 7, H = 5 };

static void path_of(const char *name, char path[128])
{
    snprintf(path, 128, "tests/data/images/%s", name);
}

static int level_at(int x, int y, int channel)
{
    return channel == 0 ? 30 * x + 11 * y : channel == 1 ? 40 * y + 3 * x : (17 * x * y + 5) % 256;
}

static void reads_tiff_codes_however_compressed(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int bits, factor;
    } files[] = {{"rgb8-lzw.tif", 8, 1}, {"rgb16-zip.tif", 16, 257}, {"planes-be.tif", 16, 257}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[128];
        Picture picture;
        path_of(files[i].name, path);
        assert_int_equal(picture_read(&picture, path, ALPHA_REFUSED, &err), STATUS_OK);
        assert_int_equal(picture.width, W);
        assert_int_equal(picture.height, H);
        assert_int_equal(picture.channels, 3);
        assert_int_equal(picture.bits, files[i].bits);
        size_t at = 0;
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                for (int c = 0; c < 3; c++)
                    assert_int_equal(picture_code(&picture, at++),
                                     level_at(x, y, c) * files[i].factor);
        picture_release(&picture);
    }
}

static void reads_floats_of_every_kind(void **state)
{
    (void)state;
    static const char *const names[] = {"float.tif", "half-zip.exr", "float-piz.exr",
                                        "half-rgba.exr", "raw-b44.exr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[128];
        Plane plane;
        path_of(names[i], path);
        assert_int_equal(plane_read(&plane, path, ALPHA_REFUSED, &err), STATUS_OK);
        assert_int_equal(plane.width, W);
        assert_int_equal(plane.height, H);
        assert_int_equal(plane.channels, 3);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const float *value = plane.values + (y * W + x) * 3;
                assert_float_equal(value[0], (float)(0.25 * x - 0.5), 0);
                assert_float_equal(value[1], (float)(0.125 * y + 2 * x), 0);
                assert_float_equal(value[2], (float)(0.5 * x * y), 0);
            }
        plane_release(&plane);
    }
}

static void reads_tiff_floats_of_16_bits(void **state)
{
    (void)state;
    Plane plane;
    assert_int_equal(plane_read(&plane, "tests/data/images/half.tif", ALPHA_REFUSED, &err),
                     STATUS_OK);
    size_t at = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++, at++)
                assert_float_equal(plane.values[at], (float)level_at(x, y, c) / 256, 0);
    plane_release(&plane);
}

static void keeps_infinity_and_nan_of_a_single_channel(void **state)
{
    (void)state;
    Plane plane;
    assert_int_equal(plane_read(&plane, "tests/data/images/depth.exr", ALPHA_REFUSED, &err),
                     STATUS_OK);
    assert_int_equal(plane.channels, 1);
    assert_true(isinf(plane.values[0]));
    assert_true(isnan(plane.values[2 * W + 3]));
    assert_float_equal(plane.values[W + 1], 100.75, 0);
    plane_release(&plane);
}

static Image read_image(const char *name)
{
    char path[128];
    Image image;
    path_of(name, path);
    must(image_read(&image, path, ALPHA_REFUSED, NULL, &err), &err);
    return image;
}

static void assert_same_image(const char *name, const char *other)
{
    Image a = read_image(name), b = read_image(other);
    if (a.plane.values) {
        assert_int_equal(a.plane.width, b.plane.width);
        assert_int_equal(a.plane.height, b.plane.height);
        for (int i = 0; i < a.plane.width * a.plane.height * a.plane.channels; i++)
            assert_float_equal(a.plane.values[i], b.plane.values[i], 0);
    } else {
        assert_int_equal(a.picture.width, b.picture.width);
        assert_int_equal(a.picture.height, b.picture.height);
        for (size_t i = 0; i < picture_stride(&a.picture) * (size_t)a.picture.height; i++)
            assert_int_equal(picture_code(&a.picture, i), picture_code(&b.picture, i));
    }
    image_release(&a);
    image_release(&b);
}

static void turns_a_tiff_as_its_orientation_says(void **state)
{
    (void)state;
    for (int i = 2; i <= 8; i++) {
        char name[32];
        snprintf(name, sizeof name, "turned-%d.tif", i);
        assert_same_image("rgb8-lzw.tif", name);
    }
}

static void reads_tiles_as_strips(void **state)
{
    (void)state;
    assert_same_image("rgb8-lzw.tif", "tiled.tif");
    assert_same_image("strips.png", "tiles.tif");
    assert_same_image("strips.png", "tiles-8.tif");
    assert_same_image("strips.exr", "tiles.exr");
}

/* The 7 x 5 pixels of half-zip.exr in a display window of `width` x `height`, their first at (x,
 * y). */
static void assert_shows(const char *name, int width, int height, int x0, int y0)
{
    Image image = read_image(name), data = read_image("half-zip.exr");
    assert_int_equal(image.plane.width, width);
    assert_int_equal(image.plane.height, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                int u = x - x0, v = y - y0;
                bool inside = u >= 0 && u < W && v >= 0 && v < H;
                float expected = inside ? data.plane.values[(v * W + u) * 3 + c] : 0;
                assert_float_equal(image.plane.values[(y * width + x) * 3 + c], expected, 0);
            }
    image_release(&image);
    image_release(&data);
}

static void shows_the_display_window_of_an_exr(void **state)
{
    (void)state;
    assert_shows("window-4-3.exr", 12, 9, 4, 3);
    assert_shows("window-1-0.exr", 12, 9, 1, 0);
    assert_shows("window-104-53.exr", 12, 9, 4, 3);
    assert_shows("window-within.exr", 4, 3, -2, -1);
}

static void knows_the_gamma_of_a_png(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double gamma;
    } files[] = {{"gamma-1.png", 1}, {"gamma-0.5.png", 0.5},  {"gamma-0.45455.png", 0},
                 {"rec709.png", 0},  {"srgb-profile.png", 0}, {"srgb-profile.tif", 0},
                 {"rgb8-lzw.tif", 0}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        assert_same_image("rgb8-lzw.tif", files[i].name);
        Image image = read_image(files[i].name);
        assert_float_equal(image.picture.gamma, files[i].gamma, 1e-9);
        image_release(&image);
    }
}

static void decodes_codes_by_their_gamma(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double linear; /* of code 30 of 255 */
    } files[] = {
        {"gamma-1.png", 0.117647}, {"gamma-0.5.png", 0.0138408}, {"rec709.png", 0.0129830}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        Image image = read_image(files[i].name);
        Picture srgb;
        assert_int_equal(picture_code(&image.picture, 3), 30);
        assert_int_equal(plane_from_picture(&image.plane, &image.picture, &err), STATUS_OK);
        assert_float_equal(image.plane.values[3], files[i].linear, 1e-6);
        assert_int_equal(picture_to_srgb(&srgb, &image.picture, 16, &err), STATUS_OK);
        assert_int_equal(picture_code(&srgb, 3),
                         image_code((float)files[i].linear, ENCODING_SRGB, 16));
        assert_float_equal(srgb.gamma, 0, 0);
        picture_release(&srgb);
        image_release(&image);
    }
}

static void says_what_it_does_not_read(void **state)
{
    (void)state;
    static const struct {
        const char *name, *sentence;
    } files[] = {
        {"glassy.tif", "is transparent at column 0, row 0"},
        {"glassy.exr", "is transparent at column 0, row 0"},
        {"dwaa.exr", "is compressed by DWAA or DWAB, which the library OpenEXRCore cannot"},
        {"aces.exr", "its color space is not sRGB (chromaticities)"},
        {"pages.tif", "has several pages"},
        {"animated.png", "is an animation of 2 pictures"},
        {"wide-profile.png", "has the color profile \"Wide built-in\""},
        {"wide-profile.tif", "has the color profile \"Wide built-in\""},
        {"p3.png", "its color space is not sRGB (cHRM chunk)"},
        {"p3.tif", "its color space is not sRGB (PrimaryChromaticities or WhitePoint)"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[128];
        Image image = {.picture = {.width = -7}};
        path_of(files[i].name, path);
        assert_int_equal(image_read(&image, path, ALPHA_REFUSED, NULL, &err), STATUS_INPUT);
        assert_non_null(strstr(err.text, path));
        if (!strstr(err.text, files[i].sentence))
            fail_msg("\"%s\" lacks \"%s\"", err.text, files[i].sentence);
        assert_int_equal(image.picture.width, -7);
    }
    Picture picture;
    Plane plane;
    assert_int_equal(picture_read(&picture, "tests/data/images/float.tif", ALPHA_REFUSED, &err),
                     STATUS_INPUT);
    assert_non_null(strstr(err.text, "holds floats"));
    assert_int_equal(plane_read(&plane, "tests/data/images/rgb8-lzw.tif", ALPHA_REFUSED, &err),
                     STATUS_INPUT);
    assert_non_null(strstr(err.text, "holds integers"));
}

/* The TIFF's codes are multiplied by alpha, 128 of 255: 30 becomes 60. */
static void keeps_alpha_or_lays_it_on_a_background(void **state)
{
    (void)state;
    static const float grey[3] = {0.3f, 0.3f, 0.3f};
    Picture picture;
    assert_int_equal(picture_read(&picture, "tests/data/images/glassy.tif", ALPHA_KEPT, &err),
                     STATUS_OK);
    assert_int_equal(picture.channels, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(picture_code(&picture, 4 + i), ((const uint16_t[]){60, 6, 10, 128})[i]);
    picture_release(&picture);
    Image kept = {0}, laid = {0};
    const char *path = "tests/data/images/glassy.exr";
    assert_int_equal(image_read(&kept, path, ALPHA_KEPT, NULL, &err), STATUS_OK);
    assert_int_equal(image_read(&laid, path, ALPHA_KEPT, NULL, &err), STATUS_OK);
    assert_int_equal(image_composite(&laid, grey, &err), STATUS_OK);
    assert_int_equal(kept.plane.channels, 4);
    assert_int_equal(laid.plane.channels, 3);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++) {
            const float *value = kept.plane.values + 4 * i;
            assert_float_equal(laid.plane.values[3 * i + c], value[c] + 0.3f * (1 - value[3]),
                               1e-6);
        }
    image_release(&kept);
    image_release(&laid);
}

/* A header of some hundred bytes that asks for gigabytes. */
static void refuses_pixels_that_no_file_of_that_size_holds(void **state)
{
    (void)state;
    static const struct {
        const char *path, *sides, *size;
    } files[] = {{"tests/fuzz/corpus/exr/announces-gigabytes.exr", "1048327 x 347", "388"},
                 {"tests/fuzz/corpus/exr/display-of-terabytes.exr", "1000000 x 1000000", "731"},
                 {"tests/fuzz/corpus/tiff/announces-gigabytes.tif", "16135 x 65285", "401"},
                 {"tests/fuzz/corpus/tiff/announces-a-large-tile.tif", "65520 x 21840", "405"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char sentence[256];
        Image image;
        snprintf(sentence, sizeof sentence,
                 "%s: its header announces %s pixels, more than its %s bytes can hold",
                 files[i].path, files[i].sides, files[i].size);
        assert_int_equal(image_read(&image, files[i].path, ALPHA_REFUSED, NULL, &err),
                         STATUS_INPUT);
        assert_string_equal(err.text, sentence);
    }
}

/* ------------------------------------------------------------------------------------- damage */

/* Reads bytes as an image, from memory, since they are many files: it is read, or refused with a
 * sentence that names the file. */
static Status read_bytes(const char *bytes, size_t size)
{
    char path[64];
    Image image = {0};
    int file = memfd_create("image", 0);
    assert_true(file >= 0);
    assert_int_equal(write(file, bytes, size), size);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    err.text[0] = '\0';
    Status status = image_read(&image, path, ALPHA_REFUSED, NULL, &err);
    if (status != STATUS_OK) {
        assert_true(status == STATUS_INPUT || status == STATUS_MEMORY);
        assert_true(strlen(err.text) > strlen(path));
        assert_null(strchr(err.text, '\n'));
        assert_null(image.picture.codes8);
        assert_null(image.plane.values);
    }
    image_release(&image);
    close(file);
    return status;
}

/* One file of every format; the last two are made here. */
static char *sample(size_t i, size_t *size)
{
    static const char *const names[] = {
        "rgb8-lzw.tif",     "rgb16-zip.tif", "float.tif",      "half-zip.exr", "float-piz.exr",
        "depth.exr",        "tiled.exr",     "tiles-8.tif",    "turned-6.tif", "pages.tif",
        "srgb-profile.png", "gamma-0.5.png", "window-4-3.exr", "aces.exr",     "parts.exr",
        "lossy.jpg",        "lossy.webp",    "planes-be.tif",  "palette.tif",  "bilevel.tif",
        "half.tif",         "half-rgba.exr", "raw-b44.exr"};
    char path[128] = "build/image_formats_test.png", *bytes;
    if (i < sizeof names / sizeof *names) {
        path_of(names[i], path);
    } else {
        Picture picture;
        assert_int_equal(picture_init(&picture, W, H, 3, i % 2 ? 8 : 16, &err), STATUS_OK);
        for (size_t k = 0; k < W * H * 3; k++)
            picture_set(&picture, k, (uint16_t)(k * 77 % 256));
        assert_int_equal(picture_write(&picture, path, ENCODING_SRGB, NULL, NULL, &err), STATUS_OK);
        picture_release(&picture);
    }
    assert_int_equal(file_read(path, &any_file, &bytes, size, &err), STATUS_OK);
    return bytes;
}
enum { SAMPLES = 25 };

static void names_the_end_that_a_png_lacks(void **state)
{
    (void)state;
    static const char *const path = "build/image_formats_test.png";
    for (size_t i = SAMPLES - 2; i < SAMPLES; i++) {
        enum { END_CHUNK = 12 };
        size_t size;
        char *bytes = sample(i, &size);
        Image image;
        ImageReader *reader;
        Picture rows;
        assert_int_equal(file_write(path, bytes, size - END_CHUNK, &err), STATUS_OK);
        assert_int_equal(image_read(&image, path, ALPHA_REFUSED, NULL, &err), STATUS_INPUT);
        assert_non_null(strstr(err.text, "ends before its IEND chunk; its pixels are whole"));
        assert_int_equal(imagereader_open(&reader, path, &err), STATUS_OK);
        assert_int_equal(picture_init(&rows, W, H, 3, imagereader_form(reader)->bits, &err),
                         STATUS_OK);
        assert_int_equal(imagereader_codes(reader, &rows, &err), STATUS_INPUT);
        assert_non_null(strstr(err.text, "ends before its IEND chunk; its pixels are whole"));
        picture_release(&rows);
        imagereader_close(reader);
        free(bytes);
    }
}

static void survives_files_cut_anywhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < SAMPLES; i++) {
        size_t size;
        char *bytes = sample(i, &size);
        for (size_t length = 0; length < size; length += 1 + length % 3)
            (void)read_bytes(bytes, length);
        assert_int_equal(read_bytes(bytes, size / 2), STATUS_INPUT);
        free(bytes);
    }
}

static void survives_files_with_damaged_bytes(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (size_t i = 0; i < SAMPLES; i++) {
        size_t size;
        char *bytes = sample(i, &size);
        for (int round = 0; round < 600; round++) {
            char *damaged = malloc(size);
            assert_non_null(damaged);
            memcpy(damaged, bytes, size);
            int edits = 1 + (int)(random_uniform(&random) * 4);
            for (int k = 0; k < edits; k++) {
                /* The first half of them near the start, where headers are. */
                double reach = round % 2 ? 1 : 0.2;
                size_t at = (size_t)(random_uniform(&random) * reach * (double)size);
                damaged[at] = (char)(random_bits(&random) & 255);
            }
            (void)read_bytes(damaged, size);
            free(damaged);
        }
        free(bytes);
    }
    unlink("build/image_formats_test.png");
}

int main(void)
{
    if (file_make_folder("build", &err) != STATUS_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_tiff_codes_however_compressed),
        cmocka_unit_test(reads_floats_of_every_kind),
        cmocka_unit_test(reads_tiff_floats_of_16_bits),
        cmocka_unit_test(keeps_infinity_and_nan_of_a_single_channel),
        cmocka_unit_test(turns_a_tiff_as_its_orientation_says),
        cmocka_unit_test(reads_tiles_as_strips),
        cmocka_unit_test(shows_the_display_window_of_an_exr),
        cmocka_unit_test(knows_the_gamma_of_a_png),
        cmocka_unit_test(decodes_codes_by_their_gamma),
        cmocka_unit_test(says_what_it_does_not_read),
        cmocka_unit_test(keeps_alpha_or_lays_it_on_a_background),
        cmocka_unit_test(refuses_pixels_that_no_file_of_that_size_holds),
        cmocka_unit_test(names_the_end_that_a_png_lacks),
        cmocka_unit_test(survives_files_cut_anywhere),
        cmocka_unit_test(survives_files_with_damaged_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
