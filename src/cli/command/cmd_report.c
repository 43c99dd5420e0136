/* Prints whether all cases agree, unless --quiet is given. */
#include "cli/commands.h"
#include "job/verify/report.h"
#include <stdio.h>

Status run_report(void *options, Parsed *parsed, Err *err)
{
    const ReportOptions *report = options;
    bool agree;
    TRY(report_run(report, parsed, &agree, err));
    if (!parsed->common.quiet)
        printf("%s: %d cases; %s\n", agree ? "agree" : "differ", parsed->n_operands, report->page);
    return agree ? STATUS_OK : STATUS_DIFFERS;
}
