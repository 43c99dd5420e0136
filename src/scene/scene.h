/* The public header of the module scene: the data that renderers draw and emitters write. These
 * types do not depend on how a tree is stored.
 *
 * A picture consists of a Geometry (the shape of the vessels), an Appearance (their colors and
 * finish) and a View (camera, lights, ground and effects). All three do not change after they are
 * built. Any appearance fits any geometry of the same tree, and any view fits both. The module
 * stage builds them from a tree; the module render draws them, and the module emit writes them to
 * scene files:
 *
 *     TRY(render(&scene, &params, &frame, NULL, err));
 *     scene_release(&scene);
 *
 * Coordinates are right-handed and in millimetres; colors are linear RGB. Release functions accept
 * a zeroed object. */
#ifndef CORCAST_SCENE_SCENE_H
#define CORCAST_SCENE_SCENE_H

#include "scene/anatomy.h"
#include "scene/appearance.h"
#include "scene/effects.h"
#include "scene/geometry.h"
#include "scene/meshends.h"
#include "scene/models.h"
#include "scene/prisms.h"
#include "scene/rayvolume.h"
#include "scene/strokes.h"
#include "scene/triangles.h"
#include "scene/vesseltree.h"
#include "scene/view.h"

/* The three parts of a picture; owned. */
typedef struct Scene {
    Geometry geometry;
    Appearance appearance;
    View view;
} Scene;

/* Releases geometry and appearance, and zeroes *scene. A view owns nothing. */
void scene_release(Scene *scene);

#endif
