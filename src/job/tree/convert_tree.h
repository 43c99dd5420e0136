/* Converts trees between file formats, and adds values and fields as columns. Call
 * convert_tree_make, which reads the tree and adds the columns, then convert_tree_write. */
#ifndef CORCAST_JOB_TREE_CONVERT_TREE_H
#define CORCAST_JOB_TREE_CONVERT_TREE_H

#include "job/tree/blood.h"
#include "options/options.h"
#include "tree/tree.h"

typedef struct TreeConversion {
    const char *values; /* "FILE" or "FILE:COLUMN": a file whose values per segment become columns;
                         * NULL: none */
    const char *fields; /* "all" or "NAME,...": fields, such as wss, that are computed and become
                         * columns; NULL: none */
    bool smooth;        /* smooth the centrelines */
    bool centreline_arrays; /* add columns named as in SimVascular's and VMTK's centrelines */
    double step_mm;     /* approximate length of the segments after resampling; 0: no resampling */
    BloodOptions blood; /* has an effect only with `fields` */
} TreeConversion;

extern const OptionTable treeconversion_table; /* sets a TreeConversion except its `blood` */

/* Reads the tree that is the first operand, and brings it into its normal form: parents precede
 * their children, and ids are 1, 2, ... in this order. Then adds the specified columns. A column
 * that the tree already has is not changed.
 *
 * The word "all" stands for every field that can be computed from the tree's data, except
 * quantities that every tree format stores anyway. A note lists the fields that are left out
 * because their inputs are missing.
 *
 * tree    receives the tree; release it with tree_release, also after an error.
 * Errors  STATUS_USAGE for an unknown field, and for options about blood without --fields;
 *         STATUS_INPUT if the tree or a file of values cannot be used, or if a field listed by name
 *         cannot be computed; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status convert_tree_make(const TreeConversion *conversion, Parsed *parsed, Tree *tree,
                                    Err *err);

/* Writes the tree to the file `path`. If the extension is .pvd, `path` is an index for ParaView,
 * and the tree is written to one file per time step of its series. Sends a note about data that the
 * format cannot store. Errors: STATUS_USAGE for an unknown extension, and if the file of a time
 * step is also an input; STATUS_INPUT if the tree cannot be written in this format; STATUS_IO;
 * STATUS_MEMORY. */
MUST_CHECK Status convert_tree_write(const Tree *tree, Parsed *parsed, const char *path, Err *err);

#endif
