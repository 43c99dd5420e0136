/* Collects the parameters of growth from options, from the header of a tree that is to be
 * continued, and from the files that options name. Then grows the tree.
 *
 * Use: growing_set_defaults, the option table growing_table, growing_prepare, growing_run,
 * growing_release, in this order. */
#ifndef CORCAST_JOB_TREE_GROWING_H
#define CORCAST_JOB_TREE_GROWING_H

#include "grow/grow.h"
#include "options/options.h"

/* The parameters of a growth. growing_prepare reads the files that the text members name. */
typedef struct Growing {
    GrowParams params; /* its pointers borrow from the other members */
    const char *domain_spec, *from_path, *demand_spec; /* NULL: not given; borrowed */
    const char *fill;       /* name of the published table by which the tree is filled; NULL: the
                             * tree is grown */
    int fill_from, fill_to; /* as FillRules */
    VectorList inlet;
    NumberList inlet_share;
    bool given[META_KEYS]; /* per key of the metadata: an option specified its value */
    Domain domain;         /* owned; zeroed before growing_prepare */
    Tree from;             /* the tree that growth continues; owned; zeroed: none */
    Demand *demand;        /* owned; NULL: none */
} Growing;

/* Sets the defaults of a zeroed Growing: those of grow_defaults. */
void growing_set_defaults(Growing *growing);
extern const OptionTable growing_table; /* sets a Growing */

/* Reads the tree, the domain and the demand map that the options name, and completes the
 * parameters. A parameter that no option specifies is taken from the header of the tree to
 * continue, if the header has it. Records the files of the domain and of the map in parsed->files.
 *
 * growing  the caller releases it with growing_release even after an error.
 * Errors   STATUS_USAGE for options without effect, and if the tree to continue has no domain or no
 *          rule for the flow of new terminals; the errors of reading_tree, tree_domain_parse,
 *          demand_read and files_read. */
MUST_CHECK Status growing_prepare(Growing *growing, Parsed *parsed, Err *err);

/* Replaces the demand map by the map that demand_spec names; with NULL, removes it. Errors: those
 * of demand_read; there is then no map. */
MUST_CHECK Status growing_read_demand(Growing *growing, Err *err);

/* Grows a tree, or fills the tree of --from if `fill` is set, and shows progress. If growth stopped
 * early, as --partial allows, warns and states the reason.
 *
 * tree     receives the tree; release it with tree_release.
 * report   receives the facts about the growth; must not be NULL.
 * Errors   those of grow_tree, fill_tree and morphometry_read. */
MUST_CHECK Status growing_run(Growing *growing, const Parsed *parsed, Tree *tree,
                              GrowReport *report, Err *err);

/* Releases the domain, the tree and the demand map. Keeps the options. */
void growing_release(Growing *growing);

#endif
