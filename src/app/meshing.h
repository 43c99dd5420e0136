/* The surface of a tree's vessels as triangles, for the commands that write it. */
#ifndef CORCAST_APP_MESHING_H
#define CORCAST_APP_MESHING_H

#include "app/options.h"
#include "base/base.h"
#include "scene/scene.h"
#include "surface/surface.h"

typedef struct Meshing {
    VesselTree vessels;
    VesselMesh mesh;
    MeshReport report;
} Meshing;

/* How far triangles may be off the surface, over the local radius, where nothing else is said. */
#define MESHING_TOLERANCE 0.02

/* Reads the tree, leaves out segments thinner than prune_radius_mm (0: none) and triangulates the
 * others. Says on standard error, unless quiet, how much work it is, and what is to be known of the
 * mesh. STATUS_DIFFERS when the mesh is not sound; errors as tree_read and vesselmesh_build have
 * them. Release with meshing_release. */
MUST_CHECK Status meshing_make(const char *tree_path, double prune_radius_mm, double tolerance,
                               const Common *common, Meshing *made, Err *err);
void meshing_release(Meshing *made);

#endif
