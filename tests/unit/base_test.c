/* The module base: numbers as text, texts, files, hashes, sorting, random numbers, threads. */
#include "any_file.h"
#include "base/base.h"
#include "scratch.h"
#include "unit.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Exact number text. */

static void a_number_reads_back_to_the_same_double(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    char text[NUMBER_TEXT_SIZE];
    for (int i = 0; i < 300000; i++) {
        double value = (random_uniform(&random) - 0.5) * pow(10, random_uniform(&random) * 40 - 20);
        double back;
        assert_true(number_parse(number_text(value, text), &back));
        assert_true(back == value);
        float single = (float)value;
        assert_true(strtof(number_text_float(single, text), NULL) == single);
    }
}

/* gcc 12 must not make one vector of both numbers [docs/decisions/same-bytes.md]. */
__attribute__((noinline)) static void round_pair(double to[2], const double from[2])
{
    double first = (double)(float)from[0], second = (double)(float)from[1];
    to[0] = first;
    to[1] = second;
}

static void two_neighbours_are_rounded_to_single_precision(void **state)
{
    (void)state;
    double values[2], rounded[2];
    number_parse("0.1", &values[0]); /* unknown to the compiler */
    number_parse("-2.385", &values[1]);
    round_pair(rounded, values);
    assert_true(rounded[0] == 0x1.99999ap-4);
    assert_true(rounded[1] == -0x1.3147aep+1);
}

static void a_number_is_as_short_as_it_can_be(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.1, "0.1"},
                 {-2.385, "-2.385"},
                 {50, "50"},
                 {0, "0"},
                 {1e-20, "1e-20"},
                 {1e22, "1e+22"},
                 {1.0 / 3, "0.3333333333333333"},
                 {123456.5, "123456.5"},
                 {0.0001, "0.0001"},
                 {99999999999999.0, "99999999999999"}};
    char text[NUMBER_TEXT_SIZE];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(number_text(cases[i].value, text), cases[i].text);
    assert_string_equal(number_text_float(0.056f, text), "0.056");
}

/* Of any number of digits, with or without a point and an exponent, and of those in the middle
 * between two doubles, which have 54 bits. */
static void a_number_reads_as_strtod_reads_it(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 4711);
    for (int i = 0; i < 300000; i++) {
        char text[80];
        int before = (int)(11 * random_uniform(&random)),
            exponent = (int)(64 * random_uniform(&random)) - 32;
        uint64_t odd = (uint64_t)(ldexp(random_uniform(&random), 53)) * 2 + 1;
        uint64_t digits = (uint64_t)(1e10 * random_uniform(&random));
        if (i % 3 == 0)
            snprintf(text, sizeof text, "%llue%d", (unsigned long long)odd, exponent);
        else
            snprintf(text, sizeof text, "%s%.*s.%010llu%.*sE%+d", i % 2 ? "-" : "+", before,
                     "0192837465", (unsigned long long)digits, i % 13, "000000000000", exponent);
        double value, expected = strtod(text, NULL);
        assert_true(number_parse(text, &value));
        assert_memory_equal(&value, &expected, sizeof value);
    }
}

static void text_that_is_no_number_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",  " 1", "1 ", "1,5", "0x10", "1e", "--2", "1.2.3", "mm",
                                        ".", "+",  "-.", "1e+", "1e5e", "e5", ".e1", "1-"};
    double value = 7;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(number_parse(wrong[i], &value));
    long long whole = 7;
    assert_false(integer_parse("2.5", 0, 9, &whole));
    assert_false(integer_parse("10", 0, 9, &whole));
    assert_false(integer_parse("99999999999999999999", 0, 9, &whole));
    assert_true(value == 7 && whole == 7);
}

/* Text and errors. */

static void text_grows_over_any_length(void **state)
{
    (void)state;
    Text text = TEXT_INIT;
    for (int i = 0; i < 1000; i++)
        text_printf(&text, "%d,%0*d;", i, i, 1);
    assert_int_equal(text_check(&text, NULL), STATUS_OK);
    assert_int_equal(text.length, strlen(text.chars));
    assert_non_null(strstr(text.chars, ";3,001;"));
    text_release(&text);
}

static void base64_is_that_of_rfc_4648(void **state)
{
    (void)state;
    static const char *const vectors[][2] = {{"", ""},
                                             {"f", "Zg=="},
                                             {"fo", "Zm8="},
                                             {"foo", "Zm9v"},
                                             {"foob", "Zm9vYg=="},
                                             {"foobar", "Zm9vYmFy"},
                                             {"\xfb\xef\xff", "++//"}};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        Text text = TEXT_INIT;
        text_base64(&text, vectors[i][0], strlen(vectors[i][0]));
        assert_string_equal(text_chars(&text), vectors[i][1]);
        text_release(&text);
    }
}

static void a_text_with_a_stream_holds_only_what_is_not_written_yet(void **state)
{
    (void)state;
    FILE *stream = tmpfile(), *full = fopen("/dev/full", "w");
    assert_non_null(stream);
    assert_non_null(full);
    Text text = TEXT_TO(stream), lost = TEXT_TO(full);
    size_t length = 0, largest = 0;
    for (int i = 0; i < 50000; i++) {
        length += (size_t)snprintf(NULL, 0, "%d,", i);
        text_printf(&text, "%d,", i);
        text_printf(&lost, "%d,", i);
        largest = text.capacity > largest ? text.capacity : largest;
    }
    assert_int_equal(text_flush(&text, NULL), STATUS_OK);
    assert_int_equal(ftell(stream), length);
    assert_true(largest < 200000 && length > 280000);
    Err err;
    assert_int_equal(text_flush(&lost, &err), STATUS_IO);
    assert_string_equal(err.text, "writing failed: No space left on device");
    text_release(&text);
    text_release(&lost);
    fclose(stream);
    fclose(full);
}

static void what_is_made_of_a_text_that_failed_fails_too(void **state)
{
    (void)state;
    Text failed = TEXT_INIT, whole = TEXT_INIT, copy = TEXT_INIT;
    Err err;
    char *taken = NULL;
    assert_string_equal(text_chars(&failed), "");
    text_puts(&failed, "half a sen");
    text_puts(&failed, NULL);
    assert_null(text_chars(&failed));
    text_clear(&failed);
    assert_int_equal(text_check(&failed, &err), STATUS_MEMORY);
    assert_int_equal(text_take(&failed, &taken, &err), STATUS_MEMORY);
    assert_int_equal(file_write_text("build/failed.txt", &failed, &err), STATUS_MEMORY);
    assert_int_equal(access("build/failed.txt", F_OK), -1);
    text_puts(&whole, text_chars(&failed));
    assert_int_equal(text_check(&whole, &err), STATUS_MEMORY);
    text_add(&copy, &failed);
    assert_int_equal(text_check(&copy, &err), STATUS_MEMORY);
    assert_null(taken);
    text_release(&failed);
    text_release(&whole);
    text_release(&copy);
}

static void a_text_that_failed_is_no_json_and_one_that_is_not_there_is_null(void **state)
{
    (void)state;
    assert_null(json_text(NULL));
    json_t *nothing = json_text_or_null(NULL), *word = json_text_or_null("2.385 mm");
    assert_true(json_is_null(nothing));
    assert_string_equal(json_string_value(word), "2.385 mm");
    json_decref(nothing);
    json_decref(word);
}

static void bytes_that_are_not_utf8_become_replacement_characters(void **state)
{
    (void)state;
#define U UTF8_REPLACEMENT
    static const struct {
        const char *bytes, *text;
    } cases[] = {
        {"plain \x01\x7F", "plain \x01\x7F"},
        {"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\xA9\xB8", "\xC3\xA9 \xE2\x82\xAC \xF0\x9F\xA9\xB8"},
        {"\xE0\xA0\x80\xED\x9F\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF",
         "\xE0\xA0\x80\xED\x9F\xBF\xF0\x90\x80\x80\xF4\x8F\xBF\xBF"},
        {"Jos\xE9.swc", "Jos" U ".swc"},                    /* Latin-1 */
        {"\xC3", U},                                        /* cut short */
        {"\xE2\x82z", U U "z"},                             /* likewise */
        {"\xC0\x80 \xE0\x9F\xBF", U U " " U U U},           /* longer than need be */
        {"\xED\xA0\x80", U U U},                            /* a surrogate */
        {"\xF4\x90\x80\x80 \xFF", U U U U " " U},           /* beyond Unicode */
        {"\xEF\xBF\xBE\xEF\xBF\xBD", U U U "\xEF\xBF\xBD"}, /* no character of XML's */
    };
#undef U
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Text text = TEXT_INIT;
        text_utf8(&text, cases[i].bytes);
        assert_string_equal(text_chars(&text), cases[i].text);
        text_release(&text);
    }
}

static void json_made_of_nothing_is_nothing(void **state)
{
    (void)state;
    const JsonMember members[] = {
        {"a", json_integer(2385)}, {"b", NULL}, {"c", json_text("left over")}};
    Text text = TEXT_INIT;
    Err err;
    assert_null(json_with(NULL, "key", json_true()));
    assert_null(json_with(json_object(), "key", NULL));
    assert_null(json_with_item(json_array(), NULL));
    assert_null(json_with_item(NULL, json_true()));
    assert_null(json_with_members(json_object(), members, 3));
    text_json(&text, NULL, 2);
    assert_int_equal(text_check(&text, &err), STATUS_MEMORY);
    text_release(&text);
}

static void a_number_in_json_reads_back_to_the_same_double(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (int i = 0; i < 2000; i++) {
        double value = (random_uniform(&random) - 0.5) * pow(10, random_uniform(&random) * 40 - 20);
        Text text = TEXT_INIT;
        text_json(&text, json_with_item(json_array(), json_number(value)), 0);
        json_t *back = json_loads(text_chars(&text), 0, NULL);
        assert_true(json_number_value(json_array_get(back, 0)) == value);
        json_decref(back);
        text_release(&text);
    }
}

static void a_prefix_says_where_an_error_happened(void **state)
{
    (void)state;
    Err err;
    Status status = err_set(&err, STATUS_INPUT, "the radius %g is negative", -2.385);
    err_prefix(&err, "%s:%d: ", "tree.swc", 17);
    assert_int_equal(status, STATUS_INPUT);
    assert_string_equal(err.text, "tree.swc:17: the radius -2.385 is negative");
    assert_int_equal(status_exit(STATUS_DIFFERS), 1);
    assert_int_equal(status_exit(STATUS_INPUT), 2);
    assert_int_equal(status_exit(STATUS_MEMORY), 3);
}

/* Files. */

static void a_discarded_file_leaves_the_old_one_alone(void **state)
{
    (void)state;
    char *path = NULL, *bytes = NULL;
    size_t size;
    Err err;
    assert_int_equal(file_join(folder, "tree.swc", &path, &err), STATUS_OK);
    assert_int_equal(file_write(path, "old", 3, &err), STATUS_OK);
    OutFile file;
    assert_int_equal(outfile_open(&file, path, &err), STATUS_OK);
    fputs("half", file.stream);
    outfile_discard(&file);
    assert_int_equal(file_read(path, &any_file, &bytes, &size, &err), STATUS_OK);
    assert_int_equal(size, 3);
    assert_string_equal(bytes, "old");
    unlink(path); /* remove_folder fails when a temporary file is left */
    free(bytes);
    free(path);
}

static void a_committed_file_has_the_usual_permissions(void **state)
{
    (void)state;
    char *path = NULL;
    Err err;
    assert_int_equal(file_join(folder, "new.swc", &path, &err), STATUS_OK);
    mode_t mask = umask(022);
    assert_int_equal(file_write(path, "x", 1, &err), STATUS_OK);
    umask(mask);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0644);
    unlink(path);
    free(path);
}

static void a_file_in_a_missing_folder_cannot_be_opened(void **state)
{
    (void)state;
    OutFile file;
    Err err;
    assert_int_equal(outfile_open(&file, "/nowhere/at/all.swc", &err), STATUS_IO);
    assert_non_null(strstr(err.text, "/nowhere/at/all.swc"));
    char *bytes;
    size_t size;
    assert_int_equal(file_read("/nowhere/at/all.swc", &any_file, &bytes, &size, &err),
                     STATUS_INPUT);
    assert_int_equal(file_read(folder, &any_file, &bytes, &size, &err), STATUS_INPUT);
}

/* Writes the bytes to a file and reads it as `form` says; returns the status. */
static Status read_as(const FileForm *form, const char *content, size_t length, char **bytes,
                      size_t *size, Err *err)
{
    char *path = NULL;
    assert_int_equal(file_join(folder, "read", &path, err), STATUS_OK);
    assert_int_equal(file_write(path, content, length, err), STATUS_OK);
    Status status = file_read(path, form, bytes, size, err);
    unlink(path);
    free(path);
    return status;
}

static bool begins_with_b(const char *start, size_t count)
{
    return count > 0 && *start == 'b';
}

static void a_file_that_is_not_of_its_form_is_refused(void **state)
{
    (void)state;
    const FileForm form = {"a bill", 5, false, begins_with_b};
    char *bytes = NULL;
    size_t size = 7;
    Err err;
    assert_int_equal(read_as(&form, "bills!", 6, &bytes, &size, &err), STATUS_INPUT);
    assert_non_null(
        strstr(err.text, "read: is larger than 5 bytes, the most that a bill may have"));
    assert_int_equal(read_as(&form, "will", 4, &bytes, &size, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "read: is not a bill"));
    assert_int_equal(read_as(&form, "", 0, &bytes, &size, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "read: is not a bill"));
    assert_null(bytes);
    assert_int_equal(size, 7);
    assert_int_equal(read_as(&form, "b\0\r\nl", 5, &bytes, &size, &err), STATUS_OK);
    assert_int_equal(size, 5);
    assert_memory_equal(bytes, "b\0\r\nl", 6);
    free(bytes);
}

static void a_text_has_one_kind_of_line_ends(void **state)
{
    (void)state;
    const FileForm form = {.name = "a bill", .most_bytes = 99, .is_text = true};
    static const char *const cases[][2] = {{"a\r\nb\rc\nd\r\r\n\n", "a\nb\nc\nd\n\n\n"},
                                           {"\xef\xbb\xbf\ra", "\na"},
                                           {"\xef\xbb\xbf", ""},
                                           {"\xef\xbb", "\xef\xbb"},
                                           {"", ""}};
    char *bytes;
    size_t size;
    Err err;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(read_as(&form, cases[i][0], strlen(cases[i][0]), &bytes, &size, &err),
                         STATUS_OK);
        assert_string_equal(bytes, cases[i][1]);
        assert_int_equal(size, strlen(bytes));
        free(bytes);
    }
    assert_int_equal(read_as(&form, "a\rb\r\nc\0d\n", 9, &bytes, &size, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "read:3: a zero byte; a bill is plain text"));
}

static void a_file_of_many_slices_is_read_whole(void **state)
{
    (void)state;
    enum { LINES = 1048583, WIDTH = 13, SIZE = LINES * WIDTH };
    const FileForm form = {.name = "a bill", .most_bytes = 1e9, .is_text = true};
    char *text = malloc(SIZE + 1), *bytes;
    size_t size;
    Err err;
    assert_non_null(text);
    for (size_t line = 0; line < LINES; line++)
        snprintf(text + WIDTH * line, WIDTH + 1, "%012zu\n", line * 982451653 % 999999999989);
    assert_int_equal(read_as(&form, text, SIZE, &bytes, &size, &err), STATUS_OK);
    assert_int_equal(size, SIZE);
    assert_memory_equal(bytes, text, SIZE + 1);
    free(bytes);
    text[WIDTH * 700001 + 4] = '\0';
    assert_int_equal(read_as(&form, text, SIZE, &bytes, &size, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "read:700002: a zero byte; a bill is plain text"));
    free(text);
}

/* A conventional millimetre of mercury is 13.5951 g/cm^3 times 9.80665 m/s^2. */
static void units_of_users_and_of_calculation_are_related_as_defined(void **state)
{
    (void)state;
    assert_true(fabs(pa_from_mmhg(2.385) - 2.385 * 13.5951 * 9.80665) < 1e-9);
    assert_true(fabs(mmhg_from_pa(2.385) - 2.385 / (13.5951 * 9.80665)) < 1e-14);
    assert_true(fabs(mm3_s_from_ml_min(500.1) - 8335) < 1e-11);
    assert_true(fabs(ml_min_from_mm3_s(8335) - 500.1) < 1e-12);
    assert_true(fabs(pa_s_from_cp(3.6) - 0.0036) < 1e-18);
}

static void numbers_and_units_are_written_as_people_write_them(void **state)
{
    (void)state;
    static const struct {
        double value;
        int digits;
        const char *text;
    } numbers[] = {{1402.9, 3, "1400"},
                   {0.50004, 4, "0.5"},
                   {0, 3, "0"},
                   {-2.385, 3, "\u22122.38"},
                   {999999, 6, "999999"},
                   {999999, 3, "10\u2076"},
                   {0.0001234, 2, "0.00012"},
                   {0.00001234, 2, "1.2\u00d710\u207b\u2075"},
                   {9.9996, 4, "10"},
                   {-6.0221e23, 3, "\u22126.02\u00d710\u00b2\u00b3"},
                   {(double)INFINITY, 3, "inf"}};
    static const struct {
        const char *unit, *text;
    } units[] = {{"um", "\u00b5m"},
                 {"mm3/s", "mm\u00b3/s"},
                 {"mm^-3", "mm\u207b\u00b3"},
                 {"ul/min", "\u00b5l/min"},
                 {"dyn/cm2", "dyn/cm\u00b2"},
                 {"cmH2O", "cmH2O"},
                 {"unit", "unit"},
                 {"m-2 um-1", "m\u207b\u00b2 \u00b5m\u207b\u00b9"},
                 {"a^b", "a^b"},
                 {"", ""}};
    static const struct {
        int exponent;
        const char *text;
    } powers[] = {{0, "1"}, {1, "10"}, {-6, "10\u207b\u2076"}, {12, "10\u00b9\u00b2"}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        assert_string_equal(READABLE(numbers[i].value, numbers[i].digits), numbers[i].text);
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++)
        assert_string_equal(power_readable(powers[i].exponent, (char[READABLE_SIZE]){0}),
                            powers[i].text);
    Text plain = TEXT_INIT;
    text_plain(&plain, "\u22122 \u00d7 10\u207b\u00b2\u2070 \u00b5m\u00b3 \u00e9");
    assert_string_equal(text_chars(&plain), "-2 x 10^-20 um^3 \u00e9");
    text_release(&plain);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        Text text = TEXT_INIT;
        text_puts(&text, "");
        text_unit(&text, units[i].unit);
        assert_string_equal(text_chars(&text), units[i].text);
        text_release(&text);
    }
}

static void units_have_names_and_ratios_to_those_of_their_kind(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to;
        double ratio;
    } cases[] = {{"Pa", "dyn/cm2", 10},  {"mmHg", "kPa", 0.133322387415}, {"mm/s", "cm/s", 0.1},
                 {"ml/s", "ml/min", 60}, {"mm3/s", "ml/min", 0.06},       {"mm", "um", 1000}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_true(fabs(unit_ratio(cases[i].from, cases[i].to) / cases[i].ratio - 1) < 1e-14);
    assert_true(unit_ratio("Pa", "mm") == 0);
    assert_true(unit_ratio("Pa", "psi") == 0 && unit_ratio("", "Pa") == 0);
    assert_string_equal(unit_canonical_name("cm/s"), "cm/s");
    assert_null(unit_canonical_name("furlong"));
    Text others = TEXT_INIT;
    unit_put_others("mm/s", &others);
    assert_string_equal(text_chars(&others), "um/s, cm/s, m/s");
    text_release(&others);
}

static void sizes_are_said_in_units_that_suit_them(void **state)
{
    (void)state;
    static const struct {
        double bytes;
        const char *text;
    } cases[] = {{0, "0 bytes"},   {1, "1 byte"},        {999, "999 bytes"},
                 {1000, "1.0 kB"}, {2.385e6, "2.4 MB"},  {999960, "1.0 MB"},
                 {4e9, "4.0 GB"},  {7.1e15, "7100.0 TB"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[BYTES_TEXT_SIZE];
        assert_string_equal(bytes_text(cases[i].bytes, text), cases[i].text);
    }
}

static void numbers_stand_between_blanks(void **state)
{
    (void)state;
    double value[3];
    assert_true(numbers_parse(" 2.385\t-1e3  7 ", 3, value));
    assert_true(value[0] == 2.385 && value[1] == -1000 && value[2] == 7);
    static const char *const wrong[] = {"1 2", "1 2 3 4", "1 2 0x3", "1,2,3", "1 2 3;", ""};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(numbers_parse(wrong[i], 3, value));
}

static void suffixes_replace_extensions_only(void **state)
{
    (void)state;
    char *out = NULL;
    assert_int_equal(file_with_suffix("a.b/c", ".inc", &out, NULL), STATUS_OK);
    assert_string_equal(out, "a.b/c.inc");
    free(out);
    assert_int_equal(file_with_suffix("a.b/c.pov", ".inc", &out, NULL), STATUS_OK);
    assert_string_equal(out, "a.b/c.inc");
    free(out);
    assert_string_equal(file_extension("a.b/c"), "");
    assert_string_equal(file_extension(".hidden"), "");
}

/* Threads and random numbers. */

static void count_index(size_t index, int worker, void *context)
{
    (void)worker;
    ((unsigned char *)context)[index]++;
}

static void a_parallel_loop_visits_every_index_once(void **state)
{
    (void)state;
    static unsigned char visits[1237];
    for (int threads = 0; threads < 6; threads++) {
        memset(visits, 0, sizeof visits);
        threads_for(sizeof visits, threads, count_index, visits);
        for (size_t i = 0; i < sizeof visits; i++)
            assert_int_equal(visits[i], 1);
    }
}

static void the_random_stream_is_the_published_one(void **state)
{
    (void)state;
    /* xoshiro256** from the state 1, 2, 3, 4: 11520, 0, 1509978240, 1215971899390074240. */
    Random random = {{1, 2, 3, 4}};
    static const uint64_t expected[] = {11520, 0, 1509978240, 1215971899390074240};
    for (size_t i = 0; i < 4; i++)
        assert_true(random_bits(&random) == expected[i]);
    /* splitmix64 from 1234567 starts with 6457827717110365317. */
    random_seed(&random, 1234567);
    assert_true(random.state[0] == 6457827717110365317u);
}

/* Numbers in order. */

static void a_selected_number_is_that_of_its_rank_in_the_sorted_ones(void **state)
{
    (void)state;
    enum { N = 137 };
    double numbers[N], sorted[N];
    Random random;
    random_seed(&random, 2385);
    for (size_t i = 0; i < N; i++) /* many of them equal */
        sorted[i] = floor(40 * random_uniform(&random)) / 7 - 1.3;
    memcpy(numbers, sorted, sizeof numbers);
    sort_numbers(sorted, N);
    for (size_t i = 0; i + 1 < N; i++)
        assert_true(sorted[i] <= sorted[i + 1]);
    for (size_t k = 0; k < N; k++) {
        size_t rank = (k * 61 + 5) % N;
        assert_true(select_number(numbers, N, rank) == sorted[rank]);
    }
}

static void a_closed_range_says_what_is_in_it(void **state)
{
    (void)state;
    static const struct {
        Range range;
        double in, out;
        const char *text;
    } expected[] = {
        {{RANGE_ABOVE_0, 10}, 5e-324, 0, "above 0 and at most 10"},
        {{RANGE_ABOVE_0, RANGE_NO_END}, 2.385, -2.385, "above 0"},
        {{0, 0.95}, 0.95, 0.9500000000000001, "from 0 to 0.95"},
        {{0, RANGE_NO_END}, 0, HUGE_VAL, "of at least 0"},
        {{-RANGE_NO_END, 7.25}, 7.25, 7.5, "of at most 7.25"},
        {{-RANGE_NO_END, RANGE_NO_END}, -1e308, -HUGE_VAL, ""},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char text[RANGE_TEXT_SIZE];
        assert_string_equal(range_text(expected[i].range, text), expected[i].text);
        assert_true(range_has(expected[i].range, expected[i].in));
        assert_false(range_has(expected[i].range, expected[i].out));
        assert_false(range_has(expected[i].range, (double)NAN));
    }
}

static void the_likeliest_name_is_suggested(void **state)
{
    (void)state;
    static const struct {
        const char *word, *sentence;
    } expected[] = {
        {"presure", "no; did you mean pressure?"},      /* one left out */
        {"raidus", "no; did you mean radius?"},         /* two exchanged */
        {"Flow_share", "no; did you mean flow-share?"}, /* as good as the same */
        {"volume", "no"},                               /* like none */
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        Err err;
        Suggestion suggestion = suggestion_start(expected[i].word, strlen(expected[i].word));
        suggestion_offer(&suggestion, "radius");
        suggestion_offer(&suggestion, "pressure");
        suggestion_offer(&suggestion, "flow-share");
        err_set(&err, STATUS_USAGE, "no");
        suggestion_append(&suggestion, "", &err);
        assert_string_equal(err.text, expected[i].sentence);
    }
}

/* FIPS 180-2, appendix B. */
static void a_hash_is_sha_256(void **state)
{
    (void)state;
    Hash hash;
    hash_begin(&hash);
    hash_add(&hash, "ab", 2);
    hash_add(&hash, NULL, 0);
    hash_add(&hash, "c", 1);
    assert_string_equal(hash_finish(&hash).hex,
                        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    HashText parted, joined;
    hash_begin(&hash);
    hash_add_text(&hash, "a");
    hash_add_text(&hash, "bc");
    parted = hash_finish(&hash);
    hash_begin(&hash);
    hash_add_text(&hash, "ab");
    hash_add_text(&hash, "c");
    joined = hash_finish(&hash);
    assert_string_not_equal(parted.hex, joined.hex);
}

static LogCurve curve_of(const char *text)
{
    LogCurve curve = {.n = 0};
    assert_true(logcurve_parse(text, (Range){RANGE_ABOVE_0, 10}, &curve));
    return curve;
}

static void a_curve_is_linear_in_the_logarithm_and_constant_outside(void **state)
{
    (void)state;
    LogCurve curve = curve_of("0.05:3,0.2:2.6,3.2:2.2");
    const double expected[][2] = {{0.001, 3}, {0.05, 3},  {0.1, 2.8}, {0.2, 2.6},
                                  {0.8, 2.4}, {3.2, 2.2}, {77, 2.2}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_true(fabs(logcurve_at(&curve, expected[i][0]) - expected[i][1]) <= 1e-14);
    curve = curve_of("2.385");
    assert_true(curve.n == 1 && logcurve_at(&curve, 1e-9) == 2.385);
}

static void a_curve_reads_back_from_its_text(void **state)
{
    (void)state;
    static const char *const texts[] = {"2.385", "0.05:3,1:2.2", "1e-07:2.5,0.3:2.1,12.5:0.1"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        LogCurve curve = curve_of(texts[i]);
        Text text = TEXT_INIT;
        text_logcurve(&text, &curve);
        assert_string_equal(text_chars(&text), texts[i]);
        text_release(&text);
    }
    LogCurve one = curve_of("0.05:3,1:2.2"), other = curve_of("0.05:3,1.5:2.2");
    assert_true(logcurve_is_same(&one, &one) && !logcurve_is_same(&one, &other));
}

static void text_that_is_no_curve_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "",
        "three",
        "0.05:",
        ":3",
        "0.05:3,",
        "1:3,0.5:2",
        "1:3,1:2",
        "0:3,1:2",
        "-1:3,1:2",
        "1:3;2:2",
        "1:3 2:2",
        "1:0,2:2",
        "1:3,2:11",
        "1:3,2:2,nan:1",
        "1:nan,2:2.2",
        "1:2.5,2:3x",
        "1:2:3",
        "1:1,2:1,3:1,4:1,5:1,6:1,7:1,8:1,9:1,10:1,11:1,12:1,13:1,14:1,15:1,16:1,17:1"};
    LogCurve curve = curve_of("3");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(logcurve_parse(wrong[i], (Range){RANGE_ABOVE_0, 10}, &curve));
    assert_true(curve.n == 1 && curve.value[0] == 3);
}

/* Work in a process of its own. */

typedef enum Fate { MAKES_BYTES, DIES, LACKS_MEMORY, REFUSES } Fate;

static Status meet(const void *context, Text *bytes, Err *err)
{
    const Fate *fate = context;
    for (int i = 0; i < 100000 && *fate != REFUSES; i++)
        text_printf(bytes, "%d\n", i);
    if (*fate == DIES)
        raise(SIGKILL);
    errno = *fate == LACKS_MEMORY ? ENOMEM : 0;
    return *fate == REFUSES ? err_set(err, STATUS_USAGE, "no such work") : STATUS_OK;
}

static void isolated_work_gives_its_bytes_or_the_reason_why_not(void **state)
{
    static const struct {
        Fate fate;
        Status status;
        const char *sentence;
    } cases[] = {{DIES, STATUS_MEMORY, "no room for a thing"},
                 {LACKS_MEMORY, STATUS_MEMORY, "no room for a thing"},
                 {REFUSES, STATUS_USAGE, "no such work"}};
    const Fate right = MAKES_BYTES;
    Text bytes = TEXT_INIT;
    Err err;
    (void)state;
    text_puts(&bytes, "before\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(isolated_run(meet, &cases[i].fate, "a thing", &bytes, &err),
                         cases[i].status);
        assert_non_null(strstr(err.text, cases[i].sentence));
        assert_string_equal(text_chars(&bytes), "before\n");
    }
    assert_int_equal(isolated_run(meet, &right, "a thing", &bytes, &err), STATUS_OK);
    assert_int_equal(strlen(text_chars(&bytes)), 7 + 588890);
    assert_non_null(strstr(text_chars(&bytes), "before\n0\n1\n"));
    text_release(&bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hash_is_sha_256),
        cmocka_unit_test(a_number_reads_back_to_the_same_double),
        cmocka_unit_test(two_neighbours_are_rounded_to_single_precision),
        cmocka_unit_test(a_number_is_as_short_as_it_can_be),
        cmocka_unit_test(a_number_reads_as_strtod_reads_it),
        cmocka_unit_test(text_that_is_no_number_is_refused),
        cmocka_unit_test(text_grows_over_any_length),
        cmocka_unit_test(base64_is_that_of_rfc_4648),
        cmocka_unit_test(a_text_with_a_stream_holds_only_what_is_not_written_yet),
        cmocka_unit_test(what_is_made_of_a_text_that_failed_fails_too),
        cmocka_unit_test(a_text_that_failed_is_no_json_and_one_that_is_not_there_is_null),
        cmocka_unit_test(bytes_that_are_not_utf8_become_replacement_characters),
        cmocka_unit_test(json_made_of_nothing_is_nothing),
        cmocka_unit_test(a_number_in_json_reads_back_to_the_same_double),
        cmocka_unit_test(a_prefix_says_where_an_error_happened),
        cmocka_unit_test(a_discarded_file_leaves_the_old_one_alone),
        cmocka_unit_test(a_committed_file_has_the_usual_permissions),
        cmocka_unit_test(a_file_in_a_missing_folder_cannot_be_opened),
        cmocka_unit_test(a_file_that_is_not_of_its_form_is_refused),
        cmocka_unit_test(a_text_has_one_kind_of_line_ends),
        cmocka_unit_test(a_file_of_many_slices_is_read_whole),
        cmocka_unit_test(units_of_users_and_of_calculation_are_related_as_defined),
        cmocka_unit_test(numbers_and_units_are_written_as_people_write_them),
        cmocka_unit_test(units_have_names_and_ratios_to_those_of_their_kind),
        cmocka_unit_test(sizes_are_said_in_units_that_suit_them),
        cmocka_unit_test(numbers_stand_between_blanks),
        cmocka_unit_test(suffixes_replace_extensions_only),
        cmocka_unit_test(a_parallel_loop_visits_every_index_once),
        cmocka_unit_test(the_random_stream_is_the_published_one),
        cmocka_unit_test(a_closed_range_says_what_is_in_it),
        cmocka_unit_test(a_curve_is_linear_in_the_logarithm_and_constant_outside),
        cmocka_unit_test(a_curve_reads_back_from_its_text),
        cmocka_unit_test(text_that_is_no_curve_is_refused),
        cmocka_unit_test(the_likeliest_name_is_suggested),
        cmocka_unit_test(isolated_work_gives_its_bytes_or_the_reason_why_not),
        cmocka_unit_test(a_selected_number_is_that_of_its_rank_in_the_sorted_ones),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
