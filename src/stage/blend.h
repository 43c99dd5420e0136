/* Which vessels blend when --potential graph keeps strangers apart. */
#ifndef CORCAST_STAGE_BLEND_H
#define CORCAST_STAGE_BLEND_H

#include "scene/scene.h"
#include "tree/tree.h"

/* Fills geometry->blend. `number` has the index in geometry->segments of the segment that ends at
 * each node of the tree, or -1. A segment blends with itself, with those it shares a node with, and
 * with those that have a node within BLEND_RADII of its own radii of one of its ends, along the
 * tree. */
#define BLEND_RADII 3
MUST_CHECK Status blend_find(const Tree *tree, const int32_t *number, Geometry *geometry, Err *err);

#endif
