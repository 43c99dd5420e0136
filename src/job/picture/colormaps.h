/* The operation `colormaps`: lists the color maps in templates/colormaps, and draws a picture of
 * them. Call colormaps_make, then colormaps_write if there is an output, then colormaps_release. */
#ifndef CORCAST_JOB_PICTURE_COLORMAPS_H
#define CORCAST_JOB_PICTURE_COLORMAPS_H

#include "image/image.h"
#include "options/options.h"

extern const Command command_colormaps;

typedef struct ColormapsOptions {
    const char *output; /* file of the picture; NULL: there is none */
    bool cite; /* the list states the publication to cite and the licence of each map, instead of
                * its purpose */
} ColormapsOptions;

/* The list and the picture. Zero it before use; release it with colormaps_release. */
typedef struct ColormapsResult {
    Text lines; /* one line per map: its name, a tab, and its purpose or, with `cite`, its citation
                 * and licence */
    Plane strips; /* one horizontal strip per map in the order of the list, linear RGB; empty
                   * without an output */
} ColormapsResult;

/* Lists the maps and, with an output, draws them. The caller releases *result even after an error.
 * Errors: STATUS_IO if the folder of templates is not found; STATUS_INPUT for a malformed map;
 * STATUS_MEMORY. */
MUST_CHECK Status colormaps_make(const ColormapsOptions *options, ColormapsResult *result,
                                 Err *err);
/* Writes the picture to options->output, which must not be NULL. Errors: STATUS_USAGE for an
 * unknown format; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status colormaps_write(const ColormapsOptions *options, const Parsed *parsed,
                                  const ColormapsResult *result, Err *err);
void colormaps_release(ColormapsResult *result);

#endif
