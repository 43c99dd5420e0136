/* Grows a tree as the options of `grow` specify. The parameters come from the options, from the
 * metadata of a tree that growth continues, and from the files that options name.
 *
 * Call growing_set_defaults, let the option table growing_table set the struct, then call
 * growing_prepare, growing_run and growing_release, in this order. */
#ifndef CORCAST_JOB_TREE_GROWING_H
#define CORCAST_JOB_TREE_GROWING_H

#include "grow/grow.h"
#include "options/options.h"

/* The parameters of a growth. The option table sets the texts; growing_prepare reads the files that
 * the texts name, and sets `domain`, `from`, `demand` and the pointers in `params`. */
typedef struct Growing {
    GrowParams params; /* the parameters of grow_tree; its pointers borrow from the other members */
    const char *domain_spec, *from_path, *demand_spec; /* NULL: not given; borrowed */
    const char *fill; /* name of the published morphometric table by which fill_tree adds vessels to
                       * the tree `from`; NULL: grow_tree makes the vessels */
    int fill_from, fill_to; /* with `fill`: FillRules.from and FillRules.to [grow/grow.h], the
                             * orders of the vessels that are added */
    VectorList inlet;
    NumberList inlet_share;
    bool given[META_KEYS]; /* given[key]: an option specified the value of this metadata key */
    Domain domain;         /* owned; zeroed before growing_prepare */
    Tree from;             /* the tree that growth continues; owned; zeroed: none */
    Demand *demand;        /* owned; NULL: none */
} Growing;

/* Sets the defaults of grow_defaults [grow/grow.h]. *growing must be zeroed. */
void growing_set_defaults(Growing *growing);
extern const OptionTable growing_table; /* sets a Growing */

/* Reads the tree, the domain and the demand map that the options name, and completes the
 * parameters. A parameter that no option specifies comes from the metadata of the tree that growth
 * continues, if they state it. Registers the files of the domain and of the map in parsed->files.
 *
 * growing  the caller releases it with growing_release even after an error.
 * Errors   STATUS_USAGE for options without effect or a wrong domain text, and if a domain, or a
 *          rule for the flow of new terminals, is stated neither by options nor by the tree that
 *          growth continues; STATUS_INPUT if the tree, the domain's file or the map cannot be used;
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status growing_prepare(Growing *growing, Parsed *parsed, Err *err);

/* Replaces the demand map by the map that growing->demand_spec names. If demand_spec is NULL,
 * removes the map. Errors: STATUS_USAGE or STATUS_INPUT if the map cannot be used; STATUS_IO;
 * STATUS_MEMORY. After an error there is no map. */
MUST_CHECK Status growing_read_demand(Growing *growing, Err *err);

/* Grows a tree or, if `fill` is set, fills the tree `from`. Reports progress. If growth stopped
 * early, which --partial allows, sends a warning with the reason.
 *
 * tree    receives the tree; release it with tree_release.
 * report  receives the facts about the growth; must not be NULL.
 * Errors  STATUS_USAGE for parameters that exclude each other or an unknown table; STATUS_INPUT for
 *         a malformed table; STATUS_INFEASIBLE if no tree meets the parameters; STATUS_CANCELLED;
 *         STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status growing_run(Growing *growing, const Parsed *parsed, Tree *tree,
                              GrowReport *report, Err *err);

/* Releases the domain, the tree and the demand map. The options keep their values, so
 * growing_prepare may follow again. */
void growing_release(Growing *growing);

#endif
