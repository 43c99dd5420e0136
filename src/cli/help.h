/* Formats the option tables [options/options.h] as help texts, manual pages, a reference, a JSON
 * schema and shell completions.
 *
 * A CommandFormatter appends the text about one command. help_format calls it for one command,
 * help_format_all for every command. All functions append to `text`. If memory runs out, `text`
 * records the failure, which text_check reports. A parameter `defaults` holds the default values
 * of all options of a command (Parsed), or the default value of one option (Setting). */
#ifndef CORCAST_CLI_HELP_H
#define CORCAST_CLI_HELP_H

#include "options/options.h"

/* Prints the help of a command on standard output. If `command` is NULL, prints the overview of all
 * commands. Errors: STATUS_MEMORY. */
MUST_CHECK Status help_print(const Command *command, Err *err);

/* The meanings of the exit codes as one line, without the words "Exit status:". */
extern const char help_exit_status[];
/* Three commands for a new user, each with a comment and a newline. */
extern const char help_first_steps[];

/* Appends one line that lists the commands whose `--json FILE` writes a file, and the commands
 * whose `--json` takes no value and prints JSON. */
void help_put_json_commands(Text *text);
/* Appends the option's help, the accepted values, and the value or phrase that applies if the
 * option is not specified. */
void help_put_option(const Setting *defaults, Text *text);
/* Appends `chars`, with a backslash before each character that is in `special`. If `chars` is NULL,
 * which text_chars returns for a Text that has failed, `text` fails as well. */
void help_put_escaped(const char *chars, const char *special, Text *text);

/* HelpHeading appends the heading of a group of options. HelpOption appends the description of one
 * option. */
typedef void HelpHeading(const char *name, Text *text);
typedef void HelpOption(const Setting *defaults, Text *text);

/* Calls `put_heading` for each group that has options, then `put_option` for each option of the
 * group. Skips the options without effect on the command [command_obeys] and, if `common` is false,
 * the common options. */
void help_put_groups(const Parsed *defaults, bool common, HelpHeading *put_heading,
                     HelpOption *put_option, Text *text);

/* Appends the description of one command. */
typedef void CommandFormatter(const Parsed *defaults, Text *text);

/* Calls `put` for `command`, with its default values. Errors: STATUS_MEMORY. */
MUST_CHECK Status help_format(CommandFormatter *put, const Command *command, Text *text, Err *err);
/* Calls `put` for every command. Errors: STATUS_MEMORY. */
MUST_CHECK Status help_format_all(CommandFormatter *put, Text *text, Err *err);

/* Appends the manual page of a command, in section 1. */
void manual_put(const Parsed *defaults, Text *text);
/* Appends the manual page corcast.1, which lists the commands. */
void manual_put_overview(Text *text);
/* Appends a JSON document with the description of `command`, or of every command if `command` is
 * NULL [options/schema.h]. Errors: STATUS_MEMORY. */
MUST_CHECK Status schema_put(const Command *command, Text *text, Err *err);
/* Appends the content of docs/REFERENCE.md. Errors: STATUS_MEMORY. */
MUST_CHECK Status reference_put(Text *text, Err *err);
/* Append the completion script for bash, zsh or fish. Errors: STATUS_MEMORY. */
MUST_CHECK Status completion_put_bash(Text *text, Err *err);
MUST_CHECK Status completion_put_zsh(Text *text, Err *err);
MUST_CHECK Status completion_put_fish(Text *text, Err *err);

#endif
