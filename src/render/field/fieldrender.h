/* Pictures of the potential, tile by tile. */
#ifndef CORCAST_RENDER_FIELDRENDER_H
#define CORCAST_RENDER_FIELDRENDER_H

#include "render/cast/caster.h"
#include "render/field/fieldtiles.h"
#include "render/job.h"

/* The samples of a pass over the whole picture, and the vessels that they see. */
typedef struct FieldPass {
    double *columns, *rows; /* owned; of the grid */
    SampleGrid grid;
    FieldTiles *tiles; /* owned; NULL: not made yet */
} FieldPass;

/* What the camera sees of an implicit scene: the centres of all pixels, and the further samples.
 * Zeroed before the first band, kept from band to band while camera and antialiasing stay. */
typedef struct FieldPrepared {
    FieldPass center, further;
} FieldPrepared;

/* renderer_rows() for implicit scenes, into planes that are there. `caster` is for shadows; NULL
 * without. Adds the seconds taken to *stats. Makes of *prepared what is not there yet. */
MUST_CHECK Status fieldrender(const Scene *scene, const RenderParams *params, Caster *caster,
                              const Band *rows, FieldPrepared *prepared, Frame *frame,
                              RenderStats *stats, Err *err);

/* Leaves *prepared zeroed. */
void fieldprepared_release(FieldPrepared *prepared);

#endif
