/* Reads INI files. A line is `name = value`, or `[section]`, which begins a section. */
#ifndef CORCAST_BASE_INI_H
#define CORCAST_BASE_INI_H

#include "base/status.h"

/* Receives a pair `name = value`, or a section head, for which `name` and `value` are NULL.
 * `section` is "" before the first section head. ini_read adds file and line to the sentence of an
 * error. */
typedef Status IniTake(void *user, const char *section, const char *name, const char *value,
                       Err *err);

/* Reads a file and calls `take` for each pair and section head, in the order of the file, until a
 * call fails.
 *
 * An empty line, and a line that begins with ';' or '#', is ignored. A ';' after a blank or a '='
 * begins a comment that lasts to the end of the line. Blanks at the start of a line, and around
 * names, values and sections, are ignored.
 *
 * what     the kind of file, for errors: "a plan".
 * user     data of the caller, which is passed to `take`.
 * text     receives the buffer that contains all names and values; the caller frees it with free().
 *          NULL: names and values are valid only during the call of `take`.
 * Errors   STATUS_INPUT with file and line for any other line; STATUS_IO; STATUS_MEMORY; any error
 *          of `take`. */
MUST_CHECK Status ini_read(const char *path, const char *what, IniTake *take, void *user,
                           char **text, Err *err);

#endif
