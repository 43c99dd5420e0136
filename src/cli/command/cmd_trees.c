/* Runs the commands that make a tree and write it: grow, refine and bifurcation. */
#include "cli/commands.h"
#include "job/tree/makers.h"

Status run_tree_maker(void *options, Parsed *parsed, Err *err)
{
    MadeTree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(tree_maker_find(parsed->command->name)->make(options, parsed, &made, err));
    status = madetree_write(parsed, &made, err);
done:
    madetree_release(&made);
    return status;
}
