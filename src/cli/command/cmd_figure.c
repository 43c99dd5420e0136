/* Draws a figure, and prints its complete recipe with --dump-recipe. */
#include "cli/commands.h"
#include "job/figure/figure.h"
#include <stdio.h>

Status run_figure(void *options, Parsed *parsed, Err *err)
{
    Figure figure = {0};
    Status status = figure_make(options, parsed, &figure, err);
    if (status == STATUS_OK)
        status = figure_write(&figure, err);
    if (status == STATUS_OK && parsed->common.dump)
        fputs(text_chars(&figure.recipe), stdout);
    figure_done(&figure);
    return status;
}
