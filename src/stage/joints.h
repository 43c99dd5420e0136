/* Builds the geometry of models with joints: cylinders that are shortened at junctions, and joints
 * (ruled surfaces) that connect the rims of the shortened cylinders. Private to the module stage.
 */
#ifndef CORCAST_STAGE_JOINTS_H
#define CORCAST_STAGE_JOINTS_H

#include "stage/coincidence.h"
#include "stage/stage.h"

/* Appends the cylinders and joints of a tree to geometry->primitives. Appends a sphere at each
 * junction where the construction of joints fails. Adds to the counts of joints and of failed
 * junctions in *report.
 *
 * coincidence  the result of coincidence_find for `tree`.
 * geometry     its `primitives` has space for two primitives per node of the tree.
 * report       must not be NULL.
 * Errors       STATUS_MEMORY. */
MUST_CHECK Status joints_add(const Tree *tree, const Coincidence *coincidence, JointForm form,
                             Geometry *geometry, StageReport *report, Err *err);

#endif
