/* The kernels of implicit surfaces (potential and blob), in one version for each instruction set;
 * fieldkernels_for selects the version. A FieldKernel finds the first hits of a tile of the image.
 * A ShadowKernel answers the shadow queries of a tile of a light view. Kernels allocate nothing and
 * cannot fail. */
#ifndef CORCAST_RENDER_FIELD_FIELDKERNELS_H
#define CORCAST_RENDER_FIELD_FIELDKERNELS_H

#include "render/field/fieldterms.h"
#include "render/light/shadowengine.h"

/* Finds the first hit of each sample of a tile.
 *
 * tile   must have at least one term. x and y of all TILE_SAMPLES samples are read, also those of
 *        samples outside the image.
 * work   workspace of at least tile->n_terms * TILE_WORK_BYTES bytes, aligned to 64 bytes. Its
 *        content is not used after the call.
 * hits   receives the hits; all fields are set. */
typedef void FieldKernel(const FieldTile *tile, void *work, TileHits *hits);

/* Answers the shadow queries of points in a tile of a light view: sets points->state. In a light
 * view z ascends along the lines from the points to the light. A point is dark if its line meets
 * the surface at a depth >= points->z. If the field at the point is within 0.2 % of the level, the
 * point counts as on the surface, and the crossing at the point itself is ignored, as in
 * field_search.any. 0.2 % exceeds the error of the field at a rounded hit [kernel_shadow.h].
 *
 * tile     x and y of the tile are not read.
 * work     as for a FieldKernel.
 * points   x and y are positions as in a FieldTile. Behind the last point there must be
 *          POINT_PADDING copies of the last point. */
typedef void ShadowKernel(const FieldTile *tile, void *work, ShadowPoints *points);

/* The kernels for one instruction set. */
typedef struct FieldKernels {
    FieldKernel *trace;
    ShadowKernel *shadow;
} FieldKernels;

/* The kernels of the potential and of the blob. */
DECLARE_KERNELS(FieldKernels, potentialkernels);
DECLARE_KERNELS(FieldKernels, blobkernels);

/* Returns the kernels of an instruction set for the geometry's model. The processor must support
 * the instruction set. */
const FieldKernels *fieldkernels_for(const Geometry *geometry, RenderKernels kernels);

#endif
