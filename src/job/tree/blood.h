/* Options about the blood in a tree. They take precedence over the tree's metadata. */
#ifndef CORCAST_JOB_TREE_BLOOD_H
#define CORCAST_JOB_TREE_BLOOD_H

#include "options/options.h"
#include "tree/tree.h"

/* Zeroed: nothing is specified. */
typedef struct BloodOptions {
    TreeMeta said; /* the values that options specify; owns nothing; read it with blood_said */
    const char *terminal_flow; /* "equal", "murray" or the path of a CSV file of flows; NULL: the
                                * flow stored in the tree */
    ViscosityLaw law;          /* specified if said.known contains its key */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions */

/* Returns all specified values, including the viscosity law, in the form that derive_field expects.
 * The result owns nothing. */
TreeMeta blood_said(const BloodOptions *blood);

/* Returns the conditions [options/conditions.h] of options about blood that are not met under a
 * viscosity law. */
ConditionSet blood_unmet(ViscosityLaw law);
/* Checks the options against the tree, the first operand, and divides the flow among the tree's
 * terminals by the rule or file of terminal_flow. If it is NULL, the tree keeps its flow. Errors:
 * STATUS_USAGE for options that do not apply to the tree's viscosity law, for a terminal_flow that
 * is neither a rule nor a file, and for "murray" if the tree's exponent varies with the radius; the
 * errors of tree_set_flow_by_radius and tree_read_flows. */
MUST_CHECK Status blood_settle(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                               Err *err);

#endif
