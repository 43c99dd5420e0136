/* The surface of a tree's vessels as triangles, for the commands that write it. */
#ifndef CORCAST_JOB_EXPORT_MESHING_H
#define CORCAST_JOB_EXPORT_MESHING_H

#include "base/base.h"
#include "emit/emit.h"
#include "job/export/printing.h"
#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "options/options.h"

/* The models whose walls are triangulated, by VesselBody; NULL ends them. */
extern const char *const vessel_body_names[];

typedef struct MeshingOptions {
    int body;                   /* choice: VesselBody */
    double tolerance;           /* over the local radius */
    double lod;                 /* the part of the triangles that are to be made; 0: as 1 */
    double tube_edge;           /* as MeshParams has it */
    bool part_overlaps;         /* thin vessels that overlap others that they do not belong with */
    const PrintSettings *print; /* NULL: the surface as it is */
    const char *look;           /* for an emitter with colours, as the coloring */
    Coloring coloring;
} MeshingOptions;

/* Triangulates the vessels of a tree, unless the emitter writes them as lines, and writes `output`
 * and what stands beside it. Says on standard error,
 * unless quiet, how much work it is, and what is to be known of the mesh. STATUS_DIFFERS when the
 * mesh is not sound; errors as coloring_appearance, vesselmesh_build and emit_files have them. */
MUST_CHECK Status meshing_write(const Emitter *emitter, const MeshingOptions *options,
                                const PictureTree *of, const char *output, const Parsed *parsed,
                                Err *err);

#endif
