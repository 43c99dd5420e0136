/* What is done to a tile several samples at once, in one version for each kind of processor. */
#ifndef CORCAST_RENDER_TILEKERNELS_H
#define CORCAST_RENDER_TILEKERNELS_H

#include "render/fieldtile.h"
#include "scene/scene.h"

/* A light in the camera's frame. */
typedef struct TileLight {
    float towards[3]; /* parallel: unit; else the light's place, mm from the camera's location */
    float color[3];
    bool parallel;
} TileLight;

typedef struct TileLook {
    Finish finish;
    const TileLight *lights;
    size_t n_lights;
} TileLook;

/* The visible points of a tile, in the camera's frame. Samples that show nothing may hold anything
 * finite. */
typedef struct TileSurface {
    float normal[3][TILE_SAMPLES];    /* unit */
    float direction[3][TILE_SAMPLES]; /* unit, of the ray */
    float point[3][TILE_SAMPLES];     /* mm from the camera's location; only for lights that are not
                                       * parallel */
    float pigment[3][TILE_SAMPLES];
    const uint8_t (*shadowed)[TILE_SAMPLES]; /* whether from each light; NULL: none is */
} TileSurface;

typedef struct TileKernels {
    /* Finds the first hits; `work` has room for the tile's terms. */
    void (*trace)(const FieldTile *tile, TileWork *work, TileHits *hits);
    /* Colours as shade() gives, to 2e-5 of the light's colour. */
    void (*shade)(const TileLook *look, const TileSurface *surface, float color[3][TILE_SAMPLES]);
} TileKernels;

extern const TileKernels tilekernels_portable;
#ifdef __x86_64__
extern const TileKernels tilekernels_avx2;
#endif
/* The fastest that this processor can run. */
const TileKernels *tilekernels_best(void);

#endif
