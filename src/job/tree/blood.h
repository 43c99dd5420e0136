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

/* Checks the command line against the viscosity law in force. Errors: STATUS_USAGE for an option
 * of another law. */
MUST_CHECK Status blood_check_law(ViscosityLaw law, const Parsed *parsed, Err *err);
/* Refuses all options of the group "blood" on the command line. Errors: STATUS_USAGE, "--NAME
 * SENTENCE". */
MUST_CHECK Status blood_refuse(const Parsed *parsed, const char *sentence, Err *err);
/* Checks the options for the tree that is the first operand, and divides the flow among the tree's
 * terminals as terminal_flow says. Errors: STATUS_USAGE for options without effect on this tree,
 * and for a terminal_flow that is no rule and no file; as tree_part_flow_by_radius and
 * tree_read_flows. */
MUST_CHECK Status blood_settle(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                               Err *err);

#endif
