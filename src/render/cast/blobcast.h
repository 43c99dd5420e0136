/* First hits of a blob: the field of surface/blob.h along a ray, solved piece by piece. */
#ifndef CORCAST_RENDER_BLOBCAST_H
#define CORCAST_RENDER_BLOBCAST_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* The segments of a geometry (borrowed) under a hierarchy of boxes; constant once built, shared by
 * threads. */
typedef struct BlobCast BlobCast;
/* The workspace of one thread: nothing is allocated while rays are cast, and only what a ray needs
 * is touched. */
typedef struct BlobScratch BlobScratch;

/* STATUS_MEMORY, as below. O(n log n) of n segments. */
MUST_CHECK Status blobcast_new(const Geometry *geometry, BlobCast **out, Err *err);
void blobcast_free(BlobCast *cast);
/* Room for rays among `n` segments. */
MUST_CHECK Status blobscratch_new(size_t n, BlobScratch **out, Err *err);
void blobscratch_free(BlobScratch *scratch);

/* The first t in (t_min, t_max), t_min >= 0, at which the field passes 1, either way: true and *t,
 * the unit normal (towards smaller fields) and the index in Geometry.segments of the one whose
 * term is largest there; or false. */
bool blobcast_first_hit(const BlobCast *cast, BlobScratch *scratch, Ray ray, double t_min,
                        double t_max, double *t, Vec3 *normal, uint32_t *segment);
/* The same among `n` segments, listed by their indices in Geometry.segments: O(n). */
bool blobcast_first_hit_among(const Geometry *geometry, const uint32_t *list, size_t n,
                              BlobScratch *scratch, Ray ray, double t_min, double t_max, double *t,
                              Vec3 *normal, uint32_t *segment);

/* Whether there is such a t. */
bool blobcast_any_hit(const BlobCast *cast, BlobScratch *scratch, Ray ray, double t_min,
                      double t_max);
bool blobcast_any_hit_among(const Geometry *geometry, const uint32_t *list, size_t n,
                            BlobScratch *scratch, Ray ray, double t_min, double t_max);

#endif
