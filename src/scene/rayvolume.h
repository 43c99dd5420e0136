/* The volume that the rays of a part of a picture pass through. Emitters use it to leave out
 * vessels that are not visible in this part. The test is conservative: no ray of the part hits an
 * object outside the volume. */
#ifndef CORCAST_SCENE_RAYVOLUME_H
#define CORCAST_SCENE_RAYVOLUME_H

#include "base/base.h"
#include "geom/geom.h"
#include "image/image.h"
#include "scene/view.h"

typedef struct RayVolume RayVolume;

/* Builds the volume of the rays through the pixels of `part`, antialiasing samples included.
 *
 * bounds   the box that holds all vessels.
 * shadows  adds the shadow rays: those from vessels within `bounds` and from the ground, as far as
 *          they are visible in `part`, to the lights.
 * volume   receives the volume; release it with rayvolume_free.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status rayvolume_new(const View *view, Box bounds, PixelRect part, bool shadows,
                                RayVolume **volume, Err *err);
void rayvolume_free(RayVolume *volume);

/* Returns false only if no ray can hit anything in the box, which must lie within the bounds. May
 * return true for a box that no ray hits. Returns true for every box if `volume` is NULL. */
bool rayvolume_meets(const RayVolume *volume, Box box);

#endif
