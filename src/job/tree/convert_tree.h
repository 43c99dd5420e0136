/* Conversion of trees between formats, with values and fields as columns. */
#ifndef CORCAST_JOB_TREE_CONVERT_TREE_H
#define CORCAST_JOB_TREE_CONVERT_TREE_H

#include "job/tree/blood.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct TreeConversion {
    const char *values;     /* "FILE" or "FILE:COLUMN": columns that a file brings; NULL: none */
    const char *fields;     /* "all" or "NAME,...": fields to derive as columns; NULL: none */
    bool smooth;            /* smooth the centrelines */
    bool centreline_arrays; /* add columns named as in SimVascular's and VMTK's centrelines */
    double step_mm;         /* length of the segments after resampling; 0: as in the file */
    BloodOptions blood;     /* has an effect with `fields` alone */
} TreeConversion;

extern const OptionTable treeconversion_table; /* sets a TreeConversion except its `blood` */

/* Reads the tree that is the first operand in its normal form: parents before children, ids 1, 2,
 * ... in that order.
 *
 * Adds the columns that are asked for. A column that the tree has stays as it is. "all" fields are
 * those that can be derived and that files of trees do not hold anyway; a note names the fields
 * that lack what they need.
 *
 * tree    receives the tree; release it with tree_release, also after an error.
 * Errors  STATUS_USAGE for an unknown field, and for options on blood without --fields;
 *         STATUS_INPUT if a field of the list lacks what it needs; as reading_tree, blood_settle
 *         and tree_read_values. */
MUST_CHECK Status convert_tree_make(const TreeConversion *conversion, Parsed *parsed, Tree *tree,
                                    Err *err);

/* Writes the tree to a file, or to an index for ParaView (.pvd) and one file per moment of its
 * series. Errors: as tree_output and tree_write_moments; STATUS_USAGE if a file of a moment is also
 * an input. */
MUST_CHECK Status convert_tree_write(const Tree *tree, Parsed *parsed, const char *path, Err *err);

#endif
