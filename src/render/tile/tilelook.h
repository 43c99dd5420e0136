/* What both kinds of tiles are lit and painted with. */
#ifndef CORCAST_RENDER_TILELOOK_H
#define CORCAST_RENDER_TILELOOK_H

#include "render/tile/tilekernels.h"

/* The scene's finish and lights, seen from a place along three orthonormal axes; *lights (owned by
 * the caller) are those of *look. */
MUST_CHECK Status tilelook_make(const Scene *scene, Vec3 location, const Vec3 axes[3],
                                TileLight **lights, TileLook *look, Err *err);
/* Whether shading needs the places of points, not their normals alone. */
bool tilelook_needs_places(const Scene *scene);
/* A surface in the scene's one colour, seen along the third axis. */
void tilesurface_init(const Scene *scene, TileSurface *surface);
/* TileKernels.encode of the part of a tile, `columns` by `rows` pixels, that is inside a
 * picture. */
void tilelook_encode(const TileKernels *kernels, const SrgbCodes *codes,
                     float color[3][TILE_SAMPLES], const uint8_t *state,
                     const uint8_t background[3], int columns, int rows, uint8_t *pixels,
                     size_t stride);

#endif
