/* Fuzzes the parser of options of every kind: a recipe, then the arguments, each up to a zero
 * byte. */
#include "options/options.h"

#include "fuzz.h"
#include <stdio.h>

enum { MAX_ARGUMENTS = 40 };

typedef struct Values {
    bool flag, on, given;
    const char *text;
    int whole;
    PictureSize size;
    unsigned choice;
    uint64_t seed;
    size_t count;
    double number;
    RangeEnds range;
    Vec3 vector, color;
    VectorList vectors;
    NumberList numbers;
} Values;

static const char *const choices[] = {"one", "two", NULL};

static const Option rows[] = {
    {.name = "output", SETS(TEXT, Values, text), GIVEN(Values, given), .help = ""},
    {.name = "flag", SETS(FLAG, Values, flag), .help = ""},
    {.name = "on", SETS(SWITCH, Values, on), .help = ""},
    {.name = "whole", SETS(WHOLE, Values, whole), FROM_TO(1, 9), .help = ""},
    {.name = "from", SETS(SEED, Values, seed), .help = ""},
    {.name = "count", SETS(COUNT, Values, count), FROM_TO(1, 1e6), .help = ""},
    {.name = "number", SETS(NUMBER, Values, number), FROM_TO(0.5, RANGE_NO_END), .help = ""},
    {.name = "vector", SETS(VECTOR, Values, vector), .help = ""},
    {.name = "vectors", SETS(VECTORS, Values, vectors), .help = ""},
    {.name = "numbers", SETS(NUMBERS, Values, numbers), .help = ""},
    {.name = "color", SETS(COLOR, Values, color), .help = ""},
    {.name = "size", SETS(SIZE, Values, size), FROM_TO(1, 9999), .help = ""},
    {.name = "dpi",
     SETS(NUMBER, Values, size.dpi),
     GIVEN(Values, size.has_dpi),
     FROM_TO(1, 1e5),
     .help = ""},
    {.name = "range", SETS(RANGE, Values, range), .help = ""},
    {.name = "choice", SETS(CHOICE, Values, choice), .choices = choices, .help = ""},
};

static const OptionTable table = OPTION_TABLE(rows);

static void set_defaults(void *options)
{
    *(Values *)options = (Values){.whole = 4,
                                  .size = {.pixels = {1, 1}, .dpi = 300},
                                  .count = 4,
                                  .number = 4,
                                  .range.at[1] = 1};
}

static const Command command = {.name = "render",
                                .summary = "fuzzed",
                                .operands = "A",
                                .examples = "",
                                .max_operands = 3,
                                .size = sizeof(Values),
                                .set_defaults = set_defaults,
                                .tables = {{&table, 0}}};

static void check(const Values *values)
{
    assert(values->whole >= 1 && values->whole <= 9);
    assert(values->count >= 1 && values->count <= 1000000 && values->number >= 0.5);
    assert(values->size.pixels[0] >= 1 && values->size.pixels[0] <= 9999);
    assert(values->size.pixels[1] >= 1 && values->size.pixels[1] <= 9999);
    const RangeEnds *range = &values->range;
    assert(range->percent[0] != range->percent[1] || range->at[0] < range->at[1]);
    assert(values->choice < 2);
    assert(values->color.x >= 0 && values->color.y <= 1);
    assert(values->vectors.n <= MAX_LIST && values->numbers.n <= MAX_LIST);
}

/* What is written of an option reads back to what is written the same. */
static void check_written(const Setting *setting, Parsed *again)
{
    const Setting *same = parsed_find(again, setting->option->name, strlen(setting->option->name));
    Err err = {{0}};
    for (size_t at = 0; at < setting_count(setting); at++) {
        Text value = TEXT_INIT, other = TEXT_INIT;
        setting_put(setting, at, &value);
        Status status = setting_read(same, text_chars(&value), &err);
        assert(status == STATUS_OK);
        setting_put(same, at, &other);
        assert(strcmp(text_chars(&value), text_chars(&other)) == 0);
        text_release(&value);
        text_release(&other);
    }
}

static void parse(int n, char **arguments)
{
    Parsed parsed, again;
    Err err = {{0}};
    if (parsed_init(&parsed, &command, &err) != STATUS_OK)
        return;
    if (options_parse(&parsed, n, arguments, &err) != STATUS_OK) {
        assert(*err.text);
    } else if (parsed_init(&again, &command, &err) == STATUS_OK) {
        const Values *values = parsed.options;
        check(values);
        assert(parsed.n_operands <= 3 && (!values->text || strlen(values->text) < 1u << 20));
        for (size_t i = 0; i < parsed.n_settings; i++)
            check_written(&parsed.settings[i], &again);
        parsed_release(&again);
    }
    parsed_release(&parsed);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char recipe[128], *arguments[MAX_ARGUMENTS] = {NULL};
    FuzzPart part = fuzz_part(&bytes, &size);
    snprintf(recipe, sizeof recipe, "--recipe=%s", fuzz_file("recipe.ini", part.bytes, part.size));
    arguments[0] = strdup(recipe);
    int n = 1;
    for (; n < MAX_ARGUMENTS && size > 0; n++) {
        part = fuzz_part(&bytes, &size);
        arguments[n] = strndup((const char *)part.bytes, part.size);
        /* no other file of the machine's, and no page of help for each of millions */
        if (strncmp(arguments[n], "--recipe", 8) == 0 || strncmp(arguments[n], "--help", 6) == 0)
            arguments[n][0] = '+';
    }
    parse(n, arguments);
    for (int i = 0; i < n; i++)
        free(arguments[i]);
    return 0;
}
