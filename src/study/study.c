/* Grows the runs of a study in parallel, and makes the tables of their results. A run grows one
 * tree, with one combination of the values that the plan lists. Runs are independent. Each run is
 * grown by one thread, so that all processors are busy for trees of any size. Each run writes a
 * file, and the tables are made from these files at the end. The tables are therefore the same if
 * the study was interrupted and resumed, or if its runs were grown on other machines with
 * `--commands`. */
#include "study/study.h"

#include "options/output.h"
#include "options/talk.h"
#include "study/study_run.h"
#include "study/study_table.h"
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const Option own[] = {
    {.name = "output",
     SETS(FOLDER, StudyOptions, output),
     .argument = "DIR",
     .excludes = "table",
     .help = "folder to write to, made if it does not exist: a JSON file per run, and the tables "
             "study.csv and study.jsonl of all runs"},
    {.name = "trees",
     SETS(FLAG, StudyOptions, trees),
     .excludes = "table",
     .help = "also write the tree of each run, as SWC"},
    {.name = "table",
     SETS(FLAG, StudyOptions, table),
     .help = "grow nothing, but join results in one CSV table on standard output. The operands "
             "are then files of `corcast info --json` or folders of studies, instead of PLAN.ini"},
    {.name = "only",
     SETS(WHOLE, StudyOptions, only),
     FROM_TO(1, STUDY_MAX_RUNS),
     .group = GROUP_PARTS,
     .argument = "K",
     .otherwise = "",
     .excludes = "table commands",
     .help = "grow only run K of the plan, and write no tables; the first run is 1; `corcast "
             "merge` joins the results"},
    {.name = "commands",
     SETS(FLAG, StudyOptions, commands),
     .group = GROUP_PARTS,
     .excludes = "table",
     .help = "grow nothing; print one command per run on standard output, for GNU parallel, "
             "Slurm and others"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)set;
    (void)parsed;
    return WHEN(OWN_SEED);
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

/* The runs that are grown, and their progress. */
typedef struct StudyRuns {
    StudyRunParams params;
    size_t first, n;      /* the runs first .. first + n - 1 */
    char **path;          /* per run: its file; owned */
    pthread_mutex_t lock; /* protects the members below */
    size_t done, kept, failed;
    FirstFail fail; /* the error of the failed run with the lowest index */
    Progress progress;
} StudyRuns;

static void runs_release(StudyRuns *runs)
{
    for (size_t i = 0; runs->path && i < runs->n; i++)
        free(runs->path[i]);
    free(runs->path);
    pthread_mutex_destroy(&runs->lock);
}

/* ---- growing --------------------------------------------------------------------------------- */

/* Counts a run that has ended, and reports the progress. The caller holds the lock. */
static void count(StudyRuns *runs, size_t index, bool kept, Status status, const Err *err)
{
    runs->done++;
    runs->kept += kept;
    runs->failed += status != STATUS_OK;
    firstfail_note(&runs->fail, index, status, err);
    progress_show(&runs->progress, (double)runs->done / (double)runs->n);
}

/* Grows one run, unless the user has stopped the study. */
static void grow_one(size_t index, int worker, void *context)
{
    StudyRuns *runs = context;
    Err err = {{0}};
    bool kept = false;
    (void)worker;
    pthread_mutex_lock(&runs->lock);
    const bool stopped = runs->progress.stopped;
    pthread_mutex_unlock(&runs->lock);
    if (stopped)
        return;
    Status status =
        study_grow_run(&runs->params, runs->first + index, &runs->path[index], &kept, &err);
    pthread_mutex_lock(&runs->lock);
    count(runs, index, kept, status, &err);
    pthread_mutex_unlock(&runs->lock);
}

/* Grows the runs that have no valid file yet. A run that fails does not stop the other runs. The
 * error is that of the failed run with the lowest index. */
static Status grow_runs(StudyRuns *runs, const Common *common, Err *err)
{
    int threads = common->threads ? common->threads : threads_available();
    runs->params.threads = runs->n < (size_t)threads ? threads / (int)runs->n : 1;
    TRY(mem_calloc(&runs->path, runs->n, sizeof *runs->path, "runs", err));
    progress_start(&runs->progress, "growing", common->talk);
    threads_for(runs->n, threads, grow_one, runs);
    progress_end(&runs->progress);
    if (runs->progress.stopped)
        return err_cancelled(err);
    if (runs->failed > 0)
        return err_set(err, runs->fail.status, "%s%s", runs->fail.err.text,
                       runs->failed > 1 ? "; other runs failed as well" : "");
    talk_note(common->talk, "%zu run%s: %zu grown, %zu found from before", runs->n,
              runs->n == 1 ? "" : "s", runs->n - runs->kept, runs->kept);
    return STATUS_OK;
}

/* ---- tables ---------------------------------------------------------------------------------- */

static Status write_table(const StudyTable *table, const char *folder, const char *name, Err *err)
{
    char *path = NULL;
    TRY(file_join(folder, name, &path, err));
    Status status = study_table_write(table, path, err);
    free(path);
    return status;
}

static Status write_tables(const StudyRuns *runs, const char *folder, Err *err)
{
    StudyTable table = {.shards = true};
    Status status;
    for (size_t i = 0; i < runs->n; i++)
        TRY_GOTO(study_table_add(&table, runs->path[i], err));
    TRY_GOTO(study_table_check(&table, err));
    TRY_GOTO(write_table(&table, folder, "study.jsonl", err));
    status = write_table(&table, folder, "study.csv", err);
done:
    study_table_release(&table);
    return status;
}

/* ---- the operation --------------------------------------------------------------------------- */

/* Appends one command line per run. */
static Status put_commands(const StudyOptions *options, const Parsed *parsed, size_t runs,
                           Text *lines, Err *err)
{
    static const char *const without[] = {"commands", "only", NULL};
    Text same = TEXT_INIT;
    Status status;
    TRY_GOTO(put_rerun_command(parsed, without, &same, err));
    text_puts(&same, parsed->common.threads ? "" : " --threads 1");
    text_puts(&same, " -o ");
    text_put_shell_word(&same, options->output);
    for (size_t i = 0; i < runs; i++) {
        text_add(lines, &same);
        text_printf(lines, " --only %zu\n", i + 1);
    }
done:
    text_release(&same);
    return status;
}

/* Grows the runs of a plan, or the one of --only, and writes the tables. */
static Status grow_plan(const StudyOptions *options, const Parsed *parsed, const StudyPlan *plan,
                        Err *err)
{
    if ((size_t)options->only > plan->runs)
        return err_set(err, STATUS_USAGE, "--only: %d is not the number of a run, 1 to %zu",
                       options->only, plan->runs);
    StudyRuns runs = {.params = {plan, options->output, options->trees, 1},
                      .first = options->only ? (size_t)options->only - 1 : 0,
                      .n = options->only ? 1 : plan->runs,
                      .lock = PTHREAD_MUTEX_INITIALIZER};
    Status status;
    TRY_GOTO(file_make_folder(options->output, err));
    TRY_GOTO(grow_runs(&runs, &parsed->common, err));
    if (!options->only)
        status = write_tables(&runs, options->output, err);
done:
    runs_release(&runs);
    return status;
}

static Status put_table(const Parsed *parsed, Text *lines, Err *err)
{
    StudyTable table = {0};
    Status status = STATUS_OK;
    for (int i = 0; i < parsed->n_operands; i++)
        TRY_GOTO(study_table_add(&table, parsed->operands[i], err));
    study_table_csv(&table, lines);
done:
    study_table_release(&table);
    return status;
}

static Status check(const StudyOptions *options, const Parsed *parsed, Err *err)
{
    const bool grows = !options->table;
    if (grows && !options->output)
        return err_set(err, STATUS_USAGE,
                       "-o DIR is missing; usage: corcast study PLAN.ini -o DIR");
    if (grows && parsed->n_operands > 1)
        return err_set(err, STATUS_USAGE, "unexpected argument '%s'; give one plan",
                       parsed->operands[1]);
    if (options->commands && strcmp(parsed->operands[0], "-") == 0)
        return err_set(err, STATUS_USAGE,
                       "--commands needs a plan in a file: each command reads the plan again");
    return STATUS_OK;
}

Status study_run(const StudyOptions *options, Parsed *parsed, Text *lines, Err *err)
{
    StudyPlan plan;
    TRY(check(options, parsed, err));
    if (options->table)
        return put_table(parsed, lines, err);
    TRY(study_plan_read(parsed->operands[0], &plan, err));
    Status status = options->commands ? put_commands(options, parsed, plan.runs, lines, err)
                                      : grow_plan(options, parsed, &plan, err);
    study_plan_release(&plan);
    return status;
}

const Command command_study = {
    .name = "study",
    .summary = "grow and measure trees for all combinations of chosen values",
    .operands = "PLAN.ini -o DIR",
    .examples =
        "  corcast study plan.ini -o runs\n"
        "  corcast study plan.ini -o runs --commands > plan.txt; parallel -a plan.txt\n"
        "  corcast merge runs -o study.csv\n"
        "  corcast study --table a.json b.json > table.csv\n"
        "\na plan is a file with one section of grow options; each option lists its values:\n"
        "  [grow]\n"
        "  seed = 1..20\n"
        "  gamma = 2.5, 3\n"
        "  terminals = 1000\n",
    .min_operands = 1,
    .max_operands = MAX_OPERANDS,
    .size = sizeof(StudyOptions),
    .tables = {{&own_table, 0}},
};
