/* The options of `metamorph` and `suite` that name the renderer under test and the output folder.
 */
#ifndef CORCAST_JOB_VERIFY_RENDERER_OPTIONS_H
#define CORCAST_JOB_VERIFY_RENDERER_OPTIONS_H

#include "options/options.h"
#include "oracle/drawing.h"

typedef struct RendererOptions {
    ShellRenderer shell;
    const char *folder; /* output folder; NULL: not given */
    bool json;          /* for the command line: the result is printed as JSON */
} RendererOptions;

/* Sets a RendererOptions, except `folder`, which the operation's own --output sets. */
extern const OptionTable renderer_options;

/* Creates the output folder, and sets *path to its absolute path, because the shell command may
 * change the working folder. The caller frees *path. After an error *path is NULL or unchanged.
 *
 * content  content of the folder, for error sentences: "the reports".
 * Errors   STATUS_USAGE if the options name no shell command or no folder; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status renderer_open_folder(const RendererOptions *options, const char *content,
                                       char **path, Err *err);

#endif
