/* Refines a whole tree, after growth or after reading: moves nodes and reconnects branches to lower
 * the target, the objective function of growth. The option table refining_table sets a Refining;
 * refining_apply does the work. */
#ifndef CORCAST_JOB_TREE_REFINING_H
#define CORCAST_JOB_TREE_REFINING_H

#include "grow/grow.h"
#include "job/tree/growing.h"
#include "options/options.h"

/* The options of a refinement. Zeroed: the tree is not refined. */
typedef struct Refining {
    GrowRefine level;
    double seconds; /* maximum duration, s; 0: no limit */
    size_t moves; /* maximum number of moves; 0: the default of RefineParams.moves [grow/grow.h] */
} Refining;

extern const OptionTable refining_table; /* sets a Refining */

/* Checks that the tree that `growing` makes can be refined. Errors: STATUS_USAGE if a level is
 * specified and growth continues a tree, because refinement would move the nodes of that tree. */
MUST_CHECK Status refining_check_growing(const Refining *refining, const Growing *growing,
                                         Err *err);

/* Refines the tree if a level is specified, and sends a note with the improvement. Reports
 * progress. Once the callback parsed->common.talk->enough [options/talk.h] returns true, refinement
 * ends with the best tree so far.
 *
 * Adds the command line to the tree's metadata, also if no level is specified. If the tree was
 * refined, adds the number of moves as well: a time limit or the user may have ended the
 * refinement, so that the command line alone does not determine the result.
 *
 * domain  the domain that the tree must stay in; NULL: there is none.
 * report  receives the report; zeroed if no level is specified.
 * Errors  those of refine_tree [grow/grow.h]. */
MUST_CHECK Status refining_apply(const Refining *refining, const Parsed *parsed,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Sends a warning that `broken` segments violate the rules of minimum length and clearance. Does
 * nothing if `broken` is 0. */
void refining_warn_broken(const Talk *talk, size_t broken);

#endif
