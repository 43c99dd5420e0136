/* Growth in stages: one tree, each stage in its own domain and with its own options. */
#ifndef CORCAST_JOB_TREE_STAGING_H
#define CORCAST_JOB_TREE_STAGING_H

#include "job/tree/growing.h"

/* Grows a tree in stages. Each stage continues the tree of the stage before it. The first stage
 * continues the tree of --from, if there is one.
 *
 * A note tells when a stage has grown. A stage that stops early, as --partial allows, is the last.
 *
 * path     an INI file. A section is a stage; its lines are options of growth. A line holds for the
 *          later stages, too, until one of them gives the option again.
 * growing  prepared. Afterwards it has the domain of the last stage and otherwise its own options.
 * tree     receives the tree; release it with tree_release, also after an error.
 * report   is that of the last stage, with the sums of all stages' seconds, points and broken
 *          segments.
 * Errors   STATUS_INPUT, with file and line, for an option that a stage cannot have; with file and
 *          stage, for stages that contradict each other. As grow_tree, after the stage's name. */
MUST_CHECK Status staging_grow(const char *path, Growing *growing, const Parsed *parsed, Tree *tree,
                               GrowReport *report, Err *err);

#endif
