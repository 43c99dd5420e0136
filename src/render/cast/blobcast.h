/* First hits of the blob of a scene: the field of surface/blob.h along a ray, solved piece by
 * piece. */
#ifndef CORCAST_RENDER_BLOBCAST_H
#define CORCAST_RENDER_BLOBCAST_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* The segments of a scene (borrowed) under a hierarchy of boxes; constant once built, shared by
 * threads. */
typedef struct BlobCast BlobCast;
/* What one thread needs to cast rays. */
typedef struct BlobScratch BlobScratch;

MUST_CHECK Status blobcast_new(const Geometry *geometry, BlobCast **out, Err *err);
void blobcast_free(BlobCast *cast);
MUST_CHECK Status blobscratch_new(const BlobCast *cast, BlobScratch **out, Err *err);
void blobscratch_free(BlobScratch *scratch);

/* The first t in (t_min, t_max), t_min >= 0, at which the field passes 1, either way: true and *t,
 * the unit normal (towards smaller fields) and the segment whose term is largest there; or
 * false. */
bool blobcast_first_hit(const BlobCast *cast, BlobScratch *scratch, Ray ray, double t_min,
                        double t_max, double *t, Vec3 *normal, uint32_t *segment);

/* Whether there is such a t. */
bool blobcast_any_hit(const BlobCast *cast, BlobScratch *scratch, Ray ray, double t_min,
                      double t_max);

#endif
