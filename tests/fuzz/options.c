/* Options of every kind: a recipe, then the arguments, each up to a zero byte. */
#include "app/options.h"

#include "fuzz.h"
#include <stdio.h>

enum { MAX_ARGUMENTS = 40 };

static const Command command = {.name = "render",
                                .summary = "fuzzed",
                                .operands = "A",
                                .examples = "",
                                .min_operands = 0,
                                .max_operands = 3};

static void parse(int n, char **arguments)
{
    static const char *const choices[] = {"one", "two", NULL};
    bool flag, on, given;
    const char *text = NULL;
    int whole = 4, size[2] = {1, 1}, choice = 0;
    uint64_t seed;
    size_t count = 4;
    double number = 4, range[2] = {0, 1};
    Vec3 vector, color = {0};
    VectorList vectors = {0};
    NumberList numbers = {0};
    const Option own[] = {
        {"output", OPTION_TEXT, &text, &given, 0, 0, NULL, NULL, ""},
        {"flag", OPTION_FLAG, &flag, NULL, 0, 0, NULL, NULL, ""},
        {"on", OPTION_SWITCH, &on, NULL, 0, 0, NULL, NULL, ""},
        {"whole", OPTION_WHOLE, &whole, NULL, 1, 9, NULL, NULL, ""},
        {"from", OPTION_SEED, &seed, NULL, 0, 0, NULL, NULL, ""},
        {"count", OPTION_COUNT, &count, NULL, 1, 1e6, NULL, NULL, ""},
        {"number", OPTION_NUMBER, &number, NULL, 0.5, 1e300, NULL, NULL, ""},
        {"vector", OPTION_VECTOR, &vector, NULL, 0, 0, NULL, NULL, ""},
        {"vectors", OPTION_VECTORS, &vectors, NULL, 0, 0, NULL, NULL, ""},
        {"numbers", OPTION_NUMBERS, &numbers, NULL, 0, 0, NULL, NULL, ""},
        {"color", OPTION_COLOR, &color, NULL, 0, 0, NULL, NULL, ""},
        {"size", OPTION_SIZE, size, NULL, 1, 9999, NULL, NULL, ""},
        {"range", OPTION_RANGE, range, NULL, 0, 0, NULL, NULL, ""},
        {"choice", OPTION_CHOICE, &choice, NULL, 0, 0, choices, NULL, ""},
        {0},
    };
    const Option *const tables[] = {own, NULL};
    Parsed parsed = {0};
    Err err = {{0}};
    if (options_parse(&command, tables, n, arguments, &parsed, &err) != STATUS_OK) {
        assert(*err.text);
        return;
    }
    assert(whole >= 1 && whole <= 9 && count >= 1 && count <= 1000000 && number >= 0.5);
    assert(size[0] >= 1 && size[0] <= 9999 && size[1] >= 1 && size[1] <= 9999);
    assert(range[0] < range[1] && choice >= 0 && choice < 2);
    assert(color.x >= 0 && color.y <= 1 && vectors.n <= MAX_LIST && numbers.n <= MAX_LIST);
    assert(parsed.n_operands <= 3 && (!text || strlen(text) < 1u << 20));
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
