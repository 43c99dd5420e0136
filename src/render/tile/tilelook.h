/* What both kinds of tiles are lit and painted with. */
#ifndef CORCAST_RENDER_TILELOOK_H
#define CORCAST_RENDER_TILELOOK_H

#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* A finish, and the lights of a view in the frame of a viewpoint; *lights (owned by the caller) are
 * those of *look. STATUS_MEMORY. */
MUST_CHECK Status tilelook_make(const View *view, const Finish *finish, const Viewpoint *eye,
                                TileLight **lights, TileLook *look, Err *err);
/* Whether shading needs the places of points, not their normals alone. */
bool tilelook_needs_places(const View *view);
/* A surface of one colour, seen along the third axis. */
void tilesurface_init(Rgb color, TileSurface *surface);

#endif
