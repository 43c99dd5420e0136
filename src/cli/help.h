/* Formats the help, manual pages, the reference and shell completions from the option tables. */
#ifndef CORCAST_CLI_HELP_H
#define CORCAST_CLI_HELP_H

#include "options/options.h"

/* Prints the help of a command; if `command` is NULL, the overview of all commands. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status help_print(const Command *command, Err *err);

/* The meanings of the exit codes as one line, without the words "Exit status:". */
extern const char help_exit_status[];
/* Three commands for a new user, each with a comment and a newline. */
extern const char help_first_steps[];

/* Appends one line that names two groups of commands: `--json FILE` writes a file, and `--json`
 * without a value prints JSON. `text` fails if memory runs out. */
void help_put_json_rule(Text *text);
/* Appends the option's help, the accepted values, and the value or phrase that applies if the
 * option is not given. `plain` has the default value. `text` fails if memory runs out. */
void help_put_meaning(const Setting *plain, Text *text);
/* Appends `chars`, with a backslash before each character that is in `special`. If `chars` is NULL,
 * from a Text that failed, `text` fails. `text` fails if memory runs out. */
void help_put_escaped(const char *chars, const char *special, Text *text);

/* Appends the heading of a group of options, and the description of one option. `text` fails if
 * memory runs out. */
typedef void HelpHeading(const char *name, Text *text);
typedef void HelpMeaning(const Setting *plain, Text *text);

/* Calls `put_heading` for each group that has options, then `put_option` for each option of the
 * group. Skips the options that the command does not obey, and the common options if `common` is
 * false. */
void help_put_groups(const Parsed *plain, bool common, HelpHeading *put_heading,
                     HelpMeaning *put_option, Text *text);

/* Appends a description of a command. `plain` has the default values. `text` fails if memory runs
 * out. */
typedef void HelpPut(const Parsed *plain, Text *text);

/* Calls `put` with the default values of `command`. Errors: STATUS_MEMORY. */
MUST_CHECK Status help_put(HelpPut *put, const Command *command, Text *text, Err *err);
/* Calls help_put for every command. Errors: STATUS_MEMORY. */
MUST_CHECK Status help_put_all(HelpPut *put, Text *text, Err *err);

/* Appends the manual page of a command, in section 1. `text` fails if memory runs out. */
void manual_put(const Parsed *plain, Text *text);
/* Appends the manual page corcast.1, which lists the commands. `text` fails if memory runs out. */
void manual_put_overview(Text *text);
/* Appends a JSON object whose member "commands" describes `command`, or every command if `command`
 * is NULL, as command_schema does. Errors: STATUS_MEMORY. */
MUST_CHECK Status schema_put(const Command *command, Text *text, Err *err);
/* Appends the content of docs/REFERENCE.md. Errors: STATUS_MEMORY. */
MUST_CHECK Status reference_put(Text *text, Err *err);
/* Append the completion script for bash, zsh or fish. Errors: STATUS_MEMORY. */
MUST_CHECK Status completion_put_bash(Text *text, Err *err);
MUST_CHECK Status completion_put_zsh(Text *text, Err *err);
MUST_CHECK Status completion_put_fish(Text *text, Err *err);

#endif
