/* The options of growth, and what they name: the domain, and a tree to grow on from. */
#ifndef CORCAST_JOB_TREE_GROWING_H
#define CORCAST_JOB_TREE_GROWING_H

#include "grow/grow.h"
#include "options/options.h"

typedef struct Growing {
    GrowParams params;
    Domain domain;
    Tree from;
    const char *domain_spec, *from_path, *demand_spec; /* NULL: not given */
    Demand *demand;                                    /* owned */
    VectorList inlet;
    NumberList inlet_share;
    bool given[META_KEYS]; /* which options of these keys were */
} Growing;

/* Of a zeroed Growing: grow_defaults. */
void growing_set_defaults(Growing *growing);
extern const OptionTable growing_table; /* sets a Growing */

/* Reads what the options name, takes note of the domain's file, and completes the parameters; what
 * they do not give is taken from the header of the tree to grow on from, where it tells.
 * STATUS_USAGE, too, for options without effect. */
MUST_CHECK Status growing_prepare(Growing *growing, Parsed *parsed, Err *err);

/* Reads the map of --demand, if it is given, instead of the one that there was. */
MUST_CHECK Status growing_read_demand(Growing *growing, Err *err);

/* Grows a tree, with progress. Warns why growth stopped early if that is allowed. Errors: as
 * grow_tree. */
MUST_CHECK Status growing_run(Growing *growing, const Parsed *parsed, Tree *tree,
                              GrowReport *report, Err *err);

void growing_release(Growing *growing);

#endif
