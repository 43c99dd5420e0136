/* Layers of prisms along the inside of the vessel wall, a boundary layer mesh for flow solvers. The
 * layers are between the triangles of the wall and a surface inside the vessels. prismlayers_sweep
 * [mesh/sweep.h] builds a PrismLayers, the exporters of the module emit write it, and
 * prismlayers_release frees it. The triangles themselves are those of the mesh. */
#ifndef CORCAST_SCENE_PRISMS_H
#define CORCAST_SCENE_PRISMS_H

#include "scene/triangles.h"

/* The layers of a mesh. Each triangle of the wall is the outer face of a column of n_layers prisms.
 * Layer 0 is at the wall. Surface k is the outer side of layer k: surface 0 is the wall, and
 * surface n_layers bounds the core of the vessels. At a flat end, the points of the rim move
 * inwards from surface to surface; the middle point is the same point on all surfaces. All arrays
 * are owned. */
typedef struct PrismLayers {
    float (*points)[3]; /* mm: the points of the mesh, then the wall points of surface 1, of surface
                         * 2, ..., of surface n_layers */
    size_t n_points;
    uint32_t *wall_index;      /* per point of the mesh: its index among the points of the wall, or
                                * NOT_ON_WALL */
    size_t n_mesh_points;      /* number of points of the mesh */
    size_t n_wall_points;      /* number of mesh points on the wall */
    uint32_t *tree_of_segment; /* per segment of the vessel tree: the index of its connected tree,
                                * below n_trees. Files give each tree a region of its own */
    size_t n_trees;
    size_t n_layers;
    size_t n_prisms;
    size_t n_thinner;       /* number of wall points at which the layers together are thinner than
                             * the specified thickness */
    double mean_ratio;      /* mean over the wall points of: thickness of all layers / specified
                             * thickness */
    double min_ratio;       /* minimum of this ratio */
    double volume_mm3;      /* volume of all prisms */
    double core_volume_mm3; /* volume inside surface n_layers */
} PrismLayers;

/* The wall_index of a point that is on no triangle of the wall: the middle of a flat end. */
#define NOT_ON_WALL UINT32_MAX

/* Returns the index in `points` of the mesh point `point`, moved to surface `surface` (0 to
 * n_layers). */
static inline uint32_t prismlayers_point(const PrismLayers *layers, uint32_t point, size_t surface)
{
    if (surface == 0 || layers->wall_index[point] == NOT_ON_WALL)
        return point;
    return (uint32_t)(layers->n_mesh_points + (surface - 1) * layers->n_wall_points) +
           layers->wall_index[point];
}

#endif
