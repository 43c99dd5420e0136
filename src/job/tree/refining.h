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

/* Refines the tree if a level is specified, and sends a note with the improvement. Always adds the
 * command line to the tree's metadata. If the tree was refined, also adds the number of moves,
 * because a time limit or the user may end a refinement, so that the command line does not
 * determine the result.
 *
 * Shows progress. Once Talk.enough [options/talk.h] returns true, the result is the best tree so
 * far.
 *
 * domain  the domain that the tree must stay in; NULL: there is none.
 * report  receives the report; zeroed if no level is specified.
 * Errors  those of refine_tree. */
MUST_CHECK Status refining_apply(const Refining *refining, const Parsed *parsed,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Warns that `broken` segments violate the rules of minimum length and clearance. Does nothing if
 * `broken` is 0. */
void refining_warn_broken(const Talk *talk, size_t broken);

#endif
