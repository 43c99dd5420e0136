/* The kernels of implicit models (potential and blob), in one version for each instruction set. A
 * FieldKernel finds the first hits of a tile of the image. A ShadowKernel answers the shadow
 * queries of a tile of a light view. Kernels allocate nothing and cannot fail. */
#ifndef CORCAST_RENDER_FIELD_FIELDKERNELS_H
#define CORCAST_RENDER_FIELD_FIELDKERNELS_H

#include "render/field/fieldterms.h"
#include "render/light/shadowengine.h"

/* Finds the first hit of each sample of a tile.
 *
 * tile   has at least one term. x and y of all TILE_SAMPLES samples are read, also those of samples
 *        outside the image.
 * work   a workspace of at least tile->n_terms * TILE_WORK_BYTES bytes, aligned to 64 bytes.
 *        Nothing in it is reused between calls.
 * hits   receives the hits; all fields are set. */
typedef void FieldKernel(const FieldTile *tile, void *work, TileHits *hits);

/* Answers the shadow queries of points in a tile of a light view: sets points->state. A point is
 * dark if a blocker lies at depth points->z or deeper on the line of sight from the point to the
 * light. A point where the field is within 0.2 % of the level counts as a point of a surface that
 * the line leaves, as in field_search.any.
 *
 * tile     lines of sight lead to the light. x and y of the tile are not read.
 * points   x and y are positions as in a FieldTile. Behind the last point are POINT_PADDING copies
 *          of the last point. */
typedef void ShadowKernel(const FieldTile *tile, void *work, ShadowPoints *points);

typedef struct FieldKernels {
    FieldKernel *trace;
    ShadowKernel *shadow;
} FieldKernels;

/* The kernels of the potential and of the blob. */
DECLARE_KERNELS(FieldKernels, potentialkernels);
DECLARE_KERNELS(FieldKernels, blobkernels);

/* Returns the kernels of an instruction set for the geometry's model. The processor must be able to
 * run them. */
const FieldKernels *fieldkernels_for(const Geometry *geometry, RenderKernels kernels);

#endif
