/* Lists the operations whose result is a tree, and writes such a tree and its report. The table is
 * for callers that choose an operation by its name: the command line, the library, and figures,
 * whose panels may show a tree that a command makes. */
#include "job/tree/makers.h"

#include "options/output.h"
#include "treeio/treeio.h"
#include <string.h>

static const TreeMaker makers[] = {{&command_grow, grow_make},
                                   {&command_refine, refine_make},
                                   {&command_bifurcation, bifurcation_make}};

const TreeMaker *tree_maker_find(const char *name)
{
    for (size_t i = 0; i < sizeof makers / sizeof *makers; i++)
        if (strcmp(makers[i].command->name, name) == 0)
            return &makers[i];
    return NULL;
}

void madetree_release(MadeTree *made)
{
    tree_release(&made->tree);
    json_decref(made->report);
    *made = (MadeTree){0};
}

Status madetree_report(MadeTree *made, json_t *report, Err *err)
{
    made->report = report;
    return report ? STATUS_OK
                  : err_set(err, STATUS_MEMORY, "out of memory: no room for the report of a tree");
}

Status tree_output_check(const char *path, Err *err)
{
    return path ? tree_format_check(path, err) : STATUS_OK;
}

/* Appends what the format of `path` cannot hold; nothing if it holds all. */
static void put_left_out(const Tree *tree, const char *path, const TreeLosses *lost, Text *text)
{
    const struct {
        bool is_lost;
        const char *what;
    } others[] = {{lost->types, "the types"},
                  {lost->flow_shares, "the flow shares"},
                  {lost->terminal_flow, "the key terminal_flow"},
                  {lost->root_values, "the roots' values"},
                  {lost->root_radii, "the roots' own radii"},
                  {lost->isolated_roots, "the roots without segments"},
                  {lost->link_radii, "the radii of segments that close loops"}};
    size_t n = 0;
    for (size_t k = 0; k < tree->n_columns; k++)
        if (!tree_format_stores(path, &tree->column[k]))
            text_printf(text, "%s%.40s", n++ ? ", " : "the columns ", tree->column[k].name);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i].is_lost)
            text_printf(text, "%s%s", n++ ? " and " : "", others[i].what);
}

Status tree_output(const Tree *tree, const char *path, const Talk *talk, Err *err)
{
    TreeLosses lost;
    Text left_out = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(tree_format_losses(path, tree, &lost, err));
    put_left_out(tree, path, &lost, &left_out);
    TRY_GOTO(text_check(&left_out, err));
    TRY_GOTO(tree_write(tree, path, err));
    if (*text_chars(&left_out))
        talk_note(talk, "%s are left out: the format cannot store them", text_chars(&left_out));
    if (lost.merged > 0)
        talk_note(talk,
                  "%zu nodes share a position with another node; this format identifies nodes by "
                  "position, so their segments may be lost when the file is read",
                  lost.merged);
done:
    text_release(&left_out);
    return status;
}

Status madetree_write(const Parsed *parsed, const MadeTree *made, Err *err)
{
    TRY(tree_output(&made->tree, parsed_text(parsed, "output"), parsed->common.talk, err));
    const char *path = parsed_text(parsed, "json");
    return path ? json_write(json_incref(made->report), path, err) : STATUS_OK;
}
