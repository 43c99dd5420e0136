/* Prints the list of color maps, unless their picture goes to standard output. */
#include "cli/commands.h"
#include "job/picture/colormaps.h"
#include <stdio.h>
#include <string.h>

Status run_colormaps(void *options, Parsed *parsed, Err *err)
{
    const ColormapsOptions *own = options;
    ColormapsResult result = {0};
    Status status = colormaps_make(own, &result, err);
    if (status == STATUS_OK && own->output)
        status = colormaps_write(own, parsed, &result, err);
    if (status == STATUS_OK && (!own->output || strcmp(own->output, "-") != 0))
        fputs(text_chars(&result.lines), stdout);
    colormaps_release(&result);
    return status;
}
