/* What is done to a tile of primitives several samples at once, in one version for each kind of
 * processor. */
#ifndef CORCAST_RENDER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTERKERNELS_H

#include "render/raster/rastertile.h"
#include "render/tile/tilekernels.h"

/* Where the samples of a tile see something, in the frame of the view; senseless for others. */
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
typedef struct RasterSpots {
    double x[TILE_SAMPLES], y[TILE_SAMPLES];
    float z[TILE_SAMPLES];      /* before which a blocker must stand, less z_middle */
    int32_t tile[TILE_SAMPLES]; /* row by row */
} RasterSpots;

/* Tiles of the picture whose places a light is asked about together. */
enum { RASTER_BATCH = 64, MOST_PROBES = RASTER_BATCH * TILE_SAMPLES };

/* Lines of sight of a light through places, all in one tile of its view, and depths on them. */
typedef struct RasterProbes {
    int n;
    const RasterSpots *spots;
    uint32_t place[MOST_PROBES]; /* TILE_SAMPLES times the number in `spots`, and the sample's */
    float x[MOST_PROBES], y[MOST_PROBES]; /* in the plane of the view, less the tile's middle */
    float z[MOST_PROBES];                 /* less z_middle */
    uint32_t item[MOST_PROBES];   /* that the place is on, as in RasterHits: no sphere or cylinder
                                   * seen in single precision shadows itself */
    uint8_t covered[MOST_PROBES]; /* 1 where an item is seen before that depth, else 0 */
} RasterProbes;

typedef struct RasterKernels {
    /* Finds the first items of the tile, and of spheres and cylinders the normals; bit i is set
     * where sample i sees one. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* State, item (as `segment`) and all other normals of the hits. */
    void (*resolve)(const RasterTile *tile, const RasterHits *hits, TileHits *surface);
    /* The places that the hits are at. */
    void (*locate)(const RasterTile *tile, const RasterHits *hits, RasterPlaces *places);
    /* facing[i] is 1 where the visible side of the surface at a place faces the light, else 0. */
    void (*face)(const RasterTile *tile, const RasterPlaces *places,
                 const float normal[3][TILE_SAMPLES], const TileLight *light,
                 uint8_t facing[TILE_SAMPLES]);
    void (*aim)(const RasterAim *aim, const RasterPlaces *places, RasterSpots *spots);
    /* Of the samples, as bits, those that lie in a tile. */
    uint64_t (*within)(const RasterSpots *spots, int32_t tile);
    /* Sets `covered` of the probes, all of which lie in this tile. */
    void (*cover)(const RasterTile *tile, RasterProbes *probes);
} RasterKernels;

extern const RasterKernels rasterkernels_portable;
#ifdef __x86_64__
extern const RasterKernels rasterkernels_avx2, rasterkernels_avx512;
#endif
/* As tilekernels. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
