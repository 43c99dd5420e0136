/* Holds, parses and checks the metadata of a tree: values of known keys, and remarks.
 *
 * Values are stored in arrays indexed by key, not in a member per key. Reading, writing, checking
 * and overriding are then each one loop, or one lookup, for all keys. The position of a key in its
 * file is stored apart from its value: a tree that the program makes has no lines, and is written
 * in the order of the table. */
#include "tree/meta.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const viscosity_law_names[] = {
    [VISCOSITY_CONSTANT] = "constant", [VISCOSITY_PRIES] = "pries", NULL};
const char *const terminal_flow_names[] = {[TERMINAL_FLOW_EQUAL] = "equal",
                                           [TERMINAL_FLOW_TERRITORY] = "territory",
                                           [TERMINAL_FLOW_DEMAND] = "demand",
                                           NULL};

const MetaRow meta_rows[META_KEYS] = {
    [META_GENERATOR] = {.name = "generator",
                        .meaning = "program and version that made the tree",
                        .kind = META_TEXT},
    [META_COMMAND] = {.name = "command",
                      .meaning = "command line that made the tree",
                      .kind = META_LINES},
    [META_SEED] = {.name = "seed", .meaning = "seed of the random numbers", .kind = META_BITS},
    [META_DIMENSION] = {.name = "dimension",
                        .meaning = "dimension of the tissue",
                        .kind = META_WHOLE,
                        .range = {2, 3}},
    [META_DOMAIN] = {.name = "domain",
                     .meaning = "tissue that the tree supplies",
                     .kind = META_TEXT},
    [META_GAMMA] = {.name = "gamma", .meaning = "Murray exponent", .range = {RANGE_ABOVE_0, 10}},
    [META_GAMMA_BY_RADIUS] = {.name = "gamma_by_radius",
                              .meaning = "Murray exponent by the radius of the parent, mm",
                              .kind = META_CURVE,
                              .range = {RANGE_ABOVE_0, 10}},
    [META_LAMBDA] = {.name = "lambda",
                     .meaning = "exponent of the target",
                     .range = {0, RANGE_NO_END}},
    [META_P_PERF] = {.name = "p_perf_mmHg",
                     .unit = "mmHg",
                     .meaning = "pressure at the inlet",
                     .range = {-RANGE_NO_END, RANGE_NO_END}},
    [META_P_TERM] = {.name = "p_term_mmHg",
                     .unit = "mmHg",
                     .meaning = "pressure at every terminal",
                     .range = {-RANGE_NO_END, RANGE_NO_END}},
    [META_Q_PERF] = {.name = "q_perf_ml_min",
                     .unit = "ml/min",
                     .meaning = "flow through the inlet",
                     .range = {RANGE_ABOVE_0, RANGE_NO_END}},
    [META_VISCOSITY] = {.name = "viscosity_cP",
                        .unit = "cP",
                        .meaning = "viscosity of the blood",
                        .range = {RANGE_ABOVE_0, RANGE_NO_END}},
    [META_VISCOSITY_LAW] = {.name = "viscosity_law",
                            .meaning = "law of viscosity",
                            .kind = META_WORD,
                            .words = viscosity_law_names},
    [META_HEMATOCRIT] = {.name = "hematocrit",
                         .meaning = "hematocrit",
                         .range = {0, MAX_HEMATOCRIT}},
    [META_PLASMA_VISCOSITY] = {.name = "plasma_viscosity_cP",
                               .unit = "cP",
                               .meaning = "viscosity of the plasma",
                               .range = {RANGE_ABOVE_0, RANGE_NO_END}},
    [META_TERMINAL_FLOW] = {.name = "terminal_flow",
                            .meaning = "what the flow through the terminals was made after",
                            .kind = META_WORD,
                            .words = terminal_flow_names},
    [META_CLEARANCE] = {.name = "clearance_mm",
                        .unit = "mm",
                        .meaning = "least distance of the walls of vessels of different trees",
                        .range = {0, RANGE_NO_END}},
    [META_FILL] = {.name = "fill",
                   .meaning = "published table that the radii of these orders were drawn from",
                   .kind = META_TEXT},
};

void meta_release(TreeMeta *meta)
{
    for (int key = 0; key < META_KEYS; key++)
        free(meta->text[key]);
    for (size_t i = 0; i < meta->n_lines; i++)
        free(meta->line[i].text);
    free(meta->line);
    *meta = (TreeMeta){0};
}

/* Adds a line, and takes over its text. */
static Status add_line(TreeMeta *meta, MetaLine line, Err *err)
{
    Status status = STATUS_OK;
    TRY_GOTO(mem_reserve(&meta->line, &meta->lines_capacity, meta->n_lines + 1, sizeof line,
                         "header lines", err));
    meta->line[meta->n_lines++] = line;
    return STATUS_OK;
done:
    free(line.text);
    return status;
}

Status meta_copy(TreeMeta *out, const TreeMeta *meta, Err *err)
{
    TreeMeta made = *meta;
    memset(made.text, 0, sizeof made.text);
    made.line = NULL;
    made.n_lines = made.lines_capacity = 0;
    Status status = STATUS_OK;
    for (int key = 0; key < META_KEYS; key++)
        if (meta->text[key])
            TRY_GOTO(mem_strdup(&made.text[key], meta->text[key], err));
    for (size_t i = 0; i < meta->n_lines; i++) {
        MetaLine line = {.key = meta->line[i].key};
        if (meta->line[i].text)
            TRY_GOTO(mem_strdup(&line.text, meta->line[i].text, err));
        TRY_GOTO(add_line(&made, line, err));
    }
    *out = made;
done:
    if (status != STATUS_OK)
        meta_release(&made);
    return status;
}

MetaKey meta_find(const char *name, size_t length)
{
    int key = 0;
    while (key < META_KEYS &&
           (strncmp(name, meta_rows[key].name, length) != 0 || meta_rows[key].name[length] != '\0'))
        key++;
    return (MetaKey)key;
}

static size_t count_words(const MetaRow *row)
{
    size_t n = 0;
    while (row->words[n])
        n++;
    return n;
}

bool meta_allows(MetaKey key, double value)
{
    const MetaRow *row = &meta_rows[key];
    if (row->kind == META_WORD)
        return value == floor(value) && value >= 0 && value < (double)count_words(row);
    return range_has(row->range, value) && (row->kind != META_WHOLE || value == floor(value));
}

/* Appends the allowed values of a key, as the end of the sentence "it must be ...". */
static void put_allowed(MetaKey key, Text *text)
{
    const MetaRow *row = &meta_rows[key];
    char range[RANGE_TEXT_SIZE];
    if (row->kind == META_WORD)
        for (size_t i = 0; row->words[i]; i++)
            text_printf(text, "%s%s", i ? " or " : "", row->words[i]);
    else if (row->kind == META_BITS)
        text_printf(text, "an integer from 0 to %" PRIu64, UINT64_MAX);
    else if (row->kind == META_CURVE)
        text_printf(text, "MM:NUMBER,..., MM above 0 and rising, each NUMBER %s",
                    range_text(row->range, range));
    else if (*range_text(row->range, range))
        text_printf(text, "%s %s", row->kind == META_WHOLE ? "an integer" : "a number", range);
    else
        text_puts(text, "a finite number");
}

void meta_set_number(TreeMeta *meta, MetaKey key, double value)
{
    meta->known[key] = true;
    meta->number[key] = value;
}

void meta_set_seed(TreeMeta *meta, uint64_t seed)
{
    meta->known[META_SEED] = true;
    meta->seed = seed;
}

LogCurve meta_gamma(const TreeMeta *meta)
{
    if (meta->known[META_GAMMA_BY_RADIUS])
        return meta->gamma_by_radius;
    return meta->known[META_GAMMA] ? logcurve_constant(meta->number[META_GAMMA])
                                   : (LogCurve){.n = 0};
}

void meta_set_gamma(TreeMeta *meta, const LogCurve *gamma)
{
    meta->known[META_GAMMA] = gamma->n == 1;
    meta->known[META_GAMMA_BY_RADIUS] = gamma->n > 1;
    if (gamma->n == 1)
        meta->number[META_GAMMA] = gamma->value[0];
    else
        meta->gamma_by_radius = *gamma;
}

static Status check_line(const char *text, Err *err)
{
    if (strpbrk(text, "\r\n"))
        return err_set(err, STATUS_INPUT, "a header line may not hold a line end: %s", text);
    return STATUS_OK;
}

Status meta_set_text(TreeMeta *meta, MetaKey key, const char *text, Err *err)
{
    char *copy = NULL;
    TRY(check_line(text, err));
    TRY(mem_strdup(&copy, text, err));
    free(meta->text[key]);
    meta->text[key] = copy;
    meta->known[key] = true;
    return STATUS_OK;
}

Status meta_add_text(TreeMeta *meta, MetaKey key, const char *text, Err *err)
{
    MetaLine line = {.key = key};
    TRY(check_line(text, err));
    TRY(mem_strdup(&line.text, text, err));
    TRY(add_line(meta, line, err));
    if (key != META_KEYS)
        meta->known[key] = true;
    return STATUS_OK;
}

static Status refuse_value(MetaKey key, const char *value, Err *err)
{
    Text sentence = TEXT_INIT;
    text_printf(&sentence, "%s is '%.40s'; it must be ", meta_rows[key].name, value);
    put_allowed(key, &sentence);
    return text_to_error(&sentence, STATUS_INPUT, err);
}

static bool parse_bits(const char *text, uint64_t *bits)
{
    if (*text < '0' || *text > '9')
        return false;
    char *end;
    errno = 0;
    *bits = strtoull(text, &end, 10);
    return *end == '\0' && errno == 0;
}

static bool parse_word(const MetaRow *row, const char *text, double *value)
{
    size_t word = 0;
    while (row->words[word] && strcmp(text, row->words[word]) != 0)
        word++;
    *value = (double)word;
    return row->words[word] != NULL;
}

/* Sets the error that a key has two different values. */
static Status contradict(MetaKey key, const char *value, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s is '%.40s', but an earlier line has another value",
                   meta_rows[key].name, value);
}

static Status set_bits(TreeMeta *meta, MetaKey key, const char *value, Err *err)
{
    uint64_t bits;
    if (!parse_bits(value, &bits))
        return refuse_value(key, value, err);
    if (meta->known[key] && bits != meta->seed)
        return contradict(key, value, err);
    meta_set_seed(meta, bits);
    return STATUS_OK;
}

/* Sets a number or a word from a text. */
static Status set_number(TreeMeta *meta, MetaKey key, const char *value, Err *err)
{
    const MetaRow *row = &meta_rows[key];
    double number;
    bool valid = row->kind == META_WORD ? parse_word(row, value, &number)
                                        : number_parse(value, &number) && meta_allows(key, number);
    if (!valid)
        return refuse_value(key, value, err);
    if (meta->known[key] && number != meta->number[key])
        return contradict(key, value, err);
    meta_set_number(meta, key, number);
    return STATUS_OK;
}

static Status set_curve(TreeMeta *meta, MetaKey key, const char *value, Err *err)
{
    LogCurve curve;
    if (!logcurve_parse(value, meta_rows[key].range, &curve))
        return refuse_value(key, value, err);
    if (meta->known[key] && !logcurve_is_same(&curve, &meta->gamma_by_radius))
        return contradict(key, value, err);
    meta->gamma_by_radius = curve;
    meta->known[key] = true;
    return STATUS_OK;
}

static Status set_text(TreeMeta *meta, MetaKey key, const char *value, Err *err)
{
    if (meta->known[key] && strcmp(value, meta->text[key]) != 0)
        return contradict(key, value, err);
    return meta_set_text(meta, key, value, err);
}

Status meta_parse(TreeMeta *meta, MetaKey key, const char *value, Err *err)
{
    MetaKind kind = meta_rows[key].kind;
    char *copy = NULL;
    TRY(mem_strdup(&copy, value, err));
    const char *bare = text_trim(copy);
    Status status = kind == META_LINES   ? meta_add_text(meta, key, bare, err)
                    : kind == META_TEXT  ? set_text(meta, key, bare, err)
                    : kind == META_BITS  ? set_bits(meta, key, bare, err)
                    : kind == META_CURVE ? set_curve(meta, key, bare, err)
                                         : set_number(meta, key, bare, err);
    free(copy);
    TRY(status);
    return kind == META_LINES ? STATUS_OK : add_line(meta, (MetaLine){.key = key}, err);
}

void meta_put_value(const TreeMeta *meta, MetaKey key, Text *text)
{
    const MetaRow *row = &meta_rows[key];
    if (row->kind == META_BITS)
        text_printf(text, "%" PRIu64, meta->seed);
    else if (row->kind == META_WORD)
        text_puts(text, row->words[(size_t)meta->number[key]]);
    else if (row->kind == META_CURVE)
        text_logcurve(text, &meta->gamma_by_radius);
    else if (row->kind == META_NUMBER || row->kind == META_WHOLE)
        text_number(text, meta->number[key]);
    else
        text_puts(text, meta->text[key]);
}

bool meta_walk(MetaWalk *walk, MetaLine *line)
{
    const TreeMeta *meta = walk->meta;
    while (walk->at < meta->n_lines + META_KEYS) {
        size_t at = walk->at++;
        *line =
            at < meta->n_lines ? meta->line[at] : (MetaLine){.key = (MetaKey)(at - meta->n_lines)};
        if (line->key == META_KEYS || (line->text && meta->known[line->key]))
            return true;
        if (meta->known[line->key] && !walk->done[line->key] &&
            meta_rows[line->key].kind != META_LINES)
            return walk->done[line->key] = true;
    }
    return false;
}

Status meta_add_lines(TreeMeta *meta, Err *err)
{
    bool has_line[META_KEYS + 1] = {false};
    for (size_t i = 0; i < meta->n_lines; i++)
        has_line[meta->line[i].key] = true;
    for (int key = 0; key < META_KEYS; key++)
        if (meta->known[key] && !has_line[key])
            TRY(add_line(meta, (MetaLine){.key = (MetaKey)key}, err));
    return STATUS_OK;
}

/* Returns the quotation mark for the name of a value: names of options are in backquotes. */
static const char *quote_of(MetaSource source)
{
    return source == META_OF_OPTIONS ? "`" : "";
}

/* `allowed` is a format that describes the accepted numbers. */
static Status refuse_number(const TreeMeta *meta, MetaKey key, MetaSource source,
                            const char *allowed, const char *more, Err *err)
{
    char number[NUMBER_TEXT_SIZE];
    return err_set(err, source == META_OF_OPTIONS ? STATUS_USAGE : STATUS_INPUT,
                   "%s%s%s is %s; it must be %s%s", quote_of(source), meta_rows[key].name,
                   quote_of(source), number_text(meta->number[key], number), allowed, more);
}

static Status check_key(const TreeMeta *meta, MetaKey key, MetaSource source, Err *err)
{
    if (!meta->known[key])
        return err_set(err, STATUS_INPUT, "it has no header key %s, the %s", meta_rows[key].name,
                       meta_rows[key].meaning);
    if (meta_allows(key, meta->number[key]))
        return STATUS_OK;
    char range[RANGE_TEXT_SIZE];
    bool any = !*range_text(meta_rows[key].range, range);
    return refuse_number(meta, key, source, any ? "a finite number" : "a number ", range, err);
}

Status meta_check_cco(const TreeMeta *meta, MetaSource source, Err *err)
{
    static const MetaKey always[] = {META_LAMBDA, META_P_PERF, META_P_TERM, META_Q_PERF};
    if (!meta->known[META_GAMMA_BY_RADIUS])
        TRY(check_key(meta, META_GAMMA, source, err));
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        TRY(check_key(meta, always[i], source, err));
    if (!(meta->number[META_P_TERM] < meta->number[META_P_PERF])) {
        char number[NUMBER_TEXT_SIZE], below[NUMBER_TEXT_SIZE + 64];
        snprintf(below, sizeof below, "%s%s%s, which is %s", quote_of(source),
                 meta_rows[META_P_PERF].name, quote_of(source),
                 number_text(meta->number[META_P_PERF], number));
        return refuse_number(meta, META_P_TERM, source, "below ", below, err);
    }
    if (meta_number(meta, META_VISCOSITY_LAW) == VISCOSITY_CONSTANT)
        return check_key(meta, META_VISCOSITY, source, err);
    TRY(check_key(meta, META_HEMATOCRIT, source, err));
    return check_key(meta, META_PLASMA_VISCOSITY, source, err);
}
