/* Cylinders and spheres of a tree. */
#ifndef CORCAST_STAGE_SOLIDS_H
#define CORCAST_STAGE_SOLIDS_H

#include "stage/places.h"
#include "stage/stage.h"

/* Fills geometry->primitives, which are empty and have room for two a node, with the cylinders and,
 * where the model has balls, the spheres of a tree, on as many threads as of a mesh, which do not
 * change the result. O(n). STATUS_MEMORY. */
MUST_CHECK Status solids_add(const Tree *tree, const Places *places, const GeometryParams *params,
                             Geometry *geometry, Err *err);

#endif
