/* Options that specify the blood in a tree: flow, pressure and viscosity. The values of options
 * take precedence over the values in the tree's metadata.
 *
 * The operation reads the tree, then calls blood_apply. blood_specified returns the values for
 * derive_field. */
#ifndef CORCAST_JOB_TREE_BLOOD_H
#define CORCAST_JOB_TREE_BLOOD_H

#include "options/options.h"
#include "tree/tree.h"

/* The values of the options. Zeroed: no value is specified. */
typedef struct BloodOptions {
    TreeMeta said; /* the values that options specify, without the viscosity law; owns nothing.
                    * blood_specified returns it complete. */
    const char *terminal_flow; /* "equal", "murray" or the path of a CSV file of flows; NULL: the
                                * flow stored in the tree */
    ViscosityLaw law;          /* valid if said.known[META_VISCOSITY_LAW] is true */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions */

/* Returns all specified values, including the viscosity law, in the form that derive_field
 * [derive/derive.h] expects. The result owns nothing. */
TreeMeta blood_specified(const BloodOptions *blood);

/* Returns the conditions [options/conditions.h] that do not hold if the tree has this viscosity
 * law. An option with such a condition has no effect: --hematocrit, for example, has an effect only
 * under the law of Pries. */
ConditionSet blood_unmet(ViscosityLaw law);
/* Checks the options against the tree, and divides the flow among the tree's terminals by the rule
 * or file `terminal_flow`. If terminal_flow is NULL, the tree keeps its flow.
 *
 * parsed  parsed->operands[0] is the tree's path, for error sentences.
 * Errors  STATUS_USAGE for an option that has no effect under the tree's viscosity law, for a
 *         terminal_flow that is neither a rule nor a file, and for "murray" if the tree's exponent
 *         varies with the radius; STATUS_INPUT if the radii or the file of flows cannot be used;
 *         STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status blood_apply(const BloodOptions *blood, const Parsed *parsed, Tree *tree,
                              Err *err);

#endif
