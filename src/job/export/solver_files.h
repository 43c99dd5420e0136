/* Writes the files that a flow solver needs in addition to a surface with named parts: a table of
 * the ends, the centreline, and a geometry for gmsh. */
#ifndef CORCAST_JOB_EXPORT_SOLVER_FILES_H
#define CORCAST_JOB_EXPORT_SOLVER_FILES_H

#include "base/base.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* Appends the ends as CSV, one row per end; docs/FORMATS.md describes the columns. `vessels` are
 * the segments from which the mesh was made. `said` has the values of the blood that options
 * specify. Errors: STATUS_MEMORY. */
MUST_CHECK Status solver_ends(const MeshEnds *ends, const Tree *tree, const VesselTree *vessels,
                              const TreeMeta *said, Text *out, Err *err);

/* Appends the tree as a VTP file, with the radii and the end points of the segments in `vessels`.
 * If `smooth` is not NULL, `vessels` are the pieces of the smooth tree, and the file contains these
 * pieces, with ids from 1, instead of the tree's segments. Errors: those of tree_write_bytes;
 * STATUS_MEMORY. */
MUST_CHECK Status solver_centerline(const Tree *tree, const SmoothTree *smooth,
                                    const VesselTree *vessels, Text *out, Err *err);

/* Appends a geometry for gmsh. It reads the STL file `file`, gives each surface the name of its
 * part, and makes volumes of the surfaces: "blood" and, of a hollow wall, "wall". If memory runs
 * out, `out` records it. */
void solver_gmsh(const MeshEnds *ends, const char *file, Text *out);
/* Appends a geometry for gmsh. The geometry reads the layers of prisms from the file `file`, and
 * makes a volume of the core of each tree, which gmsh fills with tetrahedra. The volumes have the
 * name "core". If memory runs out, `out` records it. */
void solver_core(const MeshEnds *ends, const PrismLayers *layers, const char *file, Text *out);

#endif
