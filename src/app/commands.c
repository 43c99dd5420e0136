/* The commands there are, in the order of the help. A new one is its row here, its declaration, and
 * a file cmd_NAME.c. */
#include "app/commands.h"

#include <string.h>

const Command *const all_commands[] = {
    &command_grow,    &command_refine,        &command_study,  &command_info,      &command_convert,
    &command_scene,   &command_export,        &command_povray, &command_render,    &command_merge,
    &command_diagram, &command_view,          &command_verify, &command_compare,   &command_report,
    &command_models,  &command_fields,        &command_looks,  &command_colormaps, &command_domains,
    &command_formats, &command_morphometries, &command_help,   &command_version,   NULL,
};

const Command *command_find(const char *name)
{
    for (const Command *const *command = all_commands; *command; command++)
        if (strcmp((*command)->name, name) == 0)
            return *command;
    return NULL;
}

Status command_unknown(const char *name, Err *err)
{
    Suggestion suggestion = suggestion_for(name, strlen(name));
    for (const Command *const *command = all_commands; *command; command++)
        suggestion_offer(&suggestion, (*command)->name);
    Status status = err_set(err, STATUS_USAGE,
                            "unknown command '%s'; corcast --help lists those there are", name);
    suggestion_add(&suggestion, "", err);
    return status;
}
