#include "app/commands.h"

#include <string.h>

const CommandEntry command_entries[] = {
    {"grow", run_grow, "grow an arterial tree by constrained constructive optimization"},
    {"refine", run_refine, "lower the target of a tree by whole-tree optimisation"},
    {"info", run_info, "count, measure and check a tree"},
    {"convert", run_convert, "convert trees and images"},
    {"scene", run_scene, "write a tree as a POV-Ray scene"},
    {"povray", run_povray, "run POV-Ray on a scene"},
    {"render", run_render, "render a tree with the native renderer"},
    {"view", run_view, "look at a tree in a window"},
    {"verify", run_verify, "prove that POV-Ray and the native renderer agree"},
    {"compare", run_compare, "compare two images or planes"},
    {"report", run_report, "one page about several verifications"},
    {"models", run_models, "the values of --model"},
    {"fields", run_fields, "the values of --color-by, with their units"},
    {"looks", run_looks, "the values of --look"},
    {"colormaps", run_colormaps, "the values of --colormap"},
    {"domains", run_domains, "the shapes of --domain"},
    {0},
};

const CommandEntry *command_find(const char *name)
{
    for (const CommandEntry *entry = command_entries; entry->name; entry++)
        if (strcmp(entry->name, name) == 0)
            return entry;
    return NULL;
}
