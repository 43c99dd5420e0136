/* What makes the geometry of each model: the macros that it takes and the members of the union or
 * blob that is called Tree; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_MEMBERS_H
#define CORCAST_EMIT_POVRAY_MEMBERS_H

#include "emit/emit.h"

/* One geometry being written. */
typedef struct PovrayGeometry {
    const EmitParams *params;
    const Scene *scene;
    EmitReport *report;
    CellTree cells; /* of an isosurface; owned by povray_write */
} PovrayGeometry;

/* Each appends to *out what its name says; `geometry` is a PovrayGeometry, so that it may be a part
 * of a template. */
Status put_primitive_macros(Text *out, void *geometry, Err *err);
Status put_primitives(Text *out, void *geometry, Err *err);
Status put_joint_macros(Text *out, void *geometry, Err *err);
/* The numbers and functions of an isosurface, and an isosurface for each cell. */
Status put_cell_macros(Text *out, void *geometry, Err *err);
Status put_cells(Text *out, void *geometry, Err *err);
/* The numbers of a blob and what tells its segments apart, and the calls that make it.
 * STATUS_INFEASIBLE when POV-Ray cannot hold or paint them. */
Status put_blob_macros(Text *out, void *geometry, Err *err);
Status put_blob(Text *out, void *geometry, Err *err);

/* Appends the call that draws a joint. */
void put_joint(Text *text, const EmitParams *params, const Primitive *joint);

#endif
