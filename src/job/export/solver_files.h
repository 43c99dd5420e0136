/* What a solver wants beside a surface of named parts: its ends as a table, and its centreline. */
#ifndef CORCAST_JOB_EXPORT_SOLVER_FILES_H
#define CORCAST_JOB_EXPORT_SOLVER_FILES_H

#include "base/base.h"
#include "scene/scene.h"
#include "tree/tree.h"

/* Appends the ends as CSV, a row each; docs/FORMATS.md has the columns. `vessels` are those of the
 * tree that the mesh was made of. STATUS_MEMORY. */
MUST_CHECK Status solver_ends(const MeshEnds *ends, const Tree *tree, const VesselTree *vessels,
                              Text *out, Err *err);

/* Appends the tree as a VTP, with the radii and the ends that the vessels have. As tree_write. */
MUST_CHECK Status solver_centerline(const Tree *tree, const VesselTree *vessels, Text *out,
                                    Err *err);

/* Appends a geometry for gmsh that reads the STL `file`, gives each surface the name of its part
 * and makes volumes of them: "blood" and, of a hollow wall, "wall". The text fails when memory runs
 * out. */
void solver_gmsh(const MeshEnds *ends, const char *file, Text *out);

#endif
