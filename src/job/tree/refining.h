/* --refine: whole-tree optimisation, after growth or of a tree that is read. */
#ifndef CORCAST_JOB_TREE_REFINING_H
#define CORCAST_JOB_TREE_REFINING_H

#include "grow/grow.h"
#include "job/tree/growing.h"
#include "options/options.h"

typedef struct Refining {
    GrowRefine level;
    double seconds;
    size_t moves;
} Refining;

extern const OptionTable refining_table; /* sets a Refining; a zeroed one is no refinement */

/* STATUS_USAGE for growth whose tree cannot be refined: refinement moves all nodes of a tree. */
MUST_CHECK Status refining_check_growing(const Refining *refining, const Growing *growing,
                                         Err *err);

/* Refines the tree, if at all, with progress; the first SIGINT keeps the best tree so far. *report
 * is zeroed when nothing was asked for. `domain` may be NULL. */
MUST_CHECK Status refining_apply(const Refining *refining, const Common *common,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Adds to what the tree's file says by how many moves the tree was refined, if at all: where a
 * clock or the user ended the refinement, the command line alone does not tell one result from
 * another. */
MUST_CHECK Status refining_describe(const Refining *refining, const RefineReport *report,
                                    TreeMeta *meta, Err *err);

/* Says what was gained on standard error, if anything was asked for. */
void refining_print(const RefineReport *report);

/* Says on standard error how many segments break the rules of length and clearance, if any do. */
void print_broken(size_t broken);

#endif
