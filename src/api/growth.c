/* Implements the functions of the library that make, change and measure trees. Each runs the job of
 * the command with the same name, in memory. */
#include "api/reports.h"
#include "api/request.h"

#include "job/tree/certify.h"
#include "job/tree/info.h"
#include "job/tree/makers.h"
#include <string.h>

/* ---- trees that are made --------------------------------------------------------------------- */

/* Makes a tree and, unless `report` is NULL, the report that the command line writes with
 * --json. */
static Status make_tree(const RequestArguments *form, MadeTree *made, corcast_report **report,
                        const Call *call, Err *err)
{
    Request request = {0};
    Status status = STATUS_OK;
    TRY_GOTO(request_open(&request, form, call, err));
    Parsed *parsed = &request.parsed;
    const bool has_json = parsed_find(parsed, "json", strlen("json")) != NULL;
    /* The option makes the job produce a report. The file is never written. */
    if (report && has_json)
        TRY_GOTO(options_set(parsed, "json", "report.json", err));
    TRY_GOTO(tree_maker_find(parsed->command->name)->make(parsed->options, parsed, made, err));
    if (report)
        status = report_new(has_json ? json_incref(made->report) : json_object(), report, err);
done:
    return request_close(&request, status, err);
}

static Status grow(const corcast_options *options, corcast_tree **out, corcast_report **report,
                   const Call *call, Err *err)
{
    const RequestArguments form = {
        .commands = "grow bifurcation", .options = options, .needs_options = true};
    MadeTree made = {0};
    Status status = STATUS_OK;
    TRY(argument_check(out, "out", err));
    TRY_GOTO(make_tree(&form, &made, report, call, err));
    status = tree_handle_new(&made.tree, NULL, out, err);
    if (status != STATUS_OK && report) {
        corcast_report_free(*report);
        *report = NULL;
    }
done:
    madetree_release(&made);
    return status;
}

int corcast_grow(const corcast_options *options, corcast_tree **out, corcast_report **report,
                 corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, grow(options, out, report, &call, &call.err));
}

static Status refine(corcast_tree *tree, const corcast_options *options, corcast_report **report,
                     const Call *call, Err *err)
{
    const RequestArguments form = {.commands = "refine", .options = options, .tree = tree};
    MadeTree made = {0};
    Status status = STATUS_OK;
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY_GOTO(make_tree(&form, &made, report, call, err));
    tree_handle_replace(tree, &made.tree);
done:
    madetree_release(&made);
    return status;
}

int corcast_refine(corcast_tree *tree, const corcast_options *options, corcast_report **report,
                   corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, refine(tree, options, report, &call, &call.err));
}

/* ---- facts about trees ----------------------------------------------------------------------- */

static Status certify(const RequestArguments *form, corcast_report **report, const Call *call,
                      Err *err)
{
    Request request = {0};
    Certified found = {0};
    Status status = STATUS_OK;
    TRY(handle_check(form->tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(report, "report", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(certify_make(request.parsed.options, &request.parsed, &found, err));
    status = report_new(certified_json(&found), report, err);
done:
    certified_release(&found);
    return request_close(&request, status, err);
}

int corcast_certify(const corcast_tree *tree, const corcast_options *options,
                    corcast_report **report, corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {.commands = "certify", .options = options, .tree = tree};
    return call_end(&call, certify(&form, report, &call, &call.err));
}

static Status measure(const RequestArguments *form, corcast_report **report, const Call *call,
                      Err *err)
{
    Request request = {0};
    InfoReport found = {0};
    Status status = STATUS_OK;
    TRY(handle_check(form->tree, HANDLE_TREE, "tree", err));
    TRY(argument_check(report, "report", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(options_set(&request.parsed, "json", "on", err));
    TRY_GOTO(info_make(request.parsed.options, &request.parsed, &found, err));
    status = report_new(inforeport_json(&found), report, err);
done:
    inforeport_release(&found);
    return request_close(&request, status, err);
}

int corcast_info(const corcast_tree *tree, const corcast_options *options, corcast_report **report,
                 corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {.commands = "info", .options = options, .tree = tree};
    return call_end(&call, measure(&form, report, &call, &call.err));
}
