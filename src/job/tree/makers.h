/* The operations whose result is a tree: grow, refine and bifurcation. Each has a function that
 * makes the tree in memory; madetree_write then writes it.
 *
 *     MadeTree made = {0};
 *     Status status = grow_make(parsed->options, parsed, &made, err);
 *     if (status == STATUS_OK)
 *         status = madetree_write(parsed, &made, err);
 *     madetree_release(&made); */
#ifndef CORCAST_JOB_TREE_MAKERS_H
#define CORCAST_JOB_TREE_MAKERS_H

#include "base/base.h"
#include "job/tree/growing.h"
#include "job/tree/refining.h"
#include "options/options.h"
#include "tree/tree.h"

extern const Command command_grow, command_refine, command_bifurcation;

/* The struct that the options of `grow` set. */
typedef struct GrowOptions {
    const char *output, *json, *stages; /* paths of the files to write; NULL: not written */
    bool bound; /* the report contains a lower bound of the objective function [certify.h] */
    Growing growing;
    Refining refining;
} GrowOptions;

/* A tree and the report about it. Zero it before use; release it with madetree_release. */
typedef struct MadeTree {
    Tree tree;      /* its metadata names the command that made it */
    json_t *report; /* report about the operation; owned; NULL without --json */
} MadeTree;

void madetree_release(MadeTree *made);

/* Makes a tree in memory. Messages and progress go to parsed->common.talk.
 *
 * options  parsed->options, after options_finish.
 * made     zeroed before; the caller releases it even after an error.
 * Errors   STATUS_USAGE for options that exclude each other or have no effect; STATUS_INPUT for a
 *          tree or a domain that cannot be used; STATUS_INFEASIBLE if no tree meets the options;
 *          STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
typedef Status MakeTree(void *options, Parsed *parsed, MadeTree *made, Err *err);
MUST_CHECK MakeTree grow_make, refine_make,
    bifurcation_make; /* the functions of the three operations */

/* Stores `report` in *made, which must not have a report yet. Takes over the reference. Errors:
 * STATUS_MEMORY if `report` is NULL, as it is if memory ran out. */
MUST_CHECK Status madetree_report(MadeTree *made, json_t *report, Err *err);

/* An operation that makes a tree, for callers that choose it by name. The first operand of `refine`
 * is a tree; `grow` and `bifurcation` need no operand. */
typedef struct TreeMaker {
    const Command *command;
    MakeTree *make;
} TreeMaker;

/* Returns the operation with this name: "grow", "refine" or "bifurcation". NULL for another name.
 */
const TreeMaker *tree_maker_find(const char *name);

/* Checks that the extension of `path` is a tree format. Does not look at the disk. Accepts NULL,
 * which stands for a tree that stays in memory. Errors: STATUS_USAGE, with the known extensions. */
MUST_CHECK Status tree_output_check(const char *path, Err *err);
/* Writes a tree to a file. Sends a note to `talk` about data that the file's format cannot store.
 * Errors: STATUS_USAGE for an unknown extension; STATUS_INPUT if the format cannot store the tree;
 * STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status tree_output(const Tree *tree, const char *path, const Talk *talk, Err *err);

/* Writes the tree to the file of --output and, if made->report is not NULL, the report to the file
 * of --json. Errors: those of tree_output. */
MUST_CHECK Status madetree_write(const Parsed *parsed, const MadeTree *made, Err *err);

#endif
