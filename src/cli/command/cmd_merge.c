/* Runs `merge`, which writes a file and prints nothing. */
#include "cli/commands.h"
#include "study/merge.h"

Status run_merge(void *options, Parsed *parsed, Err *err)
{
    return merge_run(options, parsed, err);
}
