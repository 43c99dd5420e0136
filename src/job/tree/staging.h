/* Grows one tree in stages, each with its own domain and options. A file lists the stages. */
#ifndef CORCAST_JOB_TREE_STAGING_H
#define CORCAST_JOB_TREE_STAGING_H

#include "job/tree/growing.h"

/* Grows a tree in stages. The first stage continues the tree of --from, if there is one. Each later
 * stage continues the tree of the previous stage.
 *
 * Sends a note when a stage is finished. A stage that stops early, which --partial allows, is the
 * last stage.
 *
 * path     an INI file. Each section is a stage; its lines are options of `grow`. An option also
 *          applies to the later stages, until a stage sets it again.
 * growing  growing_prepare must have been called. Afterwards `domain` and `demand` are those of the
 *          last stage; the other members are unchanged.
 * tree     receives the tree; release it with tree_release, also after an error.
 * report   receives the report of the last stage, in which seconds, points and broken segments are
 *          the sums over all stages.
 * Errors   STATUS_INPUT, with file and line, for an option that a stage cannot have; STATUS_INPUT,
 *          with file and stage, for stages that contradict each other; the errors of growing_run,
 *          with the name of the stage. */
MUST_CHECK Status staging_grow(const char *path, Growing *growing, const Parsed *parsed, Tree *tree,
                               GrowReport *report, Err *err);

#endif
