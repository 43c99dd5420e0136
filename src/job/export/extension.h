/* Flow extensions: vessel ends that are lengthened, so that the boundaries of a flow simulation are
 * farther from the bifurcations. */
#ifndef CORCAST_JOB_EXPORT_EXTENSION_H
#define CORCAST_JOB_EXPORT_EXTENSION_H

#include "derive/derive.h"
#include "options/options.h"
#include "tree/tree.h"

/* Lengths are in radii of the end's segment. Zeroed: no extensions. */
typedef struct ExtensionOptions {
    double all, inlet;
    bool has_inlet;     /* `inlet` is specified; else `all` applies to inlets */
    const char *outlet; /* a number, or a CSV file with the columns id and radii; NULL: `all` */
} ExtensionOptions;

extern const OptionTable extension_table; /* sets an ExtensionOptions */

/* Name of the column with the lengths of the extensions, in mm. The value at a root is that of the
 * inlet, the value at a terminal that of the outlet. */
extern const char extension_column[];

/* Lengthens the ends of the tree along their axes, and adds the column extension_column. Inlets are
 * roots with one segment; outlets are terminals. Does nothing if no extension is specified.
 *
 * Errors   STATUS_USAGE for a length outside [0, 100]; STATUS_INPUT, naming ids, if a row of the
 *          file is not about an outlet, or if an extension overlaps another vessel; the errors of
 *          files_read and tree_read_values; STATUS_MEMORY. The tree is then unchanged. */
MUST_CHECK Status extension_apply(const ExtensionOptions *options, Parsed *parsed, Tree *tree,
                                  Err *err);

/* Computes the field `name` of the blood, such as "wss" or "reynolds". Release *field with
 * field_release. The field is empty, value NULL, if the flow or the viscosity is unknown. `said`
 * has the values of the blood that options specify. Errors: as derive_rule, without STATUS_INPUT.
 */
MUST_CHECK Status extension_field(const Tree *tree, const TreeMeta *said, const char *name,
                                  Field *field, Err *err);
/* Returns the entrance length of a segment, mm: the length of a straight vessel of the segment's
 * radius after which laminar flow is developed. This is 0.06 times the Reynolds number times the
 * diameter. `reynolds` has a value per node. */
double extension_entrance(const Tree *tree, const Field *reynolds, size_t segment);

/* Reports the largest entrance length of the inlets and of the outlets, beside the length of the
 * extension there. Does nothing if no end was lengthened or the flow is unknown. Errors: as
 * extension_field. */
MUST_CHECK Status extension_say(const Tree *tree, const TreeMeta *said, const Talk *talk, Err *err);

#endif
