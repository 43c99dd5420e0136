/* Conversion of trees between formats, with values and fields as columns. */
#ifndef CORCAST_JOB_TREE_CONVERT_TREE_H
#define CORCAST_JOB_TREE_CONVERT_TREE_H

#include "job/tree/blood.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct TreeConversion {
    const char *values;     /* "FILE" or "FILE:COLUMN": a file with values that become columns;
                             * NULL: none */
    const char *fields;     /* "all" or "NAME,...": fields to derive as columns; NULL: none */
    bool smooth;            /* smooth the centrelines */
    bool centreline_arrays; /* add columns named as in SimVascular's and VMTK's centrelines */
    double step_mm;         /* length of the segments after resampling; 0: no resampling */
    BloodOptions blood;     /* has an effect only with `fields` */
} TreeConversion;

extern const OptionTable treeconversion_table; /* sets a TreeConversion except its `blood` */

/* Reads the tree that is the first operand, and brings it into its normal form: parents precede
 * their children, and ids are 1, 2, ... in this order.
 *
 * Adds the specified columns. A column that the tree already has is not changed. "all" stands for
 * all fields that can be derived and that tree formats do not store in any case. A note lists the
 * fields that cannot be derived because an input is missing.
 *
 * tree    receives the tree; release it with tree_release, also after an error.
 * Errors  STATUS_USAGE for an unknown field, and for options about blood without --fields;
 *         STATUS_INPUT if a listed field cannot be derived because an input is missing; the errors
 *         of reading_tree, blood_settle and tree_read_values. */
MUST_CHECK Status convert_tree_make(const TreeConversion *conversion, Parsed *parsed, Tree *tree,
                                    Err *err);

/* Writes the tree to a file, or to an index for ParaView (.pvd) and one file per moment of its
 * series. Errors: those of tree_output and tree_write_time_steps; STATUS_USAGE if the file of a
 * moment is also an input. */
MUST_CHECK Status convert_tree_write(const Tree *tree, Parsed *parsed, const char *path, Err *err);

#endif
