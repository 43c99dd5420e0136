/* The tile engine of implicit models (potential and blob): finds the first hits of the samples of
 * an image, tile by tile. */
#ifndef CORCAST_RENDER_FIELD_FIELDTILES_H
#define CORCAST_RENDER_FIELD_FIELDTILES_H

#include "render/tile/tilerender.h"

/* The functions of the engine, with the contracts of TileEngine. `bin` borrows the drawing's
 * geometry, camera and `hidden`. No hit is nearer along its ray than caster_nearest_mm. `trace`
 * leaves no sample of the image TILE_UNSURE. Errors: STATUS_MEMORY. */
extern const TileEngine field_tiles;

#endif
