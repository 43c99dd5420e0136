/* Files that a flow solver needs beside a surface of named parts: a table of the ends, the
 * centreline, and a geometry for gmsh. */
#ifndef CORCAST_JOB_EXPORT_SOLVER_FILES_H
#define CORCAST_JOB_EXPORT_SOLVER_FILES_H

#include "base/base.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* Appends the ends as CSV, one row per end; docs/FORMATS.md describes the columns. `vessels` are
 * the segments of `tree` that the mesh was made of; `said` are values that options give. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status solver_ends(const MeshEnds *ends, const Tree *tree, const VesselTree *vessels,
                              const TreeMeta *said, Text *out, Err *err);

/* Appends the tree as a VTP file, with the radii and the end points of the segments in `vessels`.
 * If `smooth` is not NULL, these are its pieces, which the file has instead of the tree's segments,
 * with ids from 1. Errors: those of tree_write_text; STATUS_MEMORY. */
MUST_CHECK Status solver_centerline(const Tree *tree, const SmoothTree *smooth,
                                    const VesselTree *vessels, Text *out, Err *err);

/* Appends a geometry for gmsh. It reads the STL file `file`, gives each surface the name of its
 * part, and makes volumes of the surfaces: "blood" and, of a hollow wall, "wall". The text fails if
 * memory runs out. */
void solver_gmsh(const MeshEnds *ends, const char *file, Text *out);
/* Appends a geometry for gmsh. It reads the layers of prisms in the file `file`, and makes a volume
 * of the core of each tree, which gmsh fills with tetrahedra. The volumes have the name "core". The
 * text fails if memory runs out. */
void solver_core(const MeshEnds *ends, const PrismLayers *layers, const char *file, Text *out);

#endif
