/* Which vessels of an isosurface blend when only neighbours in the tree do. */
#ifndef CORCAST_STAGE_BLEND_H
#define CORCAST_STAGE_BLEND_H

#include "scene/scene.h"
#include "tree/tree.h"

/* Fills geometry->blend (owned by the geometry even when this fails). number[i] is the index in
 * geometry->segments of the segment that ends at node i, or -1. A segment's neighbours are itself,
 * those it shares a node with, and those with a node that is no farther from one of its ends, along
 * the tree, than BLEND_RADII times its own radius. O(size of the lists). STATUS_MEMORY. */
#define BLEND_RADII 3
MUST_CHECK Status blend_find(const Tree *tree, const int32_t *number, Geometry *geometry, Err *err);

#endif
