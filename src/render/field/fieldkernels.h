/* The first hits of a tile of the potential, in one version for each kind of processor. */
#ifndef CORCAST_RENDER_FIELDKERNELS_H
#define CORCAST_RENDER_FIELDKERNELS_H

#include "render/field/fieldterms.h"
#include "render/tile/tilekernels.h"

/* Finds the first hits of a tile that has terms: sets all of *hits. `work` has room for those terms
 * [TILE_WORK_BYTES each] and holds nothing from one call to the next. Reads x and y of all
 * TILE_SAMPLES samples, those outside the picture included. */
typedef void FieldKernel(const FieldTile *tile, TileWork *work, TileHits *hits);

FieldKernel trace_portable;
#ifdef __x86_64__
FieldKernel trace_avx2, trace_avx512;
#endif
/* As tilekernels. */
extern FieldKernel *const fieldkernels[KINDS_OF_KERNELS];

#endif
