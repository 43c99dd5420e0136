/* Runs the refinement for all operations that refine a tree, and describes it in the metadata. */
#include "job/tree/refining.h"

#include "options/output.h"
#include "options/talk.h"
#include <stdio.h>

static const char *const levels[] = {[GROW_REFINE_NONE] = "none",
                                     [GROW_REFINE_GEOMETRY] = "geometry",
                                     [GROW_REFINE_TOPOLOGY] = "topology",
                                     [GROW_REFINE_ANNEAL] = "anneal",
                                     NULL};

static const Option rows[] = {
    {.name = "refine",
     SETS(CHOICE, Refining, level),
     .choices = levels,
     .group = GROUP_OPTIMUM,
     .argument = "LEVEL",
     .help = "how the complete tree is optimized: none, geometry (moves bifurcations), topology "
             "(also reconnects branches), anneal (simulated annealing, which also accepts moves "
             "that raise the target, then as topology)"},
    {.name = "refine-seconds",
     SETS(NUMBER, Refining, seconds),
     FROM_TO(0, 1e6),
     .group = GROUP_OPTIMUM,
     .unit = "s",
     .needs = "refine",
     .help = "maximum time of --refine; 0 sets no limit. With a limit, the result depends on the "
             "speed of the machine"},
    {.name = "refine-moves",
     SETS(COUNT, Refining, moves),
     FROM_TO(0, 1e12),
     .group = GROUP_OPTIMUM,
     .needs = "refine",
     .help = "maximum number of moves that --refine tries. 0 sets no limit if --refine-seconds is "
             "set; otherwise it sets a limit that depends on the level of --refine"},
};

const OptionTable refining_table = OPTION_TABLE(rows);

Status refining_check_growing(const Refining *refining, const Growing *growing, Err *err)
{
    if (refining->level == GROW_REFINE_NONE)
        return STATUS_OK;
    if (growing->from_path)
        return err_set(err, STATUS_USAGE,
                       "--refine would move the --from tree; run `corcast refine` afterwards");
    return STATUS_OK;
}

static void note_gain(const Talk *talk, const RefineReport *report)
{
    talk_note(talk, "refined in %.3g s%s: target %.6g to %.6g (%.2f %%), %llu of %llu moves kept",
              report->seconds, report->stopped ? ", stopped" : "", report->target_before,
              report->target_after, 100 * (report->target_after / report->target_before - 1),
              (unsigned long long)report->moves_kept, (unsigned long long)report->moves_tried);
    if (isfinite(report->apart_mm))
        talk_note(talk, "walls of different trees are at least %.4g mm apart", report->apart_mm);
}

static Status refine(const Refining *refining, const Common *common, const Domain *domain,
                     Tree *tree, RefineReport *report, Err *err)
{
    Progress progress;
    const RefineParams params = {.level = refining->level,
                                 .seconds = refining->seconds,
                                 .moves = refining->moves,
                                 .seed = common->seed,
                                 .threads = common->threads,
                                 .stop = progress_enough,
                                 .stop_context = &progress,
                                 .progress = progress_report,
                                 .progress_context = &progress};
    progress_start(&progress, "refining", common->talk);
    (void)progress_enough(&progress); /* the first question is this thread's */
    Status status = refine_tree(&params, domain, tree, report, err);
    progress_end(&progress);
    return status;
}

static Status describe(const Refining *refining, const RefineReport *report, TreeMeta *meta,
                       Err *err)
{
    char line[160];
    snprintf(line, sizeof line, "refined: %s, %llu of %llu moves kept%s", levels[refining->level],
             (unsigned long long)report->moves_kept, (unsigned long long)report->moves_tried,
             report->stopped ? ", stopped" : "");
    return meta_add_text(meta, META_KEYS, line, err);
}

Status refining_apply(const Refining *refining, const Parsed *parsed, const Domain *domain,
                      Tree *tree, RefineReport *report, Err *err)
{
    *report = (RefineReport){0};
    if (refining->level == GROW_REFINE_NONE)
        return treemeta_add_command(parsed, &tree->meta, err);
    TRY(refine(refining, &parsed->common, domain, tree, report, err));
    note_gain(parsed->common.talk, report);
    TRY(treemeta_add_command(parsed, &tree->meta, err));
    return describe(refining, report, &tree->meta, err);
}

void refining_warn_broken(const Talk *talk, size_t broken)
{
    if (broken > 0)
        talk_warn(talk, "%zu segment%s still shorter than wide or too close to other segments",
                  broken, broken == 1 ? " is" : "s are");
}
