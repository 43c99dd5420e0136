/* Helpers for the files that commands write: words quoted for a shell, the command line that a file
 * stores as its provenance, and JSON. */
#ifndef CORCAST_OPTIONS_OUTPUT_H
#define CORCAST_OPTIONS_OUTPUT_H

#include "options/options.h"
#include "tree/tree.h"

#define GENERATOR "corcast " CORCAST_VERSION

/* Returns true if `word` is in the list `words`, which NULL ends. */
bool is_one_of(const char *word, const char *const *words);
/* Returns true if `word` is one of the words in `words`, which are separated by blanks. NULL has no
 * words. */
bool is_word_of(const char *words, const char *word);

/* Appends a path, quoted for a shell, as an operand. A path that looks like an option gets "./"
 * before it. `text` fails if memory runs out. */
void put_shell_operand(Text *text, const char *path);

/* Sets *out to the last component of a path as one line of UTF-8; the caller frees it with free().
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status shown_name(const char *path, char **out, Err *err);

/* Sets *out to the command line for provenance, one line of UTF-8 quoted for a shell; the caller
 * frees it with free().
 *
 * The line contains the operands, every option for which setting_differs from the default, and the
 * output. The output has its name in the help, with the real extension, unless Option.is_told is
 * true. Options with Option.aside are left out. Of a path only the last component is written, so
 * that the line reveals no folder of the user.
 *
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status command_line_text(const Parsed *parsed, char **out, Err *err);

/* Appends `cd HERE && /PATH/corcast COMMAND`, the operands, and every option for which
 * setting_differs from the default, quoted for a shell. The command repeats the run from any
 * folder, and more options may be appended.
 *
 * without  names of options to leave out, ended by NULL. --output and --recipe are always left out.
 * Errors   STATUS_IO if the working folder cannot be found. STATUS_MEMORY. */
MUST_CHECK Status command_again(const Parsed *parsed, const char *const *without, Text *text,
                                Err *err);

/* Adds to `hash` the bytes of each file that an option of the kind OPTION_INPUT or OPTION_LOOKUP
 * names, including files of the templates folder. Options with Option.aside are left out. Errors:
 * those of file_read and template_file. */
MUST_CHECK Status hash_option_files(const Parsed *parsed, Hash *hash, Err *err);

/* Adds the line of command_line_text to the metadata of a tree. Errors: STATUS_MEMORY. */
MUST_CHECK Status command_describe(const Parsed *parsed, TreeMeta *meta, Err *err);

/* Writes `object` to `path` ("-" is standard output) as indented JSON with a final newline, and
 * releases the reference, also after an error. `object` may not contain numbers that are not
 * finite. Errors: those of file_write_text. */
MUST_CHECK Status json_write(json_t *object, const char *path, Err *err);

#endif
