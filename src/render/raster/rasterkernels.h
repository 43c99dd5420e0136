/* What is done to a tile of primitives several samples at once, in one version for each kind of
 * processor. Kernels read and write whole blocks of as many samples as a processor has lanes, 16 at
 * most: of arrays of TILE_SAMPLES nothing else is touched, what reaches farther says so. */
#ifndef CORCAST_RENDER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTERKERNELS_H

#include "render/raster/rastertile.h"
#include "render/tile/tilekernels.h"

/* Where the samples of a tile see something, mm in the frame of the view; undefined for samples
 * that see nothing. */
typedef struct RasterPlaces {
    double x[TILE_SAMPLES], y[TILE_SAMPLES], z[TILE_SAMPLES];
} RasterPlaces;

/* How a light looks at places in the frame of the camera. */
typedef struct RasterAim {
    Vec3 axes[3], offset; /* the light's axes there, and the camera's location in the light's */
    bool perspective;
    double left, top, per_x, per_y; /* edge of the first tile, tiles per unit */
    double columns, rows;           /* tiles */
    double slack, z_middle;
} RasterAim;

/* Places as the light sees them. */
typedef struct AimedPlaces {
    double x[TILE_SAMPLES], y[TILE_SAMPLES];
    float z[TILE_SAMPLES];      /* before which a blocker must stand, less z_middle */
    int32_t tile[TILE_SAMPLES]; /* row by row */
} AimedPlaces;

/* Tiles of the picture whose places a light is asked about together. */
enum { RASTER_BATCH = 64, MOST_QUERIES = RASTER_BATCH * TILE_SAMPLES };

/* Lines of sight of a light through places, all in one tile of its view, and depths on them. */
typedef struct ShadowQueries {
    int n;
    const AimedPlaces *aimed;
    uint32_t place[MOST_QUERIES]; /* TILE_SAMPLES times the number in `aimed`, and the sample's */
    float x[MOST_QUERIES], y[MOST_QUERIES]; /* in the plane of the view, less the tile's middle */
    float z[MOST_QUERIES];                  /* less z_middle */
    /* Index of the item whose surface the place lies on, as in RasterHits. If that is a sphere or a
     * cylinder whose hit was found in single precision, it is not tested as a blocker of this
     * place: rounding would let it shadow itself. */
    uint32_t item[MOST_QUERIES];
    uint8_t covered[MOST_QUERIES]; /* 1 where an item is seen before that depth, else 0 */
} ShadowQueries;

typedef struct RasterKernels {
    /* Finds the first item at each sample, in *hits, and where that is a sphere or a cylinder the
     * normal, in surface->normal; nothing else of *surface is set. Bit i of what is returned is set
     * if sample i sees an item. Reads tile->list[0 .. n), and of the bins what raster_decide
     * does. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Completes *surface after `trace` with the same tile and hits: state, item (as `segment`), and
     * the normals of joints and of what was decided in double precision. Leaves z, any_hit and
     * any_unsure alone. */
    void (*resolve)(const RasterTile *tile, const RasterHits *hits, TileHits *surface);
    /* The places that the hits are at. */
    void (*locate)(const RasterTile *tile, const RasterHits *hits, RasterPlaces *places);
    /* facing[i] is 1 where the visible side of the surface at a place faces the light, else 0. */
    void (*face)(const RasterTile *tile, const RasterPlaces *places,
                 const float normal[3][TILE_SAMPLES], const TileLight *light,
                 uint8_t facing[TILE_SAMPLES]);
    /* Sets the places as the light sees them; where a sample sees nothing, to a tile of the light
     * all the same. */
    void (*aim)(const RasterAim *aim, const RasterPlaces *places, AimedPlaces *aimed);
    /* Of the samples, as bits, those that lie in a tile. */
    uint64_t (*within)(const AimedPlaces *aimed, int32_t tile);
    /* Sets `covered` of the queries, all of which lie in this tile of a light, and overwrites what
     * follows the last of them up to a multiple of the lanes. tile->list holds, behind its n items,
     * their n boxes [RasterBox], and `nears` their depths: of both, up to 15 words behind the end
     * are read and ignored. */
    void (*cover)(const RasterTile *tile, ShadowQueries *queries);
} RasterKernels;

extern const RasterKernels rasterkernels_portable;
#ifdef __x86_64__
extern const RasterKernels rasterkernels_avx2, rasterkernels_avx512;
#endif
/* As tilekernels. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
