/* A table row a key: where its field and flag lie in TreeHeader, and which values it may take. */
#include "treeio/swc.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef enum KeyKind { KEY_NUMBER, KEY_DIMENSION, KEY_SEED, KEY_WORD } KeyKind;

static bool is_any(double value)
{
    return isfinite(value);
}

static bool is_dimension(double value)
{
    return value == 2 || value == 3;
}

static bool is_murray_exponent(double value)
{
    return value > 0 && value <= 10;
}

static bool is_not_negative(double value)
{
    return isfinite(value) && value >= 0;
}

static bool is_positive(double value)
{
    return isfinite(value) && value > 0;
}

static bool is_hematocrit(double value)
{
    return value >= 0 && value <= MAX_HEMATOCRIT;
}

/* The words that stand for the values 0, 1, ... of an enum. */
static const char *const viscosity_laws[] = {
    [VISCOSITY_CONSTANT] = "constant", [VISCOSITY_PRIES] = "pries", NULL};
static const char *const terminal_flows[] = {
    [TERMINAL_FLOW_EQUAL] = "equal", [TERMINAL_FLOW_TERRITORY] = "territory", NULL};

typedef struct Key {
    const char *name;
    KeyKind kind;
    bool (*allows)(double value);
    const char *const *words; /* of a KEY_WORD; ends with NULL */
    const char *allowed;
    size_t flag, field; /* offsets */
} Key;

#define KEY(name, kind, allows, allowed, flag, field)                                              \
    {                                                                                              \
        name, kind, allows, NULL, allowed, offsetof(TreeHeader, has.flag),                         \
            offsetof(TreeHeader, field)                                                            \
    }
#define WORD_KEY(name, words, allowed, flag)                                                       \
    {                                                                                              \
        name, KEY_WORD, NULL, words, allowed, offsetof(TreeHeader, has.flag),                      \
            offsetof(TreeHeader, flag)                                                             \
    }

static const Key keys[SWC_N_KEYS] = {
    KEY("seed", KEY_SEED, NULL, "a whole number from 0 to 18446744073709551615", seed, seed),
    KEY("dimension", KEY_DIMENSION, is_dimension, "2 or 3", dimension, dimension),
    KEY("gamma", KEY_NUMBER, is_murray_exponent, "above 0 and at most 10", gamma, gamma),
    KEY("lambda", KEY_NUMBER, is_not_negative, "a number that is not negative", lambda, lambda),
    KEY("p_perf_mmHg", KEY_NUMBER, is_any, "a finite number", p_perf, p_perf_mmhg),
    KEY("p_term_mmHg", KEY_NUMBER, is_any, "a finite number", p_term, p_term_mmhg),
    KEY("q_perf_ml_min", KEY_NUMBER, is_positive, "a number above 0", q_perf, q_perf_ml_min),
    KEY("viscosity_cP", KEY_NUMBER, is_positive, "a number above 0", viscosity, viscosity_cp),
    WORD_KEY("viscosity_law", viscosity_laws, "constant or pries", viscosity_law),
    KEY("hematocrit", KEY_NUMBER, is_hematocrit, "from 0 to 0.95", hematocrit, hematocrit),
    KEY("plasma_viscosity_cP", KEY_NUMBER, is_positive, "a number above 0", plasma_viscosity,
        plasma_viscosity_cp),
    WORD_KEY("terminal_flow", terminal_flows, "equal or territory", terminal_flow),
};

static const char blanks[] = " \t\v\f";

const char *swc_value_of(const char *line, const char *name)
{
    line += strspn(line, blanks);
    size_t length = strlen(name);
    if (strncmp(line, name, length) != 0)
        return NULL;
    line += length;
    line += strspn(line, blanks);
    if (*line != ':')
        return NULL;
    line++;
    return line + strspn(line, blanks);
}

int swc_key_of_line(const char *line)
{
    for (int key = 0; key < SWC_N_KEYS; key++)
        if (swc_value_of(line, keys[key].name))
            return key;
    return SWC_NO_KEY;
}

/* A field's value as read, before it is known to be allowed. */
typedef union Value {
    double number;
    int dimension;
    uint64_t seed;
    unsigned word; /* an enum whose values are not negative */
} Value;

static size_t value_size(KeyKind kind)
{
    static const size_t sizes[] = {[KEY_NUMBER] = sizeof(double),
                                   [KEY_DIMENSION] = sizeof(int),
                                   [KEY_SEED] = sizeof(uint64_t),
                                   [KEY_WORD] = sizeof(unsigned)};
    static_assert(sizeof(ViscosityLaw) == sizeof(unsigned) &&
                      sizeof(TerminalFlow) == sizeof(unsigned),
                  "a word is kept as an enum");
    return sizes[kind];
}

static bool parse_seed(const char *text, uint64_t *seed)
{
    if (*text < '0' || *text > '9')
        return false;
    char *end;
    errno = 0;
    *seed = strtoull(text, &end, 10);
    return *end == '\0' && errno == 0;
}

static bool parse_word(const char *text, const char *const *words, unsigned *word)
{
    for (*word = 0; words[*word]; ++*word)
        if (strcmp(text, words[*word]) == 0)
            return true;
    return false;
}

static bool parse_value(const Key *key, const char *text, Value *value)
{
    if (key->kind == KEY_SEED)
        return parse_seed(text, &value->seed);
    if (key->kind == KEY_WORD)
        return parse_word(text, key->words, &value->word);
    double number;
    if (!number_parse(text, &number) || !key->allows(number))
        return false;
    if (key->kind == KEY_DIMENSION)
        value->dimension = (int)number;
    else
        value->number = number;
    return true;
}

/* The value of a "key: value" line without blanks around it, cut at `size`. */
static void value_text(const Key *key, const char *line, char *out, size_t size)
{
    const char *text = swc_value_of(line, key->name);
    size_t length = strlen(text);
    while (length && strchr(blanks, text[length - 1]))
        length--;
    snprintf(out, size, "%.*s", (int)(length < size ? length : size - 1), text);
}

Status swc_key_parse(TreeHeader *header, int key_number, const char *line, Err *err)
{
    const Key *key = &keys[key_number];
    char text[400];
    value_text(key, line, text, sizeof text);
    Value value = {0};
    if (!parse_value(key, text, &value))
        return err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be %s", key->name, text,
                       key->allowed);
    bool *flag = (bool *)((char *)header + key->flag);
    void *field = (char *)header + key->field;
    if (*flag && memcmp(field, &value, value_size(key->kind)) != 0)
        return err_set(err, STATUS_INPUT, "%s is '%.40s', but an earlier line says otherwise",
                       key->name, text);
    *flag = true;
    memcpy(field, &value, value_size(key->kind));
    return STATUS_OK;
}

bool swc_key_known(const TreeHeader *header, int key)
{
    return *(const bool *)((const char *)header + keys[key].flag);
}

void swc_key_write(const TreeHeader *header, int key_number, FILE *stream)
{
    const Key *key = &keys[key_number];
    Value value = {0};
    memcpy(&value, (const char *)header + key->field, value_size(key->kind));
    fprintf(stream, "# %s: ", key->name);
    char number[NUMBER_TEXT_SIZE];
    if (key->kind == KEY_SEED)
        fprintf(stream, "%" PRIu64 "\n", value.seed);
    else if (key->kind == KEY_DIMENSION)
        fprintf(stream, "%d\n", value.dimension);
    else if (key->kind == KEY_WORD)
        fprintf(stream, "%s\n", key->words[value.word]);
    else
        fprintf(stream, "%s\n", number_text(value.number, number));
}
