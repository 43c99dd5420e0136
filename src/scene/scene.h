/* The public header of the module scene: what is drawn, independent of trees.
 *
 * A picture is made of a Geometry (the shape of the vessels), an Appearance (their colors and
 * finish) and a View (camera, lights, ground and effects). All three are immutable after
 * construction. Any appearance fits any geometry of the same tree, and any view fits both.
 * Coordinates are right-handed and in millimetres, colors are linear RGB. */
#ifndef CORCAST_SCENE_SCENE_H
#define CORCAST_SCENE_SCENE_H

#include "scene/anatomy.h"
#include "scene/appearance.h"
#include "scene/effects.h"
#include "scene/geometry.h"
#include "scene/meshends.h"
#include "scene/models.h"
#include "scene/rayvolume.h"
#include "scene/strokes.h"
#include "scene/triangles.h"
#include "scene/vesseltree.h"
#include "scene/view.h"

/* What a picture is made of. Owns the three. */
typedef struct Scene {
    Geometry geometry;
    Appearance appearance;
    View view;
} Scene;

/* Releases geometry and appearance, and zeroes *scene. A view owns nothing. */
void scene_release(Scene *scene);

#endif
