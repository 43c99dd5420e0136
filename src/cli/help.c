/* Formats the help of a command: usage, examples, and the options under their headings, each with
 * its accepted values and its default. */
#include "cli/help.h"

#include "cli/commands.h"
#include "options/output.h"
#include "options/schema.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* Columns. The indent has room for most placeholders; a longer option gets a line of its own. A
 * larger width makes longer lines; reason of 90 not recorded. */
enum { HELP_INDENT = 27, HELP_WIDTH = 90 };

/* Appends words, wrapped to HELP_WIDTH columns. The first word begins in column `column`, all other
 * lines in column `indent`. NULL, from a Text that failed, makes `text` fail. */
static void put_wrapped(const char *words, size_t column, size_t indent, Text *text)
{
    if (!words)
        text_puts(text, words);
    while (words && *words) {
        size_t length = strcspn(words, " ");
        if (column > indent && column + 1 + length > HELP_WIDTH) {
            text_printf(text, "\n%*s", (int)indent, "");
            column = indent;
        } else if (column > indent) {
            text_puts(text, " ");
            column++;
        }
        text_append(text, words, length);
        column += length;
        words += length + (words[length] == ' ');
    }
    text_puts(text, "\n");
}

/* Returns true if `word` is in `chars`, between characters that are no letters or digits. */
static bool has_word(const char *chars, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = chars; (at = strstr(at, word)); at++)
        if ((at == chars || !isalnum((unsigned char)at[-1])) && !isalnum((unsigned char)at[length]))
            return true;
    return false;
}

/* Appends the accepted words, unless the help contains all of them, as it does to explain them. */
static void put_choices(const Option *option, Text *text)
{
    bool explained = true;
    for (int i = 0; option->choices && option->choices[i]; i++)
        explained = explained && has_word(option->help, option->choices[i]);
    for (int i = 0; !explained && option->choices[i]; i++)
        text_printf(text, "%s%s", i ? ", " : ": ", option->choices[i]);
}

/* Appends "0..64", "above 0", "above 0, at most 10" or "at least 3"; nothing if all numbers are
 * accepted. */
static void put_range(const Range *range, Text *text)
{
    char low[NUMBER_TEXT_SIZE], high[NUMBER_TEXT_SIZE];
    const bool has_high = range->high < RANGE_NO_END, above_0 = range->low == RANGE_ABOVE_0;
    const bool has_low = range->low > -RANGE_NO_END;
    number_text(range->low, low);
    number_text(range->high, high);
    if (has_low && has_high && !above_0)
        text_printf(text, "%s..%s", low, high);
    else if (has_low)
        text_printf(text, above_0 ? "above 0" : "at least %s", low);
    if (has_high && (above_0 || !has_low))
        text_printf(text, "%sat most %s", above_0 ? ", " : "", high);
}

/* Appends the range and the unit: "0..64 mm". A placeholder such as "8|16" lists all values, so no
 * range follows. The help of a size states its units. */
static void put_accepted(const Option *option, Text *text)
{
    const bool lists_values = option->argument && isdigit((unsigned char)*option->argument);
    if (option->kind == OPTION_SIZE || lists_values)
        return;
    if (option_range(option))
        put_range(option_range(option), text);
    if (option_unit(option))
        text_printf(text, "%s%s", text->length ? " " : "", option_unit(option));
}

/* Appends the value or the phrase that applies if the option is not given. */
static void put_default(const Setting *defaults, Text *text)
{
    const Option *option = defaults->option;
    if (option->otherwise)
        text_puts(text, option->otherwise);
    else if (option->kind != OPTION_FLAG && setting_count(defaults) > 0)
        setting_put(defaults, 0, text);
}

void help_put_option(const Setting *defaults, Text *text)
{
    const Option *option = defaults->option;
    Text range = TEXT_INIT, value = TEXT_INIT;
    text_puts(text, option->help);
    put_choices(option, text);
    if (option->list)
        text_printf(text, "; `corcast %s` lists the names", option->list);
    put_accepted(option, &range);
    put_default(defaults, &value);
    const bool has_range = range.length || !text_chars(&range);
    const bool has_value = value.length || !text_chars(&value);
    text_puts(text, has_range || has_value ? " [" : "");
    text_add(text, &range);
    if (has_value)
        text_puts(text, has_range ? "; default: " : "default: ");
    text_add(text, &value);
    text_puts(text, has_range || has_value ? "]" : "");
    text_release(&range);
    text_release(&value);
}

void help_put_escaped(const char *chars, const char *special, Text *text)
{
    if (!chars)
        text_puts(text, chars);
    for (; chars && *chars; chars++)
        text_printf(text, strchr(special, *chars) ? "\\%c" : "%c", *chars);
}

static void put_option_lines(const Setting *defaults, Text *text)
{
    const Option *option = defaults->option;
    Text left = TEXT_INIT, meaning = TEXT_INIT;
    bool output = strcmp(option->name, "output") == 0;
    text_printf(&left, "  %s--%s ", output ? "-o, " : "", option->name);
    option_put_argument(option, &left);
    help_put_option(defaults, &meaning);
    text_add(text, &left);
    size_t column = left.length;
    if (column + 2 > HELP_INDENT) {
        text_puts(text, "\n");
        column = 0;
    }
    text_printf(text, "%*s", (int)(HELP_INDENT - column), "");
    put_wrapped(text_chars(&meaning), HELP_INDENT, HELP_INDENT, text);
    text_release(&left);
    text_release(&meaning);
}

void help_put_groups(const Parsed *defaults, bool common, HelpHeading *put_heading,
                     HelpOption *put_option, Text *text)
{
    for (int group = 0; group < OPTION_GROUPS; group++) {
        bool has_heading = false;
        for (size_t i = 0; i < defaults->n_settings; i++) {
            const Setting *setting = &defaults->settings[i];
            if ((int)setting->option->group != group || !command_obeys(defaults, setting) ||
                (!common && setting_is_common(defaults, setting)))
                continue;
            if (!has_heading)
                put_heading(option_group_names[group], text);
            has_heading = true;
            put_option(setting, text);
        }
    }
}

static void put_heading(const char *name, Text *text)
{
    text_printf(text, "\n%s:\n", name);
}

static void put_help(const Parsed *defaults, Text *text)
{
    const Command *command = defaults->command;
    text_printf(text, "corcast %s: %s\n\nusage: corcast %s%s%s\n", command->name, command->summary,
                command->name, *command->operands ? " " : "", command->operands);
    if (command->examples)
        text_printf(text, "\nexamples:\n%s", command->examples);
    help_put_groups(defaults, true, put_heading, put_option_lines, text);
}

Status help_format(CommandFormatter *put, const Command *command, Text *text, Err *err)
{
    Parsed defaults;
    TRY(parsed_init(&defaults, command, err));
    put(&defaults, text);
    parsed_release(&defaults);
    return text_check(text, err);
}

Status help_format_all(CommandFormatter *put, Text *text, Err *err)
{
    for (const CommandRow *row = command_rows; row->command; row++)
        TRY(help_format(put, row->command, text, err));
    return STATUS_OK;
}

Status schema_put(const Command *command, Text *text, Err *err)
{
    json_t *commands = json_array();
    Status status = command ? schema_add(command, command_obeys, &commands, err) : STATUS_OK;
    for (const CommandRow *row = command_rows; !command && row->command; row++)
        TRY_GOTO(schema_add(row->command, command_obeys, &commands, err));
    text_json(text, schema_document(commands), 2);
    commands = NULL;
    text_puts(text, "\n");
    status = text_check(text, err);
done:
    json_decref(commands);
    return status;
}

const char help_exit_status[] =
    "0 success; 1 a comparison or check found a difference; 2 the command line or an input is "
    "wrong; 3 a file cannot be read or written, another program failed, or memory ran out.";

/* Returns true if the command has an option --json of this kind. */
static bool has_json(const Command *command, OptionKind kind)
{
    for (int t = 0; t < MAX_TABLES && command->tables[t].table; t++)
        for (size_t i = 0; i < command->tables[t].table->n; i++) {
            const Option *option = &command->tables[t].table->options[i];
            if (strcmp(option->name, "json") == 0 && option->kind == kind)
                return true;
        }
    return false;
}

/* Appends the names of the commands whose option --json has this kind. */
static void put_json_commands(OptionKind kind, Text *text)
{
    const char *comma = "";
    for (const CommandRow *row = command_rows; row->command; row++)
        if (has_json(row->command, kind)) {
            text_printf(text, "%s%s", comma, row->command->name);
            comma = ", ";
        }
}

void help_put_json_commands(Text *text)
{
    text_puts(text, "`--json FILE` (");
    put_json_commands(OPTION_OUTPUT, text);
    text_puts(text, ") writes a summary of the run to FILE. `--json` (");
    put_json_commands(OPTION_FLAG, text);
    text_puts(text, ") prints the result on standard output. Other commands have no --json.");
}

const char help_first_steps[] = "  corcast grow --terminals 1000 -o tree.swc   # grow a tree\n"
                                "  corcast render tree.swc -o tree.png         # draw it\n"
                                "  corcast info tree.swc                       # measure it\n";

static void put_usage(Text *text)
{
    Text json_rule = TEXT_INIT;
    text_printf(text,
                GENERATOR ": grow, draw and verify arterial trees\n\n"
                          "usage: corcast COMMAND [options] [files]\n\nfirst steps:\n%s",
                help_first_steps);
    int group = -1;
    for (const CommandRow *row = command_rows; row->command; row++) {
        if ((int)row->group != group)
            text_printf(text, "\n%s:\n", command_group_names[row->group]);
        group = (int)row->group;
        text_printf(text, "  %-14s %s\n", row->command->name, row->command->summary);
    }
    text_puts(text, "\n");
    put_wrapped(
        "`corcast COMMAND --help` shows the options of a command. Square brackets behind an option "
        "contain the accepted range, the unit and the default. A file name '-' stands for standard "
        "input or output.",
        0, 0, text);
    help_put_json_commands(&json_rule);
    put_wrapped(text_chars(&json_rule), 0, 0, text);
    text_release(&json_rule);
    text_puts(text, "exit status:");
    put_wrapped(help_exit_status, strlen("exit status:"), 0, text);
}

Status help_print(const Command *command, Err *err)
{
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    if (command)
        status = help_format(put_help, command, &text, err);
    else
        put_usage(&text);
    return command_print(status, &text, err);
}
