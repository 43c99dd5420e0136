/* Helpers for the files that commands write: words quoted for a shell, the command line that a file
 * stores as its provenance, and JSON. If memory runs out, a Text records the failure, which
 * text_check reports. */
#ifndef CORCAST_OPTIONS_OUTPUT_H
#define CORCAST_OPTIONS_OUTPUT_H

#include "options/options.h"
#include "tree/tree.h"

/* Name and version of the program, which written files state. */
#define GENERATOR "corcast " CORCAST_VERSION

/* Returns true if `word` is in the list `words`, which ends with NULL. */
bool is_one_of(const char *word, const char *const *words);
/* Returns true if `word` is one of the words in `words`, which are separated by blanks. If `words`
 * is NULL, returns false. */
bool wordlist_has(const char *words, const char *word);

/* Appends a path, quoted for a shell, as an operand. A path that begins with '-' gets "./" in
 * front. If memory runs out, `text` records it. */
void put_shell_operand(Text *text, const char *path);

/* Sets *out to the last component of a path, as one line of valid UTF-8. The caller frees *out with
 * free(). Errors: STATUS_MEMORY. */
MUST_CHECK Status shown_name(const char *path, char **out, Err *err);

/* Sets *out to the command line for provenance: one line of UTF-8, quoted for a shell. The caller
 * frees *out with free().
 *
 * The line contains the operands, every option whose value differs from the default
 * [setting_differs], and the output. Options with Option.aside, which do not change the result, are
 * left out. The output's name is replaced by the placeholder that the help shows, with the output's
 * extension ("P.png"), unless Option.is_told of the option --output is true. Of each path only the
 * last component is written, so that the line reveals no folder of the user.
 *
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status command_line_text(const Parsed *parsed, char **out, Err *err);

/* Appends a shell command that repeats the run from any folder: `cd HERE && /PATH/corcast COMMAND`,
 * the operands, and every option whose value differs from the default. The caller may append more
 * options.
 *
 * without  names of options to leave out, a list that ends with NULL. --output and --recipe are
 *          always left out.
 * Errors   STATUS_IO if the working folder cannot be found; STATUS_MEMORY. */
MUST_CHECK Status put_rerun_command(const Parsed *parsed, const char *const *without, Text *text,
                                    Err *err);

/* Adds to `hash` the bytes of each file that an option of the kind OPTION_INPUT or OPTION_LOOKUP
 * names. The name of a template is looked up in the templates folder. Options with Option.aside are
 * left out. Errors: STATUS_USAGE for an unknown template; STATUS_INPUT or STATUS_IO if a file
 * cannot be read; STATUS_MEMORY. */
MUST_CHECK Status hash_option_files(const Parsed *parsed, Hash *hash, Err *err);

/* Adds the line of command_line_text to the metadata of a tree. Errors: STATUS_MEMORY. */
MUST_CHECK Status treemeta_add_command(const Parsed *parsed, TreeMeta *meta, Err *err);

/* Writes `object` to `path` ("-" is standard output) as indented JSON with a final newline.
 * Releases the reference to `object`, also after an error. `object` must not contain NaN or
 * infinity. Errors: STATUS_IO; STATUS_MEMORY, also if `object` is NULL. */
MUST_CHECK Status json_write(json_t *object, const char *path, Err *err);

#endif
