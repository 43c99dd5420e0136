#include "app/options.h"

#include "app/commands.h"
#include "app/suggest.h"
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    const Command *command;
    const Option *tables[MAX_TABLES + 1];
    int n_tables;
    Err *err;
} Reader;

static const Option *find_option(const Reader *reader, const char *name, size_t length)
{
    for (int t = 0; t < reader->n_tables; t++)
        for (const Option *option = reader->tables[t]; option->name; option++)
            if (strlen(option->name) == length && strncmp(option->name, name, length) == 0)
                return option;
    return NULL;
}

/* STATUS_USAGE with the sentence that is there already and the option that may have been meant. */
static Status suggest_option(const Reader *reader, const char *name, size_t length,
                             const char *prefix, Err *err)
{
    Suggestion suggestion = suggestion_for(name, length);
    for (int t = 0; t < reader->n_tables; t++)
        for (const Option *option = reader->tables[t]; option->name; option++)
            suggestion_offer(&suggestion, option->name);
    suggestion_add(&suggestion, prefix, err);
    return STATUS_USAGE;
}

/* Reads `count` numbers parted by `separator`; the last ones may be missing down to `least`. */
static bool read_numbers(const char *text, char separator, int least, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        const char *end = strchr(text, separator);
        size_t length = end && i + 1 < count ? (size_t)(end - text) : strlen(text);
        char number[64];
        if (length >= sizeof number)
            return false;
        memcpy(number, text, length);
        number[length] = '\0';
        if (!number_parse(number, &out[i]) || !isfinite(out[i]))
            return false;
        text += length;
        if (*text == '\0')
            return i + 1 >= least;
        text++;
    }
    return false;
}

static Status wrong(const Option *option, const char *value, const char *allowed, Err *err)
{
    return err_set(err, STATUS_USAGE, "--%s: '%s' is not %s", option->name, value, allowed);
}

static Status set_choice(const Option *option, const char *value, Err *err)
{
    Text list = TEXT_INIT;
    for (int i = 0; option->choices[i]; i++) {
        if (strcmp(option->choices[i], value) == 0) {
            text_release(&list);
            *(int *)option->where = i;
            return STATUS_OK;
        }
        text_printf(&list, "%s%s", i ? ", " : "one of ", option->choices[i]);
    }
    Status status = text_check(&list, err);
    if (status == STATUS_OK)
        status = wrong(option, value, text_chars(&list), err);
    text_release(&list);
    return status;
}

static Status set_whole(const Option *option, const char *value, Err *err)
{
    long long number;
    if (!integer_parse(value, (long long)option->low, (long long)option->high, &number)) {
        char allowed[96];
        snprintf(allowed, sizeof allowed, "a whole number from %.0f to %.0f", option->low,
                 option->high);
        return wrong(option, value, allowed, err);
    }
    if (option->kind == OPTION_WHOLE)
        *(int *)option->where = (int)number;
    else
        *(size_t *)option->where = (size_t)number;
    return STATUS_OK;
}

static Status set_number(const Option *option, const char *value, Err *err)
{
    double number;
    if (number_parse(value, &number) && isfinite(number) && number >= option->low &&
        number <= option->high) {
        *(double *)option->where = number;
        return STATUS_OK;
    }
    char allowed[96];
    if (option->high >= 1e300)
        snprintf(allowed, sizeof allowed,
                 option->low <= -1e300 ? "a number" : "a number of at least %g", option->low);
    else
        snprintf(allowed, sizeof allowed, "a number from %g to %g", option->low, option->high);
    return wrong(option, value, allowed, err);
}

static Status set_size(const Option *option, const char *value, Err *err)
{
    double size[2];
    for (int i = 0; i < 2; i++)
        size[i] = 0;
    bool read = read_numbers(value, 'x', 2, 2, size);
    for (int i = 0; i < 2; i++)
        read = read && size[i] >= 1 && size[i] <= option->high && size[i] == floor(size[i]);
    if (!read) {
        char allowed[96];
        snprintf(allowed, sizeof allowed,
                 "WIDTHxHEIGHT in pixels, each a whole number from 1 to %.0f", option->high);
        return wrong(option, value, allowed, err);
    }
    ((int *)option->where)[0] = (int)size[0];
    ((int *)option->where)[1] = (int)size[1];
    return STATUS_OK;
}

static Status set_vector(const Option *option, const char *value, Err *err)
{
    double xyz[3] = {0, 0, 0};
    if (!read_numbers(value, ',', 2, 3, xyz))
        return wrong(option, value, "X,Y or X,Y,Z, numbers parted by commas", err);
    *(Vec3 *)option->where = vec3(xyz[0], xyz[1], xyz[2]);
    return STATUS_OK;
}

static Status set_vectors(const Option *option, const char *value, Err *err)
{
    VectorList *list = option->where;
    if (list->from_recipe)
        *list = (VectorList){0};
    if (list->n == MAX_LIST)
        return err_set(err, STATUS_USAGE, "--%s: may be given at most %d times", option->name,
                       MAX_LIST);
    double xyz[3] = {0, 0, 0};
    if (!read_numbers(value, ',', 2, 3, xyz))
        return wrong(option, value, "X,Y or X,Y,Z, numbers parted by commas", err);
    list->at[list->n++] = vec3(xyz[0], xyz[1], xyz[2]);
    return STATUS_OK;
}

static Status set_numbers(const Option *option, const char *value, Err *err)
{
    NumberList list = {.n = 1};
    for (const char *comma = value; (comma = strchr(comma, ',')); comma++)
        list.n++;
    if (list.n > MAX_LIST || !read_numbers(value, ',', (int)list.n, (int)list.n, list.at))
        return wrong(option, value, "a list of numbers parted by commas", err);
    *(NumberList *)option->where = list;
    return STATUS_OK;
}

static Status set_color(const Option *option, const char *value, Err *err)
{
    double rgb[3];
    bool read = read_numbers(value, ',', 3, 3, rgb);
    for (int i = 0; i < 3; i++)
        read = read && rgb[i] >= 0 && rgb[i] <= 1;
    if (!read)
        return wrong(option, value, "R,G,B, three numbers from 0 to 1 parted by commas", err);
    *(Vec3 *)option->where = vec3(rgb[0], rgb[1], rgb[2]);
    return STATUS_OK;
}

static Status set_range(const Option *option, const char *value, Err *err)
{
    double range[2];
    if (!read_numbers(value, ',', 2, 2, range) || !(range[0] < range[1]))
        return wrong(option, value, "A,B, two numbers with A below B", err);
    memcpy(option->where, range, sizeof range);
    return STATUS_OK;
}

static Status set_seed(const Option *option, const char *value, Err *err)
{
    char *end;
    unsigned long long seed = strtoull(value, &end, 10);
    if (!*value || *end || strspn(value, "0123456789") != strlen(value) || strlen(value) > 19)
        return wrong(option, value, "a whole number from 0 to 9999999999999999999", err);
    *(uint64_t *)option->where = seed;
    return STATUS_OK;
}

static Status set_option(const Option *option, const char *value, Err *err)
{
    if (option->given)
        *option->given = true;
    switch (option->kind) {
    case OPTION_FLAG:
        *(bool *)option->where = true;
        return STATUS_OK;
    case OPTION_SWITCH:
        if (strcmp(value, "on") != 0 && strcmp(value, "off") != 0)
            return wrong(option, value, "on or off", err);
        *(bool *)option->where = strcmp(value, "on") == 0;
        return STATUS_OK;
    case OPTION_TEXT:
    case OPTION_INPUT:
    case OPTION_OUTPUT:
    case OPTION_FOLDER:
    case OPTION_LOOKUP:
        *(const char **)option->where = value;
        return STATUS_OK;
    case OPTION_WHOLE:
    case OPTION_COUNT:
        return set_whole(option, value, err);
    case OPTION_SEED:
        return set_seed(option, value, err);
    case OPTION_NUMBER:
        return set_number(option, value, err);
    case OPTION_VECTOR:
        return set_vector(option, value, err);
    case OPTION_VECTORS:
        return set_vectors(option, value, err);
    case OPTION_NUMBERS:
        return set_numbers(option, value, err);
    case OPTION_COLOR:
        return set_color(option, value, err);
    case OPTION_SIZE:
        return set_size(option, value, err);
    case OPTION_RANGE:
        return set_range(option, value, err);
    case OPTION_CHOICE:
        return set_choice(option, value, err);
    }
    return STATUS_OK;
}

/* A file or folder by name. */
static bool is_path(OptionKind kind)
{
    return kind == OPTION_INPUT || kind == OPTION_OUTPUT || kind == OPTION_FOLDER ||
           kind == OPTION_LOOKUP;
}

static bool is_text(OptionKind kind)
{
    return kind == OPTION_TEXT || is_path(kind);
}

/* ---- recipes --------------------------------------------------------------------------------- */

/* A section of another command is passed over; one of no command is an error. */
static Status take_recipe_line(void *user, const char *section, const char *name, const char *value,
                               Err *err)
{
    const Reader *reader = user;
    if (*section && strcmp(section, reader->command->name) != 0)
        return name || command_find(section)
                   ? STATUS_OK
                   : err_set(err, STATUS_USAGE, "[%s] is not the name of a command", section);
    if (!name)
        return STATUS_OK;
    const Option *option = find_option(reader, name, strlen(name));
    if (!option || strcmp(name, "recipe") == 0) {
        (void)err_set(err, STATUS_USAGE, "'%s' is not an option of %s", name,
                      reader->command->name);
        return suggest_option(reader, name, strlen(name), "", err);
    }
    if (option->kind == OPTION_FLAG && strcmp(value, "on") != 0)
        return wrong(option, value, "on; leave the line out to turn it off", err);
    return set_option(option, value, err);
}

static Status read_recipe(Reader *reader, const char *path, Parsed *parsed)
{
    TRY(ini_read(path, "a recipe", take_recipe_line, reader, &parsed->common.recipe_text,
                 reader->err));
    for (int t = 0; t < reader->n_tables; t++)
        for (const Option *option = reader->tables[t]; option->name; option++)
            if (option->kind == OPTION_VECTORS)
                ((VectorList *)option->where)->from_recipe = true;
    return STATUS_OK;
}

/* ---- options as text ------------------------------------------------------------------------- */

static size_t size_of_value(OptionKind kind)
{
    switch (kind) {
    case OPTION_FLAG:
    case OPTION_SWITCH:
        return sizeof(bool);
    case OPTION_TEXT:
    case OPTION_INPUT:
    case OPTION_OUTPUT:
    case OPTION_FOLDER:
    case OPTION_LOOKUP:
    case OPTION_VECTORS:
    case OPTION_NUMBERS:
        break;
    case OPTION_WHOLE:
    case OPTION_CHOICE:
        return sizeof(int);
    case OPTION_SIZE:
        return 2 * sizeof(int);
    case OPTION_SEED:
        return sizeof(uint64_t);
    case OPTION_COUNT:
        return sizeof(size_t);
    case OPTION_NUMBER:
        return sizeof(double);
    case OPTION_RANGE:
        return 2 * sizeof(double);
    case OPTION_VECTOR:
    case OPTION_COLOR:
        return sizeof(Vec3);
    }
    return 0;
}

bool option_differs(const Option *option, const Option *plain)
{
    if (option->given)
        return *option->given;
    if (is_text(option->kind)) {
        const char *text = *(const char **)option->where, *other = *(const char **)plain->where;
        return text && (!other || strcmp(text, other) != 0);
    }
    size_t size = size_of_value(option->kind);
    return size == 0 || memcmp(option->where, plain->where, size) != 0;
}

static void put_numbers(Text *text, const double *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        text_puts(text, i ? "," : "");
        text_number(text, numbers[i] + 0); /* never -0 */
    }
}

static void put_vector(Text *text, Vec3 v)
{
    const double numbers[] = {v.x, v.y, v.z};
    put_numbers(text, numbers, 3);
}

void option_put(const Option *option, Text *text)
{
    const void *where = option->where;
    const int *wholes = where;
    const char *words;
    switch (option->kind) {
    case OPTION_FLAG:
    case OPTION_SWITCH:
        text_puts(text, *(const bool *)where ? "on" : "off");
        return;
    case OPTION_TEXT:
    case OPTION_INPUT:
    case OPTION_OUTPUT:
    case OPTION_FOLDER:
    case OPTION_LOOKUP:
        words = *(char *const *)where;
        text_puts(text, words ? words : "");
        return;
    case OPTION_WHOLE:
        text_printf(text, "%d", *wholes);
        return;
    case OPTION_CHOICE:
        text_puts(text, option->choices[*wholes]);
        return;
    case OPTION_SIZE:
        text_printf(text, "%dx%d", wholes[0], wholes[1]);
        return;
    case OPTION_SEED:
        text_printf(text, "%llu", (unsigned long long)*(const uint64_t *)where);
        return;
    case OPTION_COUNT:
        text_printf(text, "%zu", *(const size_t *)where);
        return;
    case OPTION_NUMBER:
        put_numbers(text, where, 1);
        return;
    case OPTION_RANGE:
        put_numbers(text, where, 2);
        return;
    case OPTION_VECTOR:
    case OPTION_COLOR:
        put_vector(text, *(const Vec3 *)where);
        return;
    case OPTION_NUMBERS:
        put_numbers(text, ((const NumberList *)where)->at, ((const NumberList *)where)->n);
        return;
    case OPTION_VECTORS: /* several options: one text does not hold them */
        return;
    }
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

static bool is_typed(const Parsed *parsed, const char *name)
{
    for (int i = 0; i < parsed->n_typed; i++)
        if (strcmp(parsed->typed[i], name) == 0)
            return true;
    return false;
}

/* Takes note of an option of the command line. Of two files only one would be read or written. */
static Status note_typed(const Option *option, Parsed *parsed, Err *err)
{
    if (!is_typed(parsed, option->name)) {
        if (parsed->n_typed < MAX_TYPED)
            parsed->typed[parsed->n_typed++] = option->name;
        return STATUS_OK;
    }
    if (!is_path(option->kind))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "%s is given twice; give it once", role_of(option).text);
}

/* Whether the word after a switch is its value: not if it is another option or a file. */
static bool is_value_of_switch(const char *word)
{
    return *word && *word != '-' && !strpbrk(word, "./");
}

static Status read_option(const Reader *reader, int argc, char **argv, int *at, bool apply,
                          Parsed *parsed)
{
    const char *name = argv[*at] + 2;
    if (strcmp(argv[*at], "-o") == 0)
        name = "output";
    else if (strcmp(argv[*at], "-h") == 0)
        name = "help";
    else if (argv[*at][1] != '-')
        name = argv[*at] + 1;
    bool is_short = argv[*at][1] != '-';
    const char *equals = is_short ? NULL : strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const Option *option = find_option(reader, name, length);
    if (!option || (is_short && name == argv[*at] + 1)) {
        (void)err_set(reader->err, STATUS_USAGE,
                      "unknown option '%s'; see corcast %s --help for those there are", argv[*at],
                      reader->command->name);
        return suggest_option(reader, name, length, "--", reader->err);
    }
    const char *value = "";
    if (option->kind == OPTION_FLAG && equals)
        return err_set(reader->err, STATUS_USAGE, "--%s takes no value", option->name);
    if (option->kind != OPTION_FLAG) {
        if (equals)
            value = equals + 1;
        else if (option->kind == OPTION_SWITCH &&
                 !is_value_of_switch(*at + 1 < argc ? argv[*at + 1] : ""))
            value = "on";
        else if (*at + 1 < argc)
            value = argv[++*at];
        else
            return err_set(reader->err, STATUS_USAGE, "--%s needs a value", option->name);
    }
    bool is_recipe = strcmp(option->name, "recipe") == 0;
    TRY(note_typed(option, parsed, reader->err));
    return apply || is_recipe ? set_option(option, value, reader->err) : STATUS_OK;
}

/* One pass over the arguments; options other than --recipe take effect only when `apply`. */
static Status read_arguments(const Reader *reader, int argc, char **argv, bool apply,
                             Parsed *parsed)
{
    bool only_operands = false;
    parsed->n_operands = parsed->n_typed = 0;
    for (int i = 0; i < argc; i++) {
        if (!only_operands && strcmp(argv[i], "--") == 0) {
            only_operands = true;
        } else if (!only_operands && argv[i][0] == '-' && argv[i][1] != '\0') {
            TRY(read_option(reader, argc, argv, &i, apply, parsed));
        } else if (parsed->n_operands == reader->command->max_operands) {
            return err_set(reader->err, STATUS_USAGE,
                           "'%s' is one operand too many; usage: corcast %s %s", argv[i],
                           reader->command->name, reader->command->operands);
        } else {
            parsed->operands[parsed->n_operands++] = argv[i];
        }
    }
    return STATUS_OK;
}

static const char *argument_name(const Option *option)
{
    static const char *const names[] = {
        [OPTION_FLAG] = "",       [OPTION_SWITCH] = "[on|off]", [OPTION_TEXT] = "TEXT",
        [OPTION_INPUT] = "FILE",  [OPTION_OUTPUT] = "FILE",     [OPTION_FOLDER] = "DIR",
        [OPTION_LOOKUP] = "NAME", [OPTION_WHOLE] = "N",         [OPTION_SEED] = "N",
        [OPTION_COUNT] = "N",     [OPTION_NUMBER] = "NUMBER",   [OPTION_VECTOR] = "X,Y,Z",
        [OPTION_COLOR] = "R,G,B", [OPTION_VECTORS] = "X,Y,Z",   [OPTION_NUMBERS] = "A,B,...",
        [OPTION_SIZE] = "WxH",    [OPTION_RANGE] = "A,B",       [OPTION_CHOICE] = "NAME",
    };
    return option->argument ? option->argument : names[option->kind];
}

static void print_help(const Reader *reader)
{
    const Command *command = reader->command;
    printf("corcast %s: %s\n\nusage: corcast %s%s%s\n", command->name, command->summary,
           command->name, *command->operands ? " " : "", command->operands);
    if (command->examples)
        printf("\nexamples:\n%s", command->examples);
    puts("\noptions:");
    for (int t = 0; t < reader->n_tables; t++)
        for (const Option *option = reader->tables[t]; option->name; option++) {
            bool output = strcmp(option->name, "output") == 0;
            char left[64];
            snprintf(left, sizeof left, "%s--%s %s", output ? "-o, " : "", option->name,
                     argument_name(option));
            printf("  %-30s %s", left, option->help);
            for (int i = 0; option->choices && option->choices[i]; i++)
                printf("%s%s", i ? ", " : ": ", option->choices[i]);
            putchar('\n');
        }
}

/* Takes note of all files that are named: what is read first, as errors then name what is
 * written. */
static Status note_files(const Reader *reader, Parsed *parsed)
{
    Files *files = &parsed->files;
    int written = reader->command->writes_last ? parsed->n_operands - 1 : parsed->n_operands;
    for (int i = 0; i < written; i++)
        TRY(files_read(files, "the input", parsed->operands[i], reader->err));
    for (int outputs = 0; outputs < 2; outputs++)
        for (int t = 0; t < reader->n_tables; t++)
            for (const Option *option = reader->tables[t]; option->name; option++) {
                const char *path = is_path(option->kind) ? *(const char **)option->where : NULL;
                if (!path || option->kind == OPTION_FOLDER ||
                    (option->kind == OPTION_LOOKUP && !strchr(path, '/')))
                    continue;
                if (outputs && option->kind == OPTION_OUTPUT)
                    TRY(files_write(files, role_of(option).text, path, reader->err));
                else if (!outputs && option->kind != OPTION_OUTPUT)
                    TRY(files_read(files, role_of(option).text, path, reader->err));
            }
    for (int i = written; i < parsed->n_operands; i++)
        TRY(files_write(files, "the output", parsed->operands[i], reader->err));
    return STATUS_OK;
}

Status options_check_needs(const Parsed *parsed, const OptionNeed needs[], Err *err)
{
    for (const OptionNeed *need = needs; need->name; need++)
        if (!need->met && is_typed(parsed, need->name))
            return err_set(err, STATUS_USAGE, "--%s %s", need->name, need->sentence);
    return STATUS_OK;
}

Status options_parse(const Command *command, const Option *const tables[], int argc, char **argv,
                     Parsed *parsed, Err *err)
{
    *parsed = (Parsed){.common = {.seed = 1}};
    Common *common = &parsed->common;
    const Option common_options[] = {
        {"recipe", OPTION_INPUT, &common->recipe, NULL, 0, 0, NULL, "FILE",
         "read options from an INI file, one name = value a line"},
        {"seed", OPTION_SEED, &common->seed, NULL, 0, 0, NULL, NULL, "of what is random (1)"},
        {"threads", OPTION_WHOLE, &common->threads, NULL, 0, 256, NULL, NULL,
         "processors to use (0: all)"},
        {"quiet", OPTION_FLAG, &common->quiet, NULL, 0, 0, NULL, NULL, "no progress, no summary"},
        {"help", OPTION_FLAG, &common->help, NULL, 0, 0, NULL, NULL, "this text"},
        {0},
    };
    Reader reader = {.command = command, .err = err};
    for (; tables[reader.n_tables]; reader.n_tables++)
        reader.tables[reader.n_tables] = tables[reader.n_tables];
    reader.tables[reader.n_tables++] = common_options;
    TRY(read_arguments(&reader, argc, argv, false, parsed));
    if (common->recipe)
        TRY(read_recipe(&reader, common->recipe, parsed));
    Status status = read_arguments(&reader, argc, argv, true, parsed);
    if (status == STATUS_OK && common->help) {
        print_help(&reader);
        return STATUS_OK;
    }
    const Option *output = find_option(&reader, "output", strlen("output"));
    if (status == STATUS_OK && command->needs_output && !*(const char **)output->where)
        status = err_set(err, STATUS_USAGE, "-o %s is missing; usage: corcast %s %s",
                         output->argument, command->name, command->operands);
    if (status == STATUS_OK && parsed->n_operands < command->min_operands)
        status = err_set(err, STATUS_USAGE, "a file is missing; usage: corcast %s %s",
                         command->name, command->operands);
    if (status == STATUS_OK)
        status = note_files(&reader, parsed);
    if (status != STATUS_OK)
        parsed_release(parsed);
    return status;
}

void parsed_release(Parsed *parsed)
{
    free(parsed->common.recipe_text);
    parsed->common.recipe_text = NULL;
    files_release(&parsed->files);
}
