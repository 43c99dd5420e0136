/* Reads the plan of a study, and makes the options of its runs. While the plan is read, the option
 * of each key parses the values and formats them again. Errors are therefore reported with their
 * line before a run starts, and 2.50 is the same value as 2.5. The index of a run is a number in a
 * mixed radix: each digit is the index of a value, and the last key is the lowest digit. */
#include "study/study_plan.h"

#include "options/output.h"
#include <stdlib.h>
#include <string.h>

static const Option rows[] = {
    {.name = "output",
     SETS(OUTPUT, GrowOptions, output),
     .argument = "T.swc",
     .help = "tree file to write"},
};

static const OptionTable own_table = OPTION_TABLE(rows);

static void set_defaults(void *options)
{
    GrowOptions *growth = options;
    growing_set_defaults(&growth->growing);
    growth->output = "T.swc";
}

static const Command growth_command = {
    .name = "grow",
    .reads_tree = true,
    .trees_only = true,
    .size = sizeof(GrowOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&growing_table, offsetof(GrowOptions, growing)},
               {&refining_table, offsetof(GrowOptions, refining)}},
};

/* ---- values ---------------------------------------------------------------------------------- */

/* Sets *written to the value in the form in which the option formats it. The caller frees it. */
static Status rewrite(const char *name, const char *value, char **written, Err *err)
{
    Parsed parsed;
    Text text = TEXT_INIT;
    TRY(parsed_init(&parsed, &growth_command, err));
    const Setting *setting = parsed_find(&parsed, name, strlen(name));
    Status status;
    TRY_GOTO(setting_read(setting, value, err));
    setting_put(setting, 0, &text);
    status = text_take(&text, written, err);
done:
    text_release(&text);
    parsed_release(&parsed);
    return status;
}

/* Takes ownership of `written`, also on failure. */
static Status add_written(StudyKey *key, char *written, Err *err)
{
    Status status;
    TRY_GOTO(
        mem_reserve(&key->value, &key->capacity, key->n + 1, sizeof *key->value, "values", err));
    key->value[key->n++] = written;
    written = NULL;
done:
    free(written);
    return status;
}

/* Returns true if the value is a range A..B and the option takes integers. */
static bool is_range(const Option *option, const char *value, long long *from, long long *to)
{
    const char *dots = strstr(value, "..");
    char first[24] = "";
    bool whole =
        option->kind == OPTION_SEED || option->kind == OPTION_WHOLE || option->kind == OPTION_COUNT;
    if (!whole || !dots || dots - value >= (ptrdiff_t)sizeof first)
        return false;
    memcpy(first, value, (size_t)(dots - value));
    return integer_parse(first, 0, 1000000000000, from) &&
           integer_parse(dots + 2, 0, 1000000000000, to);
}

/* Adds all values of a range. The option parses only the two ends, because an option that accepts
 * both accepts all integers between them. */
static Status add_range(StudyKey *key, const char *range, long long from, long long to, Err *err)
{
    if (to < from)
        return err_set(err, STATUS_INPUT,
                       "%s: the range %s is empty: its first value is above its last", key->name,
                       range);
    if (to - from >= STUDY_MAX_RUNS)
        return err_set(err, STATUS_INPUT, "%s: the range %s has more than %d values", key->name,
                       range, STUDY_MAX_RUNS);
    for (long long i = from; i <= to; i++) {
        char number[24], *written = NULL;
        snprintf(number, sizeof number, "%lld", i);
        TRY(i == from || i == to ? rewrite(key->name, number, &written, err)
                                 : mem_strdup(&written, number, err));
        TRY(add_written(key, written, err));
    }
    return STATUS_OK;
}

static Status add_values(StudyKey *key, const Option *option, const char *value, Err *err)
{
    long long from, to;
    char *written = NULL;
    if (is_range(option, value, &from, &to))
        return add_range(key, value, from, to, err);
    TRY(rewrite(key->name, value, &written, err));
    return add_written(key, written, err);
}

/* Returns the comma that ends the first value of a list: the first comma before a blank or before
 * the end of the list; NULL if there is none. */
static char *end_of_value(char *list)
{
    char *comma = strchr(list, ',');
    while (comma && comma[1] && !strchr(TEXT_BLANKS, comma[1]))
        comma = strchr(comma + 1, ',');
    return comma;
}

/* Adds the values of a list. Commas within a value, as in "1,2,3", are followed by no blank. */
static Status add_list(StudyKey *key, const Option *option, const char *list, Err *err)
{
    char *copy = NULL;
    TRY(mem_strdup(&copy, list, err));
    Status status = STATUS_OK;
    for (char *rest = copy; rest;) {
        char *comma = end_of_value(rest);
        if (comma)
            *comma = '\0';
        char *value = text_trim(rest);
        if (!*value)
            TRY_GOTO(err_set(err, STATUS_INPUT, "%s: a value is missing", key->name));
        TRY_GOTO(add_values(key, option, value, err));
        rest = comma ? comma + 1 : NULL;
    }
done:
    free(copy);
    return status;
}

/* Compares strings for qsort. */
static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static Status check_different(const StudyKey *key, Err *err)
{
    char **sorted = NULL;
    TRY(mem_calloc(&sorted, key->n, sizeof *sorted, "values", err));
    memcpy(sorted, key->value, key->n * sizeof *sorted);
    qsort(sorted, key->n, sizeof *sorted, by_text);
    Status status = STATUS_OK;
    for (size_t i = 1; i < key->n; i++)
        if (strcmp(sorted[i - 1], sorted[i]) == 0)
            TRY_GOTO(
                err_set(err, STATUS_INPUT, "%s: the value %s occurs twice", key->name, sorted[i]));
done:
    free(sorted);
    return status;
}

/* ---- the file -------------------------------------------------------------------------------- */

typedef struct PlanReading {
    StudyPlan *plan;
    const Parsed *options; /* of `grow` */
    bool in_section;
} PlanReading;

/* Finds the option of a key. `others` are options of grow that a plan may not set. Errors:
 * STATUS_USAGE if there is none that a plan may set. */
static Status find_option(const PlanReading *reading, const char *name, const Option **option,
                          Err *err)
{
    static const char *const others[] = {"output", "refine-seconds", "recipe", "threads",
                                         "quiet",  "help",           NULL};
    const Setting *setting = parsed_find(reading->options, name, strlen(name));
    if (setting && !is_one_of(name, others)) {
        *option = setting->option;
        return STATUS_OK;
    }
    Suggestion suggestion = suggestion_start(name, strlen(name));
    for (size_t i = 0; i < reading->options->n_settings; i++)
        if (!is_one_of(reading->options->settings[i].option->name, others))
            suggestion_offer(&suggestion, reading->options->settings[i].option->name);
    Status status = err_set(err, STATUS_USAGE,
                            setting ? "a plan cannot set the option '%.40s' of grow"
                                    : "'%.40s' is not an option of grow",
                            name);
    suggestion_append(&suggestion, "", err);
    return status;
}

static Status add_key(StudyPlan *plan, const char *name, StudyKey **key, Err *err)
{
    for (size_t k = 0; k < plan->n; k++)
        if (strcmp(plan->key[k].name, name) == 0)
            return err_set(err, STATUS_INPUT, "'%s' occurs twice; write all its values in one line",
                           name);
    TRY(mem_reserve(&plan->key, &plan->capacity, plan->n + 1, sizeof *plan->key, "keys", err));
    *key = &plan->key[plan->n];
    **key = (StudyKey){0};
    TRY(mem_strdup(&(*key)->name, name, err));
    plan->n++;
    return STATUS_OK;
}

/* A callback of ini_read: takes one line "name = values". */
static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    PlanReading *reading = user;
    StudyPlan *plan = reading->plan;
    const Option *option = NULL;
    StudyKey *key = NULL;
    if (strcmp(section, "grow") != 0)
        return err_set(err, STATUS_INPUT, "%s%.40s%s; a plan has one section, [grow]",
                       *section ? "[" : "'", *section ? section : name,
                       *section ? "] is not a section of a plan" : "' is above [grow]");
    if (!name && reading->in_section)
        return err_set(err, STATUS_INPUT, "the section [grow] occurs twice");
    reading->in_section = true;
    if (!name)
        return STATUS_OK;
    TRY(find_option(reading, name, &option, err));
    TRY(add_key(plan, name, &key, err));
    TRY(add_list(key, option, value, err));
    TRY(check_different(key, err));
    if (key->n > STUDY_MAX_RUNS / plan->runs)
        return err_set(err, STATUS_INPUT, "%s: the plan has more than %d combinations", name,
                       STUDY_MAX_RUNS);
    plan->runs *= key->n;
    return STATUS_OK;
}

static HashText hash_of(const StudyPlan *plan)
{
    Hash hash;
    hash_begin(&hash);
    hash_add_text(&hash, GENERATOR);
    for (size_t k = 0; k < plan->n; k++) {
        hash_add_text(&hash, plan->key[k].name);
        for (size_t i = 0; i < plan->key[k].n; i++)
            hash_add_text(&hash, plan->key[k].value[i]);
        hash_add_text(&hash, "");
    }
    return hash_finish(&hash);
}

Status study_plan_read(const char *path, StudyPlan *plan, Err *err)
{
    StudyPlan made = {.runs = 1};
    Parsed options;
    TRY(parsed_init(&options, &growth_command, err));
    PlanReading reading = {.plan = &made, .options = &options};
    Status status;
    TRY_GOTO(ini_read(path, "a plan", take_line, &reading, NULL, err));
    if (made.n == 0)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: sets no option of grow", path));
    made.hash = hash_of(&made);
    *plan = made;
    made = (StudyPlan){0};
done:
    parsed_release(&options);
    study_plan_release(&made);
    return status;
}

void study_plan_release(StudyPlan *plan)
{
    for (size_t k = 0; k < plan->n; k++) {
        for (size_t i = 0; i < plan->key[k].n; i++)
            free(plan->key[k].value[i]);
        free(plan->key[k].value);
        free(plan->key[k].name);
    }
    free(plan->key);
    *plan = (StudyPlan){0};
}

/* ---- runs ------------------------------------------------------------------------------------ */

const char *study_plan_value(const StudyPlan *plan, size_t run, size_t k)
{
    for (size_t last = plan->n - 1; last > k; last--)
        run /= plan->key[last].n;
    return plan->key[k].value[run % plan->key[k].n];
}

Status study_plan_options(const StudyPlan *plan, size_t run, int threads, Parsed *parsed, Err *err)
{
    TRY(parsed_init(parsed, &growth_command, err)); /* `parsed` must not move afterwards, because
                                                     * settings point into it */
    parsed->common.quiet = true;
    parsed->common.threads = threads;
    Status status = STATUS_OK;
    for (size_t k = 0; k < plan->n; k++) {
        const char *name = plan->key[k].name;
        TRY_GOTO(setting_read(parsed_find(parsed, name, strlen(name)),
                              study_plan_value(plan, run, k), err));
    }
    return STATUS_OK;
done:
    parsed_release(parsed);
    return status;
}
