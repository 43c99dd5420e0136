/* Draws pictures into files, or prints the commands that draw their parts. */
#include "cli/commands.h"
#include "job/picture/render.h"

Status run_render(void *options, Parsed *parsed, Err *err)
{
    RenderOptions *render = options;
    Text lines = TEXT_TO(stdout);
    Status status;
    render->shard.lines = &lines;
    TRY_GOTO(render_run(render, parsed, err));
    status = text_flush(&lines, err);
done:
    text_release(&lines);
    return status;
}
