/* The parameters of growth: from options, from the header of a tree that growth continues, and from
 * the files that options name. */
#ifndef CORCAST_JOB_TREE_GROWING_H
#define CORCAST_JOB_TREE_GROWING_H

#include "grow/grow.h"
#include "options/options.h"

/* The options are texts until growing_prepare reads what they name. */
typedef struct Growing {
    GrowParams params; /* its pointers borrow from the other members */
    const char *domain_spec, *from_path, *demand_spec; /* NULL: not given; borrowed */
    const char *fill;       /* name of the published table to fill the tree by; NULL: grow */
    int fill_from, fill_to; /* as FillRules */
    VectorList inlet;
    NumberList inlet_share;
    bool given[META_KEYS]; /* by key of the metadata: an option gave it */
    Domain domain;         /* owned; zeroed before growing_prepare */
    Tree from;             /* the tree that growth continues; owned; zeroed: none */
    Demand *demand;        /* owned; NULL: none */
} Growing;

/* Sets the defaults of a zeroed Growing: those of grow_defaults. */
void growing_set_defaults(Growing *growing);
extern const OptionTable growing_table; /* sets a Growing */

/* Reads the tree, the domain and the map of demand that the options name, and completes the
 * parameters. A parameter that no option gives comes from the header of the tree to continue, if
 * the header has it. Notes the domain's and the map's files in parsed->files.
 *
 * growing  the caller releases it with growing_release even after an error.
 * Errors   STATUS_USAGE for options without effect, and if the tree to continue has no domain or no
 *          rule for the flow of new terminals; as reading_tree, tree_domain_parse, demand_read and
 *          files_read. */
MUST_CHECK Status growing_prepare(Growing *growing, Parsed *parsed, Err *err);

/* Replaces the map of demand by the one that demand_spec names; NULL: by none. Errors: as
 * demand_read. */
MUST_CHECK Status growing_read_demand(Growing *growing, Err *err);

/* Grows a tree, or fills the tree of --from if `fill` is set, with progress. Warns why growth
 * stopped early, if --partial allows that. Errors: as grow_tree; as fill_tree and morphometry_read.
 */
MUST_CHECK Status growing_run(Growing *growing, const Parsed *parsed, Tree *tree,
                              GrowReport *report, Err *err);

/* Releases domain, tree and map. The options stay. */
void growing_release(Growing *growing);

#endif
