/* What one thread needs for the terms of a tile of the potential, whosever view it is of. */
#ifndef CORCAST_RENDER_FIELDSPACE_H
#define CORCAST_RENDER_FIELDSPACE_H

#include "render/cast/blobcast.h"
#include "render/cast/fieldcast.h"
#include "render/field/fieldterms.h"

/* Grows with the longest list of a tile. Made by fieldspace_init. */
typedef struct FieldSpace {
    const Geometry *geometry; /* borrowed */
    TileTerm *terms;          /* owned, as all that follows */
    size_t terms_capacity;
    uint32_t *candidates; /* segments of the terms */
    size_t candidates_capacity;
    TileWork work;
    LocalGroups *groups;   /* NULL where all segments blend */
    FieldScratch *scratch; /* made when first needed; of a blob the next */
    BlobScratch *blob_scratch;
    size_t scratch_capacity;
} FieldSpace;

/* *space is the caller's even when this fails. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_init(const Geometry *geometry, FieldSpace *space, Err *err);
void fieldspace_release(FieldSpace *space);

/* Makes room for the terms of tiles of up to n segments. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve(FieldSpace *space, size_t n, Err *err);
/* Makes room to cast single rays among n segments. STATUS_MEMORY. */
MUST_CHECK Status fieldspace_reserve_rays(FieldSpace *space, size_t n, Err *err);

/* What is there room for: the first hit of a ray among the first n candidates, t_min or more along
 * it, as field_first_hit_among() and blobcast_first_hit_among(); and whether a ray that starts on
 * the surface meets any of them. */
bool fieldspace_first_hit(FieldSpace *space, size_t n, Ray ray, double t_min, double *t,
                          Vec3 *normal, uint32_t *segment);
bool fieldspace_is_shadowed(FieldSpace *space, size_t n, Ray ray);

#endif
