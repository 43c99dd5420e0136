/* Finds files in the templates folder, which has one subfolder per kind: looks, color maps,
 * presets, waveforms, published tables. An option takes the name of such a file, or a path with a
 * '/'. */
#ifndef CORCAST_OPTIONS_TEMPLATES_H
#define CORCAST_OPTIONS_TEMPLATES_H

#include "base/base.h"

/* Sets the templates folder for the calling thread, and returns the folder that was set before.
 * NULL
 * or "": templates_folder searches for it. Both strings are borrowed. */
const char *templates_set(const char *folder);

/* Sets *folder to the templates folder; the caller frees it with free(). If templates_set has set
 * none, searches near the file that contains this code: the build tree (../templates,
 * ../../templates) and the installation (../share/corcast/templates).
 *
 * Errors  STATUS_IO if no folder is found, or if the one that was set has no folder "looks".
 *         STATUS_MEMORY. */
MUST_CHECK Status templates_folder(char **folder, Err *err);

/* Sets *path to the path of `name` in the templates folder; the caller frees it with free(). Does
 * not check that the file exists. Errors: those of templates_folder. */
MUST_CHECK Status templates_path(const char *name, char **path, Err *err);

/* Sets *path to the file that the value of --`option` names; the caller frees it with free(). A
 * value with a '/' is the path. Any other value names the file value + extension in the subfolder
 * `folder` of the templates folder.
 *
 * Errors  STATUS_USAGE, with the names that exist, if a named template cannot be read. A path with
 *         a '/' is not checked. The errors of templates_folder. */
MUST_CHECK Status template_file(const char *option, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* Does what template_file does for a value of no option. The error sentence begins with `what`. */
MUST_CHECK Status template_find(const char *what, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* Appends the names without extension in a subfolder of the templates folder, sorted, one per line;
 * "none" if there is none. Errors: those of templates_folder. */
MUST_CHECK Status template_names(const char *folder, const char *extension, Text *lines, Err *err);

#endif
