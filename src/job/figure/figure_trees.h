/* The trees of a figure that commands make. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_TREES_H
#define CORCAST_JOB_FIGURE_FIGURE_TREES_H

#include "job/figure/figure_plan.h"

/* Runs a command, whose name is not among the arguments. */
typedef Status RunMaker(const Command *command, int argc, char **argv, Err *err);

/* Files in a folder of their own, which are removed with it. */
typedef struct MadeTrees {
    char *folder; /* owned; NULL: nothing is made */
    char **files; /* owned; of the section of this number, where it is the first with this tree */
    size_t n;
    RunMaker *run;
} MadeTrees;

/* Names the files, in a folder beside `output`. *trees is owned (madetrees_release), also on
 * failure. */
MUST_CHECK Status madetrees_open(const FigurePlan *plan, const char *output, MadeTrees *trees,
                                 Err *err);
/* Runs what makes the trees, each command once however many panels show its tree. STATUS_USAGE,
 * naming the panel, for a quote that is not closed, an option that says where the tree goes, and as
 * the commands have it. */
MUST_CHECK Status madetrees_make(const FigurePlan *plan, int threads, const MadeTrees *trees,
                                 Err *err);
/* Replaces the file of a section that has a maker, which nobody knows, in a sentence: "the tree of
 * grow". */
void madetrees_name(const FigurePlan *plan, const MadeTrees *trees, size_t i, Err *err);
/* The file of a section that has a maker. */
const char *madetrees_file(const FigurePlan *plan, const MadeTrees *trees, size_t i);
void madetrees_release(MadeTrees *trees);

#endif
