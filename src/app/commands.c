#include "app/commands.h"

#include <string.h>

const Command *const all_commands[] = {
    &command_grow,
    &command_refine,
    &command_info,
    &command_convert,
    &command_scene,
    &command_export,
    &command_povray,
    &command_render,
    &command_view,
    &command_verify,
    &command_compare,
    &command_report,
    &command_models,
    &command_fields,
    &command_looks,
    &command_colormaps,
    &command_domains,
    &command_formats,
    NULL,
};

const Command *command_find(const char *name)
{
    for (const Command *const *command = all_commands; *command; command++)
        if (strcmp((*command)->name, name) == 0)
            return *command;
    return NULL;
}
