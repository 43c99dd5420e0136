/* Layers of prisms between the wall of vessels and a surface inside it, for flow solvers: the
 * points of the layers, and which prism has which corners. */
#ifndef CORCAST_SCENE_PRISMS_H
#define CORCAST_SCENE_PRISMS_H

#include "scene/triangles.h"

/* The layers of a mesh. Each triangle of the wall is the outer face of one prism per layer. Layer 0
 * is at the wall. Surface k is the outer side of layer k; the last surface, n_layers, bounds the
 * core of the vessels. The middles of flat ends are the same point on all surfaces. All arrays are
 * owned. */
typedef struct PrismLayers {
    float (*points)[3]; /* mm: the points of the mesh, then the wall points of surface 1, 2, ... */
    size_t n_points;
    uint32_t *rank; /* per point of the mesh: its index among the points of the wall, or NO_RANK */
    size_t n_mesh_points, n_wall_points;
    uint32_t *trees; /* per segment: the index of its tree, below n_trees */
    size_t n_trees;
    size_t n_layers;
    size_t n_prisms;
    size_t n_thinner;       /* points of the wall at which the layers are thinner than the specified
                               thickness */
    double mean_part;       /* mean over the points of the wall: thickness / specified thickness */
    double least_part;      /* minimum of this ratio */
    double volume_mm3;      /* of all prisms */
    double core_volume_mm3; /* inside the last surface */
} PrismLayers;

/* The rank of a point that is on no triangle of the wall: the middle of a flat end. */
#define NO_RANK UINT32_MAX

/* Returns the index in `points` of a mesh's point on surface 0 to n_layers. */
static inline uint32_t prismlayers_point(const PrismLayers *layers, uint32_t point, size_t surface)
{
    if (surface == 0 || layers->rank[point] == NO_RANK)
        return point;
    return (uint32_t)(layers->n_mesh_points + (surface - 1) * layers->n_wall_points) +
           layers->rank[point];
}

#endif
