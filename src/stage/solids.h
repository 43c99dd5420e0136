/* Models of cylinders and spheres. Private to the module stage. */
#ifndef CORCAST_STAGE_SOLIDS_H
#define CORCAST_STAGE_SOLIDS_H

#include "stage/coincidence.h"
#include "stage/stage.h"

/* Makes the cylinders of a tree and, if the model has balls, the spheres.
 *
 * params    uses params->mesh.threads threads, which do not change the result.
 * geometry  its `primitives` is empty and has space for two primitives per node.
 * Errors    STATUS_MEMORY.
 * Cost      O(n). */
MUST_CHECK Status solids_add(const Tree *tree, const Coincidence *coincidence,
                             const GeometryParams *params, Geometry *geometry, Err *err);

#endif
