/* --refine: whole-tree optimisation, after growth or of a tree that is read. */
#ifndef CORCAST_APP_REFINING_H
#define CORCAST_APP_REFINING_H

#include "app/options.h"
#include "grow/grow.h"

enum { REFINING_OPTIONS = 4 };

typedef struct Refining {
    int level; /* a GrowRefine */
    double seconds;
    size_t moves;
    Option table[REFINING_OPTIONS];
} Refining;

/* No refinement, and the table that sets it; `refining` must not move afterwards. */
void refining_init(Refining *refining);

/* STATUS_USAGE for bounds of a refinement that nobody asks for. */
MUST_CHECK Status refining_check(const Refining *refining, const Parsed *parsed, Err *err);

/* Refines the tree, if at all, with progress; the first SIGINT keeps the best tree so far. *report
 * is zeroed when nothing was asked for. `domain` may be NULL. */
MUST_CHECK Status refining_apply(const Refining *refining, const Common *common,
                                 const Domain *domain, Tree *tree, RefineReport *report, Err *err);

/* Says what was gained on standard error, if anything was asked for. */
void refining_print(const RefineReport *report);

#endif
