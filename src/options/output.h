/* What the output of all commands has in common: provenance and JSON. */
#ifndef CORCAST_OPTIONS_OUTPUT_H
#define CORCAST_OPTIONS_OUTPUT_H

#include "options/options.h"
#include "tree/tree.h"

#define GENERATOR "corcast " CORCAST_VERSION

/* Whether a word is one of a list that ends in NULL. */
bool is_one_of(const char *word, const char *const *words);

/* Appends a file's name as a word for a shell that a command takes for an operand: one that looks
 * like an option gets "./" before it. */
void put_shell_operand(Text *text, const char *path);

/* The last component of a path as one line of UTF-8 for people and reports, in *out (owned). */
MUST_CHECK Status shown_name(const char *path, char **out, Err *err);

/* The command line for provenance, in *out (owned), one line of UTF-8 that a shell takes: the
 * operands, each option that differs from its default, whether it came from the command line or a
 * recipe, and the output under the name that the help gives it; without what the result does not
 * depend on, and of each path the last component alone, so that no folder of the user's is told. */
MUST_CHECK Status command_line_text(const Parsed *parsed, char **out, Err *err);

/* Appends `cd HERE && /PATH/corcast COMMAND`, the operands and each option that differs from its
 * default but the output and those named in `without`, which ends in NULL, all quoted for a shell:
 * the same run from any folder, to which more options may be appended. STATUS_IO when the working
 * folder has no name. */
MUST_CHECK Status command_again(const Parsed *parsed, const char *const *without, Text *text,
                                Err *err);

/* Adds to `hash` the bytes of each file that an option names and the result depends on: files of
 * the user's, and files of templates/ that are chosen by name. Errors as file_read and
 * template_file. */
MUST_CHECK Status hash_option_files(const Parsed *parsed, Hash *hash, Err *err);

/* Adds the command line to those that a tree's file says. */
MUST_CHECK Status command_describe(const Parsed *parsed, TreeMeta *meta, Err *err);

/* Writes `object` to `path` ("-": standard output) as indented JSON with a final newline, and lets
 * go of it. Numbers that are not finite must have been left out or set to null. */
MUST_CHECK Status json_write(json_t *object, const char *path, Err *err);

#endif
