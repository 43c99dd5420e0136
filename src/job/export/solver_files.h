/* Writes the files that a flow solver needs in addition to a surface with named parts: a table of
 * the vessel ends, the centreline, and a geometry for the mesh generator gmsh. */
#ifndef CORCAST_JOB_EXPORT_SOLVER_FILES_H
#define CORCAST_JOB_EXPORT_SOLVER_FILES_H

#include "base/base.h"
#include "job/picture/picture.h"
#include "scene/scene.h"
#include "tree/tree.h"

/* Appends the vessel ends as CSV, one row per end. docs/FORMATS.md describes the columns.
 * ends     the vessel ends of the mesh [scene/meshends.h].
 * of       the tree with the options that chose its vessels [picture.h].
 * vessels  the segments of the tree, or the pieces into which it is divided; the mesh was made
 *          from them.
 * said     values of the blood that options specify; they take precedence over the tree's.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status solver_ends(const MeshEnds *ends, const PictureTree *of,
                              const VesselTree *vessels, const TreeMeta *said, Text *out, Err *err);

/* Appends the centreline as a VTP file: the tree, but radii and end points are those of `vessels`.
 * If the tree is divided into pieces, the file contains the pieces, with ids from 1. `of` and
 * `vessels` are as for solver_ends. Errors: STATUS_INPUT if the tree cannot be written;
 * STATUS_MEMORY. */
MUST_CHECK Status solver_centerline(const PictureTree *of, const VesselTree *vessels, Text *out,
                                    Err *err);

/* Appends a geometry for gmsh. The geometry reads the STL file `file`, gives each surface the name
 * of its part, and makes volumes of the surfaces: "blood" and, of a hollow wall, "wall". If memory
 * runs out, `out` records it. */
void solver_gmsh(const MeshEnds *ends, const char *file, Text *out);
/* Appends a geometry for gmsh, for a mesh with layers of prisms along the wall. The geometry reads
 * the layers from `file`, a .msh file. It makes a volume of the core of each tree, the space inside
 * the layers, which gmsh fills with tetrahedra. The volumes have the name "core". If memory runs
 * out, `out` records it. */
void solver_core(const MeshEnds *ends, const PrismLayers *layers, const char *file, Text *out);

#endif
