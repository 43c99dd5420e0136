/* Where rays first meet the implicit surface Phi = FIELD_LEVEL, by proof and not by sampling. */
#ifndef CORCAST_RENDER_FIELDCAST_H
#define CORCAST_RENDER_FIELDCAST_H

#include "base/base.h"
#include "field/field.h"
#include "geom/geom.h"
#include "render/cast/rayterms.h"
#include "scene/scene.h"

/* The first point at t in [t_min, t_max] where Phi crosses FIELD_LEVEL along the ray; t_min is
 * finite, t_max may be infinite. False when there is none. That is where Phi rises through it, but
 * for a ray that starts inside a vessel: that meets the wall from within, where Phi first falls to
 * the level.
 *
 * *normal is unit and outward, -grad Phi / |grad Phi|; *segment the index of the segment whose term
 * is largest there, the lowest of equals. Terms are left out where they are below RAY_TERM_CUTOFF,
 * so the surface of a lone vessel is off by at most 1.9e-9 r each; a ray that grazes within that of
 * the level may go either way. Where segments blend in groups, the union of the groups' bodies is
 * met, and the segment is the largest of the group that is met. */
bool field_first_hit(const FieldIndex *index, FieldScratch *scratch, Ray ray, double t_min,
                     double t_max, double *t, Vec3 *normal, uint32_t *segment);

/* The same among `n` segments, listed by their indices in Geometry.segments, without a search
 * structure: O(n). `scratch` is the geometry's, with
 * room for n. */
bool field_first_hit_among(const Geometry *geometry, const uint32_t *list, size_t n,
                           FieldScratch *scratch, Ray ray, double t_min, double t_max, double *t,
                           Vec3 *normal, uint32_t *segment);

/* Whether there is such a point on a ray that starts on the surface, up to 1e-3 r off it. So the
 * wall that the ray leaves outwards, but starts just within, does not count. */
bool field_is_shadowed(const FieldIndex *index, FieldScratch *scratch, Ray ray, double t_min,
                       double t_max);

/* The same among `n` segments, as field_first_hit_among. */
bool field_is_shadowed_among(const Geometry *geometry, const uint32_t *list, size_t n,
                             FieldScratch *scratch, Ray ray, double t_min, double t_max);

#endif
