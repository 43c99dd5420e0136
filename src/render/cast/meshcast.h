/* First hits of triangles, by a bounding volume hierarchy. */
#ifndef CORCAST_RENDER_MESHCAST_H
#define CORCAST_RENDER_MESHCAST_H

#include "base/base.h"
#include "scene/scene.h"

/* Constant once built, shared by threads. */
typedef struct MeshCast MeshCast;

/* `mesh` is borrowed and must outlive the hierarchy; it has a triangle at least. O(n log n).
 * STATUS_MEMORY. */
MUST_CHECK Status meshcast_new(const VesselMesh *mesh, MeshCast **out, Err *err);
void meshcast_free(MeshCast *cast);

/* The nearest crossing with t >= t_min: true and *hit, *segment (the index in the triangle's label;
 * of equally near triangles the first), or false. The normal is that of the surface at the corners,
 * interpolated; on a cap, the triangle's own. *leaves: whether the ray comes from within, by the
 * triangle itself. */
bool meshcast_first_hit(const MeshCast *cast, Ray ray, double t_min, Hit *hit, uint32_t *segment,
                        bool *leaves);

/* Whether there is a crossing with t in (t_min, t_max). */
bool meshcast_any_hit(const MeshCast *cast, Ray ray, double t_min, double t_max);

#endif
