/* Paths in the recipe of a figure. They start at the recipe's folder, wherever the program runs. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_PATHS_H
#define CORCAST_JOB_FIGURE_FIGURE_PATHS_H

#include "options/options.h"

/* Puts `folder` before the relative paths among the values of options: files, templates that are
 * named with a '/', files of values, and files in a domain's description. The option `recipe` and
 * options that `is_fixed` names keep their values.
 *
 * folder    with its final '/'; "": nothing changes.
 * is_fixed  returns true for a setting that keeps its value; NULL: there is none.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status figure_rebase(Parsed *parsed, const char *folder,
                                bool (*is_fixed)(const Setting *setting), Err *err);

/* Makes the path that `path` is from the folder, in *out (owned). "-" is standard input. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status figure_path(const char *folder, const char *path, char **out, Err *err);

#endif
