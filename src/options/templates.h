/* Where the files of templates/ are. */
#ifndef CORCAST_OPTIONS_TEMPLATES_H
#define CORCAST_OPTIONS_TEMPLATES_H

#include "base/base.h"

/* Sets the folder for all that the calling thread looks up from now on, and returns the one before.
 * NULL or "": found by the place of the program or library. Borrowed. */
const char *templates_set(const char *folder);

/* Finds the folder: the one that was set, or beside the build folder (../templates,
 * ../../templates), or installed (../share/corcast/templates), in *folder (owned). Errors:
 * STATUS_IO if there is none, or if the one that was set has no looks. */
MUST_CHECK Status templates_folder(char **folder, Err *err);

/* The path of what is called `name` in that folder, in *path (owned), whether it is there or not.
 * Errors as templates_folder. */
MUST_CHECK Status templates_path(const char *name, char **path, Err *err);

/* The file that an option's value names: the value itself when it has a '/', else value + extension
 * in a folder of templates/; in *path (owned). STATUS_USAGE when that does not exist. */
MUST_CHECK Status template_file(const char *option, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* As template_file for a value that no option has: a sentence begins with `what`. */
MUST_CHECK Status template_find(const char *what, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* Appends the names that template_file finds in a folder of templates/, sorted, one a line.
 * STATUS_IO when there are no templates. */
MUST_CHECK Status template_names(const char *folder, const char *extension, Text *lines, Err *err);

#endif
