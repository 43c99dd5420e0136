/* Finds files in the templates folder, which has one subfolder for each kind of file: looks, color
 * maps, presets, waveforms, published tables. The value of an option is either the name of such a
 * file or a path with a '/'. */
#ifndef CORCAST_OPTIONS_TEMPLATES_H
#define CORCAST_OPTIONS_TEMPLATES_H

#include "base/base.h"

/* Sets the templates folder for the calling thread, and returns the folder that was set before.
 * `folder` NULL or "": templates_folder searches for the folder. Both strings are borrowed. */
const char *templates_set(const char *folder);

/* Sets *folder to the templates folder; the caller frees it with free(). If templates_set has set
 * no folder, searches relative to the program or library file that contains this function: in the
 * build tree (../templates, ../../templates) and in the installation (../share/corcast/templates).
 *
 * Errors  STATUS_IO if no folder is found, or if the folder that was set does not contain the
 *         folder "looks"; STATUS_MEMORY. */
MUST_CHECK Status templates_folder(char **folder, Err *err);

/* Sets *path to the path of `name` in the templates folder; the caller frees it with free(). Does
 * not check that the file exists. Errors: those of templates_folder. */
MUST_CHECK Status templates_path(const char *name, char **path, Err *err);

/* Sets *path to the path of the file that `value`, the value of the option --`option`, names. The
 * caller frees *path with free(). A value with a '/' is the path itself. Any other value is the
 * name, without `extension`, of a file in the subfolder `folder` of the templates folder.
 *
 * Errors  STATUS_USAGE, with the existing names, if a named template cannot be read; the errors of
 *         templates_folder. A path with a '/' is not checked. */
MUST_CHECK Status template_file(const char *option, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* As template_file, for a value that does not come from an option. The error sentence begins with
 * `what`. */
MUST_CHECK Status template_find(const char *what, const char *folder, const char *value,
                                const char *extension, char **path, Err *err);

/* Appends the names of the files with this extension in a subfolder of the templates folder:
 * without the extension, sorted, one per line. Appends "none" if there are none. Errors: those of
 * templates_folder. */
MUST_CHECK Status template_names(const char *folder, const char *extension, Text *lines, Err *err);

#endif
