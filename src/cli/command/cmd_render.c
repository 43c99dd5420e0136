/* Pictures are files. Printed are the commands that draw their parts. */
#include "cli/commands.h"
#include "job/picture/render.h"

Status run_render(void *options, Parsed *parsed, Err *err)
{
    Text lines = TEXT_TO(stdout);
    Status status;
    ((RenderOptions *)options)->shard.lines = &lines;
    TRY_GOTO(render_run(options, parsed, err));
    status = text_flush(&lines, err);
done:
    text_release(&lines);
    return status;
}
