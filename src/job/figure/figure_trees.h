/* Generates the trees of a figure that are not read from files but made by a command such as
 * `grow`. In the figure's recipe [figure_plan.h], a line such as `grow = --terminals 20` in the
 * section of a panel names the command, called the maker (grow), and its arguments. Call
 * madetrees_make once, then madetrees_tree for each panel. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_TREES_H
#define CORCAST_JOB_FIGURE_FIGURE_TREES_H

#include "job/figure/figure_plan.h"

/* The generated trees. Zero it before use; release it with madetrees_release. */
typedef struct MadeTrees {
    /* per section of the recipe: its tree. Zeroed if the section has no maker, or shares the
     * tree of an earlier section with the same maker and arguments. Owned. */
    MadeTree *made;
    size_t n; /* number of sections */
} MadeTrees;

/* Runs the makers. Panels with equal makers and arguments share one tree. The warnings of the
 * makers go to common->talk; their notes are dropped.
 *
 * common  common options of the command `figure`: number of threads, and receiver of messages.
 * folder  folder that relative paths among the arguments refer to [figure_paths.h].
 * trees   zeroed before; the caller releases it even after an error.
 * Errors  STATUS_USAGE for an unclosed quotation mark in the arguments, for more than 256 words,
 *         and for an option that is unknown or names an output; the errors of MakeTree
 *         [job/tree/makers.h]; STATUS_MEMORY. The sentence names the panel. */
MUST_CHECK Status madetrees_make(const FigurePlan *plan, const Common *common, const char *folder,
                                 MadeTrees *trees, Err *err);
/* Returns the tree of the panel in section `i` of the plan, which must have a maker. Borrowed from
 * `trees`. */
const Tree *madetrees_tree(const FigurePlan *plan, const MadeTrees *trees, size_t i);
void madetrees_release(MadeTrees *trees);

#endif
