/* The functions that draw implicit models (potential and blob) tile by tile: the first hits of the
 * samples of an image, and shadow queries. */
#ifndef CORCAST_RENDER_FIELD_FIELDTILES_H
#define CORCAST_RENDER_FIELD_FIELDTILES_H

#include "render/tile/tilerender.h"

/* The functions of the engine, with the contracts of TileEngine. `bin` borrows the drawing's
 * geometry, camera and `hidden`. No hit is nearer along its ray than caster_nearest_mm. `trace`
 * leaves no sample of the image TILE_UNSURE. Errors: STATUS_MEMORY. */
extern const TileEngine field_tiles;

/* Answers shadow queries among the segments of a potential or a blob [shadowengine.h].
 *
 * Supports lights for which lightview_sees_all is true, if no geometry is behind them. A point is
 * in shadow if field_search.any returns true, with a tolerance of 0.2 % of the level near the
 * point. Nothing within params->shadow_from_mm of the point casts a shadow on it; for a blob,
 * nothing within BLOB_NEAREST_MM. Hidden segments [shadowqueue.h] cast no shadow on hits that their
 * terms reach.
 *
 * Cost     to sort n segments into the tiles of a light view: O(n log n), plus O(1) for each tile
 * that a segment touches. */
extern const ShadowEngine field_shadows;

#endif
