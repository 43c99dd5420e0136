/* The operation `colormaps`: a list and a picture of the color maps in templates/colormaps. */
#ifndef CORCAST_JOB_PICTURE_COLORMAPS_H
#define CORCAST_JOB_PICTURE_COLORMAPS_H

#include "image/image.h"
#include "options/options.h"

extern const Command command_colormaps;

typedef struct ColormapsOptions {
    const char *output; /* file of the picture; NULL: there is none */
    bool cite;          /* the list states what to cite and the licence, not the purpose */
} ColormapsOptions;

/* Zero it before use; release it with colormaps_release. */
typedef struct ColormapsResult {
    Text lines;   /* one line per map: its name, a tab, and what its file states */
    Plane strips; /* one strip per map in the order of the list, linear; empty without an output */
} ColormapsResult;

/* Lists the maps and, with an output, draws them. The caller releases *result even after an error.
 * Errors: STATUS_IO if there are no templates; STATUS_INPUT for a broken map; STATUS_MEMORY. */
MUST_CHECK Status colormaps_make(const ColormapsOptions *options, ColormapsResult *result,
                                 Err *err);
/* Writes the picture to options->output. Errors: as picture_write. */
MUST_CHECK Status colormaps_write(const ColormapsOptions *options, const Parsed *parsed,
                                  const ColormapsResult *result, Err *err);
void colormaps_release(ColormapsResult *result);

#endif
