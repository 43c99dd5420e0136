/* Parses the command line and the recipe of a command, and finds options by name.
 *
 * The command line has `--name value`, `--name=value`, `-o value`, `-h`, and operands, in any
 * order. Words after `--` are operands. The recipe is read after the command line, and sets only
 * options that the command line has not set.
 *
 * A recipe is an INI file with one `name = value` per line; an option that is given several times
 * has several lines. Lines before the first [COMMAND] apply to any command; lines below it apply to
 * that command only. */
#include "options/options.h"

#include "options/output.h"
#include "options/reading.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const Option common_options[] = {
    {.name = "recipe",
     SETS(INPUT, Common, recipe),
     .group = GROUP_RUN,
     .aside = true,
     .help = "read options from FILE: one `name = value` per line, without the leading dashes of "
             "the name; an option that takes no value is set to on: `quiet = on`. Options on the "
             "command line take precedence"},
    {.name = "dump-recipe",
     SETS(FLAG, Common, dump),
     .group = GROUP_RUN,
     .aside = true,
     .help = "print the values of all options, defaults included, as a recipe (a file for "
             "--recipe) on standard output, such as `--dump-recipe > all.ini`. The command still "
             "runs, so it needs its operands and -o (in `corcast info` also --stats). If it "
             "prints a result on standard output, too, delete the result from the recipe"},
    {.name = "seed",
     SETS(SEED, Common, seed),
     .group = GROUP_RUN,
     .when = WHEN(OWN_SEED),
     .help = "seed of the random numbers, an integer; runs with the same seed make the same "
             "random choices"},
    {.name = "threads",
     SETS(WHOLE, Common, threads),
     FROM_TO(0, 256),
     .group = GROUP_RUN,
     .aside = true,
     .help = "number of threads; 0 uses one thread per processor"},
    {.name = "quiet",
     SETS(FLAG, Common, quiet),
     .group = GROUP_RUN,
     .aside = true,
     .help = "print no progress and no summary; warnings and errors are still printed"},
    {.name = "help",
     SETS(FLAG, Common, help),
     .group = GROUP_RUN,
     .aside = true,
     .help = "print this help; -h does the same"},
};

static const OptionTable common_table = OPTION_TABLE(common_options);

/* ---- settings -------------------------------------------------------------------------------- */

/* Adds the options of a table except those in the list `without`. */
static void bind(Parsed *parsed, const OptionTable *table, const char *without, void *base)
{
    for (size_t i = 0; i < table->n; i++)
        if (!wordlist_has(without, table->options[i].name))
            parsed->settings[parsed->n_settings++] =
                (Setting){.option = &table->options[i], .base = base};
}

Status parsed_init(Parsed *parsed, const Command *command, Err *err)
{
    *parsed = (Parsed){.command = command, .common = {.seed = 1}};
    size_t n = common_table.n + reading_table.n;
    for (int t = 0; t < MAX_TABLES && command->tables[t].table; t++)
        n += command->tables[t].table->n;
    TRY(mem_calloc(&parsed->settings, n, sizeof *parsed->settings, "options", err));
    Status status = mem_calloc(&parsed->options, 1, command->size, "options", err);
    if (status != STATUS_OK) {
        parsed_release(parsed);
        return status;
    }
    if (command->set_defaults)
        command->set_defaults(parsed->options);
    for (int t = 0; t < MAX_TABLES && command->tables[t].table; t++)
        bind(parsed, command->tables[t].table, t > 0 ? command->without : NULL,
             (char *)parsed->options + command->tables[t].at);
    if (command->reads_tree)
        bind(parsed, &reading_table, NULL, &parsed->reading);
    bind(parsed, &common_table, NULL, &parsed->common);
    return STATUS_OK;
}

struct OwnedText {
    OwnedText *next;
    char value[];
};

static void release_texts(OwnedText *text)
{
    while (text) {
        OwnedText *next = text->next;
        free(text);
        text = next;
    }
}

void parsed_release(Parsed *parsed)
{
    release_texts(parsed->texts);
    free(parsed->common.recipe_text);
    free(parsed->settings);
    free(parsed->options);
    files_release(&parsed->files);
    *parsed = (Parsed){0};
}

const char parsed_memory[] = "the tree";

void parsed_give(Parsed *parsed, const Tree *tree, const char *name)
{
    const Setting *from = parsed_find(parsed, "from", strlen("from"));
    parsed->given = tree;
    parsed->given_name = name ? name : parsed_memory;
    if (parsed->command->max_operands > 0) {
        parsed->operands[0] = parsed->given_name;
        parsed->n_operands = 1;
    } else if (from) {
        parsed->given_name = name ? name : from->option->argument;
        *(const char **)(void *)(from->base + from->option->where) = parsed->given_name;
    }
}

static bool is_text(const char *known, const char *name, size_t length)
{
    return known && strlen(known) == length && strncmp(known, name, length) == 0;
}

bool option_is_named(const Option *option, const char *name, size_t length)
{
    return is_text(option->name, name, length) || is_text(option->former, name, length);
}

static Setting *find(const Parsed *parsed, const char *name, size_t length)
{
    for (size_t i = 0; i < parsed->n_settings; i++)
        if (option_is_named(parsed->settings[i].option, name, length))
            return &parsed->settings[i];
    return NULL;
}

bool setting_is_common(const Parsed *parsed, const Setting *setting)
{
    return setting->base == (const char *)&parsed->common;
}

const Setting *parsed_find(const Parsed *parsed, const char *name, size_t length)
{
    return find(parsed, name, length);
}

const char *parsed_text(const Parsed *parsed, const char *name)
{
    const Setting *setting = parsed_find(parsed, name, strlen(name));
    return setting ? *(const char *const *)(setting->base + setting->option->where) : NULL;
}

/* Appends the most similar option, if one is similar, to the error sentence. Returns
 * STATUS_USAGE. */
static Status suggest_option(const Parsed *parsed, const char *name, size_t length,
                             const char *prefix, Err *err)
{
    Suggestion suggestion = suggestion_start(name, length);
    for (size_t i = 0; i < parsed->n_settings; i++)
        suggestion_offer(&suggestion, parsed->settings[i].option->name);
    suggestion_append(&suggestion, prefix, err);
    return STATUS_USAGE;
}

/* ---- recipes --------------------------------------------------------------------------------- */

/* Skips sections of other commands. A section that names no command is an error. */
static Status take_recipe_line(void *user, const char *section, const char *name, const char *value,
                               Err *err)
{
    const Parsed *parsed = user;
    const Command *command = parsed->command;
    if (*section && strcmp(section, command->name) != 0)
        return name || !parsed->find_command || parsed->find_command(section)
                   ? STATUS_OK
                   : err_set(err, STATUS_USAGE, "[%s] is not the name of a command", section);
    if (!name)
        return STATUS_OK;
    Setting *setting = find(parsed, name, strlen(name));
    if (setting && setting->typed)
        return STATUS_OK;
    if (!setting || strcmp(name, "recipe") == 0 || strcmp(name, "help") == 0) {
        (void)err_set(err, STATUS_USAGE, "'%s' is not an option of %s%s", name, command->name,
                      setting ? " that a recipe may give" : "");
        return setting ? STATUS_USAGE : suggest_option(parsed, name, strlen(name), "", err);
    }
    setting->said = true;
    return setting_read(setting, value, err);
}

static Status read_recipe(Parsed *parsed, Err *err)
{
    if (!parsed->common.recipe || parsed->common.recipe_text)
        return STATUS_OK;
    return ini_read(parsed->common.recipe, "a recipe", take_recipe_line, parsed,
                    &parsed->common.recipe_text, err);
}

static void put_key(const Setting *setting, Text *text)
{
    for (size_t at = 0; at < setting_count(setting); at++) {
        text_printf(text, "%s = ", setting->option->name);
        setting_put(setting, at, text);
        text_puts(text, "\n");
    }
}

/* The default value of an option that is not given applies, and is written, unless Option.otherwise
 * states that something else applies. */
void options_put_keys(const Parsed *parsed, OptionIsKey *is_key, Text *text)
{
    Parsed defaults;
    if (parsed_init(&defaults, parsed->command, NULL) != STATUS_OK) {
        text_puts(text, NULL);
        return;
    }
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Option *option = parsed->settings[i].option;
        const bool holds = !option->has_given && !option->otherwise;
        if (is_key(option) &&
            (holds || setting_differs(&parsed->settings[i], &defaults.settings[i], text)))
            put_key(&parsed->settings[i], text);
    }
    parsed_release(&defaults);
}

static bool is_of_result(const Option *option)
{
    return !option->aside && option->kind != OPTION_OUTPUT && option->kind != OPTION_FOLDER;
}

void options_put_recipe(const Parsed *parsed, Text *text)
{
    const Command *command = parsed->command;
    text_printf(text, "; corcast " CORCAST_VERSION ": %s %s --recipe FILE\n[%s]\n", command->name,
                command->operands, command->name);
    options_put_keys(parsed, is_of_result, text);
}

/* ---- the command line ------------------------------------------------------------------------ */

typedef struct Role {
    char text[40]; /* "--json" */
} Role;

static Role role_of(const Option *option)
{
    Role role;
    bool output = strcmp(option->name, "output") == 0;
    snprintf(role.text, sizeof role.text, "%s%s", output ? "" : "--", output ? "-o" : option->name);
    return role;
}

/* Returns true if the word after a switch is its value, and not another option or a file. */
static bool is_value_of_switch(const char *word)
{
    return *word && *word != '-' && !strpbrk(word, "./");
}

/* An option as it stands on the command line. */
typedef struct Written {
    const char *name;
    size_t length;
    const char *value; /* after '='; NULL: none */
    bool is_known;     /* not a single dash before a long name */
} Written;

static Written written(const char *argument)
{
    if (strcmp(argument, "-o") == 0)
        return (Written){"output", strlen("output"), NULL, true};
    if (strcmp(argument, "-h") == 0)
        return (Written){"help", strlen("help"), NULL, true};
    if (argument[1] != '-')
        return (Written){argument + 1, strlen(argument + 1), NULL, false};
    const char *equals = strchr(argument, '=');
    size_t length = equals ? (size_t)(equals - argument - 2) : strlen(argument + 2);
    return (Written){argument + 2, length, equals ? equals + 1 : NULL, true};
}

/* Sets *value to the value of an option, which may be the next argument. */
static Status take_value(const Option *option, const Written *as, int argc, char **argv, int *at,
                         const char **value, Err *err)
{
    const char *next = *at + 1 < argc ? argv[*at + 1] : NULL;
    *value = as->value;
    if (option->kind == OPTION_FLAG && as->value)
        return err_set(err, STATUS_USAGE, "--%s takes no value", option->name);
    if (as->value)
        return STATUS_OK;
    if (option->kind == OPTION_FLAG ||
        (option->kind == OPTION_SWITCH && !is_value_of_switch(next ? next : "")))
        *value = "on";
    else if (!next)
        return err_set(err, STATUS_USAGE, "--%s needs a value", option->name);
    else
        *value = argv[++*at];
    return STATUS_OK;
}

/* Returns STATUS_USAGE for an unknown option, with the most similar option if one is similar.
 * `written` is the whole argument; `name` and `length` are the name in it. */
static Status unknown_option(const Parsed *parsed, const char *written, const char *name,
                             size_t length, Err *err)
{
    (void)err_set(err, STATUS_USAGE, "unknown option '%s'; `corcast %s --help` lists the options",
                  written, parsed->command->name);
    return suggest_option(parsed, name, length, "--", err);
}

static Status set_value(Setting *setting, const char *value, Err *err)
{
    TRY(setting_read(setting, value, err));
    setting->typed = setting->said = true;
    return STATUS_OK;
}

static Status read_option(Parsed *parsed, int argc, char **argv, int *at, Err *err)
{
    const Written as = written(argv[*at]);
    Setting *setting = find(parsed, as.name, as.length);
    if (!setting || !as.is_known)
        return unknown_option(parsed, argv[*at], as.name, as.length, err);
    const char *value;
    TRY(take_value(setting->option, &as, argc, argv, at, &value, err));
    if (setting->typed && option_is_path(setting->option))
        return err_set(err, STATUS_USAGE, "%s occurs twice; use it once",
                       role_of(setting->option).text);
    return set_value(setting, value, err);
}

static Status read_arguments(Parsed *parsed, int argc, char **argv, Err *err)
{
    const Command *command = parsed->command;
    bool only_operands = false;
    for (int i = 0; i < argc; i++) {
        if (!only_operands && strcmp(argv[i], "--") == 0) {
            only_operands = true;
        } else if (!only_operands && argv[i][0] == '-' && argv[i][1] != '\0') {
            TRY(read_option(parsed, argc, argv, &i, err));
        } else if (parsed->n_operands == command->max_operands) {
            return err_set(err, STATUS_USAGE, "unexpected argument '%s'; usage: corcast %s %s",
                           argv[i], command->name, command->operands);
        } else {
            parsed->operands[parsed->n_operands++] = argv[i];
        }
    }
    return STATUS_OK;
}

/* Notes the file that an option names, if the file is written or read as `is_written` says. */
static Status note_file(const Setting *setting, bool is_written, Files *files, Err *err)
{
    const Option *option = setting->option;
    if (!option_is_path(option) || option->kind == OPTION_FOLDER)
        return STATUS_OK;
    const char *path = *(const char **)(setting->base + option->where);
    if (!path || (option->kind == OPTION_LOOKUP && !strchr(path, '/')))
        return STATUS_OK;
    if (is_written != (option->kind == OPTION_OUTPUT))
        return STATUS_OK;
    return is_written ? files_add_output(files, role_of(option).text, path, err)
                      : files_add_input(files, role_of(option).text, path, err);
}

/* Notes all files of the command. Files to read come first, so that an error about a file that is
 * both read and written names the output. */
static Status note_files(Parsed *parsed, Err *err)
{
    Files *files = &parsed->files;
    int read = parsed->command->writes_last ? parsed->n_operands - 1 : parsed->n_operands;
    if (parsed->command->is_lookup)
        return STATUS_OK;
    for (int i = parsed->given != NULL; i < read; i++)
        TRY(files_add_input(files, "the input", parsed->operands[i], err));
    for (int is_written = 0; is_written < 2; is_written++)
        for (size_t i = 0; i < parsed->n_settings; i++)
            TRY(note_file(&parsed->settings[i], is_written, files, err));
    for (int i = read; i < parsed->n_operands; i++)
        TRY(files_add_output(files, "the output", parsed->operands[i], err));
    return STATUS_OK;
}

/* Returns STATUS_USAGE if --output or an operand is missing. */
static Status check_present(const Parsed *parsed, Err *err)
{
    const Command *command = parsed->command;
    const Setting *output = find(parsed, "output", strlen("output"));
    if (command->needs_output && !parsed->in_memory && setting_count(output) == 0)
        return err_set(err, STATUS_USAGE, "-o %s is missing; usage: corcast %s %s",
                       output->option->argument, command->name, command->operands);
    if (!parsed->in_memory && parsed->n_operands < command->min_operands)
        return err_set(err, STATUS_USAGE, "a file is missing; usage: corcast %s %s", command->name,
                       command->operands);
    return STATUS_OK;
}

const char *options_output(const Parsed *parsed)
{
    const Setting *output = find(parsed, "output", strlen("output"));
    if (parsed->command->writes_last && parsed->n_operands > 0)
        return parsed->operands[parsed->n_operands - 1];
    return output ? *(const char *const *)(output->base + output->option->where) : NULL;
}

/* Derives the pixels of a size on paper from its lengths and resolution. */
static Status find_pixels(const Option *option, PictureSize *size, Err *err)
{
    enum { PAPER_DPI = 300 }; /* the resolution that most publishers require */
    if (!size_is_on_paper(size))
        return STATUS_OK;
    size->dpi = size->has_dpi ? size->dpi : PAPER_DPI;
    for (int i = 0; i < 2; i++) {
        double pixels = round(size->mm[i] / MM_PER_INCH * size->dpi);
        char range[RANGE_TEXT_SIZE];
        if (!range_has(*option_range(option), pixels))
            return err_set(err, STATUS_USAGE, "--%s: %g mm at %g dpi are %.10g pixels, not %s",
                           option->name, size->mm[i], size->dpi, pixels,
                           range_text(*option_range(option), range));
        size->pixels[i] = (int)pixels;
    }
    return STATUS_OK;
}

Status options_settle(const Parsed *parsed, Err *err)
{
    for (int t = 0; t < MAX_TABLES && parsed->command->tables[t].table; t++) {
        const OptionTable *table = parsed->command->tables[t].table;
        if (table->settle)
            TRY(table->settle((char *)parsed->options + parsed->command->tables[t].at, parsed,
                              err));
    }
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        if (setting->option->kind == OPTION_SIZE)
            TRY(find_pixels(setting->option, (void *)(setting->base + setting->option->where),
                            err));
    }
    return STATUS_OK;
}

Status options_finish(Parsed *parsed, Err *err)
{
    TRY(read_recipe(parsed, err));
    TRY(options_settle(parsed, err));
    TRY(check_present(parsed, err));
    TRY(note_files(parsed, err));
    return parsed->command->own_check ? STATUS_OK : options_check(parsed, err);
}

Status options_parse(Parsed *parsed, int argc, char **argv, Err *err)
{
    TRY(read_arguments(parsed, argc, argv, err));
    return parsed->common.help ? STATUS_OK : options_finish(parsed, err);
}

/* ---- options by name ------------------------------------------------------------------------- */

/* Copies a value, which options of text kinds point into. */
static Status keep_text(Parsed *parsed, const char *chars, const char **kept, Err *err)
{
    size_t size = strlen(chars) + 1;
    OwnedText *kept_text;
    TRY(mem_alloc(&kept_text, 1, sizeof *kept_text + size, "a value", err));
    memcpy(kept_text->value, chars, size);
    kept_text->next = parsed->texts;
    parsed->texts = kept_text;
    *kept = kept_text->value;
    return STATUS_OK;
}

static Status find_named(const Parsed *parsed, const char *name, Setting **setting, Err *err)
{
    char written[64];
    *setting = find(parsed, name, strlen(name));
    snprintf(written, sizeof written, "--%s", name);
    return *setting ? STATUS_OK : unknown_option(parsed, written, name, strlen(name), err);
}

Status options_set(Parsed *parsed, const char *name, const char *value, Err *err)
{
    Setting *setting;
    const char *kept;
    TRY(find_named(parsed, name, &setting, err));
    TRY(keep_text(parsed, value, &kept, err));
    return set_value(setting, kept, err);
}

Status options_get(const Parsed *parsed, const char *name, Text *text, Err *err)
{
    Setting *setting;
    TRY(find_named(parsed, name, &setting, err));
    for (size_t at = 0; at < setting_count(setting); at++) {
        text_puts(text, at ? "\n" : "");
        setting_put(setting, at, text);
    }
    return text_check(text, err);
}

/* ---- what was given -------------------------------------------------------------------------- */

bool options_typed(const Parsed *parsed, const char *name)
{
    const Setting *setting = find(parsed, name, strlen(name));
    return setting && setting->typed;
}

bool options_specified(const Parsed *parsed, const char *name)
{
    const Setting *setting = find(parsed, name, strlen(name));
    return setting && setting->said;
}

/* ---- fields ---------------------------------------------------------------------------------- */

/* Returns true if the field is the option's name, or the name and the unit: `min_radius_mm`. */
static bool is_called(const Option *option, const char *field, size_t length)
{
    const char *unit = option_unit(option);
    char name[128];
    size_t bare = strlen(option->name), i = 0;
    snprintf(name, sizeof name, "%s-%s", option->name, unit ? unit : "");
    while (name[i] && i < length &&
           (tolower((unsigned char)name[i]) == tolower((unsigned char)field[i]) ||
            (field[i] == '_' && strchr("-/", name[i]))))
        i++;
    return i == length && (i == bare || (unit && !name[i]));
}

static bool sets(const Option *option, const char *field, size_t length)
{
    const char *dot = strrchr(option->member, '.'), *member = dot ? dot + 1 : option->member;
    return (strlen(member) == length && strncmp(member, field, length) == 0) ||
           is_called(option, field, length);
}

/* Appends `n` characters, or as many as fit in the sentence. */
static void append(Err *sentence, const char *chars, size_t n)
{
    size_t length = strlen(sentence->text), room = sizeof sentence->text - 1 - length;
    memcpy(sentence->text + length, chars, n < room ? n : room);
}

/* Allocates nothing, because the error may be that memory ran out. */
void options_name_fields(const Parsed *parsed, Err *err)
{
    Err named = {{0}};
    const char *rest = err->text;
    for (const char *open; (open = strchr(rest, '`')); rest = open + 1) {
        const char *field = open + 1, *option = NULL;
        size_t length = strspn(field, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_");
        for (size_t i = 0; i < parsed->n_settings && field[length] == '`' && !option; i++)
            if (sets(parsed->settings[i].option, field, length))
                option = parsed->settings[i].option->name;
        append(&named, rest, (size_t)(open - rest));
        append(&named, option ? "--" : "`", option ? 2 : 1);
        append(&named, option ? option : "", option ? strlen(option) : 0);
        open = option ? field + length : open;
    }
    append(&named, rest, strlen(rest));
    *err = named;
}
