/* The operations whose result is a tree: grow, refine and bifurcation. */
#ifndef CORCAST_JOB_TREE_MAKERS_H
#define CORCAST_JOB_TREE_MAKERS_H

#include "base/base.h"
#include "job/tree/growing.h"
#include "job/tree/refining.h"
#include "options/options.h"
#include "tree/tree.h"

extern const Command command_grow, command_refine, command_bifurcation;

/* What the options of `grow` set. */
typedef struct GrowOptions {
    const char *output, *json, *stages; /* files; NULL: not given */
    bool bound;                         /* the report has a lower bound of the target */
    Growing growing;
    Refining refining;
} GrowOptions;

/* Zero it before use; release it with madetree_release. */
typedef struct MadeTree {
    Tree tree;      /* its metadata names the command that made it */
    json_t *report; /* report about the operation; owned; NULL without --json */
} MadeTree;

void madetree_release(MadeTree *made);

/* A function that makes a tree in memory. Messages and progress go to parsed->common.talk.
 *
 * options  the struct parsed->options, after options_finish.
 * made     the caller releases it even after an error.
 * Errors   STATUS_USAGE for options that exclude each other or have no effect; STATUS_INPUT for a
 *          tree or a domain that cannot be used; STATUS_INFEASIBLE if no tree meets the options;
 *          STATUS_IO, STATUS_MEMORY. */
typedef Status MakeTree(void *options, Parsed *parsed, MadeTree *made, Err *err);
MUST_CHECK MakeTree grow_make, refine_make, bifurcation_make; /* three such functions */

/* Stores `report` in *made, which must not have a report yet. Takes over the reference. Errors:
 * STATUS_MEMORY if `report` is NULL. */
MUST_CHECK Status madetree_report(MadeTree *made, json_t *report, Err *err);

/* An operation that makes a tree. The first operand of `refine` is a tree; `grow` and `bifurcation`
 * need no operand. */
typedef struct TreeMaker {
    const Command *command;
    MakeTree *make;
} TreeMaker;

/* Returns the operation of this name; NULL if there is none. */
const TreeMaker *tree_maker_find(const char *name);

/* Checks the extension of a path that a tree is to be written to. Does not look at the disk. NULL
 * is accepted: the tree stays in memory. Errors: those of tree_format_check. */
MUST_CHECK Status tree_output_check(const char *path, Err *err);
/* Writes a tree to a file. Sends a note to `talk` about what the file's format cannot store.
 * Errors: those of tree_write. */
MUST_CHECK Status tree_output(const Tree *tree, const char *path, const Talk *talk, Err *err);

/* Writes the tree to the file of --output, and the report, if there is one, to the file of --json.
 * Errors: those of tree_output. */
MUST_CHECK Status madetree_write(const Parsed *parsed, const MadeTree *made, Err *err);

#endif
