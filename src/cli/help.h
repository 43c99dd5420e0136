/* Commands and their options as text: help, manual pages, the reference, completions of shells.
 * All is made of the descriptions. */
#ifndef CORCAST_CLI_HELP_H
#define CORCAST_CLI_HELP_H

#include "options/options.h"

/* Prints what `corcast COMMAND --help` does; without a command, what `corcast --help` does. */
MUST_CHECK Status help_print(const Command *command, Err *err);

/* "Exit status: ..." without those words, one line. */
extern const char help_exit_status[];

/* Appends the option's meaning, which values it takes, and what holds without it; `plain` has its
 * default. */
void help_put_meaning(const Setting *plain, Text *text);
/* Appends the chars, after a backslash those that are among `special`; NULL, from a text that
 * failed, makes `text` fail. */
void help_put_escaped(const char *chars, const char *special, Text *text);

/* All of these append; `plain` has the defaults of a command. */
typedef void HelpPut(const Parsed *plain, Text *text);

/* What `put` makes of the command with its defaults. */
MUST_CHECK Status help_put(HelpPut *put, const Command *command, Text *text, Err *err);
/* Likewise of all commands. */
MUST_CHECK Status help_put_all(HelpPut *put, Text *text, Err *err);

/* A page for man, of section 1. */
void manual_put(const Parsed *plain, Text *text);
/* The page corcast.1, which names the others. */
void manual_put_overview(Text *text);
/* Appends a JSON object whose member "commands" describes a command, or all if it is NULL, as
 * command_schema does. */
MUST_CHECK Status schema_put(const Command *command, Text *text, Err *err);
/* docs/REFERENCE.md. */
MUST_CHECK Status reference_put(Text *text, Err *err);
/* Completion for bash, zsh, fish. */
MUST_CHECK Status completion_put_bash(Text *text, Err *err);
MUST_CHECK Status completion_put_zsh(Text *text, Err *err);
MUST_CHECK Status completion_put_fish(Text *text, Err *err);

#endif
