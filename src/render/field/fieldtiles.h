/* Draws implicit surfaces (potential and blob) tile by tile: field_tiles finds the first hits of
 * the samples of an image, field_shadows answers shadow queries. */
#ifndef CORCAST_RENDER_FIELD_FIELDTILES_H
#define CORCAST_RENDER_FIELD_FIELDTILES_H

#include "render/tile/tilerender.h"

/* The tile functions of the field engine, with the contracts of TileEngine. `bin` borrows the
 * drawing's geometry, camera and `hidden`. No hit is nearer along its ray than caster_nearest_mm.
 * `trace` leaves no sample of the image TILE_UNSURE. Errors: STATUS_MEMORY. */
extern const TileEngine field_tiles;

/* The shadow engine of a potential or a blob [shadowengine.h].
 *
 * Supports a light if lightview_sees_all is true for it and no part of the geometry is behind it. A
 * point is in shadow if field_search.any returns true, with a tolerance of 0.2 % of the level near
 * the point. Blockers within params->shadow_from_mm of the point (for a blob, within
 * BLOB_NEAREST_MM) cast no shadow on it. Hidden segments [shadowqueue.h] cast no shadow on hits
 * that their terms influence.
 *
 * Cost     sorting n segments into the tiles of a light view: O(n log n), plus O(1) for each tile
 *          that a segment touches. */
extern const ShadowEngine field_shadows;

#endif
