/* What the user says of the blood in a tree that is there: it takes precedence over what the tree's
 * file says. */
#ifndef CORCAST_JOB_TREE_BLOOD_H
#define CORCAST_JOB_TREE_BLOOD_H

#include "options/options.h"
#include "tree/tree.h"

typedef struct BloodOptions {
    TreeMeta said;             /* but the law; nothing in it is owned */
    const char *terminal_flow; /* "equal", "murray" or a CSV of flows; NULL: the tree's */
    ViscosityLaw law;          /* where said.known has it */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions; zeroed: nothing is said */

/* All that is said, as derive_field takes it. */
TreeMeta blood_said(const BloodOptions *blood);

/* Returns the conditions of options on blood that do not hold for a law of viscosity. */
ConditionSet blood_unmet(ViscosityLaw law);
/* Refuses options of another law of viscosity than that of the tree that is the first operand,
 * whose flow then parts among the terminals as is said. Errors as tree_part_flow_by_radius and
 * tree_read_flows have them. */
MUST_CHECK Status blood_settle(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                               Err *err);

#endif
