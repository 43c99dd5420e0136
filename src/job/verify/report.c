/* Runs the operation `report`: writes one page about the folders of several verifications and
 * comparisons. The module compare merges the reports [compare/compare.h]; this file records the
 * files that it reads. */
#include "job/verify/report.h"

#include "compare/compare.h"
#include "options/templates.h"
#include <stdlib.h>

/* Records the files that report_merge reads in a folder. */
static Status note_case(const char *folder, Files *files, Err *err)
{
    static const char *const names[] = {"report.html", "report.json"};
    for (int i = 0; i < 2; i++) {
        char *path = NULL;
        TRY(file_join(folder, names[i], &path, err));
        Status status = files_add_input(files, "the case's", path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, ReportOptions, page),
     .argument = "PAGE.html",
     .help = "web page to write"},
    {.name = "power",
     SETS(INPUT, ReportOptions, power),
     .argument = "FILE.json",
     .help = "file with the results of `make power`, which the page shows below the cases"},
};

static const OptionTable own_table = OPTION_TABLE(own);

Status report_run(const ReportOptions *options, Parsed *parsed, bool *agree, Err *err)
{
    char *folder = NULL;
    for (int i = 0; i < parsed->n_operands; i++)
        TRY(note_case(parsed->operands[i], &parsed->files, err));
    TRY(templates_path("report", &folder, err));
    Status status = report_merge(
        &(ReportMerge){parsed->operands, (size_t)parsed->n_operands, options->power, folder},
        options->page, agree, err);
    free(folder);
    return status;
}

const Command command_report = {
    .name = "report",
    .summary = "write one web page about several verifications and comparisons",
    .operands = "DIR... -o PAGE.html",
    .examples = "  corcast verify a.swc -o out/a; corcast verify b.swc -o out/b\n"
                "  corcast compare mine.png theirs.png --report out/c\n"
                "  corcast report out/a out/b out/c -o out/all.html\n",
    .min_operands = 1,
    .max_operands = MAX_OPERANDS,
    .needs_output = true,
    .size = sizeof(ReportOptions),
    .tables = {{&own_table, 0}},
};
