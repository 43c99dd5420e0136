/* Makes the trees of a figure that are not read from a file. A key of the recipe such as `grow =
 * --terminals 20` specifies the command that makes the tree. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_TREES_H
#define CORCAST_JOB_FIGURE_FIGURE_TREES_H

#include "job/figure/figure_plan.h"

/* Zero it before use; release it with madetrees_release. */
typedef struct MadeTrees {
    MadeTree *made; /* per section: its tree, if it is the first section with this maker and these
                     * arguments; else zeroed; owned */
    size_t n;
} MadeTrees;

/* Makes the trees. A tree that several panels show is made once. Passes on the warnings of the
 * commands, but not their other messages.
 *
 * figure  the options of the figure: number of threads, and the receiver of messages.
 * folder  folder that relative paths among the arguments refer to [figure_paths.h].
 * trees   the caller releases it even after an error.
 * Errors  naming the panel: STATUS_USAGE for a quote that is not closed, for an option that names
 *         an output, and for wrong options; the errors of the commands. */
MUST_CHECK Status madetrees_make(const FigurePlan *plan, const Common *figure, const char *folder,
                                 MadeTrees *trees, Err *err);
/* Returns the tree of section `i`, which must have a maker; borrowed from `trees`. */
const Tree *madetrees_tree(const FigurePlan *plan, const MadeTrees *trees, size_t i);
void madetrees_release(MadeTrees *trees);

#endif
