/* Where POV-Ray 3.7 finds the cells of an implicit surface [docs/POVRAY.md section 5]: its own
 * interval isosurface, repeated operation by operation, so that its pictures can be told from ours
 * to the last code. */
#ifndef CORCAST_RENDER_POVRAY_ISOSURFACE_H
#define CORCAST_RENDER_POVRAY_ISOSURFACE_H

#include "base/base.h"
#include "field/field.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* The cells of an isosurface under a hierarchy of boxes; constant once built, shared by threads. */
typedef struct PovrayIsosurface PovrayIsosurface;

/* Cuts the geometry, of which nothing is kept, into cells. STATUS_MEMORY; STATUS_INFEASIBLE as
 * celltree_build. */
MUST_CHECK Status povray_isosurface_new(const Geometry *geometry, const CellParams *params,
                                        PovrayIsosurface **out, Err *err);
void povray_isosurface_free(PovrayIsosurface *isosurface);

/* The first hit with t >= t_min of all cells: true and *hit, with the forward-difference normal
 * (unit, of no particular side), and the index in Geometry.segments of the one whose term is
 * largest there, and *cell, its cell's number; or false. As in POV-Ray, a cell tells of one hit
 * alone. */
bool povray_isosurface_first_hit(const PovrayIsosurface *isosurface, Ray ray, double t_min,
                                 Hit *hit, uint32_t *segment, uint32_t *cell);

/* cell_mean of the cell of this number. */
double povray_isosurface_mean(const PovrayIsosurface *isosurface, uint32_t cell,
                              const FieldSegment *segments, const double *numbers, Vec3 x);

/* Whether the hit of any cell has t in (t_min, t_max). */
bool povray_isosurface_any_hit(const PovrayIsosurface *isosurface, Ray ray, double t_min,
                               double t_max);

#endif
