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

/* Refines the tree, if asked, with progress, notes what was gained, and adds to the tree's metadata
 * the command line and, if the tree was refined, the number of moves: a refinement that a clock or
 * the user ended depends on more than the command line. If the caller has had enough [talk.h], the
 * best tree so far is the result.
 *
 * domain  NULL: the tree may be anywhere.
 * report  zeroed if the level is GROW_REFINE_NONE.
 * Errors  as refine_tree. */
MUST_CHECK Status refining_apply(const Refining *refining, const Parsed *parsed,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Warns that `broken` segments break the rules of length and clearance; 0: says nothing. */
void refining_warn_broken(const Talk *talk, size_t broken);

#endif
