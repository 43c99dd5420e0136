/* The first hits of a tile of the potential or of a blob, in one version for each kind of
 * processor. */
#ifndef CORCAST_RENDER_FIELDKERNELS_H
#define CORCAST_RENDER_FIELDKERNELS_H

#include "render/field/fieldterms.h"
#include "render/light/shadowqueue.h"

/* Finds the first hits of a tile that has terms: sets all of *hits. `work` has room for those terms
 * [TILE_WORK_BYTES each] and holds nothing from one call to the next. Reads x and y of all
 * TILE_SAMPLES samples, those outside the picture included. */
typedef void FieldKernel(const FieldTile *tile, TileWork *work, TileHits *hits);

typedef enum PlaceState {
    PLACE_LIT, /* proven: nothing is between the place and the light */
    PLACE_DARK,
    PLACE_UNSURE /* within the margin of the arithmetic */
} PlaceState;

/* Places in a tile of a light's view, whose lines of sight lead to the light. Behind the last stand
 * POINT_PADDING copies of it. */
typedef struct FieldPlaces {
    int n;
    float *x, *y;                     /* as those of a FieldTile */
    double *z;                        /* from where on something is in the way */
    uint8_t state[SHADOW_MAX_POINTS]; /* PlaceState, the answer */
} FieldPlaces;

/* Says of places what state they are in; x and y of the tile are not read. A place within 0.2 % of
 * the level is taken to be on a surface that it leaves, as field_search.any takes it. */
typedef void ShadowKernel(const FieldTile *tile, TileWork *work, FieldPlaces *places);

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
