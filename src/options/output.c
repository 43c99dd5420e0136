/* Writes the command line of a run for the provenance of files, for tiles and for messages.
 *
 * The command line that a file stores as its provenance is formatted from the values of the options
 * and not from the words that were typed. A recipe, the order of the options, and options that do
 * not change the result therefore leave no trace, and equal results have equal lines. */
#include "options/output.h"

#include "options/templates.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool is_one_of(const char *word, const char *const *words)
{
    while (*words && strcmp(*words, word) != 0)
        words++;
    return *words;
}

bool wordlist_has(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = words; at && *at; at += strcspn(at, " ")) {
        at += strspn(at, " ");
        if (strcspn(at, " ") == length && strncmp(at, word, length) == 0)
            return true;
    }
    return false;
}

/* Moves *line to *out as one line of UTF-8, and releases it. */
static Status take_line(Text *line, char **out, Err *err)
{
    Text clean = TEXT_INIT;
    text_put_line(&clean, text_chars(line));
    text_release(line);
    Status status = text_take(&clean, out, err);
    text_release(&clean);
    return status;
}

Status shown_name(const char *path, char **out, Err *err)
{
    Text name = TEXT_INIT;
    text_puts(&name, file_name(path));
    return take_line(&name, out, err);
}

/* Appends a value; of a path, only the last component. In a text such as mesh:FILE, the path begins
 * behind the colon. A file of the user's own keeps "./", which distinguishes it from a template. */
static void put_shown_value(const Setting *setting, size_t at, Text *text)
{
    Text value = TEXT_INIT;
    setting_put(setting, at, &value);
    const char *whole = text_chars(&value), *name = whole;
    OptionKind kind = setting->option->kind;
    size_t kept = kind == OPTION_TEXT && whole && strchr(whole, ':')
                      ? (size_t)(strchr(whole, ':') + 1 - whole)
                      : 0;
    Text shown = TEXT_INIT;
    if (whole && (option_is_path(setting->option) || kept))
        name = file_name(whole + kept);
    text_append(&shown, whole, whole ? kept : 0);
    text_puts(&shown, kind == OPTION_LOOKUP && name != whole ? "./" : "");
    text_puts(&shown, name);
    text_put_shell_word(text, text_chars(&shown));
    text_release(&shown);
    text_release(&value);
}

static void put_whole_value(const Setting *setting, size_t at, Text *text)
{
    Text value = TEXT_INIT;
    setting_put(setting, at, &value);
    text_put_shell_word(text, text_chars(&value));
    text_release(&value);
}

typedef void PutValue(const Setting *setting, size_t at, Text *text);

/* Appends the option as often as it has to be given. */
static void put_setting(const Setting *setting, PutValue *put_value, Text *text)
{
    for (size_t at = 0; at < setting_count(setting); at++) {
        text_printf(text, " --%s", setting->option->name);
        if (setting->option->kind == OPTION_FLAG)
            continue;
        text_puts(text, " ");
        put_value(setting, at, text);
    }
}

/* Returns the extension of a path as file_extension does, but "nii.gz" for V.nii.gz. */
static const char *whole_extension(const char *path)
{
    const char *extension = file_extension(path), *name = file_name(path);
    const char *at = extension - (extension > name);
    while (at > name && at[-1] != '.')
        at--;
    return strcmp(extension, "gz") == 0 && at > name ? at : extension;
}

/* Appends the output under its name in the help, with its real extension. The content of a file
 * does not depend on the name of the file, unless Option.is_told is true. */
static void put_output(const Setting *setting, bool in_memory, Text *text)
{
    const char *path = *(const char *const *)(setting->base + setting->option->where);
    const char *name = setting->option->argument, *extension = whole_extension(path ? path : "");
    if (!path && in_memory)
        path = name;
    if (!path)
        return;
    text_puts(text, " -o ");
    if (setting->option->is_told || (strcmp(path, "-") == 0 && !strchr(name, '.')))
        text_put_shell_word(text, file_name(path));
    else if (*extension)
        text_printf(text, "%.*s.%s", (int)strcspn(name, "."), name, extension);
    else
        text_puts(text, name);
}

/* Returns true if the command line of the provenance contains the option. --output follows at the
 * end, and other output files appear only if Option.is_told is true. */
static bool is_in_provenance(const Setting *setting, const Setting *defaults, Text *text)
{
    const Option *option = setting->option;
    bool output = strcmp(option->name, "output") == 0;
    bool hidden = option->kind == OPTION_OUTPUT && !option->is_told;
    return !option->aside && !output && !hidden && setting_differs(setting, defaults, text);
}

void put_shell_operand(Text *text, const char *path)
{
    Text word = TEXT_INIT;
    text_printf(&word, "%s%s", path[0] == '-' && path[1] ? "./" : "", path);
    text_put_shell_word(text, text_chars(&word));
    text_release(&word);
}

/* Appends the operands by their last components. */
static void put_operands(const Parsed *parsed, Text *text)
{
    const char *first = parsed->command->operands; /* "T.swc -o P.png" */
    for (int i = 0; i < parsed->n_operands; i++) {
        text_puts(text, " ");
        if (parsed->operands[i] == parsed_memory)
            text_append(text, first, strcspn(first, " "));
        else
            put_shell_operand(text, file_name(parsed->operands[i]));
    }
}

Status command_line_text(const Parsed *parsed, char **out, Err *err)
{
    Parsed defaults;
    TRY(parsed_init(&defaults, parsed->command, err));
    Text text = TEXT_INIT;
    text_printf(&text, "corcast %s", parsed->command->name);
    put_operands(parsed, &text);
    for (size_t i = 0; i < parsed->n_settings; i++)
        if (is_in_provenance(&parsed->settings[i], &defaults.settings[i], &text))
            put_setting(&parsed->settings[i], put_shown_value, &text);
    const Setting *output = parsed_find(parsed, "output", strlen("output"));
    if (output)
        put_output(output, parsed->in_memory, &text);
    parsed_release(&defaults);
    return take_line(&text, out, err);
}

/* Appends `cd` to the working folder, and the path of the program. */
static Status put_program(Text *text, Err *err)
{
    char program[PATH_MAX];
    const bool found = system_program(program, sizeof program);
    char *here = getcwd(NULL, 0);
    if (!here)
        return errno == ENOMEM
                   ? err_set(err, STATUS_MEMORY, "out of memory: no room for a folder's name")
                   : err_set(err, STATUS_IO, "the working folder has no name: %s", strerror(errno));
    text_puts(text, "cd ");
    text_put_shell_word(text, here);
    free(here);
    text_puts(text, " && ");
    text_put_shell_word(text, found ? program : "corcast");
    return STATUS_OK;
}

Status put_rerun_command(const Parsed *parsed, const char *const *without, Text *text, Err *err)
{
    Parsed defaults;
    TRY(put_program(text, err));
    TRY(parsed_init(&defaults, parsed->command, err));
    text_printf(text, " %s", parsed->command->name);
    for (int i = 0; i < parsed->n_operands; i++) {
        text_puts(text, " ");
        put_shell_operand(text, parsed->operands[i]);
    }
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        const char *name = setting->option->name;
        if (strcmp(name, "output") != 0 && strcmp(name, "recipe") != 0 &&
            !is_one_of(name, without) && setting_differs(setting, &defaults.settings[i], text))
            put_setting(setting, put_whole_value, text);
    }
    parsed_release(&defaults);
    return text_check(text, err);
}

/* Adds the bytes of the file that a value of OPTION_LOOKUP names. */
static Status hash_lookup(const Option *option, const char *value, Hash *hash, Err *err)
{
    const char *extension = strcmp(option->list, "colormaps") == 0 ? ".txt" : ".ini";
    char *path = NULL;
    TRY(template_file(option->name, option->list, value, extension, &path, err));
    Status status = file_hash(path, hash, err);
    free(path);
    return status;
}

Status hash_option_files(const Parsed *parsed, Hash *hash, Err *err)
{
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Option *option = parsed->settings[i].option;
        const bool is_lookup = option->kind == OPTION_LOOKUP;
        if (option->aside || (option->kind != OPTION_INPUT && !is_lookup))
            continue;
        const char *value = *(const char *const *)(parsed->settings[i].base + option->where);
        hash_add_text(hash, value ? option->name : "");
        if (value)
            TRY(is_lookup ? hash_lookup(option, value, hash, err) : file_hash(value, hash, err));
    }
    return STATUS_OK;
}

Status treemeta_add_command(const Parsed *parsed, TreeMeta *meta, Err *err)
{
    char *line = NULL;
    TRY(command_line_text(parsed, &line, err));
    Status status = meta_add_text(meta, META_COMMAND, line, err);
    free(line);
    return status;
}

Status json_write(json_t *object, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    text_json(&text, object, 2);
    text_puts(&text, "\n");
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}
