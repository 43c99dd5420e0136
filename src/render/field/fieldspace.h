/* The workspace of one thread for drawing one tile of an implicit surface, in the view of a camera
 * or of a light. fieldspace_init makes it. Before each tile, fieldspace_reserve makes it large
 * enough; fieldterms_make then fills `terms` and `candidates`, and a kernel uses `work`. Rays that
 * the kernel leaves undecided are searched one by one by fieldspace_first_hit and
 * fieldspace_is_shadowed. Capacities never shrink. */
#ifndef CORCAST_RENDER_FIELD_FIELDSPACE_H
#define CORCAST_RENDER_FIELD_FIELDSPACE_H

#include "render/cast/raysearch.h"
#include "render/field/fieldterms.h"

/* The workspace. */
typedef struct FieldSpace {
    const Geometry *geometry;   /* borrowed */
    ARRAY(TileTerm) terms;      /* owned, like all following pointers */
    ARRAY(uint32_t) candidates; /* per term, in the order of the list: index of its segment */
    void *work;                 /* workspace of the kernels, for work_capacity terms */
    size_t work_capacity;
    LocalGroups *groups;     /* finds blend groups [FieldTile]; NULL if all segments blend */
    const RaySearch *search; /* finds the hits of single rays with the candidates */
    void *scratch;           /* workspace of `search`; NULL before fieldspace_reserve_rays */
    size_t scratch_capacity;
} FieldSpace;

/* Initialises an empty workspace. Release it with fieldspace_release, even after an error. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err);
void fieldspace_release(FieldSpace *space);

/* Reserves space for the terms of tiles with up to n segments. Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve(FieldSpace *space, size_t n, Err *err);
/* Reserves space to find hits of single rays with n segments. Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve_rays(FieldSpace *space, size_t n, Err *err);

/* Finds the first hit of a ray among the first n candidates, at t_min (mm) or farther
 * [raysearch.h]. Returns false if there is none; *hit is then undefined. fieldspace_reserve_rays
 * must have been called for n segments. */
bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, RayHit *hit);
/* Returns true if a ray that starts on the surface hits any of the first n candidates.
 * fieldspace_reserve_rays must have been called for n segments. */
bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray);

#endif
