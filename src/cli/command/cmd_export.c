/* The job prints nothing: what it reports passes through the Talk of the command line. */
#include "cli/commands.h"
#include "job/export/export.h"

Status run_export(void *options, Parsed *parsed, Err *err)
{
    return export_write(options, parsed, NULL, err);
}
