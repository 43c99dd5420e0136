/* Resolves the paths in the recipe of a figure. Relative paths are relative to the recipe's folder,
 * not to the working directory. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_PATHS_H
#define CORCAST_JOB_FIGURE_FIGURE_PATHS_H

#include "options/options.h"

/* Prefixes `folder` to the relative paths in the values of options: input files, templates whose
 * name contains a '/', files of values, and files in the description of a domain. Does not change
 * the option `recipe` and the options that `is_fixed` selects.
 *
 * folder     ends with '/'; "": nothing changes.
 * is_fixed   returns true for a setting that is not to be changed; NULL: there is no such setting.
 * Errors     STATUS_MEMORY. The values before the error are then changed already. */
MUST_CHECK Status figure_resolve_paths(Parsed *parsed, const char *folder,
                                bool (*is_fixed)(const Setting *setting), Err *err);

/* Prefixes `folder` to a relative path. Copies an absolute path unchanged, and "-", which is
 * standard input.
 *
 * folder   ends with '/', or is "".
 * out      receives the path; the caller frees it. Unchanged after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status figure_path(const char *folder, const char *path, char **out, Err *err);

#endif
