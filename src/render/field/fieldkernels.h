/* The kernels of implicit surfaces (potential and blob), in one version for each instruction set. A
 * FieldKernel finds the first hits of a tile of the image. A ShadowKernel answers the shadow
 * queries of a tile of a light view. Kernels allocate nothing and cannot fail. */
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

/* Answers the shadow queries of points in a tile of a light view: sets points->state. A point is
 * dark if a blocker is on its line of sight at depth points->z or deeper. If the field at a point
 * is within 0.2 % of the level, the point counts as a point of the surface that the line leaves, as
 * in field_search.any.
 *
 * tile     the lines of sight lead to the light. x and y of the tile are not read.
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
