/* Pictures, planes and their files: codes, gammas, errors. */
#include "any_file.h"
#include "image/image.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Err err;

static void make(Picture *picture, int width, int height, int channels, int bits)
{
    assert_int_equal(picture_init(picture, width, height, channels, bits, &err), STATUS_OK);
    Random random;
    random_seed(&random, 2385);
    size_t n = (size_t)width * (size_t)height * (size_t)channels;
    for (size_t i = 0; i < n; i++)
        picture_set(picture, i, (uint16_t)(random_bits(&random) & (bits == 8 ? 255 : 65535)));
}

static void assert_same(const Picture *a, const Picture *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->channels, b->channels);
    assert_int_equal(a->bits, b->bits);
    for (int y = 0; y < a->height; y++)
        assert_true(picture_rows_equal(a, b, y, 0, a->width));
}

static Status read_bytes(const void *bytes, size_t size, Picture *picture)
{
    assert_int_equal(file_write("build/image_test.in", bytes, size, &err), STATUS_OK);
    Status status = picture_read(picture, "build/image_test.in", ALPHA_REFUSED, &err);
    unlink("build/image_test.in");
    return status;
}

static void assert_codes(const Picture *picture, const uint16_t *codes, size_t n)
{
    assert_int_equal((size_t)picture->height * picture_stride(picture), n);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(picture_code(picture, i), codes[i]);
}

static void read_text(const char *text, Picture *picture)
{
    assert_int_equal(read_bytes(text, strlen(text), picture), STATUS_OK);
}

static void refuses(const char *text, const char *part_of_sentence)
{
    Picture picture = {.width = -7};
    assert_int_equal(read_bytes(text, strlen(text), &picture), STATUS_INPUT);
    assert_int_equal(picture.width, -7);
    assert_non_null(strstr(err.text, "build/image_test.in: "));
    if (!strstr(err.text, part_of_sentence))
        fail_msg("\"%s\" lacks \"%s\"", err.text, part_of_sentence);
}

static void returns_from_every_file_what_was_written(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        int width, height, channels, bits;
    } cases[] = {
        {"build/image_test.ppm", 7, 3, 3, 8},   {"build/image_test.ppm", 1, 1, 3, 16},
        {"build/image_test.pgm", 5, 11, 1, 8},  {"build/image_test.pgm", 4, 3, 1, 16},
        {"build/image_test.png", 7, 3, 3, 8},   {"build/image_test.png", 31, 2, 3, 16},
        {"build/image_test.PNG", 13, 17, 1, 8}, {"build/image_test.png", 1, 1, 1, 16},
    };
    const ImageNote note = {"Description", "a tree of 401 segments\nand its seed, 7"};
    const ImageNotes notes = {&note, 1, 600};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (Encoding encoding = ENCODING_SRGB; encoding <= ENCODING_LINEAR; encoding++) {
            Picture written, read;
            make(&written, cases[i].width, cases[i].height, cases[i].channels, cases[i].bits);
            assert_int_equal(picture_write(&written, cases[i].path, encoding,
                                           encoding == ENCODING_SRGB ? &notes : NULL, NULL, &err),
                             STATUS_OK);
            assert_int_equal(picture_read(&read, cases[i].path, ALPHA_REFUSED, &err), STATUS_OK);
            assert_same(&written, &read);
            unlink(cases[i].path);
            picture_release(&written);
            picture_release(&read);
        }
}

static bool holds(const Text *text, const char *bytes, size_t size)
{
    return memmem(text->chars, text->length, bytes, size) != NULL;
}

static void tags_a_png_with_encoding_resolution_and_provenance_but_no_date(void **state)
{
    (void)state;
    Picture picture;
    make(&picture, 3, 2, 3, 8);
    static const ImageNote note[] = {{"Software", "corcast 0.1"}, {"Comment", "jos\xC3\xA9.swc"}};
    const ImageNotes notes = {note, 2, 300};
    Text srgb = TEXT_INIT, linear = TEXT_INIT;
    assert_int_equal(picture_to_png(&picture, ENCODING_SRGB, &notes, &srgb, &err), STATUS_OK);
    assert_int_equal(picture_to_png(&picture, ENCODING_LINEAR, NULL, &linear, &err), STATUS_OK);
    assert_true(holds(&srgb, "sRGB\0", 5));
    assert_true(holds(&srgb, "tEXtSoftware\0corcast 0.1", 24));
    assert_true(holds(&srgb, "iTXtComment\0\0\0\0\0jos\xC3\xA9.swc", 25));
    assert_true(holds(&srgb, "pHYs\0\0\x2e\x23\0\0\x2e\x23\1", 13));
    assert_false(holds(&srgb, "tIME", 4));
    assert_true(holds(&linear, "gAMA\0\1\x86\xa0", 8));
    assert_false(holds(&linear, "sRGB", 4));
    text_release(&srgb);
    text_release(&linear);
    picture_release(&picture);
}

static void refuses_to_write_what_the_extension_cannot_hold(void **state)
{
    (void)state;
    Picture picture;
    make(&picture, 2, 2, 3, 8);
    assert_int_equal(picture_write(&picture, "build/x.webp", ENCODING_SRGB, NULL, NULL, &err),
                     STATUS_USAGE);
    assert_int_equal(picture_write(&picture, "build/x.pgm", ENCODING_SRGB, NULL, NULL, &err),
                     STATUS_USAGE);
    assert_int_equal(picture_write(&picture, "build/none/x.png", ENCODING_SRGB, NULL, NULL, &err),
                     STATUS_IO);
    assert_int_not_equal(access("build/x.webp", F_OK), 0);
    picture_release(&picture);
}

static void reports_a_disk_that_is_full(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0)
        skip();
    Picture picture;
    make(&picture, 97, 91, 3, 16);
    assert_int_equal(symlink("/dev/full", "build/image_full.png"), 0);
    assert_int_equal(
        picture_write(&picture, "build/image_full.png", ENCODING_SRGB, NULL, NULL, &err),
        STATUS_IO);
    assert_non_null(strstr(err.text, "image_full.png"));
    unlink("build/image_full.png");
    picture_release(&picture);
}

static void reads_plain_and_commented_pnm(void **state)
{
    (void)state;
    Picture picture;
    read_text("P3\n# made by hand\n2 1 # two pixels\n255\n1 2 3\n250 251 252\n", &picture);
    const uint16_t plain[] = {1, 2, 3, 250, 251, 252};
    assert_int_equal(picture.width, 2);
    assert_codes(&picture, plain, sizeof plain / sizeof *plain);
    picture_release(&picture);
    read_text("P6\n# Software: POV-Ray 3.7\n# Platform: x\n1 1\n255\nabc", &picture);
    const uint16_t binary[] = {'a', 'b', 'c'};
    assert_codes(&picture, binary, sizeof binary / sizeof *binary);
    picture_release(&picture);
    read_text("P2 3 1 65535 0 40000 65535", &picture);
    assert_int_equal(picture.bits, 16);
    assert_int_equal(picture.channels, 1);
    assert_int_equal(picture_code(&picture, 1), 40000);
    picture_release(&picture);
}

static void rescales_a_maxval_of_its_own(void **state)
{
    (void)state;
    Picture picture;
    read_text("P2 4 1 15 0 1 7 15", &picture);
    const uint16_t eight[] = {0, 17, 119, 255};
    assert_int_equal(picture.bits, 8);
    assert_codes(&picture, eight, sizeof eight / sizeof *eight);
    picture_release(&picture);
    read_text("P2 3 1 1023 0 512 1023", &picture);
    const uint16_t sixteen[] = {0, 32800, 65535};
    assert_int_equal(picture.bits, 16);
    assert_codes(&picture, sixteen, sizeof sixteen / sizeof *sixteen);
    picture_release(&picture);
}

static void says_what_is_wrong_with_a_pnm(void **state)
{
    (void)state;
    refuses("", "is not a PBM, PGM, PPM, PAM, PFM, PNG, TIFF, OpenEXR, JPEG or WebP file");
    refuses("GIF89a", "is not a PBM, PGM, PPM, PAM, PFM, PNG, TIFF, OpenEXR, JPEG or WebP file");
    refuses("P6", "ends before the width");
    refuses("P6 0 5 255 ", "the width is \"0\"; it must be an integer from 1 to 1048576");
    refuses("P6 5 -5 255 ", "the height is \"-5\"");
    refuses("P6 99999999999 5 255 ", "the width is \"99999999999\"");
    refuses("P6 5 5 65536 ", "the largest value is \"65536\"");
    refuses("P6 2 1 255\nabcde", "announces 6 bytes of pixels, but 5 follow");
    refuses("P6 2 1 255\nabcdefg", "announces 6 bytes of pixels, but 7 follow");
    refuses("P6 1048576 1048576 65535\nabc", "announces 6597069766656 bytes");
    refuses("P3 1048576 1048576 255\n1 2 3", "more than its 28 bytes can hold");
    refuses("P3 1 1 255\n1 2 256", "the value of a pixel is \"256\"");
    refuses("P3 1 1 255\n1 2 3 4", "\"4\" follows its last pixel");
    refuses("P5 1 1 9\n:", "holds the value 58, which is above MAXVAL, 9");
    /* BLACKANDWHITE has one channel, or two with alpha. */
    refuses("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 3\nMAXVAL 1\nTUPLTYPE BLACKANDWHITE\nENDHDR\n\1\1\1",
            "has 3 samples per pixel of the kind \"BLACKANDWHITE\"");
    refuses(
        "P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 1\nTUPLTYPE BLACKANDWHITE_ALPHA\nENDHDR\n\1\1\1\1",
        "has 4 samples per pixel of the kind \"BLACKANDWHITE_ALPHA\"");
}

/* Every prefix of a file is refused with a sentence, and no changed byte does harm. */
static void survives_damage(const char *path, bool is_plane)
{
    char *bytes;
    size_t size;
    assert_int_equal(file_read(path, &any_file, &bytes, &size, &err), STATUS_OK);
    for (size_t cut = 0; cut < 2 * size; cut++) {
        bool truncating = cut < size;
        size_t at = truncating ? cut : cut - size;
        Picture picture = {0};
        Plane plane = {0};
        char saved = bytes[at];
        if (!truncating)
            bytes[at] = (char)(bytes[at] ^ 0x55);
        assert_int_equal(file_write("build/image_test.in", bytes, truncating ? at : size, &err),
                         STATUS_OK);
        bytes[at] = saved;
        err.text[0] = '\0';
        Status status = is_plane
                            ? plane_read(&plane, "build/image_test.in", ALPHA_REFUSED, &err)
                            : picture_read(&picture, "build/image_test.in", ALPHA_REFUSED, &err);
        if (truncating)
            assert_int_equal(status, STATUS_INPUT);
        if (status != STATUS_OK)
            assert_non_null(strstr(err.text, "build/image_test.in: "));
        picture_release(&picture);
        plane_release(&plane);
    }
    unlink("build/image_test.in");
    free(bytes);
}

static void survives_truncated_and_damaged_files(void **state)
{
    (void)state;
    static const char *const paths[] = {"build/image_damage.png", "build/image_damage.ppm"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        for (int bits = 8; bits <= 16; bits += 8) {
            Picture picture;
            make(&picture, 5, 4, 3, bits);
            assert_int_equal(picture_write(&picture, paths[i], ENCODING_SRGB, NULL, NULL, &err),
                             STATUS_OK);
            survives_damage(paths[i], false);
            picture_release(&picture);
            unlink(paths[i]);
        }
    Plane plane;
    assert_int_equal(plane_init(&plane, 3, 2, 3, &err), STATUS_OK);
    assert_int_equal(plane_write(&plane, "build/image_damage.pfm", NULL, &err), STATUS_OK);
    survives_damage("build/image_damage.pfm", true);
    plane_release(&plane);
    unlink("build/image_damage.pfm");
}

/* Appends a PNG chunk with its CRC. */
static void chunk(Text *png, const char *type, const void *data, size_t size)
{
    uint8_t head[8] = {(uint8_t)(size >> 24), (uint8_t)(size >> 16), (uint8_t)(size >> 8),
                       (uint8_t)size};
    memcpy(head + 4, type, 4);
    size_t start = png->length + 4;
    text_append(png, (const char *)head, 8);
    text_append(png, data, size);
    uint32_t crc = 0xffffffff;
    for (size_t i = start; i < png->length; i++) {
        crc ^= (uint8_t)png->chars[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    crc = ~crc;
    const uint8_t tail[4] = {(uint8_t)(crc >> 24), (uint8_t)(crc >> 16), (uint8_t)(crc >> 8),
                             (uint8_t)crc};
    text_append(png, (const char *)tail, 4);
}

/* A PNG of one row in a stored deflate block. */
static void build_png(Text *png, const uint8_t header[13], const uint8_t *palette,
                      size_t palette_size, const uint8_t *row, size_t row_size)
{
    text_append(png, "\x89PNG\r\n\x1a\n", 8);
    chunk(png, "IHDR", header, 13);
    if (palette)
        chunk(png, "PLTE", palette, palette_size);
    uint8_t data[64] = {0x78, 0x01, 0x01, (uint8_t)row_size, 0, (uint8_t)~row_size, 0xff};
    memcpy(data + 7, row, row_size);
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < row_size; i++) {
        a = (a + row[i]) % 65521;
        b = (b + a) % 65521;
    }
    const uint8_t sum[4] = {(uint8_t)(b >> 8), (uint8_t)b, (uint8_t)(a >> 8), (uint8_t)a};
    memcpy(data + 7 + row_size, sum, 4);
    chunk(png, "IDAT", data, row_size + 11);
    chunk(png, "IEND", "", 0);
}

static void reads_palette_and_low_depth_png(void **state)
{
    (void)state;
    Text png = TEXT_INIT;
    Picture picture;
    const uint8_t palette[] = {10, 20, 30, 40, 50, 60};
    const uint8_t indexed[] = {0, 1, 0};
    build_png(&png, (const uint8_t[13]){0, 0, 0, 2, 0, 0, 0, 1, 8, 3}, palette, 6, indexed, 3);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_OK);
    const uint16_t colors[] = {40, 50, 60, 10, 20, 30};
    assert_int_equal(picture.channels, 3);
    assert_codes(&picture, colors, sizeof colors / sizeof *colors);
    picture_release(&picture);
    text_release(&png);

    const uint8_t grey[] = {0, 0xb0};
    build_png(&png, (const uint8_t[13]){0, 0, 0, 4, 0, 0, 0, 1, 1, 0}, NULL, 0, grey, 2);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_OK);
    const uint16_t levels[] = {255, 0, 255, 255};
    assert_int_equal(picture.channels, 1);
    assert_codes(&picture, levels, sizeof levels / sizeof *levels);
    picture_release(&picture);
    text_release(&png);
}

static void takes_an_alpha_channel_only_where_it_is_opaque(void **state)
{
    (void)state;
    Text png = TEXT_INIT;
    Picture picture;
    const uint8_t opaque[] = {0, 1, 2, 3, 255, 4, 5, 6, 255};
    build_png(&png, (const uint8_t[13]){0, 0, 0, 2, 0, 0, 0, 1, 8, 6}, NULL, 0, opaque, 9);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_OK);
    const uint16_t codes[] = {1, 2, 3, 4, 5, 6};
    assert_codes(&picture, codes, sizeof codes / sizeof *codes);
    picture_release(&picture);
    text_release(&png);

    const uint8_t glassy[] = {0, 1, 2, 3, 255, 4, 5, 6, 254};
    build_png(&png, (const uint8_t[13]){0, 0, 0, 2, 0, 0, 0, 1, 8, 6}, NULL, 0, glassy, 9);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_INPUT);
    assert_non_null(strstr(err.text, "is transparent at column 1, row 0"));
    text_release(&png);
}

static void refuses_a_png_that_announces_more_than_it_can_hold(void **state)
{
    (void)state;
    Text png = TEXT_INIT;
    Picture picture;
    const uint8_t row[] = {0, 1, 2, 3};
    build_png(&png, (const uint8_t[13]){0, 15, 0, 0, 0, 15, 0, 0, 16, 2}, NULL, 0, row, 4);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_INPUT);
    assert_non_null(strstr(err.text, "announces 983040 x 983040 pixels, more than its 72 bytes"));
    text_release(&png);
    build_png(&png, (const uint8_t[13]){0, 16, 0, 1, 0, 0, 0, 1, 8, 2}, NULL, 0, row, 4);
    assert_int_equal(read_bytes(png.chars, png.length, &picture), STATUS_INPUT);
    text_release(&png);
}

static void refuses_sides_of_zero_and_images_beyond_memory(void **state)
{
    (void)state;
    Plane plane = {.width = -7};
    assert_int_equal(plane_init(&plane, 0, 5, 3, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "0 x 5 pixels"));
    assert_int_equal(plane_init(&plane, 5, IMAGE_MAX_SIDE + 1, 3, &err), STATUS_INPUT);
    assert_int_equal(plane_init(&plane, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE, 3, &err), STATUS_MEMORY);
    assert_non_null(strstr(err.text, "1048576 x 1048576 pixels needs 13194.1 GB"));
    assert_int_equal(plane.width, -7);
}

static void encodes_as_povray_does(void **state)
{
    (void)state;
    assert_int_equal(image_code(0, ENCODING_SRGB, 8), 0);
    assert_int_equal(image_code(1, ENCODING_SRGB, 8), 255);
    assert_int_equal(image_code(1, ENCODING_LINEAR, 16), 65535);
    assert_int_equal(image_code(0.5f, ENCODING_LINEAR, 8), 128);
    assert_int_equal(image_code(0.5f, ENCODING_SRGB, 8), 188);
    assert_int_equal(image_code(-3.7f, ENCODING_SRGB, 8), 0);
    assert_int_equal(image_code(2.385f, ENCODING_SRGB, 16), 65535);
    assert_int_equal(image_code(INFINITY, ENCODING_SRGB, 16), 65535);
    assert_int_equal(image_code(-INFINITY, ENCODING_LINEAR, 16), 0);
    assert_int_equal(image_code(NAN, ENCODING_SRGB, 8), 0);
    assert_int_equal(image_code(NAN, ENCODING_LINEAR, 8), 0);
    assert_float_equal(srgb_decode(srgb_encode(0.2385f)), 0.2385f, 1e-6f);
    assert_float_equal(srgb_decode(srgb_encode(0.001f)), 0.001f, 1e-9f);
}

static void tables_give_the_same_codes(void **state)
{
    (void)state;
    SrgbCodes codes;
    srgb_codes_init(&codes);
    const float odd[] = {0, -0.0f, -3.7f, 1, 2.385f, INFINITY, -INFINITY, NAN, 1e-40f};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        assert_int_equal(srgb_code(&codes, odd[i]), image_code(odd[i], ENCODING_SRGB, 8));
    for (uint32_t bits = 0; bits <= 0x3f800000; bits += 2385) {
        float value;
        memcpy(&value, &bits, sizeof value);
        assert_int_equal(srgb_code(&codes, value), image_code(value, ENCODING_SRGB, 8));
    }
    /* Every float about each step. */
    for (int code = 1; code < 256; code++) {
        uint32_t step = 0, after = 0x3f800000;
        float value;
        while (step < after) {
            uint32_t middle = step + (after - step) / 2;
            memcpy(&value, &middle, sizeof value);
            if (image_code(value, ENCODING_SRGB, 8) >= code)
                after = middle;
            else
                step = middle + 1;
        }
        for (uint32_t bits = step - 2000; bits < step + 2000; bits++) {
            memcpy(&value, &bits, sizeof value);
            assert_int_equal(srgb_code(&codes, value), image_code(value, ENCODING_SRGB, 8));
        }
    }
}

/* Codes of POV-Ray 3.7.0.10 (+FP16 File_Gamma=srgb) for colors where a power in double precision
 * rounds the other way. */
static void rounds_like_povray_where_double_precision_would_not(void **state)
{
    (void)state;
    static const struct {
        float linear;
        uint16_t code;
    } cases[] = {{0.844339371f, 60828}, {0.439689428f, 45490}, {0.632602513f, 53525},
                 {0.876581609f, 61842}, {0.377607971f, 42473}, {0.620972335f, 53085}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_int_equal(image_code(cases[i].linear, ENCODING_SRGB, 16), cases[i].code);
}

static void returns_every_code_through_a_plane(void **state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8)
        for (Encoding encoding = ENCODING_SRGB; encoding <= ENCODING_LINEAR; encoding++) {
            Picture picture, back;
            Plane plane;
            assert_int_equal(picture_init(&picture, 1 << bits, 1, 1, bits, &err), STATUS_OK);
            for (int i = 0; i < 1 << bits; i++)
                picture_set(&picture, (size_t)i, (uint16_t)i);
            picture.gamma = encoding == ENCODING_LINEAR ? 1 : 0;
            assert_int_equal(plane_from_picture(&plane, &picture, &err), STATUS_OK);
            assert_int_equal(picture_from_plane(&back, &plane, encoding, bits, &err), STATUS_OK);
            assert_same(&picture, &back);
            picture_release(&picture);
            picture_release(&back);
            plane_release(&plane);
        }
}

static void packs_ids_into_three_bytes(void **state)
{
    (void)state;
    IdPlane ids, back;
    Picture picture, deep;
    assert_int_equal(idplane_init(&ids, 3, 1, &err), STATUS_OK);
    ids.ids[1] = 0x0102fe;
    ids.ids[2] = 0xffffff;
    assert_int_equal(picture_from_ids(&picture, &ids, &err), STATUS_OK);
    const uint16_t codes[] = {0, 0, 0, 1, 2, 254, 255, 255, 255};
    assert_codes(&picture, codes, sizeof codes / sizeof *codes);
    assert_int_equal(ids_take_picture(&back, &picture, &err), STATUS_OK);
    assert_memory_equal(back.ids, ids.ids, 3 * sizeof *ids.ids);
    make(&deep, 2, 2, 3, 16);
    assert_int_equal(ids_take_picture(&back, &deep, &err), STATUS_INPUT);
    idplane_release(&ids);
    idplane_release(&back);
    picture_release(&picture);
    picture_release(&deep);
}

static void keeps_infinity_and_nan_in_a_pfm(void **state)
{
    (void)state;
    Plane plane, back;
    assert_int_equal(plane_init(&plane, 3, 2, 1, &err), STATUS_OK);
    const float values[] = {2.385f, INFINITY, NAN, -0.0f, 1e-30f, -7};
    memcpy(plane.values, values, sizeof values);
    assert_int_equal(plane_write(&plane, "build/image_test.pfm", NULL, &err), STATUS_OK);
    assert_int_equal(plane_read(&back, "build/image_test.pfm", ALPHA_REFUSED, &err), STATUS_OK);
    assert_memory_equal(back.values, values, sizeof values);
    assert_int_equal(back.channels, 1);
    unlink("build/image_test.pfm");
    plane_release(&plane);
    plane_release(&back);
}

static void reads_a_pfm_of_either_byte_order_from_the_bottom_up(void **state)
{
    (void)state;
    static const char big[] = "Pf\n1 2\n1.0\n\x40\x00\x00\x00\xc0\x40\x00\x00";
    static const char little[] = "Pf 1 2 -1\n\x00\x00\x00\x40\x00\x00\x40\xc0";
    const struct {
        const char *bytes;
        size_t size;
    } files[] = {{big, sizeof big - 1}, {little, sizeof little - 1}};
    for (int i = 0; i < 2; i++) {
        Plane plane;
        assert_int_equal(file_write("build/image_test", files[i].bytes, files[i].size, &err),
                         STATUS_OK);
        assert_int_equal(plane_read(&plane, "build/image_test", ALPHA_REFUSED, &err), STATUS_OK);
        assert_float_equal(plane.values[0], -3, 0);
        assert_float_equal(plane.values[1], 2, 0);
        plane_release(&plane);
    }
    unlink("build/image_test");
}

static void says_what_is_wrong_with_a_pfm(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } cases[] = {{"P6 1 1 255 abc", "holds integers; a picture of floats"},
                 {"PF", "ends before the width"},
                 {"PF 1 0 -1\n", "the height is \"0\""},
                 {"PF 1 1 nan\n", "the scale is \"nan\""},
                 {"PF 1 1 0\n", "the scale is \"0\""},
                 {"PF 1 1 -2.5\n", "the scale is \"-2.5\"; it must be 1 or -1"},
                 {"PF 1 1 -1", "a blank must separate"},
                 {"PF 1048576 1048576 -1\nabcd", "announces 13194139533312 bytes"},
                 {"Pf 1 1 -1\nabcde", "announces 4 bytes of pixels, but 5 follow"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Plane plane;
        assert_int_equal(
            file_write("build/image_test.pfm", cases[i].text, strlen(cases[i].text), &err),
            STATUS_OK);
        assert_int_equal(plane_read(&plane, "build/image_test.pfm", ALPHA_REFUSED, &err),
                         STATUS_INPUT);
        if (!strstr(err.text, cases[i].sentence))
            fail_msg("\"%s\" lacks \"%s\"", err.text, cases[i].sentence);
    }
    unlink("build/image_test.pfm");
}

int main(void)
{
    if (file_make_folder("build", &err) != STATUS_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(returns_from_every_file_what_was_written),
        cmocka_unit_test(tags_a_png_with_encoding_resolution_and_provenance_but_no_date),
        cmocka_unit_test(refuses_to_write_what_the_extension_cannot_hold),
        cmocka_unit_test(reports_a_disk_that_is_full),
        cmocka_unit_test(reads_plain_and_commented_pnm),
        cmocka_unit_test(rescales_a_maxval_of_its_own),
        cmocka_unit_test(says_what_is_wrong_with_a_pnm),
        cmocka_unit_test(survives_truncated_and_damaged_files),
        cmocka_unit_test(reads_palette_and_low_depth_png),
        cmocka_unit_test(takes_an_alpha_channel_only_where_it_is_opaque),
        cmocka_unit_test(refuses_a_png_that_announces_more_than_it_can_hold),
        cmocka_unit_test(refuses_sides_of_zero_and_images_beyond_memory),
        cmocka_unit_test(encodes_as_povray_does),
        cmocka_unit_test(tables_give_the_same_codes),
        cmocka_unit_test(rounds_like_povray_where_double_precision_would_not),
        cmocka_unit_test(returns_every_code_through_a_plane),
        cmocka_unit_test(packs_ids_into_three_bytes),
        cmocka_unit_test(keeps_infinity_and_nan_in_a_pfm),
        cmocka_unit_test(reads_a_pfm_of_either_byte_order_from_the_bottom_up),
        cmocka_unit_test(says_what_is_wrong_with_a_pfm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
