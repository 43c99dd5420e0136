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

/* Draws an implicit model into planes that are there, with the drawing's caster for shadows and for
 * what sight_is_needed() names. Adds the seconds taken to *stats. Makes of *prepared what is not
 * there yet. */
MUST_CHECK Status fieldrender(const Drawing *drawing, FieldPrepared *prepared, Frame *frame,
                              RenderStats *stats, Err *err);

/* Leaves *prepared zeroed. */
void fieldprepared_release(FieldPrepared *prepared);

#endif
