/* What is done to a tile several samples at once, in one version for each kind of processor.
 * Kernels read and write whole blocks of as many samples as a processor has lanes, 16 at most: what
 * an array holds for samples that see nothing does not matter, and may be overwritten. */
#ifndef CORCAST_RENDER_TILEKERNELS_H
#define CORCAST_RENDER_TILEKERNELS_H

#include "image/image.h"
#include "render/job.h"
#include "render/tile/tile.h"
#include "scene/scene.h"

/* A light in the camera's frame. */
typedef struct TileLight {
    float towards[3]; /* parallel: unit; else the light's place, mm from the camera's location */
    float color[3];
    bool parallel;
} TileLight;

typedef struct TileLook {
    Finish finish;
    TileLight lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
} TileLook;

/* The visible points of a tile, in the camera's frame. */
typedef struct TileSurface {
    const TileHits *hits;
    float direction[3][TILE_SAMPLES]; /* unit, of the ray */
    float point[3][TILE_SAMPLES];     /* mm from the camera's location; only for lights that are not
                                       * parallel */
    float pigment[3][TILE_SAMPLES];
    const uint8_t (*shadowed)[TILE_SAMPLES]; /* whether from each light; NULL: none is */
    const float *open; /* the part of the ambient light that reaches each; NULL: all */
    const float (*parts)[TILE_SAMPLES]; /* that of each light, where `is_shared`; NULL: of none */
    bool is_shared[VIEW_MAX_LIGHTS];
} TileSurface;

/* Where the samples of a tile see something, mm in the frame of the view; undefined for samples
 * that see nothing. */
typedef struct SeenPlaces {
    double x[TILE_SAMPLES], y[TILE_SAMPLES], z[TILE_SAMPLES];
} SeenPlaces;

/* How a light looks at places in the frame of the camera. */
typedef struct LightAim {
    Vec3 axes[3], offset; /* the light's axes there, and the camera's location in the light's */
    bool perspective;
    double left, top, per_x, per_y; /* edge of the first tile, tiles per unit */
    double columns, rows;           /* tiles */
    double slack, z_middle;
} LightAim;

/* Places as the light sees them. */
typedef struct AimedPlaces {
    float x[TILE_SAMPLES], y[TILE_SAMPLES]; /* in the view's plane, from the middle of the tile */
    double z[TILE_SAMPLES];                 /* before which a blocker must stand, less z_middle */
    int32_t tile[TILE_SAMPLES];             /* row by row */
} AimedPlaces;

typedef struct TileKernels {
    /* Colours of the hits as shade() gives, to 2e-5 of the light's colour. Reads of the surface
     * what the look asks for, and sets the colours of other samples in the same block to anything.
     */
    void (*shade)(const TileLook *look, const TileSurface *surface, float color[3][TILE_SAMPLES]);
    /* Gives the samples whose TileState is TILE_MISS the background. */
    void (*clear)(const uint8_t *state, const float background[3], float color[3][TILE_SAMPLES]);
    /* Stores a whole tile's colours as TILE_SIDE rows of pixels, `stride` floats from row to row.
     */
    void (*paint)(float color[3][TILE_SAMPLES], float *pixels, size_t stride);
    /* Stores the 8-bit codes of a whole tile's colours as TILE_SIDE rows of pixels, `stride` bytes
     * from row to row: the background's where a TileState is TILE_MISS. `state` NULL: none is.
     * Colours that are not a number have code 0. */
    void (*encode)(const SrgbCodes *codes, float color[3][TILE_SAMPLES], const uint8_t *state,
                   const uint8_t background[3], uint8_t *pixels, size_t stride);
    /* Bit i: the visible side of the surface at place i faces the light; anything where nothing is
     * seen. */
    uint64_t (*face)(const SeenTile *seen, const SeenPlaces *places,
                     const float normal[3][TILE_SAMPLES], const TileLight *light);
    /* Sets the places as the light sees them; where a sample sees nothing, to a tile of the light
     * all the same. */
    void (*aim)(const LightAim *aim, const SeenPlaces *places, AimedPlaces *aimed);
    /* Of the samples, as bits, those that lie in a tile. */
    uint64_t (*within)(const AimedPlaces *aimed, int32_t tile);
} TileKernels;

/* Kernels come in kinds: the portable ones first, then those for ever more able processors. */
extern const TileKernels tilekernels_portable;
#ifdef __x86_64__
enum { KINDS_OF_KERNELS = 3 };
extern const TileKernels tilekernels_avx2, tilekernels_avx512;
#else
enum { KINDS_OF_KERNELS = 1 };
#endif
/* How many of the kinds, from the first on, this processor can run; the last is the fastest. */
int kernels_usable(void);
/* The kind that is asked for, which this processor can run: an index into the tables of kernels. */
int kernels_kind(RenderKernels kernels);

extern const TileKernels *const tilekernels[KINDS_OF_KERNELS];

#endif
