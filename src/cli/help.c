/* The help of a command, made from its descriptions: usage, examples, and its options under their
 * headings, each with what it takes and what holds without it. */
#include "cli/help.h"

#include "cli/commands.h"
#include "options/output.h"
#include "options/schema.h"
#include <stdio.h>
#include <string.h>

enum { HELP_INDENT = 27, HELP_WIDTH = 90 };

/* Appends words, wrapped, from column `column` on. */
static void put_wrapped(const char *words, size_t column, Text *text)
{
    while (*words) {
        size_t length = strcspn(words, " ");
        if (column > HELP_INDENT && column + 1 + length > HELP_WIDTH) {
            text_printf(text, "\n%*s", HELP_INDENT, "");
            column = HELP_INDENT;
        } else if (column > HELP_INDENT) {
            text_puts(text, " ");
            column++;
        }
        text_append(text, words, length);
        column += length;
        words += length + (words[length] == ' ');
    }
    text_puts(text, "\n");
}

void help_put_meaning(const Setting *plain, Text *text)
{
    const Option *option = plain->option;
    Text allowed = TEXT_INIT, value = TEXT_INIT;
    text_puts(text, option->help);
    option_put_allowed(option, &allowed);
    const char *chars = text_chars(&allowed);
    if (!chars || *chars)
        text_puts(text, option->choices ? ": " : "; ");
    text_puts(text, chars && strncmp(chars, "of ", 3) == 0 ? chars + 3 : chars);
    if (option->list)
        text_printf(text, "; corcast %s lists them", option->list);
    if (option->otherwise)
        text_puts(&value, option->otherwise);
    else if (option->kind != OPTION_FLAG && setting_count(plain) > 0)
        setting_put(plain, 0, &value);
    if (value.length || !text_chars(&value)) {
        text_puts(text, " (");
        text_add(text, &value);
        text_puts(text, ")");
    }
    text_release(&allowed);
    text_release(&value);
}

void help_put_escaped(const char *chars, const char *special, Text *text)
{
    if (!chars)
        text_puts(text, chars);
    for (; chars && *chars; chars++)
        text_printf(text, strchr(special, *chars) ? "\\%c" : "%c", *chars);
}

static void put_option(const Setting *plain, Text *text)
{
    const Option *option = plain->option;
    Text left = TEXT_INIT, meaning = TEXT_INIT;
    bool output = strcmp(option->name, "output") == 0;
    text_printf(&left, "  %s--%s ", output ? "-o, " : "", option->name);
    option_put_argument(option, &left);
    help_put_meaning(plain, &meaning);
    text_add(text, &left);
    size_t column = left.length;
    if (column + 2 > HELP_INDENT) {
        text_puts(text, "\n");
        column = 0;
    }
    text_printf(text, "%*s", (int)(HELP_INDENT - column), "");
    if (text_chars(&meaning))
        put_wrapped(text_chars(&meaning), HELP_INDENT, text);
    else
        text_add(text, &meaning);
    text_release(&left);
    text_release(&meaning);
}

static void put_group(const Parsed *plain, OptionGroup group, Text *text)
{
    bool headed = false;
    for (size_t i = 0; i < plain->n_settings; i++) {
        if (plain->settings[i].option->group != group)
            continue;
        if (!headed)
            text_printf(text, "\n%s:\n", option_group_names[group]);
        headed = true;
        put_option(&plain->settings[i], text);
    }
}

static void put_help(const Parsed *plain, Text *text)
{
    const Command *command = plain->command;
    text_printf(text, "corcast %s: %s\n\nusage: corcast %s%s%s\n", command->name, command->summary,
                command->name, *command->operands ? " " : "", command->operands);
    if (command->examples)
        text_printf(text, "\nexamples:\n%s", command->examples);
    for (int group = 0; group < OPTION_GROUPS; group++)
        put_group(plain, (OptionGroup)group, text);
}

Status help_put(HelpPut *put, const Command *command, Text *text, Err *err)
{
    Parsed plain;
    TRY(parsed_init(&plain, command, err));
    put(&plain, text);
    parsed_release(&plain);
    return text_check(text, err);
}

Status help_put_all(HelpPut *put, Text *text, Err *err)
{
    for (const CommandRow *row = command_rows; row->command; row++)
        TRY(help_put(put, row->command, text, err));
    return STATUS_OK;
}

Status schema_put(const Command *command, Text *text, Err *err)
{
    json_t *commands = json_array();
    Status status = command ? schema_add(command, &commands, err) : STATUS_OK;
    for (const CommandRow *row = command_rows; !command && row->command; row++)
        TRY_GOTO(schema_add(row->command, &commands, err));
    text_json(text, schema_document(commands), 2);
    commands = NULL;
    text_puts(text, "\n");
    status = text_check(text, err);
done:
    json_decref(commands);
    return status;
}

const char help_exit_status[] =
    "0 done, 1 a comparison found a difference, 2 wrong usage or input, 3 a file, program or the "
    "memory failed.";

static void put_usage(Text *text)
{
    text_puts(text, GENERATOR ": grow, draw and verify arterial trees\n\n"
                              "usage: corcast COMMAND [options] [files]\n\n");
    for (const CommandRow *row = command_rows; row->command; row++)
        text_printf(text, "  %-9s %s\n", row->command->name, row->command->summary);
    text_printf(text,
                "\ncorcast COMMAND --help tells the options of a command; '-' stands for standard "
                "input\nor output wherever a file may stand.\n\nexit status: %s\n",
                help_exit_status);
}

Status help_print(const Command *command, Err *err)
{
    Text text = TEXT_INIT;
    Status status;
    if (!command)
        put_usage(&text);
    TRY_GOTO(command ? help_put(put_help, command, &text, err) : text_check(&text, err));
    fputs(text_chars(&text), stdout);
done:
    text_release(&text);
    return status;
}
