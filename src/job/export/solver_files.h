/* Writes the files that a flow solver needs in addition to a surface with named parts: a table of
 * the vessel ends, the centreline, and a geometry for the mesh generator gmsh. */
#ifndef CORCAST_JOB_EXPORT_SOLVER_FILES_H
#define CORCAST_JOB_EXPORT_SOLVER_FILES_H

#include "base/base.h"
#include "job/picture/picture.h"
#include "scene/scene.h"
#include "tree/tree.h"

/* Appends the vessel ends as CSV, one row per end. docs/FORMATS.md describes the columns.
 *
 * vessels  the segments or the pieces of `of` from which the mesh was made.
 * said     values of the blood that options specify.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status solver_ends(const MeshEnds *ends, const PictureTree *of,
                              const VesselTree *vessels, const TreeMeta *said, Text *out, Err *err);

/* Appends the centreline as a VTP file: the tree, with the radii and the end points that its
 * segments have in `vessels`. If the tree is divided into pieces, the file contains the pieces,
 * with ids from 1. Errors: STATUS_INPUT if the tree cannot be written; STATUS_MEMORY. */
MUST_CHECK Status solver_centerline(const PictureTree *of, const VesselTree *vessels, Text *out,
                                    Err *err);

/* Appends a geometry for gmsh. The geometry reads the STL file `file`, gives each surface the name
 * of its part, and makes volumes of the surfaces: "blood" and, of a hollow wall, "wall". If memory
 * runs out, `out` records it. */
void solver_gmsh(const MeshEnds *ends, const char *file, Text *out);
/* Appends a geometry for gmsh. The geometry reads the layers of prisms from the file `file`, and
 * makes a volume of the core of each tree, which gmsh fills with tetrahedra. The volumes have the
 * name "core". If memory runs out, `out` records it. */
void solver_core(const MeshEnds *ends, const PrismLayers *layers, const char *file, Text *out);

#endif
