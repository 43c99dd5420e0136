/* Resolves the paths in the recipe of a figure: relative paths refer to the recipe's folder, not to
 * the working directory. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_PATHS_H
#define CORCAST_JOB_FIGURE_FIGURE_PATHS_H

#include "options/options.h"

/* Prefixes `folder` to the relative paths in the values of options. These are input files,
 * templates whose name contains a '/', files that --color-by names, and files in the description of
 * a domain. Changes neither the option `recipe` nor the options that `is_fixed` selects.
 *
 * folder    ends with '/'; "": nothing changes.
 * is_fixed  returns true for an option that must not be changed; NULL: there is no such option.
 * Errors    STATUS_MEMORY, after which some values are changed already. */
MUST_CHECK Status figure_resolve_paths(Parsed *parsed, const char *folder,
                                       bool (*is_fixed)(const Setting *setting), Err *err);

/* Prefixes `folder` to a relative path. Copies an absolute path, and "-" (standard input),
 * unchanged.
 *
 * folder  ends with '/', or is "".
 * out     receives the path; the caller frees it. Unchanged after an error.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status figure_path(const char *folder, const char *path, char **out, Err *err);

#endif
