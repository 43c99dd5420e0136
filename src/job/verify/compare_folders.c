/* A folder of pictures against a folder of references, as a suite of tests. */
#include "job/picture/coloring.h"
#include "job/verify/compare_options.h"
#include "options/output.h"

#include <stdio.h>
#include <stdlib.h>

static Status put_suite(const CompareOptions *options, const Suite *suite, const char *folder,
                        double seconds, bool quiet, Err *err)
{
    Text text = TEXT_INIT, xml = TEXT_INIT;
    Status status = STATUS_OK;
    suite_junit(suite, folder, seconds, &xml);
    if (options->junit)
        TRY_GOTO(file_write_text(options->junit, &xml, err));
    if (options->json)
        TRY_GOTO(json_write(suite_json(suite), "-", err));
    if (!quiet && !options->json)
        suite_text(suite, &text);
    TRY_GOTO(text_check(&text, err));
    fwrite(text_chars(&text), 1, text.length, stdout);
done:
    text_release(&text);
    text_release(&xml);
    return status;
}

Status compare_folders(const CompareOptions *options, const Parsed *parsed, Err *err)
{
    const char *folder = parsed->operands[0];
    if (parsed->n_operands != 1)
        return err_set(err, STATUS_USAGE,
                       "--reference takes one folder of pictures, not two files");
    if (!options->accept != !options->reason || (options->reason && !*options->reason))
        return err_set(err, STATUS_USAGE, "--accept and --reason go together; one is missing");
    if (options->accept)
        return suite_accept(options->reference, folder, options->accept, options->reason, err);
    const Rgb ground = rgb_of_option(options->background);
    const float background[3] = {ground.r, ground.g, ground.b};
    Tolerance tolerance;
    Suite suite = {0};
    char *tier_name = NULL;
    double start_s = clock_seconds();
    Status status = STATUS_OK;
    TRY_GOTO(compare_tolerance(&options->judge, options->depth_mm, &tolerance, &tier_name, err));
    TRY_GOTO(suite_judge(&suite, options->reference, folder, &tolerance, background,
                         parsed->common.threads, err));
    TRY_GOTO(
        put_suite(options, &suite, folder, clock_seconds() - start_s, parsed->common.quiet, err));
    status = suite.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    suite_release(&suite);
    free(tier_name);
    return status;
}
