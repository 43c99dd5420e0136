/* Implements the functions of the library that analyse trees: pulse waves, steady flow in networks,
 * the distance of tissue from vessels, and answers for pictures. Each runs the job of the command
 * with the same name, in memory. */
#include "api/reports.h"
#include "api/request.h"

#include "job/coverage/coverage.h"
#include "job/flow/flowing.h"
#include "job/pulse/pulsing.h"
#include "job/verify/answer.h"
#include "options/output.h"
#include <stdlib.h>

/* ---- pulse ----------------------------------------------------------------------------------- */

static Status pulse(corcast_tree *tree, const RequestArguments *form, corcast_report **report,
                    const Call *call, Err *err)
{
    Request request = {0};
    Pulsing made = {0};
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(pulsing_make(request.parsed.options, &request.parsed, &made, err));
    TRY_GOTO(pulsing_write(&made, err));
    TRY_GOTO(pulsing_add_columns(&made, err));
    if (report)
        TRY_GOTO(report_new(pulsing_json(&made), report, err));
    tree_handle_replace(tree, &made.tree);
done:
    pulsing_release(&made);
    return request_close(&request, status, err);
}

int corcast_pulse(corcast_tree *tree, const corcast_options *options, corcast_report **report,
                  corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {.commands = "pulse", .options = options, .tree = tree};
    return call_end(&call, pulse(tree, &form, report, &call, &call.err));
}

/* ---- flow ------------------------------------------------------------------------------------ */

static Status flow(corcast_tree *tree, const RequestArguments *form, corcast_report **report,
                   const Call *call, Err *err)
{
    Request request = {0};
    Flowing made = {0};
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(flowing_make(request.parsed.options, &request.parsed, &made, err));
    TRY_GOTO(flowing_write(&made, err));
    if (report)
        TRY_GOTO(report_new(flowing_json(&made), report, err));
    tree_handle_replace(tree, &made.tree);
done:
    flowing_release(&made);
    return request_close(&request, status, err);
}

int corcast_flow(corcast_tree *tree, const corcast_options *options, corcast_report **report,
                 corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {.commands = "flow", .options = options, .tree = tree};
    return call_end(&call, flow(tree, &form, report, &call, &call.err));
}

/* ---- coverage -------------------------------------------------------------------------------- */

static Status coverage(const RequestArguments *form, corcast_report **report, const Call *call,
                       Err *err)
{
    Request request = {0};
    CoverageResult found = {0};
    char *command = NULL;
    Status status = STATUS_OK;
    TRY(handle_check(form->tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(report, "report", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(command_line_text(&request.parsed, &command, err));
    TRY_GOTO(coverage_make(request.parsed.options, &request.parsed, &found, err));
    status = report_new(coverage_json(&found, command), report, err);
done:
    free(command);
    coverageresult_release(&found);
    return request_close(&request, status, err);
}

int corcast_coverage(const corcast_tree *tree, const corcast_options *options,
                     corcast_report **report, corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {.commands = "coverage", .options = options, .tree = tree};
    return call_end(&call, coverage(&form, report, &call, &call.err));
}

/* ---- answer ---------------------------------------------------------------------------------- */

static Status answer(const RequestArguments *form, corcast_report **report, const Call *call,
                     Err *err)
{
    Request request = {0};
    AnswerReport found;
    Status status = STATUS_OK;
    TRY(handle_check(form->tree, HANDLE_TREE, "tree", err));
    TRY(path_check(form->output, "path", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(answer_run(request.parsed.options, &request.parsed, &found, err));
    if (report)
        status = report_new(answer_json(&found), report, err);
done:
    return request_close(&request, status, err);
}

int corcast_answer(const corcast_tree *tree, const corcast_options *options, const char *path,
                   corcast_report **report, corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {
        .commands = "answer", .options = options, .tree = tree, .output = path};
    return call_end(&call, answer(&form, report, &call, &call.err));
}
