/* A volume that contains all rays of a rectangle of a picture. Emitters use it to leave out vessels
 * that are not visible in the rectangle: rayvolume_new builds the volume, rayvolume_meets tests
 * boxes. The test is conservative: an object that a ray hits always meets the volume. */
#ifndef CORCAST_SCENE_RAYVOLUME_H
#define CORCAST_SCENE_RAYVOLUME_H

#include "base/base.h"
#include "geom/geom.h"
#include "image/image.h"
#include "scene/view.h"

typedef struct RayVolume RayVolume;

/* Builds the volume of the rays through the pixels of `part`, including their antialiasing samples.
 *
 * bounds   a box that contains all vessels.
 * shadows  true: adds the shadow rays from visible points to the lights. The points are those of
 *          the vessels within `bounds` and of the ground that are visible in `part`.
 * volume   receives the volume; release it with rayvolume_free.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status rayvolume_new(const View *view, Box bounds, PixelRect part, bool shadows,
                                RayVolume **volume, Err *err);
void rayvolume_free(RayVolume *volume);

/* Returns false only if no ray hits anything in the box, which must be within the bounds. May
 * return true for a box that no ray hits. Returns true if `volume` is NULL, which stands for all
 * rays. */
bool rayvolume_meets(const RayVolume *volume, Box box);

#endif
