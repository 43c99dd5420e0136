#include "app/commands.h"
#include "app/options.h"
#include "app/templates.h"
#include "verify/verify.h"
#include <stdio.h>
#include <stdlib.h>

static const Command command = {
    .name = "report",
    .summary = "one page about several verifications",
    .operands = "DIR... -o PAGE.html",
    .examples = "  corcast verify a.swc -o out/a; corcast verify b.swc -o out/b\n"
                "  corcast report out/a out/b -o out/all.html\n",
    .min_operands = 1,
    .max_operands = MAX_OPERANDS,
    .needs_output = true,
};

/* What report_merge reads of a folder. */
static Status note_case(const char *folder, Files *files, Err *err)
{
    static const char *const names[] = {"report.html", "report.json"};
    for (int i = 0; i < 2; i++) {
        char *path = NULL;
        TRY(file_join(folder, names[i], &path, err));
        Status status = files_read(files, "the case's", path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
}

Status run_report(int argc, char **argv, Err *err)
{
    const char *page = NULL, *power = NULL;
    const Option own[] = {
        {"output", OPTION_OUTPUT, &page, NULL, 0, 0, NULL, "PAGE.html", "the page"},
        {"power", OPTION_INPUT, &power, NULL, 0, 0, NULL, "FILE.json",
         "what `make power` measured, to be shown below the cases"},
        {0},
    };
    const Option *const tables[] = {own, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    char *templates = NULL, *folder = NULL;
    bool agree = false;
    Status status = STATUS_OK;
    if (parsed.common.help)
        goto done;
    for (int i = 0; i < parsed.n_operands; i++)
        TRY_GOTO(note_case(parsed.operands[i], &parsed.files, err));
    TRY_GOTO(templates_folder(&templates, err));
    TRY_GOTO(file_join(templates, "report", &folder, err));
    TRY_GOTO(
        report_merge(parsed.operands, (size_t)parsed.n_operands, power, folder, page, &agree, err));
    if (!parsed.common.quiet)
        printf("%s: %d cases; %s\n", agree ? "agree" : "differ", parsed.n_operands, page);
    status = agree ? STATUS_OK : STATUS_DIFFERS;
done:
    free(folder);
    free(templates);
    parsed_release(&parsed);
    return status;
}
