/* Builds layers of prisms inside a mesh, along the wall of the vessels: the triangles of the wall
 * are swept inwards. Call prismlayers_sweep after vesselmesh_build. Exported by the public header
 * of the module mesh. */
#ifndef CORCAST_MESH_SWEEP_H
#define CORCAST_MESH_SWEEP_H

#include "scene/scene.h"

/* Parameters of prismlayers_sweep. */
typedef struct LayerParams {
    int n_layers;     /* 1 to LAYERS_MAX */
    double thickness; /* of all layers together, in local radii, in (0, 0.5] */
    double growth;    /* thickness of a layer / thickness of the layer outside it, in [1, 2] */
} LayerParams;

/* Maximum number of layers; reason of the value not recorded. */
enum { LAYERS_MAX = 20 };

/* Builds the layers of a valid mesh of BODY_POTENTIAL. The mesh is the surface of the lumen alone,
 * without the outer side of a vessel wall.
 *
 * The thickness at a point is params->thickness times the radius of the thinnest segment at this
 * point. Two rules make the layers thinner. PrismLayers.n_thinner counts the points at which either
 * rule applies.
 *
 * 1. From any point to its neighbours on the wall, the thickness grows by at most half the length
 *    of the edge between them [MAX_SLOPE in sweep.c]. Layers are therefore thinner near a narrower
 *    vessel, and near every point that rule 2 changes.
 * 2. The thickness at a fault is halved, in at most 12 rounds [MAX_ROUNDS]. There are three faults.
 *    The inner surface crosses itself. A prism, or the stack of all prisms of a triangle, is
 *    inverted somewhere. Its inner face is smaller than 0.1 of its outer face [MIN_FACE_RATIO].
 *
 * The result is verified on the rounded points that are written. The Jacobian of each prism is
 * positive everywhere in the prism, and the inner surface with its flat ends is free of crossings.
 * Therefore no two prisms overlap, and the core is a solid that a mesher can fill.
 *
 * threads  number of threads; 0: one per processor. The result does not depend on it.
 * out      receives the layers; release it with prismlayers_release. Unchanged on error.
 * Errors   STATUS_INFEASIBLE, with a segment, if faults remain after the last round.
 *          STATUS_INFEASIBLE if there are too many prisms for 31-bit indices. STATUS_MEMORY. */
MUST_CHECK Status prismlayers_sweep(const VesselMesh *mesh, const VesselTree *tree,
                                    const LayerParams *params, int threads, PrismLayers *out,
                                    Err *err);
void prismlayers_release(PrismLayers *layers);

#endif
