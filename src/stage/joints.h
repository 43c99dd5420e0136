/* Models with joints: shortened cylinders, and ruled surfaces between their rims. Private to the
 * module stage. */
#ifndef CORCAST_STAGE_JOINTS_H
#define CORCAST_STAGE_JOINTS_H

#include "stage/coincidence.h"
#include "stage/stage.h"

/* Appends the cylinders and joints of a tree, and a sphere at each junction where the construction
 * of joints fails. Sets the counts of joints and of failed junctions in *report.
 *
 * geometry  its `primitives` has space for two primitives per node.
 * report    must not be NULL.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status joints_add(const Tree *tree, const Coincidence *coincidence, JointForm form,
                             Geometry *geometry, StageReport *report, Err *err);

#endif
