/* Flow extensions: longer vessel ends, which keep the boundary of a flow solver away from the
 * bifurcations. */
#ifndef CORCAST_JOB_EXPORT_EXTENSION_H
#define CORCAST_JOB_EXPORT_EXTENSION_H

#include "options/options.h"
#include "tree/tree.h"

/* Lengths are in radii of the end's segment. Zeroed: no extensions. */
typedef struct ExtensionOptions {
    double all, inlet;
    bool has_inlet;     /* `inlet` was given; else `all` applies to inlets */
    const char *outlet; /* a number, or a CSV file with the columns id and radii; NULL: `all` */
} ExtensionOptions;

extern const OptionTable extension_table; /* sets an ExtensionOptions */

/* The name of the column with the length of the extension, mm: at a root for its inlet, at a
 * terminal for its outlet. */
extern const char extension_column[];

/* Lengthens the ends of the tree along their axes, and adds the column. Inlets are roots that one
 * segment leaves; outlets are terminals. Does nothing if no extension is asked for.
 *
 * Errors   STATUS_USAGE for a length that is not in [0, 100]; STATUS_INPUT, naming ids, for a row
 * of the file that is no outlet, and for an extension that meets another vessel; as files_read and
 * tree_read_values; STATUS_MEMORY. */
MUST_CHECK Status extension_apply(const ExtensionOptions *options, Parsed *parsed, Tree *tree,
                                  Err *err);

#endif
