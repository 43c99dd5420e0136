/* The operations whose result is a tree: grow, refine and bifurcation. */
#ifndef CORCAST_JOB_TREE_MAKERS_H
#define CORCAST_JOB_TREE_MAKERS_H

#include "base/base.h"
#include "options/options.h"
#include "tree/tree.h"

extern const Command command_grow, command_refine, command_bifurcation;

/* Zero it before use; release it with madetree_release. */
typedef struct MadeTree {
    Tree tree;      /* its metadata names the command that made it */
    json_t *report; /* what was done; owned; NULL if the option json was not given */
} MadeTree;

void madetree_release(MadeTree *made);

/* Makes a tree in memory. Sentences about the tree and progress go to parsed->common.talk.
 *
 * options  parsed->options, settled and checked as options_parse does.
 * made     the caller releases it even after an error.
 * Errors   STATUS_USAGE for options that exclude each other or have no effect; STATUS_INPUT for a
 *          tree or a domain that cannot be used; STATUS_INFEASIBLE if there is no such tree;
 *          STATUS_IO, STATUS_MEMORY. */
typedef Status MakeTree(void *options, Parsed *parsed, MadeTree *made, Err *err);
MUST_CHECK MakeTree grow_make, refine_make, bifurcation_make;

/* Takes over the report of a tree. Errors: STATUS_MEMORY if `report` is NULL. */
MUST_CHECK Status madetree_report(MadeTree *made, json_t *report, Err *err);

/* An operation that makes a tree. A tree is the first operand of `refine`; the others need none. */
typedef struct TreeMaker {
    const Command *command;
    MakeTree *make;
} TreeMaker;

/* Finds the operation of this name; NULL if there is none. */
const TreeMaker *tree_maker_find(const char *name);

/* Checks that a tree can be written to such a path; NULL: it stays in memory. Errors: as
 * tree_format_check. */
MUST_CHECK Status tree_output_check(const char *path, Err *err);
/* Writes a tree to a file. Notes name what the file's format cannot hold. Errors: as tree_write. */
MUST_CHECK Status tree_output(const Tree *tree, const char *path, const Talk *talk, Err *err);

/* Writes the tree to the file of the option output, and the report, if there is one, to the file of
 * the option json. Errors: as tree_output. */
MUST_CHECK Status madetree_write(const Parsed *parsed, const MadeTree *made, Err *err);

#endif
