/* Draws pictures into files. */
#include "cli/commands.h"
#include "job/picture/render.h"

Status run_render(void *options, Parsed *parsed, Err *err)
{
    return render_run(options, parsed, err);
}
