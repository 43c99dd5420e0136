/* The first hits of a tile of the potential or of a blob, in one version for each kind of
 * processor. */
#ifndef CORCAST_RENDER_FIELDKERNELS_H
#define CORCAST_RENDER_FIELDKERNELS_H

#include "render/field/fieldterms.h"
#include "render/light/shadowengine.h"

/* Finds the first hits of a tile that has terms: sets all of *hits. `work` has room for those terms
 * [TILE_WORK_BYTES each] and holds nothing from one call to the next. Reads x and y of all
 * TILE_SAMPLES samples, those outside the picture included. */
typedef void FieldKernel(const FieldTile *tile, TileWork *work, TileHits *hits);

/* Answers the shadow queries of points in a tile of a light view whose lines of sight lead to the
 * light: sets points->state. Does not read the tile's x and y. points->x and y are as those of a
 * FieldTile. Blockers matter from depth points->z on. Behind the last point are POINT_PADDING
 * copies of it. A point within 0.2 % of the level is taken to be on a surface that it leaves, as in
 * field_search.any. */
typedef void ShadowKernel(const FieldTile *tile, TileWork *work, ShadowPoints *points);

FieldKernel trace_portable, trace_blob_portable;
ShadowKernel shadow_portable, shadow_blob_portable;
#ifdef __x86_64__
FieldKernel trace_avx2, trace_avx512, trace_blob_avx2, trace_blob_avx512;
ShadowKernel shadow_avx2, shadow_avx512, shadow_blob_avx2, shadow_blob_avx512;
#endif

typedef struct FieldKernels {
    FieldKernel *trace;
    ShadowKernel *shadow;
} FieldKernels;

/* Of the potential and of the blob, as tilekernels. */
extern const FieldKernels potentialkernels[KINDS_OF_KERNELS], blobkernels[KINDS_OF_KERNELS];

/* Those of that kind for the geometry's model. */
const FieldKernels *fieldkernels_for(const Geometry *geometry, RenderKernels kernels);

#endif
