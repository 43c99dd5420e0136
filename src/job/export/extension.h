/* Flow extensions: lengthens the ends of vessels, so that the boundaries of a flow simulation are
 * farther from the bifurcations. Call extension_apply before the surface is made, and
 * extension_report afterwards. */
#ifndef CORCAST_JOB_EXPORT_EXTENSION_H
#define CORCAST_JOB_EXPORT_EXTENSION_H

#include "derive/derive.h"
#include "options/options.h"
#include "tree/tree.h"

/* The options. Lengths are in radii of the end's segment. Zeroed: no extensions. */
typedef struct ExtensionOptions {
    double all, inlet;
    bool has_inlet;     /* `inlet` is specified; false: `all` applies to inlets */
    const char *outlet; /* the length at outlets, as a number; or the path of a CSV file with the
                         * columns id and radii; NULL: `all` applies to outlets */
} ExtensionOptions;

extern const OptionTable extension_table; /* sets an ExtensionOptions */

/* Name of the tree's column that extension_apply adds: the length of each extension, mm. The value
 * at a root belongs to the inlet, the value at a terminal to the outlet; other values are 0. */
extern const char extension_column[];

/* Lengthens the ends of the tree along their axes, and adds the column extension_column. Inlets are
 * roots with one segment; outlets are terminals. Does nothing if no extension is specified.
 *
 * parsed  parsed->files registers the CSV file.
 * Errors  STATUS_USAGE for a length outside [0, 100]; STATUS_INPUT for a malformed file, and,
 *         naming ids, if a row of the file does not belong to an outlet, or if an extension
 *         overlaps another vessel; STATUS_IO; STATUS_MEMORY. After an error the tree is unchanged.
 */
MUST_CHECK Status extension_apply(const ExtensionOptions *options, Parsed *parsed, Tree *tree,
                                  Err *err);

/* Computes a field of the blood for the notes and tables about ends: "wss", "reynolds" and others.
 * If the flow or the viscosity is unknown, the field is empty (its `value` is NULL), and the
 * function succeeds.
 *
 * said    values of the blood that options specify.
 * field   release it with field_release.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status extension_field(const Tree *tree, const TreeMeta *said, const char *name,
                                  Field *field, Err *err);
/* Returns the entrance length of a segment, mm: the length of a straight vessel of the segment's
 * radius after which laminar flow is fully developed. It is 0.06 * Reynolds number * diameter, the
 * usual estimate for pipes. `reynolds` has a value per node. */
double extension_entrance_length(const Tree *tree, const Field *reynolds, size_t segment);

/* Sends two notes, about the inlets and about the outlets: the largest entrance length, and the
 * length of the extension at that end. Does nothing if no end was lengthened or the flow is
 * unknown. Errors: STATUS_MEMORY. */
MUST_CHECK Status extension_report(const Tree *tree, const TreeMeta *said, const Talk *talk,
                                   Err *err);

#endif
