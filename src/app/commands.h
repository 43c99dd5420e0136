/* The subcommands. Each gets the arguments after its name. */
#ifndef CORCAST_APP_COMMANDS_H
#define CORCAST_APP_COMMANDS_H

#include "base/base.h"

typedef Status CommandRun(int argc, char **argv, Err *err);

CommandRun run_grow, run_refine, run_info, run_convert, run_scene, run_povray, run_render,
    run_compare, run_verify, run_report, run_view, run_models, run_fields, run_looks, run_colormaps,
    run_domains;

typedef struct CommandEntry {
    const char *name; /* NULL ends the table */
    CommandRun *run;
    const char *summary; /* one line */
} CommandEntry;

/* In the order of the help. */
extern const CommandEntry command_entries[];
/* NULL when no command has this name. */
const CommandEntry *command_find(const char *name);

#define GENERATOR "corcast " CORCAST_VERSION

/* Whether a word is one of a list that ends in NULL. */
bool is_one_of(const char *word, const char *const *words);

/* Appends a word as a shell reads it: in quotes where the shell would take it apart. */
void put_shell_word(Text *text, const char *word);

/* The last component of a path as one line of UTF-8 for people and reports, in *out (owned). */
MUST_CHECK Status shown_name(const char *path, char **out, Err *err);

/* The command line as text for provenance, in *out (owned), one line of UTF-8: every argument that
 * is a path cut to its last component, so that no folder of the user's is told, and quoted as for a
 * shell. */
MUST_CHECK Status command_line_text(const char *command, int argc, char **argv, char **out,
                                    Err *err);

/* Writes `object` to `path` ("-": standard output) as indented JSON with a final newline, and lets
 * go of it. Numbers that are not finite must have been left out or set to null. */
MUST_CHECK Status json_write(json_t *object, const char *path, Err *err);

#endif
