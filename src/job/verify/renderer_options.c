/* Defines the options that describe a renderer under test, which is a shell command, and makes the
 * output folder. All operations that test renderers have these options. */
#include "job/verify/renderer_options.h"

#include <stdlib.h>

static const Option own[] = {
    {.name = "render",
     SETS(TEXT, RendererOptions, shell.command),
     .argument = "COMMAND",
     .help = "shell command that renders the file {scene} into the PNG, PPM, TIFF or EXR file "
             "{picture} of {width} x {height} pixels. With --format swc, {camera} stands for the "
             "camera options of `corcast render`. If COMMAND has no {scene}, corcast appends the "
             "file names of scene and picture to the command"},
    {.name = "timeout",
     SETS(NUMBER, RendererOptions, shell.timeout_s),
     FROM_TO(0.1, 1e5),
     .unit = "s",
     .help = "maximum time of one rendering; a rendering that takes longer is ended and counts "
             "as not drawn"},
    {.name = "jobs",
     SETS(WHOLE, RendererOptions, shell.jobs),
     FROM_TO(1, DRAWING_JOBS),
     .aside = true,
     .argument = "N",
     .help = "number of renderings that run at the same time"},
    {.name = "json",
     SETS(FLAG, RendererOptions, json),
     .help = "print the result as JSON on standard output"},
};

const OptionTable renderer_options = OPTION_TABLE(own);

Status renderer_open_folder(const RendererOptions *options, const char *content, char **path,
                            Err *err)
{
    if (!options->shell.command || !*options->shell.command)
        return err_set(err, STATUS_USAGE,
                       "--render needs a command, such as --render 'povray +I{scene} +O{picture} "
                       "+W{width} +H{height} -D'");
    if (!options->folder)
        return err_set(err, STATUS_USAGE, "-o DIR, the folder that receives %s, is missing",
                       content);
    TRY(file_make_folder(options->folder, err));
    *path = realpath(options->folder, NULL);
    return *path ? STATUS_OK
                 : err_set(err, STATUS_IO, "%s: the folder no longer exists", options->folder);
}
