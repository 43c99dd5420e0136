/* Computes an answer and prints how many pixels are decided. */
#include "cli/commands.h"
#include "job/verify/answer.h"
#include <stdio.h>

Status run_answer(void *options, Parsed *parsed, Err *err)
{
    const AnswerOptions *answer = options;
    AnswerReport report;
    TRY(answer_run(options, parsed, &report, err));
    if (!parsed->common.quiet)
        printf("%s: %zu of %zu pixels decided to %s; %zu %s, %.2f s of processor time\n",
               answer->output, report.pixels - report.undecided, report.pixels, answer->width,
               report.beams, answer->area ? "leaves" : "rays", report.cpu_s);
    return STATUS_OK;
}
