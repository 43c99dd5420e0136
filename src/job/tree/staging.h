/* Growth in stages: one tree, each stage in its own domain and by its own options. */
#ifndef CORCAST_JOB_TREE_STAGING_H
#define CORCAST_JOB_TREE_STAGING_H

#include "job/tree/growing.h"

/* Grows stage after stage of the INI file `path` into *tree (owned), each on the tree of the one
 * before, and the first on that of --from, if there is one. A section is a stage; its lines are
 * options of growth, which hold for the later stages, too, until they say otherwise. `growing` is
 * prepared, and is left with the domain of the last stage. *report is that of the last stage, but
 * for the seconds and counts of all. STATUS_INPUT, naming file and line or stage, for what no stage
 * can say and for stages that contradict each other; errors as grow_tree, after the stage's name.
 */
MUST_CHECK Status staging_grow(const char *path, Growing *growing, const Parsed *parsed, Tree *tree,
                               GrowReport *report, Err *err);

#endif
