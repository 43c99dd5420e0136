/* What a ray meets first, for either kind of geometry. */
#ifndef CORCAST_RENDER_CASTER_H
#define CORCAST_RENDER_CASTER_H

#include "base/base.h"
#include "scene/scene.h"
#include "surface/surface.h"

/* POV-Ray's limit [docs/POVRAY.md section 3]: crossings nearer than this are not seen. */
#define NEAREST_SEEN_MM 1e-4

typedef struct Caster Caster;

/* A visible point. */
typedef struct Surfel {
    double t;         /* mm along the ray */
    Vec3 normal;      /* unit, facing the viewer */
    uint32_t segment; /* number of the segment */
} Surfel;

/* Builds the search structure of the geometry (borrowed), with workspaces for `workers` threads.
 * With `cells`, an implicit surface is found as POV-Ray finds it in them; NULL: by proof. */
MUST_CHECK Status caster_new(const Geometry *geometry, const CellParams *cells, int workers,
                             Caster **out, Err *err);
/* From now on nothing nearer to a lit place than this, mm, is in its light; at first it is
 * POV-Ray's limit. A blob has a limit of its own. */
void caster_shadow_from(Caster *caster, double nearest_mm);
void caster_free(Caster *caster);

/* `worker` in [0, workers) is the calling thread's own. */
bool caster_first(Caster *caster, int worker, Ray ray, Surfel *surfel);
/* Whether a vessel or the ground is in the way from `point` for `distance` mm (or HUGE_VAL) along
 * `towards` (unit). */
bool caster_shadow(Caster *caster, int worker, const Ground *ground, Vec3 point, Vec3 towards,
                   double distance);

#endif
