/* Makes those trees of a figure that a command generates, instead of a file that is read. In the
 * figure's recipe [figure_plan.h], a line such as `grow = --terminals 20` in the section of a panel
 * names the command (the maker: grow) and its arguments. Call madetrees_make once, then
 * madetrees_tree per panel. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_TREES_H
#define CORCAST_JOB_FIGURE_FIGURE_TREES_H

#include "job/figure/figure_plan.h"

/* Zero it before use; release it with madetrees_release. */
typedef struct MadeTrees {
    MadeTree *made; /* per section of the recipe: its tree. Zeroed if the section has no maker, or
                     * if an earlier section has the same maker and arguments, whose tree it shares.
                     * Owned. */
    size_t n;       /* number of sections */
} MadeTrees;

/* Runs the commands. Panels whose maker and arguments are equal share one tree. Passes on the
 * warnings of the commands, but not their other messages.
 *
 * common  common options of the command `figure`: number of threads, and receiver of messages.
 * folder  folder that relative paths among the arguments refer to [figure_paths.h].
 * trees   the caller releases it even after an error.
 * Errors  (the sentence names the panel) STATUS_USAGE for an unclosed quotation mark in the
 *         arguments, more than 256 words, an option that names an output, or a wrong option; the
 *         errors of the commands; STATUS_MEMORY. */
MUST_CHECK Status madetrees_make(const FigurePlan *plan, const Common *common, const char *folder,
                                 MadeTrees *trees, Err *err);
/* Returns the tree of section `i`, which must have a maker; borrowed from `trees`. */
const Tree *madetrees_tree(const FigurePlan *plan, const MadeTrees *trees, size_t i);
void madetrees_release(MadeTrees *trees);

#endif
