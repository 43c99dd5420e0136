/* Runs the jobs that write files of a tree: meshes, scenes, pictures and figures. */
#include "api/reports.h"
#include "api/request.h"
#include "api/sink.h"

#include "job/coverage/coverage.h"
#include "job/export/export.h"
#include "job/export/scene.h"
#include "job/figure/figure.h"
#include "job/job.h"
#include "job/picture/convert.h"
#include "job/picture/diagram.h"
#include "job/picture/render.h"
#include "job/pulse/pulsing.h"
#include <stdlib.h>
#include <string.h>

/* ---- to files -------------------------------------------------------------------------------- */

/* Runs the job of a command that writes files. */
typedef Status RunJob(void *options, Parsed *parsed, Err *err);

static Status export_pulse(void *options, Parsed *parsed, Err *err)
{
    Pulsing made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(pulsing_make(options, parsed, &made, err));
    if (pulsing_is_picture(made.options->output))
        TRY_GOTO(err_set(err, STATUS_USAGE,
                         "corcast_export writes no pictures of pulse waves; draw the tree of "
                         "corcast_pulse with the option \"beat\""));
    status = pulsing_write(&made, err);
done:
    pulsing_release(&made);
    return status;
}

static Status export_coverage(void *options, Parsed *parsed, Err *err)
{
    CoverageResult found = {0};
    Status status = coverage_make(options, parsed, &found, err);
    coverageresult_release(&found);
    return status;
}

/* The operations that write files, by command. */
static const struct {
    const Command *command;
    RunJob *run;
} exporters[] = {{&command_export, export_run},       {&command_scene, scene_run},
                 {&command_render, render_run},       {&command_convert, convert_run},
                 {&command_diagram, diagram_run},     {&command_pulse, export_pulse},
                 {&command_coverage, export_coverage}};

static const char of_export[] = "export scene render convert diagram pulse coverage";

static RunJob *find_exporter(const Command *command)
{
    size_t i = 0;
    while (exporters[i].command != command) /* request_open accepts only these commands */
        i++;
    return exporters[i].run;
}

static Status run_export(const RequestArguments *form, const Call *call, Err *err)
{
    Request request = {0};
    Status status = STATUS_OK;
    TRY_GOTO(request_open(&request, form, call, err));
    Parsed *parsed = &request.parsed;
    status = find_exporter(parsed->command)(parsed->options, parsed, err);
done:
    return request_close(&request, status, err);
}

static Status export_files(const corcast_tree *tree, const corcast_options *options,
                           const char *path, const Call *call, Err *err)
{
    const RequestArguments form = {.commands = of_export,
                                   .options = options,
                                   .tree = tree,
                                   .output = path,
                                   .needs_options = true};
    TRY(handle_check(tree, HANDLE_TREE, "tree", err));
    TRY(path_check(path, "path", err));
    return run_export(&form, call, err);
}

int corcast_export(const corcast_tree *tree, const corcast_options *options, const char *path,
                   corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, export_files(tree, options, path, &call, &call.err));
}

/* ---- to a sink ------------------------------------------------------------------------------- */

/* The arguments of corcast_export_bytes. */
typedef struct ExportSource {
    const corcast_tree *tree;
    const corcast_options *options;
    const Call *call;
} ExportSource;

static Status export_source(const void *context, const char *path, Err *err)
{
    const ExportSource *from = context;
    return export_files(from->tree, from->options, path, from->call, err);
}

int corcast_export_bytes(const corcast_tree *tree, const corcast_options *options, const char *name,
                         corcast_sink *sink, void *user, corcast_error *error)
{
    Call call = call_begin(error);
    const Sink to = {sink, user, call.caller_locale};
    const ExportSource from = {tree, options, &call};
    return call_end(&call, sink_files(&to, name, export_source, &from, &call.err));
}

/* ---- figures --------------------------------------------------------------------------------- */

static Status draw_figure(const RequestArguments *form, const Call *call, Err *err)
{
    Request request = {0};
    Figure figure = {0};
    Status status = STATUS_OK;
    TRY(path_check(form->operand, "recipe", err));
    TRY(path_check(form->output, "path", err));
    TRY_GOTO(request_open(&request, form, call, err));
    TRY_GOTO(figure_make(request.parsed.options, &request.parsed, &figure, err));
    status = figure_write(&figure, err);
done:
    figure_done(&figure);
    return request_close(&request, status, err);
}

int corcast_figure(const char *recipe, const corcast_options *options, const char *path,
                   corcast_error *error)
{
    Call call = call_begin(error);
    const RequestArguments form = {
        .commands = "figure", .options = options, .operand = recipe, .output = path};
    return call_end(&call, draw_figure(&form, &call, &call.err));
}
