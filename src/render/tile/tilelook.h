/* What both kinds of tiles are lit and painted with. */
#ifndef CORCAST_RENDER_TILELOOK_H
#define CORCAST_RENDER_TILELOOK_H

#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* The scene's finish, and its lights in the frame of a viewpoint; *lights (owned by the caller) are
 * those of *look. STATUS_MEMORY. */
MUST_CHECK Status tilelook_make(const Scene *scene, const Viewpoint *eye, TileLight **lights,
                                TileLook *look, Err *err);
/* Whether shading needs the places of points, not their normals alone. */
bool tilelook_needs_places(const Scene *scene);
/* A surface in the scene's one colour, seen along the third axis. */
void tilesurface_init(const Scene *scene, TileSurface *surface);

#endif
