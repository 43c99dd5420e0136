/* What one thread needs for the terms of a tile of the potential, whosever view it is of. */
#ifndef CORCAST_RENDER_FIELDSPACE_H
#define CORCAST_RENDER_FIELDSPACE_H

#include "render/cast/raysearch.h"
#include "render/field/fieldterms.h"

/* Grows with the longest list of a tile. Made by fieldspace_init. */
typedef struct FieldSpace {
    const Geometry *geometry; /* borrowed */
    TileTerm *terms;          /* owned, as all that follows */
    size_t terms_capacity;
    uint32_t *candidates; /* segments of the terms */
    size_t candidates_capacity;
    TileWork work;
    LocalGroups *groups;     /* NULL where all segments blend */
    const RaySearch *search; /* for single rays among the candidates */
    void *scratch;           /* its workspace; NULL before fieldspace_reserve_rays */
    size_t scratch_capacity;
} FieldSpace;

/* *space is the caller's even when this fails. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err);
void fieldspace_release(FieldSpace *space);

/* Makes room for the terms of tiles of up to n segments. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve(FieldSpace *space, size_t n, Err *err);
/* Makes room to cast single rays among n segments. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve_rays(FieldSpace *space, size_t n, Err *err);

/* Finds the first hit of a ray among the first n candidates, at t_min or later [raysearch.h]. There
 * must be room for n. */
bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, RayHit *hit);
/* Returns true if a ray that starts on the surface meets any of the first n candidates. */
bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray);

#endif
