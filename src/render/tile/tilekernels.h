/* Kernels that process several samples of a tile at once, compiled once for each kind of processor.
 * A kernel reads and writes whole blocks of as many samples as the processor has lanes, at most 16.
 * Array elements of samples that hit nothing are undefined and may be overwritten. */
#ifndef CORCAST_RENDER_TILE_TILEKERNELS_H
#define CORCAST_RENDER_TILE_TILEKERNELS_H

#include "image/image.h"
#include "render/job.h"
#include "render/tile/tile.h"
#include "scene/scene.h"

/* A light in the camera's frame. */
typedef struct TileLight {
    float towards[3]; /* parallel light: unit direction to it; otherwise its position, mm from the
                       * camera */
    float color[3];
    bool parallel;
} TileLight;

/* The finish and the lights with which a surface is shaded. */
typedef struct TileLook {
    Finish finish;
    TileLight lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    float paper[3]; /* the color that surfaces fade into */
} TileLook;

/* The surface points that the samples of a tile hit, in the camera's frame. */
typedef struct TileSurface {
    const TileHits *hits;
    float direction[3][TILE_SAMPLES]; /* unit, of the camera ray */
    float point[3][TILE_SAMPLES];     /* mm from the camera; set if a light is not parallel */
    float pigment[3][TILE_SAMPLES];
    const uint8_t (*shadowed)[TILE_SAMPLES]; /* per light and sample: 1 in shadow; NULL: none is */
    const float *fade;    /* per sample: fraction of the paper's color; NULL: 0 for all */
    const float *ambient; /* per sample: ambient visibility, 0 to 1; NULL: 1 for all */
    /* Per light: visibility of the light, 0 to 1, per sample; NULL: 1 for all. */
    const float *light_visibility[VIEW_MAX_LIGHTS];
} TileSurface;

/* The points that the samples of a tile hit, mm in the view's frame; undefined for samples that hit
 * nothing. */
typedef struct HitPoints {
    double x[TILE_SAMPLES], y[TILE_SAMPLES], z[TILE_SAMPLES];
} HitPoints;

/* The projection from the camera's frame to a light view: from points to their tile in the light
 * view, and their depth. */
typedef struct LightProjection {
    Vec3 axes[3], offset; /* the light's axes in the camera's frame; the camera in the light's */
    bool perspective;
    double left, top, per_x, per_y; /* edges of the first tile; tiles per unit of the plane */
    double columns, rows;           /* number of columns and rows of tiles */
    double slack;                   /* depth by which a blocker must be nearer to the light */
    double z_middle;                /* subtracted from depths, so that floats hold them well */
} LightProjection;

/* Points of a tile, projected to a light view. */
typedef struct ProjectedPoints {
    float x[TILE_SAMPLES], y[TILE_SAMPLES]; /* in the light view's plane, from the tile's middle */
    double z[TILE_SAMPLES];                 /* depth limit of blockers, minus z_middle */
    int32_t tile[TILE_SAMPLES];             /* index of the light's tile, row by row */
} ProjectedPoints;

typedef struct TileKernels {
    /* Computes the colors of hits. They agree with shade() to 2e-5 of the light's color. Sets the
     * colors of other samples in the same block to undefined values. */
    void (*shade)(const TileLook *look, const TileSurface *surface, float color[3][TILE_SAMPLES]);
    /* Sets the color of the samples whose TileState is TILE_MISS to the background. */
    void (*clear)(const uint8_t *state, const float background[3], float color[3][TILE_SAMPLES]);
    /* Copies the colors of a whole tile to TILE_SIDE rows of pixels; `stride` is the number of
     * floats from one row to the next. */
    void (*paint)(float color[3][TILE_SAMPLES], float *pixels, size_t stride);
    /* Encodes the colors of a whole tile as 8-bit sRGB, in TILE_SIDE rows of pixels; `stride` is
     * the number of bytes from one row to the next. Samples whose TileState is TILE_MISS get the
     * background; `state` NULL: no sample is. NaN is encoded as 0. */
    void (*encode)(const SrgbCodes *codes, float color[3][TILE_SAMPLES], const uint8_t *state,
                   const uint8_t background[3], uint8_t *pixels, size_t stride);
    /* Returns a mask: bit i is set if the visible side of the surface at sample i faces the light.
     * Bits of samples that hit nothing are undefined. */
    uint64_t (*face)(const TracedTile *traced, const HitPoints *points,
                     const float normal[3][TILE_SAMPLES], const TileLight *light);
    /* Projects the points to the light view. Points of samples that hit nothing get a valid tile,
     * too. */
    void (*aim)(const LightProjection *aim, const HitPoints *points, ProjectedPoints *aimed);
    /* Returns a mask of the samples whose projected point lies in the light's tile `tile`. */
    uint64_t (*within)(const ProjectedPoints *aimed, int32_t tile);
} TileKernels;

/* The kinds of kernels: first the portable one, then one for each newer instruction set. Each table
 * of functions has one version per kind, whose name LANES_NAME [lanes.h] makes. DECLARE_KERNELS
 * declares the versions of the table `name`, of struct `type`. EACH_KIND is the list of their
 * addresses. */
#ifdef __x86_64__
enum { KINDS_OF_KERNELS = 3 };
#define DECLARE_KERNELS(type, name) extern const type name##_portable, name##_avx2, name##_avx512
#define EACH_KIND(name) &name##_portable, &name##_avx2, &name##_avx512
#else
enum { KINDS_OF_KERNELS = 1 };
#define DECLARE_KERNELS(type, name) extern const type name##_portable
#define EACH_KIND(name) &name##_portable
#endif

DECLARE_KERNELS(TileKernels, tilekernels);
extern const TileKernels *const tilekernels[KINDS_OF_KERNELS];

/* Returns the number of kinds, from the first on, that this processor can run. The last of them is
 * the fastest. */
int kernels_usable(void);
/* Returns the index of the requested kind, which this processor must be able to run, in the
 * tables of kernels: KERNELS_FASTEST gives the last usable one. */
int kernels_kind(RenderKernels kernels);

#endif
