/* The joined model: cylinders cut back, and the ruled surfaces between their rims. */
#ifndef CORCAST_STAGE_JOINTS_H
#define CORCAST_STAGE_JOINTS_H

#include "stage/places.h"
#include "stage/stage.h"

/* Appends cylinders, joints and, where no joint can be, spheres to geometry->primitives, which has
 * room for two primitives a node, and counts joints and places without in *report. STATUS_MEMORY.
 */
MUST_CHECK Status joints_add(const Tree *tree, const Places *places, JointForm form,
                             Geometry *geometry, StageReport *report, Err *err);

#endif
