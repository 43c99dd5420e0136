/* Refinement of a whole tree, after growth or of a tree that is read. */
#ifndef CORCAST_JOB_TREE_REFINING_H
#define CORCAST_JOB_TREE_REFINING_H

#include "grow/grow.h"
#include "job/tree/growing.h"
#include "options/options.h"

/* Zeroed: the tree is not refined. */
typedef struct Refining {
    GrowRefine level;
    double seconds; /* maximum time; 0: no limit */
    size_t moves;   /* maximum number of moves; 0: as RefineParams.moves */
} Refining;

extern const OptionTable refining_table; /* sets a Refining */

/* Checks that the tree of a growth can be refined. Errors: STATUS_USAGE if growth continues a tree,
 * whose nodes refinement would move. */
MUST_CHECK Status refining_check_growing(const Refining *refining, const Growing *growing,
                                         Err *err);

/* Refines the tree if a level is given, and notes what was gained. In any case adds the command
 * line to the tree's metadata. Also adds the number of moves if the tree was refined: a refinement
 * that a clock or the user ended depends on more than the command line.
 *
 * Shows progress. Once Talk.enough [options/talk.h] returns true, the result is the best tree so
 * far.
 *
 * domain  NULL: the tree may be anywhere.
 * report  zeroed if no level is given.
 * Errors  as refine_tree. */
MUST_CHECK Status refining_apply(const Refining *refining, const Parsed *parsed,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Warns that `broken` segments break the rules of length and clearance. 0: says nothing. */
void refining_warn_broken(const Talk *talk, size_t broken);

#endif
