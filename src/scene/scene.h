/* The door of the room scene: what there is to draw, with no knowledge of trees.
 *
 * A picture is of three things, each of which is made once and then constant: the shape of vessels
 * (Geometry), what they look like (Appearance), and from where and in what light they are seen
 * (View). Any appearance goes with any geometry of the same tree, any view with any of both.
 * Right-handed, millimetres, linear RGB. */
#ifndef CORCAST_SCENE_SCENE_H
#define CORCAST_SCENE_SCENE_H

#include "scene/anatomy.h"
#include "scene/appearance.h"
#include "scene/effects.h"
#include "scene/geometry.h"
#include "scene/meshends.h"
#include "scene/models.h"
#include "scene/sight.h"
#include "scene/strokes.h"
#include "scene/triangles.h"
#include "scene/vesseltree.h"
#include "scene/view.h"

/* All three, where they travel together. */
typedef struct Scene {
    Geometry geometry;
    Appearance appearance;
    View view;
} Scene;

void scene_release(Scene *scene);

#endif
