/* What the rays that draw a part of a picture can meet. */
#ifndef CORCAST_SCENE_SIGHT_H
#define CORCAST_SCENE_SIGHT_H

#include "base/base.h"
#include "geom/geom.h"
#include "image/image.h"
#include "scene/view.h"

typedef struct Sight Sight;

/* Of the rays through the pixels of `part`, the samples of antialiasing included, and where
 * `shadows`, of those from all that they can see, vessels within `bounds` and the ground, to the
 * lights. *sight is the caller's (sight_free). STATUS_MEMORY. */
MUST_CHECK Status sight_new(const View *view, Box bounds, PixelRect part, bool shadows,
                            Sight **sight, Err *err);
void sight_free(Sight *sight);

/* Whether one of those rays can meet what is in the box, which lies within the bounds; true, too,
 * for some boxes that no ray meets. A sight of NULL meets every box. */
bool sight_meets(const Sight *sight, Box box);

#endif
