/* A diagram is drawn in memory, then written. */
#include "cli/commands.h"
#include "job/picture/diagram.h"

Status run_diagram(void *options, Parsed *parsed, Err *err)
{
    MadeDiagram made;
    Status status = STATUS_OK;
    TRY_GOTO(diagram_make(options, parsed, &made, err));
    status = diagram_write(options, parsed, &made, err);
done:
    madediagram_release(&made);
    return status;
}
