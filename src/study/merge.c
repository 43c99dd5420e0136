/* Runs the operation `merge`: joins the runs of a study to a table, or the tiles of a picture. The
 * extension of the output decides which. */
#include "study/merge.h"

#include "job/picture/shard.h"
#include "options/output.h"
#include "study/study_table.h"

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, MergeOptions, output),
     .argument = "P.tif|T.csv",
     .help = "file to write: the complete image, .png, .tif (BigTIFF above 4 GB) or .ppm; or the "
             "table of a study, .csv or .jsonl"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static Status merge_runs(const char *output, Parsed *parsed, Err *err)
{
    StudyTable table = {.shards = true};
    Status status;
    for (int i = 0; i < parsed->n_operands; i++)
        TRY_GOTO(study_table_add(&table, parsed->operands[i], err));
    for (size_t i = 0; i < table.n; i++)
        TRY_GOTO(files_add_input(&parsed->files, "the run", table.row[i].path, err));
    TRY_GOTO(study_table_check(&table, err));
    status = study_table_write(&table, output, err);
done:
    study_table_release(&table);
    return status;
}

Status merge_run(const MergeOptions *options, Parsed *parsed, Err *err)
{
    static const char *const tables[] = {"csv", "jsonl", NULL};
    return is_one_of(file_extension(options->output), tables)
               ? merge_runs(options->output, parsed, err)
               : shards_merge(options->output, parsed, err);
}

const Command command_merge = {
    .name = "merge",
    .summary = "join the strips of one image, or the results of a study's runs",
    .operands = "DIR|FILE... -o P.tif|T.csv",
    .examples = "  corcast render tree.swc --size 30000x30000 -o poster.tif --tiles 64 --commands "
                "> plan.txt\n"
                "  parallel -a plan.txt\n"
                "  corcast merge . -o poster.tif\n"
                "  corcast merge runs -o study.csv\n",
    .min_operands = 1,
    .max_operands = MAX_OPERANDS,
    .needs_output = true,
    .size = sizeof(MergeOptions),
    .tables = {{&own_table, 0}},
};
