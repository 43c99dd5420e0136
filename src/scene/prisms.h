/* Layers of prisms along the inside of the vessel wall, a boundary layer mesh for flow solvers. The
 * layers are between the triangles of the wall and a surface inside the vessels. mesh/ builds a
 * PrismLayers; emitters write it. */
#ifndef CORCAST_SCENE_PRISMS_H
#define CORCAST_SCENE_PRISMS_H

#include "scene/triangles.h"

/* The layers of a mesh. Each triangle of the wall is the outer face of a column of n_layers prisms.
 * Layer 0 is at the wall. Surface k is the outer side of layer k: surface 0 is the wall, and
 * surface n_layers bounds the core of the vessels. The middle point of a flat end is the same point
 * on all surfaces. All arrays are owned. */
typedef struct PrismLayers {
    float (*points)[3]; /* mm: the points of the mesh, then the wall points of surface 1, of surface
                         * 2, ..., of surface n_layers */
    size_t n_points;
    uint32_t *rank;                      /* per point of the mesh: its index among the points of the
                                          * wall, or NO_RANK */
    size_t n_mesh_points, n_wall_points; /* number of points of the mesh; number of mesh points on
                                          * the wall */
    uint32_t *trees;                     /* per segment: the index of its tree, below n_trees */
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

/* The rank of a point that is on no triangle of the wall: the middle of a flat end. */
#define NO_RANK UINT32_MAX

/* Returns the index in `points` of the mesh point `point`, moved to surface `surface` (0 to
 * n_layers). */
static inline uint32_t prismlayers_point(const PrismLayers *layers, uint32_t point, size_t surface)
{
    if (surface == 0 || layers->rank[point] == NO_RANK)
        return point;
    return (uint32_t)(layers->n_mesh_points + (surface - 1) * layers->n_wall_points) +
           layers->rank[point];
}

#endif
