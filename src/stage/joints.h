/* Models with joints: shortened cylinders, and ruled surfaces between their rims. Private to the
 * module stage. */
#ifndef CORCAST_STAGE_JOINTS_H
#define CORCAST_STAGE_JOINTS_H

#include "stage/coincidence.h"
#include "stage/stage.h"

/* Appends cylinders, joints, and spheres where the construction of joints fails. Counts joints and
 * these places in *report.
 *
 * geometry  its `primitives` has room for two per node.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status joints_add(const Tree *tree, const Coincidence *coincidence, JointForm form,
                             Geometry *geometry, StageReport *report, Err *err);

#endif
