/* Draws implicit surfaces (potential and blob) tile by tile: field_tiles finds the first hits of
 * the samples of an image. field_shadows then finds which of these points lights reach. */
#ifndef CORCAST_RENDER_FIELD_FIELDTILES_H
#define CORCAST_RENDER_FIELD_FIELDTILES_H

#include "render/tile/tilerender.h"

/* The tile functions of the field engine, with the contracts of TileEngine [tilerender.h].
 * field_tiles.bin sorts the drawing's segments into tiles; its result borrows the drawing's
 * geometry, camera and `hidden`. field_tiles.trace decides all samples of the image: none is
 * TILE_UNSURE. No hit is nearer to the ray's origin than caster_nearest_mm. Errors:
 * STATUS_MEMORY. */
extern const TileEngine field_tiles;

/* The shadow engine of a potential or a blob [shadowengine.h].
 *
 * Supports a light if the light's view contains all of the geometry (lightview_sees_all) and no
 * vessel is behind the light. A point is in shadow if field_search.any returns true for the line to
 * the light. Near the point, where the field is within 0.2 % of the level, the answers may differ:
 * a line that leaves its own surface there is not blocked [kernel_shadow.h]. Blockers within
 * params->shadow_from_mm of the point (for a blob, within BLOB_NEAREST_MM) cast no shadow on it.
 * Hidden segments [shadowqueue.h] cast no shadow on hits that their terms influence.
 *
 * Cost     sorting n segments into the tiles of a light view: O(n log n), plus O(1) for each tile
 *          that a segment touches. */
extern const ShadowEngine field_shadows;

#endif
