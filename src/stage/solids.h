/* Builds the geometry of models of cylinders and spheres. Private to the module stage. */
#ifndef CORCAST_STAGE_SOLIDS_H
#define CORCAST_STAGE_SOLIDS_H

#include "stage/coincidence.h"
#include "stage/stage.h"

/* Appends the cylinders of a tree to geometry->primitives and, if params->model has MODEL_BALLS,
 * the spheres.
 *
 * coincidence  the result of coincidence_find for `tree`.
 * params       params->mesh.threads is the number of threads; it does not change the result.
 * geometry     its `primitives` is empty and has space for two primitives per node of the tree.
 * Errors       STATUS_MEMORY.
 * Cost         O(n) for n nodes. */
MUST_CHECK Status solids_add(const Tree *tree, const Coincidence *coincidence,
                             const GeometryParams *params, Geometry *geometry, Err *err);

#endif
