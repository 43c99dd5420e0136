/* What the user says of the blood in a tree that is there: it goes before what the tree's file
 * says. */
#ifndef CORCAST_APP_BLOOD_H
#define CORCAST_APP_BLOOD_H

#include "app/options.h"
#include "tree/tree.h"

typedef struct BloodOptions {
    TreeMeta said;    /* but the law; nothing in it is owned */
    ViscosityLaw law; /* where said.known has it */
} BloodOptions;

extern const OptionTable blood_table; /* sets a BloodOptions; zeroed: nothing is said */

/* All that is said, as derive_field takes it. */
TreeMeta blood_said(const BloodOptions *blood);

/* STATUS_USAGE for an option of the command line that is of another law of viscosity than this one,
 * and than the tree's with what is said. */
MUST_CHECK Status blood_check_law(ViscosityLaw law, const Parsed *parsed, Err *err);
MUST_CHECK Status blood_check(const BloodOptions *blood, const Tree *tree, const Parsed *parsed,
                              Err *err);

#endif
