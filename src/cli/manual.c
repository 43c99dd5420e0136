/* Formats manual pages, in the macros of groff_man(7), and docs/REFERENCE.md. Both list the options
 * under the headings of the help. Pages have no date, so the same sources give the same bytes. */
#include "cli/commands.h"
#include "cli/help.h"
#include "options/output.h"
#include <string.h>

/* ---- man ------------------------------------------------------------------------------------- */

/* Appends text that troff prints verbatim. It must not begin a line, where troff reads requests. */
static void put_troff(const char *chars, Text *text)
{
    if (!chars)
        text_puts(text, chars);
    for (; chars && *chars; chars++)
        text_puts(text, *chars == '\\'   ? "\\e"
                        : *chars == '-'  ? "\\-"
                        : *chars == '\'' ? "\\(aq"
                        : *chars == '`'  ? "\\(ga"
                        : *chars == '^'  ? "\\(ha"
                        : *chars == '~'  ? "\\(ti"
                                         : (const char[]){*chars, '\0'});
}

/* Appends lines that troff prints verbatim, without filling them. */
static void put_lines(const char *lines, Text *text)
{
    text_puts(text, ".EX\n");
    while (*lines) {
        size_t length = strcspn(lines, "\n");
        Text line = TEXT_INIT;
        text_append(&line, lines, length);
        text_puts(text, "\\&");
        put_troff(text_chars(&line), text);
        text_puts(text, "\n");
        text_release(&line);
        lines += length + (lines[length] == '\n');
    }
    text_puts(text, ".EE\n");
}

static void put_man_heading(const char *name, Text *text)
{
    text_printf(text, ".SS %s\n", name);
}

static void put_man_option(const Setting *defaults, Text *text)
{
    const Option *option = defaults->option;
    Text argument = TEXT_INIT, meaning = TEXT_INIT;
    text_puts(text, ".TP\n\\fB");
    if (strcmp(option->name, "output") == 0)
        text_puts(text, "\\-o\\fR, \\fB");
    text_puts(text, "\\-\\-");
    put_troff(option->name, text);
    option_put_argument(option, &argument);
    help_put_option(defaults, &meaning);
    text_puts(text, argument.length ? "\\fR \\fI" : "");
    put_troff(text_chars(&argument), text);
    text_puts(text, "\\fR\n\\&");
    put_troff(text_chars(&meaning), text);
    text_puts(text, "\n");
    text_release(&argument);
    text_release(&meaning);
}

/* Appends the head of a page, up to the place of its summary. */
static void put_title(const char *name, Text *text)
{
    text_puts(text, ".TH ");
    for (const char *c = name; c && *c; c++)
        text_printf(text, "%c", *c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
    text_puts(text, " 1 \"\" \"" GENERATOR "\" \"corcast manual\"\n.SH NAME\n");
    put_troff(name, text);
    text_puts(text, " \\- ");
}

static void put_exit_status(Text *text)
{
    text_puts(text, ".SH EXIT STATUS\n");
    put_troff(help_exit_status, text);
    text_puts(text, "\n");
}

void manual_put(const Parsed *defaults, Text *text)
{
    const Command *command = defaults->command;
    Text name = TEXT_INIT;
    text_printf(&name, "corcast-%s", command->name);
    put_title(text_chars(&name), text);
    text_release(&name);
    put_troff(command->summary, text);
    text_printf(text, "\n.SH SYNOPSIS\n\\fBcorcast %s\\fR ", command->name);
    put_troff(command->operands, text);
    text_puts(text, *command->operands ? " [options]\n" : "[options]\n");
    text_puts(text, ".SH OPTIONS\n");
    help_put_groups(defaults, true, put_man_heading, put_man_option, text);
    if (command->examples) {
        text_puts(text, ".SH EXAMPLES\n");
        put_lines(command->examples, text);
    }
    put_exit_status(text);
    text_puts(text, ".SH SEE ALSO\n\\fBcorcast\\fR(1)\n");
}

void manual_put_overview(Text *text)
{
    put_title("corcast", text);
    text_puts(text,
              "grow, draw and verify arterial trees\n.SH SYNOPSIS\n"
              "\\fBcorcast\\fR \\fIcommand\\fR [options] [files]\n"
              ".SH DESCRIPTION\ncorcast grows, reads, measures, draws, exports and checks arterial "
              "trees. "
              "A file\nname \\(aq\\-\\(aq stands for standard input or output. Options can also be "
              "read from an INI\nfile with \\fB\\-\\-recipe\\fR.\n.SH EXAMPLES\n");
    put_lines(help_first_steps, text);
    text_puts(text, ".SH COMMANDS\n");
    int group = -1;
    for (const CommandRow *row = command_rows; row->command; row++) {
        if ((int)row->group != group)
            put_man_heading(command_group_names[row->group], text);
        group = (int)row->group;
        text_printf(text, ".TP\n\\fBcorcast\\-%s\\fR(1)\n", row->command->name);
        put_troff(row->command->summary, text);
        text_puts(text, "\n");
    }
    put_exit_status(text);
}

/* ---- Markdown -------------------------------------------------------------------------------- */

static void put_markdown_heading(const char *name, Text *text)
{
    text_printf(text, "\n| %s | |\n|---|---|\n", name);
}

static void put_markdown_option(const Setting *defaults, Text *text)
{
    const Option *option = defaults->option;
    bool output = strcmp(option->name, "output") == 0;
    Text argument = TEXT_INIT, meaning = TEXT_INIT;
    option_put_argument(option, &argument);
    help_put_option(defaults, &meaning);
    text_printf(text, "| `%s--%s%s", output ? "-o, " : "", option->name,
                argument.length ? " " : "");
    help_put_escaped(text_chars(&argument), "|", text);
    text_puts(text, "` | ");
    help_put_escaped(text_chars(&meaning), "|*<", text);
    text_puts(text, " |\n");
    text_release(&argument);
    text_release(&meaning);
}

static void put_markdown(const Parsed *defaults, Text *text)
{
    const Command *command = defaults->command;
    text_printf(text, "\n## %s\n\n", command->name);
    help_put_escaped(command->summary, "*<", text);
    text_printf(text, "\n\n    corcast %s %s\n", command->name, command->operands);
    help_put_groups(defaults, false, put_markdown_heading, put_markdown_option, text);
    if (command->examples)
        text_printf(text, "\n```\n%s```\n", command->examples);
}

static void put_common(const Parsed *defaults, Text *text)
{
    text_puts(text, "\n| option | |\n|---|---|\n");
    for (size_t i = 0; i < defaults->n_settings; i++)
        if (setting_is_common(defaults, &defaults->settings[i]))
            put_markdown_option(&defaults->settings[i], text);
}

Status reference_put(Text *text, Err *err)
{
    text_puts(text, "# Reference\n\n`make reference` writes this page from the option tables of "
                    "the program. The accepted\n"
                    "range and the default of an option are in square brackets.\n\nEvery command "
                    "accepts these options:\n");
    TRY(help_format(put_common, command_rows[0].command, text, err));
    text_puts(
        text,
        "\nA recipe contains options, one `name = value` per line; options below `[COMMAND]` apply "
        "to that\ncommand only. A file name `-` stands for standard input or output.\n\n");
    help_put_json_commands(text);
    text_printf(text, "\n\nExit status: %s\n", help_exit_status);
    return help_format_all(put_markdown, text, err);
}
