/* Joins the surfaces of junction regions, tubes and flat ends into one mesh.
 *
 * Tubes begin and end at the rims of the regions' meshes [junctionmesh.h]. A tube becomes a strip
 * of triangles between its two rims. A flat end becomes a cap: a rim that is a regular polygon, and
 * a fan of triangles around its centre. Private to the module mesh. */
#ifndef CORCAST_MESH_ASSEMBLE_H
#define CORCAST_MESH_ASSEMBLE_H

#include "mesh/junctionmesh.h"

/* How tubes and caps are triangulated. */
typedef struct TubeParams {
    uint32_t sides;   /* number of points of a cap's rim, and of each additional rim that divides a
                       * tube */
    double tube_edge; /* maximum length of a tube's triangles along the tube, in radii. A longer
                       * tube is divided by additional rims. 0: no limit */
    double grid_mm;   /* grid step: coordinates are rounded to integer multiples of it
                       * [mesh_grid] */
} TubeParams;

/* Joins the meshes of all regions, and adds the tubes between them and the caps of flat ends.
 *
 * meshes     per region, from junctionmesh_make. Each mesh is released and zeroed once it is
 *            copied. After an error the caller releases all of them.
 * mesh       receives the mesh; release it with vesselmesh_release.
 * deviation  initialized by the caller; both members are raised to the largest distance between a
 *            triangle of a tube and the tube's exact surface, if that is larger.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status assemble_mesh(const VesselTree *tree, const Junctions *junctions,
                                JunctionMesh *meshes, const TubeParams *params, VesselMesh *mesh,
                                MeshDeviation *deviation, Err *err);

#endif
