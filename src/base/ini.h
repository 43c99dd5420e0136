/* INI files: lines `name = value` and, before those of a section, `[section]`. */
#ifndef CORCAST_BASE_INI_H
#define CORCAST_BASE_INI_H

#include "base/status.h"

/* Called for each line: a pair in `section` ("" above the first one), or the head of a section,
 * with `name` and `value` NULL. Its error sentence need not name file and line: ini_read adds
 * them. */
typedef Status IniTake(void *user, const char *section, const char *name, const char *value,
                       Err *err);

/* Reads the file, `what` ("a look") naming its kind in sentences, and calls `take` line by line. A
 * line whose first character is ';' or '#' is a comment, and so is the rest of a line from a ';'
 * that follows a blank or a '='. Blanks around names, values and sections, and in front of lines,
 * do not count. What names and values point into is handed over in *text (owned), or freed when
 * `text` is NULL. STATUS_INPUT, naming file and line, on any other line, and what `take`
 * returns. */
MUST_CHECK Status ini_read(const char *path, const char *what, IniTake *take, void *user,
                           char **text, Err *err);

#endif
