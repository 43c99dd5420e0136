/* Where the files of templates/ are. */
#ifndef CORCAST_OPTIONS_TEMPLATES_H
#define CORCAST_OPTIONS_TEMPLATES_H

#include "base/base.h"

/* The folder: CORCAST_TEMPLATES unless it is empty, or beside the build folder (../templates,
 * ../../templates), or installed (../share/corcast/templates); in *folder (owned). STATUS_IO when
 * there is none, or when CORCAST_TEMPLATES is not such a folder. */
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
