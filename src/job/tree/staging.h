/* Grows one tree in stages. Each stage has its own domain and options. */
#ifndef CORCAST_JOB_TREE_STAGING_H
#define CORCAST_JOB_TREE_STAGING_H

#include "job/tree/growing.h"

/* Grows a tree in stages. Each stage continues the tree of the stage before it. The first stage
 * continues the tree of --from, if there is one.
 *
 * Sends a note when a stage is finished. A stage that stops early, as --partial allows, is the last
 * stage.
 *
 * path     an INI file. A section is a stage; its lines are options of growth. An option also
 *          applies to the later stages, until a stage sets it again.
 * growing  growing_prepare must have been called. Afterwards the domain is that of the last stage;
 *          the other members are as before.
 * tree     receives the tree; release it with tree_release, also after an error.
 * report   receives the report of the last stage, with seconds, points and broken segments summed
 *          over all stages.
 * Errors   STATUS_INPUT, with file and line, for an option that a stage cannot have, and with file
 *          and stage for stages that contradict each other; the errors of grow_tree, with the name
 *          of the stage. */
MUST_CHECK Status staging_grow(const char *path, Growing *growing, const Parsed *parsed, Tree *tree,
                               GrowReport *report, Err *err);

#endif
