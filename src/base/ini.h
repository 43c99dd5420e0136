/* Reads INI files. A line is `name = value`, or `[section]`, which begins a section. */
#ifndef CORCAST_BASE_INI_H
#define CORCAST_BASE_INI_H

#include "base/status.h"

/* Called for each pair and for each section head. `section` is "" before the first section head.
 * For a section head, `name` and `value` are NULL. An error need not name file and line, which
 * ini_read adds. */
typedef Status IniTake(void *user, const char *section, const char *name, const char *value,
                       Err *err);

/* Reads a file and calls `take` for each pair and section head, in the order of the file, until a
 * call fails.
 *
 * A line that begins with ';' or '#' is a comment. A ';' after a blank or a '=' begins a comment
 * that lasts to the end of the line. Blanks at the start of a line, and around names, values and
 * sections, are ignored.
 *
 * what     the kind of file, for errors: "a look".
 * text     receives the buffer that all names and values point into (owned). NULL: the buffer is
 *          freed before ini_read returns.
 * Errors   STATUS_INPUT with file and line for any other line; STATUS_IO; STATUS_MEMORY; any error
 *          of `take`. */
MUST_CHECK Status ini_read(const char *path, const char *what, IniTake *take, void *user,
                           char **text, Err *err);

#endif
