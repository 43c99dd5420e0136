/* Options on the blood in a tree. They take precedence over the tree's metadata. */
#ifndef CORCAST_JOB_TREE_BLOOD_H
#define CORCAST_JOB_TREE_BLOOD_H

#include "options/options.h"
#include "tree/tree.h"

/* Zeroed: nothing is specified. */
typedef struct BloodOptions {
    TreeMeta said; /* the values given by options; owns nothing; read it with blood_said */
    const char *terminal_flow; /* "equal", "murray" or a CSV file of flows; NULL: the tree's */
    ViscosityLaw law;          /* if said.known has it */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions */

/* Returns all specified values, as derive_field takes them. They own nothing. */
TreeMeta blood_said(const BloodOptions *blood);

/* Returns the conditions of options about blood that do not hold for a viscosity law. */
ConditionSet blood_unmet(ViscosityLaw law);
/* Checks the options for the tree that is the first operand, and divides the flow among the tree's
 * terminals as terminal_flow says. Errors: STATUS_USAGE for options of another viscosity law than
 * the tree's, and for a terminal_flow that is no rule and no file; as tree_set_flow_by_radius and
 * tree_read_flows. */
MUST_CHECK Status blood_settle(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                               Err *err);

#endif
