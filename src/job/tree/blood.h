/* Options that specify the blood in a tree: flow, pressure and viscosity. The values of options
 * take precedence over the values in the tree's metadata.
 *
 * A command with these options first reads the tree, then calls blood_apply, which changes only the
 * flow in the tree. All other values reach the computation through blood_specified, whose result
 * the command passes to derive_field. */
#ifndef CORCAST_JOB_TREE_BLOOD_H
#define CORCAST_JOB_TREE_BLOOD_H

#include "options/options.h"
#include "tree/tree.h"

/* The values of the options. Zeroed: no value is specified. */
typedef struct BloodOptions {
    TreeMeta said; /* the values that options specify; owns nothing. Exception: the viscosity law.
                    * `said` has only its flag, known[META_VISCOSITY_LAW], and `law` has its value;
                    * blood_specified puts flag and value together */
    const char *terminal_flow; /* "equal", "murray" or the path of a CSV file of flows; NULL: the
                                * flow stored in the tree */
    ViscosityLaw law; /* the viscosity law; valid if said.known[META_VISCOSITY_LAW] is true */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions */

/* Returns all specified values, including the viscosity law, in the form that derive_field
 * [derive/derive.h] expects. The result owns nothing. */
TreeMeta blood_specified(const BloodOptions *blood);

/* Returns the conditions [options/conditions.h] that this viscosity law does not meet. An option
 * can depend on a condition: --hematocrit, for example, depends on the law of Pries. If the law
 * does not meet the condition of an option, the option has no effect. */
ConditionSet blood_unmet(ViscosityLaw law);
/* Checks the options against the tree, and divides the flow among the tree's terminals by the rule
 * or file `terminal_flow`. If terminal_flow is NULL, the tree keeps its flow.
 *
 * parsed  parsed->operands[0] is the tree's path, for error sentences.
 * Errors  STATUS_USAGE for an option that has no effect under the tree's viscosity law, for a
 *         terminal_flow that is neither a rule nor a CSV file, and for "murray" if the tree's
 *         Murray exponent varies with the radius and no option specifies an exponent.
 *         STATUS_INPUT for "murray" if no terminal has a radius above 0, and for a CSV file that
 *         tree_read_flows rejects. STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status blood_apply(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                              Err *err);

#endif
